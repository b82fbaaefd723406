use super::*;
use crate::drawing::Edge;
use crate::identify::rotation::samples;

fn inputs(drawing: &Drawing) -> Inputs {
    let graph = Graph::new(drawing);
    Inputs::new(drawing, &graph, &Triples::new(&graph))
}

#[test]
fn tables_have_the_documented_shapes() {
    for drawing in [
        samples::cube(),
        samples::pyramid(),
        samples::circle(),
        samples::two_arcs(),
    ] {
        let graph = Graph::new(&drawing);
        let triples = Triples::new(&graph);
        let x = Inputs::new(&drawing, &graph, &triples);
        let (edges, corners) = (drawing.edges.len(), x.corner_edges.len());
        assert_eq!(x.edges.len(), edges * EDGE);
        assert_eq!(x.corners.len(), corners * CORNER);
        assert_eq!(x.triples.len(), triples.len() * TRIPLE);
        assert_eq!(x.triple_corners.len(), triples.len());
        assert_eq!(x.relations.len(), edges * edges);
        for (t, pair) in x.triple_corners.iter().enumerate() {
            let middle = pair.map(|c| x.corner_edges[c as usize][1] as usize);
            assert_eq!(middle, [triples.edge(t); 2]);
            let outer = pair.map(|c| x.corner_edges[c as usize][0] as usize);
            assert_eq!(outer, [triples.before(t).edge(), triples.after(t).edge()]);
        }
    }
}

#[test]
fn walking_edges_the_other_way_changes_nothing() {
    for mut drawing in [samples::cube(), samples::two_arcs()] {
        let before = inputs(&drawing);
        for edge in &mut drawing.edges {
            edge.v.swap(0, 1);
            edge.points.reverse();
            if !edge.is_straight() {
                edge.curve = crate::drawing::Curve2::recognise(&edge.points);
            }
        }
        let after = inputs(&drawing);
        for (a, b) in before.edges.iter().zip(&after.edges) {
            assert!((a - b).abs() < 1e-4, "{a} {b}");
        }
        assert_eq!(before.relations, after.relations);
        let total = |x: &Inputs| x.corners.iter().sum::<f32>();
        assert!((total(&before) - total(&after)).abs() < 1e-2);
    }
}

#[test]
fn relations_of_a_cube_are_known() {
    let x = inputs(&samples::cube());
    let count = |r: Relation| {
        let bit = 1u16 << r as u16;
        x.relations.iter().filter(|&&bits| bits & bit != 0).count()
    };
    assert_eq!(count(Relation::Same), 12);
    assert_eq!(count(Relation::Adjacent), 12 * 4);
    assert_eq!(count(Relation::Parallel), 12 * 3);
    assert_eq!(count(Relation::Congruent), 12 * 3);
    // Each edge is on two squares of three other edges.
    assert_eq!(count(Relation::Cycle), 12 * 6);
    assert_eq!(count(Relation::Apart), 0);
}

#[test]
fn a_drawing_without_extent_gives_finite_numbers() {
    let mut drawing = samples::cube();
    for v in &mut drawing.vertices {
        *v = glam::DVec2::ONE;
    }
    for Edge { points, .. } in &mut drawing.edges {
        points.fill(glam::DVec2::ONE);
    }
    let x = inputs(&drawing);
    let all = x.edges.iter().chain(&x.corners).chain(&x.triples);
    assert!(all.into_iter().all(|x| x.is_finite()));
}
