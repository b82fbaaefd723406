//! What the library exports.

use std::collections::BTreeSet;
use std::process::Command;

use super::library;

/// Names of the functions that the header declares.
fn declared() -> BTreeSet<String> {
    let header = library::root().join("ffi/capi/include/faceformer.h");
    let header = std::fs::read_to_string(header).unwrap();
    header
        .lines()
        .filter(|line| !line.starts_with([' ', '/', '#', '*']))
        .filter_map(|line| line.split_once('(')?.0.rsplit([' ', '*']).next())
        .filter(|name| name.starts_with("faceformer_"))
        .map(str::to_owned)
        .collect()
}

/// A symbol of OpenCASCADE or cxx among them would take the place of FreeCAD's own of another
/// version, and `import Part` would crash.
#[test]
#[cfg(target_os = "linux")]
fn exactly_the_header_is_exported() {
    let output = Command::new("nm")
        .args(["-D", "--defined-only"])
        .arg(library::path())
        .output()
        .expect("nm of the binutils");
    assert!(output.status.success());
    let exported: BTreeSet<String> = String::from_utf8(output.stdout)
        .unwrap()
        .lines()
        .filter_map(|line| line.split_whitespace().last())
        .map(str::to_owned)
        .collect();
    assert!(exported.len() >= 16);
    assert_eq!(exported, declared());
}

#[test]
#[cfg(target_os = "linux")]
fn the_soname_carries_the_abi_version() {
    let output = Command::new("readelf")
        .arg("-d")
        .arg(library::path())
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let version = super::abi::Abi::load().version();
    assert!(
        text.contains(&format!("[libfaceformer_capi.so.{version}]")),
        "{text}"
    );
}
