//! A drawn curve: points along it, and how well a curve in space agrees with it.

use glam::{DVec2, DVec3};

use crate::drawing::{Curve2, Edge};

use crate::plan::conic::Conic;
use crate::plan::sample;
use crate::plan::support::Support;
use crate::plan::view::View;

/// Steps in which a curve in space is compared with the drawing.
const STEPS: usize = 64;

/// An edge as drawn, under a view.
pub(super) struct Drawn<'a> {
    edge: &'a Edge,
    view: &'a View,
}

impl<'a> Drawn<'a> {
    pub(super) fn new(edge: &'a Edge, view: &'a View) -> Self {
        Self { edge, view }
    }

    /// Points along the drawn curve, both ends included, at least `steps` + 1 of them.
    pub(super) fn points(&self, steps: usize) -> Vec<DVec2> {
        if let Curve2::Ellipse(arc) = &self.edge.curve {
            let t = |i: usize| arc.start + arc.sweep * i as f64 / steps as f64;
            return (0..=steps).map(|i| arc.point(t(i))).collect();
        }
        let points = &self.edge.points;
        let parts = steps.div_ceil(points.len().saturating_sub(1).max(1)).max(1);
        let mut out = Vec::with_capacity(parts * points.len());
        for pair in points.windows(2) {
            let step = |i: usize| pair[0].lerp(pair[1], i as f64 / parts as f64);
            out.extend((0..parts).map(step));
        }
        out.extend(points.last());
        out
    }

    /// Picks the way round that is drawn: the conic, or its reverse, and the largest distance
    /// between the arc and the drawing.
    pub(super) fn sense(
        &self,
        conic: Conic,
        start: DVec3,
        end: DVec3,
        whole: bool,
    ) -> (Conic, f64) {
        let drawn = self.points(STEPS);
        let judged = [conic, conic.reversed()].map(|c| {
            let points = sample::arc(&c, start, end, whole, STEPS);
            // The two arcs part; which of them is near in the same order is clear at once.
            let last = (drawn.len() - 1) as f64;
            let far: f64 = (0..=STEPS)
                .map(|i| {
                    let at = (last * i as f64 / STEPS as f64).round() as usize;
                    self.view.project(points[i]).distance_squared(drawn[at])
                })
                .sum();
            (c, far, points)
        });
        let [a, b] = judged;
        let (conic, _, points) = if b.1 < a.1 { b } else { a };
        let gap = self.gap(&points);
        (conic, gap)
    }

    /// Largest distance of a drawn point from the image of a polyline in space.
    pub(super) fn gap(&self, points: &[DVec3]) -> f64 {
        let image: Vec<DVec2> = points.iter().map(|p| self.view.project(*p)).collect();
        let distance = |p: DVec2| {
            let segments = image.windows(2).map(|s| segment_distance(p, s[0], s[1]));
            segments.fold(f64::INFINITY, f64::min)
        };
        self.edge
            .points
            .iter()
            .map(|p| distance(*p))
            .fold(0.0, f64::max)
    }
}

fn segment_distance(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let d = b - a;
    let t = ((p - a).dot(d) / d.length_squared()).clamp(0.0, 1.0);
    // A segment without length gives a NaN share.
    let t = if t.is_nan() { 0.0 } else { t };
    p.distance(a + d * t)
}

/// The point of a surface that is drawn at `p`; of two, the one nearer to `near`.
pub(super) fn onto(view: &View, surface: &Support, p: DVec2, near: Option<DVec3>) -> Option<DVec3> {
    let (from, direction) = view.ray(p);
    let points = surface
        .crossings(from, direction)
        .into_iter()
        .map(|t| from + direction * t);
    points.min_by(|a, b| {
        let far = |q: &DVec3| near.map_or(0.0, |n| q.distance_squared(n));
        far(a).total_cmp(&far(b))
    })
}
