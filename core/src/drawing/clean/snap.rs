//! End points that meet become one vertex.

use std::collections::HashMap;

use glam::DVec2;

use super::super::Drawing;

/// Gives every edge its vertices: end points within `tolerance` of a cluster's first point are
/// one vertex, placed at the mean of the cluster.
pub(super) fn snap(drawing: &mut Drawing, tolerance: f64) {
    let mut grid: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
    let mut seeds: Vec<DVec2> = Vec::new();
    let mut sums: Vec<(DVec2, f64)> = Vec::new();
    for e in &mut drawing.edges {
        let [Some(&first), Some(&last)] = [e.points.first(), e.points.last()] else {
            continue;
        };
        e.v = [first, last].map(|p| {
            let cell = [p.x, p.y].map(|x| (x / tolerance).floor() as i64);
            let near = (-1..=1)
                .flat_map(|i| (-1..=1).map(move |j| [cell[0] + i, cell[1] + j]))
                .filter_map(|c| grid.get(&c))
                .flatten()
                .copied()
                .filter(|&s| seeds[s].distance(p) <= tolerance)
                .min_by(|&a, &b| seeds[a].distance(p).total_cmp(&seeds[b].distance(p)));
            let vertex = near.unwrap_or_else(|| {
                grid.entry(cell).or_default().push(seeds.len());
                seeds.push(p);
                sums.push((DVec2::ZERO, 0.0));
                seeds.len() - 1
            });
            sums[vertex].0 += p;
            sums[vertex].1 += 1.0;
            vertex
        });
    }
    drawing.vertices = sums.iter().map(|(sum, n)| *sum / *n).collect();
    for e in &mut drawing.edges {
        let ends = e.v.map(|v| drawing.vertices[v]);
        if let [first, .., last] = e.points.as_mut_slice() {
            *first = ends[0];
            *last = ends[1];
        }
    }
}
