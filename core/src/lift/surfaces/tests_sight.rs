//! Surfaces found by the lines of sight that touch them.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::evidence::{Evidence, Sight};
use super::tests::{AT, axis, evidence, free, holds, same, torus};
use super::{axes, judge, profile, sphere};
use crate::lift::ring_torus::touching_gap;
use crate::lift::{Camera, Surface};

/// A camera at the origin, and a place that it sees.
const CAMERA: Camera = Camera::Central {
    principal: DVec2::new(0.05, -0.1),
    focal: 2.5,
};
const SEEN: DVec3 = DVec3::new(0.4, 0.2, -3.0);

fn around() -> impl Iterator<Item = DVec2> {
    (0..12).map(|i| DVec2::from_angle(f64::from(i) * TAU / 12.0))
}

/// The points in which lines from the origin touch a ball.
fn touched(center: DVec3, radius: f64) -> Vec<DVec3> {
    let (u, v) = center.normalize().any_orthonormal_pair();
    let share = (radius / center.length()).powi(2);
    let (middle, wide) = (center * (1.0 - share), radius * (1.0 - share).sqrt());
    around()
        .map(|d| middle + (u * d.x + v * d.y) * wide)
        .collect()
}

fn sights(camera: &Camera, points: &[DVec3]) -> Vec<Sight> {
    let sight = |p: &DVec3| Sight::new(camera, camera.project(*p));
    points.iter().map(sight).collect()
}

#[test]
fn the_outline_of_a_ball_is_a_circle_at_its_centres_depth() {
    let mut outlined = free(Vec::new());
    outlined.discs = vec![(AT.truncate(), 0.5)];
    let end = AT + DVec3::X * 0.5;
    outlined.outline_ends = vec![(end, sights(&Camera::Parallel, &[end])[0])];
    let ball = Surface::Sphere {
        center: AT,
        radius: 0.5,
    };
    assert!(holds(&sphere::spheres(&outlined), &ball));
}

#[test]
fn in_perspective_the_outline_of_a_ball_is_a_cone_of_sight() {
    let ball = Surface::Sphere {
        center: SEEN,
        radius: 0.5,
    };
    let points = touched(SEEN, 0.5);
    // With a point of the outline, or with one elsewhere on the ball.
    let mut outlined = free(Vec::new());
    outlined.outlines = sights(&CAMERA, &points);
    let mut other = outlined.clone();
    outlined.outline_ends = vec![(points[3], outlined.outlines[3])];
    other.vertices = vec![SEEN + DVec3::new(0.3, 0.0, 0.4)];
    let found = sphere::spheres(&outlined);
    let best = judge::best(&outlined, found, 1e-9);
    assert!(best.is_some_and(|s| same(&s, &ball, 1e-9)), "{best:?}");
    // That point may be in front of a smaller ball or behind.
    let found = sphere::spheres(&other);
    assert!(holds(&found, &ball), "{found:?}");
}

#[test]
fn lines_of_sight_along_outlines_count() {
    // A ring seen along its axis: the outline touches at the widest circle.
    let ring = |minor| Surface::Torus {
        center: AT,
        axis: DVec3::Z,
        major: 0.6,
        minor,
    };
    let mut evidence = free(Vec::new());
    let widest: Vec<DVec3> = around().map(|d| AT + d.extend(0.0) * 0.7).collect();
    evidence.outlines = sights(&Camera::Parallel, &widest);
    assert!(judge::misfit(&evidence, &ring(0.1)) < 1e-9);
    assert!((judge::misfit(&evidence, &ring(0.08)) - 0.02).abs() < 1e-6);
    let p = evidence.outlines[0].from + DVec3::Z * 4.0;
    assert!(touching_gap(&ring(0.1), p, DVec3::Z) < 1e-9);
}

