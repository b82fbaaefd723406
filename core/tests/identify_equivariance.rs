//! How seldom the faces that the default engine finds depend on how a drawing lies and on its size, and
//! that they do not depend on how its edges are numbered.
//!
//! They should never. Where two readings are nearly alike and the drawing is moved, rounding decides.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use faceformer::Progress;
use faceformer::drawing::dataset::Drawings;
use faceformer::drawing::{Curve2, Drawing, Edge};
use faceformer::identify::{EngineKind, engine};
use glam::DVec2;

/// Most edges of the drawings that are looked at, so that many of them are.
const SMALL: usize = 60;

fn small() -> &'static [Drawing] {
    static ALL: OnceLock<Vec<Drawing>> = OnceLock::new();
    ALL.get_or_init(|| {
        let path = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../tests/corpus/sample.jsonl.zst"
        );
        let all = Drawings::open(path).unwrap().map(Result::unwrap);
        let mut small: Vec<Drawing> = all.filter(|d| d.edges.len() <= SMALL).collect();
        small.iter_mut().for_each(|d| d.truth = None);
        small
    })
}

/// The faces found, each as its set of edges.
fn faces(drawing: &Drawing) -> BTreeSet<Vec<usize>> {
    let found = engine(EngineKind::Rotation).identify(drawing, Progress::none());
    let found = found.expect("the sample is taken by the engine");
    found.faces.iter().map(|f| f.edge_set()).collect()
}

/// A drawing as someone else draws it.
#[derive(Debug, Clone)]
struct Variation {
    mirror: bool,
    turn: f64,
    log_scale: f64,
    shift: [f64; 2],
}

impl Variation {
    fn place(&self, p: DVec2) -> DVec2 {
        let p = if self.mirror {
            DVec2::new(-p.x, p.y)
        } else {
            p
        };
        DVec2::from_angle(self.turn).rotate(p) * self.log_scale.exp() + DVec2::from(self.shift)
    }

    /// The drawing varied.
    fn apply(&self, drawing: &Drawing) -> Drawing {
        let edge = |old: &Edge| {
            let points: Vec<DVec2> = old.points.iter().map(|p| self.place(*p)).collect();
            let curve = Curve2::recognise(&points);
            Edge {
                v: old.v,
                points,
                curve,
            }
        };
        let vertices = drawing.vertices.iter();
        Drawing {
            vertices: vertices.map(|v| self.place(*v)).collect(),
            edges: drawing.edges.iter().map(edge).collect(),
            ..drawing.clone()
        }
    }
}

/// A permutation of `0..n`.
fn shuffled(n: usize, seed: u64) -> Vec<usize> {
    let mut numbers: Vec<usize> = (0..n).collect();
    numbers.sort_by_key(|&k| (k as u64 + 1).wrapping_mul(seed | 1) % 1_000_003);
    numbers
}

#[test]
fn faces_do_not_depend_on_numbers() {
    let mut changed = Vec::new();
    for (i, drawing) in small().iter().enumerate() {
        let seed = 7919 * (i as u64 + 1);
        let vertices = shuffled(drawing.vertices.len(), seed);
        let old = shuffled(drawing.edges.len(), seed / 2);
        let other = drawing.renumbered(&vertices, &old);
        let as_given = |edges: &Vec<usize>| {
            let mut edges: Vec<usize> = edges.iter().map(|&e| old[e]).collect();
            edges.sort_unstable();
            edges
        };
        let found: BTreeSet<Vec<usize>> = faces(&other).iter().map(as_given).collect();
        if found != faces(drawing) {
            changed.push(&drawing.id);
        }
    }
    assert!(changed.is_empty(), "{changed:?}");
}

/// Share of the drawings whose faces may change.
const MOST: f64 = 0.03;

#[test]
fn faces_seldom_depend_on_how_a_drawing_lies() {
    let mut changed = Vec::new();
    for (i, drawing) in small().iter().enumerate() {
        let share = |k: f64| (i as f64 * k).fract();
        let variation = Variation {
            mirror: i % 2 == 1,
            turn: 6.0 * share(0.618_033_99) - 3.0,
            log_scale: 10.0 * share(0.754_877_67) - 5.0,
            shift: [20.0 * share(0.569_840_29) - 10.0, 3.0],
        };
        if faces(&variation.apply(drawing)) != faces(drawing) {
            changed.push(&drawing.id);
        }
    }
    let most = (MOST * small().len() as f64) as usize;
    assert!(
        changed.len() <= most,
        "{} changed: {changed:?}",
        changed.len()
    );
}
