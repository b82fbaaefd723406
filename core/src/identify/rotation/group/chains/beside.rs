//! What is drawn on an axis and is beside it.

use super::super::joins::{Role, State};
use super::super::shapes::Shapes;
use super::Chain;

impl Chain {
    /// Rings in one plane, outer and inner, that are beside the axis although they are drawn on it,
    /// as a through hole in a flange may be: two ends of a part that fit at once are no chance.
    pub(super) fn beside(&self, shapes: &Shapes, state: &State) -> Vec<[usize; 2]> {
        let own = |i: usize| self.rings.iter().position(|r| r.outline == i);
        let off_axis = |pair: &[usize; 2]| {
            let off = pair.map(|r| {
                let ring = &self.rings[r];
                let place = state.placed[shapes.loops[ring.outline].part];
                place.map(|p| p.shift - ring.shift)
            });
            let slack = 2.0 * shapes.slack(shapes.error);
            matches!(off, [Some(p), Some(q)] if (p - q).abs() > slack)
        };
        let mut all: Vec<[usize; 2]> = Vec::new();
        for (outer, inner) in state.inner.iter().enumerate() {
            let Some(a) = own(outer).filter(|_| state.roles[outer] == Role::Flat) else {
                continue;
            };
            let inner = inner.iter().filter_map(|&i| own(i));
            all.extend(inner.map(|b| [a, b]).filter(off_axis));
        }
        let parts = |pair: &[usize; 2]| pair.map(|r| shapes.loops[self.rings[r].outline].part);
        let ends = |pair: &[usize; 2]| {
            let of = parts(pair);
            all.iter().filter(|p| parts(p) == of).count()
        };
        all.iter().filter(|p| ends(p) > 1).copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::super::super::group;
    use super::super::super::round::{Round, drawn};
    use crate::drawing::Graph;
    use crate::lift::Readings;

    /// Two through holes of a disc that are drawn on its axis.
    #[test]
    fn holes_in_front_of_an_axis_and_behind_it_stay_in_their_faces() {
        let cylinder = |y: f64, radius: f64| Round::cylinder([0.0, y], radius, 0.0, 0.5);
        let (drawing, loops) =
            drawn(&[cylinder(0.0, 2.0), cylinder(1.2, 0.3), cylinder(-1.2, 0.3)]);
        let found = group(&Readings::new(&drawing), &Graph::new(&drawing), &loops);
        let faces: BTreeSet<BTreeSet<usize>> = found[0]
            .faces
            .iter()
            .filter(|f| f.len() > 1)
            .map(|f| f.iter().copied().collect())
            .collect();
        // Of each cylinder the bottom, the top and two walls.
        let plate = [[0, 4, 8], [1, 5, 9]].map(BTreeSet::from);
        assert_eq!(faces, BTreeSet::from(plate));
    }
}
