//! What a loop looks like in the drawing.
//!
//! The drawing of a planar face is an affine image of the face, so what no flat outline does, no
//! planar face's drawing does either: its edges do not turn back on themselves where they meet
//! (curved faces do so at their silhouettes), its circles are drawn as ellipses of one shape and
//! direction, and its lines are not all drawn along the axis of one of its circles.

use glam::DVec2;

use crate::drawing::{CoEdge, Curve2, Drawing, Edge, EllipseArc, SurfaceKind};

/// Sine of the angle up to which two drawn lines are parallel.
const PARALLEL: f64 = 0.01;

/// Sine of the angle up to which two edges leave a vertex the same way, for tangents that are known
/// and for those of polylines.
const CUSP: f64 = 0.015;
const VAGUE_CUSP: f64 = 0.06;

/// Uncertainty from which an arc's ellipse tells nothing.
const VAGUE: f64 = 0.02;

/// Distance from an ellipse, relative to its major axis, up to which a point is on it.
const ON: f64 = 5e-3;

/// Distance from an ellipse, relative to its chord, up to which a curve may be meant as an arc.
const NEAR: f64 = 2.5e-4;

/// Ratio of an ellipse's axes from which it is a circle as drawn.
const ROUND: f64 = 0.9995;

/// A loop as drawn.
#[derive(Debug, Clone, Default)]
pub(super) struct Look {
    /// Straight edges.
    pub(super) lines: usize,
    /// Curved edges.
    pub(super) curves: usize,
    /// Curved edges that are no ellipses.
    pub(super) bends: usize,
    /// Whether there are lines of two directions.
    pub(super) spread: bool,
    /// Whether it is one closed edge that is no ellipse.
    closed_bend: bool,
    /// Whether all edges lie on one ellipse and go around it once.
    pub(super) ring: bool,
    /// Corners where the edges leave the same way.
    cusps: usize,
    /// Edges (from 0) that are silhouettes, as cusps at their ends tell.
    pub(super) silhouettes: Vec<usize>,
    /// Whether the ellipses are of more than one shape.
    unlike: bool,
    /// Whether a line follows the axis of a circle.
    along_axis: bool,
    /// Whether lines of two directions converge between ellipses of one shape but not one centre.
    tapered: bool,
    /// Whether an edge is drawn as a circle, as a sphere's silhouette is.
    round: bool,
    /// Whether it is two parallel lines between a curve and its shifted copy.
    swept: bool,
    /// Whether all its curves are near to ellipses.
    elliptic: bool,
    /// Whether it is two ellipses that touch at both ends, as no two circles of one plane do.
    lens: bool,
}

