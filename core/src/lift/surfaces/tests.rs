//! Surfaces fitted to boundaries that are known exactly, or within the rounding of files.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use proptest::prelude::*;

use super::evidence::{Bound, Evidence};
use super::refine::{Freedom, refined};
use super::ring::Ring;
use super::{any, axes, bend, judge, profile, sphere};
use crate::lift::Surface;

pub(super) const AT: DVec3 = DVec3::new(0.2, -0.1, 0.3);

pub(super) fn axis() -> DVec3 {
    DVec3::new(0.3, 0.8, 0.5).normalize()
}

/// The frame around the axis: two directions across it.
fn across() -> (DVec3, DVec3) {
    axis().any_orthonormal_pair()
}

fn out(turn: f64) -> DVec3 {
    let (u, v) = across();
    u * turn.cos() + v * turn.sin()
}

/// Points of an arc around the axis.
fn arc(height: f64, radius: f64, from: f64, to: f64) -> Vec<DVec3> {
    let turn = |i: u32| from + (to - from) * f64::from(i) / 24.0;
    (0..=24)
        .map(|i| AT + axis() * height + out(turn(i)) * radius)
        .collect()
}

/// Points along the profile of a torus around the axis, in the half plane at `turn`.
fn section(major: f64, minor: f64, turn: f64, from: f64, to: f64) -> Vec<DVec3> {
    let angle = |i: u32| from + (to - from) * f64::from(i) / 24.0;
    (0..=24)
        .map(|i| {
            let (sin, cos) = angle(i).sin_cos();
            AT + out(turn) * (major + minor * cos) + axis() * (minor * sin)
        })
        .collect()
}

/// The evidence of boundary curves, with the surfaces beside them.
pub(super) fn evidence(curves: Vec<(Vec<DVec3>, Surface)>) -> Evidence {
    let bounds = curves.into_iter().map(|(points, beside)| Bound {
        ring: Ring::through(&points, None, 1e-6),
        points,
        beside,
    });
    let bounds: Vec<Bound> = bounds.collect();
    Evidence {
        vertices: bounds.iter().map(|b| b.points[0]).collect(),
        bounds,
        outlines: Vec::new(),
        bent: false,
        outline_ends: Vec::new(),
        discs: Vec::new(),
        directions: vec![axis()],
        size: 1.0,
    }
}

pub(super) fn free(curves: Vec<Vec<DVec3>>) -> Evidence {
    evidence(curves.into_iter().map(|c| (c, Surface::Unknown)).collect())
}

/// Points as a file has them.
fn rounded(points: Vec<DVec3>) -> Vec<DVec3> {
    let round = |p: DVec3| (p * 1e6).round() / 1e6;
    points.into_iter().map(round).collect()
}

pub(super) fn torus(major: f64, minor: f64) -> Surface {
    Surface::Torus {
        center: AT,
        axis: axis(),
        major,
        minor,
    }
}

/// Whether two surfaces are the same within a tolerance; axes may point either way.
pub(super) fn same(a: &Surface, b: &Surface, tolerance: f64) -> bool {
    let lengths = |s: &Surface| match *s {
        Surface::Cylinder { radius, .. } | Surface::Sphere { radius, .. } => [radius, 0.0],
        Surface::Cone { angle, .. } => [angle, 0.0],
        Surface::Torus { major, minor, .. } => [major, minor],
        _ => [0.0; 2],
    };
    let near = |x: f64, y: f64| (x - y).abs() <= tolerance;
    let ([a1, a2], [b1, b2]) = (lengths(a), lengths(b));
    let off = a.origin() - b.origin();
    let off = match a {
        Surface::Cylinder { axis, .. } => off.reject_from_normalized(*axis),
        _ => off,
    };
    std::mem::discriminant(a) == std::mem::discriminant(b)
        && near(a1, b1)
        && near(a2, b2)
        && a.direction().cross(b.direction()).length() <= tolerance
        && off.length() <= tolerance
}

pub(super) fn holds(candidates: &[Surface], wanted: &Surface) -> bool {
    candidates.iter().any(|c| same(c, wanted, 1e-6))
}

