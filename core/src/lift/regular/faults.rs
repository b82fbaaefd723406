//! What no solid has, in a draft: edges whose ends are one point, faces whose outlines cross, and
//! vertices that are all in one plane.

use glam::{DVec2, DVec3};

use super::draft::Draft;
use super::redraw::both;
use crate::scatter::Scatter;

/// Edges closer than this touch, in sizes of the drawing.
const TOUCH: f64 = 1e-7;

/// Points of a curve between two that the problem knows.
const BETWEEN: usize = 3;

/// A draft that is this many errors thick is flat.
const THIN: f64 = 0.5;

/// What is wrong in a draft.
#[derive(Debug, Clone, Default)]
pub(super) struct Faults {
    /// Straight edges whose ends are one point.
    pub(super) vanished: Vec<usize>,
    /// Planar faces of which edges cross, with the number of crossings.
    pub(super) tangled: Vec<(usize, usize)>,
    /// Whether all vertices are in one plane.
    pub(super) flat: bool,
}

impl Faults {
    pub(super) fn of(draft: &Draft<'_, '_>) -> Self {
        let drawing = draft.sheet.drawing;
        let vanished = |e: &usize| {
            let [a, b] = drawing.edges[*e].v;
            draft.sheet.is_straight(*e) && draft.place(a).distance(draft.place(b)) < TOUCH
        };
        let faces = 0..draft.sheet.faces.len();
        let tangled = faces
            .filter(|&f| draft.is_plane(draft.body_of[f]))
            .map(|f| (f, crossings(draft, f)))
            .filter(|c| c.1 > 0);
        Self {
            vanished: (0..drawing.edges.len()).filter(vanished).collect(),
            tangled: tangled.collect(),
            flat: thickness(draft) < THIN * draft.noise,
        }
    }

    /// How many things are wrong.
    pub(super) fn count(&self) -> usize {
        self.vanished.len() + self.tangled.iter().map(|t| t.1).sum::<usize>()
    }
}

/// Root of the mean squared distance of the vertices from the plane that is next to them all.
fn thickness(draft: &Draft<'_, '_>) -> f64 {
    let points: Vec<DVec3> = (0..draft.problem.points.len())
        .map(|p| draft.place(p))
        .collect();
    let scatter = Scatter::new(&points);
    let squares = scatter.normal().map_or(0.0, |n| n.dot(scatter.matrix * n));
    (squares.max(0.0) / points.len().max(1) as f64).sqrt()
}

/// Pairs of edges of a planar face that cross, touch or lie on each other.
fn crossings(draft: &Draft<'_, '_>, face: usize) -> usize {
    let dir = draft.problem.bodies[draft.body_of[face]].dir;
    let normal = draft.problem.direction(dir, &draft.problem.x);
    let (u, w) = normal.any_orthonormal_pair();
    let flat = |p: DVec3| DVec2::new(p.dot(u), p.dot(w));
    let edges = draft.sheet.edges_of(face).iter();
    let chains: Vec<([usize; 2], Vec<DVec2>)> = edges
        .filter_map(|&e| {
            let points = chain(draft, e)?.into_iter().map(flat).collect();
            Some((draft.sheet.drawing.edges[e].v, points))
        })
        .collect();
    let mut count = 0;
    for (i, a) in chains.iter().enumerate() {
        count += chains[i + 1..].iter().filter(|b| tangle(a, b)).count();
    }
    count
}

/// Points along an edge, if its curve is known.
fn chain(draft: &Draft<'_, '_>, edge: usize) -> Option<Vec<DVec3>> {
    let [from, to] = draft.sheet.drawing.edges[edge].v.map(|v| draft.place(v));
    if draft.sheet.is_straight(edge) {
        return Some(vec![from, to]);
    }
    let known = &draft.curve_points[edge];
    if known.is_empty() {
        return None;
    }
    let pair = draft
        .beside(edge)?
        .map(|b| draft.problem.surface(b, &draft.problem.x));
    let knots: Vec<DVec3> = std::iter::once(from)
        .chain(known.iter().map(|&p| draft.place(p)))
        .chain([to])
        .collect();
    let mut points = vec![from];
    for ends in knots.windows(2) {
        for i in 1..=BETWEEN {
            let at = ends[0].lerp(ends[1], i as f64 / (BETWEEN + 1) as f64);
            points.push(both(at, &pair));
        }
        points.push(ends[1]);
    }
    Some(points)
}

