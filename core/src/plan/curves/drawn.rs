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
        let tangents = tangents(points);
        let mut out = Vec::with_capacity(parts * points.len());
        for (pair, slopes) in points.windows(2).zip(tangents.windows(2)) {
            let step = |i: usize| between(pair, slopes, i as f64 / parts as f64);
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

/// Tangents of the smooth curve through points, by its length along the chords: of the parabola
/// through each point and its neighbours. A polyline of two points is straight.
fn tangents(points: &[DVec2]) -> Vec<DVec2> {
    let last = points.len() - 1;
    let slope = |i: usize| (points[i + 1] - points[i]) / points[i].distance(points[i + 1]);
    (0..=last)
        .map(|i| {
            if last < 2 {
                return slope(0);
            }
            let middle = i.clamp(1, last - 1);
            let (s, t) = (slope(middle - 1), slope(middle));
            let before = points[middle - 1].distance(points[middle]);
            let after = points[middle].distance(points[middle + 1]);
            let bend = (t - s) / (before + after);
            if i < middle {
                s - bend * before
            } else if i > middle {
                t + bend * after
            } else {
                s + bend * before
            }
        })
        .collect()
}

/// A point of the cubic between two points with their tangents (Hermite), at a share of it.
fn between(ends: &[DVec2], tangents: &[DVec2], t: f64) -> DVec2 {
    let length = ends[0].distance(ends[1]);
    let s = 1.0 - t;
    let curve = ends[0] * (s * s * (1.0 + 2.0 * t))
        + ends[1] * (t * t * (1.0 + 2.0 * s))
        + (tangents[0] * s - tangents[1] * t) * (length * s * t);
    // Points that fall together have no tangents.
    if curve.is_finite() {
        curve
    } else {
        ends[0].lerp(ends[1], t)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_curve_through_points_is_near_what_they_were_taken_from() {
        let at = |t: f64| DVec2::from_angle(t);
        let points: Vec<DVec2> = [0.0, 0.2, 0.3, 0.5, 0.6].map(at).to_vec();
        let slopes = tangents(&points);
        for (pair, slopes) in points.windows(2).zip(slopes.windows(2)) {
            let middle = between(pair, slopes, 0.5);
            assert!((middle.length() - 1.0).abs() < 2e-4, "{middle}");
            assert!(middle.distance(pair[0].midpoint(pair[1])) > 1e-3);
        }
        let line = [DVec2::ZERO, DVec2::X];
        assert_eq!(between(&line, &tangents(&line), 0.25), DVec2::X * 0.25);
        let twice = [DVec2::ZERO, DVec2::ZERO, DVec2::X];
        assert_eq!(
            between(&twice[..2], &tangents(&twice)[..2], 0.5),
            DVec2::ZERO
        );
    }
}
