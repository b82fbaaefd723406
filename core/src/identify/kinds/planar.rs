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
    for &e in looks
        .iter()
        .filter(|l| l.is_curved())
        .flat_map(|l| &l.silhouettes)
    {
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

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::drawing::Edge;

    /// A cylinder that stands on its end, seen from above: two circles and two silhouettes.
    fn cylinder() -> Drawing {
        let half = |from: f64, y: f64| -> Vec<DVec2> {
            (0..=48)
                .map(|k| from + std::f64::consts::PI * f64::from(k) / 48.0)
                .map(|t| DVec2::new(t.cos(), y + 0.4 * t.sin()))
                .collect()
        };
        let pi = std::f64::consts::PI;
        let curves = [
            ([0, 1], half(0.0, 0.0)),
            ([1, 0], half(pi, 0.0)),
            ([2, 3], half(0.0, 1.5)),
            ([3, 2], half(pi, 1.5)),
            ([0, 2], vec![DVec2::X, DVec2::new(1.0, 1.5)]),
            ([1, 3], vec![DVec2::NEG_X, DVec2::new(-1.0, 1.5)]),
        ];
        let edges: Vec<Edge> = curves
            .into_iter()
            .map(|(v, points)| Edge::drawn(v, points))
            .collect();
        Drawing::orthographic(
            vec![
                edges[0].points[0],
                edges[1].points[0],
                edges[2].points[0],
                edges[3].points[0],
            ],
            edges,
        )
    }

    fn walk(signed: &[i64]) -> Vec<CoEdge> {
        signed
            .iter()
            .map(|k| CoEdge::new(k.unsigned_abs() as usize - 1, *k < 0))
            .collect()
    }

    #[test]
    fn silhouettes_tell_the_sides_of_a_cylinder_from_its_ends() {
        let drawing = cylinder();
        let loops = [
            walk(&[-1, -2]),
            walk(&[3, 4]),
            walk(&[1, 6, -3, -5]),
            walk(&[2, 5, -4, -6]),
        ];
        let loops: Vec<&[CoEdge]> = loops.iter().map(Vec::as_slice).collect();
        use SurfaceKind::{Cylinder, Plane};
        assert_eq!(
            kinds_of(&drawing, &loops),
            [Plane, Plane, Cylinder, Cylinder]
        );
    }

    #[test]
    fn no_loops_have_no_kinds() {
        assert_eq!(kinds_of(&cylinder(), &[]), []);
        assert_eq!(kinds_of(&cylinder(), &[&[]]), [SurfaceKind::Plane]);
    }
}
