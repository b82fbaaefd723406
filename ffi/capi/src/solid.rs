//! Solids: depth, plan and the CAD kernel in one call.

use std::ffi::{c_char, c_void};
use std::path::Path;

use faceformer::drawing::Drawing;
use faceformer::identify::Face;
use faceformer::lift::{self, Lift, LiftOptions};
use faceformer::plan::{Orientation, Plan, PlanOptions};
use faceformer::readings::{self, Taken};
use faceformer::{Progress, Stage};
use faceformer_occt::{Format, OcctError, Solid, SolidReport};
use serde::{Deserialize, Serialize};

use crate::FaceformerStatus;
use crate::drawing::FaceformerDrawing;
use crate::error::CallError;
use crate::faces::FaceformerFaces;
use crate::guard::{Out, guard};
use crate::input;
use crate::memory::{free_handle, new_bytes, new_json};
use crate::progress::{FaceformerProgress, Watcher};

/// Names of the file formats, as `faceformer_solid_write` takes them.
pub(crate) const FORMATS: [&str; 3] = ["step", "brep", "stl"];

/// A valid closed solid, or what could be built of its shell before an error.
///
/// It never changes: several threads may use it at once.
pub struct FaceformerSolid {
    shape: Shape,
    lift: Lift,
    plan: Plan,
    /// Which reading it is of: 0 is the best, 1 the first alternative.
    reading: usize,
    /// Why it is not the best one.
    notice: Option<String>,
}

enum Shape {
    Whole(Solid),
    /// The error that ended the build, which has the partial shell.
    Partial(OcctError),
}

#[derive(Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct SolidOptions {
    flip: bool,
    scale: f64,
    orientation: Orientation,
    alternatives: usize,
}

impl Default for SolidOptions {
    fn default() -> Self {
        Self {
            flip: false,
            scale: 1.0,
            orientation: Orientation::default(),
            alternatives: 0,
        }
    }
}

#[derive(Serialize)]
struct Report<'a> {
    partial: bool,
    report: Option<&'a SolidReport>,
    error: Option<String>,
    reading: usize,
    notices: &'a [String],
    lift: &'a Lift,
    plan: &'a Plan,
}

/// Makes a solid from a drawing and its faces: depth, plan, and OpenCASCADE's B-rep of it.
///
/// `options_json` has `len` bytes: `{"flip": false, "scale": 1.0, "orientation": "upright",
/// "alternatives": 0}`, every key optional, null for the defaults. `flip` takes the other of the two
/// depths that a drawing without perspective has; `scale` is model units per drawing unit, above 0;
/// `orientation` is "upright" (the model's axes along x, y, z) or "drawn" (as seen, z towards the
/// viewer). If the faces conflict or give no solid, as many of their `alternatives` as that are tried
/// in their order, and the first one without fault is taken; the report says so. Leave it at 0 where
/// the user chose the faces. `callback` is null or hears progress and may cancel; it gets `user`.
///
/// A face whose surface is found but fits no solid is filled, and the plan's `notices` say so; the
/// faces count as being without a solid where `alternatives` are tried.
///
/// Returns `FACEFORMER_STATUS_FAILED` if depth or a valid closed solid cannot be had; the message
/// names the face or edge. If OpenCASCADE had begun a shell by then, `*out` is NOT null but a
/// handle for inspection: its report has `"partial": true`, and `faceformer_solid_brep` gives the
/// partial shell; free it as any other. Returns `FACEFORMER_STATUS_BAD_INPUT` if `faces` belong to
/// another drawing, `FACEFORMER_STATUS_CANCELLED` if the callback returned 0.
///
/// Any thread may call this, several at once with the same handles. Free `*out` with
/// `faceformer_solid_free`.
///
/// # Safety
/// `drawing` and `faces` are live handles or null, `options_json` is null or valid for reads of
/// `len` bytes, `callback` is null or may be called with `user`, `out` is valid for writes,
/// `message` is null or valid for writes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn faceformer_solid(
    drawing: *const FaceformerDrawing,
    faces: *const FaceformerFaces,
    options_json: *const c_char,
    len: usize,
    callback: FaceformerProgress,
    user: *mut c_void,
    out: *mut *mut FaceformerSolid,
    message: *mut *mut c_char,
) -> FaceformerStatus {
    // SAFETY: outputs are null or valid for writes by this function's contract.
    let (out, message) = unsafe { (Out::null(out, "out"), Out::null(message, "message")) };
    guard(&message, || {
        out.check()?;
        // SAFETY: a live handle or null by this function's contract.
        let drawing = unsafe { input::handle(drawing, "drawing") }?;
        // SAFETY: as above.
        let faces = unsafe { input::handle(faces, "faces") }?;
        // SAFETY: null or valid for reads of `len` bytes by this function's contract.
        let options: SolidOptions = unsafe { input::options(options_json, len) }?;
        // SAFETY: the callback may be called with `user` by this function's contract.
        let watcher = unsafe { Watcher::new(callback, user) };
        let report = |stage, share| watcher.report(stage, share);
        let taken = make(drawing, faces, &options, Progress::new(&report))?;
        let Made {
            lift, plan, shape, ..
        } = taken.result?;
        let outcome = match &shape {
            Shape::Whole(_) => Ok(()),
            Shape::Partial(error) => Err(error.clone().into()),
        };
        out.put(Box::into_raw(Box::new(FaceformerSolid {
            shape,
            lift,
            plan,
            reading: taken.reading,
            notice: taken.notice,
        })));
        outcome
    })
}

