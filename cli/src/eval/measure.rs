//! One drawing through the stages, timed and compared with its truth.

use std::time::{Duration, Instant};

use faceformer::drawing::{Drawing, SurfaceKind, Truth};
use faceformer::identify::metrics::DrawingScore;
use faceformer::identify::{Face, Identification};
use faceformer::lift::{LiftOptions, depth_error, lift};
use faceformer::plan::PlanOptions;
use faceformer::{Error, Progress};
use serde::Serialize;

use super::compare::{Compared, compare};
use super::random::Random;
use super::right_angles::RightAngles;
use super::spoil::corrupt;
use crate::failure::Failure;
use crate::solid::{Made, make};
use crate::stages::FacesFrom;

/// Largest depth error of a drawing that counts as lifted, in drawing units (the half diagonal of
/// the solid's bounding box is 1).
const DEPTH_TOLERANCE: f64 = 1e-3;

/// Readings of which the best one counts, where the best of several is asked for.
const TOP: usize = 3;

/// A stage that refused a drawing, or whose result is wrong.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Failed {
    /// The drawing.
    pub(crate) id: String,
    /// `clean` (clean-up made other edges), `identify`, `lift`, `depth` (lifted, but not as in the
    /// truth), `conflict` (a wrong face is not named), `plan`, `build`, `chamfer` (the solid is not
    /// the true one), `faces` (its faces are of other kinds) or `truth` (there is no true solid to
    /// compare with).
    pub(crate) stage: &'static str,
    /// Why.
    pub(crate) message: String,
}

/// Figures of one drawing.
#[derive(Debug, Clone)]
pub(crate) struct Measured {
    /// Faces and loops against the truth.
    pub(crate) score: DrawingScore,
    /// Whether every depth is right.
    pub(crate) lifted: bool,
    /// Whether a valid closed solid came out.
    pub(crate) valid: bool,
    /// Time of lifting, in milliseconds; `None` if it was not tried or failed.
    pub(crate) lift_ms: Option<f64>,
    /// Time of planning, building and checking the solid, in milliseconds; `None` if it was not
    /// tried or failed.
    pub(crate) solid_ms: Option<f64>,
    /// What went wrong, in the order of the stages.
    pub(crate) failed: Vec<Failed>,
    /// What lifting said of faces that were made wrong on purpose.
    pub(crate) corrupted: Option<Corrupted>,
    /// How the solid compares with the true one; `None` if there is no solid, or no truth.
    pub(crate) compared: Option<Compared>,
    /// Right angles between planes that are exact in the lift; `None` if there is no lift.
    pub(crate) right_angles: Option<RightAngles>,
    /// Whether an alternative was taken because the first reading has a fault.
    pub(crate) exchanged: bool,
    /// Whether the solid, or that of one of the first three readings, is the true one.
    pub(crate) near_top3: bool,
    /// Whether there is a solid, and no true one to compare it with.
    pub(crate) no_truth: bool,
    /// Which kinds of surface the truth has, in the order of [`SurfaceKind::ALL`].
    pub(crate) kinds: [bool; 6],
}

impl Measured {
    /// A drawing of which nothing but the faces is known.
    fn scored(score: DrawingScore, truth: &Truth) -> Self {
        Self {
            score,
            lifted: false,
            valid: false,
            lift_ms: None,
            solid_ms: None,
            failed: Vec::new(),
            corrupted: None,
            compared: None,
            right_angles: None,
            exchanged: false,
            near_top3: false,
            no_truth: false,
            kinds: SurfaceKind::ALL.map(|kind| truth.faces.iter().any(|f| f.kind == kind)),
        }
    }
}

/// What lifting said of faces that were made wrong on purpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Corrupted {
    /// Faces made wrong.
    pub(crate) wrong: usize,
    /// Those of them that are in the report.
    pub(crate) named: usize,
    /// Other faces in the report.
    pub(crate) accused: usize,
}

/// A drawing that clean-up made another one of, and why it is another one.
pub(crate) fn refused(id: &str, truth: &Truth, why: String) -> Measured {
    let mut measured = Measured::scored(DrawingScore::refused(truth), truth);
    measured.failed.push(Failed {
        id: id.to_owned(),
        stage: "clean",
        message: why,
    });
    measured
}

/// Takes a drawing through identification and, with `solids`, to its solid.
pub(crate) fn measure(
    drawing: &Drawing,
    truth: &Truth,
    faces: &FacesFrom,
    solids: bool,
) -> Measured {
    let mut failed = Vec::new();
    let mut fail = |stage, message| {
        failed.push(Failed {
            id: drawing.id.clone(),
            stage,
            message,
        });
    };
    let start = Instant::now();
    let found = faces.faces(drawing);
    let ms = milliseconds(start.elapsed());
    let score = match &found {
        Ok(found) => DrawingScore::of(truth, found, ms),
        Err(failure) => {
            fail("identify", failure.to_string());
            DrawingScore::refused(truth)
        }
    };
    let mut measured = Measured::scored(score, truth);
    if let (Ok(found), true) = (&found, solids) {
        measure_solid(drawing, truth, found, &mut measured, &mut fail);
    }
    measured.failed = failed;
    measured
}

