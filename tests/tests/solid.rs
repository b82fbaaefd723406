//! From a drawing to a solid with the command `faceformer`: every format, every option.

use std::path::Path;

use faceformer_tests::{faceformer, output_dir, prism, sample};
use serde_json::Value;

/// A machined block of the corpus: 19 planes.
const BLOCK: &str = "mfcad/00841#o0";
const BLOCK_VOLUME: f64 = 1.38062;

/// A washer of the corpus: two planes and, when its silhouettes are gone, two cylinders.
const WASHER: &str = "bdwarehouse/00107#o0";

fn of_sample(id: &str) -> String {
    format!("{}#{id}", sample().display())
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// The record that `solid -o OUT.json` writes, with further arguments.
fn record(name: &str, id: &str, further: &[&str]) -> Value {
    let out = output_dir(name).join("out.json");
    let arguments = [
        &[
            "solid",
            &of_sample(id),
            "--faces",
            "truth",
            "-o",
            text(&out),
        ],
        further,
    ];
    faceformer(arguments.concat()).ok();
    json(&out)
}

fn volume(record: &Value) -> f64 {
    record["report"]["volume"].as_f64().unwrap()
}

fn near(a: f64, b: f64) -> bool {
    (a / b - 1.0).abs() < 1e-3
}

#[test]
fn every_format_is_written() {
    let dir = output_dir("solid-formats");
    let drawing = of_sample(WASHER);
    for (name, start) in [
        ("washer.step", "ISO-10303-21;"),
        ("washer.STP", "ISO-10303-21;"),
        ("washer.brep", "\nCASCADE Topology V1"),
        ("washer.brp", "\nCASCADE Topology V1"),
        ("washer.json", "{\"report\":"),
    ] {
        let out = dir.join(name);
        let run = faceformer(["solid", &drawing, "--faces", "truth", "-o", text(&out)]).ok();
        assert!(
            run.stdout.contains("4 faces (2 planes, 2 cylinders)"),
            "{}",
            run.stdout
        );
        let content = std::fs::read(&out).unwrap();
        let head = String::from_utf8_lossy(&content[..content.len().min(100)]).into_owned();
        assert!(head.contains(start), "{name}: {head}");
    }
    let stl = dir.join("washer.stl");
    faceformer(["solid", &drawing, "--faces", "truth", "-o", text(&stl)]).ok();
    let bytes = std::fs::read(&stl).unwrap();
    let triangles = u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize;
    assert!(triangles > 40);
    assert_eq!(bytes.len(), 84 + 50 * triangles);
    let step = std::fs::read_to_string(dir.join("washer.step")).unwrap();
    assert_eq!(
        step.matches("CYLINDRICAL_SURFACE(").count(),
        2,
        "true cylinders"
    );
    assert_eq!(step.matches("MANIFOLD_SOLID_BREP(").count(), 1);
    assert_eq!(
        std::fs::read_dir(&dir).unwrap().count(),
        6,
        "nothing else is left"
    );
}

#[test]
fn the_solid_is_the_one_that_was_drawn() {
    let record = record("solid-block", BLOCK, &[]);
    assert!(near(volume(&record), BLOCK_VOLUME), "{}", volume(&record));
    assert_eq!(record["report"]["faces"], 19);
    assert_eq!(record["plan"]["faces"].as_array().unwrap().len(), 19);
    let depths = record["lift"]["depths"].as_array().unwrap();
    assert_eq!(
        depths.len(),
        record["plan"]["vertices"].as_array().unwrap().len()
    );
}

#[test]
fn scale_multiplies_lengths() {
    let record = record("solid-scale", BLOCK, &["--scale", "10"]);
    assert!(
        near(volume(&record), 1e3 * BLOCK_VOLUME),
        "{}",
        volume(&record)
    );
}

#[test]
fn flip_gives_the_mirror_image_in_depth() {
    let (plain, flipped) = (
        record("solid-plain", BLOCK, &[]),
        record("solid-flip", BLOCK, &["--flip"]),
    );
    assert!(near(volume(&plain), volume(&flipped)));
    let depths = |record: &Value| -> Vec<f64> {
        let depths = record["lift"]["depths"].as_array().unwrap();
        depths.iter().map(|z| z.as_f64().unwrap()).collect()
    };
    let (a, b) = (depths(&plain), depths(&flipped));
    assert!(a.iter().any(|z| z.abs() > 0.1));
    for (a, b) in a.iter().zip(&b) {
        assert!((a + b).abs() < 1e-5, "{a} {b}");
    }
}

#[test]
fn as_drawn_the_solid_lies_behind_its_drawing() {
    let record = record("solid-drawn", BLOCK, &["--orientation", "drawn"]);
    let drawing = faceformer::drawing::dataset::find(sample(), BLOCK).unwrap();
    let vertices = record["plan"]["vertices"].as_array().unwrap();
    for q in &drawing.vertices {
        let near = |p: &Value| {
            let [x, y] = [&p[0], &p[1]].map(|x| x.as_f64().unwrap());
            (x - q.x).hypot(y - q.y) < 1e-3
        };
        assert!(vertices.iter().any(near), "{q}");
    }
}

#[test]
fn lift_runs_alone() {
    let out = output_dir("solid-lift").join("lift.json");
    let block = of_sample(BLOCK);
    faceformer(["lift", &block, "--faces", "truth", "-o", text(&out)]).ok();
    let lift = json(&out);
    assert_eq!(lift["surfaces"].as_array().unwrap().len(), 19);
    assert_eq!(lift["conflicts"], serde_json::json!([]));
    let printed = faceformer(["lift", &block, "--faces", "truth"]).ok();
    assert_eq!(
        serde_json::from_str::<Value>(&printed.stdout).unwrap(),
        lift
    );
}

#[test]
fn what_cannot_be_lifted_fails_with_status_1_and_leaves_nothing() {
    let dir = output_dir("solid-refused");
    let square = dir.join("square.json");
    // A flat square is a closed wire, but shows no depth.
    let edges: Vec<Value> = [[0, 0, 1, 0], [1, 0, 1, 1], [1, 1, 0, 1], [0, 1, 0, 0]]
        .map(|[a, b, c, d]| serde_json::json!({ "points": [[a, b], [c, d]] }))
        .to_vec();
    std::fs::write(&square, serde_json::json!({ "edges": edges }).to_string()).unwrap();
    let step = dir.join("square.step");
    let run = faceformer(["solid", text(&square), "-o", text(&step)]);
    assert_eq!(run.status, 1, "{}", run.stderr);
    assert!(run.stderr.starts_with("faceformer: "), "{}", run.stderr);
    assert_eq!(
        std::fs::read_dir(&dir).unwrap().count(),
        1,
        "only the input is there"
    );
}

#[test]
fn the_faces_of_a_solid_that_cannot_be_built_can_be_kept() {
    let dir = output_dir("solid-partial");
    let [drawing, faces] = ["drawing.json", "faces.json"].map(|name| dir.join(name));
    let (content, list) = crossed_prism();
    std::fs::write(&drawing, content.to_string()).unwrap();
    std::fs::write(&faces, list.to_string()).unwrap();
    let (step, partial) = (dir.join("out.step"), dir.join("partial.brep"));
    let arguments = [
        "solid",
        text(&drawing),
        "--faces",
        text(&faces),
        "-o",
        text(&step),
    ];
    let run = faceformer(arguments);
    assert_eq!(run.status, 1, "{}", run.stderr);
    assert!(run.stderr.contains("cannot be built"), "{}", run.stderr);
    let run = faceformer([&arguments[..], &["--keep-partial", text(&partial)]].concat());
    assert_eq!(run.status, 1, "{}", run.stderr);
    let shell = std::fs::read_to_string(&partial).unwrap();
    assert!(shell.contains("CASCADE Topology V1"));
    assert!(!step.exists());
    assert_eq!(std::fs::read_dir(&dir).unwrap().count(), 3);
}

/// A drawing and faces of a prism whose base crosses itself: every face is plane and every edge
/// has two faces, but no solid has this boundary.
fn crossed_prism() -> (Value, Value) {
    let base = [(0, 0), (3, 0), (3, 2), (1, 2), (1, -1), (0, -1)];
    let seen = |z: f64| {
        base.map(|(x, y)| {
            let (x, y) = (f64::from(x), f64::from(y));
            [0.82 * x - 0.57 * y, 0.24 * x + 0.35 * y + 0.91 * z]
        })
    };
    prism(&[seen(0.0), seen(1.5)].concat())
}

#[test]
fn wrong_options_are_usage_errors() {
    let block = of_sample(BLOCK);
    let dir = output_dir("solid-usage");
    let out = dir.join("out.step");
    for further in [
        ["--scale", "0"],
        ["--scale", "nan"],
        ["--scale", "-1"],
        ["--scale", "inf"],
    ] {
        let arguments = [&["solid", &block, "-o", text(&out)], &further[..]].concat();
        assert_eq!(faceformer(&arguments).status, 2, "{further:?}");
    }
    let unknown = dir.join("out.obj");
    let run = faceformer(["solid", &block, "-o", text(&unknown)]);
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains(".step"), "{}", run.stderr);
    assert_eq!(faceformer(["solid", &block]).status, 2, "-o is required");
    assert_eq!(std::fs::read_dir(&dir).unwrap().count(), 0);
}

