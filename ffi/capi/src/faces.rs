//! Faces: identified by an engine or given by the caller.

use std::ffi::{c_char, c_void};
use std::sync::Arc;

use faceformer::drawing::CleanDrawing;
use faceformer::identify::{self, EngineKind, Identification};
use faceformer::{Error, Progress};
use serde::Deserialize;

use crate::FaceformerStatus;
use crate::drawing::FaceformerDrawing;
use crate::error::CallError;
use crate::guard::{Out, guard};
use crate::input;
use crate::memory::{free_handle, new_json};
use crate::progress::{FaceformerProgress, Watcher};

/// Faces of one drawing.
///
/// They never change: several threads may use them at once.
pub struct FaceformerFaces {
    pub(crate) drawing: Arc<CleanDrawing>,
    pub(crate) found: Identification,
}

impl FaceformerFaces {
    fn leak(drawing: &FaceformerDrawing, found: Identification) -> *mut Self {
        Box::into_raw(Box::new(Self {
            drawing: Arc::clone(&drawing.0),
            found,
        }))
    }

    /// Whether these are faces of that drawing.
    pub(crate) fn check(&self, drawing: &FaceformerDrawing) -> Result<(), CallError> {
        if Arc::ptr_eq(&drawing.0, &self.drawing) {
            Ok(())
        } else {
            Err(CallError::OtherDrawing)
        }
    }
}

#[derive(Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct IdentifyOptions {
    engine: String,
    model: Option<String>,
}

impl Default for IdentifyOptions {
    fn default() -> Self {
        Self {
            engine: EngineKind::default().to_string(),
            model: None,
        }
    }
}

/// Identifies the faces of a drawing.
///
/// `options_json` has `len` bytes: `{"engine": "rotation"}`, every key optional, null for the
/// defaults. `faceformer_info` lists the engines. `callback` is null or hears progress and may
/// cancel; it gets `user`.
///
/// With `"model": "FILE"` the engine rotation uses the trained model in that file, with
/// `"model": "none"` its hand-made scores, and else the file that the environment variable
/// `FACEFORMER_MODEL` names, or the library's own model. If a model cannot be used, the hand-made
/// scores are, and the faces' `notices` say so. The paper's engines take a file in the same ways;
/// faceformer has a small model of its own, and without a model that can be used they refuse every
/// drawing.
///
/// Returns `FACEFORMER_STATUS_FAILED` if the engine cannot handle the drawing (an edge ends freely,
/// no consistent faces exist; the message names the edge), `FACEFORMER_STATUS_CANCELLED` if the
/// callback returned 0. Any thread may call this, several at once with the same drawing. Free
/// `*out` with `faceformer_faces_free`.
///
/// # Safety
/// `drawing` is a live handle or null, `options_json` is null or valid for reads of `len` bytes,
/// `callback` is null or may be called with `user`, `out` is valid for writes, `message` is null or
/// valid for writes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn faceformer_identify(
    drawing: *const FaceformerDrawing,
    options_json: *const c_char,
    len: usize,
    callback: FaceformerProgress,
    user: *mut c_void,
    out: *mut *mut FaceformerFaces,
    message: *mut *mut c_char,
) -> FaceformerStatus {
    // SAFETY: outputs are null or valid for writes by this function's contract.
    let (out, message) = unsafe { (Out::null(out, "out"), Out::null(message, "message")) };
    guard(&message, || {
        out.check()?;
        // SAFETY: a live handle or null by this function's contract.
        let drawing = unsafe { input::handle(drawing, "drawing") }?;
        // SAFETY: null or valid for reads of `len` bytes by this function's contract.
        let options: IdentifyOptions = unsafe { input::options(options_json, len) }?;
        let kind: EngineKind = options.engine.parse().map_err(Error::Identify)?;
        // SAFETY: the callback may be called with `user` by this function's contract.
        let watcher = unsafe { Watcher::new(callback, user) };
        let report = |stage, share| watcher.report(stage, share);
        let found = identify::engine_with_model(kind, options.model.as_deref())
            .identify(&drawing.0.drawing, Progress::new(&report))?;
        out.put(FaceformerFaces::leak(drawing, found));
        Ok(())
    })
}

/// Takes faces from the caller: `len` bytes of JSON in the form of `faceformer_faces_json`, edited
/// or from elsewhere. `{"faces": [{"type": "plane", "loops": [[1, 2, -3]]}]}` is enough.
///
/// Every loop must be a closed walk over edges of `drawing`; whether the faces bound a solid is
/// found out by `faceformer_solid`.
///
/// Returns `FACEFORMER_STATUS_BAD_INPUT` if the faces do not fit the drawing; the message names the
/// face. Any thread may call this. Free `*out` with `faceformer_faces_free`.
///
/// # Safety
/// `drawing` is a live handle or null, `json` is valid for reads of `len` bytes, `out` is valid for
/// writes, `message` is null or valid for writes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn faceformer_faces_read(
    drawing: *const FaceformerDrawing,
    json: *const c_char,
    len: usize,
    out: *mut *mut FaceformerFaces,
    message: *mut *mut c_char,
) -> FaceformerStatus {
    // SAFETY: outputs are null or valid for writes by this function's contract.
    let (out, message) = unsafe { (Out::null(out, "out"), Out::null(message, "message")) };
    guard(&message, || {
        out.check()?;
        // SAFETY: a live handle or null by this function's contract.
        let drawing = unsafe { input::handle(drawing, "drawing") }?;
        // SAFETY: valid for reads of `len` bytes by this function's contract.
        let text = unsafe { input::text(json, len, "json") }?;
        let found = identify::read_faces(&drawing.0.drawing, text).map_err(Error::Identify)?;
        out.put(FaceformerFaces::leak(drawing, found));
        Ok(())
    })
}

