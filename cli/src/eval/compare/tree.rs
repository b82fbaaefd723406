//! Distances from a surface of triangles, by a tree of boxes.

use glam::DVec3;

/// Triangles in a leaf.
const LEAF: usize = 4;

/// A box around some triangles: a leaf, or two boxes that follow it.
#[derive(Debug, Clone, Copy)]
struct Node {
    low: DVec3,
    high: DVec3,
    first: usize,
    count: usize,
    /// The second child; the first one is the next node. 0 in a leaf.
    other: usize,
}

/// Triangles, to ask how far points are from them.
#[derive(Debug)]
pub(super) struct Tree {
    triangles: Vec<[DVec3; 3]>,
    nodes: Vec<Node>,
}

impl Tree {
    /// A tree of one triangle at least.
    pub(super) fn new(mut triangles: Vec<[DVec3; 3]>) -> Self {
        let mut nodes = Vec::with_capacity(triangles.len());
        let count = triangles.len();
        divide(&mut triangles, 0, count, &mut nodes);
        Self { triangles, nodes }
    }

    /// Distance of a point from the nearest triangle; infinite without triangles.
    pub(super) fn distance(&self, p: DVec3) -> f64 {
        let mut best = f64::INFINITY;
        let mut open = vec![0];
        while let Some(n) = open.pop() {
            let node = &self.nodes[n];
            if apart(node, p) >= best {
                continue;
            }
            if node.other == 0 {
                for triangle in &self.triangles[node.first..node.first + node.count] {
                    best = best.min(nearest(triangle, p).distance_squared(p));
                }
            } else {
                let mut next = [n + 1, node.other];
                if apart(&self.nodes[next[0]], p) < apart(&self.nodes[next[1]], p) {
                    next.reverse();
                }
                // The nearer one is looked at first.
                open.extend(next);
            }
        }
        best.sqrt()
    }
}

fn divide(all: &mut [[DVec3; 3]], first: usize, count: usize, nodes: &mut Vec<Node>) {
    let part = &mut all[first..first + count];
    let corners = || part.iter().flatten();
    let low = corners().fold(DVec3::INFINITY, |m, p| m.min(*p));
    let high = corners().fold(DVec3::NEG_INFINITY, |m, p| m.max(*p));
    let own = nodes.len();
    nodes.push(Node {
        low,
        high,
        first,
        count,
        other: 0,
    });
    if count <= LEAF {
        return;
    }
    let side = high - low;
    let widest = (0..3).fold(0, |k, i| if side[i] > side[k] { i } else { k });
    let middle = |t: &[DVec3; 3]| t[0][widest] + t[1][widest] + t[2][widest];
    let half = count / 2;
    part.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)));
    divide(all, first, half, nodes);
    nodes[own].other = nodes.len();
    divide(all, first + half, count - half, nodes);
}

/// Squared distance of a point from a box.
fn apart(node: &Node, p: DVec3) -> f64 {
    p.clamp(node.low, node.high).distance_squared(p)
}

/// Point of a triangle nearest to another point (Ericson 2005, Real-Time Collision Detection, 5.1.5).
fn nearest(&[a, b, c]: &[DVec3; 3], p: DVec3) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let of = |q: DVec3| (ab.dot(p - q), ac.dot(p - q));
    let ((d1, d2), (d3, d4), (d5, d6)) = (of(a), of(b), of(c));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = va + vb + vc;
    a + ab * (vb / sum) + ac * (vc / sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::eval::random::Random;

    fn point(random: &mut Random) -> DVec3 {
        DVec3::new(random.normal(), random.normal(), random.normal())
    }

    #[test]
    fn the_tree_finds_what_looking_at_all_finds() {
        let mut random = Random::new(3, "triangles");
        let triangles: Vec<[DVec3; 3]> = (0..300)
            .map(|_| {
                let p = point(&mut random);
                [
                    p,
                    p + point(&mut random) * 0.2,
                    p + point(&mut random) * 0.2,
                ]
            })
            .collect();
        let tree = Tree::new(triangles.clone());
        for _ in 0..200 {
            let p = point(&mut random) * 2.0;
            let all = triangles.iter().map(|t| nearest(t, p).distance(p));
            let least = all.fold(f64::INFINITY, f64::min);
            assert!((tree.distance(p) - least).abs() < 1e-12);
        }
    }

    #[test]
    fn the_nearest_point_is_nearer_than_any_other() {
        let mut random = Random::new(5, "nearest");
        for _ in 0..200 {
            let t = [0; 3].map(|_| point(&mut random));
            let p = point(&mut random) * 2.0;
            let q = nearest(&t, p);
            for i in 0..=20 {
                for j in 0..=20 - i {
                    let (u, v) = (f64::from(i) / 20.0, f64::from(j) / 20.0);
                    let other = t[0] + (t[1] - t[0]) * u + (t[2] - t[0]) * v;
                    assert!(q.distance(p) <= other.distance(p) + 1e-12);
                }
            }
        }
    }
}
