//! Seams, poles and filled faces: solids of revolution, bends and patches whose volume is known.

use std::f64::consts::PI;

use faceformer::Progress;
use faceformer::drawing::CoEdge;
use faceformer::plan::{Curve3, Plan, PlanEdge, PlanFace, Surface3};
use faceformer_occt::{Solid, build};
use glam::DVec3;

/// A plan while it grows.
#[derive(Default)]
struct Draft {
    vertices: Vec<DVec3>,
    edges: Vec<PlanEdge>,
    faces: Vec<PlanFace>,
}

impl Draft {
    fn vertex(&mut self, p: DVec3) -> usize {
        self.vertices.push(p);
        self.vertices.len() - 1
    }

    fn edge(&mut self, v: [usize; 2], curve: Curve3, silhouette: bool) -> usize {
        self.edges.push(PlanEdge {
            v,
            curve,
            silhouette,
        });
        self.edges.len() - 1
    }

    /// A whole circle.
    fn ring(&mut self, center: DVec3, normal: DVec3, radius: f64) -> usize {
        let v = self.vertex(center + normal.any_orthonormal_vector() * radius);
        let curve = Curve3::Circle {
            center,
            normal,
            radius,
        };
        self.edge([v, v], curve, false)
    }

    /// A circle around z.
    fn level(&mut self, z: f64, radius: f64) -> usize {
        self.ring(DVec3::Z * z, DVec3::Z, radius)
    }

    /// An arc around a normal from one vertex to another.
    fn arc(&mut self, v: [usize; 2], center: DVec3, normal: DVec3) -> usize {
        let radius = self.vertices[v[0]].distance(center);
        let curve = Curve3::Circle {
            center,
            normal,
            radius,
        };
        self.edge(v, curve, false)
    }

    /// A face; loops are edges counted from 1, negative if walked backwards.
    fn face(&mut self, surface: Surface3, loops: &[&[i64]]) {
        let walk = |l: &&[i64]| l.iter().filter_map(|&k| CoEdge::from_signed(k)).collect();
        self.faces.push(PlanFace {
            surface,
            loops: loops.iter().map(walk).collect(),
            sources: Vec::new(),
        });
    }

    fn plane(&mut self, origin: DVec3, normal: DVec3, loops: &[&[i64]]) {
        self.face(Surface3::Plane { origin, normal }, loops);
    }

    fn plan(self) -> Plan {
        Plan {
            vertices: self.vertices,
            edges: self.edges,
            faces: self.faces,
            notices: Vec::new(),
        }
    }

    fn solid(self) -> Solid {
        build(&self.plan(), Progress::none()).unwrap()
    }
}

#[track_caller]
fn assert_near(found: f64, wanted: f64) {
    assert!(
        (found - wanted).abs() <= 1e-7 * wanted.abs(),
        "{found} is not {wanted}"
    );
}

fn cone(apex: f64, down: bool, slope: f64) -> Surface3 {
    Surface3::Cone {
        apex: DVec3::Z * apex,
        axis: if down { -DVec3::Z } else { DVec3::Z },
        angle: slope.atan(),
        hollow: false,
    }
}

#[test]
fn a_frustum_is_one_cone_with_a_seam() {
    let mut draft = Draft::default();
    draft.level(0.0, 2.0);
    draft.level(3.0, 1.0);
    draft.plane(DVec3::ZERO, -DVec3::Z, &[&[-1]]);
    draft.plane(DVec3::Z * 3.0, DVec3::Z, &[&[2]]);
    draft.face(cone(6.0, true, 1.0 / 3.0), &[&[1], &[-2]]);
    let solid = draft.solid();
    assert_near(solid.report().volume, PI * (4.0 + 2.0 + 1.0));
    let counts = solid.report().face_counts;
    assert_eq!((counts.plane, counts.cone, solid.report().edges), (2, 1, 3));
}

#[test]
fn a_cone_ends_in_its_apex() {
    let mut draft = Draft::default();
    draft.level(0.0, 2.0);
    draft.plane(DVec3::ZERO, -DVec3::Z, &[&[-1]]);
    draft.face(cone(3.0, true, 2.0 / 3.0), &[&[1]]);
    let solid = draft.solid();
    assert_near(solid.report().volume, PI * 4.0);
    assert_eq!((solid.report().faces, solid.report().vertices), (2, 2));
}

