//! The same faces whatever way round a drawing is given: mirrored, turned, scaled, its vertices and
//! edges numbered anew, its edges walked the other way.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use faceformer::Progress;
use faceformer::drawing::dataset::Drawings;
use faceformer::drawing::{Curve2, Drawing, Projection};
use faceformer::identify::rotation::RotationEngine;
use faceformer::identify::{Engine, Face};
use proptest::prelude::*;

const SAMPLE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../tests/corpus/sample.jsonl.zst"
);

/// Most edges of a drawing that is tried: larger ones take long and show nothing new.
const EDGES: usize = 60;

fn sample() -> &'static [Drawing] {
    static SAMPLE_READ: OnceLock<Vec<Drawing>> = OnceLock::new();
    SAMPLE_READ.get_or_init(|| {
        let all = Drawings::open(SAMPLE).unwrap().map(Result::unwrap);
        all.filter(|d| d.edges.len() <= EDGES && d.projection == Projection::Orthographic)
            .collect()
    })
}

type Sets = Vec<Vec<usize>>;

fn sets(faces: &[Face]) -> Sets {
    let mut all: Sets = faces.iter().map(Face::edge_set).collect();
    all.sort();
    all
}

fn engine() -> RotationEngine {
    RotationEngine::with_model(Some("none"))
}

/// What is done to a drawing.
#[derive(Debug, Clone)]
struct Change {
    mirrored: bool,
    turn: f64,
    scale: f64,
    /// Keys that edges and vertices are sorted by; the low bit of an edge's turns it round.
    keys: Vec<u32>,
}

fn change() -> impl Strategy<Value = Change> {
    let keys = proptest::collection::vec(any::<u32>(), 2 * EDGES);
    (any::<bool>(), 0.0..std::f64::consts::TAU, 0.2..5.0, keys).prop_map(
        |(mirrored, turn, scale, keys)| Change {
            mirrored,
            turn,
            scale,
            keys,
        },
    )
}

/// The drawing after a change, and the new number of each edge.
fn changed(drawing: &Drawing, change: &Change) -> (Drawing, Vec<usize>) {
    let (sin, cos) = change.turn.sin_cos();
    let sign = if change.mirrored { -1.0 } else { 1.0 };
    let mut new = drawing.clone();
    new.truth = None;
    let key = |i: usize| (change.keys[i % change.keys.len()], i);
    let mut edges: Vec<usize> = (0..drawing.edges.len()).collect();
    edges.sort_by_key(|&e| key(e));
    let mut vertices: Vec<usize> = (0..drawing.vertices.len()).collect();
    vertices.sort_by_key(|&v| key(v + 7));
    let mut vertex_to = vec![0; vertices.len()];
    for (to, &from) in vertices.iter().enumerate() {
        vertex_to[from] = to;
        let p = drawing.vertices[from];
        new.vertices[to] = p;
    }
    let mut edge_to = vec![0; edges.len()];
    for (to, &from) in edges.iter().enumerate() {
        edge_to[from] = to;
        let mut edge = drawing.edges[from].clone();
        edge.v = edge.v.map(|v| vertex_to[v]);
        if key(from).0 & 1 == 1 {
            edge.v.reverse();
            edge.points.reverse();
        }
        new.edges[to] = edge;
    }
    let place = |x: f64, y: f64| {
        let x = sign * x;
        (
            change.scale * (cos * x - sin * y),
            change.scale * (sin * x + cos * y),
        )
    };
    let points = new.edges.iter_mut().flat_map(|e| e.points.iter_mut());
    for p in new.vertices.iter_mut().chain(points) {
        (p.x, p.y) = place(p.x, p.y);
    }
    for edge in &mut new.edges {
        edge.curve = if edge.points.len() == 2 {
            Curve2::Line
        } else {
            Curve2::recognise(&edge.points)
        };
    }
    (new, edge_to)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn changes_that_mean_nothing_change_nothing(
        pick in any::<proptest::sample::Index>(),
        change in change(),
    ) {
        let drawing = pick.get(sample());
        let (other, edge_to) = changed(drawing, &change);
        let engine = engine();
        let before = engine.identify(drawing, Progress::none()).unwrap();
        let after = engine.identify(&other, Progress::none()).unwrap();
        let mut expected: Sets = sets(&before.faces);
        for set in &mut expected {
            set.iter_mut().for_each(|e| *e = edge_to[*e]);
            set.sort_unstable();
        }
        expected.sort();
        let loops = |faces: &[Face]| faces.iter().map(|f| f.loops.len()).sum::<usize>();
        prop_assert_eq!(loops(&before.faces), loops(&after.faces), "{}", drawing.id);
        // Where two readings are as likely, either may be the best one.
        let found: BTreeSet<Sets> = std::iter::once(&after.faces)
            .chain(after.alternatives.iter().filter(|c| c.score > -1e-3).map(|c| &c.faces))
            .map(|f| sets(f))
            .collect();
        prop_assert!(found.contains(&expected), "{}", drawing.id);
    }
}
