//! Faces that may be parts of one surface, split by its outlines.

use crate::drawing::SurfaceKind;
use crate::lift::sheet::Sheet;

/// Cones, spheres and tori, grouped by edges that may be outlines: a circle around a known axis
/// is none, and the outlines of a cone are straight.
pub(super) fn wholes(sheet: &Sheet<'_>) -> Vec<Vec<usize>> {
    let mut root: Vec<usize> = (0..sheet.faces.len()).collect();
    let find = |root: &[usize], mut f: usize| {
        while root[f] != f {
            f = root[f];
        }
        f
    };
    for edge in 0..sheet.drawing.edges.len() {
        let [a, b] = *sheet.neighbours(edge) else {
            continue;
        };
        let kind = sheet.faces[a].kind;
        let may_be_outline = match kind {
            SurfaceKind::Cone => sheet.is_straight(edge),
            SurfaceKind::Sphere | SurfaceKind::Torus => {
                !sheet.is_straight(edge) && sheet.circles[edge].is_none()
            }
            _ => false,
        };
        if kind == sheet.faces[b].kind && may_be_outline {
            let (a, b) = (find(&root, a), find(&root, b));
            root[a.max(b)] = a.min(b);
        }
    }
    let mut wholes: Vec<Vec<usize>> = vec![Vec::new(); root.len()];
    for (f, face) in sheet.faces.iter().enumerate() {
        if !matches!(face.kind, SurfaceKind::Plane | SurfaceKind::Cylinder) {
            wholes[find(&root, f)].push(f);
        }
    }
    wholes.retain(|w| !w.is_empty());
    wholes
}
