//! Progress and cancellation through a C callback.

use std::ffi::{CStr, c_char, c_void};

use faceformer::Stage;

/// Hears how far a long call is; null if nobody listens.
///
/// Gets the stage ("drawing", "identify", "lift", "plan" or "build"), the share done of that stage,
/// 0 to 1, and the pointer `user` given to the call. Returns 0 to cancel, anything else to go on. It
/// runs on the thread that made the call, and must not throw, jump out, or free the call's handles.
pub type FaceformerProgress =
    Option<unsafe extern "C" fn(stage: *const c_char, share: f64, user: *mut c_void) -> i32>;

/// A caller's callback with its pointer.
pub(crate) struct Watcher {
    callback: FaceformerProgress,
    user: *mut c_void,
}

impl Watcher {
    /// A watcher that passes progress on to `callback`.
    ///
    /// # Safety
    /// `callback` is null or may be called with `user` on this thread until the call ends.
    pub(crate) unsafe fn new(callback: FaceformerProgress, user: *mut c_void) -> Self {
        Self { callback, user }
    }

    /// Reports progress; `false` means that the caller wants to stop.
    pub(crate) fn report(&self, stage: Stage, share: f64) -> bool {
        // SAFETY: the callback may be called with its pointer by the contract of `new`; the name
        // is static and ends with a zero.
        self.callback
            .is_none_or(|call| unsafe { call(name(stage).as_ptr(), share, self.user) } != 0)
    }
}

fn name(stage: Stage) -> &'static CStr {
    match stage {
        Stage::Drawing => c"drawing",
        Stage::Identify => c"identify",
        Stage::Lift => c"lift",
        Stage::Plan => c"plan",
        Stage::Build => c"build",
        // `Stage` may grow; a caller shows what it does not know as it is.
        _ => c"other",
    }
}

#[cfg(test)]
mod tests {
    use std::ptr;

    use faceformer::{Error, Progress};

    use super::*;

    unsafe extern "C" fn until_half(stage: *const c_char, share: f64, user: *mut c_void) -> i32 {
        // SAFETY: the test passes a live list, and names are zero-terminated.
        let (seen, stage) = unsafe { (&mut *user.cast::<Vec<String>>(), CStr::from_ptr(stage)) };
        seen.push(stage.to_str().unwrap().to_owned());
        i32::from(share < 0.5)
    }

    #[test]
    fn the_callback_hears_stages_and_cancels() {
        let mut seen: Vec<String> = Vec::new();
        // SAFETY: `seen` lives longer than the watcher.
        let watcher = unsafe { Watcher::new(Some(until_half), (&raw mut seen).cast()) };
        let report = |stage, share| watcher.report(stage, share);
        let progress = Progress::new(&report);
        assert_eq!(progress.report(Stage::Lift, 0.0), Ok(()));
        assert_eq!(progress.report(Stage::Build, 0.5), Err(Error::Cancelled));
        assert_eq!(seen, ["lift", "build"]);
    }

    #[test]
    fn nobody_listening_never_cancels() {
        // SAFETY: there is no callback to call.
        let watcher = unsafe { Watcher::new(None, ptr::null_mut()) };
        assert!(watcher.report(Stage::Plan, 1.0));
    }
}
