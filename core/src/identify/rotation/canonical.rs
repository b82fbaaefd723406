//! A drawing with its vertices and edges numbered by how they lie, so that what is found does not
//! depend on the order in which they are given.
//!
//! Where readings score alike, and in sums, the order decides. It goes by distances that turning,
//! mirroring and scaling leave alone; what is symmetric is ordered by coordinates.

use std::cmp::Ordering;

use glam::DVec2;

use crate::drawing::{CoEdge, Drawing, Edge, Graph};
use crate::identify::{Face, Identification};

/// Steps of a distance, relative to the drawing's radius, that are told apart.
const STEPS: f64 = 1e6;

/// A drawing numbered anew.
pub(super) struct Canonical {
    /// The drawing, without its truth.
    pub(super) drawing: Drawing,
    /// Vertex that each of its vertices is in the drawing as it was given.
    vertices: Vec<usize>,
    /// The same for edges.
    edges: Vec<usize>,
}

impl Canonical {
    pub(super) fn new(drawing: &Drawing, graph: &Graph) -> Self {
        let measure = Measure::new(&drawing.vertices);
        let lengths: Vec<i64> = drawing.edges.iter().map(|e| measure.length(e)).collect();
        let around = |v: usize| {
            let own = graph.leaving(v).iter().map(|c| lengths[c.edge()]);
            let mut own: Vec<i64> = own.collect();
            own.sort_unstable();
            own
        };
        let keys: Vec<(i64, Vec<i64>)> = (0..drawing.vertices.len())
            .map(|v| (measure.distance(drawing.vertices[v]), around(v)))
            .collect();
        let mut vertices: Vec<usize> = (0..keys.len()).collect();
        vertices.sort_by(|&a, &b| {
            let [p, q] = [a, b].map(|v| drawing.vertices[v]);
            keys[a].cmp(&keys[b]).then_with(|| by_place(p, q))
        });
        let mut rank = vec![0; vertices.len()];
        for (new, &old) in vertices.iter().enumerate() {
            rank[old] = new;
        }
        let ends = |e: &Edge| {
            let [a, b] = e.v.map(|v| rank[v]);
            (a.min(b), a.max(b))
        };
        let keys: Vec<_> = drawing
            .edges
            .iter()
            .zip(&lengths)
            .map(|(e, length)| (ends(e), *length, measure.distance(middle(e))))
            .collect();
        let mut edges: Vec<usize> = (0..keys.len()).collect();
        edges.sort_by(|&a, &b| {
            let [p, q] = [a, b].map(|e| middle(&drawing.edges[e]));
            keys[a].cmp(&keys[b]).then_with(|| by_place(p, q))
        });
        let drawing = drawing.renumbered(&vertices, &edges);
        Self {
            drawing: Drawing {
                truth: None,
                ..drawing
            },
            vertices,
            edges,
        }
    }

    /// What was found, with the numbers of the drawing as it was given: loops begin at their first
    /// co-edge, and faces are in the order of theirs.
    pub(super) fn as_given(&self, mut found: Identification) -> Identification {
        self.renumber(&mut found.faces);
        for other in &mut found.alternatives {
            self.renumber(&mut other.faces);
        }
        let mut vertices = vec![0.0; found.vertices.len()];
        for (&old, sure) in self.vertices.iter().zip(&found.vertices) {
            vertices[old] = *sure;
        }
        found.vertices = vertices;
        found
    }

    fn renumber(&self, faces: &mut [Face]) {
        for walk in faces.iter_mut().flat_map(|f| &mut f.loops) {
            for c in walk.iter_mut() {
                *c = CoEdge::new(self.edges[c.edge()], c.is_reversed());
            }
            let first = (0..walk.len()).min_by_key(|&k| walk[k]);
            walk.rotate_left(first.unwrap_or(0));
        }
        faces.sort_by_key(|f| f.loops.first().and_then(|walk| walk.first().copied()));
    }
}

/// Distances in steps.
struct Measure {
    center: DVec2,
    /// Steps of a unit.
    scale: f64,
}

