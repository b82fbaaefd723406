//! Dominant directions, from the drawing alone.
//!
//! Straight edges vote in clusters of parallel lines, circles through the shape of their ellipses:
//! a circle of unit normal n is drawn with |n_z| = minor / major and n_xy along the minor axis.
//! Three clusters, a circle and a cluster, or two circles make a hypothesis of a frame (design,
//! section 4); it is refined as one rotation over all evidence that agrees with it, and the frame
//! that explains most wins. A part whose circles show one axis only, such as a shaft, gives that
//! axis alone. Perspective drawings show directions by vanishing points instead (`central`).
//!
//! How precise a drawing is, is estimated too: from coordinates rounded to about 1e-6 of the
//! drawing's size up to those drawn by hand, the precision that explains the drawing in the fewest
//! bits wins.

mod central;
mod choose;
mod coarse;
mod evidence;
mod hypotheses;
mod model_frame;
mod refine;
#[cfg(test)]
mod tests;

use glam::{DMat3, DVec2, DVec3};

use super::{Camera, LiftError, Sweep};
use crate::drawing::{Drawing, Projection};

pub(crate) use coarse::{is_exact, is_rounded, recognised};
pub(crate) use evidence::{AGREE, Evidence};

/// One direction and what supports it.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Unit vector in the camera frame, towards the viewer.
    pub direction: DVec3,
    /// Straight edges (from 0) along it.
    pub edges: Vec<usize>,
    /// Elliptic arcs (edges, from 0) that are drawn as circles around it.
    pub circles: Vec<usize>,
}

/// A further direction that straight edges have, told by their vanishing point, or that circles have
/// as their normal.
#[derive(Debug, Clone, PartialEq)]
pub struct Slant {
    /// Unit vector in the camera frame, of no meaning of its sign.
    pub direction: DVec3,
    /// Straight edges (from 0) along it.
    pub edges: Vec<usize>,
    /// Elliptic arcs (edges, from 0) that are drawn as circles around it.
    pub circles: Vec<usize>,
    /// Its standard error, radians.
    pub error: f64,
    /// Whether it makes a usual angle with two axes and a right one with the third. If not, the
    /// edges may as well meet in a point of space.
    pub usual: bool,
}

/// The normals of a circle that is drawn as an ellipse: two planes show it alike.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DrawnNormals {
    pub(crate) edge: usize,
    /// The arc's vertices.
    pub(crate) v: [usize; 2],
    /// The two unit normals.
    pub(crate) normals: [DVec3; 2],
    /// Their standard error, radians.
    pub(crate) error: f64,
    /// Middle of the ellipse, and its larger half axis.
    pub(crate) center: DVec2,
    pub(crate) reach: f64,
}

impl DrawnNormals {
    /// Whether a circle of the unit normal `n`, of any sign and known to `error` radians, may look so.
    pub(crate) fn agrees(&self, n: DVec3, error: f64) -> bool {
        let limit = (AGREE * (self.error + error)).min(0.05);
        let near = |m: &DVec3| m.cross(n).length() < limit;
        self.normals.iter().any(near)
    }
}

/// The normals of all arcs that are drawn as circles well enough, two each.
pub(crate) fn drawn_normals(
    drawing: &Drawing,
    camera: &Camera,
    precision: f64,
) -> Vec<DrawnNormals> {
    match camera {
        Camera::Parallel => evidence::drawn_normals(drawing, precision),
        Camera::Central { .. } => central::drawn_normals(drawing, camera, precision),
    }
}

/// The dominant directions of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct Directions {
    /// Three axes at right angles, or one alone.
    pub axes: Vec<Axis>,
    /// Further directions; in a parallel projection, which does not show them, those that faces tell.
    pub slanted: Vec<Slant>,
    /// Sections swept along a helix around one of the axes, as this reading sees them.
    pub(crate) swept: Vec<Sweep>,
    /// The projection: parallel, or central with a focal length given or estimated.
    pub camera: Camera,
    /// Standard error of the axes, radians.
    pub error: f64,
    /// Standard error of the drawing's coordinates, drawing units.
    pub precision: f64,
}

