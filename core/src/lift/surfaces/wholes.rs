//! Faces that may be parts of one surface.

use crate::drawing::{Curve2, SurfaceKind};
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
        // A lone curve that is no circle is an outline, and then the surface is no cone.
        SurfaceKind::Cone => sheet.is_straight(edge) || is_lone(sheet, edge),
        SurfaceKind::Sphere | SurfaceKind::Torus => {
            !sheet.is_straight(edge) && sheet.circles[edge].is_none()
        }
        SurfaceKind::Other => sheet.circles[edge].is_none(),
        _ => false,
    };
    wholes(sheet, may_be_outline, |kind| kind != SurfaceKind::Cylinder)
}

/// Whether an edge is closed, meets no other one and is no circle around a known axis.
fn is_lone(sheet: &Sheet<'_>, edge: usize) -> bool {
    let [a, b] = sheet.drawing.edges[edge].v;
    a == b && sheet.edges_at(a).len() == 1 && sheet.circles[edge].is_none()
}

/// The kind of a whole; another one if its parts are said to be of several.
pub(super) fn kind(sheet: &Sheet<'_>, whole: &[usize]) -> SurfaceKind {
    let first = sheet.faces[whole[0]].kind;
    if whole.iter().all(|&f| sheet.faces[f].kind == first) {
        first
    } else {
        SurfaceKind::Other
    }
}

/// Whether a curve is an outline whatever the faces beside it are: they are parts of one surface then.
/// An outline leaves a circle by its tangent, and so does the circle's own arc: it is no ellipse, which
/// tells nothing in perspective.
pub(super) fn is_fold(sheet: &Sheet<'_>, edge: usize) -> bool {
    let [a, b] = sheet.drawing.edges[edge].v;
    matches!(sheet.drawing.edges[edge].curve, Curve2::Polyline)
        && sheet.circles[edge].is_none()
        && a != b
        && sheet.drawing.is_fold(edge)
}

/// Whether an edge is an outline of two faces of one kind that are not taken for one.
pub(super) fn is_outline(sheet: &Sheet<'_>, edge: usize, faces: [usize; 2]) -> bool {
    let [kind, other] = faces.map(|f| sheet.faces[f].kind);
    kind == other
        && match kind {
            // Two spheres may meet in a circle around any axis.
            SurfaceKind::Sphere => sheet.camera().is_parallel() && is_fold(sheet, edge),
            // Of surfaces of any kind one fits a part by chance, so that doubtful outlines count.
            SurfaceKind::Other => is_lone(sheet, edge) || is_fold(sheet, edge),
            _ => is_lone(sheet, edge),
        }
}

fn wholes(
    sheet: &Sheet<'_>,
    joins: impl Fn(SurfaceKind, usize) -> bool,
    counts: impl Fn(SurfaceKind) -> bool,
) -> Vec<Vec<usize>> {
    let kind = |f: usize| sheet.faces[f].kind;
    let mut parts = Sets::new(sheet.faces.len());
    let mut circles: Vec<(usize, usize)> = Vec::new();
    // Where an outline is told for sure, faces of two kinds are parts of one surface as well.
    let parts_one = |edge: usize, a: usize, b: usize| {
        if kind(a) == kind(b) {
            joins(kind(a), edge)
        } else {
            let round = counts(kind(a)) && counts(kind(b));
            round && sheet.camera().is_parallel() && is_fold(sheet, edge)
        }
    };
    for edge in 0..sheet.drawing.edges.len() {
        if let [a, b] = *sheet.neighbours(edge)
            && !sheet.is_planar(a)
            && !sheet.is_planar(b)
            && parts_one(edge, a, b)
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
