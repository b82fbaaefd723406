//! What curve a polyline is.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use super::curve::{Curve2, EllipseArc};
use super::ellipse;

/// Largest distance of a point from its curve, relative to the polyline's own spread.
const TOLERANCE: f64 = 1e-4;

/// Longest step between points on an ellipse, radians. A circle drawn with nine points has steps of
/// 45 degrees; a hexagon's corners lie on a circle too, and stay a polyline.
const LONGEST_STEP: f64 = 50.0 * PI / 180.0;

impl Curve2 {
    /// Recognises a polyline whose points are exact to within 1e-4 of its own size.
    pub fn recognise(points: &[DVec2]) -> Self {
        Self::recognise_within(points, 0.0)
    }

    /// Recognises the polyline of an edge.
    ///
    /// - Two points, or points that run along one segment, are a line.
    /// - Points that run along one ellipse are an arc of it, or the whole ellipse if the first
    ///   point is the last. At least six points are needed, and steps below 50 degrees.
    /// - Everything else is a polyline; so is a circle seen from its edge, which runs to and fro on
    ///   a segment.
    ///
    /// `noise` is the distance within which points are exact, in drawing units; 1e-4 of the
    /// polyline's own spread is always allowed.
    pub fn recognise_within(points: &[DVec2], noise: f64) -> Self {
        let [first, .., last] = points else {
            return Self::Polyline;
        };
        if points.len() == 2 {
            return Self::Line;
        }
        let size = spread(points.iter().copied());
        let tolerance = noise.max(TOLERANCE * size);
        if is_segment(points, *first, *last, tolerance) {
            return Self::Line;
        }
        let closed = first.distance(*last) <= noise.max(1e-9 * size);
        match arc(points, closed, tolerance) {
            Some(arc) => Self::Ellipse(arc),
            None => Self::Polyline,
        }
    }

    /// The arc of the ellipse nearest to points that run along it, however far they are from it; `None`
    /// if they turn back or go around more than once.
    pub(crate) fn nearest_ellipse(points: &[DVec2]) -> Option<EllipseArc> {
        arc(points, false, f64::INFINITY)
    }
}

/// Largest distance of a point from the mean of all. Unlike a bounding box, it does not change when
/// the points are turned; 0 without points.
pub(super) fn spread(points: impl Iterator<Item = DVec2> + Clone) -> f64 {
    let count = points.clone().count().max(1);
    // Each share is added by itself, so that huge coordinates do not overflow.
    let mean: DVec2 = points.clone().map(|p| p / count as f64).sum();
    points.map(|p| p.distance(mean)).fold(0.0, f64::max)
}

/// Whether the points lie on the segment and run along it without turning back.
fn is_segment(points: &[DVec2], first: DVec2, last: DVec2, tolerance: f64) -> bool {
    let Some(along) = (last - first).try_normalize() else {
        return false;
    };
    let mut reached = 0.0;
    for q in points.iter().map(|p| *p - first) {
        let x = along.dot(q);
        if along.perp_dot(q).abs() > tolerance || x < reached - tolerance {
            return false;
        }
        reached = x.max(reached);
    }
    reached <= first.distance(last) + tolerance
}

/// The arc of an ellipse that the points run along.
fn arc(points: &[DVec2], closed: bool, tolerance: f64) -> Option<EllipseArc> {
    let fit = ellipse::fit(points)?;
    if fit.residual.is_nan() || fit.residual > tolerance {
        return None;
    }
    let ellipse = EllipseArc {
        center: fit.center,
        major: fit.major,
        ratio: fit.ratio,
        start: 0.0,
        sweep: 0.0,
        residual: fit.residual,
        uncertainty: fit.uncertainty,
    };
    ellipse.along(points, closed, tolerance)
}

