//! Boxes with pockets, holes and bosses, seen from anywhere.

use std::collections::BTreeSet;
use std::f64::consts::PI;

use proptest::prelude::*;

use super::*;
use crate::Progress;
use crate::drawing::{CoEdge, Drawing, SurfaceKind};
use crate::identify::rotation::RotationEngine;
use crate::identify::testing::{bracket, chamfered, holed_cube, polyhedron, seen};
use crate::identify::{Engine, Evidence, from_truth};

/// What is in the top of a box of 4 by 3 by 2.
#[derive(Debug, Clone, Copy)]
struct Feature {
    low: [f64; 2],
    high: [f64; 2],
    /// Height of its other end: 0 for a hole, above 2 for a boss.
    end: f64,
}

fn block(features: &[Feature]) -> Drawing {
    let ring = |low: [f64; 2], high: [f64; 2], z: f64| {
        [
            [low[0], low[1], z],
            [high[0], low[1], z],
            [high[0], high[1], z],
            [low[0], high[1], z],
        ]
    };
    let mut corners = Vec::new();
    corners.extend(ring([0.0; 2], [4.0, 3.0], 0.0));
    corners.extend(ring([0.0; 2], [4.0, 3.0], 2.0));
    let mut bottom: Vec<Vec<usize>> = vec![vec![3, 2, 1, 0]];
    let mut top: Vec<Vec<usize>> = vec![vec![4, 5, 6, 7]];
    let mut walls: Vec<Vec<usize>> = vec![];
    for i in 0..4 {
        let j = (i + 1) % 4;
        walls.push(vec![i, j, 4 + j, 4 + i]);
    }
    for f in features {
        let at = corners.len();
        corners.extend(ring(f.low, f.high, 2.0));
        corners.extend(ring(f.low, f.high, f.end));
        top.push(vec![at + 3, at + 2, at + 1, at]);
        let end: Vec<usize> = (at + 4..at + 8).collect();
        if f.end == 0.0 {
            bottom.push(end);
        } else {
            walls.push(end);
        }
        for i in 0..4 {
            let j = (i + 1) % 4;
            walls.push(vec![at + i, at + j, at + 4 + j, at + 4 + i]);
        }
    }
    let mut faces = vec![bottom, top];
    faces.extend(walls.into_iter().map(|w| vec![w]));
    let faces: Vec<Vec<&[usize]>> = faces
        .iter()
        .map(|f| f.iter().map(Vec::as_slice).collect())
        .collect();
    let faces: Vec<&[&[usize]]> = faces.iter().map(Vec::as_slice).collect();
    polyhedron(&corners, &faces)
}

pub(super) fn single_loops(drawing: &Drawing) -> Vec<Face> {
    let truth = drawing.truth.as_ref().unwrap();
    let loops = truth.faces.iter().flat_map(|f| &f.loops);
    loops
        .map(|walk| Face {
            kind: SurfaceKind::Plane,
            loops: vec![walk.clone()],
            confidence: 1.0,
            evidence: Evidence::default(),
        })
        .collect()
}

/// The same drawing, of a parallel projection, as a camera sees it that is 6 units away.
pub(super) fn in_perspective(mut drawing: Drawing) -> Drawing {
    let truth = drawing.truth.as_ref().unwrap();
    let seen = truth
        .vertices3d
        .iter()
        .map(|p| p.truncate() * (6.0 / (6.0 - p.z)));
    drawing.vertices = seen.collect();
    for edge in &mut drawing.edges {
        edge.points = edge.v.map(|v| drawing.vertices[v]).to_vec();
    }
    drawing.projection = crate::drawing::Projection::Perspective { focal: Some(6.0) };
    drawing
}

/// Calls `look` with the loops of a drawing as they are lifted, and the pairs that may be faces.
pub(super) fn lifted(drawing: &Drawing, look: impl Fn(&Shapes, &[links::Link])) {
    let loops = single_loops(drawing);
    let readings = Readings::new(drawing);
    let (drawing, pieces) = Pieces::new(&readings, &loops).unwrap();
    let shapes = Shapes::new(&drawing, &Graph::new(&drawing), &pieces, &loops);
    look(&shapes, &links::links(&shapes));
}

fn edge_sets(faces: &[Face]) -> BTreeSet<Vec<usize>> {
    faces.iter().map(Face::edge_set).collect()
}

