//! The readings of a drawing, tried in their order: a driver over the stages after identification.
//!
//! An engine gives the likeliest set of faces, and others that are less so. Where the first one gives
//! no solid, or one whose faces conflict, and another one does without, that one is what was drawn.
//! The stages know nothing of this: each attempt takes one set of faces as it is.

use std::fmt::Display;

use crate::identify::{Face, Identification};
use crate::lift::Lift;

/// Alternatives that are tried after the first reading.
pub const ALTERNATIVES: usize = 4;

/// What came of the reading that was taken.
#[derive(Debug, Clone, PartialEq)]
pub struct Taken<R> {
    /// Which reading: 0 is the best, 1 the first alternative.
    pub reading: usize,
    /// What the attempt gave.
    pub result: R,
    /// Said to the user if it is not the first reading: which one it is, and why.
    pub notice: Option<String>,
}

/// Attempts the first reading, and as many as `alternatives` further ones until one has no fault.
/// If all have one, the first is taken as it is.
///
/// `fault` says what is wrong with an attempt, as the end of "the first ..."; `None` takes it, be it
/// a success or an error, as cancelling, that no other reading can help.
///
/// ```
/// use faceformer::identify::Identification;
/// use faceformer::readings::take;
///
/// let found: Identification = serde_json::from_str(
///     r#"{"engine": "none", "faces": [], "alternatives": [{"faces": []}, {"faces": []}]}"#,
/// ).unwrap();
/// let mut count = 0;
/// let taken = take(&found, 2, |_| { count += 1; count }, |n| (*n < 2).then(|| "is odd".into()));
/// assert_eq!((taken.reading, taken.result), (1, 2));
/// assert_eq!(taken.notice.unwrap(), "the second reading was taken: the first is odd");
/// ```
pub fn take<R>(
    found: &Identification,
    alternatives: usize,
    mut attempt: impl FnMut(&[Face]) -> R,
    fault: impl Fn(&R) -> Option<String>,
) -> Taken<R> {
    let first = attempt(&found.faces);
    if let Some(why) = fault(&first) {
        let others = found.alternatives.iter().take(alternatives);
        for (k, other) in others.enumerate() {
            let result = attempt(&other.faces);
            if fault(&result).is_none() {
                return Taken {
                    reading: k + 1,
                    result,
                    notice: Some(format!(
                        "the {} reading was taken: the first {why}",
                        ordinal(k + 2)
                    )),
                };
            }
        }
    }
    Taken {
        reading: 0,
        result: first,
        notice: None,
    }
}

/// What is wrong with a lifted reading: its first conflict.
pub fn conflict(lift: &Lift) -> Option<String> {
    let first = lift.conflicts.first()?;
    Some(format!("does not lift without conflict: {first}"))
}

/// What is wrong with a reading of which some faces' surfaces, from 0, had to be given up.
pub fn given_up(faces: &[usize]) -> Option<String> {
    let first = faces.first()?;
    Some(format!(
        "has no surface that fits the edges of face {}",
        first + 1
    ))
}

/// What is wrong with a reading that gives no solid.
pub fn failure(error: &impl Display) -> String {
    format!("gives no solid: {error}")
}

fn ordinal(number: usize) -> String {
    const WORDS: [&str; 6] = ["first", "second", "third", "fourth", "fifth", "sixth"];
    match number.checked_sub(1).and_then(|k| WORDS.get(k)) {
        Some(word) => (*word).to_owned(),
        None => format!("{number}th"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::Candidate;

    /// Readings without faces; attempts tell them apart by their turn.
    fn found(alternatives: usize) -> Identification {
        Identification {
            engine: "test".into(),
            faces: Vec::new(),
            alternatives: vec![
                Candidate {
                    faces: Vec::new(),
                    score: 0.0
                };
                alternatives
            ],
            notices: Vec::new(),
            vertices: Vec::new(),
        }
    }

    /// Takes readings whose attempts have these faults.
    fn taken(faults: &[bool], alternatives: usize) -> (Taken<usize>, usize) {
        let mut tried = 0;
        let attempt = |_: &[Face]| {
            tried += 1;
            tried - 1
        };
        let fault = |k: &usize| faults[*k].then(|| format!("is wrong ({k})"));
        let taken = take(&found(faults.len() - 1), alternatives, attempt, fault);
        (taken, tried)
    }

    #[test]
    fn a_first_reading_without_fault_is_the_only_one_tried() {
        let (taken, tried) = taken(&[false, false], 5);
        assert_eq!((taken.reading, taken.notice, tried), (0, None, 1));
    }

    #[test]
    fn the_first_alternative_without_fault_is_taken_and_told() {
        let (taken, tried) = taken(&[true, true, false, false], 5);
        assert_eq!((taken.reading, taken.result, tried), (2, 2, 3));
        assert_eq!(
            taken.notice.unwrap(),
            "the third reading was taken: the first is wrong (0)"
        );
    }

    #[test]
    fn the_first_reading_stays_if_all_have_faults() {
        let (one, tried) = taken(&[true, true, true], 5);
        assert_eq!(
            (one.reading, one.result, one.notice, tried),
            (0, 0, None, 3)
        );
        let (limited, tried) = taken(&[true, true, false], 1);
        assert_eq!((limited.reading, tried), (0, 2));
        let (none, tried) = taken(&[true, false], 0);
        assert_eq!((none.reading, tried), (0, 1));
    }
}
