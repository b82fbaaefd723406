//! What clean-up does to small drawings, one rule at a time.

use std::f64::consts::{PI, TAU};

use glam::DVec2;
use proptest::prelude::*;

use super::super::{Curve2, DrawingError, FindingKind, Limits, Severity, read};
use super::restore::cleaned;
use super::{CleanDrawing, CleanOptions, clean};

/// Hidden-line projections that FreeCAD made: each file says what clean-up must make of it.
#[test]
fn freecad_projections_become_the_wireframes_of_their_solids() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/corpus/freecad");
    let mut files = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "json") {
            continue;
        }
        files += 1;
        let text = std::fs::read_to_string(&path).unwrap();
        let expected = &serde_json::from_str::<serde_json::Value>(&text).unwrap()["expected"];
        let c = read(&text, &Limits::default()).unwrap();
        let straight = c.drawing.edges.iter().filter(|e| e.is_straight()).count();
        let found = [c.drawing.vertices.len(), c.drawing.edges.len(), straight];
        let wanted =
            ["vertices", "edges", "straight"].map(|k| expected[k].as_u64().unwrap() as usize);
        assert_eq!(found, wanted, "{}: {:#?}", path.display(), c.report);
        assert!(!c.report.has_errors(), "{}", path.display());
        let mut sources: Vec<usize> = c.sources.concat();
        sources.sort_unstable();
        sources.dedup();
        let inputs = serde_json::from_str::<serde_json::Value>(&text).unwrap()["edges"]
            .as_array()
            .unwrap()
            .len();
        assert_eq!(sources.len(), inputs, "{}", path.display());
    }
    assert_eq!(files, 16);
}

fn line(points: &[(f64, f64)]) -> Vec<DVec2> {
    points.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
}

/// Points of an arc of an ellipse around (x, y), level axes a and b, from angle s to e.
fn arc([x, y, a, b, s, e]: [f64; 6]) -> Vec<DVec2> {
    (0..=24)
        .map(|i| s + (e - s) * f64::from(i) / 24.0)
        .map(|t| DVec2::new(x + a * t.cos(), y + b * t.sin()))
        .collect()
}

fn kinds(c: &CleanDrawing) -> Vec<(Severity, FindingKind, Vec<usize>)> {
    let findings = c.report.findings.iter();
    findings
        .map(|f| (f.severity, f.kind, f.edges.clone()))
        .collect()
}

/// A standing cylinder as a user draws it: two whole ellipses and two lines that touch them.
#[test]
fn silhouettes_cut_the_ellipses_that_they_end_on() {
    let c = cleaned(&[
        arc([0.0, 0.0, 1.0, 0.4, 1.0, 1.0 + TAU]),
        arc([0.0, 2.0, 1.0, 0.4, 1.0, 1.0 + TAU]),
        line(&[(1.00002, 0.0), (1.0, 2.00003)]),
        line(&[(-1.0, 2.0), (-1.0, -0.00002)]),
    ]);
    assert_eq!((c.drawing.vertices.len(), c.drawing.edges.len()), (4, 6));
    let mut sources = c.sources.clone();
    sources.sort();
    assert_eq!(
        sources,
        [vec![0], vec![0], vec![1], vec![1], vec![2], vec![3]]
    );
    for e in &c.drawing.edges {
        match e.curve {
            Curve2::Line => assert!((e.length() - 2.0).abs() < 1e-4),
            Curve2::Ellipse(arc) => {
                assert!((arc.sweep.abs() - PI).abs() < 1e-3, "{arc:?}");
                assert!((arc.major.length() - 1.0).abs() < 1e-4);
                assert!((arc.ratio - 0.4).abs() < 1e-4);
            }
            Curve2::Polyline => panic!("{e:?}"),
        }
    }
    for cut in [0, 1] {
        for end in [2, 3] {
            assert!(kinds(&c).contains(&(Severity::Notice, FindingKind::Split, vec![cut, end])));
        }
    }
    assert!(!c.report.has_errors());
}

