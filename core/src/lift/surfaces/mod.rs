//! Surfaces of faces from lifted depths.
//!
//! Planes and cylinders come first, each face by itself. Cones, spheres and tori are then found
//! from what bounds them: circles and other curves whose place is known, outlines, and neighbours
//! that they touch. Outlines split a surface, so faces of one kind that meet are tried as one whole
//! before each is tried by itself. What is found helps its neighbours in the next round.

mod axes;
mod bend;
mod cylinder;
mod evidence;
mod flat;
mod judge;
mod profile;
mod refine;
mod ring;
mod sphere;
mod wholes;

use super::Surface;
use super::heights::Heights;
use super::sheet::Sheet;
use crate::drawing::SurfaceKind;
use evidence::Evidence;
pub(super) use wholes::touching;

/// Rounds in which surfaces help their neighbours; the first ones ask for a better fit.
const ROUNDS: [f64; 4] = [2e-5, 1e-4, 1e-3, 1e-3];

/// The surface of every face, as far as known depths tell; in a central projection of planes and
/// cylinders only, as the others are found from lines of sight that are parallel.
pub(super) fn surfaces(sheet: &Sheet<'_>, heights: &Heights) -> Vec<Surface> {
    let mut known: Vec<Surface> = (0..sheet.faces.len())
        .map(|face| {
            let found = match sheet.faces[face].kind {
                _ if !heights.are_known(&sheet.corners[face]) => None,
                SurfaceKind::Plane => flat::plane(sheet, heights, face),
                SurfaceKind::Cylinder => cylinder::cylinder(sheet, heights, face),
                _ => None,
            };
            found.unwrap_or(Surface::Unknown)
        })
        .collect();
    if !sheet.camera().is_parallel() {
        return known;
    }
    let wholes = wholes::surfaces(sheet);
    for tolerance in ROUNDS {
        for whole in &wholes {
            if whole.iter().any(|&f| known[f] == Surface::Unknown) {
                round(sheet, heights, whole, tolerance * sheet.size, &mut known);
            }
        }
    }
    known
}

/// Tries a whole, then each of its faces that are not known yet.
fn round(
    sheet: &Sheet<'_>,
    heights: &Heights,
    whole: &[usize],
    tolerance: f64,
    known: &mut [Surface],
) {
    let kind = sheet.faces[whole[0]].kind;
    let singles = (whole.len() > 1).then(|| whole.chunks(1)).into_iter();
    for part in std::iter::once(whole).chain(singles.flatten()) {
        if part.iter().any(|&f| known[f] != Surface::Unknown) {
            continue;
        }
        let evidence = Evidence::new(sheet, heights, part, known);
        if evidence.vertices.is_empty() {
            continue;
        }
        let candidates = match kind {
            SurfaceKind::Sphere => sphere::spheres(&evidence),
            SurfaceKind::Cone => axes::axes(&evidence)
                .iter()
                .filter_map(|axis| profile::cone(&evidence, axis))
                .collect(),
            SurfaceKind::Torus => axes::axes(&evidence)
                .iter()
                .flat_map(|axis| profile::tori(&evidence, axis))
                .chain(bend::tori(&evidence))
                .collect(),
            _ => continue,
        };
        if let Some(surface) = judge::best(&evidence, candidates, tolerance) {
            part.iter().for_each(|&f| known[f] = surface);
        }
    }
}
