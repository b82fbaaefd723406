//! Circles and ellipses in space, as cuts of round surfaces and as drawn curves on planes.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3};

use super::Curve3;
use super::support::Support;
use crate::scatter::Scatter;

/// An ellipse `center + cos(t) major + sin(t) minor`; the axes are orthogonal.
#[derive(Debug, Clone, Copy)]
pub(super) struct Conic {
    pub(super) center: DVec3,
    pub(super) major: DVec3,
    pub(super) minor: DVec3,
}

/// Axes that differ by less than this share of the larger one make a circle.
const ROUND: f64 = 1e-9;

impl Conic {
    /// The circle around an axis through a point; `None` if the point is on the axis.
    pub(super) fn around(origin: DVec3, axis: DVec3, p: DVec3) -> Option<Self> {
        let center = origin + axis * axis.dot(p - origin);
        let major = p - center;
        let round = major.length() > 1e-12 * (1.0 + center.length());
        round.then(|| Self {
            center,
            major,
            minor: axis.cross(major),
        })
    }

    /// The closed curve in which a plane cuts a cylinder, cone or sphere; `None` if it is not
    /// closed, or nearly not, or no conic.
    pub(super) fn cut(plane: DVec3, normal: DVec3, surface: &Support) -> Option<Self> {
        match *surface {
            Support::Cylinder {
                origin,
                axis,
                radius,
            } => Self::cut_cylinder(plane, normal, (origin, axis, radius)),
            Support::Cone { apex, axis, angle } => {
                let (sin, cos) = angle.sin_cos();
                let side = normal.reject_from_normalized(axis);
                let side = side.normalize_or(axis.any_orthonormal_vector());
                // Where the two generators meet the plane that lean most and least to it.
                let ends = [side, -side].map(|w| {
                    let along = axis * cos + w * sin;
                    let t = normal.dot(plane - apex) / normal.dot(along);
                    (t.is_finite() && t > 0.0).then(|| apex + along * t)
                });
                let [Some(p), Some(q)] = ends else {
                    return None;
                };
                let (center, major) = (p.midpoint(q), (p - q) / 2.0);
                let height = axis.dot(center - apex);
                let aside = (center - apex - axis * height).length_squared();
                let minor = ((height * sin / cos).powi(2) - aside).sqrt();
                let across = normal.cross(major).try_normalize()?;
                // A very long ellipse is nearly a parabola.
                (minor > 1e-2 * major.length()).then(|| Self {
                    center,
                    major,
                    minor: across * minor,
                })
            }
            Support::Sphere { center, radius } => {
                let height = normal.dot(plane - center);
                let inner = (radius * radius - height * height).sqrt();
                let (u, v) = normal.any_orthonormal_pair();
                (inner > 1e-6 * radius).then(|| Self {
                    center: center + normal * height,
                    major: u * inner,
                    minor: v * inner,
                })
            }
            _ => None,
        }
    }

    fn cut_cylinder(
        plane: DVec3,
        normal: DVec3,
        (origin, axis, radius): (DVec3, DVec3, f64),
    ) -> Option<Self> {
        let slope = normal.dot(axis);
        if slope.abs() < 1e-3 {
            return None;
        }
        let center = origin + axis * (normal.dot(plane - origin) / slope);
        let minor = axis.cross(normal);
        Some(if minor.length() < ROUND {
            let major = axis.any_orthonormal_vector() * radius;
            Self {
                center,
                major,
                minor: axis.cross(major),
            }
        } else {
            let minor = minor.normalize() * radius;
            let along = (axis - normal * slope).normalize();
            Self {
                center,
                major: along * (radius / slope.abs()),
                minor,
            }
        })
    }

    /// The ellipse with two conjugate semi-diameters (Rytz's construction, by one rotation of the
    /// parameter).
    pub(super) fn conjugate(center: DVec3, p: DVec3, q: DVec3) -> Self {
        // The axes are where the distance from the centre is extreme.
        let t = 0.5 * (2.0 * p.dot(q)).atan2(p.length_squared() - q.length_squared());
        let (sin, cos) = t.sin_cos();
        Self {
            center,
            major: p * cos + q * sin,
            minor: q * cos - p * sin,
        }
    }

    /// The same curve as a circle if its axes are equal within `tolerance`, a length.
    pub(super) fn rounded(self, tolerance: f64) -> Self {
        let (a, b) = (self.major.length(), self.minor.length());
        if (a - b).abs() > tolerance {
            return self;
        }
        let mean = (a + b) / 2.0;
        let major = self.major.normalize();
        let minor = self.minor.reject_from_normalized(major);
        Self {
            major: major * mean,
            minor: minor.normalize_or(major.any_orthonormal_vector()) * mean,
            ..self
        }
    }

    /// Point at a parameter, radians.
    pub(super) fn point(&self, t: f64) -> DVec3 {
        let (sin, cos) = t.sin_cos();
        self.center + self.major * cos + self.minor * sin
    }

    /// Parameter of the point beside `p`, in (-pi, pi].
    pub(super) fn parameter(&self, p: DVec3) -> f64 {
        let d = p - self.center;
        let y = self.minor.dot(d) / self.minor.length_squared();
        let x = self.major.dot(d) / self.major.length_squared();
        y.atan2(x)
    }

    /// The same curve walked the other way.
    pub(super) fn reversed(self) -> Self {
        Self {
            minor: -self.minor,
            ..self
        }
    }

