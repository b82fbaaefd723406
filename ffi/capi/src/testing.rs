//! What the tests share: a drawing of a box, and wrappers that free what they get.

use std::ffi::{CStr, c_char, c_void};
use std::ptr;

use crate::*;

/// A slot for a string of the library, filled with garbage as a C caller's may be.
pub(crate) struct Message(*mut c_char);

impl Message {
    pub(crate) fn dirty() -> Self {
        Self(ptr::dangling_mut())
    }

    pub(crate) fn slot(&mut self) -> *mut *mut c_char {
        &raw mut self.0
    }

    /// The text that a call has put there, freed.
    pub(crate) fn take(self) -> Option<String> {
        if self.0.is_null() {
            return None;
        }
        // SAFETY: set by a call to null or to a string of this library.
        let text = unsafe { CStr::from_ptr(self.0) }
            .to_str()
            .unwrap()
            .to_owned();
        // SAFETY: freed once, since `self` ends here.
        unsafe { faceformer_string_free(self.0) };
        Some(text)
    }
}

/// What a call gave: a result, or the status and message of its failure.
pub(crate) type Called<T> = Result<T, (FaceformerStatus, String)>;

/// Calls a function that has one pointer as output.
pub(crate) fn call<T>(
    function: impl FnOnce(*mut *mut T, *mut *mut c_char) -> FaceformerStatus,
) -> Called<*mut T> {
    let mut out = ptr::dangling_mut();
    let mut message = Message::dirty();
    let status = function(&raw mut out, message.slot());
    match (status, message.take()) {
        (FaceformerStatus::Ok, None) => Ok(out),
        (FaceformerStatus::Ok, Some(text)) => panic!("message on success: {text}"),
        (status, text) => {
            assert!(out.is_null(), "output on failure");
            Err((status, text.expect("a message on failure")))
        }
    }
}

/// Calls a function that returns a string.
pub(crate) fn call_string(
    function: impl FnOnce(*mut *mut c_char, *mut *mut c_char) -> FaceformerStatus,
) -> Called<String> {
    call(function).map(|text| Message(text).take().unwrap())
}

macro_rules! owner {
    ($name:ident, $handle:ty, $free:path) => {
        /// A handle that is freed at the end of the test.
        #[derive(Debug)]
        pub(crate) struct $name(pub(crate) *mut $handle);

        impl Drop for $name {
            fn drop(&mut self) {
                // SAFETY: made by this library, freed once.
                unsafe { $free(self.0) };
            }
        }
    };
}

owner!(Drawing, FaceformerDrawing, faceformer_drawing_free);
owner!(Faces, FaceformerFaces, faceformer_faces_free);
owner!(Solid, FaceformerSolid, faceformer_solid_free);

impl Drawing {
    pub(crate) fn read(json: &[u8]) -> Called<Self> {
        // SAFETY: the slice is valid for its length, the slots are live.
        call(|out, message| unsafe {
            faceformer_drawing_read(json.as_ptr().cast(), json.len(), out, message)
        })
        .map(Self)
    }

    pub(crate) fn report(&self) -> serde_json::Value {
        // SAFETY: a live handle.
        let json = call_string(|json, message| unsafe {
            faceformer_drawing_report(self.0, json, message)
        });
        serde_json::from_str(&json.unwrap()).unwrap()
    }
}

impl Faces {
    pub(crate) fn identify(drawing: &Drawing, options: &str, mut share: f64) -> Called<Self> {
        // SAFETY: live handles and slots; the callback's number outlives the call.
        call(|out, message| unsafe {
            faceformer_identify(
                drawing.0,
                options.as_ptr().cast(),
                options.len(),
                Some(cancel_from),
                (&raw mut share).cast(),
                out,
                message,
            )
        })
        .map(Self)
    }

    pub(crate) fn read(drawing: &Drawing, json: &str) -> Called<Self> {
        // SAFETY: live handles and slots.
        call(|out, message| unsafe {
            faceformer_faces_read(drawing.0, json.as_ptr().cast(), json.len(), out, message)
        })
        .map(Self)
    }

    pub(crate) fn json(&self) -> serde_json::Value {
        // SAFETY: a live handle.
        let json =
            call_string(|json, message| unsafe { faceformer_faces_json(self.0, json, message) });
        serde_json::from_str(&json.unwrap()).unwrap()
    }
}

/// Lifts and reads the answer.
pub(crate) fn lift_json(
    drawing: &Drawing,
    faces: &Faces,
    options: &str,
) -> Called<serde_json::Value> {
    // SAFETY: live handles and slots.
    call_string(|json, message| unsafe {
        faceformer_lift(
            drawing.0,
            faces.0,
            options.as_ptr().cast(),
            options.len(),
            None,
            ptr::null_mut(),
            json,
            message,
        )
    })
    .map(|text| serde_json::from_str(&text).unwrap())
}

impl Solid {
    pub(crate) fn build(drawing: &Drawing, faces: &Faces, options: &str) -> Called<Self> {
        // SAFETY: live handles and slots.
        call(|out, message| unsafe {
            faceformer_solid(
                drawing.0,
                faces.0,
                options.as_ptr().cast(),
                options.len(),
                None,
                ptr::null_mut(),
                out,
                message,
            )
        })
        .map(Self)
    }

