//! Depth on its own: what a drawing and its faces say of space before a solid is made.

use std::ffi::{c_char, c_void};

use faceformer::Progress;
use faceformer::lift::{self, Lift, LiftOptions};

use crate::FaceformerStatus;
use crate::drawing::FaceformerDrawing;
use crate::error::CallError;
use crate::faces::FaceformerFaces;
use crate::guard::{Out, guard};
use crate::input;
use crate::memory::new_json;
use crate::progress::{FaceformerProgress, Watcher};

/// Finds the depth of every vertex and the surface of every face, and which faces conflict, as a
/// JSON object: `{"depths": [...], "surfaces": [...], "conflicts": [{"face": 6, "vertices": [12],
/// "others": [2, 8], "residual": 0.1, "message": "face 7 conflicts with faces 3 and 9 at vertex
/// 12"}], ...}`.
///
/// A conflict has a face that the depths contradict, the vertices where they do, and the other faces
/// there, all counted from 0; `residual` is how far off its surface it is, in drawing units.
/// `message` says it for the user, faces counted from 1. Without conflicts the list is empty.
///
/// `options_json` has `len` bytes: `{"flip": false}`, every key optional, null for the defaults.
/// `callback` is null or hears progress and may cancel; it gets `user`.
///
/// Returns `FACEFORMER_STATUS_FAILED` if depth cannot be had (the message says of which vertices),
/// `FACEFORMER_STATUS_BAD_INPUT` if `faces` belong to another drawing, `FACEFORMER_STATUS_CANCELLED`
/// if the callback returned 0. Any thread may call this, several at once with the same handles.
/// Free `*json` with `faceformer_string_free`.
///
/// # Safety
/// `drawing` and `faces` are live handles or null, `options_json` is null or valid for reads of
/// `len` bytes, `callback` is null or may be called with `user`, `json` is valid for writes,
/// `message` is null or valid for writes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn faceformer_lift(
    drawing: *const FaceformerDrawing,
    faces: *const FaceformerFaces,
    options_json: *const c_char,
    len: usize,
    callback: FaceformerProgress,
    user: *mut c_void,
    json: *mut *mut c_char,
    message: *mut *mut c_char,
) -> FaceformerStatus {
    // SAFETY: outputs are null or valid for writes by this function's contract.
    let (json, message) = unsafe { (Out::null(json, "json"), Out::null(message, "message")) };
    guard(&message, || {
        json.check()?;
        // SAFETY: a live handle or null by this function's contract.
        let drawing = unsafe { input::handle(drawing, "drawing") }?;
        // SAFETY: as above.
        let faces = unsafe { input::handle(faces, "faces") }?;
        // SAFETY: null or valid for reads of `len` bytes by this function's contract.
        let options: LiftOptions = unsafe { input::options(options_json, len) }?;
        // SAFETY: the callback may be called with `user` by this function's contract.
        let watcher = unsafe { Watcher::new(callback, user) };
        let report = |stage, share| watcher.report(stage, share);
        json.put(new_json(&depths(
            drawing,
            faces,
            &options,
            Progress::new(&report),
        )?)?);
        Ok(())
    })
}

/// Finds depth, of faces that belong to the drawing.
fn depths(
    drawing: &FaceformerDrawing,
    faces: &FaceformerFaces,
    options: &LiftOptions,
    progress: Progress<'_>,
) -> Result<Lift, CallError> {
    faces.check(drawing)?;
    Ok(lift::lift(
        &drawing.0.drawing,
        &faces.found.faces,
        options,
        progress,
    )?)
}

#[cfg(test)]
mod tests {
    use crate::FaceformerStatus;
    use crate::testing::{self, BOX_FACES, Drawing, Faces, lift_json};

    fn parts() -> (Drawing, Faces) {
        let drawing = Drawing::read(testing::box_json().as_bytes()).unwrap();
        let faces = Faces::read(&drawing, BOX_FACES).unwrap();
        (drawing, faces)
    }

    #[test]
    fn a_box_has_depths_and_no_conflict() {
        let (drawing, faces) = parts();
        let straight = lift_json(&drawing, &faces, "{}").unwrap();
        assert_eq!(straight["surfaces"].as_array().unwrap().len(), 6);
        assert!(straight["conflicts"].as_array().unwrap().is_empty());
        let flipped = lift_json(&drawing, &faces, r#"{"flip": true}"#).unwrap();
        let depth = |lift: &serde_json::Value, v: usize| lift["depths"][v].as_f64().unwrap();
        for v in 0..8 {
            assert!((depth(&straight, v) + depth(&flipped, v)).abs() < 1e-9);
        }
    }

    #[test]
    fn two_faces_taken_for_one_are_named_in_a_sentence() {
        let (drawing, faces) = parts();
        let mut wrong = faces.json();
        let all = wrong["faces"].as_array_mut().unwrap();
        let taken = all.remove(1)["loops"][0].clone();
        all[0]["loops"].as_array_mut().unwrap().push(taken);
        let wrong = Faces::read(&drawing, &wrong.to_string()).unwrap();
        let found = lift_json(&drawing, &wrong, "{}").unwrap();
        let conflicts = found["conflicts"].as_array().unwrap();
        assert_eq!(conflicts.len(), 1, "{conflicts:?}");
        let conflict = &conflicts[0];
        assert_eq!(conflict["face"], 0);
        let message = conflict["message"].as_str().unwrap();
        assert!(
            message.starts_with("face 1 conflicts with faces "),
            "{message}"
        );
        assert!(message.contains(" at vert"), "{message}");
        assert!(!conflict["vertices"].as_array().unwrap().is_empty());
    }

    #[test]
    fn what_does_not_fit_is_bad_input() {
        let (drawing, faces) = parts();
        let (other, _) = parts();
        for (drawing, options) in [
            (&drawing, "{"),
            (&drawing, r#"{"flop": 1}"#),
            (&other, "{}"),
        ] {
            let (status, message) = lift_json(drawing, &faces, options).unwrap_err();
            assert_eq!(status, FaceformerStatus::BadInput, "{message}");
        }
    }
}