#[test]
fn crossing_edges_do_not_meet() {
    let c = cleaned(&[
        line(&[(0.0, 0.0), (1.0, 1.0)]),
        line(&[(0.0, 1.0), (1.0, 0.0)]),
    ]);
    assert_eq!((c.drawing.vertices.len(), c.drawing.edges.len()), (4, 2));
    assert_eq!(
        kinds(&c)
            .iter()
            .filter(|k| k.1 == FindingKind::Dangling)
            .count(),
        4
    );
    assert!(c.report.has_errors());
}

#[test]
fn a_cut_where_another_edge_crosses_vanishes_and_cuts_nothing() {
    let c = cleaned(&[
        line(&[(0.0, 0.0), (0.5, 0.5)]),
        line(&[(0.5, 0.5), (1.0, 1.0)]),
        line(&[(0.0, 1.0), (1.0, 0.0)]),
    ]);
    assert_eq!((c.drawing.vertices.len(), c.drawing.edges.len()), (4, 2));
    assert!(kinds(&c).contains(&(Severity::Notice, FindingKind::Joined, vec![0, 1])));
}

#[test]
fn edges_without_length_are_left_out_and_reported() {
    let mut edges = vec![
        line(&[(0.0, 0.0), (1.0, 0.0)]),
        line(&[(0.3, 0.3), (0.3, 0.3)]),
        line(&[(1.0, 0.0), (0.0, 1.0)]),
        line(&[(0.0, 1.0), (0.0, 0.0)]),
        line(&[(0.2, 0.2)]),
        vec![],
    ];
    let c = cleaned(&edges);
    assert_eq!(c.sources, [[0], [2], [3]]);
    for e in [1, 4, 5] {
        assert!(kinds(&c).contains(&(Severity::Notice, FindingKind::ZeroLength, vec![e])));
    }
    edges.drain(..1);
    edges.drain(1..3);
    let nothing = clean(&edges, &CleanOptions::default(), &Limits::default());
    assert_eq!(nothing, Err(DrawingError::ZeroLength { edge: 1 }));
}

#[test]
fn whole_circles_stay_whole_and_pieces_of_one_become_whole() {
    for pieces in [
        vec![[0.0, TAU]],
        vec![[0.0, 2.0], [2.0, TAU]],
        vec![[5.0, 4.0], [0.3, 4.0], [5.0, TAU + 0.3]],
    ] {
        let polylines: Vec<Vec<DVec2>> = pieces
            .iter()
            .map(|[s, e]| arc([3.0, 1.0, 2.0, 2.0, *s, *e]))
            .collect();
        let c = cleaned(&polylines);
        assert_eq!((c.drawing.vertices.len(), c.drawing.edges.len()), (1, 1));
        let Curve2::Ellipse(arc) = c.drawing.edges[0].curve else {
            panic!("{:?}", c.drawing.edges[0])
        };
        assert_eq!(arc.sweep.abs(), TAU);
        assert!(arc.center.distance(DVec2::new(3.0, 1.0)) < 1e-9);
        assert_eq!(c.sources[0].len(), pieces.len());
        assert!(!c.report.has_errors());
    }
}

#[test]
fn gaps_are_closed_up_to_the_tolerance_and_no_farther() {
    let triangle = |gap: f64| {
        cleaned(&[
            line(&[(0.0, 0.0), (1.0, 0.0)]),
            line(&[(1.0, gap), (0.0, 1.0)]),
            line(&[(0.0, 1.0), (0.0, 0.0)]),
        ])
    };
    // The size is half the diagonal, 0.707.
    let closed = triangle(1.2e-4);
    assert_eq!(closed.drawing.vertices.len(), 3);
    assert!(kinds(&closed).contains(&(Severity::Notice, FindingKind::Snapped, vec![0, 1])));
    let open = triangle(2e-4);
    assert_eq!(open.drawing.vertices.len(), 4);
    assert!(kinds(&open).contains(&(Severity::Error, FindingKind::Dangling, vec![0])));
    assert!(kinds(&open).contains(&(Severity::Error, FindingKind::Dangling, vec![1])));
}

