//! Lengths that planning judges by.

/// Tolerances of one plan, in drawing units.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lengths {
    /// Half diagonal of the drawing.
    pub(super) size: f64,
    /// Within this, what was measured may be taken for what was meant.
    pub(super) snap: f64,
    /// Beyond this, an edge is off its surface.
    pub(super) limit: f64,
}
