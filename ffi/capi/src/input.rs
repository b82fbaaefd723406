//! Checks of what a caller passes in.

use std::ffi::{CStr, c_char};

use serde::de::DeserializeOwned;

use crate::error::CallError;

/// Most bytes of one JSON input: 256 MiB. The limits on a drawing's size are far below; this one
/// keeps a wrong length from being read at all.
pub(crate) const MAX_INPUT: usize = 256 << 20;

/// The handle behind a pointer.
///
/// # Safety
/// `handle` is null, or came from this library and is not freed before the call ends.
pub(crate) unsafe fn handle<'a, T>(
    handle: *const T,
    what: &'static str,
) -> Result<&'a T, CallError> {
    // SAFETY: by this function's contract the pointer is null or points to a live `T`, which
    // nobody changes, since handles are immutable.
    unsafe { handle.as_ref() }.ok_or(CallError::Null(what))
}

/// Text of `len` bytes.
///
/// # Safety
/// `text` is null, or valid for reads of `len` bytes, which nobody changes until the call ends.
pub(crate) unsafe fn text<'a>(
    text: *const c_char,
    len: usize,
    what: &'static str,
) -> Result<&'a str, CallError> {
    if text.is_null() {
        return Err(CallError::Null(what));
    }
    if len > MAX_INPUT {
        return Err(CallError::TooLong {
            what,
            len,
            limit: MAX_INPUT,
        });
    }
    // SAFETY: not null, `len` is below `isize::MAX`, and the bytes are readable and stay as they
    // are by this function's contract.
    let bytes = unsafe { std::slice::from_raw_parts(text.cast::<u8>(), len) };
    utf8(bytes, what)
}

/// Text that ends with a zero byte.
///
/// # Safety
/// `text` is null, or points to bytes that end with a zero and that nobody changes until the call
/// ends.
pub(crate) unsafe fn c_text<'a>(
    text: *const c_char,
    what: &'static str,
) -> Result<&'a str, CallError> {
    if text.is_null() {
        return Err(CallError::Null(what));
    }
    // SAFETY: not null, and ends with a zero by this function's contract.
    let bytes = unsafe { CStr::from_ptr(text) }.to_bytes();
    utf8(bytes, what)
}

/// Options as a JSON object; the defaults if the pointer is null.
///
/// # Safety
/// As for [`text`].
pub(crate) unsafe fn options<T: DeserializeOwned + Default>(
    json: *const c_char,
    len: usize,
) -> Result<T, CallError> {
    if json.is_null() {
        return Ok(T::default());
    }
    // SAFETY: passed on from this function's contract.
    let text = unsafe { text(json, len, "options_json") }?;
    serde_json::from_str(text).map_err(CallError::Options)
}

fn utf8<'a>(bytes: &'a [u8], what: &'static str) -> Result<&'a str, CallError> {
    std::str::from_utf8(bytes).map_err(|e| CallError::Utf8 {
        what,
        at: e.valid_up_to(),
    })
}

#[cfg(test)]
mod tests {
    use std::ptr;

    use super::*;

    fn read(bytes: &[u8]) -> Result<&str, CallError> {
        // SAFETY: the slice is valid for its length.
        unsafe { text(bytes.as_ptr().cast(), bytes.len(), "json") }
    }

    #[test]
    fn text_is_checked() {
        assert_eq!(read("Kante ä".as_bytes()).unwrap(), "Kante ä");
        assert_eq!(read(b"").unwrap(), "");
        assert!(matches!(
            read(b"ab\xff"),
            Err(CallError::Utf8 { at: 2, .. })
        ));
    }

    #[test]
    fn null_and_absurd_lengths_are_refused_unread() {
        // SAFETY: null is allowed.
        let null = unsafe { text(ptr::null(), 5, "json") };
        assert!(matches!(null, Err(CallError::Null("json"))));
        // SAFETY: nothing is read, since the length is refused first.
        let long = unsafe { text(c"x".as_ptr(), usize::MAX, "json") };
        assert!(matches!(
            long,
            Err(CallError::TooLong {
                len: usize::MAX,
                ..
            })
        ));
        // SAFETY: null is allowed.
        let none = unsafe { handle(ptr::null::<u8>(), "faces") };
        assert!(matches!(none, Err(CallError::Null("faces"))));
    }

    #[test]
    fn options_default_and_refuse_garbage() {
        #[derive(Debug, Default, PartialEq, serde::Deserialize)]
        #[serde(default, deny_unknown_fields)]
        struct Options {
            flip: bool,
        }
        // SAFETY: null is allowed.
        let none: Options = unsafe { options(ptr::null(), 0) }.unwrap();
        assert_eq!(none, Options::default());
        for (json, good) in [
            (r#"{"flip":true}"#, true),
            (r#"{"flop":1}"#, false),
            ("", false),
        ] {
            // SAFETY: the string is valid for its length.
            let read: Result<Options, _> = unsafe { options(json.as_ptr().cast(), json.len()) };
            assert_eq!(read.is_ok(), good, "{json}");
        }
    }
}
