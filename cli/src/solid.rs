//! `faceformer solid`: the whole way from a drawing to a solid.

use std::path::Path;
use std::time::{Duration, Instant};

use faceformer::Progress;
use faceformer::drawing::Drawing;
use faceformer::identify::{Face, Identification};
use faceformer::lift::{Lift, LiftOptions, lift};
use faceformer::plan::{Orientation, Plan, PlanOptions};
use faceformer::readings::{self, Taken};
use faceformer_occt::{Format, Solid, SolidReport, reconstruct};
use serde::Serialize;

use crate::args::{OrientationArg, SolidArgs};
use crate::failure::Failure;
use crate::output::{Output, json_line, print};
use crate::stages::{FacesFrom, tell, usable, warn};

/// What `-o OUT.json` holds.
#[derive(Debug, Serialize)]
struct Record<'a> {
    report: &'a SolidReport,
    /// Which reading the solid is of: 0 is the best, 1 the first alternative.
    reading: usize,
    /// Why it is not the best one.
    notice: Option<&'a str>,
    lift: Option<&'a Lift>,
    plan: &'a Plan,
}

/// Files that a solid can be written to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Target {
    /// A CAD or mesh file.
    Shape(Format),
    /// The plan with the lift and the report.
    Json,
}

impl Target {
    fn of(path: &Path) -> Result<Self, Failure> {
        let ending = path.extension().and_then(|e| e.to_str()).unwrap_or("");
        match ending.to_ascii_lowercase().as_str() {
            "step" | "stp" => Ok(Self::Shape(Format::Step)),
            "brep" | "brp" => Ok(Self::Shape(Format::Brep)),
            "stl" => Ok(Self::Shape(Format::Stl)),
            "json" => Ok(Self::Json),
            _ => Err(Failure::Usage(format!(
                "{}: the ending says the format, and must be .step, .stp, .brep, .brp, .stl or \
                 .json",
                path.display()
            ))),
        }
    }
}

/// Makes the solid and writes it.
///
/// # Errors
/// [`Failure`].
pub(crate) fn run(args: &SolidArgs) -> Result<(), Failure> {
    let target = Target::of(&args.output)?;
    if !(args.scale.is_finite() && args.scale > 0.0) {
        return Err(Failure::Usage(format!(
            "--scale must be a positive number, and is {}",
            args.scale
        )));
    }
    let output = Output::create(&args.output)?;
    let partial = args
        .keep_partial
        .as_deref()
        .map(Output::create)
        .transpose()?;
    let drawing = usable(&args.drawing)?;
    let found = FacesFrom::new(&args.faces).faces(&drawing)?;
    tell(&found.notices);
    let options = PlanOptions {
        scale: args.scale,
        orientation: match args.orientation {
            OrientationArg::Upright => Orientation::Upright,
            OrientationArg::Drawn => Orientation::Drawn,
        },
    };
    let taken = make(&drawing, &found, args.flip, &options);
    if let Some(lift) = &taken.result.lift {
        warn(lift);
    }
    let Made { lift, built, .. } = taken.result;
    let (lift, plan, solid) = match built {
        Ok((plan, solid)) => (lift, plan, solid),
        Err(Failure::Build(error)) => {
            if let (Some(output), Some(shell)) = (partial, error.partial()) {
                output.write(shell)?;
                output.commit()?;
            }
            return Err(Failure::Build(error));
        }
        Err(failure) => return Err(failure),
    };
    tell(taken.notice.as_slice());
    tell(&plan.notices);
    let report = solid.report();
    match target {
        Target::Shape(format) => solid.write(output.path()?, format)?,
        Target::Json => {
            output.write(&json_line(&Record {
                report,
                reading: taken.reading,
                notice: taken.notice.as_deref(),
                lift: lift.as_ref(),
                plan: &plan,
            })?)?;
        }
    }
    output.commit()?;
    print(summary(&args.output, report).as_bytes())
}

/// What came of one set of faces.
#[derive(Debug)]
pub(crate) struct Made {
    /// The depths, if they could be had.
    pub(crate) lift: Option<Lift>,
    /// Time that lifting took.
    pub(crate) lift_time: Duration,
    /// The solid with its plan, or the failure of the stage at fault.
    pub(crate) built: Result<(Plan, Solid), Failure>,
    /// Faces whose surfaces were given up for it.
    given_up: Vec<usize>,
    /// Time that plan and solid took.
    pub(crate) build_time: Duration,
}

impl Made {
    /// Lifts, plans and builds.
    pub(crate) fn of(drawing: &Drawing, faces: &[Face], flip: bool, options: &PlanOptions) -> Self {
        let start = Instant::now();
        let lifted = lift(drawing, faces, &LiftOptions { flip }, Progress::none());
        let lift_time = start.elapsed();
        let start = Instant::now();
        let (lift, made) = match lifted {
            Ok(mut lift) => {
                let made = reconstruct(drawing, faces, &mut lift, options, Progress::none());
                (Some(lift), made)
            }
            Err(error) => (None, Err(error)),
        };
        let (built, given_up) = match made {
            Ok(made) => {
                let built = made.solid.map(|solid| (made.plan, solid));
                (built.map_err(Into::into), made.given_up)
            }
            Err(error) => (Err(error.into()), Vec::new()),
        };
        Self {
            lift,
            lift_time,
            built,
            given_up,
            build_time: start.elapsed(),
        }
    }

    /// What is wrong with it, if something is.
    fn fault(&self) -> Option<String> {
        match &self.built {
            Err(failure) => Some(readings::failure(failure)),
            Ok(_) => {
                let conflict = self.lift.as_ref().and_then(readings::conflict);
                conflict.or_else(|| readings::given_up(&self.given_up))
            }
        }
    }
}

/// Makes the solid of the first reading without fault.
pub(crate) fn make(
    drawing: &Drawing,
    found: &Identification,
    flip: bool,
    options: &PlanOptions,
) -> Taken<Made> {
    readings::take(
        found,
        readings::ALTERNATIVES,
        |faces| Made::of(drawing, faces, flip, options),
        Made::fault,
    )
}

fn summary(path: &Path, report: &SolidReport) -> String {
    let worst = report
        .filled
        .iter()
        .map(|f| f.deviation)
        .fold(0.0, f64::max);
    let filled = match report.filled.len() {
        0 => String::new(),
        n => format!("; {n} filled, within {worst:.1e} of their edges"),
    };
    format!(
        "{}: valid closed solid, {} faces ({}{filled}), {} edges, {} vertices, volume {:.6}, area \
         {:.6}\n",
        path.display(),
        report.faces,
        report.face_counts,
        report.edges,
        report.vertices,
        report.volume,
        report.area
    )
}
