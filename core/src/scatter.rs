//! How points in space are spread around their centroid.

use glam::{DMat3, DVec3};

/// The second moments of points.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scatter {
    pub(crate) centroid: DVec3,
    /// Sum of the outer products of the points' distances from the centroid, in squared units.
    pub(crate) matrix: DMat3,
}

impl Scatter {
    /// The scatter of points, at least one.
    pub(crate) fn new(points: &[DVec3]) -> Self {
        let centroid = points.iter().sum::<DVec3>() / points.len() as f64;
        let mut matrix = DMat3::ZERO;
        for p in points {
            let d = *p - centroid;
            matrix += DMat3::from_cols(d * d.x, d * d.y, d * d.z);
        }
        Self { centroid, matrix }
    }

    /// Sum of the squared distances from the centroid.
    pub(crate) fn trace(&self) -> f64 {
        self.matrix.x_axis.x + self.matrix.y_axis.y + self.matrix.z_axis.z
    }

    /// Unit normal of the plane through the centroid that is next to the points; `None` if they are
    /// one point. Of points on a line it is across that line.
    pub(crate) fn normal(&self) -> Option<DVec3> {
        // The eigenvector of the least eigenvalue, by inverse iteration. The shift keeps the matrix
        // of an exact plane invertible.
        let shift = DMat3::from_diagonal(DVec3::splat(1e-14 * self.trace()));
        let inverse = (self.matrix + shift).inverse();
        let mut normal = DVec3::new(0.36, 0.48, 0.8);
        for _ in 0..30 {
            normal = (inverse * normal).try_normalize()?;
        }
        Some(normal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_normal_is_across_a_thin_slab() {
        let slab: Vec<DVec3> = (0..60)
            .map(|i| {
                let (i, up) = (f64::from(i), f64::from(i % 2) - 0.5);
                DVec3::new(i.sin(), 1.7 * i.cos(), 0.3 * i.sin() + 1e-3 * up)
            })
            .collect();
        let scatter = Scatter::new(&slab);
        let normal = scatter.normal().unwrap();
        assert!(
            normal
                .cross(DVec3::new(-0.3, 0.0, 1.0).normalize())
                .length()
                < 1e-3
        );
        let along = scatter.matrix * normal;
        assert!(along.cross(normal).length() < 1e-9 * scatter.trace());
        assert!(Scatter::new(&[DVec3::ONE; 4]).normal().is_none());
    }
}
