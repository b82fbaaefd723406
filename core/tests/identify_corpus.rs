//! The engines on the sample of real drawings. The bounds are the measured figures, rounded down;
//! raise them when an engine gets better.

use faceformer::Progress;
use faceformer::drawing::dataset::Drawings;
use faceformer::drawing::{Drawing, SurfaceKind};
use faceformer::identify::metrics::{DrawingScore, Summary};
use faceformer::identify::{EngineKind, engine, from_truth, read_faces};

const SAMPLE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../tests/corpus/sample.jsonl.zst"
);

fn sample() -> Vec<Drawing> {
    Drawings::open(SAMPLE)
        .unwrap()
        .map(Result::unwrap)
        .collect()
}

fn is_polyhedron(drawing: &Drawing) -> bool {
    let faces = &drawing.truth.as_ref().unwrap().faces;
    faces.iter().all(|f| f.kind == SurfaceKind::Plane)
}

fn has_inner_loops(drawing: &Drawing) -> bool {
    let faces = &drawing.truth.as_ref().unwrap().faces;
    faces.iter().any(|f| f.loops.len() > 1)
}

fn evaluate(kind: EngineKind, drawings: &[Drawing], keep: impl Fn(&Drawing) -> bool) -> Summary {
    let engine = engine(kind);
    let scores: Vec<DrawingScore> = drawings
        .iter()
        .filter(|d| keep(d))
        .map(|d| {
            let truth = d.truth.as_ref().unwrap();
            match engine.identify(d, Progress::none()) {
                Ok(found) => DrawingScore::of(truth, &found, 0.0),
                Err(_) => DrawingScore::refused(truth),
            }
        })
        .collect();
    Summary::of(&scores)
}

#[test]
fn varley_on_polyhedra() {
    let sample = sample();
    let simple = |d: &Drawing| is_polyhedron(d) && !has_inner_loops(d);
    let found = evaluate(EngineKind::Varley, &sample, simple);
    assert_eq!((found.drawings, found.refused), (36, 0));
    assert!(found.precision >= 99.9 && found.recall >= 99.9, "{found:?}");

    let found = evaluate(EngineKind::Varley, &sample, is_polyhedron);
    assert_eq!((found.drawings, found.refused), (122, 0));
    assert!(
        found.loop_precision >= 99.6 && found.loop_recall >= 99.5,
        "{found:?}"
    );
    assert!(found.precision >= 84.0 && found.recall >= 91.0, "{found:?}");

    let found = evaluate(EngineKind::Varley, &sample, |d| !is_polyhedron(d));
    assert_eq!(found.refused, 178, "curved edges are refused");
    assert_eq!((found.precision, found.exact), (0.0, 0.0));
}

#[test]
fn shortest_on_everything() {
    let sample = sample();
    let simple = |d: &Drawing| is_polyhedron(d) && !has_inner_loops(d);
    let found = evaluate(EngineKind::Shortest, &sample, simple);
    assert!(found.precision >= 85.0 && found.recall >= 97.0, "{found:?}");
    let found = evaluate(EngineKind::Shortest, &sample, |_| true);
    assert_eq!((found.drawings, found.refused), (300, 0));
    assert!(
        found.loop_precision >= 73.0 && found.loop_recall >= 94.0,
        "{found:?}"
    );
}

#[test]
fn every_result_is_a_faces_file_that_fits_its_drawing() {
    for drawing in sample().iter().step_by(7) {
        for kind in EngineKind::ALL {
            let Ok(found) = engine(kind).identify(drawing, Progress::none()) else {
                continue;
            };
            let text = serde_json::to_string(&found).unwrap();
            assert_eq!(
                read_faces(drawing, &text).unwrap(),
                found,
                "{kind} {}",
                drawing.id
            );
        }
        let truth = from_truth(drawing).unwrap();
        let text = serde_json::to_string(&truth).unwrap();
        assert_eq!(read_faces(drawing, &text).unwrap(), truth);
        let score = DrawingScore::of(drawing.truth.as_ref().unwrap(), &truth, 0.0);
        assert!(score.exact() && score.loops_exact(), "{}", drawing.id);
        assert_eq!(score.surfaced, score.faces);
    }
}
