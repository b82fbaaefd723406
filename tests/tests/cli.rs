//! The command `faceformer` as a user types it: drawings in, files and figures out.

use std::path::Path;

use faceformer_tests::{Run, faceformer, output_dir, sample};
use serde_json::Value;

/// A machined block of the corpus: 19 planes, 51 edges, one face with two loops.
const BLOCK: &str = "mfcad/00841#o0";

/// A washer of the corpus: two planes and two cylinders, drawn with silhouettes.
const WASHER: &str = "bdwarehouse/00107#o0";

fn of_sample(id: &str) -> String {
    format!("{}#{id}", sample().display())
}

fn read(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn json(bytes: &[u8]) -> Value {
    serde_json::from_slice(bytes)
        .unwrap_or_else(|e| panic!("{e}: {}", String::from_utf8_lossy(bytes)))
}

fn text(path: &Path) -> String {
    path.to_str().unwrap().to_owned()
}

/// One drawing of the corpus as JSON.
fn drawing_of_sample(id: &str) -> Value {
    let drawing = faceformer::drawing::dataset::find(sample(), id).unwrap();
    serde_json::from_str(&drawing.to_json()).unwrap()
}

/// Names of all files in a folder.
fn files(dir: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(dir).unwrap();
    let mut names: Vec<String> = entries
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn help_names_every_command_and_exits_with_0() {
    let run = faceformer(["--help"]).ok();
    for command in ["check", "identify", "lift", "solid", "eval", "render"] {
        assert!(run.stdout.contains(&format!("  {command} ")), "{command}");
        faceformer([command, "--help"]).ok();
    }
    assert_eq!(faceformer(["--version"]).stdout, "faceformer 0.1.0\n");
}

#[test]
fn identify_writes_faces_that_later_stages_read() {
    let dir = output_dir("cli-identify");
    let (faces, svg) = (dir.join("faces.json"), dir.join("faces.svg"));
    let block = of_sample(BLOCK);
    let run = faceformer(["identify", &block, "-o", &text(&faces)]).ok();
    assert_eq!(run.stdout, "");
    assert_eq!(files(&dir), ["faces.json"]);
    let found = json(&read(&faces));
    assert_eq!(found["engine"], "rotation");
    let printed = faceformer(["identify", &block]).ok();
    assert_eq!(json(printed.stdout.as_bytes()), found);
    faceformer([
        "render",
        &block,
        "--faces",
        &text(&faces),
        "-o",
        &text(&svg),
    ])
    .ok();
    assert!(
        String::from_utf8(read(&svg))
            .unwrap()
            .contains("(rotation)")
    );
}

#[test]
fn a_drawing_can_come_from_standard_input() {
    let square = r#"{"edges":[
        {"name":"Edge1","points":[[0,0],[1,0]]}, {"name":"Edge2","points":[[1,0],[1,1]]},
        {"name":"Edge3","points":[[1,1],[0,1]]}, {"name":"Edge4","points":[[0,1],[0,0]]}]}"#;
    let run = Run::with_input(["check", "-"], square.as_bytes()).ok();
    assert!(
        run.stdout.starts_with("4 edges (0 curved), 4 vertices"),
        "{}",
        run.stdout
    );
    let run = Run::with_input(["check", "-", "--json"], square.as_bytes()).ok();
    let report = json(run.stdout.as_bytes());
    assert_eq!(report["drawing"]["edges"].as_array().unwrap().len(), 4);
    assert_eq!(report["sources"], serde_json::json!([[0], [1], [2], [3]]));
}

#[test]
fn eval_prints_one_object_with_the_agreed_fields() {
    let data = text(&sample());
    let run = faceformer(["eval", &data, "--faces", "truth", "--limit", "7", "--json"]).ok();
    assert_eq!(run.stdout.lines().count(), 1);
    let figures = json(run.stdout.as_bytes());
    assert_eq!(figures["drawings"], 7);
    for key in [
        "precision",
        "recall",
        "type_rate",
        "exact",
        "exact_top3",
        "loop_precision",
        "loop_recall",
        "loops_exact",
    ] {
        assert_eq!(figures[key], 100.0, "{key}");
    }
    assert_eq!(figures["refused"], 0);
    for key in ["faces", "ms_median", "ms_p99"] {
        assert!(figures[key].as_f64().unwrap() >= 0.0, "{key}");
    }
}

#[test]
fn eval_counts_refused_drawings_as_zero_and_says_why() {
    let dir = output_dir("cli-eval");
    let (data, failures) = (dir.join("data.jsonl"), dir.join("failures.jsonl"));
    // Varley's engine takes straight edges only, so it refuses the washer.
    let line = drawing_of_sample(WASHER).to_string();
    std::fs::write(&data, format!("{line}\n{line}\n")).unwrap();
    let (data, failed) = (text(&data), text(&failures));
    let arguments = ["eval", &data, "--engine", "varley", "--failures", &failed];
    let run = faceformer(arguments).ok();
    assert!(
        run.stdout.contains("2 drawings, 12 faces, 2 refused"),
        "{}",
        run.stdout
    );
    assert!(run.stdout.contains("    2  identify  "), "{}", run.stdout);
    let run = faceformer([&arguments[..], &["--json"]].concat()).ok();
    let figures = json(run.stdout.as_bytes());
    assert_eq!(
        (&figures["refused"], &figures["recall"]),
        (&2.into(), &0.0.into())
    );
    let failures = String::from_utf8(read(&failures)).unwrap();
    let failed: Vec<Value> = failures.lines().map(|l| json(l.as_bytes())).collect();
    assert_eq!(failed.len(), 2);
    assert_eq!(
        (&failed[0]["id"], &failed[0]["stage"]),
        (&WASHER.into(), &"identify".into())
    );
    assert!(failed[0]["message"].as_str().unwrap().contains("straight"));
}

