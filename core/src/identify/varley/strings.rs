//! Strings: walks of co-edges that will be parts of faces, and which of them may merge.

use super::pairs::Pairs;
use crate::drawing::{CoEdge, Graph};

/// No co-edge.
const NONE: u32 = u32::MAX;

/// A place where a string may end and another go on: its last co-edge, the other's first.
pub(super) type Corner = (CoEdge, CoEdge);

/// A merge that is legal.
#[derive(Debug, Clone, Copy)]
pub(super) struct Merge {
    /// The new corner.
    pub(super) corner: Corner,
    /// Whether the two strings close each other to a face.
    pub(super) closes: bool,
}

/// All strings of a drawing at one moment. An open string is known by its first or last co-edge.
#[derive(Clone)]
pub(super) struct Strings<'a> {
    pub(super) graph: &'a Graph,
    pub(super) pairs: &'a Pairs,
    /// Co-edge after and before each co-edge.
    after: Vec<u32>,
    before: Vec<u32>,
    /// From an open string's first co-edge to its last, and from its last to its first.
    far: Vec<u32>,
    /// Priority of an open string, at its first co-edge.
    priority: Vec<f64>,
    /// Corners that were tried in vain.
    banned: Vec<Corner>,
    /// One co-edge of each face.
    faces: Vec<CoEdge>,
    /// Vertices at which merges may have become forced, or impossible.
    pub(super) changed: Vec<usize>,
    /// First co-edges of strings that may have a mate that closes them.
    pub(super) grown: Vec<CoEdge>,
    /// Vertices of the string in hand carry the latest stamp.
    stamps: Vec<u32>,
    stamp: u32,
}

impl<'a> Strings<'a> {
    /// One string for each co-edge.
    pub(super) fn new(graph: &'a Graph, pairs: &'a Pairs) -> Self {
        let n = 2 * graph.edge_count();
        Self {
            graph,
            pairs,
            after: vec![NONE; n],
            before: vec![NONE; n],
            far: (0..n as u32).collect(),
            priority: graph.coedges().map(|c| pairs.priority(c.edge())).collect(),
            banned: Vec::new(),
            faces: Vec::new(),
            changed: Vec::new(),
            grown: Vec::new(),
            stamps: vec![0; graph.vertex_count()],
            stamp: 0,
        }
    }

    /// Looks for forced merges at the origins of the given co-edges, and nowhere else.
    pub(super) fn wake(&mut self, coedges: &[CoEdge]) {
        self.grown.clear();
        self.changed.clear();
        self.changed
            .extend(coedges.iter().map(|&c| self.graph.origin(c)));
        self.changed.sort_unstable();
        self.changed.dedup();
    }

