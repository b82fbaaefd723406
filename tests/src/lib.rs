//! What the whole-path tests share: where things are, and building what they run.
//!
//! The tests run the programs of this workspace as a user does, so they need them built. Each
//! [`build`] asks cargo, which does nothing if all is up to date; no test runs a stale program.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Root folder of the repository.
pub fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here).to_path_buf()
}

/// Folder that cargo builds into with the profile of the running test, as `target/release`.
///
/// # Panics
/// If the running test does not lie in a folder of cargo's.
pub fn profile_dir() -> PathBuf {
    let exe = std::env::current_exe().expect("a running program has a path");
    // .../release/deps/cli-0123456789abcdef
    let dir = exe.parent().and_then(Path::parent);
    dir.expect("cargo runs tests from its deps folder")
        .to_path_buf()
}

/// Builds a package of this workspace with the profile of the running test.
///
/// # Panics
/// If the build fails, with the compiler's messages.
pub fn build(package: &str) {
    let dir = profile_dir();
    let profile = match dir.file_name().and_then(|name| name.to_str()) {
        None | Some("debug") => "dev",
        Some(name) => name,
    };
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let target = dir
        .parent()
        .expect("the profile's folder lies in the target folder");
    let output = Command::new(cargo)
        .args([
            "build",
            "--quiet",
            "--package",
            package,
            "--profile",
            profile,
        ])
        .arg("--target-dir")
        .arg(target)
        .current_dir(root())
        .output()
        .expect("cargo can be started");
    assert!(
        output.status.success(),
        "building {package} failed:\n{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

/// The program `faceformer`, built.
pub fn program() -> PathBuf {
    build("faceformer-cli");
    let name = format!("faceformer{}", std::env::consts::EXE_SUFFIX);
    profile_dir().join(name)
}

/// The shared library of the C ABI, built.
pub fn library() -> PathBuf {
    build("faceformer-capi");
    let name = format!(
        "{}faceformer_capi{}",
        std::env::consts::DLL_PREFIX,
        std::env::consts::DLL_SUFFIX
    );
    profile_dir().join(name)
}

/// The data set that comes with the tests.
pub fn sample() -> PathBuf {
    root().join("tests/corpus/sample.jsonl.zst")
}

/// An empty folder `tests/output/NAME` for a test's files; they are kept for a look at them.
///
/// # Panics
/// If the folder cannot be emptied or made.
pub fn output_dir(name: &str) -> PathBuf {
    let dir = root().join("tests/output").join(name);
    if dir.exists() {
        std::fs::remove_dir_all(&dir).expect("old test output can be removed");
    }
    std::fs::create_dir_all(&dir).expect("the folder for test output can be made");
    dir
}