#[test]
fn caps_of_a_ball_end_in_a_pole() {
    // Half of it, and less and more.
    for z in [0.0f64, 1.0, -0.7] {
        let mut draft = Draft::default();
        draft.level(z, (4.0 - z * z).sqrt());
        draft.plane(DVec3::Z * z, -DVec3::Z, &[&[-1]]);
        let ball = Surface3::Sphere {
            center: DVec3::ZERO,
            radius: 2.0,
            hollow: false,
        };
        draft.face(ball, &[&[1]]);
        let h = 2.0 - z;
        let solid = draft.solid();
        assert_near(solid.report().volume, PI * h * h * (6.0 - h) / 3.0);
        assert_eq!(solid.report().face_counts.sphere, 1);
    }
}

#[test]
fn a_zone_of_a_ball_has_a_seam() {
    let mut draft = Draft::default();
    draft.level(-1.0, 3f64.sqrt());
    draft.level(1.0, 3f64.sqrt());
    draft.plane(-DVec3::Z, -DVec3::Z, &[&[-1]]);
    draft.plane(DVec3::Z, DVec3::Z, &[&[2]]);
    let ball = Surface3::Sphere {
        center: DVec3::ZERO,
        radius: 2.0,
        hollow: false,
    };
    draft.face(ball, &[&[1], &[-2]]);
    let solid = draft.solid();
    // The sum of 4 - z^2 from -1 to 1.
    assert_near(solid.report().volume, PI * (8.0 - 2.0 / 3.0));
}

#[test]
fn a_ball_drawn_by_its_outline_is_whole() {
    let mut draft = Draft::default();
    let (p, q) = (draft.vertex(DVec3::X), draft.vertex(-DVec3::X));
    for v in [[p, q], [q, p]] {
        let e = draft.arc(v, DVec3::ZERO, DVec3::Z);
        draft.edges[e].silhouette = true;
    }
    for walk in [[1, 2], [-2, -1]] {
        let ball = Surface3::Sphere {
            center: DVec3::ZERO,
            radius: 1.0,
            hollow: false,
        };
        draft.face(ball, &[&walk]);
    }
    let solid = draft.solid();
    assert_near(solid.report().volume, 4.0 / 3.0 * PI);
    assert_eq!(solid.report().faces, 1);
}

#[test]
fn a_torus_turns_both_ways() {
    // Around its axis: half of a ring, cut across by a plane.
    let tube = |hollow| Surface3::Torus {
        center: DVec3::ZERO,
        axis: DVec3::Z,
        major: 2.0,
        minor: 0.5,
        hollow,
    };
    let mut draft = Draft::default();
    draft.level(0.0, 2.5);
    draft.level(0.0, 1.5);
    draft.plane(DVec3::ZERO, -DVec3::Z, &[&[-1], &[2]]);
    draft.face(tube(false), &[&[1], &[-2]]);
    let solid = draft.solid();
    assert_near(solid.report().volume, PI * PI * 2.0 * 0.25);
    assert_eq!(solid.report().face_counts.torus, 1);

    // Around its tube: half a turn of a pipe.
    let mut draft = Draft::default();
    for x in [2.0, -2.0] {
        draft.ring(DVec3::X * x, -DVec3::Y, 0.5);
    }
    draft.plane(DVec3::X * 2.0, -DVec3::Y, &[&[1]]);
    draft.plane(DVec3::X * -2.0, -DVec3::Y, &[&[2]]);
    draft.face(tube(false), &[&[-1], &[-2]]);
    let solid = draft.solid();
    assert_near(solid.report().volume, PI * 0.25 * PI * 2.0);
    assert_eq!((solid.report().faces, solid.report().edges), (3, 3));
}

#[test]
fn a_bored_ring_is_hollow() {
    // A tube between two cylinders, the inner one hollow, with a groove's torus outside.
    let mut draft = Draft::default();
    for (z, radius) in [(0.0, 2.0), (1.0, 2.0), (0.0, 1.0), (1.0, 1.0)] {
        draft.level(z, radius);
    }
    let wall = |radius, hollow| Surface3::Cylinder {
        origin: DVec3::ZERO,
        axis: DVec3::Z,
        radius,
        hollow,
    };
    draft.plane(DVec3::ZERO, -DVec3::Z, &[&[-1], &[3]]);
    draft.plane(DVec3::Z, DVec3::Z, &[&[2], &[-4]]);
    draft.face(wall(2.0, false), &[&[1], &[-2]]);
    draft.face(wall(1.0, true), &[&[-3], &[4]]);
    let solid = draft.solid();
    assert_near(solid.report().volume, PI * 3.0);
    assert_eq!(solid.report().face_counts.cylinder, 2);
}

