//! Edges that are opposite sides of parallelograms.
//!
//! The sides of a prism are drawn as parallelograms, so that the edges along it are drawn alike: one
//! vector, of which each edge shows a copy with errors of its own. A short one may follow any axis;
//! the mean of all tells which. This needs no faces: a parallelogram of edges is hardly ever drawn by
//! chance.

use std::f64::consts::SQRT_2;

use glam::DVec2;

use crate::drawing::Drawing;
use crate::lift::directions::Directions;
use crate::sets::Sets;

/// Errors of the difference of two edges within which they are one vector.
const SAME: f64 = 3.0;

/// Errors of the mean within which it is along an axis.
const ALONG: f64 = 3.0;

/// Edges that are drawn as one vector.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sides {
    /// Its edges, each with the sign by which it runs as the first does.
    pub(super) edges: Vec<(usize, f64)>,
    /// Mean of the edges as vectors.
    mean: DVec2,
    /// Those that are the other sides of the same parallelograms, by index.
    beside: Vec<usize>,
}

/// Edges that are drawn as one vector, two and more, each edge once; `precision` is the standard error
/// of coordinates, drawing units.
pub(super) fn sides(drawing: &Drawing, precision: f64) -> Vec<Sides> {
    let edges = drawing.edges.len();
    let mut leaving: Vec<Vec<(usize, usize)>> = vec![Vec::new(); drawing.vertices.len()];
    for (e, edge) in drawing.edges.iter().enumerate() {
        if edge.is_straight() {
            let [a, b] = edge.v;
            leaving[a].push((e, b));
            leaving[b].push((e, a));
        }
    }
    let at = |v: usize| drawing.vertices[v];
    let mut sets = Sets::new(edges);
    let mut corners = Vec::new();
    for (a, from) in leaving.iter().enumerate() {
        for &(e, b) in from.iter().filter(|&&(_, b)| a < b) {
            for &(f, c) in from.iter().filter(|x| x.0 != e) {
                for &(g, d) in leaving[b].iter().filter(|x| x.0 != e && x.1 != c) {
                    // The difference of two edges has the errors of four ends.
                    let off = (at(b) - at(a)) - (at(d) - at(c));
                    if off.length() > SAME * 2.0 * precision {
                        continue;
                    }
                    if let Some(&(h, _)) = leaving[c].iter().find(|x| x.1 == d) {
                        sets.join(e, h);
                        sets.join(f, g);
                        corners.push((e, f));
                    }
                }
            }
        }
    }
    let chord = |e: usize| at(drawing.edges[e].v[1]) - at(drawing.edges[e].v[0]);
    let mut all: Vec<Sides> = Vec::new();
    let mut sides_of = vec![None; edges];
    for e in corners.iter().flat_map(|&(e, f)| [e, f]) {
        let set = sets.find(e);
        if sides_of[set].is_none() {
            let own: Vec<usize> = (0..edges).filter(|&x| sets.find(x) == set).collect();
            let sign = |x: usize| chord(x).dot(chord(own[0])).signum();
            let members: Vec<(usize, f64)> = own.iter().map(|&x| (x, sign(x))).collect();
            let sum: DVec2 = members.iter().map(|&(x, s)| chord(x) * s).sum();
            own.iter().for_each(|&x| sides_of[x] = Some(all.len()));
            all.push(Sides {
                mean: sum / members.len() as f64,
                edges: members,
                beside: Vec::new(),
            });
        }
    }
    for (e, f) in corners {
        if let [Some(i), Some(j)] = [sides_of[e], sides_of[f]] {
            all[i].beside.push(j);
            all[j].beside.push(i);
        }
    }
    all
}

/// The reading, with the edges of each vector along the axis that their mean is along; along none if
/// it is aside of all. Sides of one parallelogram do not follow one axis.
pub(super) fn told(all: &[Sides], mut reading: Directions) -> Directions {
    let mut order: Vec<usize> = (0..all.len()).collect();
    let weight = |i: usize| all[i].mean.length() * all[i].edges.len() as f64;
    order.sort_by(|&i, &j| weight(j).total_cmp(&weight(i)));
    let mut axis_of: Vec<Option<usize>> = vec![None; all.len()];
    for i in order {
        let sides = &all[i];
        let count = sides.edges.len() as f64;
        let error = SQRT_2 * reading.precision / count.sqrt();
        let error = error.hypot(reading.error * sides.mean.length() / 2.0);
        let off = |k: usize| {
            let drawn = reading.axes[k].direction.truncate();
            (sides.mean.perp_dot(drawn.normalize_or(DVec2::X)) / error).abs()
        };
        let free = |k: &usize| sides.beside.iter().all(|&j| axis_of[j] != Some(*k));
        let nearest = (0..reading.axes.len())
            .filter(free)
            .min_by(|&j, &k| off(j).total_cmp(&off(k)))
            .filter(|&k| off(k) < ALONG);
        for axis in &mut reading.axes {
            axis.edges.retain(|e| sides.edges.iter().all(|m| m.0 != *e));
        }
        if let Some(k) = nearest {
            let edges = &mut reading.axes[k].edges;
            edges.extend(sides.edges.iter().map(|m| m.0));
            edges.sort_unstable();
        }
        axis_of[i] = nearest;
    }
    reading
}
