//! Consistent directions for loops that were found one by one.

use super::Face;
use crate::drawing::{CoEdge, Graph};

/// Reverses loops so that two loops that share an edge walk it opposite ways, as faces of a solid
/// do when each is on the left of its loops.
///
/// Directions spread from loop to loop over the edges that exactly two loops use; each group of
/// loops so connected keeps the direction of its first loop. Where no choice fits all edges, which
/// happens with wrong faces only, the one reached first stays.
pub fn orient(graph: &Graph, faces: &mut [Face]) {
    let mut loops: Vec<&mut Vec<CoEdge>> = faces.iter_mut().flat_map(|f| &mut f.loops).collect();
    let mut users: Vec<Vec<(usize, CoEdge)>> = vec![Vec::new(); graph.edge_count()];
    for (i, walk) in loops.iter().enumerate() {
        for &c in walk.iter() {
            users[c.edge()].push((i, c));
        }
    }
    let mut reversed: Vec<Option<bool>> = vec![None; loops.len()];
    let mut queue = Vec::new();
    for start in 0..loops.len() {
        if reversed[start].is_some() {
            continue;
        }
        reversed[start] = Some(false);
        queue.push((start, false));
        while let Some((i, is_reversed)) = queue.pop() {
            for &c in loops[i].iter() {
                let &[(a, ca), (b, cb)] = users[c.edge()].as_slice() else {
                    continue;
                };
                let other = if a == i { b } else { a };
                if reversed[other].is_none() {
                    let turn = is_reversed != (ca == cb);
                    reversed[other] = Some(turn);
                    queue.push((other, turn));
                }
            }
        }
    }
    for (walk, reversed) in loops.iter_mut().zip(reversed) {
        if reversed == Some(true) {
            walk.reverse();
            walk.iter_mut().for_each(|c| *c = c.mate());
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::{from_truth, testing};
    use super::*;

    proptest! {
        #[test]
        fn any_reversal_of_loops_is_undone(turns in any::<u64>(), which in 0..3usize) {
            let solids = [testing::bracket, testing::holed_cube, testing::tetrahedron];
            let drawing = solids[which]();
            let graph = Graph::new(&drawing);
            let mut faces = from_truth(&drawing).unwrap().faces;
            for (i, walk) in faces.iter_mut().flat_map(|f| &mut f.loops).enumerate() {
                if turns >> i & 1 == 1 {
                    walk.reverse();
                    walk.iter_mut().for_each(|c| *c = c.mate());
                }
            }
            orient(&graph, &mut faces);
            let mut used = vec![0; 2 * graph.edge_count()];
            for walk in faces.iter().flat_map(|f| &f.loops) {
                for (i, &c) in walk.iter().enumerate() {
                    used[c.index()] += 1;
                    prop_assert_eq!(graph.head(c), graph.origin(walk[(i + 1) % walk.len()]));
                }
            }
            prop_assert!(used.iter().all(|&n| n == 1));
        }
    }

    #[test]
    fn an_edge_of_three_loops_ties_no_directions() {
        let drawing = testing::tetrahedron();
        let graph = Graph::new(&drawing);
        let mut faces = from_truth(&drawing).unwrap().faces;
        faces.push(faces[0].clone());
        let before = faces.clone();
        orient(&graph, &mut faces);
        assert_eq!(faces, before);
    }
}