    /// Builds with a callback that stops at a stage, and returns how that ends.
    pub(crate) fn stop_at(drawing: &Drawing, faces: &Faces, stage: &CStr) -> FaceformerStatus {
        // SAFETY: live handles and slots; the stage outlives the call.
        call::<FaceformerSolid>(|out, message| unsafe {
            let user = stage.as_ptr().cast_mut().cast();
            let json = ptr::null();
            faceformer_solid(
                drawing.0,
                faces.0,
                json,
                0,
                Some(not_at),
                user,
                out,
                message,
            )
        })
        .map_or_else(
            |(status, _)| status,
            |solid| {
                drop(Self(solid));
                FaceformerStatus::Ok
            },
        )
    }

    pub(crate) fn report(&self) -> serde_json::Value {
        // SAFETY: a live handle.
        let json =
            call_string(|json, message| unsafe { faceformer_solid_report(self.0, json, message) });
        serde_json::from_str(&json.unwrap()).unwrap()
    }

    pub(crate) fn brep(&self) -> Vec<u8> {
        let mut len = 7;
        // SAFETY: a live handle and live slots.
        let bytes = call(|out, message| unsafe {
            faceformer_solid_brep(self.0, out, &raw mut len, message)
        })
        .unwrap();
        // SAFETY: the library gave the bytes with their length.
        let owned = unsafe { std::slice::from_raw_parts(bytes, len) }.to_vec();
        // SAFETY: freed once with their length.
        unsafe { faceformer_bytes_free(bytes, len) };
        owned
    }

    pub(crate) fn write(&self, path: &CStr, format: &CStr) -> Called<()> {
        let mut message = Message::dirty();
        // SAFETY: a live handle, zero-terminated texts, a live slot.
        let status = unsafe {
            faceformer_solid_write(self.0, path.as_ptr(), format.as_ptr(), message.slot())
        };
        match (status, message.take()) {
            (FaceformerStatus::Ok, None) => Ok(()),
            (status, text) => Err((status, text.expect("a message on failure alone"))),
        }
    }
}

/// Goes on unless the stage is the one that `user` points to.
unsafe extern "C" fn not_at(stage: *const c_char, _: f64, user: *mut c_void) -> i32 {
    // SAFETY: both are zero-terminated.
    i32::from(unsafe { CStr::from_ptr(stage) != CStr::from_ptr(user.cast()) })
}

/// Goes on until the share in the number that `user` points to is reached.
pub(crate) unsafe extern "C" fn cancel_from(
    stage: *const c_char,
    share: f64,
    user: *mut c_void,
) -> i32 {
    assert!(!stage.is_null() && (0.0..=1.0).contains(&share));
    // SAFETY: the tests pass a live number.
    i32::from(share < unsafe { *user.cast::<f64>() })
}

/// The box 2 x 3 x 4 seen from (1, 1.4, 0.8), as the vertices of its drawing.
fn box_vertices() -> [[f64; 2]; 8] {
    let (yaw, pitch) = (0.62_f64, 0.5_f64);
    std::array::from_fn(|i| {
        let [x, y, z] =
            [(1, 2.0), (2, 3.0), (4, 4.0)].map(|(bit, size)| if i & bit == 0 { 0.0 } else { size });
        let (right, back) = (x * yaw.cos() - y * yaw.sin(), x * yaw.sin() + y * yaw.cos());
        [right, z * pitch.cos() + back * pitch.sin()]
    })
}

/// Ends of the box's edges: vertices that differ in one coordinate.
const BOX_EDGES: [[usize; 2]; 12] = [
    [0, 1],
    [2, 3],
    [4, 5],
    [6, 7],
    [0, 2],
    [1, 3],
    [4, 6],
    [5, 7],
    [0, 4],
    [1, 5],
    [2, 6],
    [3, 7],
];

/// The box's faces as signed edge numbers.
pub(crate) const BOX_FACES: &str = r#"{"faces": [
    {"type": "plane", "loops": [[1, 6, -2, -5]]}, {"type": "plane", "loops": [[3, 8, -4, -7]]},
    {"type": "plane", "loops": [[1, 10, -3, -9]]}, {"type": "plane", "loops": [[2, 12, -4, -11]]},
    {"type": "plane", "loops": [[5, 11, -7, -9]]}, {"type": "plane", "loops": [[6, 12, -8, -10]]}
]}"#;

/// Interchange JSON of the box.
pub(crate) fn box_json() -> String {
    let v = box_vertices();
    let edges: Vec<_> = BOX_EDGES
        .iter()
        .map(|&[a, b]| serde_json::json!({"v": [a, b], "points": [v[a], v[b]]}))
        .collect();
    serde_json::json!({"vertices": v, "edges": edges}).to_string()
}

/// The first `count` edges of the box as a plain list.
pub(crate) fn box_edge_list(count: usize) -> String {
    let v = box_vertices();
    let edges: Vec<_> = BOX_EDGES[..count]
        .iter()
        .enumerate()
        .map(|(i, &[a, b])| serde_json::json!({"name": format!("Edge{}", i + 1), "points": [v[a], v[b]]}))
        .collect();
    serde_json::json!({ "edges": edges }).to_string()
}