/// A cube's wireframe, every end off by up to `off` to a side of its own.
fn cube_by_hand(off: f64) -> Vec<Vec<DVec2>> {
    let corner = |i: usize| {
        let [x, y, z] = [0, 1, 2].map(|k| f64::from((i >> k) as u32 & 1));
        DVec2::new(0.9 * x - 0.4 * y, 0.3 * x + 0.5 * y + 0.8 * z)
    };
    let mut turn = 0.0;
    let mut by = || {
        turn += 2.4;
        DVec2::from_angle(turn) * off
    };
    let pairs = (0..8).flat_map(|i| (0..3).map(move |k| (i, i | 1 << k)));
    pairs
        .filter(|(i, j)| i != j)
        .map(|(i, j)| vec![corner(i) + by(), corner(j) + by()])
        .collect()
}

#[test]
fn ends_by_hand_are_gathered_into_vertices() {
    for off in [1e-3, 2.5e-3] {
        let c = cleaned(&cube_by_hand(off));
        assert_eq!((c.drawing.vertices.len(), c.drawing.edges.len()), (8, 12));
        assert!(!c.report.has_errors(), "{:?}", c.report);
        assert!(c.sources.iter().all(|s| s.len() == 1));
        assert!(kinds(&c).iter().any(|k| k.1 == FindingKind::Snapped));
    }
    // So far apart they are no ends of one edge.
    assert!(cleaned(&cube_by_hand(2e-2)).report.has_errors());
}

#[test]
fn a_short_edge_by_hand_stays_an_edge() {
    let mut edges = cube_by_hand(1.5e-3);
    let tip = edges[0][0];
    edges[0][0] = tip + DVec2::new(0.004, -0.007);
    edges.push(line(&[(tip.x, tip.y), (tip.x + 0.005, tip.y - 0.008)]));
    let c = cleaned(&edges);
    assert_eq!((c.drawing.vertices.len(), c.drawing.edges.len()), (9, 13));
}

#[test]
fn true_corners_of_two_edges_are_kept() {
    let c = cleaned(&[
        line(&[(0.0, 0.0), (1.0, 0.0)]),
        line(&[(1.0, 0.0), (2.0, 0.02)]),
        arc([2.0, 1.02, 1.0, 1.0, -PI / 2.0, PI / 2.0]),
        line(&[(2.0, 2.02), (0.0, 0.0)]),
    ]);
    assert_eq!((c.drawing.vertices.len(), c.drawing.edges.len()), (4, 4));
}

#[test]
fn twins_become_one_whichever_way_they_are_drawn() {
    let mut bow = arc([0.0, 0.0, 1.0, 0.6, 0.2, 2.6]);
    let c = cleaned(&[
        bow.clone(),
        line(&[bow[0].into(), bow[24].into()]),
        line(&[bow[24].into(), bow[0].into()]),
        {
            bow.reverse();
            bow
        },
    ]);
    assert_eq!(c.sources, [[0, 3], [1, 2]]);
    assert!(kinds(&c).contains(&(Severity::Notice, FindingKind::Duplicate, vec![0, 3])));
}

#[test]
fn overlapping_collinear_edges_become_one() {
    let c = cleaned(&[
        line(&[(0.0, 0.0), (2.0, 0.0)]),
        line(&[(1.0, 0.0), (3.0, 0.0)]),
        line(&[(2.5, 0.0), (0.5, 0.0)]),
        line(&[(3.0, 0.0), (0.0, 1.0)]),
        line(&[(0.0, 1.0), (0.0, 0.0)]),
    ]);
    assert_eq!((c.drawing.vertices.len(), c.drawing.edges.len()), (3, 3));
    assert!(c.sources.contains(&vec![0, 1, 2]));
}

