//! The parts of segments that no triangle hides.

use glam::{DVec2, DVec3, Vec3Swizzles};

/// Triangles seen from far away along +z, ready to be asked what they hide.
#[derive(Debug)]
pub(crate) struct Screen {
    triangles: Vec<[DVec3; 3]>,
    bias: f64,
}

impl Screen {
    /// A screen of triangles; what lies less than `bias` behind one is not hidden by it.
    pub(crate) fn new(triangles: Vec<[DVec3; 3]>, bias: f64) -> Self {
        Self { triangles, bias }
    }

    /// The visible parts of the segment from `a` to `b`, as pairs of points in order.
    pub(crate) fn visible(&self, a: DVec3, b: DVec3) -> Vec<[DVec3; 2]> {
        let mut hidden: Vec<[f64; 2]> = self
            .triangles
            .iter()
            .filter_map(|t| hidden_by(t, a, b, self.bias))
            .collect();
        hidden.sort_unstable_by(|p, q| p[0].total_cmp(&q[0]));
        let mut parts = Vec::new();
        let mut from = 0.0;
        for [start, end] in hidden {
            if start > from {
                parts.push([from, start]);
            }
            from = end.max(from);
        }
        if from < 1.0 {
            parts.push([from, 1.0]);
        }
        // What is left between two triangles by rounding is no line.
        parts.retain(|[s, e]| e - s > 1e-6);
        parts
            .into_iter()
            .map(|part| part.map(|t| a.lerp(b, t)))
            .collect()
    }
}

/// The stretch of the segment that lies behind a triangle, as parameters from 0 to 1.
fn hidden_by(triangle: &[DVec3; 3], a: DVec3, b: DVec3, bias: f64) -> Option<[f64; 2]> {
    let [p, q, r] = triangle.map(|c| c.xy());
    let (min, max) = (p.min(q).min(r), p.max(q).max(r));
    if a.xy().min(b.xy()).cmpge(max).any() || a.xy().max(b.xy()).cmple(min).any() {
        return None;
    }
    if triangle.iter().all(|c| c.z <= a.z.min(b.z)) {
        return None;
    }
    let mut range = [0.0, 1.0];
    // Inside the triangle means left of its three sides; each is a linear condition on the
    // parameter. The fourth: the triangle's plane is nearer to the viewer.
    for (s, e) in [(p, q), (q, r), (r, p)] {
        let left = |x: DVec3| (e - s).perp_dot(x.xy() - s);
        clip(&mut range, left(a), left(b))?;
    }
    let normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    if normal.z <= 0.0 {
        return None;
    }
    let behind = |x: DVec3| {
        let slope = DVec2::new(normal.x, normal.y).dot(x.xy() - triangle[0].xy()) / normal.z;
        (triangle[0].z - slope) - x.z - bias
    };
    clip(&mut range, behind(a), behind(b))?;
    Some(range)
}

/// Cuts a parameter range to where the linear function with the given values at 0 and 1 is
/// positive; `None` if nothing is left.
fn clip(range: &mut [f64; 2], at_0: f64, at_1: f64) -> Option<()> {
    match (at_0 > 0.0, at_1 > 0.0) {
        (true, true) => {}
        (false, false) => return None,
        (true, false) => range[1] = range[1].min(at_0 / (at_0 - at_1)),
        (false, true) => range[0] = range[0].max(at_0 / (at_0 - at_1)),
    }
    (range[0] < range[1]).then_some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn screen() -> Screen {
        let corner = |x: f64, y: f64| DVec3::new(x, y, 1.0);
        let triangle = [corner(0.0, 0.0), corner(2.0, 0.0), corner(0.0, 2.0)];
        Screen::new(vec![triangle], 1e-6)
    }

    #[test]
    fn the_part_behind_a_triangle_is_cut_out() {
        let at = |x: f64| DVec3::new(x, 0.5, 0.0);
        let parts = screen().visible(at(-1.0), at(3.0));
        let expected = [[at(-1.0), at(0.0)], [at(1.5), at(3.0)]];
        assert_eq!(parts.len(), 2);
        for (part, expected) in parts.iter().zip(expected) {
            assert!(part[0].distance(expected[0]) < 1e-9);
            assert!(part[1].distance(expected[1]) < 1e-9);
        }
    }

    #[test]
    fn what_is_in_front_or_on_the_triangle_is_visible() {
        for z in [1.0, 2.0] {
            let at = |x: f64| DVec3::new(x, 0.5, z);
            assert_eq!(screen().visible(at(-1.0), at(3.0)), [[at(-1.0), at(3.0)]]);
        }
    }

    #[test]
    fn a_segment_that_pierces_the_triangle_is_half_visible() {
        let (a, b) = (DVec3::new(0.4, 0.4, 0.0), DVec3::new(0.6, 0.6, 2.0));
        let parts = screen().visible(a, b);
        assert_eq!(parts.len(), 1);
        assert!((parts[0][0].z - 1.0).abs() < 1e-5);
        assert_eq!(parts[0][1], b);
    }
}
