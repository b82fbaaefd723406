//! Faces that hang together.

use faceformer::drawing::CoEdge;

/// Faces grouped by the edges they share.
pub(crate) struct Groups(Vec<usize>);

impl Groups {
    /// Groups faces, given the loops of each, by those of their edges that join; there are `edges`
    /// edges, and none beyond is named.
    pub(crate) fn new<'a>(
        faces: impl Iterator<Item = &'a Vec<Vec<CoEdge>>>,
        edges: usize,
        joins: impl Fn(usize) -> bool,
    ) -> Self {
        let mut groups = Self(Vec::new());
        let mut seen = vec![None; edges];
        for (f, loops) in faces.enumerate() {
            groups.0.push(f);
            for e in loops.iter().flatten().map(|c: &CoEdge| c.edge()) {
                match seen[e] {
                    None => seen[e] = Some(f),
                    Some(g) if joins(e) => groups.join(f, g),
                    Some(_) => {}
                }
            }
        }
        groups
    }

    fn root(&self, mut f: usize) -> usize {
        while self.0[f] != f {
            f = self.0[f];
        }
        f
    }

    /// The smaller index becomes the root, so that labels are in the order of the faces.
    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }

    /// Group of every face, numbered from 0 in the order of their first faces.
    pub(crate) fn labels(&self) -> Vec<u32> {
        let mut labels = vec![0; self.0.len()];
        let mut next = 0;
        for f in 0..labels.len() {
            let root = self.root(f);
            if root == f {
                labels[f] = next;
                next += 1;
            } else {
                labels[f] = labels[root];
            }
        }
        labels
    }
}
