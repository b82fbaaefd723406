//! Straight edges as lines that lead to vanishing points.

use std::f64::consts::SQRT_2;

use glam::{DVec2, DVec3};

use crate::drawing::{Curve2, Drawing};
use crate::lift::Camera;
use crate::lift::directions::AGREE;

/// Slant between a line and the way to a vanishing point, radians, that is too much whatever the
/// errors.
const SLANTED: f64 = 0.05;

/// A straight edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub(super) edge: usize,
    /// Its vertices: lines that share one are not parallel.
    pub(super) v: [usize; 2],
    pub(super) middle: DVec2,
    /// Unit direction, of no meaning of its sign.
    pub(super) direction: DVec2,
    /// Half its length.
    pub(super) half: f64,
}

/// The straight edges of a drawing, longest first, at one precision.
#[derive(Debug, Clone)]
pub(super) struct Lines {
    pub(super) all: Vec<Line>,
    /// Standard error of a coordinate, drawing units.
    pub(super) precision: f64,
    /// Half diagonal of the drawing.
    pub(super) size: f64,
    /// Elliptic arcs.
    arcs: usize,
}

impl Lines {
    pub(super) fn new(drawing: &Drawing, precision: f64) -> Self {
        let line = |(edge, e): (usize, &crate::drawing::Edge)| {
            let [a, b] = e.v.map(|v| drawing.vertices[v]);
            let length = a.distance(b);
            // Below this an edge's direction is mostly error.
            (e.is_straight() && length > 50.0 * precision).then(|| Line {
                edge,
                v: e.v,
                middle: a.midpoint(b),
                direction: (b - a) / length,
                half: length / 2.0,
            })
        };
        let mut all: Vec<Line> = drawing.edges.iter().enumerate().filter_map(line).collect();
        all.sort_by(|a, b| b.half.total_cmp(&a.half));
        let is_arc = |e: &&crate::drawing::Edge| matches!(e.curve, Curve2::Ellipse(_));
        Self {
            all,
            precision,
            size: drawing.size(),
            arcs: drawing.edges.iter().filter(is_arc).count(),
        }
    }

    /// Most votes that a reading can get.
    pub(super) fn votes(&self) -> f64 {
        (self.all.len() + 2 * self.arcs) as f64
    }

    /// How much a line says: long ones more than short ones, but less than by their length.
    pub(super) fn salience(&self, line: &Line) -> f64 {
        (2.0 * line.half / self.size).sqrt()
    }

    /// Whether a line is drawn along the direction `l`, known to `error` radians.
    pub(super) fn follows(&self, camera: &Camera, line: &Line, l: DVec3, error: f64) -> bool {
        let drawn = camera.drawn(l, line.middle);
        let length = drawn.length();
        let slant = (line.direction.perp_dot(drawn) / length).abs();
        let error = self.slant_error(line) + error / length;
        // A vanishing point is never on the edge itself.
        let beyond = match *camera {
            Camera::Parallel => true,
            Camera::Central { focal, .. } => focal * length > line.half * l.z.abs(),
        };
        length > 1e-6 && beyond && slant < (AGREE * error).min(SLANTED)
    }

    /// Standard error of a line's direction, radians.
    pub(super) fn slant_error(&self, line: &Line) -> f64 {
        self.precision / (SQRT_2 * line.half)
    }

    /// Unit normal of the plane through the camera and a line, and its error, radians.
    pub(super) fn plane(&self, camera: &Camera, line: &Line) -> (DVec3, f64) {
        let (_, ray) = camera.ray(line.middle);
        let ray = ray.normalize();
        let normal = ray.cross(line.direction.extend(0.0));
        (normal.normalize(), self.slant_error(line))
    }
}
