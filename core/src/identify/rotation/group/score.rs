//! How likely a join is.
//!
//! A join is described by features, and a score made of them; only the score knows how people
//! model parts. A trained score takes the place of the weights here by the trait [`JoinScorer`].

/// Features of a join, in the order of [`Feature`].
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
    More 0.40: "Further loops of the part that the same move puts into faces.",
    Coaxial -2.01: "One of the links is along an axis.",
    Doubtful -1.21: "A circle is put into a plane although it is drawn around another one's axis.",
    Right -1.02: "Share of a pocket's points inside the solid, or of a boss' outside.",
    Wrong -4.57: "Share of a pocket's points outside the solid, or of a boss' inside.",
    Pierced -0.88: "Share of other parts' points inside the part.",
    Boss -1.76: "The part is on the outer side of the face.",
    Through 2.17: "The part opens in two planes.",
    Spread -1.50: "Difference of the moves that its links imply, over the tolerance.",
    Area 0.41: "Drawn width of the inner loop over that of the outer one in their plane.",
    Narrow 1.50: "The same for two circles of a surface of revolution.",
    Skips -2.00: "A third circle is drawn between two of a surface of revolution.",
    Lonely -1.00: "The part is one circle, and both its sides would be planes.",
    Shared 0.40: "The face has other inner loops.",
    Centred 2.50: "Directions of the face in which the inner loop is centred.",
    Aligned 2.84: "Directions in which the inner loop lies as another one of the face does.",
    Level 0.11: "Share of the part's other planes that are level with one that is placed.",
    Clearance 0.99: "Drawn distance between inner and outer loop, over the inner one's width.",
    Main -0.37: "The other part is the main one.",
    Alike 2.00: "Share of the parts drawn alike that are joined alike, less those that are not.",
    Host -2.86: "The part placed hangs on this one.",
    Astray -2.00: "Some of a pocket is outside the solid, or of a boss inside.",
    Round 0.22: "Log-odds against chance that places in the face are round fractions of its extents.",
    Fits 3.00: "All of a loop lies on the curved surface that it would be a hole in.",
    Thin -2.00: "How thin the wall beside the inner loop is: 1 if there is none.",
}

/// Gives a join's score from its features.
///
/// Scores of the joins of one part are compared with each other: as log-odds, larger is likelier.
pub(super) trait JoinScorer {
    /// Score of a join.
    fn score(&self, row: &Row) -> f64;
}

/// A weighted sum with fixed weights.
///
/// They come from a conditional logit over the joins of each part, fitted to drawings of real parts
/// (block machining features, a parts library, electronic and standard parts); those of links along
/// an axis and of what fits are set by hand. The sample corpus overlaps those drawings. The weights of
/// what is astray, round and thin are fitted to drawings of three views of the families in training;
/// those of what is astray and thin are made smaller by a third and a half, as parts from elsewhere want
/// it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct HandJoinScorer;

impl JoinScorer for HandJoinScorer {
    fn score(&self, row: &Row) -> f64 {
        row.iter().zip(WEIGHTS).map(|(x, w)| x * w).sum()
    }
}
