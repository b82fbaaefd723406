//! Choices made one after the other, and those that may be tried instead.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::joins::{Join, State};

/// A choice among the joins of a part.
#[derive(Debug, Clone)]
pub(super) struct Step {
    pub(super) part: usize,
    pub(super) joins: Vec<Join>,
    pub(super) chosen: usize,
}

/// All choices, and the state before each and at the end.
pub(super) struct Run {
    pub(super) steps: Vec<Step>,
    pub(super) states: Vec<State>,
    pub(super) log_likelihood: f64,
    /// First step that is not its parent's.
    pub(super) from: usize,
}

/// A run to be tried.
pub(super) struct Trial {
    pub(super) estimate: f64,
    pub(super) run: usize,
    pub(super) step: usize,
    pub(super) choice: usize,
}

impl PartialEq for Trial {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Trial {}

impl PartialOrd for Trial {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Trial {
    fn cmp(&self, other: &Self) -> Ordering {
        let by = |t: &Self| (t.run, t.step, t.choice);
        self.estimate
            .total_cmp(&other.estimate)
            .then_with(|| by(other).cmp(&by(self)))
    }
}

impl Step {
    /// Probability of each join.
    pub(super) fn shares(&self) -> Vec<f64> {
        let top = self.joins.first().map_or(0.0, |j| j.score);
        let all: Vec<f64> = self.joins.iter().map(|j| (j.score - top).exp()).collect();
        let sum: f64 = all.iter().sum();
        all.into_iter().map(|x| x / sum).collect()
    }

    pub(super) fn log_share(&self, choice: usize) -> f64 {
        self.shares()[choice].ln()
    }
}

/// Every other choice of a run's own steps.
pub(super) fn push_trials(heap: &mut BinaryHeap<Trial>, runs: &[Run], run: usize) {
    let whole = &runs[run];
    for (k, step) in whole.steps.iter().enumerate().skip(whole.from) {
        for choice in 1..step.joins.len() {
            heap.push(Trial {
                estimate: whole.log_likelihood - step.log_share(step.chosen)
                    + step.log_share(choice),
                run,
                step: k,
                choice,
            });
        }
    }
}
