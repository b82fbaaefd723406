//! Small turned parts, seen so steeply that none of their faces has a silhouette.

use std::collections::BTreeSet;

use glam::{DMat3, DVec3};

use super::super::group;
use crate::drawing::{CoEdge, Curve2, Drawing, Edge, Graph, Projection, SurfaceKind};
use crate::identify::{Evidence, Face};
use crate::lift::Readings;

/// Circles around one axis, each by radius and height.
fn turned(profile: &[(f64, f64)]) -> Drawing {
    let view = DMat3::from_rotation_z(0.3) * DMat3::from_rotation_x(-0.45);
    let edges: Vec<Edge> = profile
        .iter()
        .enumerate()
        .map(|(k, &(radius, height))| {
            let point = |i: i32| {
                let (sin, cos) = (std::f64::consts::TAU * f64::from(i % 64) / 64.0).sin_cos();
                (view * DVec3::new(radius * cos, radius * sin, height)).truncate()
            };
            let points: Vec<_> = (0..=64).map(point).collect();
            Edge {
                v: [k, k],
                curve: Curve2::recognise(&points),
                points,
            }
        })
        .collect();
    Drawing {
        id: String::new(),
        source: String::new(),
        projection: Projection::Orthographic,
        vertices: edges.iter().map(|e| e.points[0]).collect(),
        edges,
        truth: None,
    }
}

/// The circles of each face of the likeliest grouping.
fn faces(profile: &[(f64, f64)]) -> Vec<BTreeSet<usize>> {
    let drawing = turned(profile);
    let loops: Vec<Face> = (0..2 * profile.len())
        .map(|i| Face {
            kind: SurfaceKind::Plane,
            loops: vec![vec![CoEdge::new(i / 2, i % 2 == 1)]],
            confidence: 1.0,
            evidence: Evidence::default(),
        })
        .collect();
    let found = group(&Readings::new(&drawing), &Graph::new(&drawing), &loops);
    let mut faces: Vec<BTreeSet<usize>> = found[0]
        .faces
        .iter()
        .map(|f| f.iter().map(|i| i / 2).collect())
        .collect();
    faces.sort();
    faces
}

fn sets(lists: &[&[usize]]) -> Vec<BTreeSet<usize>> {
    let mut sets: Vec<BTreeSet<usize>> =
        lists.iter().map(|l| l.iter().copied().collect()).collect();
    sets.sort();
    sets
}

#[test]
fn a_ring_has_no_end() {
    let ring = faces(&[(1.0, 0.0), (3.0, 0.0), (2.0, 0.3)]);
    assert_eq!(ring, sets(&[&[0, 1], &[1, 2], &[2, 0]]));
}

#[test]
fn no_two_discs_are_in_one_plane() {
    // Sleeves with a collar, and one with a groove around its top.
    let profiles: [&[(f64, f64)]; 3] = [
        &[(1.0, 0.0), (2.0, 0.0), (2.0, 0.3), (1.0, 0.3)],
        &[
            (1.0, 0.0),
            (3.0, 0.0),
            (3.0, 0.2),
            (2.0, 0.2),
            (2.0, 0.5),
            (1.0, 0.5),
        ],
        &[
            (2.6, 0.0),
            (3.0, 0.0),
            (3.0, 0.4),
            (2.8, 0.4),
            (2.8, 0.6),
            (2.6, 0.6),
        ],
    ];
    for profile in profiles {
        let found = faces(profile);
        let discs: Vec<f64> = found
            .iter()
            .filter(|face| face.len() == 1)
            .map(|face| profile[*face.first().expect("one circle")].1)
            .collect();
        let one_plane = discs.iter().enumerate();
        let twice = one_plane.filter(|(k, height)| discs[..*k].contains(height));
        assert_eq!(twice.count(), 0, "{profile:?}: {found:?}");
    }
}
