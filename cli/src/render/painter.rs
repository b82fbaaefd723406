//! The order in which polygons in space are painted, far ones first.
//!
//! Sorting by distance fails for polygons of different sizes. Space is divided by the planes of the
//! polygons instead (binary space partitioning, Fuchs, Kedem and Naylor 1980): what lies beyond a
//! plane is painted before what lies in it, and that before what lies in front. Polygons that a
//! plane crosses are cut.

use glam::DVec3;

/// A plane convex polygon that faces the viewer.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Polygon {
    /// Corners in order.
    pub(crate) points: Vec<DVec3>,
    /// Unit normal; `z` is positive.
    pub(crate) normal: DVec3,
    /// What the caller knows it by.
    pub(crate) tag: usize,
}

/// What is still to be done, the next thing last.
enum Task {
    Divide(Vec<Polygon>),
    Paint(Vec<Polygon>),
}

/// Sorts polygons that do not cross each other for a viewer far away along +z, cutting where
/// needed. Points within `tolerance` of a plane count as in it.
pub(crate) fn order(polygons: Vec<Polygon>, tolerance: f64) -> Vec<Polygon> {
    let mut painted = Vec::with_capacity(polygons.len());
    let mut tasks = vec![Task::Divide(polygons)];
    while let Some(task) = tasks.pop() {
        match task {
            Task::Paint(polygons) => painted.extend(polygons),
            Task::Divide(polygons) => {
                if let Some([far, within, near]) = divide(polygons, tolerance) {
                    tasks.push(Task::Divide(near));
                    tasks.push(Task::Paint(within));
                    tasks.push(Task::Divide(far));
                }
            }
        }
    }
    painted
}

/// Divides polygons by the plane of the largest one, which cuts the fewest others: beyond the
/// plane, in it, in front of it.
fn divide(polygons: Vec<Polygon>, tolerance: f64) -> Option<[Vec<Polygon>; 3]> {
    let largest = polygons.iter().max_by(|a, b| area(a).total_cmp(&area(b)))?;
    let (normal, origin) = (largest.normal, *largest.points.first()?);
    let [mut far, mut within, mut near] = [Vec::new(), Vec::new(), Vec::new()];
    for polygon in polygons {
        let heights: Vec<f64> = polygon
            .points
            .iter()
            .map(|p| normal.dot(*p - origin))
            .collect();
        let above = heights.iter().any(|h| *h > tolerance);
        let below = heights.iter().any(|h| *h < -tolerance);
        match (below, above) {
            (false, false) => within.push(polygon),
            (true, false) => far.push(polygon),
            (false, true) => near.push(polygon),
            (true, true) => {
                far.extend(part(&polygon, &heights, -1.0));
                near.extend(part(&polygon, &heights, 1.0));
            }
        }
    }
    if within.is_empty() {
        // Numbers that are not finite have no place; nothing is painted for them.
        return None;
    }
    Some([far, within, near])
}

/// The part of a convex polygon on one side of a plane; `heights` are its corners' distances.
fn part(polygon: &Polygon, heights: &[f64], side: f64) -> Option<Polygon> {
    let mut points = Vec::with_capacity(polygon.points.len() + 1);
    for (i, (p, h)) in polygon.points.iter().zip(heights).enumerate() {
        let j = (i + 1) % heights.len();
        let (q, k) = (polygon.points[j], heights[j]);
        if h * side >= 0.0 {
            points.push(*p);
        }
        if h * k < 0.0 {
            points.push(p.lerp(q, h / (h - k)));
        }
    }
    (points.len() >= 3).then_some(Polygon {
        points,
        normal: polygon.normal,
        tag: polygon.tag,
    })
}

fn area(polygon: &Polygon) -> f64 {
    let [first, rest @ ..] = polygon.points.as_slice() else {
        return 0.0;
    };
    let sum: DVec3 = rest
        .windows(2)
        .map(|w| (w[0] - first).cross(w[1] - first))
        .sum();
    sum.length() / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle facing the viewer.
    fn triangle(points: [[f64; 3]; 3], tag: usize) -> Polygon {
        let points = points.map(DVec3::from_array).to_vec();
        let normal = (points[1] - points[0]).cross(points[2] - points[0]);
        assert!(normal.z > 0.0);
        Polygon {
            normal: normal.normalize(),
            points,
            tag,
        }
    }

    #[test]
    fn nearer_polygons_come_later() {
        let at = |z| [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
        let polygons = vec![
            triangle(at(0.5), 0),
            triangle(at(2.0), 1),
            triangle(at(-1.0), 2),
        ];
        let tags: Vec<usize> = order(polygons, 1e-9).iter().map(|p| p.tag).collect();
        assert_eq!(tags, [2, 0, 1]);
    }

    #[test]
    fn three_bars_that_overlap_in_a_ring_are_cut() {
        // Each bar's head lies over the next one's tail: no order exists without a cut.
        let bar = |turn: f64, tag| {
            let place = |x: f64, y: f64, z: f64| {
                let (sin, cos) = turn.to_radians().sin_cos();
                [cos * x - sin * y, sin * x + cos * y, z]
            };
            let corners = [
                place(-3.0, -1.2, -0.5),
                place(3.0, -0.9, 0.5),
                place(-3.0, -0.6, -0.5),
            ];
            triangle(corners, tag)
        };
        let polygons = vec![bar(0.0, 0), bar(120.0, 1), bar(240.0, 2)];
        let whole: f64 = polygons.iter().map(area).sum();
        let painted = order(polygons, 1e-9);
        assert!(painted.len() > 3);
        let sum: f64 = painted.iter().map(area).sum();
        assert!((sum - whole).abs() < 1e-9, "cutting keeps the area");
    }

    #[test]
    fn polygons_without_a_place_end_the_work() {
        let mut polygon = triangle([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], 0);
        polygon.normal = DVec3::NAN;
        assert!(order(vec![polygon], 1e-9).len() <= 1);
        assert!(order(Vec::new(), 1e-9).is_empty());
    }
}
