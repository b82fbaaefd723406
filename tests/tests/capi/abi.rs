//! The ABI loaded at run time, as FreeCAD does it.

use std::ffi::{CStr, c_char, c_void};
use std::ptr;

use libloading::{Library, Symbol};

use super::library;

/// `FaceformerStatus` of the header.
pub(crate) const OK: i32 = 0;
pub(crate) const FAILED: i32 = 1;
pub(crate) const BAD_INPUT: i32 = 2;

type Handle = *mut c_void;
type Text = *mut c_char;
type Progress = Option<unsafe extern "C" fn(*const c_char, f64, *mut c_void) -> i32>;
type Read = unsafe extern "C" fn(*const c_char, usize, *mut Handle, *mut Text) -> i32;
type Report = unsafe extern "C" fn(Handle, *mut Text, *mut Text) -> i32;
type Identify = unsafe extern "C" fn(
    Handle,
    *const c_char,
    usize,
    Progress,
    *mut c_void,
    *mut Handle,
    *mut Text,
) -> i32;

type ReadFaces = unsafe extern "C" fn(Handle, *const c_char, usize, *mut Handle, *mut Text) -> i32;
type Lift = unsafe extern "C" fn(
    Handle,
    Handle,
    *const c_char,
    usize,
    Progress,
    *mut c_void,
    *mut Text,
    *mut Text,
) -> i32;

/// The loaded library.
pub(crate) struct Abi(Library);

/// What a call gave: its status, its message, and a result if there is one.
pub(crate) struct Answer<T> {
    pub(crate) status: i32,
    pub(crate) message: String,
    pub(crate) value: Option<T>,
}

/// A handle of a drawing, freed at the end.
pub(crate) struct Drawing<'a>(&'a Abi, Handle);

impl Drop for Drawing<'_> {
    fn drop(&mut self) {
        // SAFETY: the handle is live and freed once.
        unsafe {
            self.0
                .symbol::<unsafe extern "C" fn(Handle)>("faceformer_drawing_free")(
                self.1
            )
        };
    }
}

/// A handle of faces, freed at the end.
pub(crate) struct Faces<'a>(&'a Abi, Handle);

impl Drop for Faces<'_> {
    fn drop(&mut self) {
        // SAFETY: the handle is live and freed once.
        unsafe {
            self.0
                .symbol::<unsafe extern "C" fn(Handle)>("faceformer_faces_free")(self.1);
        };
    }
}

impl Abi {
    pub(crate) fn load() -> Self {
        // SAFETY: the library has no initialisers beyond those of its runtimes.
        Self(unsafe { Library::new(library::path()) }.unwrap())
    }

    fn symbol<T>(&self, name: &str) -> Symbol<'_, T> {
        // SAFETY: the callers name types that are those of the header.
        unsafe { self.0.get(name.as_bytes()) }.unwrap()
    }

    fn take(&self, text: Text) -> Option<String> {
        if text.is_null() {
            return None;
        }
        // SAFETY: strings of the library end with a zero.
        let owned = unsafe { CStr::from_ptr(text) }.to_str().unwrap().to_owned();
        // SAFETY: freed once.
        unsafe { self.symbol::<unsafe extern "C" fn(Text)>("faceformer_string_free")(text) };
        Some(owned)
    }

    pub(crate) fn version(&self) -> u32 {
        // SAFETY: no arguments.
        unsafe { self.symbol::<unsafe extern "C" fn() -> u32>("faceformer_abi_version")() }
    }

    pub(crate) fn read(&self, json: &[u8]) -> Answer<Drawing<'_>> {
        let (mut out, mut message) = (ptr::dangling_mut(), ptr::dangling_mut());
        // SAFETY: the slice is valid for its length, the slots are live.
        let status = unsafe {
            self.symbol::<Read>("faceformer_drawing_read")(
                json.as_ptr().cast(),
                json.len(),
                &raw mut out,
                &raw mut message,
            )
        };
        assert_eq!(out.is_null(), status != OK);
        Answer {
            status,
            message: self.take(message).unwrap_or_default(),
            value: (!out.is_null()).then(|| Drawing(self, out)),
        }
    }

    pub(crate) fn report(&self, drawing: &Drawing<'_>) -> serde_json::Value {
        let (mut json, mut message) = (ptr::null_mut(), ptr::null_mut());
        // SAFETY: a live handle and live slots.
        let status = unsafe {
            self.symbol::<Report>("faceformer_drawing_report")(
                drawing.1,
                &raw mut json,
                &raw mut message,
            )
        };
        assert_eq!(status, OK, "{:?}", self.take(message));
        serde_json::from_str(&self.take(json).unwrap()).unwrap()
    }

    /// Identifies with the default engine.
    pub(crate) fn identify(&self, drawing: &Drawing<'_>) -> Answer<Faces<'_>> {
        let (mut out, mut message) = (ptr::dangling_mut(), ptr::dangling_mut());
        // SAFETY: a live handle, no options, no callback, live slots.
        let status = unsafe {
            self.symbol::<Identify>("faceformer_identify")(
                drawing.1,
                ptr::null(),
                0,
                None,
                ptr::null_mut(),
                &raw mut out,
                &raw mut message,
            )
        };
        self.faces(status, message, out)
    }

    pub(crate) fn read_faces(&self, drawing: &Drawing<'_>, json: &str) -> Answer<Faces<'_>> {
        let (mut out, mut message) = (ptr::dangling_mut(), ptr::dangling_mut());
        // SAFETY: a live handle, text that is valid for its length, live slots.
        let status = unsafe {
            self.symbol::<ReadFaces>("faceformer_faces_read")(
                drawing.1,
                json.as_ptr().cast(),
                json.len(),
                &raw mut out,
                &raw mut message,
            )
        };
        self.faces(status, message, out)
    }

    fn faces(&self, status: i32, message: Text, out: Handle) -> Answer<Faces<'_>> {
        assert_eq!(out.is_null(), status != OK);
        Answer {
            status,
            message: self.take(message).unwrap_or_default(),
            value: (!out.is_null()).then(|| Faces(self, out)),
        }
    }

    /// The faces as JSON.
    pub(crate) fn faces_json(&self, faces: &Faces<'_>) -> serde_json::Value {
        let (mut json, mut message) = (ptr::null_mut(), ptr::null_mut());
        // SAFETY: a live handle and live slots.
        let status = unsafe {
            self.symbol::<Report>("faceformer_faces_json")(faces.1, &raw mut json, &raw mut message)
        };
        assert_eq!(status, OK, "{:?}", self.take(message));
        serde_json::from_str(&self.take(json).unwrap()).unwrap()
    }

    /// Depths, surfaces and conflicts as JSON.
    pub(crate) fn lift(
        &self,
        drawing: &Drawing<'_>,
        faces: &Faces<'_>,
    ) -> Answer<serde_json::Value> {
        let (mut json, mut message) = (ptr::dangling_mut(), ptr::dangling_mut());
        // SAFETY: live handles, no options, no callback, live slots.
        let status = unsafe {
            self.symbol::<Lift>("faceformer_lift")(
                drawing.1,
                faces.1,
                ptr::null(),
                0,
                None,
                ptr::null_mut(),
                &raw mut json,
                &raw mut message,
            )
        };
        Answer {
            status,
            message: self.take(message).unwrap_or_default(),
            value: self
                .take(json)
                .map(|text| serde_json::from_str(&text).unwrap()),
        }
    }
}
