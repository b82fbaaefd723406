//! Curves that the points of a section sweep along a helix: the edges of spring washers, of threads
//! and of springs.
//!
//! Edges that belong to one sweep share its spine ([`model`]), so that together they show its axis and
//! the depth of all their points, as circles show theirs: they are fitted to what is drawn with the
//! precision of the drawing, and a fit that is as good as that is no chance.

mod fit;
mod grow;
mod model;
mod start;
#[cfg(test)]
mod tests;

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::Camera;
use super::directions::{Axis, Directions};
use crate::drawing::{Drawing, Projection};
use fit::Fitted;
use start::Seed;

/// Points are this near to their tracks, in sizes of the drawing.
const NEAR: f64 = 3e-5;

/// A start that is farther from all this after fitting leads nowhere.
const LOST: f64 = 0.05;

/// Edges that are left out of a start so that the others agree.
const LEFT_OUT: usize = 3;

/// Below this rise, in sizes, tracks are circles.
const FLAT: f64 = 1e-3;

/// Length of track that shows a sweep, radians: of all its edges together.
const LONG: f64 = PI;

/// Points of half a turn of a curve in space, at least.
const STEPS: f64 = 16.0;

/// Angle within which an axis is that of a reading, radians.
const SAME_AXIS: f64 = 1e-3;

/// Depths are off by so many times what drawn points are off their tracks.
const DEPTH: f64 = 5.0;

/// Standard error of a coordinate, in sizes: rounded to 1e-6.
const PRECISION: f64 = 6e-7;

/// A sweep in space, camera frame. In a parallel projection its place in depth is free, in a central
/// one its scale.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sweep {
    /// A point of the axis and its unit direction.
    pub(crate) origin: DVec3,
    pub(crate) axis: DVec3,
    /// Edges on it.
    pub(crate) edges: Vec<Swept>,
    /// Largest distance of a drawn point from its curve, drawing units.
    pub(crate) miss: f64,
}

/// An edge on a sweep.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Swept {
    pub(crate) edge: usize,
    /// Points of its curve, from its first vertex to its last.
    pub(crate) points: Vec<DVec3>,
    /// Unit tangents at both ends, along the curve.
    pub(crate) tangents: [DVec3; 2],
}

impl Sweep {
    /// Its mirror image in depth.
    #[must_use]
    pub(crate) fn reversed(mut self) -> Self {
        let mirror = |p: &mut DVec3| p.z = -p.z;
        mirror(&mut self.origin);
        mirror(&mut self.axis);
        for edge in &mut self.edges {
            edge.points.iter_mut().for_each(mirror);
            edge.tangents.iter_mut().for_each(mirror);
        }
        self
    }

    /// Vertices at ends of its edges with a depth, each edge's first one first.
    pub(crate) fn ends<'a>(
        &'a self,
        drawing: &'a Drawing,
    ) -> impl Iterator<Item = (usize, usize, f64)> + 'a {
        self.edges.iter().flat_map(|swept| {
            let v = drawing.edges[swept.edge].v;
            let ends = [swept.points.first(), swept.points.last()];
            let depths = v.into_iter().zip(ends);
            depths.filter_map(move |(v, p)| p.map(|p| (swept.edge, v, p.z)))
        })
    }

    /// Standard error of a depth, drawing units.
    pub(crate) fn error(&self) -> f64 {
        DEPTH * self.miss
    }
}

/// All sweeps of a drawing whose camera is known.
pub(super) fn sweeps(drawing: &Drawing) -> Vec<Sweep> {
    let size = drawing.size();
    let Some(camera) = camera(drawing, size) else {
        return Vec::new();
    };
    let mut seeds = start::seeds(drawing);
    let mut found = Vec::new();
    while !seeds.is_empty() {
        let starts = start::starts(drawing, &seeds, camera);
        let Some(fitted) = starts.into_iter().find_map(|s| fitted(drawing, s)) else {
            break;
        };
        let count = seeds.len();
        seeds.retain(|s: &Seed| !fitted.members.iter().any(|m| m.edge == s.edge));
        if seeds.len() == count {
            break;
        }
        found.push(sweep(&fitted, size));
    }
    found
}

/// The camera of a drawing in units of `unit`; `None` if its focal length is not given.
fn camera(drawing: &Drawing, unit: f64) -> Option<Camera> {
    match drawing.projection {
        Projection::Orthographic => Some(Camera::Parallel),
        Projection::Perspective { focal } => focal.map(|focal| Camera::Central {
            principal: DVec2::ZERO,
            focal: focal / unit,
        }),
    }
}