/// Lists the faces as a JSON object: `{"engine": "rotation", "faces": [...], "alternatives":
/// [...], "notices": [...]}`.
///
/// A face has `type` ("plane", "cylinder", "cone", "sphere", "torus", "other"), `loops` of signed
/// edge numbers (`k` is edge `k` of the drawing, counted from 1, walked forwards, `-k` backwards),
/// `confidence` from 0 to 1 and `evidence`. `alternatives` are further sets of faces, best first:
/// to use one, give its `faces` to `faceformer_faces_read`.
///
/// Any thread may call this. Free `*json` with `faceformer_string_free`.
///
/// # Safety
/// `faces` is a live handle or null, `json` is valid for writes, `message` is null or valid for
/// writes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn faceformer_faces_json(
    faces: *const FaceformerFaces,
    json: *mut *mut c_char,
    message: *mut *mut c_char,
) -> FaceformerStatus {
    // SAFETY: outputs are null or valid for writes by this function's contract.
    let (json, message) = unsafe { (Out::null(json, "json"), Out::null(message, "message")) };
    guard(&message, || {
        json.check()?;
        // SAFETY: a live handle or null by this function's contract.
        let faces = unsafe { input::handle(faces, "faces") }?;
        json.put(new_json(&faces.found)?);
        Ok(())
    })
}

/// Frees faces. Null does nothing. No call may be using them.
///
/// # Safety
/// `faces` is null, or a live handle that is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn faceformer_faces_free(faces: *mut FaceformerFaces) {
    // SAFETY: made by `Box::into_raw`, and not used again by this function's contract.
    unsafe { free_handle(faces) };
}

#[cfg(test)]
mod tests {
    use crate::FaceformerStatus;
    use crate::testing::{self, BOX_FACES, Drawing, Faces};

    fn drawing() -> Drawing {
        Drawing::read(testing::box_json().as_bytes()).unwrap()
    }

    #[test]
    fn every_engine_finds_the_six_faces_of_a_box() {
        let all = faceformer::identify::EngineKind::ALL;
        for engine in all.into_iter().filter(|e| !e.needs_model()) {
            let options = format!("{{\"engine\": \"{engine}\"}}");
            let faces = Faces::identify(&drawing(), &options, 2.0).unwrap().json();
            assert_eq!(faces["faces"].as_array().unwrap().len(), 6, "{engine}");
            assert_eq!(faces["engine"], engine.to_string());
        }
    }

    #[test]
    fn faces_go_out_and_come_in_again() {
        let drawing = drawing();
        let first = Faces::read(&drawing, BOX_FACES).unwrap().json();
        assert_eq!(
            Faces::read(&drawing, &first.to_string()).unwrap().json(),
            first
        );
    }

    #[test]
    fn the_callback_cancels() {
        let (status, message) = Faces::identify(&drawing(), "{}", 0.0).unwrap_err();
        assert_eq!(
            (status, message.as_str()),
            (FaceformerStatus::Cancelled, "cancelled")
        );
    }

    #[test]
    fn wrong_options_and_faces_are_bad_input() {
        for options in ["{\"engine\": \"magic\"}", "{\"motor\": 1}", "[", "null"] {
            let (status, message) = Faces::identify(&drawing(), options, 2.0).unwrap_err();
            assert_eq!(status, FaceformerStatus::BadInput, "{options}: {message}");
        }
        for faces in [
            "{}",
            "",
            r#"{"faces": [{"type": "plane", "loops": [[1, 99]]}]}"#,
        ] {
            let (status, message) = Faces::read(&drawing(), faces).unwrap_err();
            assert_eq!(status, FaceformerStatus::BadInput, "{faces}: {message}");
        }
    }

    #[test]
    fn an_open_wire_fails_by_name() {
        let open = Drawing::read(testing::box_edge_list(2).as_bytes()).unwrap();
        let (status, message) = Faces::identify(&open, "{}", 2.0).unwrap_err();
        assert_eq!(status, FaceformerStatus::Failed);
        assert!(message.contains("edge"), "{message}");
    }

    #[test]
    fn threads_share_a_drawing() {
        let drawing = drawing();
        // A raw pointer is no `Sync`; the handle behind it is.
        let address = drawing.0 as usize;
        let run = || {
            let shared = std::mem::ManuallyDrop::new(Drawing(address as *mut _));
            Faces::identify(&shared, "{}", 2.0).unwrap().json()
        };
        let results: Vec<_> = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..4).map(|_| scope.spawn(run)).collect();
            threads.into_iter().map(|t| t.join().unwrap()).collect()
        });
        assert!(results.windows(2).all(|w| w[0] == w[1]));
    }
}