    /// Number of faces.
    pub(super) fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// The faces from number `from` on, in the order in which they closed.
    pub(super) fn faces(&self, from: usize) -> impl Iterator<Item = Vec<CoEdge>> + '_ {
        self.faces[from..].iter().map(|&c| {
            let rest = std::iter::successors(self.after(c), |&d| self.after(d));
            std::iter::once(c)
                .chain(rest.take_while(|&d| d != c))
                .collect()
        })
    }

    /// Whether a co-edge is the first of an open string.
    pub(super) fn starts(&self, c: CoEdge) -> bool {
        self.before[c.index()] == NONE
    }

    /// Whether a co-edge is the last of an open string.
    pub(super) fn ends(&self, c: CoEdge) -> bool {
        self.after[c.index()] == NONE
    }

    /// The other end of the open string that starts or ends with `c`.
    pub(super) fn far(&self, c: CoEdge) -> CoEdge {
        CoEdge::from_index(self.far[c.index()] as usize)
    }

    /// Co-edge after `c` in its string or face.
    fn after(&self, c: CoEdge) -> Option<CoEdge> {
        let next = self.after[c.index()];
        (next != NONE).then(|| CoEdge::from_index(next as usize))
    }

    /// The co-edges of the open string that starts with `first`.
    fn walk(&self, first: CoEdge) -> impl Iterator<Item = CoEdge> + '_ {
        std::iter::successors(Some(first), |&c| self.after(c))
    }

    /// Bans a corner for good.
    pub(super) fn ban(&mut self, corner: Corner) {
        self.banned.push(corner);
        self.changed.push(self.graph.head(corner.0));
    }

    /// Whether a corner may be added at its vertex.
    ///
    /// On a manifold the corners at a vertex link its edges in one cycle, so a cycle must not
    /// close before it has all of them. For a cycle of two this is the rule that a corner does not
    /// occur reversed.
    fn corner_fits(&self, (a, b): Corner) -> bool {
        if b == a.mate() || self.banned.contains(&(a, b)) {
            return false;
        }
        let (mut out, mut edges) = (b, 1);
        while out.mate() != a {
            match self.after(out.mate()) {
                Some(next) => out = next,
                None => return true,
            }
            edges += 1;
        }
        edges == self.graph.degree(self.graph.head(a))
    }

    /// The merge at a corner, if it is legal: both strings are open there, share no other vertex,
    /// and the corner fits, as does the closing corner if they close each other.
    pub(super) fn merge_at(&mut self, corner: Corner) -> Option<Merge> {
        let (a, b) = corner;
        if !self.ends(a) || !self.starts(b) || !self.corner_fits(corner) {
            return None;
        }
        let (first, last) = (self.far(a), self.far(b));
        let closes = self.graph.origin(first) == self.graph.head(last);
        if closes && !self.corner_fits((last, first)) {
            return None;
        }
        self.stamp += 1;
        // Strings that close each other do share the first one's first vertex.
        let mut c = if closes {
            self.after(first)
        } else {
            Some(first)
        };
        while let Some(d) = c {
            self.stamps[self.graph.origin(d)] = self.stamp;
            c = self.after(d);
        }
        let shares = self
            .walk(b)
            .any(|c| self.stamps[self.graph.head(c)] == self.stamp);
        (!shares).then_some(Merge { corner, closes })
    }

    /// Merges two strings; a string that closes becomes a face.
    pub(super) fn merge(&mut self, merge: Merge) {
        let (a, b) = merge.corner;
        let (first, last) = (self.far(a), self.far(b));
        self.priority[first.index()] = self.merged_priority(merge);
        self.link(a, b);
        if merge.closes {
            self.link(last, first);
            self.faces.push(first);
        } else {
            self.far[first.index()] = last.index() as u32;
            self.far[last.index()] = first.index() as u32;
            self.changed
                .extend([self.graph.origin(first), self.graph.head(last)]);
            self.grown.push(first);
        }
    }

    fn link(&mut self, a: CoEdge, b: CoEdge) {
        self.after[a.index()] = b.index() as u32;
        self.before[b.index()] = a.index() as u32;
        self.changed.push(self.graph.head(a));
    }

    /// Priority of the string that a merge gives: the sum of the two, times how well they mate.
    pub(super) fn merged_priority(&self, merge: Merge) -> f64 {
        let (s, t) = (self.far(merge.corner.0), merge.corner.1);
        (self.priority[s.index()] + self.priority[t.index()]) * self.mating(s, t)
    }

    /// How well two strings mate: 1 for two single edges, else the mean of the better half of the
    /// parallelisms between an edge of one and an edge of the other.
    fn mating(&self, s: CoEdge, t: CoEdge) -> f64 {
        if self.ends(s) && self.ends(t) {
            return 1.0;
        }
        let mut values: Vec<f64> = Vec::new();
        for c in self.walk(s) {
            values.extend(
                self.walk(t)
                    .map(|d| self.pairs.parallelism(c.edge(), d.edge())),
            );
        }
        values.sort_unstable_by(|x, y| y.total_cmp(x));
        values.truncate(values.len().div_ceil(2));
        values.iter().sum::<f64>() / values.len() as f64
    }
}
