//! The library installed with CMake, and a C and a C++ program that find it there.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use super::library;

/// An empty folder for this test's files. What takes long is built in cargo's own folder.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("capi")
        .join(name);
    if folder.exists() {
        std::fs::remove_dir_all(&folder).unwrap();
    }
    folder
}

/// Runs a command and gives its standard output.
fn run(command: &mut Command) -> String {
    let output = command
        .output()
        .unwrap_or_else(|e| panic!("{command:?}: {e}"));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        output.status.success(),
        "{command:?}: {}\n{text}\n{}",
        output.status,
        String::from_utf8_lossy(&output.stderr)
    );
    text
}

/// Configures and builds a CMake project.
fn cmake(source: &Path, build: &Path, settings: &[String]) {
    let mut configure = Command::new("cmake");
    run(configure
        .arg("-S")
        .arg(source)
        .arg("-B")
        .arg(build)
        .args(settings));
    run(Command::new("cmake")
        .arg("--build")
        .arg(build)
        .args(["--config", "Release"]));
}

/// Where the library is installed, with headers, CMake package and workbench.
fn prefix() -> &'static PathBuf {
    static PREFIX: OnceLock<PathBuf> = OnceLock::new();
    PREFIX.get_or_init(|| {
        let (build, prefix) = (folder("build"), folder("prefix"));
        cmake(&library::root().join("cmake"), &build, &[]);
        run(Command::new("cmake")
            .arg("--install")
            .arg(&build)
            .arg("--prefix")
            .arg(&prefix));
        prefix
    })
}

/// Builds a consumer against the installed library, runs it on the bracket and checks what it
/// says: an L of 4 x 3 and thickness 1, 2 wide, so a volume of 12.
fn consume(language: &str) {
    let source = library::root().join("tests/consumers");
    let build = folder(language);
    let found = format!("-DCMAKE_PREFIX_PATH={}", prefix().display());
    cmake(&source.join(language), &build, &[found]);

    let step = build.join("bracket.step");
    let mut program = Command::new(build.join(format!("consumer_{language}")));
    let said = run(program.arg(source.join("bracket.json")).arg(&step));
    let volume: f64 = said
        .lines()
        .find_map(|line| line.strip_prefix("volume "))
        .and_then(|number| number.parse().ok())
        .unwrap_or_else(|| panic!("no volume in\n{said}"));
    assert!((volume - 12.0).abs() < 12.0 * 1e-3, "volume {volume}");
    assert!(said.ends_with("0 failed\n"), "{said}");

    let step = std::fs::read_to_string(step).unwrap();
    assert!(step.starts_with("ISO-10303-21;") && step.contains("MANIFOLD_SOLID_BREP"));
    // Eight planes: six around the profile and two ends.
    assert_eq!(step.matches("ADVANCED_FACE").count(), 8);
}

#[test]
#[ignore = "slow: builds with CMake"]
fn a_c_program_uses_the_installed_library() {
    consume("c");
}

#[test]
#[ignore = "slow: builds with CMake"]
fn a_cpp_program_uses_the_installed_library() {
    consume("cpp");
}

#[test]
#[ignore = "slow: builds with CMake"]
fn the_workbench_is_installed_with_its_library() {
    let workbench = prefix().join("share/faceformer/Mod/Faceformer");
    assert!(workbench.join("package.xml").exists());
    let native = format!("{}-{}", std::env::consts::OS, std::env::consts::ARCH);
    let name = library::path().file_name().unwrap();
    let native = workbench
        .join("freecad/Faceformer/native")
        .join(native)
        .join(name);
    // SAFETY: the library has no initialisers beyond those of its runtimes.
    let library = unsafe { libloading::Library::new(&native) }.unwrap();
    // SAFETY: the header's type of that function.
    let version: libloading::Symbol<'_, unsafe extern "C" fn() -> u32> =
        unsafe { library.get(b"faceformer_abi_version") }.unwrap();
    // SAFETY: no arguments.
    assert!(unsafe { version() } >= 1);
}
