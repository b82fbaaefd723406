//! Whether a part is inside or outside of what is placed.
//!
//! A part whose loops are each closed by a surface of their own is a closed body. A pocket's
//! opening and the same outline in the face it opens in cancel out, so a point is inside the solid
//! if it is inside an odd number of its parts.

use glam::{DVec2, DVec3};

use super::shapes::Shapes;

/// Where parts stand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// Depth added to the part's own.
    pub(super) shift: f64,
    /// Whether its loops are walked backwards.
    pub(super) turned: bool,
}

/// What a part would do to the solid.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Fit {
    /// Share of its points off the surface that are inside the solid.
    pub(super) inside: f64,
    /// Share that are outside.
    pub(super) outside: f64,
    /// Whether other parts have points inside it.
    pub(super) pierced: f64,
}

/// Compares a part at a depth with the parts placed.
pub(super) fn fit(shapes: &Shapes, part: usize, shift: f64, placed: &[Option<Place>]) -> Fit {
    let mut fit = Fit::default();
    let samples = &shapes.parts[part].samples;
    let own = &shapes.parts[part];
    let step = samples.len().div_ceil(MOST).max(1);
    let samples = samples.iter().step_by(step);
    let count = samples.len().max(1) as f64;
    for s in samples {
        match in_solid(shapes, *s + DVec3::Z * shift, placed, part) {
            Some(true) => fit.inside += 1.0 / count,
            Some(false) => fit.outside += 1.0 / count,
            None => {}
        }
    }
    let slack = DVec2::splat(shapes.slack(shapes.error));
    let (low, high) = (own.low + slack, own.high - slack);
    let (mut seen, mut within) = (0usize, 0usize);
    'all: for (other, place) in placed.iter().enumerate() {
        let Some(place) = place else { continue };
        let near =
            shapes.parts[other].low.cmplt(high).all() && shapes.parts[other].high.cmpgt(low).all();
        if other == part || !near {
            continue;
        }
        for s in &shapes.parts[other].samples {
            if s.truncate().cmplt(low).any() || s.truncate().cmpgt(high).any() {
                continue;
            }
            seen += 1;
            let p = *s + DVec3::Z * (place.shift - shift);
            within += usize::from(in_part(shapes, part, p) == Some(true));
            if seen == 4 * MOST {
                break 'all;
            }
        }
    }
    fit.pierced = (within as f64 / count).min(1.0);
    fit
}

/// Most points of a part that are looked at.
const MOST: usize = 48;

/// Whether a point is inside the parts placed, but for one; `None` on a surface.
fn in_solid(shapes: &Shapes, p: DVec3, placed: &[Option<Place>], but: usize) -> Option<bool> {
    let mut inside = false;
    for (part, place) in placed.iter().enumerate() {
        if let Some(place) = place
            && part != but
        {
            inside ^= in_part(shapes, part, p - DVec3::Z * place.shift)?;
        }
    }
    Some(inside)
}

/// Whether a point, with depth in the part, is inside its loops; `None` on one of them.
fn in_part(shapes: &Shapes, part: usize, p: DVec3) -> Option<bool> {
    let whole = &shapes.parts[part];
    let at = p.truncate();
    if at.cmplt(whole.low).any() || at.cmpgt(whole.high).any() {
        return Some(false);
    }
    let mut inside = false;
    for &i in &whole.loops {
        let outline = &shapes.loops[i];
        if outline.contains(at) {
            let above = outline.depth(at) - p.z;
            if above.abs() < shapes.slack(outline.depth_error(shapes.error)) {
                return None;
            }
            inside ^= above > 0.0;
        }
    }
    Some(inside)
}