#[test]
fn eval_measures_solids() {
    let data = sample();
    let arguments = [
        "eval",
        text(&data),
        "--faces",
        "truth",
        "--solids",
        "--limit",
        "5",
        "--json",
    ];
    let figures: Value = serde_json::from_str(&faceformer(arguments).ok().stdout).unwrap();
    assert_eq!(figures["drawings"], 5);
    for key in ["lifted", "valid"] {
        assert_eq!(figures[key], 100.0, "{key}: {figures}");
    }
    for key in ["lift_ms_median", "solid_ms_median"] {
        assert!(figures[key].as_f64().unwrap() > 0.0, "{key}: {figures}");
    }
}

#[test]
fn render_shows_the_solid_in_a_second_panel() {
    let dir = output_dir("solid-render");
    let drawing = of_sample(WASHER);
    for name in ["washer.svg", "washer.png"] {
        let out = dir.join(name);
        let arguments = [
            "render",
            &drawing,
            "--faces",
            "truth",
            "--solid",
            "-o",
            text(&out),
        ];
        faceformer(arguments).ok();
    }
    let svg = std::fs::read_to_string(dir.join("washer.svg")).unwrap();
    assert!(svg.contains(r#"width="1440""#));
    assert!(svg.contains("2 planes, 2 cylinders, volume"));
    assert_eq!(std::fs::read_dir(&dir).unwrap().count(), 2);
}
