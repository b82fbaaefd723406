//! From a lifted drawing to a solid, giving up surfaces that none can be built with.

use faceformer::drawing::{Drawing, SurfaceKind};
use faceformer::identify::Face;
use faceformer::lift::{Lift, Surface};
use faceformer::plan::{Plan, PlanError, PlanOptions, plan};
use faceformer::{Error, Progress};

use crate::{OcctError, Solid, build};

/// So often surfaces are given up before the first error is the last word.
const ROUNDS: usize = 4;

/// A plan, and what came of it.
#[derive(Debug)]
pub struct Reconstruction {
    /// The plan that was built.
    pub plan: Plan,
    /// The solid, or why there is none.
    pub solid: Result<Solid, OcctError>,
    /// Faces, from 0, whose surfaces were given up: they are filled, and the plan's notices say so.
    pub given_up: Vec<usize>,
}

/// Plans and builds the solid of a lifted drawing.
///
/// Where it fails at a face whose surface was found, but misses the face's edges, that surface becomes
/// unknown in `lift`, and the face is filled. If it fails all the same, `lift` stays as it is and the
/// first failure is given.
///
/// # Errors
/// [`PlanError`] if no plan can be had. What the kernel says, [`OcctError::Cancelled`] too if `progress`
/// asked to stop, is in [`Reconstruction::solid`].
///
/// # Panics
/// Only if the callback of `progress` panics.
pub fn reconstruct(
    drawing: &Drawing,
    faces: &[Face],
    lift: &mut Lift,
    options: &PlanOptions,
    progress: Progress<'_>,
) -> Result<Reconstruction, Error> {
    let attempt = |lift: &Lift| {
        let plan = plan(drawing, faces, lift, options)?;
        let solid = build(&plan, progress);
        Ok(Reconstruction {
            plan,
            solid,
            given_up: Vec::new(),
        })
    };
    let first = attempt(lift);
    let mut trial = lift.clone();
    // Faces with one surface, which are given up together.
    let mut given: Vec<Vec<usize>> = Vec::new();
    let mut place = Place::of(&first);
    let mut found = None;
    while let (Some(at), None) = (&place, &found)
        && given.len() < ROUNDS
        && let Some(suspect) = suspect(drawing, faces, &trial, at)
    {
        let surface = trial.surfaces[suspect];
        let parts = (0..faces.len()).filter(|&f| trial.surfaces[f] == surface);
        given.push(parts.collect());
        trial = without(lift, &given);
        let next = attempt(&trial);
        if is_cancelled(&next) {
            return next;
        }
        place = Place::of(&next);
        found = next.ok().filter(|made| made.solid.is_ok());
    }
    let Some(mut made) = found else {
        return first;
    };
    // The last one it was that helped; those before may do no harm.
    for i in (0..given.len() - 1).rev() {
        let back = given.remove(i);
        match attempt(&without(lift, &given)) {
            Ok(better) if better.solid.is_ok() => made = better,
            stopped if is_cancelled(&stopped) => return stopped,
            _ => given.insert(i, back),
        }
    }
    let mut given_up: Vec<usize> = given.concat();
    given_up.sort_unstable();
    let notices = given_up.iter().map(|&f| notice(f, &lift.surfaces[f]));
    made.plan.notices.extend(notices);
    *lift = without(lift, &given);
    made.given_up = given_up;
    Ok(made)
}

fn is_cancelled(attempt: &Result<Reconstruction, Error>) -> bool {
    matches!(attempt, Ok(made) if made.solid == Err(OcctError::Cancelled))
}

/// A lift without the surfaces of some faces.
fn without(lift: &Lift, given: &[Vec<usize>]) -> Lift {
    let mut lift = lift.clone();
    for &f in given.iter().flatten() {
        lift.surfaces[f] = Surface::Unknown;
    }
    lift
}

/// What is said of a face, from 0, whose surface was given up.
fn notice(face: usize, surface: &Surface) -> String {
    let kind = surface.kind().map_or("surface", SurfaceKind::name);
    let face = face + 1;
    format!("no solid can be built with the {kind} of face {face}; its edges were filled instead")
}

/// Where it failed, from 0; nowhere in particular if both are empty.
struct Place {
    edges: Vec<usize>,
    faces: Vec<usize>,
}

impl Place {
    /// Where an attempt failed, if other surfaces may help.
    fn of(attempt: &Result<Reconstruction, Error>) -> Option<Self> {
        let at = |edges: &[usize], faces: &[usize]| {
            // The kernel's 0, which is no place, becomes a number that nothing has.
            let from_one = |list: &[usize]| list.iter().map(|i| i.wrapping_sub(1)).collect();
            Some(Self {
                edges: from_one(edges),
                faces: from_one(faces),
            })
        };
        match attempt {
            Err(Error::Plan(error)) => match error {
                PlanError::OffSurface { edge, face, .. } => at(&[*edge], &[*face]),
                PlanError::Curve { edge, faces, .. } => at(&[*edge], faces),
                PlanError::Surface { face, .. } => at(&[], &[*face]),
                _ => None,
            },
            Err(_) => None,
            Ok(made) => match &made.solid {
                Err(OcctError::Edge { edge, .. }) => at(&[*edge], &[]),
                Err(OcctError::Face { face, .. }) => at(&[], &[*face]),
                Err(OcctError::Shell { .. } | OcctError::Tolerance { .. }) => at(&[], &[]),
                _ => None,
            },
        }
    }
}

/// The face whose surface is given up next: one near the place that is there for another kind, else a
/// curved one at the place, else one that meets the edge at fault in a vertex, else one beside the faces
/// there; of several the one with fewest edges.
fn suspect(drawing: &Drawing, faces: &[Face], lift: &Lift, at: &Place) -> Option<usize> {
    let coedges = |f: usize| faces[f].loops.iter().flatten();
    let ends = |f: usize| coedges(f).flat_map(|c| drawing.edges[c.edge()].v);
    let curved: Vec<usize> = (0..faces.len())
        .filter(|&f| {
            let surface = &lift.surfaces[f];
            !matches!(surface, Surface::Plane { .. } | Surface::Unknown)
        })
        .collect();
    let fewest = |wanted: &dyn Fn(usize) -> bool| {
        let all = curved.iter().copied().filter(|&f| wanted(f));
        all.min_by_key(|&f| coedges(f).count())
    };
    let stands_in = |f: usize| lift.surfaces[f].kind() != Some(faces[f].kind);
    let there =
        |f: usize| at.faces.contains(&f) || coedges(f).any(|c| at.edges.contains(&c.edge()));
    let beside: Vec<usize> = (0..faces.len())
        .filter(|&f| there(f))
        .flat_map(ends)
        .collect();
    let anywhere = at.edges.is_empty() && at.faces.is_empty();
    let near = |f: usize| anywhere || ends(f).any(|v| beside.contains(&v));
    let edges = at.edges.iter().filter_map(|&e| drawing.edges.get(e));
    let tips: Vec<usize> = edges.flat_map(|e| e.v).collect();
    fewest(&|f| stands_in(f) && near(f))
        .or_else(|| fewest(&there))
        .or_else(|| fewest(&|f| ends(f).any(|v| tips.contains(&v))))
        .or_else(|| fewest(&|f| !anywhere && near(f)))
}
