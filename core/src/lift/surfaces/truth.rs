//! Surfaces of true faces, fitted to their true boundary curves.
//!
//! A truth says what kind a face's surface is and where its boundary runs in space, outlines
//! included, and nothing of centres, axes and radii. Those follow from the boundary.

use glam::{DVec2, DVec3};

use super::evidence::{Bound, Evidence};
use super::flat::best_plane;
use super::judge;
use super::refine::{Freedom, refined};
use super::ring::Ring;
use super::{any, axes, bend, profile, sphere};
use crate::drawing::{SurfaceKind, Truth};
use crate::lift::Surface;
use crate::lift::circle::circle_fit;

/// Largest distance of a true curve from the surface fitted to it, relative to the size; the
/// coordinates of a truth are rounded.
const EXACT: f64 = 2e-5;

/// Rounds in which surfaces help their neighbours.
const ROUNDS: usize = 3;

/// The surfaces of true faces, [`Surface::Unknown`] where none fits the boundary; `size` is the
/// half diagonal.
pub(in crate::lift) fn true_surfaces(truth: &Truth, size: f64) -> Vec<Surface> {
    let mut known = vec![Surface::Unknown; truth.faces.len()];
    let sides = sides(truth);
    by_themselves(truth, &sides, &mut known, size);
    // What an outline leaves of a surface may not tell it: its parts together do.
    for f in 0..known.len() {
        let kind = truth.faces[f].kind;
        if known[f] != Surface::Unknown {
            continue;
        }
        let beside = truth.faces[f]
            .loops
            .iter()
            .flatten()
            .flat_map(|c| sides[c.edge()].clone());
        let beside: Vec<usize> = beside
            .filter(|&g| g != f && truth.faces[g].kind == kind)
            .collect();
        for g in beside {
            let both = evidence(truth, &[f, g], &sides, &known, size);
            if let Some(surface) = fitted(&both, kind, balls(&both)) {
                known[f] = surface;
                if known[g] == Surface::Unknown {
                    known[g] = surface;
                }
                break;
            }
        }
    }
    by_themselves(truth, &sides, &mut known, size);
    share(truth, &sides, &mut known, size);
    known
}

/// Fits faces that are not known yet one by one, so that each helps its neighbours.
fn by_themselves(truth: &Truth, sides: &[Vec<usize>], known: &mut [Surface], size: f64) {
    for _ in 0..ROUNDS {
        for f in 0..known.len() {
            if known[f] == Surface::Unknown {
                let own = evidence(truth, &[f], sides, known, size);
                let found = fitted(&own, truth.faces[f].kind, sphere::spheres(&own));
                known[f] = found.unwrap_or(Surface::Unknown);
            }
        }
    }
}

/// Gives faces of one surface the same one: the surface that most faces fit goes first.
fn share(truth: &Truth, sides: &[Vec<usize>], known: &mut [Surface], size: f64) {
    let own: Vec<Evidence> = (0..known.len())
        .map(|f| evidence(truth, &[f], sides, known, size))
        .collect();
    let surfaces = known.to_vec();
    let fits = |f: usize, g: usize| {
        truth.faces[f].kind == truth.faces[g].kind
            && surfaces[g] != Surface::Unknown
            && judge::misfit(&own[f], &surfaces[g]) <= EXACT * size
    };
    let mut fitting: Vec<(usize, Vec<usize>)> = (0..known.len())
        .map(|g| (g, (0..known.len()).filter(|&f| fits(f, g)).collect()))
        .collect();
    fitting.sort_by_key(|(_, faces)| std::cmp::Reverse(faces.len()));
    let mut settled = vec![false; known.len()];
    for (g, faces) in fitting {
        for f in faces {
            if !settled[f] {
                settled[f] = true;
                known[f] = surfaces[g];
            }
        }
    }
}

/// Faces at each edge.
fn sides(truth: &Truth) -> Vec<Vec<usize>> {
    let mut sides = vec![Vec::new(); truth.edges3d.len()];
    for (f, face) in truth.faces.iter().enumerate() {
        for coedge in face.loops.iter().flatten() {
            if let Some(list) = sides.get_mut(coedge.edge()) {
                list.push(f);
            }
        }
    }
    sides
}

