//! What every call has in common: outputs that are always initialised, and no unwinding out.
//!
//! Unwinding out of an `extern "C"` function aborts the process, which would take FreeCAD with
//! it. So each function of the ABI runs inside [`guard`], and a panic becomes a status.

use std::any::Any;
use std::ffi::c_char;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;

use crate::FaceformerStatus;
use crate::error::CallError;
use crate::memory::new_string;

/// An output of a call, set to its empty value before anything else happens.
pub(crate) struct Out<T> {
    slot: *mut T,
    name: &'static str,
}

impl<T> Out<*mut T> {
    /// Takes the caller's slot for a pointer and writes null to it, if there is one.
    ///
    /// # Safety
    /// As for [`new`](Self::new).
    pub(crate) unsafe fn null(slot: *mut *mut T, name: &'static str) -> Self {
        // SAFETY: passed on from this function's contract.
        unsafe { Self::new(slot, name, ptr::null_mut()) }
    }
}

impl<T> Out<T> {
    /// Takes the caller's slot and writes `empty` to it, if there is one.
    ///
    /// # Safety
    /// `slot` is null, or valid for writes of a `T` until the call ends.
    pub(crate) unsafe fn new(slot: *mut T, name: &'static str, empty: T) -> Self {
        if !slot.is_null() {
            // SAFETY: not null, and valid for writes by this function's contract. `write` does not
            // drop the old value, which may be uninitialised.
            unsafe { slot.write(empty) };
        }
        Self { slot, name }
    }

    /// Refuses a call that gave no place for its result, before any work is done for it.
    pub(crate) fn check(&self) -> Result<(), CallError> {
        if self.slot.is_null() {
            Err(CallError::Null(self.name))
        } else {
            Ok(())
        }
    }

    /// Hands the result to the caller. Does nothing if the slot is null.
    pub(crate) fn put(&self, value: T) {
        if !self.slot.is_null() {
            // SAFETY: valid for writes by the contract of `new`; the empty value needs no drop.
            unsafe { self.slot.write(value) };
        }
    }
}

/// Runs `work`, keeps its panics inside and turns its outcome into a status and a message.
pub(crate) fn guard(
    message: &Out<*mut c_char>,
    work: impl FnOnce() -> Result<(), CallError>,
) -> FaceformerStatus {
    // The handles that the work borrows are immutable, so a panic leaves nothing half changed.
    let (status, text) = match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(())) => return FaceformerStatus::Ok,
        Ok(Err(error)) => (error.status(), error.to_string()),
        Err(payload) => (FaceformerStatus::Panic, panic_text(payload)),
    };
    if message.check().is_ok() {
        message.put(new_string(text));
    }
    status
}

/// Frees what a handle owns, keeping panics inside: nobody could hear of them.
pub(crate) fn guard_free(work: impl FnOnce()) {
    if let Err(payload) = catch_unwind(AssertUnwindSafe(work)) {
        std::mem::forget(payload);
    }
}

fn panic_text(payload: Box<dyn Any + Send>) -> String {
    let what = payload
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| payload.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no details")
        .to_owned();
    // Dropping a payload of an unknown type may panic once more, outside of any guard.
    std::mem::forget(payload);
    format!("internal error, please report it with the drawing: {what}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Message;

    fn run(work: impl FnOnce() -> Result<(), CallError>) -> (FaceformerStatus, Option<String>) {
        let mut message = Message::dirty();
        // SAFETY: the message slot is a live local.
        let out = unsafe { Out::null(message.slot(), "message") };
        (guard(&out, work), message.take())
    }

    #[test]
    fn success_clears_the_message() {
        assert_eq!(run(|| Ok(())), (FaceformerStatus::Ok, None));
    }

    #[test]
    fn a_panic_becomes_a_status_with_its_text() {
        let (status, text) = run(|| panic!("face {} fell off", 7));
        assert_eq!(status, FaceformerStatus::Panic);
        assert!(text.unwrap().contains("face 7 fell off"));
        let (status, text) = run(|| std::panic::panic_any(7_u8));
        assert_eq!(status, FaceformerStatus::Panic);
        assert!(text.unwrap().contains("no details"));
    }

    #[test]
    fn errors_carry_their_status() {
        let (status, text) = run(|| Err(CallError::Null("json")));
        assert_eq!(status, FaceformerStatus::BadInput);
        assert_eq!(text.unwrap(), "the argument json is null");
        let (status, text) = run(|| Err(faceformer::Error::Cancelled.into()));
        assert_eq!(status, FaceformerStatus::Cancelled);
        assert_eq!(text.unwrap(), "cancelled");
    }

    #[test]
    fn the_message_is_optional() {
        // SAFETY: a null slot is allowed.
        let out = unsafe { Out::null(ptr::null_mut(), "message") };
        let status = guard(&out, || Err(CallError::Null("out")));
        assert_eq!(status, FaceformerStatus::BadInput);
    }

    #[test]
    fn outputs_are_initialised_first() {
        let mut value = 7_usize;
        // SAFETY: the slot is a live local.
        let out = unsafe { Out::new(&raw mut value, "out", 0) };
        assert!(out.check().is_ok());
        assert_eq!(value, 0);
        // SAFETY: a null slot is allowed.
        let out = unsafe { Out::<usize>::new(ptr::null_mut(), "out", 0) };
        assert!(matches!(out.check(), Err(CallError::Null("out"))));
        out.put(3);
    }
}
