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
pub(super) use bend::between as bend_between;
pub(super) use cylinder::touching as touching_circle;
use evidence::Evidence;
pub(super) use flat::best_plane;
pub(super) use ring::Ring;
pub(super) use truth::true_surfaces;
pub(super) use wholes::touching;

/// Rounds in which surfaces help their neighbours; the first ones ask for a better fit.
const ROUNDS: [f64; 4] = [2e-5, 1e-4, 3e-4, 3e-4];

/// A surface may be as far off as this many errors of a drawn point in any case.
const ERRORS: f64 = 20.0;

/// The surface of every face, as far as known depths tell.
pub(super) fn surfaces(sheet: &Sheet<'_>, heights: &Heights) -> Vec<Surface> {
    surfaces_of(sheet, heights, true, |_| true)
}

/// The same of planes, cylinders and the wholes of which some face is asked for; the others stay
/// unknown, and so do those that only a surface of another kind fits, unless `any_kind`.
pub(super) fn surfaces_of(
    sheet: &Sheet<'_>,
    heights: &Heights,
    any_kind: bool,
    asked: impl Fn(usize) -> bool,
) -> Vec<Surface> {
    let mut known: Vec<Surface> = (0..sheet.faces.len())
        .map(|face| {
            let found = match sheet.faces[face].kind {
                _ if !heights.are_known(&sheet.corners[face]) => None,
                SurfaceKind::Plane => flat::plane(sheet, heights, face),
                // A narrow one may be drawn as flat as a plane.
                SurfaceKind::Cylinder => cylinder::cylinder(sheet, heights, face).or_else(|| {
                    flat::straight(sheet, heights, face, ROUNDS[0]).filter(|_| any_kind)
                }),
                _ => None,
            };
            found.unwrap_or(Surface::Unknown)
        })
        .collect();
    let mut wholes = wholes::surfaces(sheet);
    // What a section sweeps along a helix may pass for a usual surface where it is short.
    let swept = |whole: &[usize]| {
        wholes::kind(sheet, whole) == SurfaceKind::Other && whole.iter().any(|&f| sheet.is_swept(f))
    };
    wholes.retain(|whole| whole.iter().any(|&f| asked(f)) && !swept(whole));
    // What was known, and how good a fit was asked for, when a whole was last tried.
    let mut tried = vec![(usize::MAX, 0.0, None); wholes.len()];
    let mut before = None;
    for share in ROUNDS {
        for (whole, tried) in wholes.iter().zip(&mut tried) {
            if whole.iter().all(|&f| known[f] != Surface::Unknown) {
                continue;
            }
            // Only what fits as if it were drawn for it, or as if it were a spline that stands for it.
            let other = |&f: &usize| sheet.faces[f].kind == SurfaceKind::Other;
            let share = if whole.iter().all(other) {
                share.min(ROUNDS[1])
            } else {
                share
            };
            let found = known.iter().filter(|s| **s != Surface::Unknown).count();
            if *tried != (found, share, before) {
                *tried = (found, share, before);
                round(sheet, heights, whole, (share, before), &mut known);
            }
        }
        before = Some(share);
    }
    for whole in &wholes {
        if whole.iter().any(|&f| known[f] != Surface::Unknown) {
            continue;
        }
        let evidence = Evidence::new(sheet, heights, whole, &known);
        let instead = match wholes::kind(sheet, whole) {
            // It is no surface to place a vertex by.
            SurfaceKind::Other if whole.iter().all(|&f| heights.are_known(&sheet.corners[f])) => {
                judge::stand_in(&evidence, any(&evidence))
            }
            SurfaceKind::Cone => tip::hidden(sheet, heights, whole, &evidence),
            _ => None,
        };
        let instead = match instead {
            None if any_kind => another(&evidence),
            _ => instead,
        };
        whole
            .iter()
            .for_each(|&f| known[f] = instead.unwrap_or(Surface::Unknown));
    }
    known
}

/// A surface of another kind than was said, if it fits as if the drawing were made for it: a torus is
/// easily taken for a sphere.
fn another(evidence: &Evidence) -> Option<Surface> {
    if evidence.is_one_circle() {
        return None;
    }
    let axes = axes::axes(evidence);
    let bulges = axes.iter().flat_map(|a| profile::bulges(evidence, a));
    let candidates = any(evidence).into_iter().chain(bulges).collect();
    judge::best(evidence, candidates, ROUNDS[0] * evidence.size)
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

/// Tries a whole, then each of its faces that are not known yet, within the first share of the drawing's
/// size. Parts have to fit within the second one, that of the round before: a small part fits cones of any
/// axis and angle, or a torus that its outline rules out, and should not before the whole has been tried.
fn round(
    sheet: &Sheet<'_>,
    heights: &Heights,
    whole: &[usize],
    (share, before): (f64, Option<f64>),
    known: &mut [Surface],
) {
    let singles = (whole.len() > 1).then(|| whole.chunks(1)).into_iter();
    for part in std::iter::once(whole).chain(singles.flatten()) {
        if part.iter().any(|&f| known[f] != Surface::Unknown) {
            continue;
        }
        let evidence = Evidence::new(sheet, heights, part, known);
        if evidence.vertices.is_empty() {
            continue;
        }
        let kind = wholes::kind(sheet, part);
        let least = ERRORS * sheet.directions.precision;
        let is_part = part.len() < whole.len();
        let loose = (share * sheet.size).max(least);
        let tolerance = match (kind, before) {
            (_, None) if is_part => continue,
            // Of a part alone some surface fits by chance, and so it does where no outline is.
            (SurfaceKind::Other, _) if is_part || evidence.outlines.is_empty() => {
                ROUNDS[0] * sheet.size
            }
            (_, Some(before)) if is_part => (before * sheet.size).max(least),
            _ => loose,
        };
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
            SurfaceKind::Other if !evidence.is_one_circle() => any(&evidence),
            _ => continue,
        };
        let best = |candidates| judge::best(&evidence, candidates, tolerance);
        let bulges = || {
            if kind != SurfaceKind::Torus {
                return None;
            }
            let axes = axes::axes(&evidence);
            let bulges = axes.iter().flat_map(|a| profile::bulges(&evidence, a));
            best(bulges.collect())
        };
        // What is no better known than its parts, as it may be of splines, has the surface of one of them.
        let others = || {
            let mut surfaces = whole.iter().map(|&f| known[f]).filter(|_| is_part);
            let near = |s: &Surface| judge::misfit(&evidence, s) <= loose;
            surfaces.find(|s| *s != Surface::Unknown && !evidence.is_one_circle() && near(s))
        };
        let found = best(candidates).or_else(bulges).or_else(others);
        if let Some(surface) = found {
            part.iter().for_each(|&f| known[f] = surface);
        }
    }
}
