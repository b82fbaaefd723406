//! How naturally a reading of a drawing stands, to choose between readings that explain it alike.
//!
//! The drawing of a wedge fits several solids: any corner of its triangle may be the one with the
//! right angle. People draw parts upright and standing on a face, so a reading with a vertical axis
//! goes before one without, and one that stands before one that balances on an edge.

use glam::DVec3;

use super::directions::Directions;
use super::sheet::Sheet;
use crate::drawing::SurfaceKind;

/// Slant of an axis on the page, radians, within which it is drawn upright.
const UPRIGHT: f64 = 0.01;

/// Heights that differ by less than this share of the drawing's size are equal.
const LEVEL: f64 = 1e-3;

/// What speaks for a reading, the weightier first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Posture {
    /// One axis is drawn vertically on the page.
    upright: bool,
    /// The lowest vertices are the corners of a planar face that is level.
    stands: bool,
}

impl Posture {
    /// The posture of a lifted reading. Heights and directions reversed together have the same.
    pub(super) fn of(sheet: &Sheet<'_>, height: impl Fn(usize) -> f64) -> Self {
        let axes = sheet.directions.axes.iter().map(|a| a.direction);
        let Some(up) = axes.max_by(|a, b| steepness(*a).total_cmp(&steepness(*b))) else {
            return Self {
                upright: false,
                stands: false,
            };
        };
        let up = if up.y < 0.0 { -up } else { up };
        let vertices = sheet.drawing.vertices.iter().enumerate();
        let heights: Vec<f64> = vertices
            .map(|(v, p)| sheet.place(*p, height(v)).dot(up))
            .collect();
        let bottom = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let low = bottom + LEVEL * sheet.size;
        let faces = sheet.faces.iter().zip(&sheet.corners);
        Self {
            upright: steepness(up) > UPRIGHT.cos(),
            stands: faces
                .filter(|(face, corners)| face.kind == SurfaceKind::Plane && !corners.is_empty())
                .any(|(_, corners)| corners.iter().all(|&v| heights[v] < low)),
        }
    }
}

/// How close to vertical an axis is drawn: 1 if it is.
fn steepness(axis: DVec3) -> f64 {
    axis.y.abs() / axis.truncate().length().max(f64::MIN_POSITIVE)
}

/// Number of edges that a reading explains.
pub(super) fn explained(directions: &Directions) -> usize {
    let edges = |a: &super::directions::Axis| a.edges.len() + a.circles.len();
    directions.axes.iter().map(edges).sum()
}