/// A vault over the rectangle from (0, 0) to (2, 1), whose arches have their centres so far below.
fn vault(depths: [f64; 2]) -> Draft {
    let mut draft = Draft::default();
    for (y, x) in [(0.0, 0.0), (0.0, 2.0), (1.0, 0.0), (1.0, 2.0)] {
        draft.vertex(DVec3::new(x, y, 0.0));
    }
    for v in [[0, 1], [2, 3], [0, 2], [1, 3]] {
        draft.edge(v, Curve3::Line, false);
    }
    for (y, depth) in [0.0, 1.0].into_iter().zip(depths) {
        let v = if y == 0.0 { [1, 0] } else { [3, 2] };
        draft.arc(v, DVec3::new(1.0, y, -depth), -DVec3::Y);
    }
    draft.plane(DVec3::ZERO, -DVec3::Z, &[&[3, 2, -4, -1]]);
    draft.plane(DVec3::ZERO, -DVec3::Y, &[&[1, 5]]);
    draft.plane(DVec3::Y, DVec3::Y, &[&[-6, -2]]);
    draft.face(Surface3::Filled, &[&[-5, 4, 6, -3]]);
    draft
}

#[test]
fn a_patch_between_equal_arches_is_the_barrel() {
    let solid = vault([0.0, 0.0]).solid();
    let report = solid.report();
    assert!((report.volume - PI / 2.0).abs() < 3e-4, "{}", report.volume);
    assert_eq!(report.filled.len(), 1);
    assert_eq!(report.filled[0].face, 3);
    assert!(report.filled[0].deviation < 1e-5);
    assert_eq!(report.face_counts.other, 1);
}

#[test]
fn a_patch_between_unequal_arches_holds_its_edges() {
    // Half a turn and a quarter of one: as rational curves they have different weights.
    let solid = vault([0.0, 1.0]).solid();
    let report = solid.report();
    let (high, low) = (PI / 2.0, PI / 2.0 - 1.0);
    assert!(
        report.volume < high && report.volume > low,
        "{}",
        report.volume
    );
    assert!((report.volume - (high + low) / 2.0).abs() < 0.1);
    assert!(report.filled[0].deviation < 1e-4, "{:?}", report.filled);
}

#[test]
fn the_wall_of_a_pipe_is_filled_in_halves_and_that_of_a_dome_in_one_piece() {
    let wall = |radius: f64, height: f64| {
        // Two halves from a circle below to one above; outlines part them.
        let mut draft = Draft::default();
        for (r, z) in [(1.0, 0.0), (radius, height)] {
            for x in [-r, r] {
                draft.vertex(DVec3::new(x, 0.0, z));
            }
        }
        for (v, z) in [
            ([0, 1], 0.0),
            ([1, 0], 0.0),
            ([2, 3], height),
            ([3, 2], height),
        ] {
            draft.arc(v, DVec3::Z * z, DVec3::Z);
        }
        for v in [[0, 2], [1, 3]] {
            draft.edge(v, Curve3::Line, true);
        }
        draft.plane(DVec3::ZERO, -DVec3::Z, &[&[-2, -1]]);
        draft.plane(DVec3::Z * height, DVec3::Z, &[&[3, 4]]);
        draft.face(Surface3::Filled, &[&[1, 6, -3, -5]]);
        draft.face(Surface3::Filled, &[&[2, 5, -4, -6]]);
        draft.solid()
    };
    let pipe = wall(1.0, 2.0);
    assert_eq!(pipe.report().face_counts.other, 2);
    let volume = pipe.report().volume;
    assert!((volume / (2.0 * PI) - 1.0).abs() < 1e-3, "{volume}");
    assert_eq!(wall(0.3, 0.2).report().face_counts.other, 1);
}

#[test]
fn a_patch_between_three_arcs_is_laid_as_a_plate() {
    // The corner of a ball, its round face unknown.
    let mut draft = Draft::default();
    for p in [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z] {
        draft.vertex(p);
    }
    for v in [[0, 1], [0, 2], [0, 3]] {
        draft.edge(v, Curve3::Line, false);
    }
    for (v, normal) in [([1, 2], DVec3::Z), ([2, 3], DVec3::X), ([3, 1], DVec3::Y)] {
        draft.arc(v, DVec3::ZERO, normal);
    }
    draft.plane(DVec3::ZERO, -DVec3::Z, &[&[2, -4, -1]]);
    draft.plane(DVec3::ZERO, -DVec3::X, &[&[3, -5, -2]]);
    draft.plane(DVec3::ZERO, -DVec3::Y, &[&[1, -6, -3]]);
    draft.face(Surface3::Filled, &[&[4, 5, 6]]);
    let solid = draft.solid();
    let report = solid.report();
    assert!((report.volume - PI / 6.0).abs() < 0.1, "{}", report.volume);
    assert!(report.filled[0].deviation < 1e-4, "{:?}", report.filled);
}
