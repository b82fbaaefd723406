//! Drawings: reading and diagnosis.

use std::ffi::c_char;
use std::sync::Arc;

use faceformer::drawing::{self, CleanDrawing, Drawing, Finding, Limits};
use serde::Serialize;

use crate::FaceformerStatus;
use crate::guard::{Out, guard};
use crate::input;
use crate::memory::{free_handle, new_json};

/// A drawing that was read and checked.
///
/// It never changes: several threads may use it at once, and it may be freed while faces or solids
/// made from it live on.
pub struct FaceformerDrawing(pub(crate) Arc<CleanDrawing>);

#[derive(Serialize)]
struct DrawingReport<'a> {
    drawing: &'a Drawing,
    sources: &'a [Vec<usize>],
    findings: &'a [Finding],
    tolerance: Option<f64>,
}

/// Reads a drawing from `len` bytes of JSON, at most 256 MiB, and cleans it where its form asks
/// for that.
///
/// Forms: the interchange format (`vertices` and `edges`; taken at its word), the released
/// Faceformer JSON (`edges` and `pairings`), and a plain list of edges `{"edges": [{"name":
/// "Edge1", "points": [[x, y], ...]}]}` (cleaned up: end points snapped, pieces of one curve
/// joined, curves recognised). Mistakes that can be drawn around, such as an edge that ends
/// freely, are findings of `faceformer_drawing_report`, not errors of this call.
///
/// Returns `FACEFORMER_STATUS_BAD_INPUT` if the text is no drawing, is too large, or has a number
/// that is not finite; the message names the edge. Any thread may call this. Free `*out` with
/// `faceformer_drawing_free`.
///
/// # Safety
/// `json` is valid for reads of `len` bytes, `out` is valid for writes, `message` is null or valid
/// for writes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn faceformer_drawing_read(
    json: *const c_char,
    len: usize,
    out: *mut *mut FaceformerDrawing,
    message: *mut *mut c_char,
) -> FaceformerStatus {
    // SAFETY: outputs are null or valid for writes by this function's contract.
    let (out, message) = unsafe { (Out::null(out, "out"), Out::null(message, "message")) };
    guard(&message, || {
        out.check()?;
        // SAFETY: valid for reads of `len` bytes by this function's contract.
        let text = unsafe { input::text(json, len, "json") }?;
        let clean = drawing::read(text, &Limits::default()).map_err(faceformer::Error::from)?;
        out.put(Box::into_raw(Box::new(FaceformerDrawing(Arc::new(clean)))));
        Ok(())
    })
}

/// Tells what the drawing became and what is wrong with it, as a JSON object:
/// `{"drawing": ..., "sources": [[0], ...], "findings": [...], "tolerance": 1e-4}`.
///
/// `drawing` is in the interchange format, with a recognised `curve` at each edge. `sources[e]`
/// are the edges of the input, counted from 0, that edge `e` was made from. A finding has
/// `severity` ("error", "warning", "notice"), `kind`, `message`, the `edges` of the input (from 0),
/// the `vertices` of the drawing (from 0) and the `points` concerned. `tolerance` is the distance
/// within which points became one; null if the drawing was not cleaned.
///
/// Any thread may call this. Free `*json` with `faceformer_string_free`.
///
/// # Safety
/// `drawing` is a live handle or null, `json` is valid for writes, `message` is null or valid for
/// writes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn faceformer_drawing_report(
    drawing: *const FaceformerDrawing,
    json: *mut *mut c_char,
    message: *mut *mut c_char,
) -> FaceformerStatus {
    // SAFETY: outputs are null or valid for writes by this function's contract.
    let (json, message) = unsafe { (Out::null(json, "json"), Out::null(message, "message")) };
    guard(&message, || {
        json.check()?;
        // SAFETY: a live handle or null by this function's contract.
        let clean = &unsafe { input::handle(drawing, "drawing") }?.0;
        json.put(new_json(&DrawingReport {
            drawing: &clean.drawing,
            sources: &clean.sources,
            findings: &clean.report.findings,
            tolerance: clean.report.tolerance,
        })?);
        Ok(())
    })
}

/// Frees a drawing. Null does nothing. No call may be using it.
///
/// # Safety
/// `drawing` is null, or a live handle that is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn faceformer_drawing_free(drawing: *mut FaceformerDrawing) {
    // SAFETY: made by `Box::into_raw`, and not used again by this function's contract.
    unsafe { free_handle(drawing) };
}

#[cfg(test)]
mod tests {
    use crate::FaceformerStatus;
    use crate::testing::{self, Drawing};

    #[test]
    fn both_forms_of_a_box_are_read_and_reported() {
        for json in [testing::box_json(), testing::box_edge_list(12)] {
            let report = Drawing::read(json.as_bytes()).unwrap().report();
            assert_eq!(report["drawing"]["vertices"].as_array().unwrap().len(), 8);
            assert_eq!(report["drawing"]["edges"].as_array().unwrap().len(), 12);
            assert_eq!(report["drawing"]["edges"][0]["curve"]["kind"], "line");
            assert_eq!(report["sources"].as_array().unwrap().len(), 12);
            assert_eq!(report["findings"], serde_json::json!([]));
        }
    }

    #[test]
    fn an_open_wire_is_a_finding() {
        let drawing = Drawing::read(testing::box_edge_list(2).as_bytes()).unwrap();
        let report = drawing.report();
        let findings = report["findings"].as_array().unwrap();
        assert!(
            findings.iter().any(|f| f["severity"] == "error"),
            "{findings:?}"
        );
    }

    #[test]
    fn what_is_no_drawing_is_bad_input() {
        let nan = testing::box_edge_list(12).replacen("[[0.0", "[[NaN", 1);
        for json in [
            "",
            "garbage",
            "{}",
            "[]",
            "{\"edges\":[]}",
            "null",
            &nan,
            "\u{feff}",
        ] {
            let (status, message) = Drawing::read(json.as_bytes()).unwrap_err();
            assert_eq!(status, FaceformerStatus::BadInput, "{json}: {message}");
            assert!(!message.is_empty());
        }
        let (status, message) = Drawing::read(b"{\"edges\":[\xff]}").unwrap_err();
        assert_eq!(status, FaceformerStatus::BadInput);
        assert!(message.contains("byte 10"), "{message}");
    }

    #[test]
    fn deep_nesting_is_refused_without_a_stack_overflow() {
        let (status, _) = Drawing::read("[".repeat(1 << 20).as_bytes()).unwrap_err();
        assert_eq!(status, FaceformerStatus::BadInput);
    }
}
