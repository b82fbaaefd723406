//! Lengths that planning judges by.

/// Tolerances of one plan, in drawing units.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lengths {
    /// How far a curve may be drawn from where its surfaces meet: beyond it the surfaces are wrong.
    pub(super) drawn: f64,
    /// Within this, what was measured may be taken for what was meant.
    pub(super) snap: f64,
    /// Beyond this, an edge is off its surface.
    pub(super) limit: f64,
}
