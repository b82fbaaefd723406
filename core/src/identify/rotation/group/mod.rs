//! Grouping loops into faces by lifting.
//!
//! Every loop is a face of its own at first. Lifting gives planar loops a plane and circles an
//! axis, and each part of the drawing that shares no vertex with the others a depth of its own.
//!
//! 1. [`shapes`]: the loops as drawn and lifted, with the [`axis`] of circles, and of circles that
//!    are [`oblique`]; [`tolerance`]: how near is one,
//! 2. [`links`]: pairs of loops that may be one face, and how far in depth each moves a part,
//! 3. [`joins`]: links of a part that imply the same move support each other and make one join,
//! 4. [`body`] and [`volume`]: whether a part so placed is a pocket, a hole or a boss that a solid can
//!    have, and [`layout`]: whether it is where people put one,
//! 5. [`score`]: how likely a join is,
//! 6. [`search`]: the likeliest joins of all parts, and ranked alternatives,
//! 7. [`chains`]: circles and silhouettes around one axis, matched all at once.

mod alike;
mod assemble;
mod axis;
mod body;
mod chains;
mod joins;
mod layout;
mod links;
mod oblique;
#[cfg(test)]
mod round;
mod score;
mod search;
mod shapes;
#[cfg(test)]
mod tests;
mod tolerance;
mod trials;
mod volume;

use crate::drawing::Graph;
use crate::identify::Face;
use crate::lift::{Pieces, Readings};
use score::HandJoinScorer;
use shapes::Shapes;

/// Loops grouped into faces.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Grouping {
    /// Loop indices of each face, the outer loop first, each loop in one face.
    pub(super) faces: Vec<Vec<usize>>,
    /// Probability that a face's grouping is right, as far as the scores tell.
    pub(super) sureness: Vec<f64>,
    /// Whether each face is a surface of revolution between two circles.
    pub(super) round: Vec<bool>,
    /// Whether each face is a plane because of its several loops.
    pub(super) flat: Vec<bool>,
    /// Whether each loop is to be walked backwards, so that all faces are seen from one side.
    pub(super) reversed: Vec<bool>,
    /// Log-odds against the best grouping.
    pub(super) score: f64,
}

/// Groups loops, each given as a face of one loop; the best grouping first, never none.
pub(super) fn group(readings: &Readings<'_>, graph: &Graph, loops: &[Face]) -> Vec<Grouping> {
    let Ok((drawing, pieces)) = Pieces::new(readings, loops) else {
        return vec![Grouping {
            faces: (0..loops.len()).map(|i| vec![i]).collect(),
            sureness: vec![1.0; loops.len()],
            round: vec![false; loops.len()],
            flat: vec![false; loops.len()],
            reversed: vec![false; loops.len()],
            score: 0.0,
        }];
    };
    let mut shapes = Shapes::new(&drawing, graph, &pieces, loops);
    oblique::add(&mut shapes, &drawing, &pieces, loops);
    let links = links::links(&shapes);
    search::Search::new(&shapes, &links, &HandJoinScorer).run()
}
