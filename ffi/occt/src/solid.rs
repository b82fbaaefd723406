//! Building, and the finished solid.

use std::path::Path;
use std::str::FromStr;

use faceformer::Progress;
use faceformer::plan::Plan;
use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::bridge::{Watcher, ffi};
use crate::encode::{Encoded, encode};
use crate::{OcctError, SolidReport};

/// File formats a solid is written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Format {
    /// STEP AP214, lengths in millimetres.
    Step,
    /// OCCT's BREP text, version 1, which every FreeCAD reads.
    Brep,
    /// Binary STL: triangles within 0.05% of the size.
    Stl,
}

impl FromStr for Format {
    type Err = OcctError;

    /// Reads a name or a file suffix: `step`, `stp`, `brep`, `brp`, `stl`, in any case.
    fn from_str(name: &str) -> Result<Self, OcctError> {
        match name.to_ascii_lowercase().as_str() {
            "step" | "stp" => Ok(Self::Step),
            "brep" | "brp" => Ok(Self::Brep),
            "stl" => Ok(Self::Stl),
            _ => Err(OcctError::Write {
                path: name.to_owned(),
                what: "the formats are step, brep and stl".to_owned(),
            }),
        }
    }
}

/// A valid, closed solid. It is plain data: it can go to another thread.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    brep: Vec<u8>,
    report: SolidReport,
}

impl Solid {
    /// Figures of the solid.
    pub const fn report(&self) -> &SolidReport {
        &self.report
    }

    /// The solid as BREP text, version 1.
    ///
    /// # Errors
    /// None today; the signature leaves room for shapes that are kept in another form.
    pub fn brep(&self) -> Result<Vec<u8>, OcctError> {
        Ok(self.brep.clone())
    }

    /// Triangles of the solid's faces, counter-clockwise seen from outside, no further than
    /// `deflection` from them; lengths in the plan's units.
    ///
    /// # Errors
    /// [`OcctError::Kernel`] if a face cannot be divided.
    pub fn triangles(&self, deflection: f64) -> Result<Vec<[DVec3; 3]>, OcctError> {
        let numbers = ffi::triangles(&self.brep, deflection)
            .map_err(|e| OcctError::Kernel(e.what().to_owned()))?;
        let corner = |t: &[f64], i: usize| DVec3::from_slice(&t[3 * i..3 * i + 3]);
        let triangles = numbers.chunks_exact(9);
        Ok(triangles
            .map(|t| [corner(t, 0), corner(t, 1), corner(t, 2)])
            .collect())
    }

    /// Writes the solid to a file, which is replaced if it is there.
    ///
    /// STEP files are written one at a time in a process, because OCCT's writer has global state.
    ///
    /// # Errors
    /// [`OcctError::Write`] if the file cannot be written.
    pub fn write(&self, path: &Path, format: Format) -> Result<(), OcctError> {
        let fail = |what: String| OcctError::Write {
            path: path.display().to_string(),
            what,
        };
        if format == Format::Brep {
            return std::fs::write(path, &self.brep).map_err(|e| fail(e.to_string()));
        }
        let name = path
            .to_str()
            .ok_or_else(|| fail("its name is not Unicode".to_owned()))?;
        match format {
            Format::Step => ffi::write_step(&self.brep, name),
            _ => ffi::write_stl(&self.brep, name),
        }
        .map_err(|e| fail(e.what().to_owned()))
    }
}

/// Builds the solid of a plan, and checks it.
///
/// Faces that only silhouettes part become one face: a hole is one cylinder with a seam. Where a filled
/// face with several loops cannot be built in one piece, its parts stay apart.
///
/// # Errors
/// [`OcctError`] naming the edge or face of the plan at fault, with the partial shell;
/// [`OcctError::Cancelled`] if `progress` asked to stop.
///
/// # Panics
/// Only if the callback of `progress` panics: its panic goes on.
pub fn build(plan: &Plan, progress: Progress<'_>) -> Result<Solid, OcctError> {
    let encoded = encode(plan, false)?;
    let rings = encoded.rings;
    let whole = run(encoded, progress);
    match &whole {
        Err(OcctError::Edge { .. } | OcctError::Face { .. } | OcctError::Shell { .. }) if rings => {
            match encode(plan, true).and_then(|parts| run(parts, progress)) {
                parts @ (Ok(_) | Err(OcctError::Cancelled)) => parts,
                Err(_) => whole,
            }
        }
        _ => whole,
    }
}

