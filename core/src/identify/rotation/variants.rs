//! Other readings of a drawing's loops, near the best one.

use std::collections::BTreeSet;

use super::reading::Doubts;
use super::{Field, RotationSystem};
use crate::drawing::Graph;

/// Loss of total score up to which a reading is given, log-odds.
const WORST: f64 = 6.0;

/// Most readings given beside the best one.
const MOST: usize = 4;

/// Rounds in which the neighbours of a changed vertex are settled.
const ROUNDS: usize = 8;

/// A rotation system and what it loses against the best one, log-odds.
pub(super) struct Variant {
    pub(super) system: RotationSystem,
    pub(super) loss: f64,
}

/// The system itself and the likeliest others: each with the second best order at one vertex, its
/// neighbours settled anew, or with a part of a component turned over.
pub(super) fn variants(
    field: &Field<'_>,
    system: RotationSystem,
    doubts: &Doubts<'_>,
) -> Vec<Variant> {
    let graph = field.graph();
    let total = field.total(&system);
    let every = vec![true; graph.vertex_count()];
    let mut others: Vec<Variant> = Vec::new();
    let mut push = |other: RotationSystem| {
        let loss = (total - field.total(&other)).max(0.0);
        if loss < WORST {
            others.push(Variant {
                system: other,
                loss,
            });
        }
    };
    for (v, _) in doubts
        .margins
        .iter()
        .enumerate()
        .filter(|(_, m)| **m < WORST)
    {
        if let Some(second) = field.best_order(&system, v, &every).second {
            let mut other = system.clone();
            other.set(graph, v, &second);
            settle(field, &mut other, v, &every);
            push(other);
        }
    }
    for (v, _) in doubts.cuts().all().filter(|(_, cost)| *cost < WORST) {
        let mut other = system.clone();
        for &w in doubts.cuts().part(v) {
            other.reverse(graph, w);
        }
        push(other);
    }
    others.sort_by(|a, b| a.loss.total_cmp(&b.loss));
    let mut seen = BTreeSet::from([key(&system)]);
    others.retain(|o| seen.len() <= MOST && seen.insert(key(&o.system)));
    others.insert(0, Variant { system, loss: 0.0 });
    others
}

/// Best orders around a vertex that keeps its own, until none changes.
fn settle(field: &Field<'_>, system: &mut RotationSystem, kept: usize, every: &[bool]) {
    let graph = field.graph();
    let around = |v: usize| graph.leaving(v).iter().map(|c| graph.head(*c));
    let mut open: BTreeSet<usize> = around(kept).collect();
    for _ in 0..ROUNDS {
        let mut next = BTreeSet::new();
        for v in open.into_iter().filter(|&v| v != kept) {
            let best = field.best_order(system, v, every);
            if best.order != system.order(graph, v) {
                system.set(graph, v, &best.order);
                next.extend(around(v));
            }
        }
        if next.is_empty() {
            break;
        }
        open = next;
    }
}

/// The loops as sets of edges, which is what readings differ in.
fn key(system: &RotationSystem) -> Vec<Vec<usize>> {
    let edges = |walk: Vec<crate::drawing::CoEdge>| {
        let mut edges: Vec<usize> = walk.iter().map(|c| c.edge()).collect();
        edges.sort_unstable();
        edges
    };
    let mut all: Vec<Vec<usize>> = system.loops().into_iter().map(edges).collect();
    all.sort_unstable();
    all
}

/// How plausible loops are whatever scored them, log-odds: a loop that walks an edge both ways is
/// no face's, and a connected piece of a solid's drawing seldom has a handle of its own.
pub(super) fn plausibility(graph: &Graph, system: &RotationSystem) -> f64 {
    let loops = system.loops();
    let twice = |walk: &Vec<crate::drawing::CoEdge>| {
        let mut edges: Vec<usize> = walk.iter().map(|c| c.edge()).collect();
        edges.sort_unstable();
        edges.windows(2).filter(|w| w[0] == w[1]).count()
    };
    let slits: usize = loops.iter().map(twice).sum();
    // Euler: V - E + L = 2 (components - handles).
    let euler = graph.vertex_count() as f64 - graph.edge_count() as f64 + loops.len() as f64;
    let handles = graph.component_count() as f64 - euler / 2.0;
    -SLIT * slits as f64 - HANDLE * handles
}

/// Log-odds against an edge that a loop walks both ways.
const SLIT: f64 = 6.0;

/// Log-odds against a handle.
const HANDLE: f64 = 1.5;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Drawing;
    use crate::identify::rotation::{Triples, samples};

    /// Calls `look` with the readings of a drawing.
    fn read(drawing: &Drawing, look: impl Fn(&Graph, Vec<Variant>)) {
        let graph = Graph::new(drawing);
        let triples = Triples::new(&graph);
        let scores = samples::hand_scores(drawing, &graph, &triples);
        let field = Field::new(&graph, &triples, &scores);
        let system = field.decode();
        let doubts = Doubts::new(&field, &system);
        look(&graph, variants(&field, system, &doubts));
    }

    #[test]
    fn readings_differ_and_the_best_is_first() {
        for drawing in [samples::cube(), samples::pyramid(), samples::two_arcs()] {
            read(&drawing, |graph, all| {
                assert_eq!(all[0].loss, 0.0);
                assert!(all.len() <= MOST + 1);
                let losses: Vec<f64> = all.iter().map(|v| v.loss).collect();
                assert!(losses.is_sorted() && losses.iter().all(|l| *l < WORST));
                let keys: BTreeSet<_> = all.iter().map(|v| key(&v.system)).collect();
                assert_eq!(keys.len(), all.len());
                for variant in &all {
                    let mut used: Vec<usize> = variant
                        .system
                        .loops()
                        .concat()
                        .iter()
                        .map(|c| c.index())
                        .collect();
                    used.sort_unstable();
                    let every: Vec<usize> = (0..2 * graph.edge_count()).collect();
                    assert_eq!(used, every);
                }
            });
        }
    }

    #[test]
    fn a_handle_or_a_slit_is_less_plausible() {
        read(&samples::cube(), |graph, all| {
            let right = &all[0].system;
            assert_eq!(plausibility(graph, right), 0.0);
            let mut wrong = right.clone();
            wrong.reverse(graph, 0);
            assert!(plausibility(graph, &wrong) < -1.0);
        });
    }
}
