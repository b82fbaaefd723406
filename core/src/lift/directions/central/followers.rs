//! What follows a frame in a perspective drawing.

use glam::{DMat3, DVec3};

use super::circles::Circle;
use super::lines::{Line, Lines};
use crate::lift::Camera;
use crate::lift::directions::model_frame::USUAL;

/// Errors, radians, up to which slanted directions are told apart by chance seldom enough.
const SHARP: f64 = 1e-3;

/// Indices of usual directions for lines, of axes for circles.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Followers {
    pub(super) lines: Vec<Option<usize>>,
    pub(super) circles: Vec<Option<usize>>,
}

impl Followers {
    /// What agrees with a frame that is known to `error` radians. What two axes would explain
    /// follows neither.
    pub(super) fn of_axes(
        lines: &Lines,
        circles: &[Circle],
        camera: &Camera,
        frame: &DMat3,
        error: f64,
    ) -> Self {
        let circle =
            |c: &Circle| only((0..3).filter(|&k| c.agreeing(frame.col(k), error).is_some()));
        let around: Vec<Option<usize>> = circles.iter().map(circle).collect();
        let line = |line: &Line| {
            let along = |k: &usize| lines.follows(camera, line, frame.col(*k), error);
            let stray = circles.iter().zip(&around).filter(|(_, k)| k.is_none());
            let mut stray = stray.filter(|(c, _)| c.v.iter().any(|v| line.v.contains(v)));
            // The outline of a cylinder that stands aslant.
            let outline = stray.any(|(c, _)| {
                lines.slant_error(line) + c.error < SHARP
                    && (c.normals.iter()).any(|n| lines.follows(camera, line, *n, c.error))
            });
            only((0..3).filter(along)).filter(|_| !outline)
        };
        Self {
            lines: lines.all.iter().map(line).collect(),
            circles: around,
        }
    }

    /// The same with slanted directions, for lines that no axis explains.
    pub(super) fn with_slanted(
        lines: &Lines,
        circles: &[Circle],
        camera: &Camera,
        frame: &DMat3,
        error: f64,
    ) -> Self {
        let usual: Vec<DVec3> = USUAL.iter().map(|u| *frame * u.direction).collect();
        let mut found = Self::of_axes(lines, circles, camera, frame, error);
        for (line, follows) in lines.all.iter().zip(&mut found.lines) {
            let along = |i: &usize| lines.follows(camera, line, usual[*i], error);
            let sharp = lines.slant_error(line) + error < SHARP;
            if follows.is_none() && sharp && !(0..3).any(|k| along(&k)) {
                *follows = only((3..usual.len()).filter(along));
            }
        }
        found
    }

    /// How many numbers the followers fix.
    pub(super) fn constraints(&self) -> usize {
        self.lines.iter().flatten().count() + 2 * self.circles.iter().flatten().count()
    }
}

fn only(mut all: impl Iterator<Item = usize>) -> Option<usize> {
    match (all.next(), all.next()) {
        (found, None) => found,
        _ => None,
    }
}
