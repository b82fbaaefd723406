//! Walls that touch the circle in which a plane cuts a cone, as the sides of a chamfered nut do.
//!
//! Wall and cone meet in a hyperbola whose vertex is where the wall touches the circle. A hair more
//! or less and the curves there cross or part, so touching is made exact.

use glam::DVec3;

use super::support::Support;

/// Sweeps of [`make_exact`].
const SWEEPS: usize = 200;

/// Sine of the angle within which directions are parallel, or at right angles.
const ANGLE: f64 = 1e-9;

/// A wall, a cone and the plane that cuts the cone in a circle: indices of supports.
type Triple = [usize; 3];

/// Distance of a wall from the axis less the radius of the circle.
fn gap(wall: &Support, cone: &Support, end: &Support) -> Option<f64> {
    let (Support::Plane { normal, .. }, Support::Plane { normal: up, .. }) = (*wall, *end) else {
        return None;
    };
    let Support::Cone { apex, axis, angle } = *cone else {
        return None;
    };
    if normal.dot(axis).abs() > ANGLE || up.cross(axis).length() > ANGLE {
        return None;
    }
    let height = up.dot(end.origin() - apex) / up.dot(axis);
    Some(wall.distance(apex).abs() - height * angle.tan())
}

/// The walls, cones and ends that meet in a vertex and nearly touch; `corners` are the supports of
/// each vertex.
pub(super) fn triples<'a>(
    supports: &[Support],
    corners: impl Iterator<Item = &'a [usize]>,
    tolerance: f64,
) -> Vec<Triple> {
    let mut found = Vec::new();
    for corner in corners {
        for &c in corner {
            if !matches!(supports[c], Support::Cone { .. }) {
                continue;
            }
            for &w in corner {
                for &e in corner {
                    let near = gap(&supports[w], &supports[c], &supports[e]);
                    if near.is_some_and(|g| g.abs() <= tolerance) {
                        found.push([w, c, e]);
                    }
                }
            }
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}

/// Makes walls touch by moving them across, and the cones along their axes, as little as possible
/// (Kaczmarz 1937).
pub(super) fn make_exact(supports: &mut [Support], triples: &[Triple]) {
    for _ in 0..SWEEPS {
        let mut largest = 0f64;
        for &[w, c, e] in triples {
            let Some(gap) = gap(&supports[w], &supports[c], &supports[e]) else {
                continue;
            };
            let Support::Cone { apex, axis, angle } = supports[c] else {
                continue;
            };
            largest = largest.max(gap.abs());
            let slope = angle.tan();
            let step = gap / (1.0 + slope * slope);
            let side = supports[w].distance(apex).signum();
            let wall = supports[w].origin() + supports[w].direction() * (step * side);
            supports[w] = supports[w].with_origin(wall);
            supports[c] = supports[c].with_origin(apex - axis * (step * slope));
        }
        if largest <= 1e-15 {
            break;
        }
    }
}

/// The plane through the axis and the point of touch.
pub(super) fn contact(triple: Triple, supports: &[Support]) -> Option<Support> {
    let Support::Cone { apex, axis, .. } = supports[triple[1]] else {
        return None;
    };
    let across: DVec3 = supports[triple[0]].direction();
    let normal = axis.cross(across).try_normalize()?;
    Some(Support::Plane {
        origin: apex,
        normal,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walls_of_a_nut_touch_the_circle_of_its_chamfer() {
        let wall = |turn: f64, off: f64| {
            let normal = DVec3::new(turn.cos(), turn.sin(), 0.0);
            Support::Plane {
                origin: normal * (1.0 + off),
                normal,
            }
        };
        let mut supports = vec![
            wall(0.0, 1e-6),
            wall(1.0, -2e-6),
            wall(2.0, 1e-6),
            Support::Cone {
                apex: DVec3::new(0.0, 0.0, 1.5),
                axis: -DVec3::Z,
                angle: 1.0 - 1e-6,
            },
            Support::Plane {
                origin: DVec3::Z * (1.5 - 1.0 / 1f64.tan()),
                normal: DVec3::Z,
            },
        ];
        let corners = [[0, 3, 4], [1, 3, 4], [2, 3, 4]];
        let found = triples(&supports, corners.iter().map(|c| &c[..]), 1e-5);
        assert_eq!(found.len(), 3);
        make_exact(&mut supports, &found);
        for [w, c, e] in found {
            let gap = gap(&supports[w], &supports[c], &supports[e]).unwrap();
            assert!(gap.abs() < 1e-14, "{gap:e}");
        }
    }
}
