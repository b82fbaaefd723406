//! The paper's post-processing of independent predictions (section 4.2), for engines that predict
//! one face from each start.
//!
//! 1. Predictions that are no closed walks are removed.
//! 2. Predictions that use an edge twice, so also both co-edges of an edge, are removed.
//! 3. Predictions with the same set of edges are merged; the type of most votes wins.
//!
//! The paper leaves ties open: the type that comes first in [`SurfaceKind`] wins, so that the
//! result does not depend on the order of the votes. Of merged predictions the first one gives the
//! loops, and faces keep the order of their first predictions.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use super::{Evidence, Face};
use crate::drawing::{CoEdge, Graph, SurfaceKind};

/// One predicted face.
#[derive(Debug, Clone, PartialEq)]
pub struct Prediction {
    /// Predicted surface kind.
    pub kind: SurfaceKind,
    /// Its co-edges as predicted, one loop after the other. Only the first loop must be in walking
    /// order; the paper sorts the co-edges of the others.
    pub coedges: Vec<CoEdge>,
    /// How many starts gave this prediction.
    pub votes: usize,
}

/// What is left of the predictions, and what was removed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Processed {
    /// Distinct faces. A face's votes are the starts that led to it; its confidence is their
    /// number over that of its co-edges, each of which should have led to it, at most 1.
    pub faces: Vec<Face>,
    /// Votes removed by step 1.
    pub unclosed: usize,
    /// Votes removed by step 2.
    pub doubled: usize,
}

/// Turns predictions into distinct, closed faces.
pub fn postprocess(graph: &Graph, predictions: &[Prediction]) -> Processed {
    let mut done = Processed::default();
    let mut known: HashMap<Vec<usize>, usize> = HashMap::new();
    let mut kinds: Vec<[usize; SurfaceKind::ALL.len()]> = Vec::new();
    for prediction in predictions {
        let coedges = &prediction.coedges;
        if !is_closed(graph, coedges) {
            done.unclosed += prediction.votes;
            continue;
        }
        let mut edges: Vec<usize> = coedges.iter().map(|c| c.edge()).collect();
        edges.sort_unstable();
        if edges.windows(2).any(|w| w[0] == w[1]) {
            done.doubled += prediction.votes;
            continue;
        }
        let face = match known.entry(edges) {
            Entry::Occupied(entry) => *entry.get(),
            Entry::Vacant(entry) => {
                done.faces.push(Face {
                    kind: prediction.kind,
                    loops: split_loops(graph, coedges),
                    confidence: 0.0,
                    evidence: Evidence::default(),
                });
                kinds.push([0; SurfaceKind::ALL.len()]);
                *entry.insert(done.faces.len() - 1)
            }
        };
        done.faces[face].evidence.votes += prediction.votes;
        kinds[face][prediction.kind as usize] += prediction.votes;
    }
    for (face, kinds) in done.faces.iter_mut().zip(&kinds) {
        let most = kinds.iter().copied().max();
        let winner = SurfaceKind::ALL
            .into_iter()
            .find(|&kind| Some(kinds[kind as usize]) == most);
        face.kind = winner.unwrap_or(face.kind);
        let size: usize = face.loops.iter().map(Vec::len).sum();
        face.confidence = (face.evidence.votes as f64 / size as f64).min(1.0);
    }
    done
}

/// Whether the co-edges, in some order, are closed walks: each vertex is entered as often as left.
fn is_closed(graph: &Graph, coedges: &[CoEdge]) -> bool {
    if coedges.is_empty() || coedges.iter().any(|c| c.edge() >= graph.edge_count()) {
        return false;
    }
    let mut heads: Vec<usize> = coedges.iter().map(|&c| graph.head(c)).collect();
    let mut origins: Vec<usize> = coedges.iter().map(|&c| graph.origin(c)).collect();
    heads.sort_unstable();
    origins.sort_unstable();
    heads == origins
}