/// Builds and checks what was encoded.
fn run(encoded: Encoded, progress: Progress<'_>) -> Result<Solid, OcctError> {
    let Encoded {
        model,
        edges,
        faces,
        ..
    } = encoded;
    let watcher = Watcher::new(progress);
    let outcome = ffi::build(&model, &watcher);
    watcher.resume();
    let outcome = outcome.map_err(|e| OcctError::Kernel(e.what().to_owned()))?;
    let ffi::Outcome {
        fault,
        number,
        message,
        ..
    } = &outcome;
    let what = message.clone();
    // The fault's place in the plan, from 1; 0 if it has none.
    let place = |sources: &[usize]| {
        let index = (*number as usize).checked_sub(1);
        index.and_then(|i| sources.get(i)).map_or(0, |s| s + 1)
    };
    let partial = || outcome.brep.clone();
    Err(match *fault {
        ffi::Fault::None => {
            let report = SolidReport::new(&outcome, &faces);
            return Ok(Solid {
                brep: outcome.brep,
                report,
            });
        }
        ffi::Fault::Cancelled => OcctError::Cancelled,
        ffi::Fault::Edge => OcctError::Edge {
            edge: place(&edges),
            what,
            partial: partial(),
        },
        ffi::Fault::Face => OcctError::Face {
            face: place(&faces),
            what,
            partial: partial(),
        },
        ffi::Fault::Tolerance => OcctError::Tolerance {
            what,
            partial: partial(),
        },
        _ => OcctError::Shell {
            what,
            partial: partial(),
        },
    })
}

/// Version of the OCCT that is linked, as in "7.6.3".
///
/// # Errors
/// [`OcctError::Kernel`] if the kernel cannot be asked.
pub fn occt_version() -> Result<String, OcctError> {
    ffi::version().map_err(|e| OcctError::Kernel(e.what().to_owned()))
}

#[cfg(test)]
mod tests {
    use faceformer::drawing::CoEdge;
    use faceformer::plan::{Curve3, PlanEdge, PlanFace, Surface3};

    use super::*;

    /// The corner of a cube of side 1.
    fn tetrahedron() -> Plan {
        let line = |a, b| PlanEdge {
            v: [a, b],
            curve: Curve3::Line,
            silhouette: false,
        };
        let face = |normal: DVec3, walk: [i64; 3], origin: DVec3| PlanFace {
            surface: Surface3::Plane {
                origin,
                normal: normal.normalize(),
            },
            loops: vec![
                walk.iter()
                    .filter_map(|&k| CoEdge::from_signed(k))
                    .collect(),
            ],
            sources: Vec::new(),
        };
        Plan {
            vertices: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
            edges: vec![
                line(0, 1),
                line(0, 2),
                line(0, 3),
                line(1, 2),
                line(2, 3),
                line(3, 1),
            ],
            faces: vec![
                face(-DVec3::Z, [2, -4, -1], DVec3::ZERO),
                face(-DVec3::X, [3, -5, -2], DVec3::ZERO),
                face(-DVec3::Y, [1, -6, -3], DVec3::ZERO),
                face(DVec3::ONE, [4, 5, 6], DVec3::X),
            ],
            notices: Vec::new(),
        }
    }

    #[test]
    fn tetrahedron_has_a_sixth_of_the_cube() {
        let solid = build(&tetrahedron(), Progress::none()).unwrap();
        assert!((solid.report().volume - 1.0 / 6.0).abs() < 1e-12);
    }

    #[test]
    fn triangles_bound_the_volume() {
        let solid = build(&tetrahedron(), Progress::none()).unwrap();
        let triangles = solid.triangles(1e-3).unwrap();
        assert_eq!(triangles.len(), 4);
        let volume: f64 = triangles
            .iter()
            .map(|[a, b, c]| a.dot(b.cross(*c)) / 6.0)
            .sum();
        assert!((volume - 1.0 / 6.0).abs() < 1e-12);
    }

    /// A `Standard_Failure` is no `std::exception`: without our own trycatch this test would not
    /// fail but end the process.
    #[test]
    fn occt_exception_becomes_an_error() {
        let mut model = encode(&tetrahedron(), false).unwrap().model;
        model.scale = 0.0;
        let error = ffi::build(&model, &Watcher::new(Progress::none())).unwrap_err();
        assert!(
            error.what().contains("Standard_ConstructionError"),
            "{error}"
        );
    }

    #[test]
    fn occt_exception_of_one_edge_names_the_edge() {
        let mut model = encode(&tetrahedron(), false).unwrap().model;
        model.edges[3].kind = ffi::CurveKind::Ellipse;
        let outcome = ffi::build(&model, &Watcher::new(Progress::none())).unwrap();
        assert_eq!((outcome.fault, outcome.number), (ffi::Fault::Edge, 4));
        assert!(outcome.message.contains("Standard_"), "{}", outcome.message);
    }

    #[test]
    fn standard_exception_becomes_an_error() {
        let error = ffi::write_step(b"this is no shape", "unused.step").unwrap_err();
        assert!(error.what().contains("no BREP text"), "{error}");
    }
}
