//! Points along the curve in which surfaces meet, following what is drawn.

use glam::{DVec2, DVec3};

use crate::plan::side::GRAZING;
use crate::plan::support::{Support, meet};
use crate::plan::view::View;

use super::drawn::Drawn;

/// Steps along the curve: a cubic spline through that many points of a half turn is within 1e-7 of
/// it, relative to its radius.
const STEPS: usize = 48;

/// How much a jump in depth counts against being off the other surface.
const JUMP: f64 = 0.2;

/// A surface that the curve is on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lain {
    pub(super) support: Support,
    /// From which side the face on it is seen, as [`sides`](crate::plan::side::sides) tells.
    pub(super) side: Option<f64>,
}

/// Where the curve may pass.
#[derive(Debug, Clone, Copy)]
struct Place {
    point: DVec3,
    depth: f64,
    /// How far it is off the surfaces.
    off: f64,
}

/// Points on all surfaces, drawn along the edge, from its first vertex to its last.
///
/// Each drawn point is lifted onto the surfaces, the crossings picked that together are nearest to
/// all of them and go on most smoothly from end to end (by dynamic programming, Bellman 1957), and
/// then moved to where all surfaces meet. A face that is seen from one side is not crossed on the
/// other.
pub(super) fn trace(
    drawn: &Drawn<'_>,
    view: &View,
    surfaces: &[Lain],
    ends: [DVec3; 2],
) -> Vec<DVec3> {
    let supports: Vec<Support> = surfaces.iter().map(|s| s.support).collect();
    let flat = drawn.points(STEPS);
    let inner = flat[1..flat.len() - 1].iter();
    let layers: Vec<Vec<Place>> = inner
        .map(|p| {
            let (from, direction) = view.ray(*p);
            places(surfaces, &supports, view, (from, direction))
        })
        .filter(|layer| !layer.is_empty())
        .collect();
    let depth = |p: DVec3, q: DVec2| {
        let (from, direction) = view.ray(q);
        direction.dot(p - from)
    };
    let last = flat.len() - 1;
    let depths = [depth(ends[0], flat[0]), depth(ends[1], flat[last])];
    let mut points = vec![ends[0]];
    points.extend(smoothest(&layers, depths));
    points.push(ends[1]);
    points
}

/// The places on a line of sight where it crosses one of the surfaces.
fn places(
    surfaces: &[Lain],
    supports: &[Support],
    view: &View,
    (from, direction): (DVec3, DVec3),
) -> Vec<Place> {
    let wrong = |q: DVec3| {
        let seen = |s: &Lain| s.support.gradient(q).dot(view.toward(q));
        surfaces
            .iter()
            .any(|s| s.side.is_some_and(|side| side * seen(s) < -GRAZING))
    };
    let crossings = supports.iter().flat_map(|s| s.crossings(from, direction));
    let mut all: Vec<(DVec3, f64)> = crossings.map(|t| (from + direction * t, t)).collect();
    if all.iter().any(|(q, _)| !wrong(*q)) {
        all.retain(|(q, _)| !wrong(*q));
    }
    all.into_iter()
        .map(|(q, depth)| Place {
            point: meet(q, supports),
            depth,
            off: supports.iter().map(|s| s.distance(q).abs()).sum(),
        })
        .collect()
}

