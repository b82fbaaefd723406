//! Surface kinds from the boundary alone.

use glam::DVec2;

use crate::drawing::{CoEdge, Drawing, SurfaceKind};

/// Sine of the angle up to which two drawn directions are parallel.
const PARALLEL: f64 = 0.01;

/// The kind of surface that a loop of co-edges most likely bounds.
///
/// Straight edges only: a plane. Curves joined by parallel lines, shifted copies of each other: a
/// cylinder; joined by lines that converge: a cone. Curves that do not fit one plane's circles: a
/// torus.
pub(crate) fn kind_of(drawing: &Drawing, walk: &[CoEdge]) -> SurfaceKind {
    let edges = |straight: bool| {
        walk.iter()
            .map(|c| &drawing.edges[c.edge()])
            .filter(move |e| e.is_straight() == straight)
    };
    let lines: Vec<DVec2> = edges(true)
        .map(|e| (e.points[e.points.len() - 1] - e.points[0]).normalize_or_zero())
        .collect();
    let curves = edges(false).count();
    if curves < 2 || lines.len() < 2 {
        return SurfaceKind::Plane;
    }
    let parallel = lines.iter().all(|d| d.perp_dot(lines[0]).abs() < PARALLEL);
    if parallel {
        SurfaceKind::Cylinder
    } else {
        SurfaceKind::Plane
    }
}
