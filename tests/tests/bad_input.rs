//! Bad input on the command line: refused with status 2 and a plain reason, nothing half-written.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use faceformer_tests::{Run, faceformer, output_dir, sample};

/// Runs `identify` on a text and returns the reason of the refusal.
fn refusal(text: &str) -> String {
    let run = Run::with_input(["identify", "-"], text.as_bytes());
    assert_eq!(run.status, 2, "{}", run.stderr);
    assert_eq!(run.stdout, "");
    let reason = run.stderr.trim_end().to_owned();
    assert!(reason.starts_with("faceformer: "), "{reason}");
    assert_eq!(reason.lines().count(), 1, "{reason}");
    reason
}

/// A plain edge list of polylines.
fn edges(polylines: &[&str]) -> String {
    let edges: Vec<String> = (1..)
        .zip(polylines)
        .map(|(k, points)| format!(r#"{{"name":"Edge{k}","points":{points}}}"#))
        .collect();
    format!(r#"{{"edges":[{}]}}"#, edges.join(","))
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn garbage_is_no_drawing() {
    for text in [
        "",
        "{",
        "[1,2",
        "null",
        "7",
        "\"edges\"",
        "{}",
        "\u{0}\u{1}",
        "<svg/>",
    ] {
        refusal(text);
    }
    let run = Run::with_input(["check", "-"], b"\xff\xfe\x00");
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains("UTF-8"), "{}", run.stderr);
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    for number in ["NaN", "Infinity", "-Infinity", "1e999", "null", "\"1\""] {
        refusal(&edges(&[&format!("[[0,0],[{number},1]]"), "[[0,0],[1,1]]"]));
    }
}

#[test]
fn a_drawing_without_edges_is_refused() {
    let reason = refusal(r#"{"edges":[]}"#);
    assert!(reason.contains("no edges"), "{reason}");
    refusal(r#"{"vertices":[],"edges":[]}"#);
}

#[test]
fn an_open_wire_is_named() {
    let wire = edges(&["[[0,0],[1,0]]", "[[1,0],[1,1]]", "[[1,1],[0,1]]"]);
    let reason = refusal(&wire);
    assert!(reason.contains("Edge1"), "{reason}");
    assert!(reason.contains("faceformer check"), "{reason}");
    // `check` reports everything that is wrong, and fails all the same.
    let run = Run::with_input(["check", "-"], wire.as_bytes());
    assert_eq!(run.status, 2);
    assert_eq!(run.stdout.matches("error: ").count(), 2, "{}", run.stdout);
    assert!(run.stdout.contains("Edge3"), "{}", run.stdout);
}

#[test]
fn lines_that_cross_without_a_vertex_do_not_meet() {
    let reason = refusal(&edges(&["[[0,0],[2,2]]", "[[0,2],[2,0]]"]));
    assert!(reason.contains("Edge1"), "{reason}");
}

#[test]
fn a_million_edges_are_refused_by_the_limit() {
    let mut text = String::from(r#"{"edges":["#);
    for i in 0..1_000_000 {
        let comma = if i == 0 { "" } else { "," };
        write!(text, r#"{comma}{{"points":[[{i},0],[{i},1]]}}"#).unwrap();
    }
    text.push_str("]}");
    let reason = refusal(&text);
    assert!(reason.contains("limit"), "{reason}");
}

#[test]
fn an_edge_that_names_a_missing_vertex_is_named() {
    let reason =
        refusal(r#"{"vertices":[[0,0],[1,0]],"edges":[{"v":[0,5],"points":[[0,0],[1,0]]}]}"#);
    assert!(reason.contains("vertex 5"), "{reason}");
}

#[test]
fn unknown_names_are_usage_errors() {
    let data = sample();
    let data = text(&data);
    let block = format!("{data}#mfcad/00841#o0");
    let nobody = format!("{data}#nobody");
    let cases: &[(&[&str], &str)] = &[
        (&[], "Usage"),
        (&["dance"], "dance"),
        (&["identify", "no-such-file.json"], "no-such-file.json"),
        (&["identify", &nobody], "nobody"),
        (&["identify", data], "#ID"),
        (&["identify", &block, "--engine", "magic"], "magic"),
        (&["eval", "no-such-file.jsonl"], "no-such-file.jsonl"),
        (&["eval", data, "--shapes", "cubes"], "cubes"),
        (
            &["eval", data, "--limit", "0", "--faces", "truth"],
            "no drawing",
        ),
        (&["eval", data, "--faces", "faces.json"], "--faces truth"),
        (&["render", &block, "-o", "picture.gif"], ".svg or .png"),
        (
            &["render", &block, "-o", "picture.svg", "--width", "1"],
            "width",
        ),
        (
            &[
                "render", &block, "-o", "p.svg", "--faces", "truth", "--engine", "varley",
            ],
            "cannot be used with",
        ),
    ];
    for (arguments, word) in cases {
        let run = faceformer(*arguments);
        assert_eq!(run.status, 2, "{arguments:?}: {}", run.stderr);
        assert!(run.stderr.contains(word), "{arguments:?}: {}", run.stderr);
    }
}

#[test]
fn faces_that_do_not_fit_are_refused() {
    let dir = output_dir("bad-faces");
    let block = format!("{}#mfcad/00841#o0", sample().display());
    let svg: PathBuf = dir.join("picture.svg");
    for (name, content, word) in [
        ("garbage.json", "faces", "not a faces file"),
        (
            "edge.json",
            r#"{"faces":[{"type":"plane","loops":[[1,2,999]]}]}"#,
            "999",
        ),
        (
            "open.json",
            r#"{"faces":[{"type":"plane","loops":[[1]]}]}"#,
            "face 1",
        ),
    ] {
        let file = dir.join(name);
        std::fs::write(&file, content).unwrap();
        let run = faceformer(["render", &block, "--faces", text(&file), "-o", text(&svg)]);
        assert_eq!(run.status, 2, "{}", run.stderr);
        assert!(run.stderr.contains(word), "{}", run.stderr);
    }
    assert!(!svg.exists());
}

#[test]
fn without_truth_there_are_no_true_faces() {
    let square = edges(&[
        "[[0,0],[1,0]]",
        "[[1,0],[1,1]]",
        "[[1,1],[0,1]]",
        "[[0,1],[0,0]]",
    ]);
    let dir = output_dir("bad-truth");
    let svg = dir.join("picture.svg");
    let arguments = ["render", "-", "--faces", "truth", "-o", text(&svg)];
    let run = Run::with_input(arguments, square.as_bytes());
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains("no truth"), "{}", run.stderr);
    let left: Vec<_> = std::fs::read_dir(&dir).unwrap().collect();
    assert!(left.is_empty(), "{left:?}");
    let data = dir.join("data.jsonl");
    let line =
        r#"{"id":"a","vertices":[[0,0],[1,0]],"edges":[{"v":[0,1],"points":[[0,0],[1,0]]}]}"#;
    std::fs::write(&data, line).unwrap();
    let run = faceformer(["eval", text(&data)]);
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains("\"a\""), "{}", run.stderr);
}

#[test]
fn output_that_cannot_be_written_is_known_before_the_work() {
    let block = format!("{}#mfcad/00841#o0", sample().display());
    let dir = output_dir("bad-output");
    let folder = dir.join("folder.svg");
    std::fs::create_dir(&folder).unwrap();
    for target in [dir.join("missing/picture.svg"), folder] {
        let run = faceformer(["render", &block, "-o", text(&target)]);
        assert_eq!(run.status, 2, "{}", run.stderr);
        assert!(run.stderr.contains("cannot be written"), "{}", run.stderr);
    }
}
