//! Curves of edges in space, from how they are drawn and the surfaces beside them.

mod drawn;
mod exact;
mod free;
mod trace;

use glam::DVec3;

use crate::drawing::{Curve2, Edge};
use crate::lift::LiftedCurve;

use super::conic::{Conic, fit_plane};
use super::lengths::Lengths;
use super::support::Support;
use super::view::View;
use super::{Curve3, PlanError};

use drawn::Drawn;
use trace::Lain;

/// Surfaces that meet at a smaller angle (its sine) do not tell the tangent of their curve.
const SLANT: f64 = 0.02;

/// Uncertainty from which on the axes of a drawn ellipse are not known.
const UNKNOWN: f64 = 0.1;

/// What is known of an edge when its curve is sought.
pub(super) struct Place<'a> {
    /// Edge, from 0.
    pub(super) edge: usize,
    pub(super) drawn: &'a Edge,
    /// Its vertices in space.
    pub(super) ends: [DVec3; 2],
    /// Its curve in space, if lifting knows it.
    pub(super) lifted: Option<&'a LiftedCurve>,
    /// Faces beside it, from 0.
    pub(super) faces: [usize; 2],
    /// Their surfaces.
    pub(super) supports: [Support; 2],
    /// From which side they are seen, if known.
    pub(super) sides: [Option<f64>; 2],
    /// Whether both faces have the same surface.
    pub(super) same: bool,
    /// Whether it is an outline of that surface.
    pub(super) silhouette: bool,
}

impl Place<'_> {
    /// The curve that lifting knows, from vertex to vertex, if it is on both surfaces.
    fn known(&self, limit: f64) -> Option<Curve3> {
        let lifted = self.lifted?;
        let mut points = lifted.points.clone();
        let [.., last] = points[..] else {
            return None;
        };
        let off = [self.ends[0] - points[0], self.ends[1] - last];
        let steps = (points.len() - 1) as f64;
        for (i, p) in points.iter_mut().enumerate() {
            *p += off[0].lerp(off[1], i as f64 / steps);
        }
        let on = |p: &DVec3| self.supports.iter().all(|s| s.distance(*p).abs() <= limit);
        points.iter().all(on).then_some(Curve3::Points {
            points,
            tangents: Some(lifted.tangents),
        })
    }

    fn lain(&self, i: usize, side: Option<f64>) -> Lain {
        Lain {
            support: self.supports[i],
            side,
        }
    }
}

/// The curve of an edge.
///
/// A straight edge stays straight. A curved one is where its surfaces meet: a circle between
/// surfaces around one axis, a circle or ellipse where a plane cuts a cylinder, cone or sphere;
/// between two faces of one plane what is drawn, lifted onto it; beside a surface of no kind a circle
/// that the other one has by itself; else a curve through points, or a circle or ellipse if these lie on
/// one. A silhouette is only where it is drawn.
///
/// # Errors
/// [`PlanError::OffSurface`] or [`PlanError::Curve`] if the surfaces do not meet where it is drawn.
pub(super) fn curve(place: &Place<'_>, view: &View, lengths: Lengths) -> Result<Curve3, PlanError> {
    let drawn = Drawn::new(place.drawn, view);
    if let Some(curve) = place.known(lengths.limit) {
        return Ok(curve);
    }
    if place.silhouette && !place.drawn.is_straight() {
        let points = trace::trace(&drawn, view, &[place.lain(0, None)], place.ends);
        return Ok(Curve3::Points {
            points,
            tangents: None,
        });
    }
    if place.drawn.is_straight() {
        return straight(place, lengths);
    }
    match place.supports {
        [Support::Plane { .. }, Support::Plane { .. }] if place.same => {
            on_plane(place, &drawn, view, lengths)
        }
        [Support::Plane { .. }, Support::Plane { .. }] => straight(place, lengths),
        [Support::Unknown, Support::Unknown] => free::free(place, &drawn, view, lengths),
        [plane @ Support::Plane { .. }, Support::Unknown]
        | [Support::Unknown, plane @ Support::Plane { .. }] => {
            let place = Place {
                supports: [plane; 2],
                ..*place
            };
            on_plane(&place, &drawn, view, lengths)
        }
        [a, b] => {
            if let Some(conic) = exact::conic(&a, &b, place.ends) {
                return fitted(place, &drawn, conic, lengths);
            }
            if let (Support::Plane { .. }, Support::Cylinder { .. })
            | (Support::Cylinder { .. }, Support::Plane { .. }) = (a, b)
            {
                // A plane along the axis meets the cylinder in straight lines only.
                return straight(place, lengths);
            }
            if let Some(curve) = own_circle(place, &drawn, lengths) {
                return Ok(curve);
            }
            let mut surfaces: Vec<Lain> = (0..2).map(|i| place.lain(i, place.sides[i])).collect();
            surfaces.retain(|s| s.support != Support::Unknown);
            if place.same {
                surfaces.truncate(1);
            }
            let points = trace::trace(&drawn, view, &surfaces, place.ends);
            through(place, &drawn, points, lengths)
        }
    }
}

