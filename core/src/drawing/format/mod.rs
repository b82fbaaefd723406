//! Files in and out: the interchange format, the released Faceformer JSON and plain edge lists.
//!
//! [`read`] tells the three apart by their keys: `vertices` is the interchange format, `pairings`
//! the release, and edges alone are a plain edge list.

mod check;
mod parse;
mod release;
mod write;

use super::{CleanDrawing, CleanOptions, Drawing, DrawingError, Limits, Report, clean, diagnose};
pub(super) use parse::{Raw, RawEdge};

/// Reads a drawing in any of the three forms.
///
/// - Interchange format (has `vertices`): taken at its word, checked and not changed.
/// - Released Faceformer JSON (has `pairings`): one polyline a co-edge; end points within 2e-4 of
///   the size are one vertex, and the faces become the truth.
/// - Plain edge list, `{"edges": [{"name": "Edge1", "points": [[x, y], ...]}]}` (an edge may also
///   be its bare list of points): goes through [`clean`] with the default options.
///
/// Unknown keys are ignored. The report holds what clean-up did and what [`diagnose`] found.
///
/// # Errors
/// [`DrawingError`] naming the edge or vertex that is wrong, or the limit that is passed; limits
/// are applied while the text is read, before any other work.
pub fn read(text: &str, limits: &Limits) -> Result<CleanDrawing, DrawingError> {
    let raw = parse::parse(text, limits)?;
    if raw.vertices.is_some() {
        let labels = raw.labels();
        let drawing = interchange(raw, limits)?;
        let sources = (0..drawing.edges.len()).map(|e| vec![e]).collect();
        let findings = diagnose::findings(&drawing, &labels);
        return Ok(CleanDrawing {
            drawing,
            sources,
            report: Report {
                findings,
                tolerance: None,
            },
        });
    }
    if raw.is_release() {
        return release::read(raw, limits);
    }
    clean::clean_raw(raw, &CleanOptions::default(), limits)
}

impl Drawing {
    /// Reads one drawing in the interchange format, within the default [`Limits`].
    ///
    /// # Errors
    /// [`DrawingError`] naming the edge or vertex that is wrong.
    pub fn from_json(text: &str) -> Result<Self, DrawingError> {
        let limits = Limits::default();
        interchange(parse::parse(text, &limits)?, &limits)
    }
}

fn interchange(raw: Raw, limits: &Limits) -> Result<Drawing, DrawingError> {
    let drawing = raw.into_drawing()?;
    drawing.check(limits)?;
    Ok(drawing.recognised())
}

#[cfg(test)]
mod tests;