/// Makes faces wrong and lifts; there is no solid to build of them.
pub(crate) fn measure_corrupted(
    drawing: &Drawing,
    truth: &Truth,
    faces: &FacesFrom,
    count: usize,
    random: &mut Random,
) -> Measured {
    let mut measured = measure(drawing, truth, faces, false);
    let Ok(found) = faces.faces(drawing) else {
        return measured;
    };
    let mut faces = found.faces;
    let wrong = corrupt(&mut faces, count, random);
    let mut report = Corrupted {
        wrong: wrong.len(),
        named: 0,
        accused: 0,
    };
    let mut fail = |stage, message| {
        measured.failed.push(Failed {
            id: drawing.id.clone(),
            stage,
            message,
        });
    };
    let start = Instant::now();
    match lift(drawing, &faces, &LiftOptions::default(), Progress::none()) {
        Ok(lifted) => {
            measured.lift_ms = Some(milliseconds(start.elapsed()));
            let error = depth_error(&lifted, truth);
            measured.lifted = error <= DEPTH_TOLERANCE;
            if !measured.lifted {
                fail("depth", format!("the depths are up to {error:.1e} off"));
            }
            let named = |f: &usize| lifted.conflicts.iter().any(|c| c.face == *f);
            report.named = wrong.iter().filter(|f| named(f)).count();
            report.accused = lifted.conflicts.len() - report.named;
            if report.named < report.wrong {
                let missed: Vec<usize> =
                    wrong.iter().filter(|f| !named(f)).map(|f| f + 1).collect();
                fail("conflict", format!("wrong faces {missed:?} are not named"));
            }
        }
        Err(error) => fail("lift", error.to_string()),
    }
    measured.corrupted = Some(report);
    measured
}

/// The solid of some faces beside the true one; `None` if there is no solid.
fn beside_truth(
    made: &Made,
    drawing: &Drawing,
    truth: &Truth,
    faces: &[Face],
) -> Option<Result<Compared, String>> {
    let (plan, solid) = made.built.as_ref().ok()?;
    let lift = made.lift.as_ref()?;
    Some(compare(drawing, truth, faces, lift, (plan, solid)))
}

/// The stage that gave no solid.
const fn stage(failure: &Failure) -> &'static str {
    match failure {
        Failure::Stage(Error::Lift(_)) => "lift",
        Failure::Stage(Error::Plan(_)) => "plan",
        _ => "build",
    }
}

fn measure_solid(
    drawing: &Drawing,
    truth: &Truth,
    found: &Identification,
    measured: &mut Measured,
    fail: &mut dyn FnMut(&'static str, String),
) {
    let options = PlanOptions::default();
    let taken = make(drawing, found, false, &options);
    measured.exchanged = taken.reading > 0;
    let made = taken.result;
    if let Some(lifted) = &made.lift {
        measured.lift_ms = Some(milliseconds(made.lift_time));
        let error = depth_error(lifted, truth);
        measured.lifted = error <= DEPTH_TOLERANCE;
        let faces = found.reading(taken.reading);
        measured.right_angles = Some(RightAngles::of(drawing, faces, lifted));
        if !measured.lifted {
            fail("depth", format!("the depths are up to {error:.1e} off"));
        }
    }
    match &made.built {
        Ok(_) => {
            measured.valid = true;
            measured.solid_ms = Some(milliseconds(made.build_time));
        }
        Err(failure) => fail(stage(failure), failure.to_string()),
    }
    match beside_truth(&made, drawing, truth, found.reading(taken.reading)) {
        Some(Ok(compared)) => {
            if !compared.near {
                let by = compared.chamfer;
                fail(
                    "chamfer",
                    format!("the solid is {by:.1e} from the true one"),
                );
            }
            let (found, wanted) = (compared.faces, compared.true_faces);
            if found != wanted {
                fail(
                    "faces",
                    format!("the solid has {found}; the truth {wanted}"),
                );
            }
            measured.compared = Some(compared);
        }
        Some(Err(why)) => {
            measured.no_truth = true;
            fail("truth", why);
        }
        None => {}
    }
    let near = |k: usize| {
        let faces = found.reading(k);
        let made = Made::of(drawing, faces, false, &options);
        let compared = beside_truth(&made, drawing, truth, faces);
        compared.is_some_and(|c| c.is_ok_and(|c| c.near))
    };
    measured.near_top3 = measured.compared.as_ref().is_some_and(|c| c.near)
        || (!measured.no_truth
            && (0..TOP.min(1 + found.alternatives.len())).any(|k| k != taken.reading && near(k)));
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}
