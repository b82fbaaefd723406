//! Which strings merge next: what is forced, what closes, and the surest of the arbitrary moves.

use super::strings::{Corner, Merge, Strings};
use crate::drawing::CoEdge;

/// The best merge of a string.
#[derive(Debug, Clone, Copy)]
pub(super) struct Choice {
    pub(super) merge: Merge,
    /// Priority of the merged string.
    priority: f64,
    /// That of the second best merge, 0 if there is none.
    second: f64,
}

impl Choice {
    /// What the choices of different strings are compared by.
    fn sureness(&self) -> (f64, f64) {
        (self.priority - self.second, self.priority)
    }

    /// Log of the best merge's priority over that of the second best.
    pub(super) fn margin(&self) -> f64 {
        if self.second == 0.0 {
            f64::INFINITY
        } else {
            (self.priority / self.second).ln()
        }
    }
}

impl Strings<'_> {
    /// Makes forced merges and completions until there are none. Returns false if a string has no
    /// mate, so that no consistent faces follow.
    pub(super) fn settle(&mut self) -> bool {
        loop {
            while let Some(v) = self.changed.pop() {
                if !self.force(v) {
                    return false;
                }
            }
            let Some(first) = self.grown.pop() else {
                return true;
            };
            self.complete(first);
        }
    }

    /// Merges every string that has exactly one mate at vertex `v`; false if one has none.
    fn force(&mut self, v: usize) -> bool {
        let leaving = self.graph.leaving(v);
        let mut merged = true;
        while merged {
            merged = false;
            for &c in leaving {
                if self.ends(c.mate()) {
                    let corners = leaving.iter().map(|&next| (c.mate(), next));
                    let Some(done) = self.force_one(corners) else {
                        return false;
                    };
                    merged |= done;
                }
                if self.starts(c) {
                    let corners = leaving.iter().map(|&before| (before.mate(), c));
                    let Some(done) = self.force_one(corners) else {
                        return false;
                    };
                    merged |= done;
                }
            }
        }
        true
    }

    /// Merges if exactly one of the corners allows it, and says whether; `None` if none does.
    fn force_one(&mut self, corners: impl Iterator<Item = Corner>) -> Option<bool> {
        let mut only = None;
        for corner in corners {
            if let Some(merge) = self.merge_at(corner) {
                if only.is_some() {
                    return Some(false);
                }
                only = Some(merge);
            }
        }
        self.merge(only?);
        Some(true)
    }

    /// Closes a string with one that leads from its end to its start, if there is such a string.
    fn complete(&mut self, first: CoEdge) {
        if !self.starts(first) {
            return;
        }
        let graph = self.graph;
        let last = self.far(first);
        for &b in graph.leaving(graph.head(last)) {
            let returns = self.starts(b) && graph.head(self.far(b)) == graph.origin(first);
            if !returns {
                continue;
            }
            if let Some(merge) = self.merge_at((last, b)).filter(|m| m.closes) {
                return self.merge(merge);
            }
        }
    }

    /// The best merge of the string that ends with `last`: the one whose merged priority beats
    /// that of the second best by most. `None` if the string has no mate.
    fn best(&mut self, last: CoEdge) -> Option<Choice> {
        let graph = self.graph;
        let mut best: Option<Choice> = None;
        for &b in graph.leaving(graph.head(last)) {
            let Some(merge) = self.merge_at((last, b)) else {
                continue;
            };
            let priority = self.merged_priority(merge);
            let (most, second) = best.map_or((0.0, 0.0), |c| (c.priority, c.second));
            if best.is_none() || priority > most {
                let second = most;
                best = Some(Choice {
                    merge,
                    priority,
                    second,
                });
            } else if let Some(best) = &mut best {
                best.second = second.max(priority);
            }
        }
        best
    }

    /// The surest arbitrary move for the strings that end with one of the given co-edges: of all
    /// strings' best merges the one that beats its string's second best by most. `None` if every
    /// string is closed.
    pub(super) fn surest(&mut self, coedges: &[CoEdge]) -> Option<Choice> {
        let mut surest: Option<Choice> = None;
        for &last in coedges {
            if self.ends(last)
                && let Some(best) = self.best(last)
                && surest.is_none_or(|s| best.sureness() > s.sureness())
            {
                surest = Some(best);
            }
        }
        surest
    }

    /// Adds the corners of a face that are not there yet.
    pub(super) fn commit(&mut self, face: &[CoEdge]) {
        for (i, &a) in face.iter().enumerate() {
            if let Some(merge) = self.merge_at((a, face[(i + 1) % face.len()])) {
                self.merge(merge);
            }
        }
    }
}
