//! Whether a part is inside or outside of what is placed.
//!
//! A part whose loops are each closed by a surface of their own is a closed body. A pocket's
//! opening and the same outline in the face it opens in cancel out, so a point is inside the solid
//! if it is inside an odd number of its parts.

use std::cell::OnceCell;

use glam::{DVec2, DVec3};

use super::shapes::{Outline, Shapes};

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

/// Most points of a part that are looked at.
const MOST: usize = 48;

/// Levels of the loops of a part that are drawn around a point, each with the error of it that is
/// allowed.
type Levels = Vec<(f64, f64)>;

/// A point of a part.
#[derive(Debug)]
struct Point {
    /// Depth in its part.
    depth: f64,
    /// Other parts that are drawn around it.
    around: Vec<(usize, Levels)>,
}

/// A part drawn beside another.
#[derive(Debug)]
struct Neighbour {
    part: usize,
    /// Depths of its points within the other's box, and the levels of the other there.
    points: OnceCell<Vec<(f64, Levels)>>,
}

/// What is drawn around the points of a part, wherever parts stand.
#[derive(Debug)]
struct Surroundings {
    points: Vec<Point>,
    beside: Vec<Neighbour>,
}

/// Points of all parts, looked at when they are asked for.
pub(super) struct Bodies(Vec<OnceCell<Surroundings>>);

impl Bodies {
    pub(super) fn new(shapes: &Shapes) -> Self {
        Self(shapes.parts.iter().map(|_| OnceCell::new()).collect())
    }

    /// Compares a part at a depth with the parts placed.
    pub(super) fn fit(
        &self,
        shapes: &Shapes,
        part: usize,
        shift: f64,
        placed: &[Option<Place>],
    ) -> Fit {
        let own = self.0[part].get_or_init(|| surroundings(shapes, part));
        let mut fit = Fit::default();
        let count = own.points.len().max(1) as f64;
        for point in &own.points {
            match in_solid(point, point.depth + shift, placed) {
                Some(true) => fit.inside += 1.0 / count,
                Some(false) => fit.outside += 1.0 / count,
                None => {}
            }
        }
        let (mut seen, mut within) = (0usize, 0usize);
        'all: for other in &own.beside {
            let Some(place) = placed[other.part] else {
                continue;
            };
            let points = || beside(shapes, part, other.part);
            for (depth, levels) in other.points.get_or_init(points) {
                seen += 1;
                let depth = depth + (place.shift - shift);
                within += usize::from(is_between(levels, depth) == Some(true));
                if seen == 4 * MOST {
                    break 'all;
                }
            }
        }
        fit.pierced = (within as f64 / count).min(1.0);
        fit
    }
}

fn surroundings(shapes: &Shapes, part: usize) -> Surroundings {
    let samples = &shapes.parts[part].samples;
    let step = samples.len().div_ceil(MOST).max(1);
    let others = || (0..shapes.parts.len()).filter(|&p| p != part);
    let point = |s: &DVec3| {
        let around = others().map(|p| (p, levels(shapes, p, s.truncate())));
        Point {
            depth: s.z,
            around: around.filter(|(_, levels)| !levels.is_empty()).collect(),
        }
    };
    let (low, high) = inner_box(shapes, part);
    let is_beside = |p: &usize| {
        let other = &shapes.parts[*p];
        other.low.cmplt(high).all() && other.high.cmpgt(low).all()
    };
    Surroundings {
        points: samples.iter().step_by(step).map(point).collect(),
        beside: others()
            .filter(is_beside)
            .map(|part| Neighbour {
                part,
                points: OnceCell::new(),
            })
            .collect(),
    }
}

/// Points of another part within the box of a part.
fn beside(shapes: &Shapes, part: usize, other: usize) -> Vec<(f64, Levels)> {
    let (low, high) = inner_box(shapes, part);
    let samples = shapes.parts[other].samples.iter();
    samples
        .filter(|s| !(s.truncate().cmplt(low).any() || s.truncate().cmpgt(high).any()))
        .take(4 * MOST)
        .map(|s| (s.z, levels(shapes, part, s.truncate())))
        .collect()
}

/// The box that a part is drawn in, but for errors.
fn inner_box(shapes: &Shapes, part: usize) -> (DVec2, DVec2) {
    let slack = DVec2::splat(shapes.slack(shapes.error));
    let part = &shapes.parts[part];
    (part.low + slack, part.high - slack)
}

/// Levels of the loops of a part that are drawn around a place.
fn levels(shapes: &Shapes, part: usize, at: DVec2) -> Levels {
    let whole = &shapes.parts[part];
    if at.cmplt(whole.low).any() || at.cmpgt(whole.high).any() {
        return Vec::new();
    }
    let outlines = whole.loops.iter().map(|&i| &shapes.loops[i]);
    let level = |o: &Outline| {
        let slack = shapes.slack(o.depth_error(shapes.error));
        (o.depth(at), slack)
    };
    outlines.filter(|o| o.contains(at)).map(level).collect()
}

/// Whether a point at a depth is inside the parts placed; `None` on a surface.
fn in_solid(point: &Point, depth: f64, placed: &[Option<Place>]) -> Option<bool> {
    let mut inside = false;
    for (part, levels) in &point.around {
        if let Some(place) = placed[*part] {
            inside ^= is_between(levels, depth - place.shift)?;
        }
    }
    Some(inside)
}

/// Whether an odd number of levels is above a depth; `None` if it is at one of them.
fn is_between(levels: &Levels, depth: f64) -> Option<bool> {
    let mut inside = false;
    for (level, slack) in levels {
        let above = level - depth;
        if above.abs() < *slack {
            return None;
        }
        inside ^= above > 0.0;
    }
    Some(inside)
}
