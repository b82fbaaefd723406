//! Ellipses in the drawing that several edges lie on.

use glam::DVec2;

use crate::drawing::{CoEdge, Curve2, Drawing, EllipseArc, Graph};

/// Distance from an ellipse, over its semi-major axis, up to which a point lies on it.
const ON: f64 = 4e-3;

/// Uncertainty beyond which an arc's ellipse is too vague to collect others.
const VAGUE: f64 = 0.05;

/// Connected edges on one ellipse: a circle of the solid that vertices divide into arcs.
#[derive(Debug, Clone)]
pub(super) struct Ring {
    /// The ellipse, from the arc that shows it best.
    pub(super) ellipse: EllipseArc,
}

/// All rings of a drawing.
#[derive(Debug, Clone)]
pub(super) struct Rings {
    rings: Vec<Ring>,
    of_edge: Vec<Option<usize>>,
}

impl Rings {
    /// Collects rings, the best known ellipses first. A short arc whose own ellipse is vague joins
    /// its neighbour's if all its points lie on it.
    pub(super) fn new(drawing: &Drawing, graph: &Graph) -> Self {
        let mut seeds: Vec<(f64, usize, EllipseArc)> = drawing
            .edges
            .iter()
            .enumerate()
            .filter_map(|(e, edge)| match edge.curve {
                Curve2::Ellipse(arc) if arc.uncertainty < VAGUE => Some((arc.uncertainty, e, arc)),
                _ => None,
            })
            .collect();
        seeds.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut rings = Self {
            rings: Vec::new(),
            of_edge: vec![None; drawing.edges.len()],
        };
        for (_, seed, ellipse) in seeds {
            if rings.of_edge[seed].is_some() {
                continue;
            }
            let ring = rings.rings.len();
            rings.rings.push(Ring { ellipse });
            rings.of_edge[seed] = Some(ring);
            let mut open = vec![seed];
            while let Some(e) = open.pop() {
                for v in drawing.edges[e].v {
                    for c in graph.leaving(v) {
                        let edge = &drawing.edges[c.edge()];
                        if rings.of_edge[c.edge()].is_none()
                            && !edge.is_straight()
                            && edge.points.iter().all(|p| is_on(&ellipse, *p))
                        {
                            rings.of_edge[c.edge()] = Some(ring);
                            open.push(c.edge());
                        }
                    }
                }
            }
        }
        rings
    }

    /// Ring of an edge.
    pub(super) fn of(&self, edge: usize) -> Option<usize> {
        self.of_edge[edge]
    }

    /// Ellipse of an edge's ring.
    pub(super) fn ellipse(&self, edge: usize) -> Option<&EllipseArc> {
        self.of_edge[edge].map(|r| &self.rings[r].ellipse)
    }

    /// Whether two rings are circles in parallel planes, up to the reversal in depth: ellipses of
    /// one shape and direction.
    pub(super) fn parallel(a: &EllipseArc, b: &EllipseArc) -> bool {
        let width = 0.01 + 2.0 * (a.uncertainty + b.uncertainty);
        // In a round ellipse the direction of the axes says nothing.
        let turn = a.major.perp_dot(b.major).abs() / (a.major.length() * b.major.length());
        let flatness = 1.0 - a.ratio.max(b.ratio);
        (a.ratio - b.ratio).abs() < width && turn * flatness < width
    }

    /// Whether a co-edge leaves its origin counter-clockwise around its ellipse.
    pub(super) fn turns_left(ellipse: &EllipseArc, origin: DVec2, tangent: DVec2) -> bool {
        ellipse.derivative(ellipse.parameter(origin)).dot(tangent) > 0.0
    }

    /// The sine of the angle between a tangent and the ellipse at a point.
    pub(super) fn slant(ellipse: &EllipseArc, origin: DVec2, tangent: DVec2) -> f64 {
        let along = ellipse.derivative(ellipse.parameter(origin));
        along.normalize_or_zero().perp_dot(tangent).abs()
    }

    /// Distance between `q` and the mirror image of `p` on the other side of the minor axis, over
    /// the major one. A surface of revolution around the circle's axis has its two silhouettes at
    /// points that mirror each other.
    pub(super) fn asymmetry(ellipse: &EllipseArc, p: DVec2, q: DVec2) -> f64 {
        let d = p - ellipse.center;
        let mirrored =
            d - ellipse.major * (2.0 * d.dot(ellipse.major) / ellipse.major.length_squared());
        (q - ellipse.center).distance(mirrored) / ellipse.major.length()
    }

    /// The co-edge with which a ring goes on beyond an end of one of its arcs; `None` if the arc
    /// ends there or the ring branches.
    pub(super) fn continuation(&self, graph: &Graph, arc: CoEdge) -> Option<CoEdge> {
        let ring = self.of(arc.edge())?;
        let mut others = graph
            .leaving(graph.origin(arc))
            .iter()
            .filter(|c| **c != arc && self.of(c.edge()) == Some(ring));
        let next = others.next().copied();
        others.next().map_or(next, |_| None)
    }
}

/// Whether a point lies on an ellipse.
fn is_on(ellipse: &EllipseArc, p: DVec2) -> bool {
    let t = ellipse.parameter(p);
    p.distance(ellipse.point(t)) < ON * ellipse.major.length()
}