/// A sweep from where its fit starts, with all edges that are on it.
fn fitted(drawing: &Drawing, mut start: Fitted) -> Option<Fitted> {
    for _ in 0..=LEFT_OUT {
        start.fit();
        let (worst, miss) = worst(&start)?;
        if miss < NEAR {
            break;
        }
        if miss > LOST || start.members.len() < 2 {
            return None;
        }
        start.members.swap_remove(worst);
    }
    let mut others = Vec::new();
    while grow::grow(drawing, &mut start, &others) {
        start.fit();
        while let Some((worst, miss)) = worst(&start)
            && miss > NEAR
        {
            others.push(start.members.swap_remove(worst).edge);
            start.fit();
        }
    }
    let (_, miss) = worst(&start)?;
    let spans = || start.members.iter().map(|m| m.at[m.at.len() - 1] - m.at[0]);
    let longest = spans().map(f64::abs).fold(0.0, f64::max);
    let rise = start.spine().rise.abs() * longest;
    let shown = spans().map(f64::abs).sum::<f64>();
    (miss < NEAR && shown > LONG && rise > FLAT).then_some(start)
}

/// The member farthest from its track.
fn worst(fitted: &Fitted) -> Option<(usize, f64)> {
    let all = fitted.members.iter().map(|m| fitted.miss(m)).enumerate();
    all.max_by(|a, b| a.1.total_cmp(&b.1))
}

fn sweep(fitted: &Fitted, size: f64) -> Sweep {
    let spine = fitted.spine();
    let edges = fitted.members.iter().map(|m| {
        let own = fitted.own(m.track);
        let (first, last) = (m.at[0], m.at[m.at.len() - 1]);
        let steps = ((last - first).abs() * STEPS / PI).ceil().max(8.0);
        let at = |i: f64| first + (last - first) * i / steps;
        let points = (0..=steps as usize).map(|i| spine.point(own, at(i as f64)) * size);
        Swept {
            edge: m.edge,
            points: points.collect(),
            tangents: [first, last].map(|t| spine.tangent(own, t) * (last - first).signum()),
        }
    });
    let (axis, origin) = (spine.axis, spine.origin);
    Sweep {
        origin: origin * size,
        axis: if axis.z < 0.0 { -axis } else { axis },
        edges: edges.collect(),
        miss: worst(fitted).map_or(0.0, |w| w.1).max(PRECISION) * size,
    }
}

/// Readings of a drawing with its sweeps: one of each sweep's own axis, then the others, each with
/// the sweeps around one of its axes.
pub(super) fn readings(
    drawing: &Drawing,
    sweeps: &[Sweep],
    others: Vec<Directions>,
) -> Vec<Directions> {
    let own = sweeps.iter().map(|sweep| own_reading(drawing, sweep));
    let mut all: Vec<Directions> = own.collect();
    all.extend(others);
    for reading in &mut all {
        reading.swept = sweeps.iter().filter_map(|s| around(s, reading)).collect();
    }
    all
}

/// The reading of a sweep's axis alone.
fn own_reading(drawing: &Drawing, sweep: &Sweep) -> Directions {
    let camera = camera(drawing, 1.0).unwrap_or_default();
    let axis = Axis {
        direction: sweep.axis,
        edges: Vec::new(),
        circles: Vec::new(),
    };
    let reading = Directions {
        axes: vec![axis],
        slanted: Vec::new(),
        swept: Vec::new(),
        camera,
        error: sweep.error() / drawing.size(),
        precision: sweep.miss,
    };
    if camera.is_parallel() {
        reading.seen_from_above()
    } else {
        reading
    }
}

/// A sweep as a reading sees it: around one of its axes, as it is or mirrored in depth.
fn around(sweep: &Sweep, reading: &Directions) -> Option<Sweep> {
    let limit = SAME_AXIS + 3.0 * reading.error;
    let along = |s: &Sweep| {
        let axes = reading.axes.iter();
        let off = axes.map(|a| a.direction.cross(s.axis).length());
        off.fold(f64::INFINITY, f64::min) < limit
    };
    if along(sweep) {
        return Some(sweep.clone());
    }
    let mirrored = sweep.clone().reversed();
    (reading.camera.is_parallel() && along(&mirrored)).then_some(mirrored)
}