#[test]
fn where_an_outline_ends_the_torus_is_seen_edge_on() {
    let torus = Surface::Torus {
        center: SEEN,
        axis: DVec3::Y,
        major: 0.6,
        minor: 0.2,
    };
    // Where the section in the plane of a radius and the axis is seen edge-on: its normal there is
    // at right angles to the line of sight.
    let out = DVec3::new(0.6, 0.0, 0.8);
    let place = |angle: f64| {
        let normal = out * angle.cos() + DVec3::Y * angle.sin();
        (SEEN + out * 0.6 + normal * 0.2, normal)
    };
    let edge_on = |angle: f64| place(angle).0.dot(place(angle).1);
    let (mut low, mut high) = (0.0, std::f64::consts::PI);
    assert!(edge_on(low) * edge_on(high) < 0.0);
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if edge_on(middle) * edge_on(low) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let end = place(low).0;
    let ring = |height: f64| -> Vec<DVec3> {
        let radius = 0.6 + (0.04 - height * height).sqrt();
        let point = |d: DVec2| SEEN + DVec3::new(d.x * radius, height, d.y * radius);
        around().map(point).collect()
    };
    let mut band: Evidence = evidence(vec![(ring(0.1), Surface::Unknown)]);
    band.outline_ends = vec![(end, sights(&CAMERA, &[end])[0])];
    let found: Vec<Surface> = axes::axes(&band)
        .iter()
        .flat_map(|axis| profile::tori(&band, axis))
        .collect();
    assert!(holds(&found, &torus), "{found:?}");
}

/// Two circles are on tori of any tube; the lines of sight that graze it tell which.
#[test]
fn the_bulge_of_a_rounded_rim_shows_in_its_outline() {
    for (low, high) in [(-1.2, 0.9), (-0.4, 1.9), (-1.9, 0.3)] {
        let wanted = torus(0.6, 0.1);
        let Surface::Torus { axis: n, .. } = wanted else {
            unreachable!();
        };
        let (u, v) = n.any_orthonormal_pair();
        let place = |turn: f64, angle: f64| {
            let out = u * turn.cos() + v * turn.sin();
            AT + out * (0.6 + 0.1 * angle.cos()) + n * (0.1 * angle.sin())
        };
        let circle = |angle: f64| (0..=24).map(move |i| place(f64::from(i) * TAU / 24.0, angle));
        let mut rim = free(vec![circle(low).collect(), circle(high).collect()]);
        rim.outlines = (0..16)
            .map(|i| {
                let angle = low + (high - low) * (0.3 + 0.025 * f64::from(i));
                let p = place(0.4 * f64::from(i), angle);
                let tangent = wanted.gradient(p).cross(DVec3::new(0.3, 0.2, 1.0));
                let direction = tangent.normalize();
                Sight {
                    from: p - direction * 3.0,
                    direction,
                }
            })
            .collect();
        let axes = axes::axes(&rim);
        let found: Vec<Surface> = axes.iter().flat_map(|a| profile::tori(&rim, a)).collect();
        assert_eq!(judge::best(&rim, found, 1e-5), None);
        let found: Vec<Surface> = axes.iter().flat_map(|a| profile::bulges(&rim, a)).collect();
        let best = judge::best(&rim, found, 1e-5);
        assert!(best.is_some_and(|s| same(&s, &wanted, 1e-4)), "{best:?}");
    }
}

#[test]
fn lines_touch_cylinders_and_cones() {
    let (u, v) = axis().any_orthonormal_pair();
    for k in 0..12 {
        let turn = f64::from(k) * TAU / 12.0;
        let (out, along) = (
            u * turn.cos() + v * turn.sin(),
            v * turn.cos() - u * turn.sin(),
        );
        let sight = |from: DVec3, direction: DVec3| Sight {
            from: from - direction * 3.0,
            direction: direction.normalize(),
        };
        let beside = sight(AT + out * 0.5, along + axis() * 0.3);
        assert!((beside.apart(AT, axis()) - 0.5).abs() < 1e-12);
        assert!((sight(AT + out * 0.5, axis()).apart(AT, axis()) - 0.5).abs() < 1e-12);
        // In the plane that touches a cone along a line of it, across that line.
        let angle = 0.4f64;
        let line = axis() * angle.cos() + out * angle.sin();
        let normal = out * angle.cos() - axis() * angle.sin();
        let across = along + line * 0.2;
        let gap =
            |off: f64| sight(AT + line * 0.7 + normal * off, across).cone_gap(AT, axis(), angle);
        assert!(gap(0.0).abs() < 1e-12, "{}", gap(0.0));
        assert!(gap(0.01) > 0.009 && gap(-0.01) < -0.009);
        // Steeper than the cone.
        let steep = sight(AT + out, axis() + out * 0.1);
        assert_eq!(steep.cone_gap(AT, axis(), angle), f64::INFINITY);
    }
}
