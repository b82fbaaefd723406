//! Faces that may be parts of one surface.

use crate::drawing::SurfaceKind;
use crate::lift::sheet::Sheet;
use crate::sets::Sets;

/// Circles whose centres and radii differ by less than this, relative to the drawing's size, are
/// drawn as one.
const SAME_CIRCLE: f64 = 1e-4;

/// Curved faces of one kind that share an edge, or that arcs of one circle bound: an outline splits
/// a surface, and so do the walls that cut the chamfer of a nut.
pub(in crate::lift) fn touching(sheet: &Sheet<'_>) -> Vec<Vec<usize>> {
    wholes(sheet, |_, edge| edge < sheet.drawing.edges.len(), |_| true)
}

/// Cones, spheres and tori, grouped by edges that may be outlines: a circle around a known axis
/// is none, and the outlines of a cone are straight; and by circles that they share.
pub(super) fn surfaces(sheet: &Sheet<'_>) -> Vec<Vec<usize>> {
    let may_be_outline = |kind: SurfaceKind, edge: usize| match kind {
        SurfaceKind::Cone => sheet.is_straight(edge),
        SurfaceKind::Sphere | SurfaceKind::Torus => {
            !sheet.is_straight(edge) && sheet.circles[edge].is_none()
        }
        SurfaceKind::Other => sheet.circles[edge].is_none(),
        _ => false,
    };
    wholes(sheet, may_be_outline, |kind| kind != SurfaceKind::Cylinder)
}

fn wholes(
    sheet: &Sheet<'_>,
    joins: impl Fn(SurfaceKind, usize) -> bool,
    counts: impl Fn(SurfaceKind) -> bool,
) -> Vec<Vec<usize>> {
    let kind = |f: usize| sheet.faces[f].kind;
    let mut parts = Sets::new(sheet.faces.len());
    let mut circles: Vec<(usize, usize)> = Vec::new();
    for edge in 0..sheet.drawing.edges.len() {
        if let [a, b] = *sheet.neighbours(edge)
            && kind(a) == kind(b)
            && !sheet.is_planar(a)
            && joins(kind(a), edge)
        {
            parts.join(a, b);
        }
        for &f in sheet.neighbours(edge) {
            if sheet.circles[edge].is_some()
                && !matches!(kind(f), SurfaceKind::Plane | SurfaceKind::Cylinder)
            {
                circles.push((edge, f));
            }
        }
    }
    for (i, &(e, a)) in circles.iter().enumerate() {
        for &(other, b) in &circles[..i] {
            if a != b && e != other && kind(a) == kind(b) && same_circle(sheet, e, other) {
                parts.join(a, b);
            }
        }
    }
    let mut wholes: Vec<Vec<usize>> = vec![Vec::new(); sheet.faces.len()];
    for f in (0..sheet.faces.len()).filter(|&f| !sheet.is_planar(f) && counts(kind(f))) {
        wholes[parts.find(f)].push(f);
    }
    wholes.retain(|w| !w.is_empty());
    wholes
}

/// Whether two edges are arcs of one drawn circle around one axis.
fn same_circle(sheet: &Sheet<'_>, a: usize, b: usize) -> bool {
    let (Some((k, c)), Some((l, d))) = (&sheet.circles[a], &sheet.circles[b]) else {
        return false;
    };
    let near = SAME_CIRCLE * sheet.size * (c.gain + d.gain).clamp(1.0, 20.0);
    k == l && c.center.distance(d.center) < near && (c.radius - d.radius).abs() < near
}