/// Whether two chains with these end vertices cross, touch or lie on each other elsewhere than where
/// they end in one vertex.
fn tangle((v, a): &([usize; 2], Vec<DVec2>), (w, b): &([usize; 2], Vec<DVec2>)) -> bool {
    let last = [a.len() - 2, b.len() - 2];
    for (i, p) in a.windows(2).enumerate() {
        for (j, q) in b.windows(2).enumerate() {
            // Ends of these pieces that are ends of the edges.
            let ends = |at: usize, last: usize, v: &[usize; 2]| {
                [(at == 0).then_some(v[0]), (at == last).then_some(v[1])]
            };
            let (x, y) = (ends(i, last[0], v), ends(j, last[1], w));
            let shared = (0..2)
                .flat_map(|k| (0..2).map(move |l| (k, l)))
                .find(|&(k, l)| x[k].is_some() && x[k] == y[l]);
            let wrong = match shared {
                // Neighbours may lie on each other.
                Some((k, l)) => {
                    let (s, t) = (p[1 - k] - p[k], q[1 - l] - q[l]);
                    let sine = s.perp_dot(t) / (s.length() * t.length());
                    sine.abs() < 1e-6 && s.dot(t) > 0.0
                }
                None => meet([p[0], p[1]], [q[0], q[1]]),
            };
            if wrong {
                return true;
            }
        }
    }
    false
}

/// Whether two segments cross or touch.
fn meet([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).normalize_or_zero().perp_dot(r - p);
    let across = side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
    let on = |p: DVec2, q: DVec2, r: DVec2| {
        let length = p.distance(q);
        let along = (q - p).normalize_or_zero().dot(r - p);
        side(p, q, r).abs() < TOUCH && along > -TOUCH && along < length + TOUCH
    };
    across || on(a, b, c) || on(a, b, d) || on(c, d, a) || on(c, d, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An edge between two numbered vertices.
    fn edge(v: [usize; 2], points: &[[f64; 2]]) -> ([usize; 2], Vec<DVec2>) {
        (v, points.iter().map(|&p| DVec2::from(p)).collect())
    }

    #[test]
    fn edges_that_cross_touch_or_run_back_are_tangled() {
        let base = edge([0, 1], &[[0.0, 0.0], [1.0, 0.0]]);
        let across = edge([2, 3], &[[0.5, -0.5], [0.5, 0.5]]);
        let onto = edge([2, 3], &[[0.5, 0.0], [0.5, 0.5]]);
        let back = edge([1, 2], &[[1.0, 0.0], [0.3, 0.0]]);
        let around = edge([2, 3], &[[0.2, 0.5], [0.4, -0.1], [0.6, 0.5]]);
        for other in [across, onto, back, around] {
            assert!(tangle(&base, &other) && tangle(&other, &base), "{other:?}");
        }
    }

    #[test]
    fn neighbours_and_edges_apart_are_not() {
        let base = edge([0, 1], &[[0.0, 0.0], [1.0, 0.0]]);
        let corner = edge([1, 2], &[[1.0, 0.0], [1.0, 1.0]]);
        let straight_on = edge([1, 2], &[[1.0, 0.0], [2.0, 0.0]]);
        let other_way_round = edge([0, 1], &[[0.0, 0.0], [0.5, 0.5], [1.0, 0.0]]);
        let apart = edge([2, 3], &[[0.0, 0.2], [1.0, 0.2]]);
        for other in [corner, straight_on, other_way_round, apart] {
            assert!(!tangle(&base, &other), "{other:?}");
        }
    }
}
