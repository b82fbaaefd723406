//! Faces from the links that a search made true.

use std::collections::BTreeSet;

use super::Grouping;
use super::joins::{Join, Joiner, Role, State};
use super::trials::Step;

impl Joiner<'_> {
    /// The faces of a state that steps led to, not scored.
    pub(super) fn grouping<'s>(
        &self,
        steps: impl Iterator<Item = &'s Step>,
        state: &State,
    ) -> Grouping {
        let shapes = self.shapes;
        let count = shapes.loops.len();
        let mut owner: Vec<usize> = (0..count).collect();
        for (outer, inner) in state.inner.iter().enumerate() {
            for &i in inner {
                let (from, to) = (owner[i], owner[outer]);
                owner
                    .iter_mut()
                    .filter(|o| **o == from)
                    .for_each(|o| *o = to);
            }
        }
        let mut sure = vec![1.0; count];
        for step in steps {
            let shares = step.shares();
            let at = |j: &Join, i: usize| -> Vec<usize> {
                let touches = |l: &&usize| {
                    let link = &self.links[**l];
                    link.outer == i || link.inner == i
                };
                j.links.iter().filter(touches).copied().collect()
            };
            let ends = step.joins.iter().flat_map(|j| &j.links).flat_map(|&l| {
                let link = &self.links[l];
                [link.outer, link.inner]
            });
            let ends: BTreeSet<usize> = ends.collect();
            for i in ends {
                let own = at(&step.joins[step.chosen], i);
                let same = step.joins.iter().zip(&shares);
                let share: f64 = same.filter(|(j, _)| at(j, i) == own).map(|(_, s)| s).sum();
                sure[i] *= share;
            }
        }
        let mut faces: Vec<Vec<usize>> = vec![Vec::new(); count];
        for (i, &o) in owner.iter().enumerate() {
            faces[o].push(i);
        }
        faces.retain(|f| !f.is_empty());
        for face in &mut faces {
            let size = |i: &usize| shapes.loops[*i].area.abs();
            face.sort_by(|a, b| size(b).total_cmp(&size(a)).then(a.cmp(b)));
        }
        let turned: Vec<bool> = (0..shapes.parts.len())
            .map(|p| state.placed[p].map_or_else(|| shapes.volume(p) < 0.0, |place| place.turned))
            .collect();
        let used_as = |role: Role| {
            let used = faces
                .iter()
                .map(|f| f.len() > 1 && state.roles[f[0]] == role);
            used.collect()
        };
        Grouping {
            sureness: faces
                .iter()
                .map(|f| f.iter().map(|&i| sure[i]).fold(1.0, f64::min))
                .collect(),
            round: used_as(Role::Round),
            flat: used_as(Role::Flat),
            faces,
            reversed: shapes.loops.iter().map(|l| turned[l.part]).collect(),
            score: 0.0,
        }
    }
}
