//! Progress reports and cancellation for long calls.

use crate::Error;

/// The part of the way a long call is in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stage {
    /// Cleaning and checking the drawing.
    Drawing,
    /// Identifying faces.
    Identify,
    /// Recovering depth.
    Lift,
    /// Planning the B-rep.
    Plan,
    /// Building the solid in the CAD kernel.
    Build,
}

/// A caller's view of a long call: hears how far it is, and may stop it.
///
/// The callback gets the stage and the share done in it, 0 to 1, and returns `false` to cancel.
#[derive(Clone, Copy)]
pub struct Progress<'a>(Option<&'a dyn Fn(Stage, f64) -> bool>);

impl<'a> Progress<'a> {
    /// Progress that nobody watches and nobody cancels.
    pub const fn none() -> Self {
        Self(None)
    }

    /// Progress that goes to `callback`.
    pub const fn new(callback: &'a dyn Fn(Stage, f64) -> bool) -> Self {
        Self(Some(callback))
    }

    /// Reports the share done of a stage.
    ///
    /// # Errors
    /// [`Error::Cancelled`] if the callback returned `false`.
    pub fn report(&self, stage: Stage, share: f64) -> Result<(), Error> {
        match self.0 {
            Some(callback) if !callback(stage, share) => Err(Error::Cancelled),
            _ => Ok(()),
        }
    }
}

impl std::fmt::Debug for Progress<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Progress").field(&self.0.is_some()).finish()
    }
}
