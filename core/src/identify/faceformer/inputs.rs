//! What the network sees of a drawing: co-edges or edges in the order of their coordinates, each as
//! points evenly along it (paper, section 4.1).

use std::cmp::Ordering;

use glam::DVec2;
use half::f16;

use super::{Frame, Variant};
use crate::drawing::{CoEdge, Drawing, Edge};

/// A drawing as the network sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct Inputs {
    /// The tokens of the drawing in their order. An edge stands there as the co-edge that begins at
    /// its lower end.
    pub coedges: Vec<CoEdge>,
    /// Coordinates, `[coedges][points][2]`, rounded to the half precision of the shards.
    pub points: Vec<f32>,
}

impl Inputs {
    /// The inputs of a network of that variant, with `points` points an edge.
    pub fn new(drawing: &Drawing, variant: Variant, frame: Frame, points: usize) -> Self {
        let coedges = match variant {
            Variant::Faceformer | Variant::Seq2seqCoedge => coedge_order(drawing),
            Variant::Seq2seq => edge_order(drawing),
        };
        let sampled = edge_points(drawing, frame, points);
        let mut all = Vec::with_capacity(coedges.len() * points * 2);
        for c in &coedges {
            let own = &sampled[c.edge() * points..][..points];
            let mut put = |p: &[f16; 2]| all.extend(p.map(f16::to_f32));
            if c.is_reversed() {
                own.iter().rev().for_each(&mut put);
            } else {
                own.iter().for_each(&mut put);
            }
        }
        Self {
            coedges,
            points: all,
        }
    }
}

/// All co-edges, lowest first: by x then y of their first points, then of their second ones, and so
/// on. What has the same points is in the order of its index.
pub fn coedge_order(drawing: &Drawing) -> Vec<CoEdge> {
    let mut order: Vec<CoEdge> = (0..2 * drawing.edges.len())
        .map(CoEdge::from_index)
        .collect();
    order.sort_by(|&a, &b| compare(drawing, a, b).then(a.cmp(&b)));
    order
}

/// All edges, lowest first; each as the lower one of its two co-edges.
pub fn edge_order(drawing: &Drawing) -> Vec<CoEdge> {
    let lower = |e: usize| {
        let c = CoEdge::new(e, false);
        match compare(drawing, c.mate(), c) {
            Ordering::Less => c.mate(),
            _ => c,
        }
    };
    let mut order: Vec<CoEdge> = (0..drawing.edges.len()).map(lower).collect();
    order.sort_by(|&a, &b| compare(drawing, a, b).then(a.cmp(&b)));
    order
}

fn compare(drawing: &Drawing, a: CoEdge, b: CoEdge) -> Ordering {
    let by = |a: f64, b: f64| a.partial_cmp(&b).unwrap_or(Ordering::Equal);
    walk(drawing, a)
        .zip(walk(drawing, b))
        .map(|(p, q)| by(p.x, q.x).then(by(p.y, q.y)))
        .find(|o| o.is_ne())
        .unwrap_or(Ordering::Equal)
}

/// The points of a co-edge in its direction. Its ends are its vertices, so that co-edges that leave
/// one vertex begin alike whatever the rounding of their polylines.
fn walk(drawing: &Drawing, c: CoEdge) -> impl Iterator<Item = DVec2> {
    let edge = &drawing.edges[c.edge()];
    let last = edge.points.len() - 1;
    (0..=last).map(move |i| {
        let i = if c.is_reversed() { last - i } else { i };
        end(drawing, edge, i).unwrap_or(edge.points[i])
    })
}

fn end(drawing: &Drawing, edge: &Edge, i: usize) -> Option<DVec2> {
    let vertex = match i {
        0 => edge.v[0],
        i if i + 1 == edge.points.len() => edge.v[1],
        _ => return None,
    };
    drawing.vertices.get(vertex).copied()
}

