//! Closed polylines in the plane; the last point is not repeated.

use glam::DVec2;

/// Area, positive if the polygon runs counter-clockwise.
pub(crate) fn signed_area(polygon: &[DVec2]) -> f64 {
    let n = polygon.len();
    (0..n)
        .map(|i| polygon[i].perp_dot(polygon[(i + 1) % n]))
        .sum::<f64>()
        / 2.0
}

/// Whether a point is inside, by the even-odd rule.
pub fn contains(polygon: &[DVec2], p: DVec2) -> bool {
    let mut inside = false;
    let n = polygon.len();
    for i in 0..n {
        let (a, b) = (polygon[i], polygon[(i + 1) % n]);
        if (a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x {
            inside = !inside;
        }
    }
    inside
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_has_an_area_and_an_inside() {
        let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y].map(|p| 2.0 * p);
        assert_eq!(signed_area(&square), 4.0);
        assert!(contains(&square, DVec2::ONE));
        assert!(!contains(&square, DVec2::new(2.5, 1.0)));
        assert!(!contains(&[], DVec2::ONE));
    }
}
