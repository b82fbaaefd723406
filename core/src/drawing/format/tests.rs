use glam::DVec2;
use proptest::prelude::*;

use super::super::{Drawing, DrawingError, Limits, Projection};
use super::read;

/// A triangle with the given edge list and further keys.
fn triangle(first_edge: &str, more: &str) -> String {
    format!(
        r#"{{"vertices": [[0, 0], [1, 0], [0, 1]], "edges": [{first_edge},
            {{"v": [1, 2], "points": [[1, 0], [0, 1]]}},
            {{"v": [2, 0], "points": [[0, 1], [0, 0]]}}]{more}}}"#
    )
}

const GOOD: &str = r#"{"v": [0, 1], "points": [[0, 0], [1, 0]]}"#;

fn error(text: &str) -> DrawingError {
    Drawing::from_json(text).unwrap_err()
}

#[test]
fn a_good_triangle_is_read_and_unknown_keys_are_ignored() {
    let d =
        Drawing::from_json(&triangle(GOOD, r#", "hidden": {"a": [1]}, "truth": null"#)).unwrap();
    assert_eq!((d.vertices.len(), d.edges.len()), (3, 3));
    assert!(d.edges.iter().all(|e| e.is_straight()));
    assert_eq!(d.projection, Projection::Orthographic);
}

#[test]
fn numbers_that_are_not_finite_name_their_edge_or_vertex() {
    for number in ["null", "NaN", "Infinity", "-Infinity", "1e999"] {
        let edge = format!(r#"{{"v": [0, 1], "points": [[0, 0], [{number}, 0]]}}"#);
        assert_eq!(
            error(&triangle(&edge, "")),
            DrawingError::NotFinite { edge: 1 },
            "{number}"
        );
        let vertices = format!(r#"{{"vertices": [[0, 0], [1, {number}]], "edges": []}}"#);
        assert_eq!(
            error(&vertices),
            DrawingError::VertexNotFinite { vertex: 1 },
            "{number}"
        );
        let truth = format!(r#", "truth": {{"faces": [], "directions": [[{number}, 0, 0]]}}"#);
        assert!(
            matches!(error(&triangle(GOOD, &truth)), DrawingError::Truth(_)),
            "{number}"
        );
    }
}

#[test]
fn garbage_is_a_format_error() {
    for text in [
        "",
        "garbage",
        "[]",
        "{}",
        "{\"edges\": 3}",
        "{\"edges\": [3]}",
        "{\"edges\": [{\"name\": \"a\"}]}",
        "{\"edges\": [[[0, 0, 0], [1, 1, 1]]]}",
        "{\"edges\": [], \"edges\": []}",
        "{\"edges\": [[[0,0],[1,0]]]} {}",
        "\u{0}\u{1}\u{fffd}",
        &"[".repeat(100_000),
    ] {
        let e = read(text, &Limits::default()).unwrap_err();
        assert!(matches!(e, DrawingError::Format(_)), "{text:.40}: {e:?}");
    }
    let message = error(&triangle(
        r#"{"v": [0, 1], "points": [[0, 0], ["a", 0]]}"#,
        "",
    ))
    .to_string();
    assert!(message.contains("edge 1"), "{message}");
}

#[test]
fn an_empty_list_is_refused() {
    assert_eq!(
        error(r#"{"vertices": [], "edges": []}"#),
        DrawingError::Empty
    );
    assert_eq!(
        read(r#"{"edges": []}"#, &Limits::default()).unwrap_err(),
        DrawingError::Empty
    );
}

#[test]
fn limits_stop_the_reading() {
    let limits = Limits {
        edges: 2,
        points: 3,
        total_points: 4,
    };
    let what = |text: &str| match read(text, &limits).unwrap_err() {
        DrawingError::TooLarge { what, .. } => what,
        e => panic!("{e:?}"),
    };
    // Each text breaks off right behind what is too much: nothing after it is read.
    assert_eq!(what(r#"{"edges": [[],[],[] broken"#), "edges");
    assert_eq!(
        what(r#"{"vertices": [[0,0],[0,0],[0,0],[0,0],[0,0] broken"#),
        "vertices"
    );
    assert_eq!(
        what(r#"{"edges": [[[0,0],[1,0],[0,0],[1,0] broken"#),
        "points in one edge"
    );
    assert_eq!(
        what(r#"{"edges": [[[0,0],[1,0],[0,1]],[[0,0],[1,0]] broken"#),
        "points"
    );
}

#[test]
fn a_million_edges_are_refused_at_once() {
    let edge = r#"{"name": "Edge", "points": [[0, 0], [1, 0]]},"#;
    let mut text = format!(r#"{{"edges": [{}"#, edge.repeat(1_000_000));
    text.pop();
    text.push_str("]}");
    let start = std::time::Instant::now();
    assert!(matches!(
        read(&text, &Limits::default()),
        Err(DrawingError::TooLarge { what: "edges", .. })
    ));
    assert!(start.elapsed().as_millis() < 500);
}

#[test]
fn edges_must_fit_their_vertices() {
    let edge = |text: &str| error(&triangle(text, ""));
    assert!(matches!(
        edge(r#"{"v": [0, 3], "points": [[0, 0], [1, 0]]}"#),
        DrawingError::NoSuchVertex {
            edge: 1,
            vertex: 3,
            vertices: 3
        }
    ));
    assert!(matches!(
        edge(r#"{"v": [0, 1], "points": [[0, 0], [1.001, 0]]}"#),
        DrawingError::EndMismatch {
            edge: 1,
            vertex: 1,
            ..
        }
    ));
    assert_eq!(
        edge(r#"{"points": [[0, 0], [1, 0]]}"#),
        DrawingError::NoVertices { edge: 1 }
    );
    for points in ["[]", "[[0, 0]]", "[[0, 0], [0, 0]]"] {
        assert_eq!(
            edge(&format!(r#"{{"v": [0, 0], "points": {points}}}"#)),
            DrawingError::ZeroLength { edge: 1 },
            "{points}"
        );
    }
    let unused =
        r#"{"vertices": [[0,0],[1,0],[5,5]], "edges": [{"v":[0,1],"points":[[0,0],[1,0]]}]}"#;
    assert_eq!(error(unused), DrawingError::UnusedVertex { vertex: 2 });
}

#[test]
fn ends_within_tolerance_are_moved_onto_their_vertices() {
    let d = Drawing::from_json(&triangle(
        r#"{"v": [0, 1], "points": [[0, 0], [1.00002, 0]]}"#,
        "",
    ))
    .unwrap();
    assert_eq!(d.edges[0].points[1], d.vertices[1]);
}

#[test]
fn sizes_beyond_doubles_are_refused() {
    for k in ["1e100", "1e-100"] {
        let text = format!(
            r#"{{"vertices": [[0,0],[{k},0]], "edges": [{{"v":[0,1],"points":[[0,0],[{k},0]]}}]}}"#
        );
        assert!(matches!(error(&text), DrawingError::Scale { .. }), "{k}");
    }
}

#[test]
fn truth_must_fit_the_drawing() {
    let good =
        r#"{"type": "plane", "loops": [[1, 2, 3]]}, {"type": "plane", "loops": [[-3, -2, -1]]}"#;
    let with = |faces: &str, more: &str| {
        Drawing::from_json(&triangle(
            GOOD,
            &format!(r#", "truth": {{"faces": [{faces}]{more}}}"#),
        ))
    };
    let d = with(good, r#", "vertices3d": [[0,0,0],[1,0,0],[0,1,0]]"#).unwrap();
    assert_eq!(d.truth.unwrap().faces.len(), 2);
    for (faces, more) in [
        (r#"{"type": "plane", "loops": [[1, 2, 4]]}"#, ""),
        (r#"{"type": "plane", "loops": [[1, 2, 0]]}"#, ""),
        (r#"{"type": "plane", "loops": [[1, 3, 2]]}"#, ""),
        (r#"{"type": "plane", "loops": []}"#, ""),
        (r#"{"type": "plane", "loops": [[1, 2, 3]]}"#, ""),
        (
            r#"{"type": "plane", "loops": [[1, 2, 3]]}, {"type": "plane", "loops": [[1, 2, 3]]}"#,
            "",
        ),
        (r#"{"type": "pyramid", "loops": [[1, 2, 3]]}"#, ""),
        (good, r#", "vertices3d": [[0,0,0]]"#),
        (good, r#", "edges3d": [[[0,0,0],[1,0,0]]]"#),
        (good, r#", "edges3d": [[[0,0,0]], [[0,0,0]], [[0,0,0]]]"#),
        (good, r#", "directions": [[1,0,0]]"#),
    ] {
        let e = with(faces, more).unwrap_err();
        assert!(matches!(e, DrawingError::Truth(_)), "{faces} {more}: {e:?}");
    }
}

#[test]
fn corpus_round_trips_exactly() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../tests/corpus/sample.jsonl.zst"
    );
    for drawing in super::super::dataset::Drawings::open(path).unwrap() {
        let drawing = drawing.unwrap();
        assert_eq!(
            Drawing::from_json(&drawing.to_json()).unwrap(),
            drawing,
            "{}",
            drawing.id
        );
    }
}

proptest! {
    #[test]
    fn any_double_round_trips(xs in prop::collection::vec(-1e6..1e6f64, 4), scale in -30i32..30) {
        let p = |x: f64, y: f64| DVec2::new(x, y) * 10f64.powi(scale);
        let vertices = vec![p(xs[0], xs[1]), p(xs[2], xs[3])];
        let text = serde_json::json!({
            "vertices": vertices,
            "edges": [{"v": [0, 1], "points": vertices}],
        });
        if let Ok(d) = Drawing::from_json(&text.to_string()) {
            prop_assert_eq!(&d.vertices, &vertices);
            prop_assert_eq!(Drawing::from_json(&d.to_json()).unwrap(), d);
        }
    }

    #[test]
    fn no_text_panics(text in "\\PC{0,80}", cut in 0usize..400) {
        let _ = read(&text, &Limits::default());
        let whole = triangle(GOOD, r#", "truth": {"faces": [{"type": "plane", "loops": [[1, 2, 3]]}]}"#);
        let _ = read(whole.get(..cut).unwrap_or(""), &Limits::default());
    }
}
