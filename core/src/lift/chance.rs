//! Straight edges that are drawn along an axis by chance.
//!
//! Two chamfers meet in an edge that an isometric view draws parallel to an axis, and the short sides
//! of a pocket may be drawn so in any view. Faces tell: no plane holds three axes, and two that
//! share an edge do not hold the same two axes.

use crate::drawing::SurfaceKind;
use crate::identify::Face;

/// Edges that follow an axis at least if it is one of a face's for certain.
const SURE: usize = 2;

/// What faces say of the axes of edges.
pub(super) struct Witness<'a> {
    pub(super) faces: &'a [Face],
    /// Edges of each face.
    pub(super) edges: &'a [Vec<usize>],
    /// Faces at each edge.
    pub(super) faces_of: &'a [Vec<usize>],
}

impl Witness<'_> {
    /// Takes their axis from edges that alone contradict the others.
    pub(super) fn release(&self, edge_axis: &mut [Option<usize>]) {
        let pairs = self.faces_of.iter().filter_map(|beside| match **beside {
            [f, g] if f != g => Some([f, g]),
            _ => None,
        });
        let single = (0..self.faces.len()).map(|f| [f, f]);
        let mut all: Vec<[usize; 2]> = single.chain(pairs).collect();
        all.retain(|pair| {
            pair.iter()
                .all(|&f| self.faces[f].kind == SurfaceKind::Plane)
        });
        // What is released may be what another pair complains of.
        for pair in all {
            if let Some(edge) = self.stray(pair, edge_axis) {
                edge_axis[edge] = None;
            }
        }
    }

    /// The one edge that keeps two faces, or one that is given twice, from being as they can be.
    fn stray(&self, pair: [usize; 2], edge_axis: &[Option<usize>]) -> Option<usize> {
        let [first, second] = pair.map(|f| self.axes(f, edge_axis));
        let held = |axes: &[Vec<usize>; 3]| -> Vec<usize> {
            (0..3).filter(|&k| !axes[k].is_empty()).collect()
        };
        let (p, q) = (held(&first), held(&second));
        let contradict = if pair[0] == pair[1] {
            p.len() == 3
        } else {
            p.len() == 2 && p == q
        };
        if !contradict {
            return None;
        }
        let lists = first.iter().chain(&second).filter(|list| !list.is_empty());
        let mut doubtful: Vec<usize> = lists
            .filter(|list| list.len() < SURE)
            .flatten()
            .copied()
            .collect();
        doubtful.sort_unstable();
        doubtful.dedup();
        match *doubtful {
            [only] => Some(only),
            _ => None,
        }
    }

    /// Edges of a face along each of the three axes.
    fn axes(&self, face: usize, edge_axis: &[Option<usize>]) -> [Vec<usize>; 3] {
        let mut axes: [Vec<usize>; 3] = Default::default();
        for &e in &self.edges[face] {
            if let Some(k) = edge_axis[e] {
                axes[k].push(e);
            }
        }
        axes
    }
}

#[cfg(test)]
mod tests {
    use super::super::directions::Directions;
    use super::super::sheet::Sheet;
    use crate::identify::from_truth;
    use crate::identify::testing::chamfered;

    #[test]
    fn edges_of_a_chamfer_lose_the_axis_that_they_do_not_follow() {
        let drawing = chamfered();
        let faces = from_truth(&drawing).unwrap().faces;
        let directions = Directions::estimate(&drawing).unwrap();
        let sheet = Sheet::new(&drawing, &faces, &directions);
        let released: Vec<[usize; 2]> = (0..drawing.edges.len())
            .filter(|&e| directions.axis_of_edge(e).is_some() && sheet.edge_axis[e].is_none())
            .map(|e| drawing.edges[e].v)
            .collect();
        assert_eq!(released, [[4, 3], [8, 5]]);
    }
}
