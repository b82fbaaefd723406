use glam::DVec2;

use super::super::dataset::Drawings;
use super::super::{Curve2, Drawing, Edge, Finding, FindingKind, Limits, Projection, Severity};
use super::diagnose;

/// A drawing of straight edges between vertices.
fn drawing(vertices: &[(f64, f64)], edges: &[[usize; 2]]) -> Drawing {
    let vertices: Vec<DVec2> = vertices.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
    let edges = edges.iter().map(|&v| Edge {
        v,
        points: v.map(|v| vertices[v]).to_vec(),
        curve: Curve2::Line,
    });
    let drawing = Drawing {
        id: String::new(),
        source: String::new(),
        projection: Projection::default(),
        edges: edges.collect(),
        vertices,
        truth: None,
    };
    drawing.check(&Limits::default()).unwrap();
    drawing
}

/// A tetrahedron, which has nothing to be said about, and more vertices and edges.
fn with_tetrahedron(vertices: &[(f64, f64)], edges: &[[usize; 2]]) -> Drawing {
    let mut all = vec![(0.0, 0.0), (4.0, 0.3), (1.7, 3.1), (1.9, 1.2)];
    all.extend(vertices);
    let mut list = vec![[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
    list.extend(edges);
    drawing(&all, &list)
}

fn of(kind: FindingKind, findings: Vec<Finding>) -> Vec<Finding> {
    findings.into_iter().filter(|f| f.kind == kind).collect()
}

#[test]
fn a_sound_drawing_has_no_findings() {
    assert_eq!(diagnose(&with_tetrahedron(&[], &[])), []);
}

#[test]
fn dangling_edges_are_errors_that_name_edge_and_place() {
    let d = with_tetrahedron(&[(5.0, 3.0)], &[[1, 4]]);
    let findings = diagnose(&d);
    assert_eq!(findings[0].kind, FindingKind::Dangling);
    assert_eq!(findings[0].severity, Severity::Error);
    assert_eq!(findings[0].edges, [6]);
    assert_eq!(findings[0].vertices, [4]);
    assert_eq!(findings[0].points, [DVec2::new(5.0, 3.0)]);
    assert!(findings[0].message.contains("edge 7"));
    // An edge that hangs at both ends has a finding for each.
    let loose = diagnose(&drawing(&[(0.0, 0.0), (1.0, 0.0)], &[[0, 1]]));
    assert_eq!(of(FindingKind::Dangling, loose).len(), 2);
}

#[test]
fn vertices_of_two_edges_are_notices() {
    let d = with_tetrahedron(&[(6.0, 2.0)], &[[1, 4], [4, 2]]);
    let found = of(FindingKind::DegreeTwo, diagnose(&d));
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].severity, Severity::Notice);
    assert_eq!(found[0].edges, [6, 7]);
    assert_eq!(found[0].vertices, [4]);
}

#[test]
fn an_end_on_the_inside_of_an_edge_is_a_t_junction() {
    let d = with_tetrahedron(&[(2.0, 0.15 + 1e-5)], &[[2, 4]]);
    let found = of(FindingKind::TJunction, diagnose(&d));
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].severity, Severity::Warning);
    assert_eq!(found[0].edges, [0, 6]);
    assert!(found[0].message.contains("edge 1") && found[0].message.contains("edge 7"));
    // A complete vertex so near is an accident of the projection, and only exactly there doubtful.
    let near = |y: f64| {
        let d = with_tetrahedron(&[(2.0, y), (3.0, -1.0)], &[[2, 4], [3, 4], [4, 5], [0, 5]]);
        of(FindingKind::TJunction, diagnose(&d)).len()
    };
    assert_eq!(near(0.15 + 1e-4), 0);
    assert_eq!(near(0.15), 1);
}

#[test]
fn crowded_vertices_are_warned_of() {
    let ends: Vec<(f64, f64)> = (0..9).map(|i| (f64::from(i), 9.0)).collect();
    let fan: Vec<[usize; 2]> = (1..10).map(|i| [0, i]).collect();
    let rim: Vec<[usize; 2]> = (1..9).map(|i| [i, i + 1]).collect();
    let d = drawing(&[vec![(4.0, 0.0)], ends].concat(), &[fan, rim].concat());
    let found = of(FindingKind::HighDegree, diagnose(&d));
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].vertices, [0]);
    assert!(found[0].message.contains("9 edges"));
}

#[test]
fn edges_on_each_other_are_told_once() {
    // Twins, and an edge that ends on another one along it.
    let d = with_tetrahedron(
        &[(2.0, 0.15), (6.0, 0.45), (5.0, 4.0)],
        &[[0, 1], [4, 5], [4, 6], [5, 6], [4, 2], [5, 2], [6, 3]],
    );
    let found = of(FindingKind::Overlap, diagnose(&d));
    let edges: Vec<_> = found.iter().map(|f| f.edges.clone()).collect();
    assert_eq!(edges, [[0, 7], [6, 7], [0, 6]]);
}

#[test]
fn parts_within_the_outline_are_noticed_and_parts_outside_warned_of() {
    let square = |x: f64, y: f64| [(x, y), (x + 0.1, y), (x + 0.1, y + 0.1), (x, y + 0.1)];
    let ring = [[4, 5], [5, 6], [6, 7], [7, 4]];
    let inside = of(
        FindingKind::IsolatedPart,
        diagnose(&with_tetrahedron(&square(2.0, 0.6), &ring)),
    );
    assert_eq!(inside.len(), 1);
    assert_eq!(inside[0].severity, Severity::Notice);
    assert_eq!(inside[0].edges, [6, 7, 8, 9]);
    let outside = of(
        FindingKind::IsolatedPart,
        diagnose(&with_tetrahedron(&square(9.0, 0.6), &ring)),
    );
    assert_eq!(outside.len(), 1);
    assert_eq!(outside[0].severity, Severity::Warning);
    assert_eq!(outside[0].edges, [6, 7, 8, 9]);
}

/// Real drawings hardly ever raise a warning, and never an error.
#[test]
fn corpus_drawings_are_sound() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../tests/corpus/sample.jsonl.zst"
    );
    let mut warned = 0;
    for d in Drawings::open(path).unwrap() {
        let findings = diagnose(&d.unwrap());
        assert!(findings.iter().all(|f| f.severity != Severity::Error));
        warned += usize::from(findings.iter().any(|f| f.severity == Severity::Warning));
    }
    assert!(warned <= 3, "{warned}");
}
