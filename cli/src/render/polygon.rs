//! Plane polygons with holes, as lists of closed rings.

use glam::DVec2;

/// Signed area of a ring: positive if it runs counter-clockwise with y upwards.
pub(crate) fn ring_area(ring: &[DVec2]) -> f64 {
    sides(ring).map(|(a, b)| a.perp_dot(b)).sum::<f64>() / 2.0
}

/// Whether `p` lies inside by the even-odd rule.
pub(crate) fn contains(rings: &[Vec<DVec2>], p: DVec2) -> bool {
    let crossings = rings
        .iter()
        .flat_map(|ring| sides(ring))
        .filter(|(a, b)| {
            (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)
        })
        .count();
    crossings % 2 == 1
}

/// Distance of `p` from the nearest side.
pub(crate) fn boundary_distance(rings: &[Vec<DVec2>], p: DVec2) -> f64 {
    rings
        .iter()
        .flat_map(|ring| sides(ring))
        .map(|(a, b)| segment_distance(a, b, p))
        .fold(f64::INFINITY, f64::min)
}

/// A point inside with room around it for a label of radius `radius`, away from the labels in
/// `taken`: the best of a grid. `None` if no grid point is inside.
pub(crate) fn label_point(rings: &[Vec<DVec2>], taken: &[DVec2], radius: f64) -> Option<DVec2> {
    const STEPS: usize = 24;
    let points = || rings.iter().flatten();
    let min = points().fold(DVec2::INFINITY, |m, p| m.min(*p));
    let max = points().fold(DVec2::NEG_INFINITY, |m, p| m.max(*p));
    let reach = DVec2::splat(2.0 * radius);
    let near: Vec<DVec2> = taken
        .iter()
        .copied()
        .filter(|t| t.cmpge(min - reach).all() && t.cmple(max + reach).all())
        .collect();
    let mut best = None;
    for i in 0..STEPS {
        for j in 0..STEPS {
            let share = DVec2::new(i as f64 + 0.5, j as f64 + 0.5) / STEPS as f64;
            let p = min + (max - min) * share;
            if !contains(rings, p) {
                continue;
            }
            let room = boundary_distance(rings, p);
            let gap = near
                .iter()
                .map(|t| t.distance(p))
                .fold(f64::INFINITY, f64::min);
            // Beyond what the label needs, more room counts little.
            let score = room.min(radius) + (0.5 * gap).min(radius) + 0.05 * room;
            if best.is_none_or(|(s, _)| score > s) {
                best = Some((score, p));
            }
        }
    }
    best.map(|(_, p)| p)
}

fn sides(ring: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    let next = ring.iter().skip(1).chain(ring.first());
    ring.iter().copied().zip(next.copied())
}

fn segment_distance(a: DVec2, b: DVec2, p: DVec2) -> f64 {
    let d = b - a;
    let length = d.length_squared();
    let t = if length > 0.0 {
        ((p - a).dot(d) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (a + d * t).distance(p)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(center: DVec2, half: f64) -> Vec<DVec2> {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| center + half * DVec2::new(x, y))
            .to_vec()
    }

    #[test]
    fn a_hole_is_outside() {
        let rings = vec![square(DVec2::ZERO, 4.0), square(DVec2::ZERO, 2.0)];
        assert!(contains(&rings, DVec2::new(3.0, 0.1)));
        assert!(!contains(&rings, DVec2::new(0.3, 0.1)));
        assert_eq!(boundary_distance(&rings, DVec2::new(2.5, 0.0)), 0.5);
        assert_eq!(ring_area(&rings[0]), 64.0);
    }

    #[test]
    fn labels_stay_inside_and_apart() {
        let rings = vec![square(DVec2::ZERO, 4.0), square(DVec2::ZERO, 2.0)];
        let first = label_point(&rings, &[], 1.0).unwrap();
        let second = label_point(&rings, &[first], 1.0).unwrap();
        for p in [first, second] {
            assert!(contains(&rings, p));
            assert!(boundary_distance(&rings, p) > 0.8);
        }
        assert!(first.distance(second) >= 2.0);
    }

    #[test]
    fn a_ring_without_area_has_no_label_point() {
        let flat = vec![vec![DVec2::ZERO, DVec2::X, DVec2::ZERO]];
        assert_eq!(label_point(&flat, &[], 1.0), None);
        assert_eq!(label_point(&[], &[], 1.0), None);
    }
}
