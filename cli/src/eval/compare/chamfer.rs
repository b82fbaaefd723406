//! Chamfer distance between two surfaces of triangles.

use glam::DVec3;

use super::tree::Tree;
use crate::eval::random::Random;

/// Points on each surface.
const POINTS: usize = 10_000;

/// A surface of triangles, with points spread evenly over it.
#[derive(Debug)]
pub(super) struct Surface {
    tree: Tree,
    points: Vec<DVec3>,
}

impl Surface {
    /// `None` if the triangles have no area.
    pub(super) fn new(triangles: Vec<[DVec3; 3]>) -> Option<Self> {
        let points = spread(&triangles, POINTS)?;
        Some(Self {
            tree: Tree::new(triangles),
            points,
        })
    }

    /// Mean distance of this surface's points from the other one, and the other way, added.
    ///
    /// Distances are to the surface itself, not to the other one's points: those are far apart, and
    /// would tell two samples of one surface apart.
    pub(super) fn chamfer(&self, other: &Self) -> f64 {
        self.apart(other) + other.apart(self)
    }

    fn apart(&self, other: &Self) -> f64 {
        let sum: f64 = self.points.iter().map(|p| other.tree.distance(*p)).sum();
        sum / self.points.len() as f64
    }
}

/// Points spread over triangles by area: one in each of `count` equal shares, so that no part is
/// missed by chance.
fn spread(triangles: &[[DVec3; 3]], count: usize) -> Option<Vec<DVec3>> {
    let area = |[a, b, c]: &[DVec3; 3]| (*b - *a).cross(*c - *a).length() / 2.0;
    let total: f64 = triangles.iter().map(area).sum();
    if !(total.is_finite() && total > 0.0) {
        return None;
    }
    let mut random = Random::new(1, "chamfer");
    let mut points = Vec::with_capacity(count);
    let mut passed = 0.0;
    let step = total / count as f64;
    for triangle in triangles {
        passed += area(triangle);
        while points.len() < count && (points.len() as f64 + 0.5) * step <= passed {
            let (u, v) = (random.unit(), random.unit());
            let (u, v) = if u + v > 1.0 {
                (1.0 - u, 1.0 - v)
            } else {
                (u, v)
            };
            let [a, b, c] = *triangle;
            points.push(a + (b - a) * u + (c - a) * v);
        }
    }
    Some(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(z: f64) -> Vec<[DVec3; 3]> {
        let [a, b, c, d] =
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| DVec3::new(x, y, z));
        vec![[a, b, c], [a, c, d]]
    }

    #[test]
    fn a_surface_is_no_way_from_itself() {
        // Cut another way, the same square.
        let [a, b, c, d] = [
            square(0.0)[0][0],
            square(0.0)[0][1],
            square(0.0)[0][2],
            square(0.0)[1][2],
        ];
        let one = Surface::new(square(0.0)).unwrap();
        let other = Surface::new(vec![[a, b, d], [b, c, d]]).unwrap();
        assert!(one.chamfer(&other) < 1e-15);
    }

    #[test]
    fn squares_beside_each_other_are_twice_their_distance_apart() {
        let [one, other] = [0.0, 0.25].map(|z| Surface::new(square(z)).unwrap());
        assert!((one.chamfer(&other) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn points_are_spread_by_area() {
        let [small, large] =
            [0.1, 1.0].map(|s| [DVec3::ZERO, DVec3::X * s, DVec3::Y * s].map(|p| p + DVec3::Z * s));
        let points = spread(&[small, large], 1010).unwrap();
        assert_eq!(points.len(), 1010);
        assert_eq!(points.iter().filter(|p| p.z < 0.5).count(), 10);
        assert!(spread(&[[DVec3::ONE; 3]], 10).is_none());
    }

    #[test]
    fn twenty_thousand_distances_are_quick() {
        // A ball of 20,000 triangles.
        let at = |i: usize, j: usize| {
            let (u, v) = (i as f64 * 0.0628_318, j as f64 * 0.0314_159);
            DVec3::new(u.cos() * v.sin(), u.sin() * v.sin(), v.cos())
        };
        let mut triangles = Vec::new();
        for i in 0..100 {
            for j in 0..100 {
                let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        let ball = Surface::new(triangles.clone()).unwrap();
        let larger = triangles.iter().map(|t| t.map(|p| p * 1.01)).collect();
        let chamfer = ball.chamfer(&Surface::new(larger).unwrap());
        assert!((chamfer - 0.02).abs() < 5e-4, "{chamfer}");
    }
}
