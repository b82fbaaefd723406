//! The sample corpus: drawings of known solids become those solids again.
//!
//! What is expected stands in `tests/corpus/expected.json`, measured on the original solids; the
//! README beside it tells more.

use std::collections::BTreeMap;

use faceformer::Progress;
use faceformer::drawing::Drawing;
use faceformer::drawing::dataset::Drawings;
use faceformer::identify::{EngineKind, Identification, engine, from_truth};
use faceformer::lift::{LiftOptions, lift};
use faceformer::plan::{PlanOptions, plan};
use faceformer_occt::{SolidReport, build};
use faceformer_tests::{root, sample};
use serde::{Deserialize, Serialize};

/// Largest relative difference of volumes. The drawings' coordinates are rounded to 1e-6, and thin
/// parts have volumes that react a thousand times as strongly.
const VOLUME_TOLERANCE: f64 = 1e-3;

/// The same where a face is of no kind that we know: what lies between its edges is a guess.
const FILLED_TOLERANCE: f64 = 1e-2;

/// The originals' volumes are rounded to so much.
const VOLUME_ROUNDING: f64 = 5e-6;

/// Every so many drawings, one is in the fast tests.
const STRIDE: usize = 7;

/// An original solid.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Original {
    plane: usize,
    cylinder: usize,
    #[serde(default)]
    cone: usize,
    #[serde(default)]
    sphere: usize,
    #[serde(default)]
    torus: usize,
    #[serde(default)]
    other: usize,
    volume: f64,
}

impl Original {
    /// Faces by kind, in the order of [`KINDS`].
    fn counts(&self) -> [usize; 6] {
        let Self {
            plane,
            cylinder,
            cone,
            sphere,
            torus,
            other,
            ..
        } = *self;
        [plane, cylinder, cone, sphere, torus, other]
    }
}

/// Names of the kinds of surfaces in the list.
const KINDS: [&str; 6] = ["plane", "cylinder", "cone", "sphere", "torus", "other"];

#[derive(Debug, Deserialize)]
struct Expected {
    solids: BTreeMap<String, Original>,
    expected_failures: BTreeMap<String, BTreeMap<String, String>>,
}

fn path() -> std::path::PathBuf {
    root().join("tests/corpus/expected.json")
}

fn expected() -> Expected {
    serde_json::from_str(&std::fs::read_to_string(path()).unwrap()).unwrap()
}

/// The whole way from a drawing to a solid that is the original again, or what went wrong.
fn rebuild(drawing: &Drawing, found: &Identification, original: &Original) -> Result<(), String> {
    let options = LiftOptions::default();
    let lifted = lift(drawing, &found.faces, &options, Progress::none())
        .map_err(|e| format!("lift: {e}"))?;
    let plan = plan(drawing, &found.faces, &lifted, &PlanOptions::default())
        .map_err(|e| format!("plan: {e}"))?;
    let solid = build(&plan, Progress::none()).map_err(|e| format!("build: {e}"))?;
    compare(solid.report(), original)
}

fn compare(report: &SolidReport, original: &Original) -> Result<(), String> {
    let counts = &report.face_counts;
    let found = [
        counts.plane,
        counts.cylinder,
        counts.cone,
        counts.sphere,
        counts.torus,
        counts.other,
    ];
    let wanted = original.counts();
    // A face of another kind may be built as one of ours, if it is one or in its stead.
    let fits = if original.other == 0 {
        found == wanted
    } else {
        found[0] == wanted[0] && (1..5).all(|k| found[k] >= wanted[k])
    };
    if !fits || report.faces != wanted.iter().sum::<usize>() {
        return Err(format!("faces: {}, not {}", named(found), named(wanted)));
    }
    let off = (report.volume - original.volume).abs();
    let share = if original.other == 0 {
        VOLUME_TOLERANCE
    } else {
        FILLED_TOLERANCE
    };
    if off > share * original.volume + VOLUME_ROUNDING {
        return Err(format!(
            "volume: {:.5}, not {:.5}",
            report.volume, original.volume
        ));
    }
    Ok(())
}

/// Counts in words, without what there is none of.
fn named(counts: [usize; 6]) -> String {
    let all = KINDS.iter().zip(counts).filter(|(_, n)| *n > 0);
    let words: Vec<String> = all.map(|(kind, n)| format!("{n} {kind}")).collect();
    words.join(" ")
}

