//! The smallest set of faces that, taken for something else, makes the rest agree.
//!
//! Rows that the L1 norm drops point at faces, and may point at right ones beside a wrong one. So
//! each face that they point at is tried: as a cylinder if it is a plane with arcs, and as a face of
//! which nothing is known. The search takes the fewest such faces, of these the ones that the
//! engine is least sure of.

use super::LiftError;
use super::directions::Directions;
use super::sheet::Sheet;
use super::solve::{self, Solved};
use crate::drawing::{Drawing, SurfaceKind};
use crate::identify::Face;

/// Faces that may be blamed together.
const MOST: usize = 4;

/// Faces that are tried in the place of one.
const SUSPECTS: usize = 10;

/// Sets of faces that are pursued at a time.
const BEAM: usize = 2;

/// Faces at rows that were dropped, as a share of all: more are the sign of an inexact drawing, not
/// of wrong faces.
const FEW: f64 = 0.5;

/// Least weight of a face: one that is sure to be wrong is blamed as one face still.
const DOUBT: f64 = 0.05;

/// Weight of taking a plane for a cylinder: a wrong kind is likelier than a wrong loop.
const KIND: f64 = 0.5;

/// Faces that agree, and what was given up for that.
pub(super) struct Blame {
    pub(super) faces: Vec<Face>,
    pub(super) solved: Solved,
    /// Faces that were taken for something else.
    pub(super) wrong: Vec<usize>,
    /// Rows of theirs that contradicted the others.
    lost: usize,
    cost: f64,
}

impl Blame {
    /// Number of rows that contradict the rest, those of the blamed faces included.
    pub(super) fn contradictions(&self) -> usize {
        self.solved.dropped() + self.lost
    }

    /// All sets of faces with one more of them.
    fn further(&self, drawing: &Drawing, broken: &[usize], reading: &Directions) -> Vec<Self> {
        let sheet = Sheet::new(drawing, &self.faces, reading);
        let mut found = Vec::new();
        let suspects = self.solved.suspects(&sheet);
        let fresh = suspects.iter().filter(|(f, _)| !self.wrong.contains(f));
        for &(face, rows) in fresh.take(SUSPECTS) {
            let (sure, rows) = if broken.contains(&face) {
                (DOUBT, 0)
            } else {
                (self.faces[face].confidence.clamp(DOUBT, 1.0), rows)
            };
            let round = sheet.is_planar(face)
                && sheet
                    .edges_of(face)
                    .iter()
                    .any(|&e| sheet.circles[e].is_some());
            let cylinder = round.then_some((SurfaceKind::Cylinder, KIND * sure));
            for (kind, cost) in cylinder
                .into_iter()
                .chain([(SurfaceKind::Other, sure)])
                .filter(|(kind, _)| *kind != self.faces[face].kind)
            {
                let mut faces = self.faces.clone();
                faces[face].kind = kind;
                if let Ok(solved) = solve::solve(&Sheet::new(drawing, &faces, reading)) {
                    found.push(Self {
                        faces,
                        solved,
                        wrong: self.wrong.iter().copied().chain([face]).collect(),
                        lost: self.lost + rows,
                        cost: self.cost + cost,
                    });
                }
            }
        }
        found
    }
}

/// Looks for the faces to blame; there are none if the faces agree, or no small set makes them.
/// `broken` are parts of faces that are wrong by themselves: blaming these costs little, and what
/// they contradict is no news.
///
/// # Errors
/// [`LiftError`] if the faces leave depth open.
pub(super) fn blame(
    drawing: &Drawing,
    faces: Vec<Face>,
    broken: &[usize],
    reading: &Directions,
) -> Result<Blame, LiftError> {
    let sheet = Sheet::new(drawing, &faces, reading);
    let solved = solve::solve(&sheet)?;
    let few = (FEW * faces.len() as f64).max(4.0);
    let hopeless = solved.dropped() == 0 || solved.suspects(&sheet).len() as f64 > few;
    let whole = Blame {
        faces,
        solved,
        wrong: Vec::new(),
        lost: 0,
        cost: 0.0,
    };
    if hopeless {
        return Ok(whole);
    }
    let mut beam: Vec<Blame> = Vec::new();
    for _ in 0..MOST {
        let from = if beam.is_empty() {
            std::slice::from_ref(&whole)
        } else {
            &beam
        };
        let mut next: Vec<Blame> = from
            .iter()
            .flat_map(|blame| blame.further(drawing, broken, reading))
            .collect();
        next.sort_by(|a, b| {
            let dropped = a.solved.dropped().cmp(&b.solved.dropped());
            dropped.then(a.cost.total_cmp(&b.cost))
        });
        next.truncate(BEAM);
        match next.first().map(|first| first.solved.dropped()) {
            Some(0) => return Ok(next.swap_remove(0)),
            Some(dropped) if dropped < from[0].solved.dropped() => beam = next,
            _ => break,
        }
    }
    Ok(whole)
}
