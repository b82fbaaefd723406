//! The faces that the default engine finds do not depend on how a drawing lies, on its size, or on
//! how its edges are numbered and drawn.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use faceformer::Progress;
use faceformer::drawing::dataset::Drawings;
use faceformer::drawing::{Curve2, Drawing, Edge};
use faceformer::identify::{EngineKind, engine};
use glam::DVec2;
use proptest::prelude::*;

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
        // Known shortcoming: the screws of bdwarehouse are long chains around one axis, which are
        // searched in the order of the edges' numbers, and in a few the numbering decides.
        let chained = |d: &Drawing| d.id.starts_with("bdwarehouse/");
        let mut small: Vec<Drawing> = all
            .filter(|d| d.edges.len() <= SMALL && !chained(d))
            .collect();
        small.iter_mut().for_each(|d| d.truth = None);
        small
    })
}

/// Lead over the next reading, log-odds, below which the numbering may decide which one is given: a
/// known shortcoming, as the search meets readings that are nearly alike in the order of numbers.
const LEAD: f64 = 0.1;

/// The faces found, each as its set of edges, and their lead over the next reading.
fn faces(drawing: &Drawing) -> (BTreeSet<Vec<usize>>, f64) {
    let found = engine(EngineKind::Rotation).identify(drawing, Progress::none());
    let found = found.expect("the sample is taken by the engine");
    let lead = found
        .alternatives
        .first()
        .map_or(f64::INFINITY, |a| -a.score);
    (found.faces.iter().map(|f| f.edge_set()).collect(), lead)
}

/// A drawing as someone else draws it.
#[derive(Debug, Clone)]
struct Variation {
    mirror: bool,
    turn: f64,
    log_scale: f64,
    shift: [f64; 2],
    /// Edges and vertices are sorted by these, one each, over and over.
    keys: Vec<u32>,
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

    /// The order of `count` things, by their keys.
    fn order(&self, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by_key(|&i| {
            let key = self.keys[i % self.keys.len()];
            (key.wrapping_mul(2 * i as u32 + 1), i)
        });
        order
    }

    /// The drawing varied, and for each of its edges the number in the original.
    fn apply(&self, drawing: &Drawing) -> (Drawing, Vec<usize>) {
        let vertices = self.order(drawing.vertices.len());
        let edges = self.order(drawing.edges.len());
        let mut number = vec![0; vertices.len()];
        for (new, &old) in vertices.iter().enumerate() {
            number[old] = new;
        }
        let edge = |&old: &usize| {
            let Edge { v, points, .. } = &drawing.edges[old];
            let mut v = v.map(|v| number[v]);
            let mut points: Vec<DVec2> = points.iter().map(|p| self.place(*p)).collect();
            if self.keys[old % self.keys.len()] % 2 == 1 {
                v.reverse();
                points.reverse();
            }
            let curve = Curve2::recognise(&points);
            Edge { v, points, curve }
        };
        let varied = Drawing {
            vertices: vertices
                .iter()
                .map(|&v| self.place(drawing.vertices[v]))
                .collect(),
            edges: edges.iter().map(edge).collect(),
            ..drawing.clone()
        };
        (varied, edges)
    }
}

fn variation() -> impl Strategy<Value = Variation> {
    (
        any::<bool>(),
        -3.0..3.0f64,
        -5.0..5.0f64,
        [-10.0..10.0f64, -10.0..10.0f64],
        proptest::collection::vec(any::<u32>(), 7..20),
    )
        .prop_map(|(mirror, turn, log_scale, shift, keys)| Variation {
            mirror,
            turn,
            log_scale,
            shift,
            keys,
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn faces_do_not_depend_on_how_a_drawing_is_drawn(
        which in any::<proptest::sample::Index>(),
        variation in variation(),
    ) {
        let drawing = which.get(small());
        let (wanted, lead) = faces(drawing);
        prop_assume!(lead > LEAD);
        let (varied, edges) = variation.apply(drawing);
        let found: BTreeSet<Vec<usize>> = faces(&varied)
            .0
            .into_iter()
            .map(|face| {
                let mut face: Vec<usize> = face.into_iter().map(|e| edges[e]).collect();
                face.sort_unstable();
                face
            })
            .collect();
        prop_assert_eq!(found, wanted, "{}", drawing.id);
    }
}