#[test]
fn a_ring_is_a_circle_and_nothing_else() {
    let ring = Ring::through(&arc(0.1, 0.4, 0.0, 2.0), None, 1e-6).unwrap();
    assert!(ring.center.distance(AT + axis() * 0.1) < 1e-9);
    assert!(ring.normal.cross(axis()).length() < 1e-9);
    assert!((ring.radius - 0.4).abs() < 1e-9);
    // Too short to tell its centre, not round, not flat, too few points.
    assert!(Ring::through(&arc(0.0, 0.4, 0.0, 0.02), None, 1e-6).is_none());
    let oval = arc(0.0, 0.4, 0.0, TAU).into_iter();
    let oval: Vec<DVec3> = oval.map(|p| p * DVec3::new(1.0, 1.0, 1.1)).collect();
    assert!(Ring::through(&oval, None, 1e-6).is_none());
    let spiral = arc(0.0, 0.4, 0.0, 3.0).into_iter().enumerate();
    let spiral: Vec<DVec3> = spiral
        .map(|(i, p)| p + axis() * (i as f64 * 0.01))
        .collect();
    assert!(Ring::through(&spiral, None, 1e-6).is_none());
    assert!(Ring::through(&arc(0.0, 0.4, 0.0, TAU)[..3], None, 1e-6).is_none());
}

#[test]
fn axes_come_from_circles_and_neighbours_once() {
    let pipe = Surface::Cylinder {
        origin: AT + axis() * 3.0,
        axis: axis(),
        radius: 0.2,
    };
    let other = Surface::Cylinder {
        origin: AT,
        axis: across().0,
        radius: 0.1,
    };
    let curves = vec![
        (arc(0.0, 0.2, 0.0, TAU), pipe),
        (arc(0.5, 0.3, 0.0, TAU), other),
    ];
    let found = axes::axes(&evidence(curves));
    assert_eq!(found.len(), 2);
    // The larger circle's first.
    assert!(found[0].origin.distance(AT + axis() * 0.5) < 1e-9);
    assert!(found[1].direction.cross(across().0).length() < 1e-9);
}

#[test]
fn spheres_are_found_through_points_and_by_touch() {
    let ball = Surface::Sphere {
        center: AT,
        radius: 0.5,
    };
    // A corner of a ball: three arcs that no plane holds.
    let quarter = |a: DVec3, b: DVec3| -> Vec<DVec3> {
        let turn = |i: u32| PI / 2.0 * f64::from(i) / 12.0;
        (0..=12)
            .map(|i| AT + (a * turn(i).cos() + b * turn(i).sin()) * 0.5)
            .collect()
    };
    let (u, v) = across();
    let corner = free(vec![quarter(u, v), quarter(v, axis()), quarter(axis(), u)]);
    assert!(holds(&sphere::spheres(&corner), &ball));
    let best = judge::best(&corner, sphere::spheres(&corner), 1e-6);
    assert!(best.is_some_and(|s| same(&s, &ball, 1e-6)));

    // A dome on a pipe: one circle, and the pipe that it goes on from smoothly.
    let pipe = Surface::Cylinder {
        origin: AT,
        axis: axis(),
        radius: 0.5,
    };
    let dome = evidence(vec![(arc(0.0, 0.5, 0.0, TAU), pipe)]);
    assert!(holds(&sphere::spheres(&dome), &ball));
}

#[test]
fn cones_and_cylinders_follow_from_their_profile() {
    let line = |height: f64| arc(height, 0.1 + 0.5 * height, 0.3, 2.5);
    let cone = Surface::Cone {
        apex: AT - axis() * 0.2,
        axis: axis(),
        angle: 0.5f64.atan(),
    };
    let frustum = free(vec![line(0.0), line(0.6)]);
    let found: Vec<Surface> = axes::axes(&frustum)
        .iter()
        .filter_map(|a| profile::cone(&frustum, a))
        .collect();
    assert!(holds(&found, &cone), "{found:?}");
    // Equal circles are a cylinder's, and no cone's.
    let pipe = free(vec![arc(0.0, 0.3, 0.0, TAU), arc(0.7, 0.3, 0.0, TAU)]);
    let along = axes::axes(&pipe)[0];
    assert!(profile::cone(&pipe, &along).is_none());
    let wanted = Surface::Cylinder {
        origin: AT,
        axis: axis(),
        radius: 0.3,
    };
    let found = profile::cylinder(&pipe, &along).unwrap();
    assert!(same(&found, &wanted, 1e-9), "{found:?}");
}

