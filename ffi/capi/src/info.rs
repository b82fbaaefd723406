//! What this library is.

use std::ffi::c_char;

use faceformer::identify::EngineKind;
use serde::Serialize;

use crate::guard::{Out, guard};
use crate::memory::new_json;
use crate::solid::FORMATS;
use crate::{FACEFORMER_ABI_VERSION, FaceformerStatus};

#[derive(Serialize)]
struct Info {
    version: &'static str,
    abi: u32,
    occt: String,
    occt_bundled: bool,
    engines: Vec<String>,
    default_engine: String,
    formats: [&'static str; 3],
}

/// Version of the interface of the loaded library.
///
/// Compare it with `FACEFORMER_ABI_VERSION` of the header after loading the library by hand. Any
/// thread may call this.
#[unsafe(no_mangle)]
pub extern "C" fn faceformer_abi_version() -> u32 {
    FACEFORMER_ABI_VERSION
}

/// Tells what this library is, as a JSON object:
/// `{"version": "0.1.0", "abi": 1, "occt": "7.6.3", "occt_bundled": false, "engines":
/// ["rotation", ...], "default_engine": "rotation", "formats": ["step", "brep", "stl"]}`.
///
/// Any thread may call this.
///
/// # Safety
/// `json` is valid for writes, `message` is null or valid for writes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn faceformer_info(
    json: *mut *mut c_char,
    message: *mut *mut c_char,
) -> FaceformerStatus {
    // SAFETY: outputs are null or valid for writes by this function's contract.
    let (json, message) = unsafe { (Out::null(json, "json"), Out::null(message, "message")) };
    guard(&message, || {
        json.check()?;
        json.put(new_json(&Info {
            version: env!("CARGO_PKG_VERSION"),
            abi: FACEFORMER_ABI_VERSION,
            occt: faceformer_occt::occt_version()?,
            occt_bundled: cfg!(feature = "bundled-occt"),
            engines: EngineKind::ALL.iter().map(ToString::to_string).collect(),
            default_engine: EngineKind::default().to_string(),
            formats: FORMATS,
        })?);
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::call_string;

    #[test]
    fn info_names_versions_and_engines() {
        // SAFETY: live slots.
        let info = call_string(|json, message| unsafe { faceformer_info(json, message) }).unwrap();
        let info: serde_json::Value = serde_json::from_str(&info).unwrap();
        assert_eq!(info["abi"], FACEFORMER_ABI_VERSION);
        assert_eq!(info["version"], env!("CARGO_PKG_VERSION"));
        assert!(info["occt"].as_str().unwrap().starts_with("7."), "{info}");
        assert!(
            info["engines"]
                .as_array()
                .unwrap()
                .contains(&info["default_engine"])
        );
    }
}
