//! Small turned parts, seen so steeply that none of their faces has a silhouette.

use std::collections::BTreeSet;
use std::f64::consts::PI;

use glam::{DMat3, DVec2, DVec3};

use super::super::group;
use super::super::joins::{Role, State};
use super::super::links::links;
use super::super::shapes::Shapes;
use super::{Chain, chains};
use crate::drawing::{CoEdge, Curve2, Drawing, Edge, Graph, SurfaceKind};
use crate::identify::{Evidence, Face};
use crate::lift::{Pieces, Readings};

/// The view.
fn view() -> DMat3 {
    DMat3::from_rotation_z(0.3) * DMat3::from_rotation_x(-0.45)
}

/// Circles around one axis, each by radius and height.
fn turned(profile: &[(f64, f64)]) -> Drawing {
    let view = view();
    let edges: Vec<Edge> = profile
        .iter()
        .enumerate()
        .map(|(k, &(radius, height))| {
            let point = |i: i32| {
                let (sin, cos) = (std::f64::consts::TAU * f64::from(i % 64) / 64.0).sin_cos();
                (view * DVec3::new(radius * cos, radius * sin, height)).truncate()
            };
            let points: Vec<_> = (0..=64).map(point).collect();
            Edge::drawn([k, k], points)
        })
        .collect();
    Drawing::orthographic(edges.iter().map(|e| e.points[0]).collect(), edges)
}

/// Both loops of so many circles.
fn loops(circles: usize) -> Vec<Face> {
    (0..2 * circles)
        .map(|i| Face {
            kind: SurfaceKind::Plane,
            loops: vec![vec![CoEdge::new(i / 2, i % 2 == 1)]],
            confidence: 1.0,
            evidence: Evidence::default(),
        })
        .collect()
}

/// Adds a prism of six corners between two heights: its loops are the top, the bottom and six walls.
fn add_socket(drawing: &mut Drawing, loops: &mut Vec<Face>, heights: [f64; 2]) {
    let (v, e) = (drawing.vertices.len(), drawing.edges.len());
    for height in heights {
        let corner = |k: u32| DVec2::from_angle(0.2 + PI / 3.0 * f64::from(k)).extend(0.0);
        let at = |k: u32| view() * (corner(k) * 0.3 + DVec3::Z * height);
        drawing.vertices.extend((0..6).map(|k| at(k).truncate()));
    }
    let next = |k: usize| (k + 1) % 6;
    let tops = (0..6).map(|k| [k, next(k)]);
    let bottoms = (0..6).map(|k| [6 + k, 6 + next(k)]);
    let sides = (0..6).map(|k| [k, 6 + k]);
    for ends in tops.chain(bottoms).chain(sides) {
        let ends = ends.map(|k| v + k);
        drawing.edges.push(Edge {
            v: ends,
            points: ends.map(|k| drawing.vertices[k]).to_vec(),
            curve: Curve2::Line,
        });
    }
    let walk = |list: &[(usize, bool)]| Face {
        kind: SurfaceKind::Plane,
        loops: vec![
            list.iter()
                .map(|&(k, back)| CoEdge::new(e + k, back))
                .collect(),
        ],
        confidence: 1.0,
        evidence: Evidence::default(),
    };
    loops.push(walk(&[0, 1, 2, 3, 4, 5].map(|k| (k, false))));
    loops.push(walk(&[11, 10, 9, 8, 7, 6].map(|k| (k, true))));
    loops.extend((0..6).map(|k| {
        walk(&[
            (k, true),
            (12 + k, false),
            (6 + k, false),
            (12 + next(k), true),
        ])
    }));
}

/// The circles of each face of the likeliest grouping.
fn faces(profile: &[(f64, f64)]) -> Vec<BTreeSet<usize>> {
    let drawing = turned(profile);
    let loops = loops(profile.len());
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
fn two_discs_in_one_plane_are_no_matching() {
    let profile = [(1.0, 0.0), (2.0, 0.0), (2.0, 0.3), (1.0, 0.3)];
    let (drawing, loops) = (turned(&profile), loops(profile.len()));
    let readings = Readings::new(&drawing);
    let (drawing, pieces) = Pieces::new(&readings, &loops).unwrap();
    let shapes = Shapes::new(&drawing, &Graph::new(&drawing), &pieces, &loops);
    let links = links(&shapes);
    let state = State {
        placed: vec![None; shapes.parts.len()],
        roles: vec![Role::Free; loops.len()],
        inner: vec![Vec::new(); loops.len()],
        hung: vec![false; loops.len()],
    };
    let mut chain = chains(&shapes, &links).remove(0);
    let circle = |r: usize| chain.rings[r].outline / 2;
    let over: BTreeSet<[usize; 2]> = (0..chain.rings.len())
        .flat_map(|r| chain.around[r].iter().map(move |&s| [s, r]))
        .map(|pair| pair.map(circle))
        .collect();
    assert_eq!(over, BTreeSet::from([[1, 0], [2, 3]]));
    // All loops alone are discs, of which every ring has one inside the other.
    let apart = |chain: &Chain| chain.matchings(&shapes, &links, &state).now;
    let with = apart(&chain);
    chain.around.iter_mut().for_each(Vec::clear);
    assert!(with > apart(&chain) + 10.0, "{with}");
}

/// The head of a screw: a cone between its circles, and the socket in the upper one.
#[test]
fn a_socket_is_in_the_end_of_its_head() {
    let profile = [(1.0, 0.0), (0.8, 0.35)];
    let (mut drawing, mut loops) = (turned(&profile), loops(profile.len()));
    add_socket(&mut drawing, &mut loops, [0.35, 0.15]);
    let found = group(&Readings::new(&drawing), &Graph::new(&drawing), &loops);
    let top = 2 * profile.len();
    let is_right = |f: &Vec<usize>| f.len() == 2 && f[0] / 2 == 1 && f[1] == top;
    assert!(found[0].faces.iter().any(is_right), "{:?}", found[0].faces);
}
