use proptest::prelude::*;

use super::*;
use crate::Error;
use crate::identify::metrics::DrawingScore;
use crate::identify::testing;

fn find(drawing: &Drawing) -> Result<Identification> {
    VarleyEngine.identify(drawing, Progress::none())
}

fn score(drawing: &Drawing) -> DrawingScore {
    DrawingScore::of(
        drawing.truth.as_ref().unwrap(),
        &find(drawing).unwrap(),
        0.0,
    )
}

fn refusal(drawing: &Drawing) -> IdentifyError {
    match find(drawing) {
        Err(Error::Identify(error)) => error,
        other => panic!("{other:?}"),
    }
}

/// A prism over a regular polygon of `n` corners.
fn regular_prism(n: usize) -> Drawing {
    let turn = std::f64::consts::TAU / n as f64;
    let corners: Vec<[f64; 2]> = (0..n)
        .map(|i| glam::DVec2::from_angle(turn * i as f64).to_array())
        .collect();
    testing::prism(&corners, 0.8)
}

#[test]
fn finds_the_faces_of_simple_solids() {
    use testing::{bracket, cube, tetrahedron, wedge};
    for solid in [
        cube(),
        tetrahedron(),
        wedge(),
        bracket(),
        regular_prism(5),
        regular_prism(12),
    ] {
        assert!(score(&solid).exact(), "{:?}", score(&solid));
        assert!(find(&solid).unwrap().notices.is_empty());
    }
}

#[test]
fn every_coedge_is_used_once() {
    let found = find(&testing::bracket()).unwrap();
    let mut used: Vec<usize> = found
        .faces
        .iter()
        .flat_map(|f| &f.loops)
        .flatten()
        .map(|c| c.index())
        .collect();
    used.sort_unstable();
    assert_eq!(used, (0..36).collect::<Vec<_>>());
}

#[test]
fn a_pyramid_has_a_vertex_of_degree_four() {
    let pyramid = testing::polyhedron(
        &[
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.4, 0.5, 0.9],
        ],
        &[
            &[&[3, 2, 1, 0]],
            &[&[0, 1, 4]],
            &[&[1, 2, 4]],
            &[&[2, 3, 4]],
            &[&[3, 0, 4]],
        ],
    );
    assert!(score(&pyramid).exact());
}

#[test]
fn a_vertex_of_degree_two_is_passed_by_both_faces() {
    let level = |z: f64| {
        [
            [0.0, 0.0, z],
            [0.5, 0.0, z],
            [1.0, 0.0, z],
            [1.0, 1.0, z],
            [0.0, 1.0, z],
        ]
    };
    let corners = [level(0.0), level(1.0)].concat();
    let cube = testing::polyhedron(
        &corners,
        &[
            &[&[4, 3, 2, 1, 0]],
            &[&[5, 6, 7, 8, 9]],
            &[&[0, 1, 2, 7, 6, 5]],
            &[&[2, 3, 8, 7]],
            &[&[3, 4, 9, 8]],
            &[&[4, 0, 5, 9]],
        ],
    );
    assert!(score(&cube).exact(), "{:?}", find(&cube));
}

#[test]
fn a_hole_gives_faces_of_its_own_and_a_notice() {
    let holed = testing::holed_cube();
    let score = score(&holed);
    assert!(score.loops_exact());
    assert_eq!((score.matched, score.predicted), (8, 12));
    let notices = find(&holed).unwrap().notices;
    assert!(
        notices.iter().any(|n| n.contains("2 separate parts")),
        "{notices:?}"
    );
}

#[test]
fn what_it_cannot_do_is_refused_by_number() {
    let mut curved = testing::cube();
    curved.edges[4].curve = crate::drawing::Curve2::Polyline;
    assert!(matches!(
        refusal(&curved),
        IdentifyError::CurvedEdge { edge: 5, .. }
    ));

    let mut dangling = testing::cube();
    dangling.edges.truncate(11);
    dangling.edges.swap_remove(0);
    dangling.edges.truncate(1);
    let expected = dangling.edges[0].v[0];
    let error = refusal(&dangling);
    assert_eq!(
        error,
        IdentifyError::DanglingEdge {
            edge: 1,
            vertex: expected
        }
    );

    let spokes = 33;
    let n = spokes + 1;
    let mut wheel = regular_prism(n);
    wheel.edges.truncate(n);
    for i in 0..spokes {
        let mut spoke = wheel.edges[0].clone();
        spoke.v = [n, i];
        spoke.points = spoke.v.map(|v| wheel.vertices[v]).to_vec();
        wheel.edges.push(spoke);
    }
    let error = refusal(&wheel);
    assert!(
        matches!(
            error,
            IdentifyError::DegreeTooHigh {
                degree: 33,
                limit: 32,
                ..
            }
        ),
        "{error}"
    );
}

#[test]
fn a_flat_polygon_is_no_solid_but_has_its_loop() {
    let mut polygon = testing::cube();
    polygon.edges.truncate(4);
    let found = find(&polygon).unwrap();
    assert_eq!(found.faces.len(), 2, "both sides");
    assert_eq!(found.faces[0].edge_set(), found.faces[1].edge_set());
}

#[test]
fn it_can_be_cancelled() {
    let stop = |_, _| false;
    let found = VarleyEngine.identify(&testing::bracket(), Progress::new(&stop));
    assert_eq!(found, Err(Error::Cancelled));
}

proptest! {
    #[test]
    fn any_graph_gives_closed_loops_or_a_refusal(
        ends in prop::collection::vec((0..9usize, 0..9usize), 1..26),
    ) {
        let mut drawing = regular_prism(5);
        drawing.truth = None;
        let template = drawing.edges[0].clone();
        let vertices = drawing.vertices.clone();
        drawing.edges = ends
            .into_iter()
            .filter(|(u, v)| u != v)
            .map(|(u, v)| {
                let mut edge = template.clone();
                edge.v = [u, v];
                edge.points = vec![vertices[u], vertices[v]];
                edge
            })
            .collect();
        let graph = Graph::new(&drawing);
        if let Ok(found) = find(&drawing) {
            let mut used = vec![false; 2 * graph.edge_count()];
            for walk in found.faces.iter().flat_map(|f| &f.loops) {
                for (i, &c) in walk.iter().enumerate() {
                    prop_assert_eq!(graph.head(c), graph.origin(walk[(i + 1) % walk.len()]));
                    prop_assert!(!std::mem::replace(&mut used[c.index()], true));
                }
            }
        }
    }
}