/// Cuts closed co-edges into loops: a walk goes on with the next co-edge of the sequence where
/// that fits, else with the first unused one that does, and ends back at its first vertex.
fn split_loops(graph: &Graph, coedges: &[CoEdge]) -> Vec<Vec<CoEdge>> {
    let mut used = vec![false; coedges.len()];
    let mut loops = Vec::new();
    for first in 0..coedges.len() {
        if used[first] {
            continue;
        }
        let start = graph.origin(coedges[first]);
        let mut walk = Vec::new();
        let mut next = Some(first);
        while let Some(i) = next {
            used[i] = true;
            walk.push(coedges[i]);
            let at = graph.head(coedges[i]);
            let fits = |&j: &usize| !used[j] && graph.origin(coedges[j]) == at;
            next = if at == start {
                None
            } else {
                (i + 1..coedges.len()).chain(0..i).find(fits)
            };
        }
        loops.push(walk);
    }
    loops
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::{from_truth, testing};
    use super::*;

    fn walk(numbers: &[i64]) -> Vec<CoEdge> {
        numbers
            .iter()
            .map(|&k| CoEdge::from_signed(k).unwrap())
            .collect()
    }

    fn prediction(kind: SurfaceKind, coedges: Vec<CoEdge>) -> Prediction {
        Prediction {
            kind,
            coedges,
            votes: 1,
        }
    }

    #[test]
    fn each_step_removes_its_own() {
        let graph = Graph::new(&testing::cube());
        let face = from_truth(&testing::cube())
            .unwrap()
            .faces
            .remove(0)
            .loops
            .remove(0);
        let open = face[..3].to_vec();
        let there_and_back = vec![face[0], face[0].mate()];
        let beyond = walk(&[13]);
        let predictions = [open, there_and_back, beyond, Vec::new(), face.clone()]
            .map(|coedges| prediction(SurfaceKind::Plane, coedges));
        let done = postprocess(&graph, &predictions);
        assert_eq!((done.unclosed, done.doubled), (3, 1));
        assert_eq!(done.faces.len(), 1);
        assert_eq!(done.faces[0].loops, [face]);
        assert_eq!(done.faces[0].confidence, 0.25);
    }

    #[test]
    fn most_votes_give_the_type_and_the_first_kind_wins_a_tie() {
        let graph = Graph::new(&testing::cube());
        let face = from_truth(&testing::cube())
            .unwrap()
            .faces
            .remove(0)
            .loops
            .remove(0);
        let kinds_to_winner = |kinds: &[SurfaceKind]| {
            let mut coedges = face.clone();
            let predictions: Vec<Prediction> = kinds
                .iter()
                .map(|&kind| {
                    coedges.rotate_left(1);
                    prediction(kind, coedges.clone())
                })
                .collect();
            let done = postprocess(&graph, &predictions);
            assert_eq!(done.faces.len(), 1);
            assert_eq!(done.faces[0].evidence.votes, kinds.len());
            done.faces[0].kind
        };
        use SurfaceKind::{Cone, Cylinder, Plane};
        assert_eq!(kinds_to_winner(&[Plane, Cone, Cone]), Cone);
        assert_eq!(kinds_to_winner(&[Cone, Cylinder]), Cylinder);
        assert_eq!(
            kinds_to_winner(&[Plane, Plane, Cone, Cone, Cylinder]),
            Plane
        );
    }

    #[test]
    fn a_sorted_inner_loop_is_put_in_walking_order() {
        let drawing = testing::cube();
        let graph = Graph::new(&drawing);
        let faces = from_truth(&drawing).unwrap().faces;
        let outer = faces[0].loops[0].clone();
        let inner = faces[1].loops[0].clone();
        let mut sequence = outer.clone();
        sequence.extend([inner[0], inner[2], inner[1], inner[3]]);
        let done = postprocess(&graph, &[prediction(SurfaceKind::Plane, sequence)]);
        assert_eq!(done.faces[0].loops, [outer, inner]);
    }

    proptest! {
        #[test]
        fn it_is_idempotent_and_gives_valid_distinct_faces(
            sequences in prop::collection::vec(
                (prop::collection::vec(0..24usize, 1..7), 0..6usize, 1..4usize), 0..12),
            copies in prop::collection::vec((0..6usize, 0..4usize, 0..6usize), 0..24),
        ) {
            let drawing = testing::cube();
            let graph = Graph::new(&drawing);
            let faces = from_truth(&drawing).unwrap().faces;
            let random = sequences.into_iter().map(|(indices, kind, votes)| Prediction {
                kind: SurfaceKind::ALL[kind],
                coedges: indices.into_iter().map(CoEdge::from_index).collect(),
                votes,
            });
            let rotated = copies.into_iter().map(|(face, by, kind)| {
                let mut coedges = faces[face].loops[0].clone();
                coedges.rotate_left(by);
                prediction(SurfaceKind::ALL[kind], coedges)
            });
            let predictions: Vec<Prediction> = random.chain(rotated).collect();
            let once = postprocess(&graph, &predictions);

            let votes: usize = predictions.iter().map(|p| p.votes).sum();
            let kept: usize = once.faces.iter().map(|f| f.evidence.votes).sum();
            prop_assert_eq!(votes, kept + once.unclosed + once.doubled);
            let mut sets: Vec<_> = once.faces.iter().map(Face::edge_set).collect();
            sets.sort();
            sets.dedup();
            prop_assert_eq!(sets.len(), once.faces.len());
            for walk in once.faces.iter().flat_map(|f| &f.loops) {
                for (i, &c) in walk.iter().enumerate() {
                    prop_assert_eq!(graph.head(c), graph.origin(walk[(i + 1) % walk.len()]));
                }
            }

            let again: Vec<Prediction> = once.faces.iter().map(|face| Prediction {
                kind: face.kind,
                coedges: face.loops.concat(),
                votes: face.evidence.votes,
            }).collect();
            let twice = postprocess(&graph, &again);
            prop_assert_eq!(twice.faces, once.faces);
            prop_assert_eq!((twice.unclosed, twice.doubled), (0, 0));
        }
    }
}