#[test]
fn eval_tells_of_each_drawing() {
    let rows = output_dir("cli-each").join("each.jsonl");
    let (data, each) = (text(&sample()), text(&rows));
    let run = faceformer([
        "eval", &data, "--engine", "shortest", "--each", &each, "--json",
    ])
    .ok();
    let figures = json(run.stdout.as_bytes());
    let lines = String::from_utf8(read(&rows)).unwrap();
    let rows: Vec<Value> = lines.lines().map(|l| json(l.as_bytes())).collect();
    assert_eq!(figures["drawings"], rows.len());
    let count = |key: &str| rows.iter().filter(|r| r[key] == true).count();
    let share = |key: &str| 100.0 * count(key) as f64 / rows.len() as f64;
    for key in ["exact", "exact_top3", "loops_exact"] {
        assert_eq!(figures[key], share(key), "{key}");
    }
    assert!(count("curved") > 0 && count("curved") < rows.len());
    let first = &rows[0];
    let drawing = drawing_of_sample(first["id"].as_str().unwrap());
    let edges = drawing["edges"].as_array().unwrap().len();
    assert_eq!(first["edges"], edges);
    assert!(first.get("lifted").is_none(), "{first}");
}

#[test]
fn eval_selects_shapes_by_truth() {
    let data = text(&sample());
    let drawings = |shapes: &str| {
        let run = faceformer([
            "eval", &data, "--faces", "truth", "--shapes", shapes, "--json",
        ]);
        json(run.ok().stdout.as_bytes())["drawings"]
            .as_u64()
            .unwrap()
    };
    assert_eq!(drawings("all"), 300);
    assert_eq!(drawings("polyhedra"), 122);
    assert_eq!(drawings("polyhedra-single"), 36);
    assert_eq!(drawings("planes-cylinders"), 209);
}

#[test]
fn render_writes_svg_and_png_of_the_size_asked_for() {
    let dir = output_dir("cli-render");
    let (svg, png) = (dir.join("block.svg"), dir.join("block.png"));
    let block = of_sample(BLOCK);
    let truth = [
        "render", &block, "--faces", "truth", "--width", "640", "--height", "480", "-o",
    ];
    faceformer([&truth[..], &[&text(&svg)]].concat()).ok();
    faceformer([&truth[..], &[&text(&png), "--labels", "edges"]].concat()).ok();
    let drawn = String::from_utf8(read(&svg)).unwrap();
    assert!(drawn.contains(r#"width="640" height="480""#));
    assert!(drawn.contains(">plane 19</text>"));
    assert_eq!(
        drawn.matches("fill-rule=\"evenodd\"").count(),
        19,
        "one patch a face"
    );
    assert!(
        !drawn.contains("stroke-dasharray"),
        "every edge has two faces"
    );
    let pixels = read(&png);
    assert_eq!(&pixels[..8], b"\x89PNG\r\n\x1a\n");
    assert_eq!(pixels[16..24], [0, 0, 2, 128, 0, 0, 1, 224]);
    assert_eq!(files(&dir), ["block.png", "block.svg"]);
}

#[test]
fn render_shows_each_mistake_in_its_colour() {
    let dir = output_dir("cli-render-mistakes");
    let (faces, svg) = (dir.join("faces.json"), dir.join("mistakes.svg"));
    let mut found = drawing_of_sample(BLOCK)["truth"]["faces"].clone();
    let found = found.as_array_mut().unwrap();
    found[3]["type"] = "torus".into();
    let last = found.pop().unwrap();
    found[4]["loops"]
        .as_array_mut()
        .unwrap()
        .push(last["loops"][0].clone());
    std::fs::write(&faces, serde_json::json!({ "faces": found }).to_string()).unwrap();
    let (faces, out, block) = (text(&faces), text(&svg), of_sample(BLOCK));
    let command = ["render", &block, "--mistakes", "--faces"];
    faceformer([&command[..], &[&faces, "-o", &out]].concat()).ok();
    let drawn = String::from_utf8(read(&svg)).unwrap();
    for legend in [">wrong loops 1<", ">wrong type 1<", ">missed 2<"] {
        assert!(drawn.contains(legend), "{legend}");
    }
    let patches = drawn.matches("fill-rule=\"evenodd\"").count();
    assert_eq!(patches, 4, "one patch a mistake");
    faceformer([&command[..], &["truth", &block, "-o", &out]].concat()).ok();
    let drawn = String::from_utf8(read(&svg)).unwrap();
    assert!(!drawn.contains("evenodd"), "the truth has no mistakes");
    let several = ["render", &block, &block, "-o", &out];
    let refused = faceformer(several);
    assert_eq!(refused.status, 2);
    assert!(
        refused.stderr.contains("only with --mistakes"),
        "{}",
        refused.stderr
    );
}

#[test]
fn render_marks_edges_that_miss_a_face() {
    let dir = output_dir("cli-render-open");
    let (faces, svg) = (dir.join("faces.json"), dir.join("open.svg"));
    let truth = drawing_of_sample(BLOCK)["truth"]["faces"].clone();
    let most = serde_json::json!({ "faces": truth.as_array().unwrap()[1..] });
    std::fs::write(&faces, most.to_string()).unwrap();
    let (faces, out) = (text(&faces), text(&svg));
    faceformer(["render", &of_sample(BLOCK), "--faces", &faces, "-o", &out]).ok();
    let drawn = String::from_utf8(read(&svg)).unwrap();
    let removed = truth[0]["loops"].as_array().unwrap();
    let edges: usize = removed.iter().map(|l| l.as_array().unwrap().len()).sum();
    assert_eq!(drawn.matches("stroke-dasharray").count(), edges);
}
