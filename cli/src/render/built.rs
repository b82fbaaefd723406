//! The solid of a drawing, built for its picture.

use faceformer::drawing::Drawing;
use faceformer::identify::{Face, Identification};
use faceformer::plan::{Orientation, Plan, PlanOptions};
use faceformer_occt::{Format, SolidReport};
use glam::{DVec2, DVec3};

use super::mesh::Mesh;
use super::owner::owners;
use super::page::{Anchor, Page};
use super::palette::Rgb;
use super::solid_view::SolidView;
use super::view::Frame;
use super::{INK, QUIET};
use crate::failure::Failure;
use crate::output::Output;
use crate::solid::make;
use crate::stages::{tell, warn};

/// A solid that stands as its drawing shows it.
#[derive(Debug)]
pub(crate) struct Built {
    mesh: Mesh,
    plan: Plan,
    axes: Vec<DVec3>,
    report: SolidReport,
}

impl Built {
    /// Lifts the drawing, builds its solid and divides it into triangles. The faces of the reading
    /// that the solid is of take the place of those in `found`. The triangles take their way through
    /// the temporary file of `scratch`, which the picture overwrites later.
    ///
    /// # Errors
    /// [`Failure`] of the stage that failed.
    pub(crate) fn new(
        drawing: &Drawing,
        found: &mut Identification,
        flip: bool,
        scratch: &Output,
    ) -> Result<Self, Failure> {
        let options = PlanOptions {
            orientation: Orientation::Drawn,
            ..PlanOptions::default()
        };
        let taken = make(drawing, found, flip, &options);
        tell(taken.notice.as_slice());
        let (plan, solid) = taken.result.built?;
        let lift = taken.result.lift;
        lift.iter().for_each(warn);
        if let Some(k) = taken.reading.checked_sub(1) {
            let other = &mut found.alternatives[k].faces;
            std::mem::swap(&mut found.faces, other);
        }
        let path = scratch.path()?;
        solid.write(path, Format::Stl)?;
        let read = |source| Failure::Read {
            path: path.to_path_buf(),
            source,
        };
        let stl = std::fs::read(path).map_err(read)?;
        let mesh = Mesh::from_stl(&stl)
            .ok_or_else(|| read(std::io::Error::from(std::io::ErrorKind::InvalidData)))?;
        Ok(Self {
            mesh,
            plan,
            axes: lift.map(|l| l.directions).unwrap_or_default(),
            report: solid.report().clone(),
        })
    }

    /// Draws the solid from another side. `colours` has one entry for each face of the drawing.
    pub(crate) fn draw(
        &self,
        page: &mut Page,
        frame: Frame,
        drawing: &Drawing,
        found: &Identification,
        colours: &[Rgb],
    ) {
        let outlines: Vec<Vec<Vec<DVec2>>> = self
            .plan
            .faces
            .iter()
            .map(|f| {
                let faces = f.sources.iter().filter_map(|i| found.faces.get(*i));
                faces.flat_map(|face| rings(drawing, face)).collect()
            })
            .collect();
        let unknown = Rgb(170, 174, 178);
        let colours: Vec<Rgb> = self
            .plan
            .faces
            .iter()
            .map(|f| f.sources.first().and_then(|i| colours.get(*i)).copied())
            .map(|colour| colour.unwrap_or(unknown))
            .collect();
        SolidView {
            mesh: &self.mesh,
            plan: &self.plan,
            owners: &owners(&self.mesh, &self.plan, &outlines),
            colours: &colours,
            axes: &self.axes,
        }
        .draw(page, frame);
        let text = format!(
            "{}, volume {:.4}",
            self.report.face_counts, self.report.volume
        );
        let at = |y: f64| DVec2::new(frame.corner.x, y);
        let title = "The solid from another side";
        page.text(at(30.0), title, 18.0, INK, Anchor::Start, false);
        page.text(at(50.0), &text, 13.0, QUIET, Anchor::Start, false);
    }
}

/// The outlines of a face in the drawing.
fn rings(drawing: &Drawing, face: &Face) -> Vec<Vec<DVec2>> {
    face.loops
        .iter()
        .map(|coedges| super::wireframe::ring(drawing, coedges))
        .collect()
}