#[test]
fn tori_follow_from_circles_and_what_they_touch() {
    let wanted = torus(0.6, 0.1);
    // A fillet: two circles, and the wall that one of them touches.
    let wall = Surface::Cylinder {
        origin: AT,
        axis: axis(),
        radius: 0.7,
    };
    let floor = Surface::Plane {
        origin: AT - axis() * 0.1,
        normal: axis(),
    };
    let top = Surface::Plane {
        origin: AT - axis() * 0.1,
        normal: axis(),
    };
    for (first, second) in [
        (wall, floor),
        (wall, Surface::Unknown),
        (Surface::Unknown, top),
    ] {
        let fillet = evidence(vec![
            (arc(0.0, 0.7, 0.0, TAU), first),
            (arc(-0.1, 0.6, 0.0, TAU), second),
        ]);
        let found: Vec<Surface> = axes::axes(&fillet)
            .iter()
            .flat_map(|a| profile::tori(&fillet, a))
            .collect();
        assert!(holds(&found, &wanted), "{found:?}");
        let best = judge::best(&fillet, found, 1e-6);
        assert!(best.is_some_and(|s| same(&s, &wanted, 1e-6)), "{best:?}");
    }
}

#[test]
fn bends_follow_from_sections_of_the_pipe() {
    let wanted = torus(0.6, 0.1);
    for turn in [PI / 2.0, PI / 4.0, PI] {
        let bent = free(vec![
            section(0.6, 0.1, 0.2, 0.0, TAU),
            section(0.6, 0.1, 0.2 + turn, 0.0, TAU),
        ]);
        let found = bend::tori(&bent);
        assert!(holds(&found, &wanted), "{turn}: {found:?}");
    }
    // One section, and a point further on.
    let cut = free(vec![
        section(0.6, 0.1, 0.2, 0.0, TAU),
        section(0.6, 0.1, 1.0, 0.5, 1.5),
    ]);
    let found = bend::tori(&cut);
    assert!(
        found.iter().any(|s| judge::misfit(&cut, s) < 1e-2),
        "{found:?}"
    );
}

#[test]
fn the_better_of_two_that_fit_is_the_one_that_goes_on_smoothly() {
    // Circles that a cone holds as well as a torus; the wall tells.
    let wall = Surface::Cylinder {
        origin: AT,
        axis: axis(),
        radius: 0.7,
    };
    let curves = vec![
        (arc(0.0, 0.7, 0.0, TAU), wall),
        (arc(-0.1, 0.6, 0.0, TAU), Surface::Unknown),
    ];
    let fillet = evidence(curves);
    let best = judge::best(&fillet, any(&fillet), 1e-6).unwrap();
    assert!(same(&best, &torus(0.6, 0.1), 1e-6), "{best:?}");
    // What does not fit within the tolerance is nothing, however it is refined.
    assert!(judge::best(&fillet, vec![wall], 1e-6).is_none());
}

#[test]
fn a_short_boundary_does_not_turn_the_axis() {
    // A corner of a fillet, a twentieth of a turn, with the rounding of files: freely refined the
    // axis would follow the rounding.
    let wall = Surface::Cylinder {
        origin: AT,
        axis: axis(),
        radius: 0.7,
    };
    let curves = vec![
        (rounded(arc(0.0, 0.7, 0.0, 0.3)), wall),
        (rounded(arc(-0.1, 0.6, 0.0, 0.3)), Surface::Unknown),
        (
            rounded(section(0.6, 0.1, 0.0, -PI / 2.0, 0.0)),
            Surface::Unknown,
        ),
        (
            rounded(section(0.6, 0.1, 0.3, -PI / 2.0, 0.0)),
            Surface::Unknown,
        ),
    ];
    let corner = evidence(curves);
    let found: Vec<Surface> = axes::axes(&corner)
        .iter()
        .flat_map(|a| profile::tori(&corner, a))
        .collect();
    let best = judge::best(&corner, found, 2e-5).unwrap();
    assert!(same(&best, &torus(0.6, 0.1), 1e-5), "{best:?}");
}