impl Measure {
    fn new(points: &[DVec2]) -> Self {
        // Sums of sorted numbers are the same in any order.
        let mean = |of: fn(&DVec2) -> f64| {
            let mut all: Vec<f64> = points.iter().map(of).collect();
            all.sort_by(f64::total_cmp);
            all.iter().sum::<f64>() / all.len().max(1) as f64
        };
        let center = DVec2::new(mean(|p| p.x), mean(|p| p.y));
        let far = points.iter().map(|p| p.distance(center));
        let radius = far.fold(f64::MIN_POSITIVE, f64::max);
        Self {
            center,
            scale: STEPS / radius,
        }
    }

    fn distance(&self, p: DVec2) -> i64 {
        (p.distance(self.center) * self.scale).round() as i64
    }

    fn length(&self, edge: &Edge) -> i64 {
        (edge.length() * self.scale).round() as i64
    }
}

/// The middle point of an edge's polyline.
fn middle(edge: &Edge) -> DVec2 {
    let points = &edge.points;
    let n = points.len();
    points[(n - 1) / 2].midpoint(points[n / 2])
}

fn by_place(p: DVec2, q: DVec2) -> Ordering {
    p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::{EngineKind, from_truth, testing};

    /// The drawing with its edges in reverse order and its vertices shifted.
    fn renumbered(drawing: &Drawing) -> Drawing {
        let mut vertices: Vec<usize> = (0..drawing.vertices.len()).collect();
        vertices.rotate_right(3);
        let edges: Vec<usize> = (0..drawing.edges.len()).rev().collect();
        drawing.renumbered(&vertices, &edges)
    }

    fn canonical(drawing: &Drawing) -> Canonical {
        Canonical::new(drawing, &Graph::new(drawing))
    }

    #[test]
    fn the_order_given_does_not_matter() {
        for drawing in [testing::bracket(), testing::holed_cube(), testing::wedge()] {
            let plain = canonical(&drawing).drawing;
            let other = canonical(&renumbered(&drawing)).drawing;
            assert_eq!(plain.vertices, other.vertices);
            assert_eq!(plain.edges, other.edges);
        }
    }

    #[test]
    fn turning_leaves_the_order() {
        let drawing = testing::bracket();
        let turn = |p: &DVec2| DVec2::from_angle(0.7).rotate(DVec2::new(-p.x, p.y)) * 3.0 + 1.0;
        let mut turned = renumbered(&drawing);
        turned.vertices = turned.vertices.iter().map(turn).collect();
        for edge in &mut turned.edges {
            edge.points = edge.points.iter().map(turn).collect();
        }
        let (plain, other) = (canonical(&drawing), canonical(&turned));
        for (p, q) in plain.drawing.vertices.iter().zip(&other.drawing.vertices) {
            assert!(turn(p).distance(*q) < 1e-9);
        }
        let ends = |c: &Canonical| -> Vec<[usize; 2]> {
            let mut all: Vec<_> = c.drawing.edges.iter().map(|e| e.v).collect();
            all.iter_mut().for_each(|v| v.sort_unstable());
            all
        };
        assert_eq!(ends(&plain), ends(&other));
    }

    #[test]
    fn what_is_found_has_the_numbers_given() {
        let drawing = testing::holed_cube();
        let truth = from_truth(&drawing).unwrap();
        let canonical = canonical(&drawing);
        let mut new = vec![0; drawing.edges.len()];
        for (k, &old) in canonical.edges.iter().enumerate() {
            new[old] = k;
        }
        let mut found = truth.clone();
        for walk in found.faces.iter_mut().flat_map(|f| &mut f.loops) {
            walk.iter_mut()
                .for_each(|c| *c = CoEdge::new(new[c.edge()], c.is_reversed()));
        }
        found.engine = EngineKind::Rotation.name().to_owned();
        found.vertices = canonical.vertices.iter().map(|v| *v as f64).collect();
        let given = canonical.as_given(found);
        let sets = |faces: &[Face]| {
            let mut all: Vec<Vec<usize>> = faces.iter().map(Face::edge_set).collect();
            all.sort_unstable();
            all
        };
        assert_eq!(sets(&given.faces), sets(&truth.faces));
        let numbers: Vec<f64> = (0..drawing.vertices.len()).map(|v| v as f64).collect();
        assert_eq!(given.vertices, numbers);
    }
}
