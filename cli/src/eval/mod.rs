//! `faceformer eval`: how right and how fast the stages are on drawings with known truth.

mod bar;
mod compare;
mod each;
mod figures;
mod measure;
mod random;
mod right_angles;
mod spoil;

use faceformer::drawing::dataset::Drawings;
use faceformer::drawing::{DrawingError, SurfaceKind, Truth};

use crate::args::{EvalArgs, Shapes};
use crate::failure::Failure;
use crate::output::{Output, finish, json_line, print};
use crate::stages::FacesFrom;
pub(crate) use bar::Bar;
use each::Row;
use figures::Figures;
use measure::{Measured, measure, measure_corrupted, refused};
use random::Random;

/// Measures a data set and prints the figures.
///
/// # Errors
/// [`Failure`]; drawings that a stage refuses are part of the figures and no failure.
pub(crate) fn run(args: &EvalArgs) -> Result<(), Failure> {
    let faces = FacesFrom::new(&args.faces);
    if let FacesFrom::File(name) = &faces {
        return Err(Failure::Usage(format!(
            "{name} holds the faces of one drawing; eval takes --faces truth, or --engine"
        )));
    }
    for (name, percent) in [("noise", args.noise), ("gap", args.gap)] {
        if let Some(percent) = percent
            && !(percent.is_finite() && percent > 0.0)
        {
            return Err(Failure::Usage(format!(
                "--{name} must be a positive percentage, and is {percent}"
            )));
        }
    }
    let failures = args.failures.as_deref().map(Output::create).transpose()?;
    let each = args.each.as_deref().map(Output::create).transpose()?;
    let mut rows = Vec::new();
    let bad_input = |source| Failure::Drawing {
        name: args.data.display().to_string(),
        source,
    };
    let limit = args.limit.unwrap_or(usize::MAX);
    let mut measured: Vec<Measured> = Vec::new();
    let mut bar = Bar::new(args.limit);
    for drawing in Drawings::open(&args.data).map_err(bad_input)? {
        if measured.len() >= limit {
            break;
        }
        let drawing = drawing.map_err(bad_input)?;
        let Some(truth) = &drawing.truth else {
            let what = format!(
                "drawing {:?} has none, and eval compares with it",
                drawing.id
            );
            return Err(bad_input(DrawingError::Truth(what)));
        };
        if !selected(args.shapes, truth) {
            continue;
        }
        let mut random = Random::new(args.seed, &drawing.id);
        let mut spoilt = drawing.clone();
        if let Some(percent) = args.noise {
            spoil::shake(&mut spoilt, percent / 100.0, &mut random);
        }
        let result = match (args.corrupt, args.gap) {
            (Some(count), _) => measure_corrupted(&spoilt, truth, &faces, count, &mut random),
            (None, Some(percent)) => match spoil::part(&spoilt, percent / 100.0, &mut random) {
                Ok(cleaned) => measure(&cleaned, truth, &faces, args.solids),
                Err(why) => refused(&drawing.id, truth, why),
            },
            (None, None) => measure(&spoilt, truth, &faces, args.solids),
        };
        if each.is_some() {
            rows.extend(json_line(&Row::of(&drawing, truth, &result, args.solids))?);
        }
        measured.push(result);
        bar.advance(measured.len());
    }
    bar.clear();
    if measured.is_empty() {
        return Err(Failure::Usage(format!(
            "{} has no drawing to measure; look at --shapes and --limit",
            args.data.display()
        )));
    }
    if let Some(output) = failures {
        let mut lines = Vec::new();
        for failed in measured.iter().flat_map(|m| &m.failed) {
            lines.extend(json_line(failed)?);
        }
        finish(Some(output), &lines)?;
    }
    if each.is_some() {
        finish(each, &rows)?;
    }
    let figures = Figures::of(&measured, args.solids);
    if args.json {
        print(&json_line(&figures)?)
    } else {
        print(figures.table(&measured).as_bytes())
    }
}

/// Whether a drawing with this truth is one of the shapes asked for.
fn selected(shapes: Shapes, truth: &Truth) -> bool {
    let all = |kinds: &[SurfaceKind]| truth.faces.iter().all(|f| kinds.contains(&f.kind));
    match shapes {
        Shapes::All => true,
        Shapes::Polyhedra => all(&[SurfaceKind::Plane]),
        Shapes::PolyhedraSingle => {
            all(&[SurfaceKind::Plane]) && truth.faces.iter().all(|f| f.loops.len() == 1)
        }
        Shapes::PlanesCylinders => all(&[SurfaceKind::Plane, SurfaceKind::Cylinder]),
    }
}

#[cfg(test)]
mod tests {
    use faceformer::drawing::{CoEdge, TruthFace};

    use super::*;

    fn truth(faces: &[(SurfaceKind, usize)]) -> Truth {
        let face = |&(kind, loops): &(SurfaceKind, usize)| TruthFace {
            kind,
            loops: vec![vec![CoEdge::new(0, false)]; loops],
        };
        Truth {
            faces: faces.iter().map(face).collect(),
            ..Truth::default()
        }
    }

    #[test]
    fn shapes_are_selected_by_truth() {
        use SurfaceKind::{Cone, Cylinder, Plane};
        let block = truth(&[(Plane, 1), (Plane, 1)]);
        let pocket = truth(&[(Plane, 1), (Plane, 2)]);
        let hole = truth(&[(Plane, 2), (Cylinder, 1)]);
        let cone = truth(&[(Plane, 1), (Cone, 1)]);
        let counts = |shapes| [&block, &pocket, &hole, &cone].map(|t| selected(shapes, t));
        assert_eq!(counts(Shapes::All), [true; 4]);
        assert_eq!(counts(Shapes::Polyhedra), [true, true, false, false]);
        assert_eq!(counts(Shapes::PolyhedraSingle), [true, false, false, false]);
        assert_eq!(counts(Shapes::PlanesCylinders), [true, true, true, false]);
    }
}