/// Between a round surface and one that says nothing: a circle of the round one, if that is what is drawn.
/// Points on it that are nearly seen edge-on tell little.
fn own_circle(place: &Place<'_>, drawn: &Drawn<'_>, lengths: Lengths) -> Option<Curve3> {
    let ([surface, Support::Unknown] | [Support::Unknown, surface]) = place.supports else {
        return None;
    };
    let [start, end] = place.ends;
    let whole = place.drawn.v[0] == place.drawn.v[1];
    let circles = exact::natural(&surface, place.ends, lengths.limit).into_iter();
    circles
        .map(|circle| drawn.sense(circle, start, end, whole))
        .filter(|(_, gap)| *gap <= lengths.limit)
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(circle, _)| circle.curve())
}

/// A segment, if it lies on both surfaces.
fn straight(place: &Place<'_>, lengths: Lengths) -> Result<Curve3, PlanError> {
    let [a, b] = place.ends;
    for (support, face) in place.supports.iter().zip(place.faces) {
        for share in [0.25, 0.5, 0.75] {
            let gap = support.distance(a.lerp(b, share)).abs();
            if gap.is_nan() || gap > lengths.limit {
                return Err(PlanError::OffSurface {
                    edge: place.edge + 1,
                    face: face + 1,
                    gap,
                });
            }
        }
    }
    Ok(Curve3::Line)
}

/// A conic, walked the way that is drawn.
fn fitted(
    place: &Place<'_>,
    drawn: &Drawn<'_>,
    conic: Conic,
    lengths: Lengths,
) -> Result<Curve3, PlanError> {
    let [start, end] = place.ends;
    let whole = place.drawn.v[0] == place.drawn.v[1];
    let (conic, gap) = drawn.sense(conic, start, end, whole);
    if gap.is_nan() || gap > lengths.drawn {
        return Err(PlanError::Curve {
            edge: place.edge + 1,
            faces: place.faces.map(|f| f + 1),
            gap,
        });
    }
    Ok(conic.curve())
}

/// A curve between two faces of one plane: what is drawn, lifted.
fn on_plane(
    place: &Place<'_>,
    drawn: &Drawn<'_>,
    view: &View,
    lengths: Lengths,
) -> Result<Curve3, PlanError> {
    let plane = place.supports[0];
    // A parallel projection maps conjugate diameters to conjugate diameters.
    if let (Curve2::Ellipse(arc), true) = (&place.drawn.curve, view.is_parallel()) {
        let lift = |p| drawn::onto(view, &plane, p, None);
        let lifted = [arc.center, arc.center + arc.major, arc.center + arc.minor()].map(lift);
        if let [Some(center), Some(p), Some(q)] = lifted {
            let conic = Conic::conjugate(center, p - center, q - center).rounded(lengths.snap);
            // A curve that is nearly straight is no ellipse that is known well.
            let on = |p: &DVec3| conic.point(conic.parameter(*p)).distance(*p) <= lengths.limit;
            if arc.uncertainty < UNKNOWN || place.ends.iter().all(on) {
                return fitted(place, drawn, conic, lengths);
            }
        }
    }
    let points = trace::trace(drawn, view, &[place.lain(0, None)], place.ends);
    Ok(Curve3::Points {
        points,
        tangents: None,
    })
}

/// A curve given by points: a circle or ellipse if they lie on one.
fn through(
    place: &Place<'_>,
    drawn: &Drawn<'_>,
    points: Vec<DVec3>,
    lengths: Lengths,
) -> Result<Curve3, PlanError> {
    for p in &points {
        for (support, face) in place.supports.iter().zip(place.faces) {
            let gap = support.distance(*p).abs();
            if gap.is_nan() || gap > lengths.limit {
                return Err(PlanError::OffSurface {
                    edge: place.edge + 1,
                    face: face + 1,
                    gap,
                });
            }
        }
    }
    if let Some((middle, normal, gap)) = fit_plane(&points)
        && gap <= lengths.snap
    {
        let circle = exact::circle(&points, middle, normal, lengths.snap);
        let cut = Conic::cut(middle, normal, &place.supports[0])
            .or_else(|| Conic::cut(middle, normal, &place.supports[1]))
            .map(|c| c.rounded(lengths.snap));
        for conic in circle.into_iter().chain(cut) {
            let on = |p: &DVec3| conic.point(conic.parameter(*p)).distance(*p) <= lengths.limit;
            if points.iter().all(on)
                && let Ok(curve) = fitted(place, drawn, conic, lengths)
            {
                return Ok(curve);
            }
        }
    }
    let gap = drawn.gap(&points);
    if gap.is_nan() || gap > lengths.drawn {
        return Err(PlanError::Curve {
            edge: place.edge + 1,
            faces: place.faces.map(|f| f + 1),
            gap,
        });
    }
    Ok(Curve3::Points {
        tangents: tangents(&points, &place.supports),
        points,
    })
}

/// Tangents at both ends of a curve in which two surfaces meet; `None` where they touch.
fn tangents(points: &[DVec3], supports: &[Support; 2]) -> Option<[DVec3; 2]> {
    let tangent = |at: DVec3, along: DVec3| {
        let across = supports[0].gradient(at).cross(supports[1].gradient(at));
        let unit = across.normalize_or_zero();
        let forwards = unit.dot(along.normalize_or_zero());
        (across.length() > SLANT && forwards.abs() > 0.8).then(|| unit * forwards.signum())
    };
    match points {
        [a, b, .., c, d] => Some([tangent(*a, *b - *a)?, tangent(*d, *d - *c)?]),
        _ => None,
    }
}