/// One place of each layer, so that all are near the surfaces and depth goes on evenly between the
/// depths of the ends.
fn smoothest(layers: &[Vec<Place>], [first, last]: [f64; 2]) -> Vec<DVec3> {
    let Some(start) = layers.first() else {
        return Vec::new();
    };
    // For each pair of neighbouring places: the least cost up to the later one, and the best place
    // before both. The end before the first layer is one place.
    let step = |before: f64, at: f64, next: f64| JUMP * (next - 2.0 * at + before).abs();
    let mut cost: Vec<Vec<f64>> = vec![
        start
            .iter()
            .map(|p| p.off + JUMP * (p.depth - first).abs())
            .collect(),
    ];
    let mut from: Vec<Vec<Vec<usize>>> = Vec::new();
    let mut earlier = vec![first];
    for pair in layers.windows(2) {
        let (at, next) = (&pair[0], &pair[1]);
        // cost[i][j]: place i before, place j at.
        let mut costs = vec![vec![f64::INFINITY; next.len()]; at.len()];
        let mut best = vec![vec![0; next.len()]; at.len()];
        for (j, here) in at.iter().enumerate() {
            for (k, there) in next.iter().enumerate() {
                for (i, &before) in earlier.iter().enumerate() {
                    let total = cost[i][j] + there.off + step(before, here.depth, there.depth);
                    if total < costs[j][k] {
                        costs[j][k] = total;
                        best[j][k] = i;
                    }
                }
            }
        }
        earlier = at.iter().map(|p| p.depth).collect();
        cost = costs;
        from.push(best);
    }
    let end = &layers[layers.len() - 1];
    let mut chosen = (f64::INFINITY, 0, 0);
    for (i, &before) in earlier.iter().enumerate() {
        for (j, here) in end.iter().enumerate() {
            let total = cost[i][j] + step(before, here.depth, last);
            if total < chosen.0 {
                chosen = (total, i, j);
            }
        }
    }
    let (_, mut before, mut at) = chosen;
    let mut points = vec![end[at].point];
    for (layer, best) in layers.iter().zip(&from).rev() {
        points.push(layer[before].point);
        (before, at) = (best[before][at], before);
    }
    points.reverse();
    points
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::*;
    use crate::drawing::{Curve2, Edge};
    use crate::lift::Camera;

    /// Two pipes of radius 1 and 0.5 that cross at right angles, seen from aside.
    fn pipes() -> [Support; 2] {
        let pipe = |axis, radius| Support::Cylinder {
            origin: DVec3::ZERO,
            axis,
            radius,
        };
        [pipe(DVec3::Y, 1.0), pipe(DVec3::Z, 0.5)]
    }

    /// The half of their curve for y < 0 or y > 0.
    fn half(t: f64) -> DVec3 {
        let (sin, cos) = t.sin_cos();
        let x = 0.5 * cos;
        DVec3::new(x, 0.5 * sin, (1.0 - x * x).sqrt())
    }

    #[test]
    fn the_side_that_is_seen_tells_which_half_of_a_curve_is_meant() {
        use std::f64::consts::PI;

        let turn = DMat3::from_rotation_x(1.2) * DMat3::from_rotation_y(0.1);
        let view = View::new(Camera::Parallel, turn);
        for start in [0.0, PI] {
            let curve: Vec<DVec3> = (1..40)
                .map(|i| half(start + PI * f64::from(i) / 40.0))
                .collect();
            let edge = Edge {
                v: [0, 1],
                points: curve.iter().map(|p| view.project(*p)).collect(),
                curve: Curve2::Polyline,
            };
            let seen = |p: &DVec3| pipes()[1].gradient(*p).dot(view.toward(*p));
            let side = curve.iter().map(seen).sum::<f64>().signum();
            let surfaces = [0, 1].map(|i| Lain {
                support: pipes()[i],
                side: (i == 1).then_some(side),
            });
            let ends = [curve[0], curve[curve.len() - 1]];
            for p in trace(&Drawn::new(&edge, &view), &view, &surfaces, ends) {
                assert!(pipes().iter().all(|s| s.distance(p).abs() < 1e-6));
                assert!(p.y * curve[20].y > 0.0, "{p} is on the other half");
            }
        }
    }

    #[test]
    fn both_ends_tell_how_a_curve_goes_on() {
        // Two branches of equal places; only the last end is on the second.
        let place = |depth: f64, off: f64| Place {
            point: DVec3::Z * depth,
            depth,
            off,
        };
        let layers: Vec<Vec<Place>> = (1..10)
            .map(|i| vec![place(0.0, 0.0), place(f64::from(i) * 0.1, 0.0)])
            .collect();
        let points = smoothest(&layers, [0.0, 1.0]);
        assert!(
            points
                .iter()
                .zip(1..)
                .all(|(p, i)| (p.z - f64::from(i) * 0.1).abs() < 1e-12)
        );
        assert!(smoothest(&layers, [0.0, 0.0]).iter().all(|p| p.z == 0.0));
        assert!(smoothest(&[], [0.0, 1.0]).is_empty());
    }
}