impl Directions {
    /// Estimates the directions of a drawing. An orthographic one is reversed in depth so that the
    /// model is seen from above: the axis that is most vertical on the page has its upper end
    /// towards the viewer.
    ///
    /// # Errors
    /// - [`LiftError::Focal`] if nothing tells the focal length of a perspective drawing.
    /// - [`LiftError::DegenerateView`] if the view is too close to an axis or a plane of two axes
    ///   for the drawing's precision.
    /// - [`LiftError::NoDirections`] if neither straight edges nor circles agree on any.
    pub fn estimate(drawing: &Drawing) -> Result<Self, LiftError> {
        let mut candidates = Self::candidates(drawing)?;
        Ok(candidates.swap_remove(0))
    }

    /// Further readings of the drawing after the best one, most likely first; never empty.
    ///
    /// # Errors
    /// As [`estimate`](Self::estimate).
    pub(crate) fn candidates(drawing: &Drawing) -> Result<Vec<Self>, LiftError> {
        match drawing.projection {
            Projection::Orthographic => choose::candidates(drawing),
            Projection::Perspective { focal } => central::candidates(drawing, focal),
        }
    }

    /// Readings of an orthographic drawing by hand, whose coordinates are off by a thousandth of its
    /// size and more, most likely first; none if nothing can be told.
    pub(crate) fn coarse(drawing: &Drawing) -> Vec<Self> {
        coarse::candidates(drawing)
    }

    /// Whether there are three axes at right angles.
    pub const fn is_frame(&self) -> bool {
        self.axes.len() == 3
    }

    /// The axis that a straight edge (from 0) is parallel to.
    pub fn axis_of_edge(&self, edge: usize) -> Option<usize> {
        self.axes.iter().position(|a| a.edges.contains(&edge))
    }

    /// The axis that an arc (edge, from 0) is drawn as a circle around.
    pub fn axis_of_circle(&self, edge: usize) -> Option<usize> {
        self.axes.iter().position(|a| a.circles.contains(&edge))
    }

    /// What circles are drawn around, with the arcs: the axes, then the further directions.
    pub(crate) fn normals(&self) -> impl Iterator<Item = (DVec3, &[usize])> {
        let axes = self.axes.iter().map(|a| (a.direction, &a.circles[..]));
        axes.chain(self.slanted.iter().map(|s| (s.direction, &s.circles[..])))
    }

    /// Direction of one of the [`normals`](Self::normals).
    pub(crate) fn normal(&self, k: usize) -> DVec3 {
        match self.axes.get(k) {
            Some(axis) => axis.direction,
            None => self.slanted[k - self.axes.len()].direction,
        }
    }

    /// Its standard error, radians.
    pub(crate) fn normal_error(&self, k: usize) -> f64 {
        match k.checked_sub(self.axes.len()) {
            None => self.error,
            Some(k) => self.slanted[k].error,
        }
    }

    /// The same directions mirrored in depth.
    #[must_use]
    pub fn reversed(mut self) -> Self {
        for axis in &mut self.axes {
            axis.direction = towards_viewer(axis.direction * DVec3::new(1.0, 1.0, -1.0));
        }
        self.swept = self.swept.into_iter().map(Sweep::reversed).collect();
        self
    }

    pub(crate) fn seen_from_above(self) -> Self {
        let steepest = self
            .axes
            .iter()
            .map(|a| a.direction)
            .max_by(|a, b| a.y.abs().total_cmp(&b.y.abs()));
        match steepest {
            Some(d) if d.y * d.z < 0.0 => self.reversed(),
            _ => self,
        }
    }
}

pub(crate) fn towards_viewer(d: DVec3) -> DVec3 {
    if d.z < 0.0 { -d } else { d }
}

fn columns(m: &DMat3) -> [DVec3; 3] {
    [m.x_axis, m.y_axis, m.z_axis]
}
