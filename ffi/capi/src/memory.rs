//! What the library hands out and the caller frees.

use std::ffi::{CString, c_char};

use serde::Serialize;

use crate::error::CallError;
use crate::guard::guard_free;

/// A string for the caller, to be freed with [`faceformer_string_free`].
///
/// A zero byte would end the text early in C, so it becomes the replacement character; JSON and
/// the library's own messages have none, but a message may quote a name from the input.
pub(crate) fn new_string(text: String) -> *mut c_char {
    match CString::new(text) {
        Ok(text) => text.into_raw(),
        Err(e) => {
            let clean = String::from_utf8_lossy(&e.into_vec()).replace('\0', "\u{fffd}");
            CString::new(clean).unwrap_or_default().into_raw()
        }
    }
}

/// JSON for the caller, to be freed with [`faceformer_string_free`].
pub(crate) fn new_json(value: &impl Serialize) -> Result<*mut c_char, CallError> {
    serde_json::to_string(value)
        .map(new_string)
        .map_err(CallError::Json)
}

/// Bytes for the caller, to be freed with [`faceformer_bytes_free`].
pub(crate) fn new_bytes(bytes: Vec<u8>) -> (*mut u8, usize) {
    let bytes = bytes.into_boxed_slice();
    let len = bytes.len();
    (Box::into_raw(bytes).cast(), len)
}

/// Frees a handle made by `Box::into_raw`; null does nothing.
///
/// # Safety
/// `handle` is null, or came from `Box::into_raw` and is neither used nor freed again.
pub(crate) unsafe fn free_handle<T>(handle: *mut T) {
    if !handle.is_null() {
        // SAFETY: from `Box::into_raw` and freed only here, by this function's contract.
        guard_free(|| drop(unsafe { Box::from_raw(handle) }));
    }
}

/// Frees a string or message that this library returned. Null does nothing.
///
/// Any thread may call this.
///
/// # Safety
/// `text` is null, or came from this library and is freed once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn faceformer_string_free(text: *mut c_char) {
    if !text.is_null() {
        // SAFETY: every string this library returns comes from `CString::into_raw`.
        guard_free(|| drop(unsafe { CString::from_raw(text) }));
    }
}

/// Frees bytes that this library returned, given the length that came with them. Null does nothing.
///
/// Any thread may call this.
///
/// # Safety
/// `bytes` is null, or came from this library with the length `len` and is freed once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn faceformer_bytes_free(bytes: *mut u8, len: usize) {
    if !bytes.is_null() {
        let slice = std::ptr::slice_from_raw_parts_mut(bytes, len);
        // SAFETY: all bytes this library returns come from a boxed slice of that length.
        guard_free(|| drop(unsafe { Box::from_raw(slice) }));
    }
}

#[cfg(test)]
mod tests {
    use std::ffi::CStr;
    use std::ptr;

    use super::*;

    #[test]
    fn zero_bytes_do_not_cut_a_message() {
        let text = new_string("edge \"a\0b\" is open".into());
        // SAFETY: just made by this library.
        let read = unsafe { CStr::from_ptr(text) }.to_str().unwrap().to_owned();
        assert_eq!(read, "edge \"a\u{fffd}b\" is open");
        // SAFETY: freed once.
        unsafe { faceformer_string_free(text) };
    }

    #[test]
    fn bytes_round_trip_even_without_any() {
        for bytes in [Vec::new(), vec![1_u8, 0, 3]] {
            let (start, len) = new_bytes(bytes.clone());
            // SAFETY: just made by this library.
            assert_eq!(unsafe { std::slice::from_raw_parts(start, len) }, bytes);
            // SAFETY: freed once with its length.
            unsafe { faceformer_bytes_free(start, len) };
        }
    }

    #[test]
    fn null_is_freed_in_peace() {
        // SAFETY: null is allowed everywhere.
        unsafe {
            faceformer_string_free(ptr::null_mut());
            faceformer_bytes_free(ptr::null_mut(), 9);
            free_handle(ptr::null_mut::<u8>());
        }
    }
}
