//! Surface kinds of faces: from a loop as drawn, from how loops meet, and from lifted faces.

mod look;
mod planar;
mod rulings;

pub(crate) use planar::kinds_of;
pub(crate) use rulings::ruled_out;

use crate::drawing::{CoEdge, Drawing, SurfaceKind};
use look::Look;

/// The kind of surface that a loop of co-edges most likely bounds, by the loop alone; see
/// [`Look::kind`].
pub(crate) fn kind_of(drawing: &Drawing, walk: &[CoEdge]) -> SurfaceKind {
    Look::new(drawing, walk).kind()
}

/// Whether all edges of a loop lie on one ellipse and go around it once.
pub(crate) fn is_ring(drawing: &Drawing, walk: &[CoEdge]) -> bool {
    Look::new(drawing, walk).ring
}
