//! The first stages: a usable drawing, its faces, its depth.

use faceformer::Progress;
use faceformer::drawing::{CleanDrawing, Drawing, Finding, Severity};
use faceformer::identify::{self, Engine, EngineKind, Identification};
use faceformer::lift::{Lift, LiftOptions, lift};

use crate::args::{FacesArgs, IdentifyArgs, LiftArgs, ModelArgs};
use crate::failure::Failure;
use crate::output::{Output, finish, json_line};
use crate::source;

/// Where faces come from.
pub(crate) enum FacesFrom {
    /// An engine finds them. It is made once, however many drawings it sees.
    Engine(Box<dyn Engine>),
    /// The drawing's truth.
    Truth,
    /// A faces file.
    File(String),
}

impl FacesFrom {
    /// What the command line asks for.
    pub(crate) fn new(args: &FacesArgs) -> Self {
        match (&args.faces, args.engine) {
            (Some(name), _) if name == "truth" => Self::Truth,
            (Some(name), _) => Self::File(name.clone()),
            (None, kind) => Self::engine(kind.unwrap_or_default(), &args.model),
        }
    }

    /// The engine of that kind, with its model.
    pub(crate) fn engine(kind: EngineKind, model: &ModelArgs) -> Self {
        let name = model.model.as_deref();
        Self::Engine(identify::engine_with(kind, name, model.decoding()))
    }

    /// The faces of a drawing.
    ///
    /// # Errors
    /// [`Failure::Stage`] if the engine refuses the drawing, [`Failure::Usage`] if it has no truth,
    /// [`Failure::Faces`] if the file does not fit it.
    pub(crate) fn faces(&self, drawing: &Drawing) -> Result<Identification, Failure> {
        match self {
            Self::Engine(engine) => Ok(engine.identify(drawing, Progress::none())?),
            Self::Truth => identify::from_truth(drawing).ok_or_else(|| {
                Failure::Usage(
                    "the drawing has no truth: name an engine, or a file of faces".to_owned(),
                )
            }),
            Self::File(name) => {
                let mut found =
                    identify::read_faces(drawing, &source::text(name)?).map_err(|source| {
                        Failure::Faces {
                            name: name.clone(),
                            source,
                        }
                    })?;
                // The user chose these; nothing is to take their place.
                found.alternatives.clear();
                Ok(found)
            }
        }
    }
}

/// Reads a drawing, tells the user what was found in it, and refuses it if it shows no solid.
///
/// # Errors
/// [`Failure::Read`], [`Failure::Drawing`], and [`Failure::Unusable`] with the first finding.
pub(crate) fn usable(name: &str) -> Result<Drawing, Failure> {
    let CleanDrawing {
        drawing, report, ..
    } = source::load(name)?;
    let (errors, rest): (Vec<&Finding>, Vec<&Finding>) = report
        .findings
        .iter()
        .partition(|f| f.severity == Severity::Error);
    if let Some((first, further)) = errors.split_first() {
        return Err(Failure::Unusable {
            name: source::shown(name).to_owned(),
            first: first.message.clone(),
            further: further.len(),
        });
    }
    for finding in rest {
        if finding.severity == Severity::Warning {
            eprintln!("faceformer: warning: {}", finding.message);
        }
    }
    Ok(drawing)
}

/// Passes an identification's notices on to the user.
pub(crate) fn tell(notices: &[String]) {
    for notice in notices {
        eprintln!("faceformer: note: {notice}");
    }
}

/// `faceformer identify`.
///
/// # Errors
/// [`Failure`].
pub(crate) fn run_identify(args: &IdentifyArgs) -> Result<(), Failure> {
    let output = args.output.as_deref().map(Output::create).transpose()?;
    let drawing = usable(&args.drawing)?;
    let found = FacesFrom::engine(args.engine, &args.model).faces(&drawing)?;
    tell(&found.notices);
    finish(output, &json_line(&found)?)
}

/// `faceformer lift`.
///
/// # Errors
/// [`Failure`].
pub(crate) fn run_lift(args: &LiftArgs) -> Result<(), Failure> {
    let output = args.output.as_deref().map(Output::create).transpose()?;
    let drawing = usable(&args.drawing)?;
    let found = FacesFrom::new(&args.faces).faces(&drawing)?;
    tell(&found.notices);
    let lifted = raise(&drawing, &found, args.flip)?;
    finish(output, &json_line(&lifted)?)
}

/// Lifts a drawing and tells the user which faces contradict the depths.
///
/// # Errors
/// [`Failure::Stage`].
pub(crate) fn raise(
    drawing: &Drawing,
    found: &Identification,
    flip: bool,
) -> Result<Lift, Failure> {
    let options = LiftOptions { flip };
    let lifted = lift(drawing, &found.faces, &options, Progress::none())?;
    warn(&lifted);
    Ok(lifted)
}

/// Tells the user which faces contradict the depths.
pub(crate) fn warn(lift: &Lift) {
    for conflict in &lift.conflicts {
        eprintln!(
            "faceformer: warning: {conflict}, {:.2e} off its surface",
            conflict.residual
        );
    }
}