/// What came of one set of faces.
struct Made {
    lift: Lift,
    plan: Plan,
    shape: Shape,
    given_up: Vec<usize>,
}

/// Makes the solid of the first reading without fault.
fn make(
    drawing: &FaceformerDrawing,
    faces: &FaceformerFaces,
    options: &SolidOptions,
    progress: Progress<'_>,
) -> Result<Taken<Result<Made, CallError>>, CallError> {
    faces.check(drawing)?;
    let scale = options.scale;
    if !(scale.is_finite() && scale > 0.0) {
        return Err(CallError::Scale(scale));
    }
    Ok(readings::take(
        &faces.found,
        options.alternatives,
        |faces| attempt(&drawing.0.drawing, faces, options, progress),
        fault,
    ))
}

/// Finds depth, plans the B-rep and builds it, whole or in part.
fn attempt(
    drawing: &Drawing,
    faces: &[Face],
    options: &SolidOptions,
    progress: Progress<'_>,
) -> Result<Made, CallError> {
    let mut lift = lift::lift(
        drawing,
        faces,
        &LiftOptions { flip: options.flip },
        progress,
    )?;
    progress.report(Stage::Plan, 0.0)?;
    let plan_options = PlanOptions {
        scale: options.scale,
        orientation: options.orientation,
    };
    let made = faceformer_occt::reconstruct(drawing, faces, &mut lift, &plan_options, progress)?;
    let shape = match made.solid {
        Ok(solid) => Shape::Whole(solid),
        Err(error) if error.partial().is_some() => Shape::Partial(error),
        Err(error) => return Err(error.into()),
    };
    Ok(Made {
        lift,
        plan: made.plan,
        shape,
        given_up: made.given_up,
    })
}

/// What is wrong with an attempt; nothing is if the caller stopped it.
fn fault(made: &Result<Made, CallError>) -> Option<String> {
    match made {
        Ok(Made {
            shape: Shape::Partial(error),
            ..
        }) => Some(readings::failure(error)),
        Ok(made) => readings::conflict(&made.lift).or_else(|| readings::given_up(&made.given_up)),
        Err(error) if error.status() == FaceformerStatus::Cancelled => None,
        Err(error) => Some(readings::failure(error)),
    }
}

