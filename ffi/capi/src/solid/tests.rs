//! Solids through the ABI: options, files, cancelling, partial shells, threads.

use std::ffi::CString;

use super::*;
use crate::testing::{self, BOX_FACES, Drawing, Faces, Solid as Built};

fn parts() -> (Drawing, Faces) {
    let drawing = Drawing::read(testing::box_json().as_bytes()).unwrap();
    let faces = Faces::read(&drawing, BOX_FACES).unwrap();
    (drawing, faces)
}

/// A path in the system's folder for such files, of this process alone.
fn temporary(name: &str) -> (std::path::PathBuf, CString) {
    let path = std::env::temp_dir().join(format!("faceformer-{}-{name}", std::process::id()));
    let text = CString::new(path.to_str().unwrap()).unwrap();
    (path, text)
}

#[test]
fn a_box_has_its_volume_at_every_option() {
    let (drawing, faces) = parts();
    for (options, volume) in [
        ("{}", 24.0),
        (r#"{"scale": 2}"#, 192.0),
        (r#"{"flip": true, "orientation": "drawn"}"#, 24.0),
    ] {
        let report = Built::build(&drawing, &faces, options).unwrap().report();
        assert_eq!(report["partial"], false);
        let found = report["report"]["volume"].as_f64().unwrap();
        assert!((found / volume - 1.0).abs() < 1e-6, "{options}: {found}");
        assert_eq!(report["report"]["face_counts"]["plane"], 6);
        assert_eq!(report["lift"]["depths"].as_array().unwrap().len(), 8);
        assert_eq!(report["plan"]["faces"].as_array().unwrap().len(), 6);
    }
}

#[test]
fn every_format_is_written() {
    let (drawing, faces) = parts();
    let solid = Built::build(&drawing, &faces, "{}").unwrap();
    let brep = String::from_utf8(solid.brep()).unwrap();
    assert!(
        brep.lines()
            .take(3)
            .any(|line| line.starts_with("CASCADE Topology V1")),
        "{brep}"
    );
    for format in FORMATS {
        let (path, text) = temporary(&format!("box.{format}"));
        solid.write(&text, &CString::new(format).unwrap()).unwrap();
        assert!(std::fs::metadata(&path).unwrap().len() > 100);
        std::fs::remove_file(path).unwrap();
    }
    let (_, text) = temporary("box.gif");
    assert_eq!(
        solid.write(&text, c"gif").unwrap_err().0,
        FaceformerStatus::BadInput
    );
    let (status, message) = solid
        .write(c"no/such/folder/box.step", c"step")
        .unwrap_err();
    assert_eq!(status, FaceformerStatus::Failed);
    assert!(message.contains("no/such/folder"), "{message}");
}

#[test]
fn every_stage_can_be_cancelled() {
    let (drawing, faces) = parts();
    for stage in [c"lift", c"plan", c"build"] {
        let status = Built::stop_at(&drawing, &faces, stage);
        assert_eq!(status, FaceformerStatus::Cancelled, "{stage:?}");
    }
    assert_eq!(
        Built::stop_at(&drawing, &faces, c"never"),
        FaceformerStatus::Ok
    );
}

#[test]
fn what_does_not_fit_is_bad_input() {
    let (drawing, faces) = parts();
    for options in [
        r#"{"scale": 0}"#,
        r#"{"scale": -1}"#,
        r#"{"scale": 1e999}"#,
        r#"{"scale": NaN}"#,
        r#"{"orientation": "sideways"}"#,
        r#"{"mirror": true}"#,
    ] {
        let (status, message) = Built::build(&drawing, &faces, options).unwrap_err();
        assert_eq!(status, FaceformerStatus::BadInput, "{options}: {message}");
    }
    let (other, _) = parts();
    let (status, message) = Built::build(&other, &faces, "{}").unwrap_err();
    assert_eq!(status, FaceformerStatus::BadInput);
    assert!(message.contains("another drawing"), "{message}");
}

#[test]
fn an_open_box_fails_by_name() {
    let (drawing, faces) = parts();
    let mut open = faces.json();
    open["faces"].as_array_mut().unwrap().pop();
    let open = Faces::read(&drawing, &open.to_string()).unwrap();
    let (status, message) = Built::build(&drawing, &open, "{}").unwrap_err();
    assert_eq!(status, FaceformerStatus::Failed);
    assert!(message.contains("edge"), "{message}");
}

#[test]
fn an_alternative_is_taken_if_the_caller_allows_it() {
    let (drawing, faces) = parts();
    let right = faces.json();
    let mut wrong = right.clone();
    wrong["faces"].as_array_mut().unwrap().pop();
    wrong["alternatives"] = serde_json::json!([{"faces": right["faces"]}]);
    let faces = Faces::read(&drawing, &wrong.to_string()).unwrap();
    for options in ["{}", r#"{"alternatives": 0}"#] {
        let (status, _) = Built::build(&drawing, &faces, options).unwrap_err();
        assert_eq!(status, FaceformerStatus::Failed);
    }
    let report = Built::build(&drawing, &faces, r#"{"alternatives": 3}"#)
        .unwrap()
        .report();
    assert_eq!(report["reading"], 1);
    let notice = report["notices"][0].as_str().unwrap();
    assert!(
        notice.starts_with("the second reading was taken: the first gives no solid: "),
        "{notice}"
    );
}

#[test]
fn a_partial_shell_is_handed_over() {
    let (drawing, faces) = parts();
    let whole = Built::build(&drawing, &faces, "{}").unwrap();
    // SAFETY: a live handle.
    let FaceformerSolid { lift, plan, .. } = unsafe { &*whole.0 };
    let error = OcctError::Face {
        face: 3,
        what: "it is torn".into(),
        partial: b"shell".into(),
    };
    let shape = Shape::Partial(error);
    let (lift, plan) = (lift.clone(), plan.clone());
    let partial = Built(Box::into_raw(Box::new(FaceformerSolid {
        shape,
        lift,
        plan,
        reading: 0,
        notice: None,
    })));
    let report = partial.report();
    assert_eq!(report["partial"], true);
    assert!(report["report"].is_null());
    assert!(report["error"].as_str().unwrap().contains("face 3"));
    assert_eq!(partial.brep(), b"shell");
    let (path, text) = temporary("partial.step");
    assert_eq!(
        partial.write(&text, c"step").unwrap_err().0,
        FaceformerStatus::Failed
    );
    assert!(!path.exists());
}

#[test]
fn threads_share_a_solid() {
    let (drawing, faces) = parts();
    let solid = Built::build(&drawing, &faces, "{}").unwrap();
    // A raw pointer is no `Sync`; the handle behind it is.
    let address = solid.0 as usize;
    std::thread::scope(|scope| {
        for i in 0..4 {
            scope.spawn(move || {
                let shared = std::mem::ManuallyDrop::new(Built(address as *mut _));
                let (path, text) = temporary(&format!("thread-{i}.step"));
                for _ in 0..3 {
                    shared.write(&text, c"step").unwrap();
                    assert!(shared.brep().len() > 100);
                }
                std::fs::remove_file(path).unwrap();
            });
        }
    });
}