/// Points evenly along every edge from its first vertex to its second, `[edges][points]`.
pub fn edge_points(drawing: &Drawing, frame: Frame, points: usize) -> Vec<[f16; 2]> {
    let (centre, unit) = match frame {
        Frame::Drawn => (DVec2::ZERO, 1.0),
        Frame::Fitted => fit(drawing),
    };
    let mut all = Vec::with_capacity(drawing.edges.len() * points);
    for e in 0..drawing.edges.len() {
        let polyline: Vec<DVec2> = walk(drawing, CoEdge::new(e, false)).collect();
        let length: f64 = polyline.windows(2).map(|w| w[0].distance(w[1])).sum();
        let (mut segment, mut before) = (0, 0.0);
        for k in 0..points {
            let along = length * k as f64 / (points - 1) as f64;
            // The segment on which that point lies; the last one for the end, come what may.
            let mut own = polyline[segment].distance(polyline[segment + 1]);
            while before + own < along && segment + 2 < polyline.len() {
                before += own;
                segment += 1;
                own = polyline[segment].distance(polyline[segment + 1]);
            }
            let share = if own > 0.0 {
                ((along - before) / own).clamp(0.0, 1.0)
            } else {
                0.0
            };
            let p = polyline[segment].lerp(polyline[segment + 1], share);
            let p = (p - centre) / unit;
            all.push([p.x, p.y].map(f16::from_f64));
        }
    }
    all
}

/// Centre of the drawing's bounding box, and half its diagonal.
fn fit(drawing: &Drawing) -> (DVec2, f64) {
    let points = || drawing.edges.iter().flat_map(|e| &e.points);
    let min = points().fold(DVec2::INFINITY, |m, p| m.min(*p));
    let max = points().fold(DVec2::NEG_INFINITY, |m, p| m.max(*p));
    let size = drawing.size();
    if size > 0.0 {
        ((min + max) / 2.0, size)
    } else {
        (DVec2::ZERO, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::testing;

    #[test]
    fn coedges_are_in_the_order_of_their_points() {
        let drawing = testing::bracket();
        let order = coedge_order(&drawing);
        assert_eq!(order.len(), 36);
        let first = |c: &CoEdge| walk(&drawing, *c).next().unwrap();
        for pair in order.windows(2) {
            let (p, q) = (first(&pair[0]), first(&pair[1]));
            assert!((p.x, p.y) <= (q.x, q.y));
        }
        // All co-edges of the lowest vertex come first.
        assert_eq!(first(&order[0]), first(&order[2]));
        assert_ne!(first(&order[2]), first(&order[3]));
    }

    #[test]
    fn edges_begin_at_their_lower_ends() {
        let drawing = testing::bracket();
        let order = edge_order(&drawing);
        assert_eq!(order.len(), 18);
        for &c in &order {
            let points: Vec<DVec2> = walk(&drawing, c).collect();
            assert!(points[0].x <= points[1].x);
        }
    }

    #[test]
    fn points_are_even_and_fit_the_frame() {
        let mut drawing = testing::cube();
        // A corner in the middle of the first edge: two legs of different length.
        let [a, b] = [drawing.edges[0].points[0], drawing.edges[0].points[1]];
        let corner = a.lerp(b, 0.25);
        drawing.edges[0].points.insert(1, corner);
        let moved = |f: f64, by: DVec2| {
            let mut moved = drawing.clone();
            let points = moved.edges.iter_mut().flat_map(|e| &mut e.points);
            points
                .chain(&mut moved.vertices)
                .for_each(|p| *p = *p * f + by);
            moved
        };
        let fitted = edge_points(&drawing, Frame::Fitted, 9);
        let other = edge_points(&moved(16.0, DVec2::new(64.0, -32.0)), Frame::Fitted, 9);
        for (p, q) in fitted.iter().flatten().zip(other.iter().flatten()) {
            assert!((p.to_f32() - q.to_f32()).abs() < 1e-3);
        }
        let drawn = edge_points(&drawing, Frame::Drawn, 9);
        for (k, [x, y]) in drawn.iter().take(9).enumerate() {
            let p = a.lerp(b, k as f64 / 8.0);
            let off = DVec2::new(x.to_f64(), y.to_f64()) - p;
            assert!(off.length() < 1e-3, "{k}: {off}");
        }
    }

    #[test]
    fn a_coedge_and_its_mate_have_the_same_points_backwards() {
        let drawing = testing::wedge();
        let inputs = Inputs::new(&drawing, Variant::Faceformer, Frame::Fitted, 5);
        let points = |c: CoEdge| -> Vec<[f32; 2]> {
            let i = inputs.coedges.iter().position(|d| *d == c).unwrap();
            let own = &inputs.points[i * 10..][..10];
            own.chunks(2).map(|p| [p[0], p[1]]).collect()
        };
        for c in (0..9).map(|e| CoEdge::new(e, false)) {
            let mut back = points(c.mate());
            back.reverse();
            assert_eq!(points(c), back);
        }
    }
}