/// All boundary curves of a face; outlines count as curves, as their place in space is known.
fn evidence(
    truth: &Truth,
    part: &[usize],
    sides: &[Vec<usize>],
    known: &[Surface],
    size: f64,
) -> Evidence {
    let edges = part
        .iter()
        .flat_map(|&f| truth.faces[f].loops.iter().flatten());
    let mut edges: Vec<usize> = edges.map(|c| c.edge()).collect();
    edges.sort_unstable();
    edges.dedup();
    let bounds = edges.into_iter().filter_map(|e| {
        let points = truth.edges3d.get(e)?.clone();
        let outside = sides[e].iter().find(|f| !part.contains(f));
        Some(Bound {
            ring: Ring::through(&points, None, EXACT * size),
            points,
            beside: outside.map_or(Surface::Unknown, |&f| known[f]),
        })
    });
    let bounds: Vec<Bound> = bounds.filter(|b| b.points.len() > 1).collect();
    Evidence {
        vertices: bounds.iter().map(|b| b.points[0]).collect(),
        bounds,
        outlines: Vec::new(),
        bent: false,
        outline_ends: Vec::new(),
        discs: Vec::new(),
        directions: truth.directions.clone(),
        size,
    }
}

fn fitted(evidence: &Evidence, kind: SurfaceKind, spheres: Vec<Surface>) -> Option<Surface> {
    let axes = || axes::axes(evidence);
    let candidates: Vec<Surface> = match kind {
        SurfaceKind::Plane => plane(evidence).into_iter().collect(),
        SurfaceKind::Cylinder => cylinders(evidence),
        SurfaceKind::Cone => axes()
            .iter()
            .filter_map(|a| profile::cone(evidence, a))
            .collect(),
        SurfaceKind::Sphere => spheres,
        SurfaceKind::Torus => axes()
            .iter()
            .flat_map(|a| profile::tori(evidence, a))
            .chain(bend::tori(evidence))
            .collect(),
        SurfaceKind::Other => [
            any(evidence),
            cylinders(evidence),
            plane(evidence).into_iter().collect(),
        ]
        .concat(),
    };
    judge::best(evidence, candidates, EXACT * evidence.size)
}

fn plane(evidence: &Evidence) -> Option<Surface> {
    let points: Vec<DVec3> = evidence.points().collect();
    let (origin, normal) = best_plane(&points)?;
    Some(Surface::Plane { origin, normal })
}

/// Cylinders along straight edges, axes of the model and of circles, through all points.
fn cylinders(evidence: &Evidence) -> Vec<Surface> {
    let points: Vec<DVec3> = evidence.points().collect();
    let straight = evidence.bounds.iter().filter(|b| b.points.len() == 2);
    let along = straight.filter_map(|b| (b.points[1] - b.points[0]).try_normalize());
    let around = evidence.rings().map(|(ring, _)| ring.normal);
    let mut found = Vec::new();
    for axis in along
        .chain(around)
        .chain(evidence.directions.iter().copied())
    {
        let (u, w) = axis.any_orthonormal_pair();
        let seen = points.iter().map(|p| DVec2::new(p.dot(u), p.dot(w)));
        if let Some((center, radius, _)) = circle_fit(seen) {
            found.push(refined(
                evidence,
                Surface::Cylinder {
                    origin: u * center.x + w * center.y,
                    axis,
                    radius,
                },
                Freedom::All,
            ));
        }
    }
    found
}

/// Spheres, also those of which a circle is the widest: an outline is all that bounds a ball. A cap is
/// bounded by one circle as well, but what it touches tells it.
fn balls(evidence: &Evidence) -> Vec<Surface> {
    let mut found = sphere::spheres(evidence);
    found.extend(evidence.rings().map(|(ring, _)| Surface::Sphere {
        center: ring.center,
        radius: ring.radius,
    }));
    found
}