impl Look {
    pub(super) fn new(drawing: &Drawing, walk: &[CoEdge]) -> Self {
        let mut look = Self::default();
        let mut directions: Vec<DVec2> = Vec::new();
        let mut ellipses: Vec<EllipseArc> = Vec::new();
        let mut sweep = 0.0;
        for c in walk {
            let edge = &drawing.edges[c.edge()];
            match edge.curve {
                Curve2::Line => {
                    look.lines += 1;
                    let d = edge.points[edge.points.len() - 1] - edge.points[0];
                    directions.push(d.normalize_or_zero());
                }
                Curve2::Ellipse(arc) => {
                    look.curves += 1;
                    sweep += arc.sweep.abs();
                    ellipses.push(arc);
                }
                Curve2::Polyline => {
                    look.curves += 1;
                    look.bends += 1;
                }
            }
        }
        let parallel = |a: DVec2, b: DVec2| a.perp_dot(b).abs() < PARALLEL;
        look.spread = directions.iter().any(|d| !parallel(*d, directions[0]));
        let mut ends: Vec<usize> = Vec::new();
        for (a, b) in corners(walk).filter(|&(a, b)| cusp(drawing, a, b)) {
            look.cusps += 1;
            ends.extend(silhouette(drawing, a, b));
        }
        // A curve may touch another one at one of its ends in space, as on a chamfered nut.
        ends.sort_unstable();
        let runs = ends.chunk_by(|a, b| a == b);
        look.silhouettes = runs
            .filter(|r| r.len() > 1 || drawing.edges[r[0]].is_straight())
            .map(|r| r[0])
            .collect();
        let sure: Vec<&EllipseArc> = ellipses.iter().filter(|a| a.uncertainty < VAGUE).collect();
        look.round = sure.iter().any(|a| a.ratio > ROUND);
        // Lines of a cylinder all follow its axis; a plane's steepest line is drawn like the axis.
        look.along_axis = !look.spread
            && sure.iter().any(|arc| {
                arc.ratio < ROUND
                    && directions
                        .iter()
                        .any(|d| d.dot(arc.major).abs() < PARALLEL * arc.major.length())
            });
        let surest = ellipses
            .iter()
            .min_by(|a, b| a.uncertainty.total_cmp(&b.uncertainty));
        // A short arc on another one's ellipse is of that one, whatever its own ellipse.
        look.unlike = surest.is_some_and(|whole| {
            walk.iter().map(|c| &drawing.edges[c.edge()]).any(|edge| {
                matches!(edge.curve, Curve2::Ellipse(arc)
                    if arc.uncertainty < VAGUE
                        && !alike(&arc, whole)
                        && !on_ellipse(whole, &edge.points))
            })
        });
        let one_ellipse = surest.is_some_and(|arc| {
            let mut points = walk.iter().map(|c| &drawing.edges[c.edge()].points);
            points.all(|p| on_ellipse(arc, p))
        });
        look.ring = look.lines == 0
            && look.bends == 0
            && (sweep - std::f64::consts::TAU).abs() < 0.05
            && one_ellipse;
        look.tapered = look.spread
            && look.lines == 2
            && look.curves == 2
            && sure.len() == 2
            && alike(sure[0], sure[1])
            && !same_center(sure[0], sure[1])
            && sure[0].center.distance(sure[1].center) > 0.0
            && {
                // Along the axis of both.
                let d = (sure[1].center - sure[0].center).normalize_or_zero();
                sure[0].ratio < ROUND
                    && d.dot(sure[0].major).abs()
                        < (PARALLEL + 2.0 * sure[0].uncertainty) * sure[0].major.length()
            };
        look.elliptic = walk
            .iter()
            .all(|c| nearly_elliptic(&drawing.edges[c.edge()]));
        look.swept = !look.spread && swept(drawing, walk);
        look.closed_bend = walk.len() == 1 && look.bends == 1;
        look.lens = ellipses.len() == 2
            && walk.len() == 2
            && !one_ellipse
            && corners(walk).all(|(a, b)| {
                drawing.tangent(a.mate()).perp_dot(drawing.tangent(b)).abs() < VAGUE_CUSP
            });
        look
    }

    /// Whether the loop bounds no planar face, as far as it tells alone.
    ///
    /// Edges of a flat outline may touch as well: with lines of several directions they do.
    pub(super) fn is_curved(&self) -> bool {
        let outline = self.spread && self.lines > 2;
        (self.cusps > 0 && !outline)
            || self.unlike
            || self.along_axis
            || self.tapered
            || self.lens
            || self.closed_bend
            || self.swept
    }

    /// How much the loop looks like a planar face's, to choose between neighbours.
    pub(super) fn flatness(&self) -> f64 {
        let lines = match (self.spread, self.lines) {
            (true, 3..) => 3.0,
            (true, _) => 1.5,
            (false, 0) => 0.0,
            (false, _) => 0.5,
        };
        let ring = if self.ring { 1.0 } else { 0.0 };
        lines + ring - 0.5 * f64::from(self.bends.min(4) as u32)
    }

    /// The kind of surface by the loop alone.
    pub(super) fn kind(&self) -> SurfaceKind {
        if self.is_curved() {
            self.curved_kind()
        } else {
            SurfaceKind::Plane
        }
    }

    /// The kind of surface if it is no plane: lines that are parallel rule a cylinder, or sweep a
    /// curve that is no circle; others rule a cone; without lines it is a sphere if drawn round, else a torus.
    pub(super) fn curved_kind(&self) -> SurfaceKind {
        match (self.lines, self.spread) {
            (2, false) if self.swept && !self.elliptic => SurfaceKind::Other,
            (1.., false) => SurfaceKind::Cylinder,
            (2, true) => SurfaceKind::Cone,
            (0, _) if self.round => SurfaceKind::Sphere,
            (0, _) => SurfaceKind::Torus,
            _ => SurfaceKind::Other,
        }
    }
}

fn corners(walk: &[CoEdge]) -> impl Iterator<Item = (CoEdge, CoEdge)> + '_ {
    let next = walk.iter().cycle().skip(1);
    walk.iter().copied().zip(next.copied())
}

