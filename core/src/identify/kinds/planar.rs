//! Which loops of a drawing bound planes.
//!
//! Two planes meet in a straight line, so of the two loops at a curved edge at most one bounds a
//! plane; at a silhouette neither does, since both loops bound one curved surface. Loops that look
//! flat for sure settle what their neighbours are.

use std::collections::BTreeMap;

use super::look::Look;
use crate::drawing::{CoEdge, Drawing, SurfaceKind};

/// The kind of surface of each loop; together the loops use every co-edge once, or less.
///
/// A whole circle counts as a plane unless a neighbour is one for sure: it lies in a plane, whatever
/// the face is.
pub(crate) fn kinds_of(drawing: &Drawing, loops: &[&[CoEdge]]) -> Vec<SurfaceKind> {
    let looks: Vec<Look> = loops.iter().map(|l| Look::new(drawing, l)).collect();
    let mut sides: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (i, walk) in loops.iter().enumerate() {
        for c in walk
            .iter()
            .filter(|c| !drawing.edges[c.edge()].is_straight())
        {
            sides.entry(c.edge()).or_default().push(i);
        }
    }
    let mut order: Vec<usize> = (0..loops.len()).collect();
    order.sort_by(|&a, &b| {
        let by = |i: usize| looks[i].flatness();
        by(b).total_cmp(&by(a)).then(a.cmp(&b))
    });
    let mut flat: Vec<Option<bool>> = looks
        .iter()
        .map(|l| l.is_curved().then_some(false))
        .collect();
    for &e in looks.iter().flat_map(|l| &l.silhouettes) {
        for &i in sides.get(&e).into_iter().flatten() {
            flat[i] = Some(false);
        }
    }
    for i in order {
        if flat[i].is_some() {
            continue;
        }
        flat[i] = Some(true);
        let curved = |c: &&CoEdge| !drawing.edges[c.edge()].is_straight();
        for c in loops[i].iter().filter(curved) {
            for &j in sides.get(&c.edge()).into_iter().flatten() {
                // Both sides of a circle without corners look the same.
                let twins = looks[i].ring && looks[j].ring;
                if j != i && flat[j].is_none() && !twins {
                    flat[j] = Some(false);
                }
            }
        }
    }
    looks
        .iter()
        .zip(flat)
        .map(|(look, flat)| match flat {
            Some(false) => look.curved_kind(),
            _ => SurfaceKind::Plane,
        })
        .collect()
}
