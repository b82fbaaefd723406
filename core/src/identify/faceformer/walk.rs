//! A mask for decoding that allows only what can become a face: co-edges that continue the walk.
//!
//! The paper decodes without it; it is an option.

use super::{FurtherLoops, TOKENS, Variant};
use crate::drawing::{CoEdge, Graph};

/// What may follow a sequence over one drawing.
#[derive(Debug)]
pub(super) struct Walks<'a> {
    graph: &'a Graph,
    /// Co-edges of the tokens.
    coedges: &'a [CoEdge],
    /// Token of each co-edge, by its index.
    token: Vec<u32>,
    variant: Variant,
    further: FurtherLoops,
}

impl<'a> Walks<'a> {
    /// The mask over a drawing whose tokens are `coedges`.
    pub(super) fn new(
        graph: &'a Graph,
        coedges: &'a [CoEdge],
        variant: Variant,
        further: FurtherLoops,
    ) -> Self {
        let mut token = vec![0; 2 * graph.edge_count()];
        for (i, c) in coedges.iter().enumerate() {
            token[c.index()] = (i + TOKENS) as u32;
        }
        Self {
            graph,
            coedges,
            token,
            variant,
            further,
        }
    }

    /// Sets the logits of what may not follow `tokens` to minus infinity.
    ///
    /// An open walk goes on with a co-edge that leaves its end; a closed one ends the face or begins
    /// another loop. A face uses no edge twice, and no co-edge is in two faces. Where sequences hold
    /// further loops sorted, those are no walks: there only a face that is closed as a whole may end.
    /// Where nothing is left, a face by itself is given up, and in a sequence of all faces the next
    /// one begins. Sequences of edges are no walks, so there nothing is forbidden.
    pub(super) fn forbid(&self, tokens: &[u32], logits: &mut [f32]) {
        if self.variant == Variant::Seq2seq {
            return;
        }
        let mut allowed = self.allowed(tokens);
        if self.variant == Variant::Seq2seqCoedge && !allowed.contains(&true) {
            allowed[Variant::SEP as usize..TOKENS].fill(true);
        }
        for (logit, allowed) in logits.iter_mut().zip(allowed) {
            if !allowed {
                *logit = f32::NEG_INFINITY;
            }
        }
    }

    fn allowed(&self, tokens: &[u32]) -> Vec<bool> {
        let mut allowed = vec![false; TOKENS + self.coedges.len()];
        let face = match self.variant {
            Variant::Faceformer => tokens,
            _ => {
                let last = tokens.iter().rposition(|&t| t < TOKENS as u32);
                &tokens[last.map_or(0, |i| i + 1)..]
            }
        };
        let mut taken = vec![false; 2 * self.graph.edge_count()];
        for c in tokens.iter().filter_map(|&t| self.coedge(t)) {
            taken[c.index()] = true;
        }
        for c in face.iter().filter_map(|&t| self.coedge(t)) {
            taken[c.mate().index()] = true;
        }
        let mut free = |c: CoEdge| {
            if !taken[c.index()] {
                allowed[self.token[c.index()] as usize] = true;
            }
        };
        match self.state(face) {
            State::Open(vertex) => self.graph.leaving(vertex).iter().copied().for_each(free),
            State::Empty => self.graph.coedges().for_each(free),
            State::Unbalanced => self.graph.coedges().for_each(free),
            State::Closed => {
                self.graph.coedges().for_each(&mut free);
                let ends = match self.variant {
                    Variant::Faceformer => 1..TOKENS,
                    _ => Variant::SEP as usize..TOKENS,
                };
                allowed[ends].fill(true);
            }
        }
        allowed
    }

    fn coedge(&self, token: u32) -> Option<CoEdge> {
        let place = (token as usize).checked_sub(TOKENS)?;
        self.coedges.get(place).copied()
    }

    fn state(&self, face: &[u32]) -> State {
        let coedges: Vec<CoEdge> = face.iter().filter_map(|&t| self.coedge(t)).collect();
        let mut walk: Option<(usize, usize)> = None;
        for (k, &c) in coedges.iter().enumerate() {
            let (first, _) = walk.unwrap_or((self.graph.origin(c), 0));
            let at = self.graph.head(c);
            walk = (at != first).then_some((first, at));
            if walk.is_none() && self.further == FurtherLoops::Sorted {
                return self.balance(&coedges[k + 1..]);
            }
        }
        match walk {
            Some((_, at)) => State::Open(at),
            None if coedges.is_empty() => State::Empty,
            None => State::Closed,
        }
    }