/// A feature over the box from `x` to `x + 2`; a blind pocket only if `pocket`: two of them have four
/// readings that are all consistent, each from above or from below.
fn feature(x: f64, pocket: bool) -> impl Strategy<Value = Feature> {
    let inset = 0.15..0.5;
    (
        inset.clone(),
        inset.clone(),
        inset.clone(),
        inset,
        0..3usize,
        0.3..1.7f64,
    )
        .prop_map(move |(a, b, c, d, kind, depth)| Feature {
            low: [x + a, b],
            high: [x + 2.0 - c, 3.0 - d],
            end: match kind {
                0 => 0.0,
                1 if pocket => 2.0 - depth,
                // Too high to be a pocket of the box.
                _ => 4.2 + depth,
            },
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn the_truth_is_among_the_first_three(
        left in feature(0.0, true),
        right in proptest::option::of(feature(2.0, false)),
        turn in 0.3..0.6f64,
        tilt in -1.1..-0.6f64,
    ) {
        let features: Vec<Feature> = [left].into_iter().chain(right).collect();
        let drawing = seen(block(&features), turn, tilt);
        let graph = Graph::new(&drawing);
        let loops = single_loops(&drawing);
        let truth = edge_sets(&from_truth(&drawing).unwrap().faces);
        let found = group(&Readings::new(&drawing), &graph, &loops);
        let at = found.iter().position(|g| {
            let merged = g.faces.iter().map(|list| {
                let mut edges: Vec<usize> =
                    list.iter().flat_map(|&i| loops[i].edge_set()).collect();
                edges.sort_unstable();
                edges
            });
            merged.collect::<BTreeSet<_>>() == truth
        });
        prop_assert!(at.is_some_and(|k| k < 3), "{at:?} of {}", found.len());
        for g in &found {
            let mut all: Vec<usize> = g.faces.concat();
            all.sort_unstable();
            prop_assert_eq!(all, (0..loops.len()).collect::<Vec<_>>());
            prop_assert!(g.score <= found[0].score);
            prop_assert!(g.sureness.iter().all(|s| (0.0..=1.0 + 1e-9).contains(s)));
        }
    }

    #[test]
    fn faces_do_not_depend_on_numbers_mirror_or_scale(
        which in 0..2usize,
        rotate in 0..24usize,
        mirror in any::<bool>(),
        scale in 0.01..100.0f64,
    ) {
        let drawing = [bracket, holed_cube][which]();
        let find = |d: &Drawing| {
            RotationEngine::default().identify(d, Progress::none()).unwrap().faces
        };
        let n = drawing.edges.len();
        let mut other = drawing.clone();
        other.truth = None;
        let by = rotate % n;
        other.edges.rotate_left(by);
        let map = |p: &mut glam::DVec2| {
            *p *= scale;
            if mirror {
                p.x = -p.x;
            }
        };
        other.vertices.iter_mut().for_each(map);
        other.edges.iter_mut().flat_map(|e| &mut e.points).for_each(map);
        let back: BTreeSet<Vec<usize>> = edge_sets(&find(&other))
            .into_iter()
            .map(|edges| {
                let mut edges: Vec<usize> = edges.into_iter().map(|e| (e + by) % n).collect();
                edges.sort_unstable();
                edges
            })
            .collect();
        prop_assert_eq!(back, edge_sets(&find(&drawing)));
    }
}

#[test]
fn inner_loops_go_round_the_other_way() {
    let drawing = holed_cube();
    let found = RotationEngine::default()
        .identify(&drawing, Progress::none())
        .unwrap();
    let mut used = vec![0; 2 * drawing.edges.len()];
    let area = |walk: &[CoEdge]| {
        let points: Vec<_> = walk
            .iter()
            .map(|c| {
                let points = &drawing.edges[c.edge()].points;
                points[if c.is_reversed() { points.len() - 1 } else { 0 }]
            })
            .collect();
        (0..points.len())
            .map(|i| points[i].perp_dot(points[(i + 1) % points.len()]))
            .sum::<f64>()
    };
    for face in &found.faces {
        for walk in &face.loops[1..] {
            assert!(area(&face.loops[0]) * area(walk) < 0.0);
            assert!(area(&face.loops[0]).abs() > area(walk).abs());
        }
        for c in face.loops.iter().flatten() {
            used[c.index()] += 1;
        }
    }
    assert!(used.iter().all(|&n| n == 1));
    assert_eq!(found.faces.iter().filter(|f| f.loops.len() == 2).count(), 2);
}

#[test]
fn without_directions_loops_stay_alone() {
    let drawing = holed_cube();
    let graph = Graph::new(&drawing);
    assert_eq!(group(&Readings::new(&drawing), &graph, &[]).len(), 1);
    let one = crate::identify::rotation::samples::circle();
    let found = group(&Readings::new(&one), &Graph::new(&one), &[]);
    assert_eq!(found[0].faces, Vec::<Vec<usize>>::new());
}

/// Moves every vertex by a share of the drawing's size to a side of its own.
/// Two chamfers meet in an edge that is drawn parallel to an axis.
#[test]
fn an_edge_that_follows_an_axis_by_chance_does_not_tilt_the_top() {
    let drawing = chamfered();
    let loops = single_loops(&drawing);
    let found = group(&Readings::new(&drawing), &Graph::new(&drawing), &loops);
    let joined: Vec<_> = found[0].faces.iter().filter(|f| f.len() > 1).collect();
    // The top and the pocket's opening.
    assert_eq!(joined, [&[0, 1]]);
}

/// A drafted pocket of five corners in a block: its ends follow no axes.
#[test]
fn a_drafted_pocket_is_in_its_face() {
    let mut corners: Vec<[f64; 3]> = vec![];
    for z in [0.0, 2.0] {
        corners.extend([[0.0, 0.0, z], [4.0, 0.0, z], [4.0, 3.0, z], [0.0, 3.0, z]]);
    }
    for (radius, z) in [(1.0, 2.0), (0.7, 1.1)] {
        let at = |k: u32| glam::DVec2::from_angle(0.3 + 0.4 * PI * f64::from(k)) * radius;
        corners.extend((0..5).map(at).map(|p| [1.7 + p.x, 1.4 + p.y, z]));
    }
    let drawing = polyhedron(
        &corners,
        &[
            &[&[4, 5, 6, 7], &[12, 11, 10, 9, 8]],
            &[&[3, 2, 1, 0]],
            &[&[0, 1, 5, 4]],
            &[&[1, 2, 6, 5]],
            &[&[2, 3, 7, 6]],
            &[&[3, 0, 4, 7]],
            &[&[13, 14, 15, 16, 17]],
            &[&[8, 9, 14, 13]],
            &[&[9, 10, 15, 14]],
            &[&[10, 11, 16, 15]],
            &[&[11, 12, 17, 16]],
            &[&[12, 8, 13, 17]],
        ],
    );
    let loops = single_loops(&drawing);
    let found = group(&Readings::new(&drawing), &Graph::new(&drawing), &loops);
    let joined: Vec<_> = found[0].faces.iter().filter(|f| f.len() > 1).collect();
    assert_eq!(joined, [&[0, 1]]);
}

fn shaken(mut drawing: Drawing, share: f64) -> Drawing {
    let by = share * drawing.size();
    for (i, p) in drawing.vertices.iter_mut().enumerate() {
        *p += glam::DVec2::from_angle(2.4 * (i * i) as f64) * by;
    }
    for edge in &mut drawing.edges {
        edge.points = edge.v.map(|v| drawing.vertices[v]).to_vec();
    }
    drawing
}

/// A hole and a boss.
#[test]
fn loops_of_a_drawing_by_hand_are_grouped() {
    let hole = Feature {
        low: [0.4, 0.6],
        high: [1.5, 2.1],
        end: 0.0,
    };
    let boss = Feature {
        low: [2.4, 0.7],
        high: [3.5, 2.0],
        end: 4.6,
    };
    let exact = seen(block(&[hole, boss]), 0.45, -0.8);
    for share in [0.001, 0.003, 0.005] {
        let drawing = shaken(exact.clone(), share);
        let loops = single_loops(&drawing);
        let truth = edge_sets(&from_truth(&drawing).unwrap().faces);
        let readings = Readings::new(&drawing);
        let found = group(&readings, &Graph::new(&drawing), &loops);
        let merged = found[0].faces.iter().map(|list| {
            let mut edges: Vec<usize> = list.iter().flat_map(|&i| loops[i].edge_set()).collect();
            edges.sort_unstable();
            edges
        });
        assert_eq!(merged.collect::<BTreeSet<_>>(), truth, "{share}");
    }
}