#[test]
fn stand_ins_close_bands_between_circles_only() {
    let circle = |height, radius| arc(height, radius, 0.0, TAU);
    let band = free(vec![circle(0.0, 0.3), circle(0.4, 0.5)]);
    let found = judge::stand_in(&band, any(&band)).unwrap();
    assert!(band.points().all(|p| found.distance(p).abs() < 1e-6));
    let one = free(vec![circle(0.0, 0.3)]);
    assert!(judge::stand_in(&one, any(&one)).is_none());
    let open = free(vec![
        circle(0.0, 0.3),
        section(0.6, 0.1, 0.0, 0.0, 2.0),
        vec![AT, AT + axis()],
    ]);
    assert!(judge::stand_in(&open, any(&open)).is_none());
}

fn whole(surface: &Surface) -> Evidence {
    let curves = match surface {
        Surface::Cylinder { radius, .. } => {
            vec![arc(0.0, *radius, 0.0, TAU), arc(0.8, *radius, 0.0, TAU)]
        }
        Surface::Cone { .. } => vec![arc(0.0, 0.2, 0.0, TAU), arc(0.8, 0.5, 0.0, TAU)],
        Surface::Sphere { .. } => vec![
            arc(0.0, 0.5, 0.0, TAU),
            arc(0.3, 0.4, 0.0, TAU),
            arc(-0.4, 0.3, 0.0, TAU),
        ],
        _ => vec![
            arc(0.1, 0.6, 0.0, TAU),
            arc(0.0, 0.7, 0.0, TAU),
            section(0.6, 0.1, 0.0, 0.0, 4.0),
            section(0.6, 0.1, 2.0, 1.0, 6.0),
        ],
    };
    free(curves)
}

fn kinds() -> [Surface; 4] {
    [
        Surface::Cylinder {
            origin: AT,
            axis: axis(),
            radius: 0.4,
        },
        Surface::Cone {
            apex: AT - axis() * (0.2 / 0.375),
            axis: axis(),
            angle: 0.375f64.atan(),
        },
        Surface::Sphere {
            center: AT,
            radius: 0.5,
        },
        torus(0.6, 0.1),
    ]
}

proptest! {
    #[test]
    fn refining_finds_back(
        shift in prop::array::uniform3(-0.01..0.01f64),
        tilt in prop::array::uniform2(-0.01..0.01f64),
        length in -0.01..0.01f64,
    ) {
        let (u, v) = across();
        for wanted in kinds() {
            let evidence = whole(&wanted);
            let tilted = wanted.direction() + (u * tilt[0] + v * tilt[1]);
            let mut start = wanted.with_origin(wanted.origin() + DVec3::from_array(shift));
            if wanted.direction() != DVec3::ZERO {
                start = start.with_direction(tilted.normalize());
            }
            if let Surface::Torus { minor, .. } | Surface::Cylinder { radius: minor, .. } = &mut start {
                *minor += length;
            }
            let found = refined(&evidence, start, Freedom::All);
            prop_assert!(same(&found, &wanted, 1e-6), "{wanted:?} {found:?}");
        }
    }

    #[test]
    fn refining_along_the_axis_keeps_the_axis(along in -0.02..0.02f64, length in -0.01..0.01f64) {
        for wanted in kinds() {
            let evidence = whole(&wanted);
            let mut start = wanted;
            if let Surface::Torus { center, minor, .. } = &mut start {
                *center += axis() * along;
                *minor += length;
            }
            for freedom in [Freedom::AlongAxis, Freedom::Shifts] {
                let found = refined(&evidence, start, freedom);
                let turned = found.direction() - wanted.direction();
                prop_assert!(turned.length() < 1e-14, "{turned}");
                prop_assert!(same(&found, &wanted, 1e-6), "{:?} {:?}", wanted, found);
            }
        }
    }
}

#[test]
fn one_circle_tells_no_surface() {
    let circle = rounded(arc(0.2, 0.5, 0.0, TAU));
    let own = free(vec![circle.clone()]);
    assert!(own.is_one_circle());
    // Its own rounding is no height.
    assert!(sphere::spheres(&own).is_empty());
    assert!(!free(vec![circle, arc(0.3, 0.4, 0.0, TAU)]).is_one_circle());
}
