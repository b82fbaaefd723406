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
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_sight;
mod tip;
mod truth;
mod wholes;

use super::Surface;
use super::heights::Heights;
use super::sheet::Sheet;
use crate::drawing::SurfaceKind;
pub(super) use cylinder::touching as touching_circle;
use evidence::Evidence;
pub(super) use flat::best_plane;
pub(super) use truth::true_surfaces;
pub(super) use wholes::touching;

/// Rounds in which surfaces help their neighbours; the first ones ask for a better fit.
const ROUNDS: [f64; 4] = [2e-5, 1e-4, 3e-4, 3e-4];

/// A surface may be as far off as this many errors of a drawn point in any case.
const ERRORS: f64 = 20.0;

/// The surface of every face, as far as known depths tell.
pub(super) fn surfaces(sheet: &Sheet<'_>, heights: &Heights) -> Vec<Surface> {
    surfaces_of(sheet, heights, |_| true)
}

/// The same of planes, cylinders and the wholes of which some face is asked for; the others stay
/// unknown.
pub(super) fn surfaces_of(
    sheet: &Sheet<'_>,
    heights: &Heights,
    asked: impl Fn(usize) -> bool,
) -> Vec<Surface> {
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
    let mut wholes = wholes::surfaces(sheet);
    wholes.retain(|whole| whole.iter().any(|&f| asked(f)));
    // What a section sweeps along a helix may pass for a usual surface where it is short.
    wholes.retain(|whole| {
        sheet.faces[whole[0]].kind != SurfaceKind::Other
            || !whole.iter().any(|&f| sheet.is_swept(f))
    });
    for tolerance in ROUNDS {
        for whole in &wholes {
            if whole.iter().any(|&f| known[f] == Surface::Unknown) {
                let drawn = ERRORS * sheet.directions.precision;
                let tolerance = (tolerance * sheet.size).max(drawn);
                round(sheet, heights, whole, tolerance, &mut known);
            }
        }
    }
    for whole in &wholes {
        if whole.iter().any(|&f| known[f] != Surface::Unknown) {
            continue;
        }
        let instead = match sheet.faces[whole[0]].kind {
            SurfaceKind::Other => {
                let evidence = Evidence::new(sheet, heights, whole, &known);
                judge::stand_in(&evidence, any(&evidence))
            }
            SurfaceKind::Cone => tip::hidden(sheet, heights, whole, &known),
            _ => None,
        };
        whole
            .iter()
            .for_each(|&f| known[f] = instead.unwrap_or(Surface::Unknown));
    }
    known
}

/// Candidates for a surface of another kind: it may be one of ours in another form, as a spline.
fn any(evidence: &Evidence) -> Vec<Surface> {
    let mut found = sphere::spheres(evidence);
    for axis in axes::axes(evidence) {
        found.extend(profile::cylinder(evidence, &axis));
        found.extend(profile::cone(evidence, &axis));
        found.extend(profile::tori(evidence, &axis));
    }
    found.extend(bend::tori(evidence));
    found
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
            SurfaceKind::Other => any(&evidence),
            _ => continue,
        };
        let found = if kind == SurfaceKind::Other {
            // Only what fits as if it were drawn for it.
            judge::best(&evidence, candidates, ROUNDS[0] * sheet.size)
        } else {
            judge::best(&evidence, candidates, tolerance).or_else(|| {
                if kind != SurfaceKind::Torus {
                    return None;
                }
                let axes = axes::axes(&evidence);
                let bulges = axes.iter().flat_map(|a| profile::bulges(&evidence, a));
                judge::best(&evidence, bulges.collect(), tolerance)
            })
        };
        if let Some(surface) = found {
            part.iter().for_each(|&f| known[f] = surface);
        }
    }
}