impl EllipseArc {
    /// The arc of the same ellipse that the points run along from the first to the last, without
    /// turning back by more than `tolerance` or stepping too far.
    pub(super) fn along(mut self, points: &[DVec2], closed: bool, tolerance: f64) -> Option<Self> {
        self.start = self.parameter(*points.first()?);
        self.sweep = 0.0;
        // How far a parameter may run back for points that are off by the tolerance.
        let slack = tolerance / (self.major.length() * self.ratio);
        let (mut t, mut low, mut high) = (self.start, 0f64, 0f64);
        for p in &points[1..] {
            let next = self.parameter(*p);
            let step = (next - t + PI).rem_euclid(TAU) - PI;
            if step.abs() > LONGEST_STEP {
                return None;
            }
            t = next;
            self.sweep += step;
            low = low.min(self.sweep);
            high = high.max(self.sweep);
            if (low < -slack || self.sweep < high - slack)
                && (high > slack || self.sweep > low + slack)
            {
                return None;
            }
        }
        if closed {
            if (self.sweep.abs() / TAU - 1.0).abs() > 0.01 {
                return None;
            }
            self.sweep = TAU.copysign(self.sweep);
        }
        (self.sweep.abs() <= TAU && self.sweep != 0.0).then_some(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sample(arc: &EllipseArc, n: usize) -> Vec<DVec2> {
        (0..n)
            .map(|i| arc.point(arc.start + arc.sweep * i as f64 / (n - 1) as f64))
            .collect()
    }

    /// Rounds as files do.
    fn rounded(points: &[DVec2]) -> Vec<DVec2> {
        points.iter().map(|p| (p * 1e6).round() / 1e6).collect()
    }

    fn as_arc(curve: Curve2) -> EllipseArc {
        match curve {
            Curve2::Ellipse(arc) => arc,
            other => panic!("{other:?}"),
        }
    }

    prop_compose! {
        fn any_arc()(
            center in prop::array::uniform2(-1.0..1.0f64),
            angle in -4.0..4.0f64,
            major in 0.05..0.8f64,
            ratio in 0.03..1.0f64,
            start in -3.1..3.1f64,
            sweep in 0.3..6.2f64,
            clockwise: bool,
        ) -> EllipseArc {
            EllipseArc {
                center: center.into(),
                major: DVec2::from_angle(angle) * major,
                ratio,
                start,
                sweep: if clockwise { -sweep } else { sweep },
                residual: 0.0,
                uncertainty: 0.0,
            }
        }
    }

    proptest! {
        #[test]
        fn exact_arcs_come_back(arc in any_arc(), n in 9usize..60) {
            let points = sample(&arc, n);
            let found = as_arc(Curve2::recognise(&points));
            prop_assert!((found.sweep - arc.sweep).abs() < 1e-4, "{found:?}");
            prop_assert!((found.major.length() / arc.major.length() - 1.0).abs() < 1e-5, "{found:?}");
            prop_assert!((found.ratio - arc.ratio).abs() < 1e-5, "{found:?}");
            prop_assert!(found.center.distance(arc.center) < 1e-5);
            prop_assert!(found.residual < 1e-9);
            prop_assert!(found.point(found.start).distance(points[0]) < 1e-9);
            prop_assert!(found.point(found.start + found.sweep).distance(points[n - 1]) < 1e-9);
        }

        #[test]
        fn rounded_arcs_come_back_within_their_uncertainty(mut arc in any_arc(), n in 9usize..40) {
            arc.sweep = arc.sweep.abs().max(1.0).copysign(arc.sweep);
            let points = rounded(&sample(&arc, n));
            let found = as_arc(Curve2::recognise_within(&points, 2e-6));
            let off = (found.major.length() / arc.major.length() - 1.0)
                .abs()
                .max((found.ratio - arc.ratio).abs());
            prop_assert!(off < 10.0 * found.uncertainty + 1e-5, "{off} {found:?}");
            prop_assert!(found.residual < 2e-6);
        }

        #[test]
        fn whole_ellipses_close(mut arc in any_arc(), n in 9usize..80) {
            arc.sweep = TAU.copysign(arc.sweep);
            let mut points = rounded(&sample(&arc, n));
            points[n - 1] = points[0];
            let found = as_arc(Curve2::recognise_within(&points, 2e-6));
            prop_assert_eq!(found.sweep, arc.sweep);
            prop_assert!((found.ratio - arc.ratio).abs() < 1e-3);
        }

        #[test]
        fn recognition_moves_turns_and_scales_with_the_points(
            arc in any_arc(), turn in -3.0..3.0f64, log_scale in -20.0..20.0f64, far in -1e3..1e3f64
        ) {
            let scale = log_scale.exp();
            let moved = |p: DVec2| (DVec2::from_angle(turn).rotate(p) + far) * scale;
            let points = sample(&arc, 20);
            let found = as_arc(Curve2::recognise(&points.iter().map(|p| moved(*p)).collect::<Vec<_>>()));
            prop_assert!((found.sweep - arc.sweep).abs() < 1e-2);
            prop_assert!((found.major.length() / arc.major.length() / scale - 1.0).abs() < 1e-2);
            prop_assert!((found.ratio - arc.ratio).abs() < 1e-2);
        }

        #[test]
        fn any_points_give_a_finite_answer(
            points in prop::collection::vec(prop::array::uniform2(-1e3..1e3f64), 0..12),
            repeat in 1usize..4,
        ) {
            let points: Vec<DVec2> = points.iter().flat_map(|p| vec![DVec2::from(*p); repeat]).collect();
            if let Curve2::Ellipse(arc) = Curve2::recognise(&points) {
                prop_assert!(arc.center.is_finite() && arc.major.is_finite());
                prop_assert!(arc.ratio > 0.0 && arc.ratio <= 1.0 && arc.uncertainty <= 1.0);
            }
        }
    }

    #[test]
    fn points_along_a_segment_are_a_line() {
        let points: Vec<DVec2> = (0..10)
            .map(|i| DVec2::new(0.3, 0.1) * f64::from(i))
            .collect();
        assert_eq!(Curve2::recognise(&points), Curve2::Line);
        assert_eq!(Curve2::recognise(&points[..2]), Curve2::Line);
        // Half a circle from its edge cannot be told from a line.
        let half: Vec<DVec2> = (0..=16)
            .map(|i| DVec2::new((f64::from(i) * PI / 16.0).cos(), 0.5))
            .collect();
        assert_eq!(Curve2::recognise(&half), Curve2::Line);
    }

    #[test]
    fn a_circle_from_its_edge_is_no_line_and_no_ellipse() {
        for turn in [TAU, 4.0] {
            let points: Vec<DVec2> = (0..=32)
                .map(|i| DVec2::from_angle(0.7) * (f64::from(i) * turn / 32.0).cos())
                .collect();
            assert_eq!(Curve2::recognise(&points), Curve2::Polyline);
        }
    }

    #[test]
    fn polygons_and_other_curves_stay_polylines() {
        let hexagon: Vec<DVec2> = (0..=6)
            .map(|i| DVec2::from_angle(f64::from(i) * PI / 3.0))
            .collect();
        let corner: Vec<DVec2> = (-10..=10)
            .map(|i| DVec2::new(f64::from(i), f64::from(i).abs()))
            .collect();
        let wave: Vec<DVec2> = (0..=40)
            .map(|i| DVec2::new(f64::from(i) * 0.1, (f64::from(i) * 0.1).sin()))
            .collect();
        let twice: Vec<DVec2> = (0..=40)
            .map(|i| DVec2::from_angle(f64::from(i) * 0.3))
            .collect();
        let back: Vec<DVec2> = (-20..=20)
            .map(|i: i32| DVec2::from_angle(f64::from(i.abs()) * 0.1))
            .collect();
        for points in [hexagon, corner, wave, twice, back] {
            assert_eq!(Curve2::recognise(&points), Curve2::Polyline);
        }
    }

    #[test]
    fn a_shallow_arc_is_still_an_arc() {
        for sweep in [0.03, 0.1, 0.3] {
            let arc = EllipseArc {
                center: DVec2::new(0.1, -0.3),
                major: DVec2::new(0.5, 0.2),
                ratio: 0.6,
                start: 0.4,
                sweep,
                residual: 0.0,
                uncertainty: 0.0,
            };
            let points = rounded(&sample(&arc, 9));
            let found = as_arc(Curve2::recognise_within(&points, 2e-6));
            assert!(found.uncertainty > 1e-3, "{found:?}");
            assert!(found.point(found.start).distance(points[0]) < 2e-6);
        }
    }

    /// Circles of the solid must be recognised, and their radius and tilt right within what the
    /// fit says of itself.
    #[test]
    fn corpus_circles_are_recognised() {
        let path = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../tests/corpus/sample.jsonl.zst"
        );
        let (mut circles, mut recognised, mut sure, mut right) = (0, 0, 0, 0);
        for drawing in super::super::dataset::Drawings::open(path).unwrap() {
            let drawing = drawing.unwrap();
            let truth = drawing.truth.as_ref().unwrap();
            for (e, points) in drawing.edges.iter().zip(&truth.edges3d) {
                let Some((radius, tilt)) = circle(points) else {
                    continue;
                };
                circles += 1;
                if let Curve2::Ellipse(arc) = e.curve {
                    recognised += 1;
                    if arc.uncertainty < 1e-3 {
                        sure += 1;
                        let off = (arc.major.length() / radius - 1.0)
                            .abs()
                            .max((arc.ratio - tilt).abs());
                        right += usize::from(off < 5.0 * arc.uncertainty.max(2e-5));
                    }
                }
            }
        }
        println!("{circles} circles: {recognised} recognised, {sure} sure, {right} right");
        assert!(circles > 1000);
        assert!(recognised * 1000 >= circles * 995);
        assert!(sure * 100 >= circles * 75);
        assert!(right * 100 >= sure * 98);
    }

    /// Radius and |n_z| of the circle that points in space lie on.
    fn circle(points: &[glam::DVec3]) -> Option<(f64, f64)> {
        let n = points.len();
        if n < 3 {
            return None;
        }
        // With a closed curve the first and last point are one: take thirds.
        let [a, b, c] = [points[0], points[n / 3], points[2 * n / 3]];
        let normal = (b - a).cross(c - a);
        let (u, v) = (b - a, c - a);
        let center = a
            + (u.length_squared() * v.cross(normal) + v.length_squared() * normal.cross(u))
                / (2.0 * normal.length_squared());
        let normal = normal.try_normalize()?;
        let radius = center.distance(a);
        let on = |p: &glam::DVec3| {
            (p.distance(center) - radius).abs() < 1e-5 && (*p - center).dot(normal).abs() < 1e-5
        };
        points.iter().all(on).then_some((radius, normal.z.abs()))
    }
}
