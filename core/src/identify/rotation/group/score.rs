//! How likely a join is.

/// What is known of a join, and what is known of how a body has it; see [`FEATURES`].
pub(super) type Row = [f64; COUNT];

macro_rules! features {
    ($($name:ident $weight:literal: $text:literal,)*) => {
        /// The features of a join, in the order of a row.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub(super) enum Feature {
            $(#[doc = $text] $name,)*
        }

        /// Number of features.
        pub(super) const COUNT: usize = [$(Feature::$name,)*].len();

        /// Weights without a trained model, log-odds for one unit.
        const WEIGHTS: [f64; COUNT] = [$($weight,)*];
    };
}

features! {
    More 3.0: "Further loops of the part that the same move puts into faces.",
    Coaxial 0.0: "One of the links is along an axis.",
    Doubtful -3.0: "A circle is put into a plane although it is drawn around another one's axis.",
    Right 3.0: "Share of a pocket's points inside the solid, or of a boss' outside.",
    Wrong -3.0: "Share of a pocket's points outside the solid, or of a boss' inside.",
    Pierced -3.0: "Share of other parts' points inside the part.",
    Boss -1.0: "The part is on the outer side of the face.",
    Through 1.0: "The part opens in two planes.",
    Area 1.0: "Drawn width of the inner loop over that of the outer one.",
    Shared 0.0: "The face has other inner loops.",
    Centred 0.5: "Directions of the face in which the inner loop is centred.",
    Aligned 0.5: "Directions in which the inner loop lies as another one of the face does.",
    Level 1.0: "Share of the part's other planes that are level with one that is placed.",
    Clearance 0.0: "Drawn distance between inner and outer loop, over the inner one's width.",
    Main 0.0: "The other part is the main one.",
    Host 0.0: "The part placed hangs on this one.",
}

/// Gives a join's score from its features.
///
/// Scores of the joins of one part are compared with each other: as log-odds, larger is likelier.
pub(super) trait JoinScorer {
    /// Score of a join.
    fn score(&self, row: &Row) -> f64;
}

/// A weighted sum with fixed weights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct HandJoinScorer;

impl JoinScorer for HandJoinScorer {
    fn score(&self, row: &Row) -> f64 {
        row.iter().zip(WEIGHTS).map(|(x, w)| x * w).sum()
    }
}
