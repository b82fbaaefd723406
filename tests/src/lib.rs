//! What the whole-path tests share: where things are, and building what they run.
//!
//! The tests run the programs of this workspace as a user does, so they need them built. Cargo
//! is asked each time, which does nothing if all is up to date; no test runs a stale program.

use std::ffi::OsStr;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

use serde_json::{Value, json};

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

/// Builds the program and the library with the profile of the running test. Both at once, because
/// cargo chooses the features of dependencies for what it builds together: so `setup.sh` does too,
/// and nothing is compiled twice.
fn build() {
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
        .args(["build", "--quiet", "--profile", profile])
        .args([
            "--package",
            "faceformer-cli",
            "--package",
            "faceformer-capi",
        ])
        .arg("--target-dir")
        .arg(target)
        .current_dir(root())
        .output()
        .expect("cargo can be started");
    assert!(
        output.status.success(),
        "building failed:\n{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

/// The program `faceformer`, built.
///
/// # Panics
/// If the build fails, with the compiler's messages.
pub fn program() -> PathBuf {
    build();
    let name = format!("faceformer{}", std::env::consts::EXE_SUFFIX);
    profile_dir().join(name)
}

/// The shared library of the C ABI, built.
///
/// # Panics
/// If the build fails, with the compiler's messages.
pub fn library() -> PathBuf {
    build();
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

/// A finished run of the program `faceformer`.
#[derive(Debug)]
pub struct Run {
    /// Exit status; -1 if a signal ended it.
    pub status: i32,
    /// What it wrote to standard output.
    pub stdout: String,
    /// What it wrote to standard error.
    pub stderr: String,
}

/// Runs the program `faceformer` to its end.
///
/// # Panics
/// If it cannot be built or started.
pub fn faceformer<I: IntoIterator<Item: AsRef<OsStr>>>(arguments: I) -> Run {
    Run::with_input(arguments, b"")
}

impl Run {
    /// Runs the program `faceformer` with the given standard input.
    ///
    /// # Panics
    /// If it cannot be built or started.
    pub fn with_input<I: IntoIterator<Item: AsRef<OsStr>>>(arguments: I, input: &[u8]) -> Self {
        static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
        let mut child = Command::new(PROGRAM.get_or_init(program))
            .args(arguments)
            .current_dir(root())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program can be started");
        // A program that refuses its arguments does not read; then the pipe breaks, and that is
        // no fault of the test.
        let mut stdin = child.stdin.take().expect("it was asked for");
        let input = input.to_owned();
        let writer = std::thread::spawn(move || stdin.write_all(&input));
        let output = child
            .wait_with_output()
            .expect("the program can be waited for");
        writer.join().expect("writing does not panic").ok();
        Self {
            status: output.status.code().unwrap_or(-1),
            stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
        }
    }

    /// The run, which must have succeeded.
    ///
    /// # Panics
    /// If the status is not 0, with what the program said.
    pub fn ok(self) -> Self {
        assert_eq!(self.status, 0, "{}", self.stderr);
        self
    }
}

/// A prism as a drawing and its faces, both in JSON, from where the corners are drawn: those of one
/// end in order, then those of the other.
pub fn prism(corners: &[[f64; 2]]) -> (Value, Value) {
    let n = corners.len() / 2;
    let next = |i: usize| (i + 1) % n;
    let near = (0..n).map(|i| [i, next(i)]);
    let far = (0..n).map(|i| [n + i, n + next(i)]);
    let across = (0..n).map(|i| [i, n + i]);
    let edges: Vec<Value> = near
        .chain(far)
        .chain(across)
        .map(|[a, b]| json!({ "v": [a, b], "points": [corners[a], corners[b]] }))
        .collect();
    // Edges count from 1 in faces, and one that is walked backwards is negative.
    let number = |i: usize| i as i64 + 1;
    let wall = |i: usize| {
        let (a, b) = (number(2 * n + next(i)), number(2 * n + i));
        vec![number(i), a, -number(n + i), -b]
    };
    let mut loops: Vec<Vec<i64>> = (0..n).map(wall).collect();
    loops.push((0..n).rev().map(|i| -number(i)).collect());
    loops.push((0..n).map(|i| number(n + i)).collect());
    let faces: Vec<Value> = loops
        .iter()
        .map(|walk| json!({ "type": "plane", "loops": [walk] }))
        .collect();
    (
        json!({ "vertices": corners, "edges": edges }),
        json!({ "faces": faces }),
    )
}
