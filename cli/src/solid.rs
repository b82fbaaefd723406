//! `faceformer solid`: the whole way from a drawing to a solid.

use std::path::Path;

use faceformer::Progress;
use faceformer::drawing::Drawing;
use faceformer::identify::Identification;
use faceformer::lift::Lift;
use faceformer::plan::{Orientation, Plan, PlanOptions, plan};
use faceformer_occt::{Format, Solid, SolidReport, build};
use serde::Serialize;

use crate::args::{OrientationArg, SolidArgs};
use crate::failure::Failure;
use crate::output::{Output, json_line, print};
use crate::stages::{FacesFrom, raise, tell, usable};

/// What `-o OUT.json` holds.
#[derive(Debug, Serialize)]
struct Record<'a> {
    report: &'a SolidReport,
    lift: &'a Lift,
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
    let lift = raise(&drawing, &found, args.flip)?;
    let options = PlanOptions {
        scale: args.scale,
        orientation: match args.orientation {
            OrientationArg::Upright => Orientation::Upright,
            OrientationArg::Drawn => Orientation::Drawn,
        },
    };
    let (plan, solid) = match make(&drawing, &found, &lift, &options) {
        Ok(made) => made,
        Err(Failure::Build(error)) => {
            if let (Some(output), Some(shell)) = (partial, error.partial()) {
                output.write(shell)?;
                output.commit()?;
            }
            return Err(Failure::Build(error));
        }
        Err(failure) => return Err(failure),
    };
    tell(&plan.notices);
    let report = solid.report();
    match target {
        Target::Shape(format) => solid.write(output.path()?, format)?,
        Target::Json => {
            let lift = &lift;
            let plan = &plan;
            output.write(&json_line(&Record { report, lift, plan })?)?;
        }
    }
    output.commit()?;
    print(summary(&args.output, report).as_bytes())
}

/// Plans and builds the solid of a lifted drawing.
///
/// # Errors
/// [`Failure::Stage`] from the plan, [`Failure::Build`] from the CAD kernel.
pub(crate) fn make(
    drawing: &Drawing,
    found: &Identification,
    lift: &Lift,
    options: &PlanOptions,
) -> Result<(Plan, Solid), Failure> {
    let plan = plan(drawing, &found.faces, lift, options)?;
    let solid = build(&plan, Progress::none())?;
    Ok((plan, solid))
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