/// Rebuilds the listed drawings and returns the reasons of those that fail.
fn failures(mode: &str, expected: &Expected, stride: usize) -> BTreeMap<String, Option<String>> {
    let rotation = engine(EngineKind::Rotation);
    let faces = |drawing: &Drawing| match mode {
        "truth" => from_truth(drawing).ok_or_else(|| "no truth".to_owned()),
        _ => rotation
            .identify(drawing, Progress::none())
            .map_err(|e| format!("identify: {e}")),
    };
    let drawings = Drawings::open(sample()).unwrap().map(Result::unwrap);
    let listed = drawings.filter_map(|d| Some((*expected.solids.get(&d.id)?, d)));
    listed
        .step_by(stride)
        .map(|(original, d)| {
            let outcome = faces(&d).and_then(|found| rebuild(&d, &found, &original));
            (d.id, outcome.err())
        })
        .collect()
}

/// Compares with the list of expected failures, or writes it anew.
fn check(mode: &str, stride: usize) {
    let expected = expected();
    let outcomes = failures(mode, &expected, stride);
    assert!(outcomes.len() >= expected.solids.len() / stride);
    if std::env::var_os("FACEFORMER_BLESS").is_some() {
        return bless(mode, &outcomes);
    }
    let listed = &expected.expected_failures[mode];
    let mut wrong = Vec::new();
    for (id, failure) in &outcomes {
        match (failure, listed.get(id)) {
            (Some(reason), None) => wrong.push(format!("{id} fails: {reason}")),
            (None, Some(reason)) => {
                wrong.push(format!("{id} is right now, take it off the list: {reason}"));
            }
            _ => {}
        }
    }
    assert!(wrong.is_empty(), "{mode}:\n{}", wrong.join("\n"));
}

/// Replaces the expected failures among the drawings that ran, leaving the rest of the file as it
/// is.
fn bless(mode: &str, outcomes: &BTreeMap<String, Option<String>>) {
    // Both tests of this file write the same file.
    static LOCK: std::sync::Mutex<()> = std::sync::Mutex::new(());
    let _guard = LOCK.lock().unwrap();
    let expected = expected();
    let mut failures = expected.expected_failures;
    let listed = failures.entry(mode.to_owned()).or_default();
    for (id, failure) in outcomes {
        match failure {
            Some(reason) => listed.insert(id.clone(), shortened(reason)),
            None => listed.remove(id),
        };
    }
    let rows = |rows: Vec<String>| rows.join(",\n");
    let line = |indent: &str, key: &String, value: String| {
        format!("{indent}{}: {value}", serde_json::to_string(key).unwrap())
    };
    let solids = expected.solids.iter().map(|(id, original)| {
        let counts = KINDS.iter().zip(original.counts()).enumerate();
        let counts: Vec<String> = counts
            .filter(|(k, (_, n))| *k < 2 || *n > 0)
            .map(|(_, (kind, n))| format!(r#""{kind}": {n}, "#))
            .collect();
        let value = format!(r#"{{{}"volume": {}}}"#, counts.concat(), original.volume);
        line("    ", id, value)
    });
    let modes = failures.iter().map(|(mode, listed)| {
        let listed = listed
            .iter()
            .map(|(id, reason)| line("      ", id, serde_json::to_string(reason).unwrap()));
        let listed = rows(listed.collect());
        let body = if listed.is_empty() {
            "{}".to_owned()
        } else {
            format!("{{\n{listed}\n    }}")
        };
        line("    ", mode, body)
    });
    let text = format!(
        "{{\n  \"solids\": {{\n{}\n  }},\n  \"expected_failures\": {{\n{}\n  }}\n}}\n",
        rows(solids.collect()),
        rows(modes.collect())
    );
    std::fs::write(path(), text).unwrap();
}

/// The beginning of a reason; some end in long lists of vertices.
fn shortened(reason: &str) -> String {
    const LONGEST: usize = 90;
    if reason.chars().count() <= LONGEST {
        return reason.to_owned();
    }
    reason.chars().take(LONGEST).chain("...".chars()).collect()
}

#[test]
fn some_drawings_with_their_true_faces() {
    check("truth", STRIDE);
}

#[test]
fn some_drawings_with_the_faces_found() {
    check("rotation", STRIDE);
}

#[test]
#[ignore = "the whole corpus; run by continuous integration"]
fn all_drawings_with_their_true_faces() {
    check("truth", 1);
}

#[test]
#[ignore = "the whole corpus; run by continuous integration"]
fn all_drawings_with_the_faces_found() {
    check("rotation", 1);
}

#[test]
fn the_lists_name_drawings_that_are_there() {
    let expected = expected();
    assert_eq!(expected.solids.len(), 300);
    assert_eq!(
        expected.expected_failures.keys().collect::<Vec<_>>(),
        ["rotation", "truth"]
    );
    for id in expected
        .expected_failures
        .values()
        .flat_map(|listed| listed.keys())
    {
        assert!(
            expected.solids.contains_key(id),
            "{id} is no drawing of the list"
        );
    }
}
