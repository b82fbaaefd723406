//! The workbench in a real FreeCAD: headless with `freecadcmd`, and in a window under Xvfb.
//!
//! Slow, so all of it is ignored by default; `./test.sh --all` runs it. What FreeCAD printed is
//! kept in `tests/output/freecad_*/log.txt`.

use std::path::{Path, PathBuf};
use std::process::Command;

use faceformer_tests::{library, output_dir, root};

/// Seconds until a FreeCAD that hangs is ended. A failed start script leaves a window open.
const LIMIT: &str = "240";

/// Ends the test with the way to install a program that is not there.
fn need(program: &str, package: &str) {
    let found = Command::new("sh")
        .args(["-c", &format!("command -v {program}")])
        .output()
        .is_ok_and(|output| output.status.success());
    assert!(
        found,
        "{program} is not installed; on Debian and Ubuntu: apt-get install {package}"
    );
}

/// Runs a command with a fresh user folder of FreeCAD's, and returns what it printed.
fn run(mut command: Command, output: &Path) -> String {
    let home = output.join("home");
    std::fs::create_dir_all(&home).expect("the user folder can be made");
    let result = command
        .env("FREECAD_USER_HOME", &home)
        .env("FACEFORMER_OUTPUT", output)
        .env("LANG", "C.UTF-8")
        .env("LC_ALL", "C.UTF-8")
        .env("QTWEBENGINE_DISABLE_SANDBOX", "1")
        .current_dir(output)
        .output()
        .expect("the command can be started");
    let text = String::from_utf8_lossy(&result.stdout).into_owned()
        + &String::from_utf8_lossy(&result.stderr);
    std::fs::write(output.join("log.txt"), &text).expect("the log can be written");
    assert!(result.status.success(), "{}:\n{text}", result.status);
    text
}

/// A command under the time limit.
fn limited(program: &str) -> Command {
    let mut command = Command::new("timeout");
    command.args([LIMIT, program]);
    command
}

fn script(name: &str) -> PathBuf {
    root().join("tests/freecad").join(name)
}

fn workbench() -> PathBuf {
    root().join("freecad_workbench")
}

/// Runs a script in `freecadcmd` with the workbench and the library, and checks its last line.
fn headless(name: &str) -> String {
    need("freecadcmd", "freecad freecad-python3");
    let library = library();
    let mut command = limited("freecadcmd");
    command
        .arg(script(&format!("{name}.py")))
        .arg("-M")
        .arg(workbench())
        .env("FACEFORMER_LIBRARY", library);
    let text = run(command, &output_dir(&format!("freecad_{name}")));
    assert!(text.contains("failed: 0"), "{text}");
    text
}

#[test]
#[ignore = "starts FreeCAD"]
fn the_workbenchs_own_tests_pass() {
    need("freecadcmd", "freecad freecad-python3");
    let mut command = limited("freecadcmd");
    command
        .args(["-t", "freecad.Faceformer.tests", "-M"])
        .arg(workbench());
    let text = run(command, &output_dir("freecad_unit"));
    assert!(text.contains("OK") && text.contains("Ran "), "{text}");
}

#[test]
#[ignore = "starts FreeCAD"]
fn solids_come_back_from_their_wireframes() {
    let text = headless("round_trip");
    for part in [
        "box",
        "l_bracket",
        "through_hole",
        "blind_hole_and_slot",
        "stepped_shaft",
        "pocket",
        "wedge",
    ] {
        assert!(text.contains(&format!("ok    part {part} ")), "{text}");
    }
    assert!(text.contains(" real parts came back"), "{text}");
}

#[test]
#[ignore = "starts FreeCAD"]
fn solids_follow_their_sketches() {
    headless("follow");
}

#[test]
#[ignore = "starts FreeCAD"]
fn bad_input_is_refused_and_leaves_the_document_alone() {
    headless("bad_input");
}

#[test]
#[ignore = "starts FreeCAD in a window"]
fn two_clicks_make_a_solid() {
    need("freecad", "freecad freecad-python3");
    need("xvfb-run", "xvfb xauth");
    let library = library();
    let output = output_dir("freecad_click_through");
    let mut command = limited("xvfb-run");
    command
        .args(["-a", "-s", "-screen 0 1280x800x24 -dpi 96", "freecad"])
        .arg(script("click_through.py"))
        .arg("-M")
        .arg(workbench())
        .env("FACEFORMER_LIBRARY", library);
    let text = run(command, &output);
    assert!(text.contains("failed: 0"), "{text}");
    for picture in ["selected", "faces", "solid"] {
        let path = output.join(format!("{picture}.png"));
        let size = std::fs::metadata(&path).map_or(0, |meta| meta.len());
        assert!(size > 10_000, "{} has {size} bytes", path.display());
    }
}

#[test]
fn the_translation_file_has_all_texts() {
    need("python3", "python3");
    let result = Command::new("python3")
        .arg(workbench().join("tools/translations.py"))
        .arg("--check")
        .output()
        .expect("the command can be started");
    let text = String::from_utf8_lossy(&result.stderr);
    assert!(result.status.success(), "{text}");
}
