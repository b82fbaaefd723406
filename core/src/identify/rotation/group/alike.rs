//! Parts that are drawn alike: holes and bosses of one pattern.
//!
//! What is drilled or set in a row is meant alike, so a part joins the others as its twins do.

use super::joins::{Joiner, State};
use super::shapes::{Outline, Shapes};

/// A part that another one is a moved copy of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Twin {
    part: usize,
    /// Its loop for each loop of the other part, in the order of that part's loops.
    loops: Vec<usize>,
}

/// For each part its twins.
pub(super) fn alike(shapes: &Shapes) -> Vec<Vec<Twin>> {
    let twins = |p: usize| {
        let others = (0..shapes.parts.len()).filter(|&q| q != p);
        others.filter_map(|q| twin(shapes, p, q)).collect()
    };
    (0..shapes.parts.len()).map(twins).collect()
}

/// Part `q` as a copy of part `p`, if it is drawn as one.
fn twin(shapes: &Shapes, p: usize, q: usize) -> Option<Twin> {
    let (a, b) = (&shapes.parts[p], &shapes.parts[q]);
    let near = shapes.near();
    let by = b.low - a.low;
    if a.loops.len() != b.loops.len() || (b.high - a.high).distance(by) > near {
        return None;
    }
    let same = |x: &Outline, y: &Outline| {
        x.vertices.len() == y.vertices.len()
            && (y.low - x.low).distance(by) < near
            && (y.high - x.high).distance(by) < near
            && (x.area - y.area).abs() < near * shapes.size
    };
    let mut free = b.loops.clone();
    let mut loops = Vec::with_capacity(free.len());
    for &i in &a.loops {
        let k = free
            .iter()
            .position(|&j| same(&shapes.loops[i], &shapes.loops[j]))?;
        loops.push(free.swap_remove(k));
    }
    Some(Twin { part: q, loops })
}

impl Joiner<'_> {
    /// Share of the links of a join that the part's twins that are placed have, too, less the share
    /// of those that they could have and have not.
    pub(super) fn as_twins(&self, part: usize, list: &[usize], state: &State) -> f64 {
        let own = &self.shapes.parts[part].loops;
        let (mut votes, mut sum) = (0usize, 0.0);
        for twin in &self.alike[part] {
            if state.placed[twin.part].is_none() {
                continue;
            }
            for &l in list {
                let link = &self.links[l];
                let Some(k) = own.iter().position(|&i| i == link.inner) else {
                    continue;
                };
                let other = twin.loops[k];
                if self.joined.contains(&(link.outer, other)) {
                    votes += 1;
                    let has = state.inner[link.outer].contains(&other);
                    sum += if has { 1.0 } else { -1.0 };
                }
            }
        }
        sum / votes.max(1) as f64
    }
}
