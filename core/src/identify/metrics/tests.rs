use proptest::prelude::*;

use super::*;
use crate::drawing::{CoEdge, SurfaceKind, Truth};
use crate::identify::{Candidate, Identification, from_truth, testing};

fn cube() -> (Truth, Identification) {
    let cube = testing::cube();
    let found = from_truth(&cube).unwrap();
    (cube.truth.unwrap(), found)
}

#[test]
fn the_truth_scores_full_marks() {
    let (truth, found) = cube();
    let score = DrawingScore::of(&truth, &found, 2.0);
    assert!(score.exact() && score.exact_top3 && score.loops_exact());
    assert_eq!((score.precision(), score.recall()), (1.0, 1.0));
    let summary = Summary::of(&[score, DrawingScore { ms: 4.0, ..score }]);
    assert_eq!((summary.type_rate, summary.exact), (100.0, 100.0));
    assert_eq!((summary.ms_median, summary.ms_p99), (3.0, 4.0));
}

#[test]
fn a_face_more_and_a_face_less() {
    let (truth, mut found) = cube();
    found.faces.pop();
    let score = DrawingScore::of(&truth, &found, 0.0);
    assert_eq!((score.precision(), score.recall()), (1.0, 5.0 / 6.0));
    assert!(!score.exact() && !score.exact_top3);
    let (_, mut found) = cube();
    found.faces.push(found.faces[0].clone());
    let score = DrawingScore::of(&truth, &found, 0.0);
    assert_eq!((score.precision(), score.recall()), (6.0 / 7.0, 1.0));
    assert!(!score.exact(), "the same face twice is one too many");
}

#[test]
fn types_count_over_matched_faces_only() {
    let (truth, mut found) = cube();
    found.faces[0].kind = SurfaceKind::Cylinder;
    found.faces[1].loops[0].pop();
    found.faces[1].kind = SurfaceKind::Cone;
    let score = DrawingScore::of(&truth, &found, 0.0);
    assert_eq!((score.matched, score.typed, score.surfaced), (5, 4, 4));
    let mut cones = truth.clone();
    cones.faces[2].kind = SurfaceKind::Cone;
    found.faces[2].kind = SurfaceKind::Torus;
    let score = DrawingScore::of(&cones, &found, 0.0);
    assert_eq!(
        (score.typed, score.surfaced),
        (4, 3),
        "cone and torus are both other"
    );
}

#[test]
fn the_truth_may_be_one_of_the_first_three() {
    let (truth, mut found) = cube();
    let right = Candidate {
        faces: found.faces.clone(),
        score: 0.0,
    };
    found.faces.pop();
    let wrong = Candidate {
        faces: found.faces.clone(),
        score: 1.0,
    };
    found.alternatives = vec![wrong.clone(), right.clone()];
    assert!(DrawingScore::of(&truth, &found, 0.0).exact_top3);
    found.alternatives = vec![wrong.clone(), wrong, right];
    assert!(!DrawingScore::of(&truth, &found, 0.0).exact_top3);
}

#[test]
fn loops_are_compared_without_their_grouping() {
    let (mut truth, found) = cube();
    let inner = truth.faces.pop().unwrap().loops.remove(0);
    truth.faces[0].loops.push(inner);
    let score = DrawingScore::of(&truth, &found, 0.0);
    assert!(score.loops_exact() && !score.exact());
    assert_eq!((score.matched, score.faces, score.predicted), (4, 5, 6));
}

#[test]
fn a_refused_drawing_counts_as_zero() {
    let (truth, found) = cube();
    let scores = [
        DrawingScore::of(&truth, &found, 7.0),
        DrawingScore::refused(&truth),
    ];
    let summary: Summary = scores.iter().collect();
    assert_eq!(
        (summary.drawings, summary.refused, summary.faces),
        (2, 1, 12)
    );
    assert_eq!(
        (summary.precision, summary.recall, summary.exact),
        (50.0, 50.0, 50.0)
    );
    assert_eq!((summary.type_rate, summary.ms_median), (100.0, 7.0));
    assert_eq!(Summary::of(&[]), Summary::default());
}

/// Renames the edges of loops and reverses some of them.
fn rename(loops: &mut [Vec<CoEdge>], names: &[usize], reversed: u64) {
    for walk in loops {
        for c in walk.iter_mut() {
            let flip = reversed >> c.edge() & 1 == 1;
            *c = CoEdge::new(names[c.edge()], c.is_reversed() != flip);
        }
    }
}

proptest! {
    #[test]
    fn numbering_edges_and_ordering_faces_changes_nothing(
        names in Just((0..12usize).collect::<Vec<_>>()).prop_shuffle(),
        order in Just((0..6usize).collect::<Vec<_>>()).prop_shuffle(),
        reversed in any::<u64>(),
        dropped in 0..6usize,
        swapped in 0..12usize,
    ) {
        let (truth, mut found) = cube();
        found.faces.remove(dropped);
        found.faces[0].loops[0][0] = CoEdge::new(swapped, false);
        let before = DrawingScore::of(&truth, &found, 1.0);
        let mut renamed = truth.clone();
        renamed.faces = order.iter().map(|&i| truth.faces[i].clone()).collect();
        for face in &mut renamed.faces {
            rename(&mut face.loops, &names, reversed);
        }
        for face in &mut found.faces {
            rename(&mut face.loops, &names, reversed);
        }
        found.faces.rotate_left(order[0] % 5);
        prop_assert_eq!(DrawingScore::of(&renamed, &found, 1.0), before);
    }
}