/// Whether a loop is a line, a curve, a line and a curve, and one curve is the other one shifted.
fn swept(drawing: &Drawing, walk: &[CoEdge]) -> bool {
    let &[a, b, c, d] = walk else {
        return false;
    };
    let straight = |c: CoEdge| drawing.edges[c.edge()].is_straight();
    let (p, q) = match [a, b, c, d].map(straight) {
        [true, false, true, false] => (b, d),
        [false, true, false, true] => (a, c),
        _ => return false,
    };
    // Walked opposite ways around the loop.
    let walked = |c: CoEdge, reversed: bool| {
        let mut points = drawing.edges[c.edge()].points.clone();
        if c.is_reversed() != reversed {
            points.reverse();
        }
        points
    };
    let (p, q) = (walked(p, false), walked(q, true));
    let shift = q[0] - p[0];
    let chord = p[0].distance(p[p.len() - 1]);
    let limit = 5e-3 * chord;
    let bulge = |l: &[DVec2]| l[l.len() / 2] - (l[0] + l[l.len() - 1]) / 2.0;
    (p[p.len() - 1] + shift).distance(q[q.len() - 1]) < limit
        && p.len() == q.len()
        && bulge(&p).distance(bulge(&q)) < limit
}

/// Whether a walk turns back where it goes from one edge to another.
fn cusp(drawing: &Drawing, from: CoEdge, to: CoEdge) -> bool {
    if from == to || from == to.mate() {
        return false;
    }
    let (a, b) = (&drawing.edges[from.edge()], &drawing.edges[to.edge()]);
    if a.is_straight() && b.is_straight() {
        return false;
    }
    let (back, ahead) = (drawing.tangent(from.mate()), drawing.tangent(to));
    let vague = [a, b].iter().any(|e| matches!(e.curve, Curve2::Polyline));
    let limit = if vague { VAGUE_CUSP } else { CUSP };
    back.dot(ahead) > 0.0 && back.perp_dot(ahead).abs() < limit
}

/// Of two edges that leave a vertex the same way the one that is a silhouette: the other one bounds
/// the surface, and is tangent to the silhouette where this ends. A silhouette is a line on
/// cylinders and cones, round on a sphere, and no ellipse on a torus.
fn silhouette(drawing: &Drawing, from: CoEdge, to: CoEdge) -> Option<usize> {
    let rank = |c: CoEdge| match drawing.edges[c.edge()].curve {
        Curve2::Line => 3,
        Curve2::Polyline => 2,
        Curve2::Ellipse(arc) if arc.ratio > ROUND => 1,
        Curve2::Ellipse(_) => 0,
    };
    match rank(from).cmp(&rank(to)) {
        std::cmp::Ordering::Greater => Some(from.edge()),
        std::cmp::Ordering::Less => Some(to.edge()),
        std::cmp::Ordering::Equal => None,
    }
}

/// Whether two ellipses may be circles in parallel planes.
fn alike(a: &EllipseArc, b: &EllipseArc) -> bool {
    let width = 0.01 + 3.0 * (a.uncertainty + b.uncertainty);
    let turn = a.major.perp_dot(b.major).abs() / (a.major.length() * b.major.length());
    let flatness = 1.0 - a.ratio.max(b.ratio);
    (a.ratio - b.ratio).abs() < width && turn * flatness < width
}

fn same_center(a: &EllipseArc, b: &EllipseArc) -> bool {
    let larger = a.major.length().max(b.major.length());
    a.center.distance(b.center) < (0.01 + 3.0 * (a.uncertainty + b.uncertainty)) * larger
}

/// Whether an edge is a line, or an ellipse as far as a part's own approximations allow.
fn nearly_elliptic(edge: &Edge) -> bool {
    match edge.curve {
        Curve2::Line | Curve2::Ellipse(_) => true,
        Curve2::Polyline => {
            let points = &edge.points;
            let noise = NEAR * points[0].distance(points[points.len() - 1]);
            matches!(Curve2::recognise_within(points, noise), Curve2::Ellipse(_))
        }
    }
}

/// Whether points lie on an ellipse.
fn on_ellipse(arc: &EllipseArc, points: &[DVec2]) -> bool {
    let near = ON * arc.major.length();
    points
        .iter()
        .all(|p| p.distance(arc.point(arc.parameter(*p))) < near)
}