#[test]
fn findings_name_the_input_edges() {
    let text = r#"{"edges": [
        {"name": "Edge7", "points": [[0, 0], [1, 0]], "hidden": true},
        {"name": "Edge9", "points": [[1, 0], [1, 1]]}, [[1, 1], [0, 0.5]]]}"#;
    let c = read(text, &Limits::default()).unwrap();
    let dangling: Vec<_> = c
        .report
        .findings
        .iter()
        .filter(|f| f.kind == FindingKind::Dangling)
        .collect();
    assert!(
        dangling
            .iter()
            .any(|f| f.message.contains("Edge7") && f.edges == [0])
    );
    assert!(
        dangling
            .iter()
            .any(|f| f.message.contains("edge 3") && f.edges == [2])
    );
    assert!(
        dangling
            .iter()
            .all(|f| f.vertices.len() == 1 && f.points.len() == 1)
    );
}

#[test]
fn thousands_of_edges_take_less_than_seconds() {
    let mut edges = Vec::new();
    let n = 30;
    for i in 0..n {
        for j in 0..n {
            let (x, y) = (f64::from(i), f64::from(j));
            edges.push(line(&[(x, y), (x + 1.0, y + 0.1)]));
            edges.push(line(&[(x, y), (x + 0.1, y + 1.0)]));
            edges.push(arc([x, y, 0.6, 0.3, 0.0, 3.0]));
        }
    }
    let hatch: Vec<_> = (0..5000)
        .map(|i| line(&[(0.0, 0.0), (1.0 + f64::from(i), 0.0)]))
        .collect();
    let star: Vec<_> = (0..5000)
        .map(|i| line(&[(0.0, 0.0), (f64::from(i).cos(), f64::from(i).sin())]))
        .collect();
    let chain: Vec<_> = (0..5000)
        .map(|i| line(&[(f64::from(i), 0.0), (f64::from(i) + 1.0, 0.0)]))
        .collect();
    for (name, edges) in [
        ("grid", edges),
        ("hatch", hatch),
        ("star", star),
        ("chain", chain),
    ] {
        let start = std::time::Instant::now();
        let result = clean(&edges, &CleanOptions::default(), &Limits::default());
        let time = start.elapsed();
        println!(
            "{name}: {} edges, {time:?}, {}",
            edges.len(),
            result.is_ok()
        );
        assert!(time.as_secs() < 10, "{name}: {time:?}");
    }
}

proptest! {
    #[test]
    fn any_edge_list_is_cleaned_or_refused(
        list in prop::collection::vec(
            prop::collection::vec(prop::array::uniform2(0i8..6), 0..5), 0..30)
    ) {
        let list: Vec<Vec<DVec2>> = list
            .iter()
            .map(|l| l.iter().map(|p| DVec2::new(f64::from(p[0]), f64::from(p[1]))).collect())
            .collect();
        if let Ok(c) = clean(&list, &CleanOptions::default(), &Limits::default()) {
            prop_assert!(c.drawing.check(&Limits::default()).is_ok());
            prop_assert_eq!(c.sources.len(), c.drawing.edges.len());
            // Every input edge is in the drawing or reported.
            for (i, _) in list.iter().enumerate() {
                let used = c.sources.iter().flatten().any(|&s| s == i);
                let told = c.report.findings.iter().any(|f| f.edges.contains(&i));
                prop_assert!(used || told);
            }
        }
    }
}

/// Exporters repeat points; they say nothing of a curve's direction.
#[test]
fn repeated_points_change_nothing() {
    // Half a wave: smooth, and no ellipse.
    let wave: Vec<DVec2> = (0..=40)
        .map(|i| f64::from(i) / 40.0)
        .map(|x| DVec2::new(x, 0.3 * (3.0 * x).sin()))
        .collect();
    let back = line(&[(1.0, wave[40].y), (0.5, -1.0), (0.0, 0.0)]);
    let once = vec![
        wave[..=20].to_vec(),
        wave[20..].to_vec(),
        back[..2].to_vec(),
        back[1..].to_vec(),
    ];
    let doubled: Vec<Vec<DVec2>> = once
        .iter()
        .map(|l| l.iter().flat_map(|p| [*p, *p]).collect())
        .collect();
    let (a, b) = (cleaned(&once), cleaned(&doubled));
    assert_eq!(a.sources, b.sources);
    assert_eq!(a.sources, [vec![0, 1], vec![2], vec![3]]);
    assert_eq!(a.drawing.edges[0].points, b.drawing.edges[0].points);
}