/// Tells how the solid came about and what it is, as a JSON object: `{"partial": false, "report":
/// {"volume": ..., "area": ..., "face_counts": {"plane": 6, ...}, ...}, "error": null, "reading": 0,
/// "notices": [], "lift": ..., "plan": ...}`.
///
/// `reading` says which faces the solid has: 0 those of `faces`, 1 the first of their alternatives;
/// if it is not 0, the one text in `notices` tells the user why. `lift` lists `conflicts` as
/// `faceformer_lift` does.
///
/// `lift` has the depth of every vertex of the drawing, `plan` the points, curves and surfaces the
/// solid was built from. For a partial shell `partial` is true, `report` null and `error` the
/// message.
///
/// Any thread may call this. Free `*json` with `faceformer_string_free`.
///
/// # Safety
/// `solid` is a live handle or null, `json` is valid for writes, `message` is null or valid for
/// writes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn faceformer_solid_report(
    solid: *const FaceformerSolid,
    json: *mut *mut c_char,
    message: *mut *mut c_char,
) -> FaceformerStatus {
    // SAFETY: outputs are null or valid for writes by this function's contract.
    let (json, message) = unsafe { (Out::null(json, "json"), Out::null(message, "message")) };
    guard(&message, || {
        json.check()?;
        // SAFETY: a live handle or null by this function's contract.
        let FaceformerSolid {
            shape,
            lift,
            plan,
            reading,
            notice,
        } = unsafe { input::handle(solid, "solid") }?;
        let (report, error) = match shape {
            Shape::Whole(solid) => (Some(solid.report()), None),
            Shape::Partial(error) => (None, Some(error.to_string())),
        };
        json.put(new_json(&Report {
            partial: report.is_none(),
            report,
            error,
            reading: *reading,
            notices: notice.as_slice(),
            lift,
            plan,
        })?);
        Ok(())
    })
}

/// Gives the B-rep as OpenCASCADE's BREP text, format version 1, which every FreeCAD reads; of a
/// partial shell what there is of it.
///
/// `*bytes` has `*length` bytes and no zero at the end. Any thread may call this. Free `*bytes` with
/// `faceformer_bytes_free`.
///
/// # Safety
/// `solid` is a live handle or null, `bytes` and `length` are valid for writes, `message` is null or
/// valid for writes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn faceformer_solid_brep(
    solid: *const FaceformerSolid,
    bytes: *mut *mut u8,
    length: *mut usize,
    message: *mut *mut c_char,
) -> FaceformerStatus {
    // SAFETY: outputs are null or valid for writes by this function's contract.
    let (bytes, length, message) = unsafe {
        (
            Out::null(bytes, "bytes"),
            Out::new(length, "length", 0),
            Out::null(message, "message"),
        )
    };
    guard(&message, || {
        bytes.check()?;
        length.check()?;
        // SAFETY: a live handle or null by this function's contract.
        let text = match &unsafe { input::handle(solid, "solid") }?.shape {
            Shape::Whole(solid) => solid.brep()?,
            Shape::Partial(error) => error.partial().unwrap_or_default().to_vec(),
        };
        let (start, len) = new_bytes(text);
        bytes.put(start);
        length.put(len);
        Ok(())
    })
}

/// Writes the solid to a file, which is replaced if it is there.
///
/// `path` is UTF-8 and ends with a zero byte, as does `format`: "step", "brep" or "stl". STEP and STL
/// are in the units of `scale`; STEP calls them millimetres.
///
/// Returns `FACEFORMER_STATUS_FAILED` if the file cannot be written, or the solid is only a partial
/// shell. Any thread may call this. OpenCASCADE's STEP writer has settings that are global to the
/// process: this library's own writes wait for each other, but where it shares the system's
/// OpenCASCADE with the program, do not write while the program itself reads or writes STEP in
/// another thread.
///
/// # Safety
/// `solid` is a live handle or null, `path` and `format` are null or end with a zero byte, `message`
/// is null or valid for writes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn faceformer_solid_write(
    solid: *const FaceformerSolid,
    path: *const c_char,
    format: *const c_char,
    message: *mut *mut c_char,
) -> FaceformerStatus {
    // SAFETY: null or valid for writes by this function's contract.
    let message = unsafe { Out::null(message, "message") };
    guard(&message, || {
        // SAFETY: a live handle or null by this function's contract.
        let solid = unsafe { input::handle(solid, "solid") }?;
        // SAFETY: null or zero-terminated by this function's contract.
        let (path, format) = unsafe {
            (
                input::c_text(path, "path")?,
                input::c_text(format, "format")?,
            )
        };
        let format: Format = format
            .parse()
            .map_err(|_| CallError::Format(format.to_owned()))?;
        match &solid.shape {
            Shape::Whole(solid) => Ok(solid.write(Path::new(path), format)?),
            Shape::Partial(_) => Err(CallError::PartialWrite),
        }
    })
}

/// Frees a solid. Null does nothing. No call may be using it.
///
/// # Safety
/// `solid` is null, or a live handle that is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn faceformer_solid_free(solid: *mut FaceformerSolid) {
    // SAFETY: made by `Box::into_raw`, and not used again by this function's contract.
    unsafe { free_handle(solid) };
}

#[cfg(test)]
mod tests;
