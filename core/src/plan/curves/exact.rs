//! Edges that are circles or ellipses by what their surfaces are.

use glam::{DVec2, DVec3};

use crate::plan::conic::Conic;
use crate::plan::support::Support;
use crate::plan::touch_round::bend;

/// A bend goes on as its pipe within this share of its radius.
const BENT: f64 = 1e-6;

/// Axes closer than this share of the surfaces' distance from each other are one.
const SAME_AXIS: f64 = 1e-6;

/// The conic through an edge's ends in which two surfaces meet; `None` if they meet in none.
pub(super) fn conic(a: &Support, b: &Support, ends: [DVec3; 2]) -> Option<Conic> {
    if let Some((origin, axis)) = common_axis(a, b) {
        // Both ends are at one height; a circle through one is the edge.
        let mean = ends[0].midpoint(ends[1]);
        let height = axis.dot(mean - origin);
        let conic = Conic::around(origin, axis, ends[0])?;
        return Some(Conic {
            center: origin + axis * height,
            ..conic
        });
    }
    // A pipe goes on as its bend from a circle across.
    for (pipe, torus) in [(a, b), (b, a)] {
        if let Some((origin, axis)) = pipe.axis()
            && bend(pipe, torus, BENT * torus.radius()).is_some()
        {
            return Conic::around(origin, axis, ends[0]);
        }
    }
    let (plane, other) = match (a, b) {
        (Support::Plane { .. }, other) => (a, other),
        (other, Support::Plane { .. }) => (b, other),
        _ => return None,
    };
    if let Support::Torus {
        center,
        axis,
        major,
        minor,
    } = *other
    {
        // A plane through the axis cuts the tube across.
        let normal = plane.direction();
        let through = plane.distance(center).abs() < SAME_AXIS * major;
        let out = (ends[0] - center).reject_from_normalized(axis);
        let out = out.reject_from_normalized(normal).try_normalize()?;
        return (through && normal.dot(axis).abs() < SAME_AXIS).then(|| Conic {
            center: center + out * major,
            major: out * minor,
            minor: axis * minor,
        });
    }
    Conic::cut(plane.origin(), plane.direction(), other)
}

/// The circles that a round surface has through an edge's ends by itself: around its axis, and that of a
/// torus around its tube.
pub(super) fn natural(surface: &Support, ends: [DVec3; 2], near: f64) -> Vec<Conic> {
    let Some((origin, axis)) = surface.axis() else {
        return Vec::new();
    };
    let mut found = Vec::new();
    let [p, q] = ends.map(|p| p - origin);
    let across = [p, q].map(|p| p.reject_from_normalized(axis));
    if (p - q).dot(axis).abs() <= near && (across[0].length() - across[1].length()).abs() <= near {
        found.extend(Conic::around(origin, axis, ends[0]));
    }
    if let Support::Torus { major, minor, .. } = *surface
        && let Some(out) = (across[0] + across[1]).try_normalize()
        && across[0].reject_from_normalized(out).length() <= near
    {
        found.push(Conic {
            center: origin + out * major,
            major: out * minor,
            minor: axis * minor,
        });
    }
    found
}

/// The axis that two surfaces have in common: all their curves in common are circles around it.
fn common_axis(a: &Support, b: &Support) -> Option<(DVec3, DVec3)> {
    let (one, other) = if a.axis().is_some() { (a, b) } else { (b, a) };
    let (origin, axis) = one.axis()?;
    let scale = origin.distance(other.origin());
    let on_axis = |p: DVec3, near: f64| {
        (p - origin).reject_from_normalized(axis).length() <= SAME_AXIS * scale.max(near)
    };
    let parallel = |d: DVec3| axis.cross(d).length() <= SAME_AXIS;
    let common = match *other {
        Support::Plane { normal, .. } => parallel(normal),
        Support::Sphere { center, radius } => on_axis(center, radius),
        Support::Cylinder { .. } | Support::Cone { .. } | Support::Torus { .. } => {
            let near = one.radius().min(other.radius()).min(1.0);
            parallel(other.direction()) && on_axis(other.origin(), near)
        }
        Support::Unknown => false,
    };
    common.then_some((origin, axis))
}

/// The circle in a plane closest to points, if they are within `tolerance` of it.
pub(super) fn circle(
    points: &[DVec3],
    middle: DVec3,
    normal: DVec3,
    tolerance: f64,
) -> Option<Conic> {
    let (u, v) = normal.any_orthonormal_pair();
    let flat = |p: &DVec3| DVec2::new((*p - middle).dot(u), (*p - middle).dot(v));
    let (center, radius, gain) = crate::lift::circle_fit(points.iter().map(flat))?;
    let off = |p: &DVec3| (flat(p).distance(center) - radius).abs();
    (gain < 1e4 && points.iter().all(|p| off(p) <= tolerance)).then(|| Conic {
        center: middle + u * center.x + v * center.y,
        major: u * radius,
        minor: v * radius,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_torus_has_circles_around_its_axis_and_around_its_tube() {
        let torus = Support::Torus {
            center: DVec3::Z,
            axis: DVec3::Z,
            major: 1.0,
            minor: 0.2,
        };
        let top = DVec3::new(1.0, 0.0, 1.2);
        let around = natural(&torus, [top, DVec3::new(0.0, -1.0, 1.2)], 1e-9);
        let [circle] = around[..] else {
            panic!("{around:?}");
        };
        assert!((circle.point(2.0).distance(DVec3::Z * 1.2) - 1.0).abs() < 1e-12);
        let across = natural(&torus, [top, DVec3::new(1.2, 0.0, 1.0)], 1e-9);
        let [circle] = across[..] else {
            panic!("{across:?}");
        };
        assert!(circle.center.distance(DVec3::new(1.0, 0.0, 1.0)) < 1e-12);
        assert!(natural(&torus, [top, DVec3::new(0.0, -1.2, 1.0)], 1e-9).is_empty());
    }
}
