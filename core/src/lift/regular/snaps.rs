//! What is decided after a first fit: which directions, offsets and radii are one.

use super::draft::Draft;
use super::fit::{Fitted, judged};
use super::report::Snap;
use crate::lift::LiftError;

/// Decides and fits again.
pub(super) fn settle(draft: &mut Draft<'_, '_>) -> Result<(Fitted, Vec<Snap>), LiftError> {
    let fitted = judged(&draft.problem);
    Ok((fitted, Vec::new()))
}