    /// Whether co-edges without order are closed walks.
    fn balance(&self, coedges: &[CoEdge]) -> State {
        let mut heads: Vec<usize> = coedges.iter().map(|&c| self.graph.head(c)).collect();
        let mut origins: Vec<usize> = coedges.iter().map(|&c| self.graph.origin(c)).collect();
        heads.sort_unstable();
        origins.sort_unstable();
        if heads == origins {
            State::Closed
        } else {
            State::Unbalanced
        }
    }
}

/// Where a face stands.
enum State {
    /// It has no co-edge yet.
    Empty,
    /// The walk is at that vertex, where it did not begin.
    Open(usize),
    /// Further co-edges are missing, in no order of walking.
    Unbalanced,
    /// All its loops are closed.
    Closed,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::testing;

    /// Co-edges of a cube with a hole whose top has an inner loop, as tokens in the order of indices.
    fn setting() -> (Graph, Vec<CoEdge>, Vec<Vec<CoEdge>>) {
        let drawing = testing::holed_cube();
        let graph = Graph::new(&drawing);
        let coedges: Vec<CoEdge> = graph.coedges().collect();
        let loops = drawing.truth.unwrap().faces.remove(1).loops;
        (graph, coedges, loops)
    }

    fn tokens(walk: &[CoEdge]) -> Vec<u32> {
        walk.iter().map(|c| (c.index() + TOKENS) as u32).collect()
    }

    fn left(walks: &Walks<'_>, tokens: &[u32]) -> Vec<usize> {
        let mut logits = vec![0.0; TOKENS + walks.coedges.len()];
        walks.forbid(tokens, &mut logits);
        (0..logits.len()).filter(|&t| logits[t] == 0.0).collect()
    }

    #[test]
    fn an_open_walk_goes_on_and_a_closed_one_may_end() {
        let (graph, coedges, loops) = setting();
        for further in [FurtherLoops::Sorted, FurtherLoops::Walked] {
            let walks = Walks::new(&graph, &coedges, Variant::Faceformer, further);
            let outer = tokens(&loops[0]);
            let after = left(&walks, &outer[..2]);
            assert_eq!(after.len(), 2);
            assert!(after.contains(&(outer[2] as usize)));
            let closed = left(&walks, &outer);
            assert_eq!(closed[..3], [1, 2, 3]);
            // 48 co-edges, without the loop's and their mates.
            assert_eq!(closed.len(), 3 + 40);
        }
    }

    #[test]
    fn further_loops_are_walked_or_sorted() {
        let (graph, coedges, loops) = setting();
        let (outer, inner) = (tokens(&loops[0]), tokens(&loops[1]));
        let begun = [outer.clone(), inner[..1].to_vec()].concat();
        let walked = Walks::new(&graph, &coedges, Variant::Faceformer, FurtherLoops::Walked);
        assert_eq!(left(&walked, &begun).len(), 2);
        let sorted = Walks::new(&graph, &coedges, Variant::Faceformer, FurtherLoops::Sorted);
        assert_eq!(left(&sorted, &begun).len(), 38);
        let whole = [outer, inner].concat();
        assert_eq!(left(&sorted, &whole)[..3], [1, 2, 3]);
    }

    #[test]
    fn faces_in_a_row_take_no_coedge_twice() {
        let (graph, coedges, loops) = setting();
        let walks = Walks::new(
            &graph,
            &coedges,
            Variant::Seq2seqCoedge,
            FurtherLoops::Walked,
        );
        let mut sequence = vec![Variant::SOS];
        assert_eq!(left(&walks, &sequence).len(), 48);
        sequence.extend(tokens(&loops[0]));
        assert_eq!(left(&walks, &sequence)[..2], [2, 3]);
        sequence.push(Variant::SEP);
        let next = left(&walks, &sequence);
        assert_eq!(next.len(), 44);
        assert!(next.contains(&(loops[0][0].mate().index() + TOKENS)));
    }
}
