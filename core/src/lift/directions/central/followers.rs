//! What follows a frame in a perspective drawing.

use glam::DMat3;

use super::circles::Circle;
use super::lines::Lines;
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
    /// follows neither; slanted directions are asked only where no axis explains a line.
    pub(super) fn new(
        lines: &Lines,
        circles: &[Circle],
        camera: &Camera,
        frame: &DMat3,
        error: f64,
    ) -> Self {
        let line = |line| {
            let along =
                |i: &usize| lines.follows(camera, line, *frame * USUAL[*i].direction, error);
            match only((0..3).filter(along)) {
                Ok(found) => found,
                Err(Several) => None,
            }
            .or_else(|| {
                let none = !(0..3).any(|i| along(&i));
                let sharp = lines.slant_error(line) + error < SHARP;
                (none && sharp)
                    .then(|| only((3..USUAL.len()).filter(along)).ok().flatten())
                    .flatten()
            })
        };
        let circle = |c: &Circle| {
            only((0..3).filter(|&k| c.agreeing(frame.col(k), error).is_some()))
                .ok()
                .flatten()
        };
        Self {
            lines: lines.all.iter().map(line).collect(),
            circles: circles.iter().map(circle).collect(),
        }
    }

    /// Without the lines in slanted directions.
    pub(super) fn without_slanted(mut self) -> Self {
        for line in &mut self.lines {
            *line = line.filter(|&i| i < 3);
        }
        self
    }

    /// How many numbers the followers fix.
    pub(super) fn constraints(&self) -> usize {
        self.lines.iter().flatten().count() + 2 * self.circles.iter().flatten().count()
    }
}

struct Several;

fn only(mut all: impl Iterator<Item = usize>) -> Result<Option<usize>, Several> {
    match (all.next(), all.next()) {
        (found, None) => Ok(found),
        _ => Err(Several),
    }
}