    /// Parameter at `start` and the length of the arc from there to `end`, in (0, 2 pi]; whole if
    /// the two are one vertex.
    pub(super) fn range(&self, start: DVec3, end: DVec3, whole: bool) -> (f64, f64) {
        let first = self.parameter(start);
        if whole {
            return (first, TAU);
        }
        let sweep = (self.parameter(end) - first).rem_euclid(TAU);
        (first, if sweep > 0.0 { sweep } else { TAU })
    }

    /// The plan's curve, walked as the parameter grows.
    pub(super) fn curve(&self) -> Curve3 {
        let (a, b) = (self.major.length(), self.minor.length());
        let normal = self.major.cross(self.minor).normalize();
        if (a - b).abs() <= ROUND * a.max(b) {
            return Curve3::Circle {
                center: self.center,
                normal,
                radius: a,
            };
        }
        let (major, ratio) = if a > b {
            (self.major, b / a)
        } else {
            (self.minor, a / b)
        };
        Curve3::Ellipse {
            center: self.center,
            normal,
            major,
            ratio,
        }
    }

    /// The conic of a plan's curve; `None` for lines and points.
    pub(super) fn of(curve: &Curve3, start: DVec3) -> Option<Self> {
        match *curve {
            Curve3::Circle {
                center,
                normal,
                radius,
            } => {
                let arm = (start - center).reject_from(normal);
                let major = arm.normalize_or(normal.any_orthogonal_vector()) * radius;
                Some(Self {
                    center,
                    major,
                    minor: normal.cross(major),
                })
            }
            Curve3::Ellipse {
                center,
                normal,
                major,
                ratio,
            } => Some(Self {
                center,
                major,
                minor: normal.cross(major) * ratio,
            }),
            Curve3::Line | Curve3::Points { .. } => None,
        }
    }
}

/// The plane that lies closest to points: their centroid, its normal, the largest distance.
/// `None` for fewer than three points, or points on one line.
pub(super) fn fit_plane(points: &[DVec3]) -> Option<(DVec3, DVec3, f64)> {
    if points.len() < 3 {
        return None;
    }
    let scatter = Scatter::new(points);
    let (spread, trace) = (scatter.matrix, scatter.trace());
    let normal = scatter.normal()?;
    // On a line two eigenvalues are small, and the normal says nothing.
    let along = DMat3::from_cols(
        spread.x_axis - normal * normal.dot(spread.x_axis),
        spread.y_axis - normal * normal.dot(spread.y_axis),
        spread.z_axis - normal * normal.dot(spread.z_axis),
    );
    let squares = along.x_axis.length_squared() + along.y_axis.length_squared();
    let squares = squares + along.z_axis.length_squared();
    let product = (trace * trace - squares) / 2.0;
    if product.is_nan() || product <= 1e-10 * trace * trace {
        return None;
    }
    let distances = points
        .iter()
        .map(|p| normal.dot(*p - scatter.centroid).abs());
    Some((scatter.centroid, normal, distances.fold(0.0, f64::max)))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn tube() -> Support {
        Support::Cylinder {
            origin: DVec3::new(0.3, -0.2, 0.1),
            axis: DVec3::new(0.2, 0.1, 1.0).normalize(),
            radius: 0.4,
        }
    }

    proptest! {
        #[test]
        fn cut_lies_on_plane_and_cylinder(
            n in prop::array::uniform3(-1.0..1.0f64),
            t in 0.0..TAU,
        ) {
            let normal = DVec3::from_array(n).normalize_or(DVec3::Z);
            let plane = DVec3::new(0.1, 0.2, 0.3);
            if let Some(conic) = Conic::cut(plane, normal, &tube()) {
                let p = conic.point(t);
                prop_assert!(normal.dot(p - plane).abs() < 1e-9);
                prop_assert!(tube().distance(p).abs() < 1e-9 * conic.major.length().max(1.0));
                prop_assert!((conic.parameter(p) - t).sin().abs() < 1e-9);
                let again = Conic::of(&conic.curve(), p).unwrap();
                let near = again.point(again.parameter(p));
                prop_assert!(near.distance(p) < 1e-9 * conic.major.length().max(1.0));
            }
        }

        #[test]
        fn conjugate_diameters_lie_on_their_ellipse(
            p in prop::array::uniform3(-1.0..1.0f64),
            q in prop::array::uniform3(-1.0..1.0f64),
        ) {
            let (p, q) = (DVec3::from_array(p), DVec3::from_array(q));
            prop_assume!(p.cross(q).length() > 0.05);
            let conic = Conic::conjugate(DVec3::X, p, q);
            prop_assert!(conic.major.dot(conic.minor).abs() < 1e-12);
            prop_assert!(conic.major.length() >= conic.minor.length());
            for d in [p, q, -p] {
                let point = conic.point(conic.parameter(DVec3::X + d));
                prop_assert!(point.distance(DVec3::X + d) < 1e-9);
            }
        }

        #[test]
        fn plane_fits_its_points(n in prop::array::uniform3(-1.0..1.0f64)) {
            let normal = DVec3::from_array(n).normalize_or(DVec3::X);
            let (u, v) = normal.any_orthonormal_pair();
            let points: Vec<DVec3> = (0..12)
                .map(|i| {
                    let (sin, cos) = f64::from(i).sin_cos();
                    DVec3::ONE + u * cos + v * 0.3 * sin
                })
                .collect();
            let (_, found, gap) = fit_plane(&points).unwrap();
            prop_assert!(found.cross(normal).length() < 1e-6);
            prop_assert!(gap < 1e-6);
        }
    }

    #[test]
    fn points_on_a_line_have_no_plane() {
        let points: Vec<DVec3> = (0..9).map(|i| DVec3::ONE * f64::from(i)).collect();
        assert!(fit_plane(&points).is_none());
    }
}
