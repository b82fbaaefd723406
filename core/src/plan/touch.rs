//! Surfaces that touch: a plane beside a cylinder as at a fillet, two cylinders side by side, the bends of
//! a pipe.
//!
//! Where surfaces touch, their common points are not well determined: a hair more or less and they
//! miss each other, or cut each other far from where they were meant to touch. So touching is made
//! exact, and vertices there are held on the line of contact.

use glam::DVec3;

use super::support::Support;
use super::touch_round;

/// Surfaces touch only if the vertex they share is this near to the line of contact, as a share of
/// the smaller radius.
const NEAR: f64 = 0.02;

/// Sweeps of [`make_exact`]; each takes a constant share off what is left.
const SWEEPS: usize = 300;

/// Makes surfaces touch that nearly do, with the least change of planes, axes and radii.
///
/// `contacts` are pairs of supports that share a vertex. Cylinders with one axis keep one axis, and
/// equal radii stay equal. All conditions are linear in the unknowns while directions stay, so
/// cyclic projection onto each of them (Kaczmarz 1937) ends at the nearest solution.
pub(super) fn make_exact(supports: &mut [Support], contacts: &[[usize; 2]], tolerance: f64) {
    let ordered: Vec<[usize; 2]> = contacts
        .iter()
        .map(|&[a, b]| {
            let rank = |s: usize| match supports[s] {
                Support::Plane { .. } => 0,
                Support::Cylinder { .. } => 1,
                _ => 2,
            };
            if rank(a) < rank(b) { [a, b] } else { [b, a] }
        })
        .collect();
    touch_round::line_up(supports, &ordered, tolerance);
    let mut unknowns = Unknowns::new(supports);
    let touching: Vec<[usize; 2]> = ordered
        .into_iter()
        .filter(|&[a, b]| {
            touches(&supports[a], &supports[b], tolerance)
                .next()
                .is_some()
        })
        .collect();
    for _ in 0..SWEEPS {
        let mut largest = 0f64;
        for &[a, b] in &touching {
            let (first, second) = (unknowns.at(supports, a), unknowns.at(supports, b));
            for touch in touches(&first, &second, f64::INFINITY) {
                largest = largest.max(touch.gap.abs());
                unknowns.correct([a, b], touch);
            }
        }
        if largest <= f64::EPSILON * tolerance {
            break;
        }
    }
    for s in 0..supports.len() {
        supports[s] = unknowns.at(supports, s);
    }
}

/// How two surfaces that nearly touch miss it.
#[derive(Debug, Clone, Copy)]
struct Touch {
    /// What is missing: positive if the second surface has to move against `across`.
    gap: f64,
    /// Unit direction across both surfaces, at the first one's side.
    across: DVec3,
    /// How the gap changes with the two radii, and with that of the second one's spine.
    slopes: [f64; 3],
}

/// How two surfaces miss touching each other, if by less than a tolerance: in one way, a pipe and its bend
/// in two. A plane comes first, a torus last.
fn touches(a: &Support, b: &Support, tolerance: f64) -> impl Iterator<Item = Touch> + use<> {
    let bend = touch_round::bend(a, b, tolerance).map(|bend| {
        bend.map(|(across, gap, spine)| Touch {
            gap,
            across,
            slopes: [0.0, 0.0, spine],
        })
    });
    touch(a, b, tolerance)
        .into_iter()
        .chain(bend.into_iter().flatten())
}

/// The touch of two surfaces that miss it by less than a tolerance; a plane comes first.
fn touch(a: &Support, b: &Support, tolerance: f64) -> Option<Touch> {
    let found = match (*a, *b) {
        (
            Support::Plane { normal, .. },
            Support::Cylinder {
                origin,
                axis,
                radius,
            },
        ) if normal.dot(axis).abs() < 1e-9 => {
            let height = a.distance(origin);
            let side = height.signum();
            Touch {
                gap: height - side * radius,
                across: normal,
                slopes: [0.0, -side, 0.0],
            }
        }
        (
            Support::Cylinder {
                origin: p,
                axis,
                radius: r,
            },
            Support::Cylinder {
                origin: q,
                axis: other,
                radius: s,
            },
        ) if axis.cross(other).length() < 1e-9 => {
            let between = (q - p).reject_from_normalized(axis);
            let distance = between.length();
            let across = between.try_normalize()?;
            let outside = distance - (r + s);
            let inside = distance - (r - s).abs();
            if outside.abs() <= inside.abs() {
                Touch {
                    gap: outside,
                    across,
                    slopes: [-1.0, -1.0, 0.0],
                }
            } else {
                let sign = (r - s).signum();
                Touch {
                    gap: inside,
                    across,
                    slopes: [-sign, sign, 0.0],
                }
            }
        }
        _ => return None,
    };
    (found.gap.abs() <= tolerance).then_some(found)
}

/// What may change: places across planes, axes shared by coaxial cylinders, shared radii.
struct Unknowns {
    /// Shift of every plane, or of every class of axes.
    shifts: Vec<DVec3>,
    radii: Vec<f64>,
    /// Radii of the spines of tori.
    spines: Vec<f64>,
    /// Class of the shift of every support.
    shift_of: Vec<usize>,
    /// Class of the radius of every support, that of the tube of a torus; planes have one of their own.
    radius_of: Vec<usize>,
}

impl Unknowns {
    fn new(supports: &[Support]) -> Self {
        let first = |same: &dyn Fn(&Support, &Support) -> bool| -> Vec<usize> {
            let twin = |s: usize| supports[..s].iter().position(|t| same(t, &supports[s]));
            (0..supports.len()).map(|s| twin(s).unwrap_or(s)).collect()
        };
        let radius = |s: &Support| match s {
            Support::Cylinder { radius, .. } => Some(*radius),
            Support::Torus { minor, .. } => Some(*minor),
            _ => None,
        };
        let spine = |s: &Support| match s {
            Support::Torus { major, .. } => *major,
            _ => 0.0,
        };
        Self {
            shifts: vec![DVec3::ZERO; supports.len()],
            radii: supports.iter().map(|s| radius(s).unwrap_or(0.0)).collect(),
            spines: supports.iter().map(spine).collect(),
            // Cones and tori follow a cylinder that they share the axis with.
            shift_of: first(&|a, b| match (a.axis(), b.axis()) {
                (Some((p, d)), Some((q, e))) => {
                    let aside = (q - p).reject_from_normalized(d);
                    let scale = p.distance(q).max(a.radius().min(b.radius()).min(1.0));
                    d.cross(e).length() < 1e-12 && aside.length() < 1e-9 * scale
                }
                _ => false,
            }),
            radius_of: first(&|a, b| radius(a).is_some() && radius(a) == radius(b)),
        }
    }

    /// A support with the changes made to it so far.
    fn at(&self, supports: &[Support], s: usize) -> Support {
        let origin = supports[s].origin() + self.shifts[self.shift_of[s]];
        match supports[s] {
            Support::Cylinder { axis, .. } => Support::Cylinder {
                origin,
                axis,
                radius: self.radii[self.radius_of[s]],
            },
            Support::Torus { axis, .. } => Support::Torus {
                center: origin,
                axis,
                major: self.spines[s],
                minor: self.radii[self.radius_of[s]],
            },
            other => other.with_origin(origin),
        }
    }

    /// The least change that closes a gap.
    fn correct(&mut self, pair: [usize; 2], touch: Touch) {
        let [r, s] = pair.map(|i| self.radius_of[i]);
        let [first, second, spine] = touch.slopes;
        let slopes = if r == s {
            [first + second, 0.0, spine]
        } else {
            touch.slopes
        };
        let norm = 2.0 + slopes.iter().map(|s| s * s).sum::<f64>();
        let step = touch.gap / norm;
        self.shifts[self.shift_of[pair[0]]] += touch.across * step;
        self.shifts[self.shift_of[pair[1]]] -= touch.across * step;
        self.radii[r] -= slopes[0] * step;
        self.radii[s] -= slopes[1] * step;
        self.spines[pair[1]] -= spine * step;
    }
}

/// A surface through the line of contact and across both surfaces, if they touch near a point.
pub(super) fn contact(a: &Support, b: &Support, near: DVec3, tolerance: f64) -> Option<Support> {
    let (a, b) = match (a, b) {
        (Support::Cylinder { .. }, Support::Plane { .. }) => (b, a),
        _ => (a, b),
    };
    let found = match touch(a, b, tolerance) {
        Some(touch) => Support::Plane {
            origin: b.origin(),
            normal: b.direction().cross(touch.across).try_normalize()?,
        },
        None => touch_round::contact(a, b, tolerance)?,
    };
    let close = found.distance(near).abs() <= NEAR * a.radius().min(b.radius());
    close.then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::support::meet;

    fn tube(x: f64, radius: f64) -> Support {
        Support::Cylinder {
            origin: DVec3::new(x, 0.0, 0.0),
            axis: DVec3::Z,
            radius,
        }
    }

    #[test]
    fn plane_is_moved_to_touch_and_the_vertex_lies_on_the_contact() {
        let plane = Support::Plane {
            origin: DVec3::new(0.0, 0.5 + 1e-6, 0.0),
            normal: DVec3::Y,
        };
        let mut supports = [plane, tube(0.0, 0.5)];
        make_exact(&mut supports, &[[0, 1]], 1e-5);
        let [plane, tube] = supports;
        assert!((tube.distance(DVec3::new(0.0, plane.origin().y, 0.0))).abs() < 1e-12);
        let start = DVec3::new(1e-3, 0.5, 0.3);
        let across = contact(&tube, &plane, start, 1e-5).unwrap();
        let p = meet(start, &[plane, tube, across]);
        assert!(p.x.abs() < 1e-12);
        assert!(p.distance(DVec3::new(0.0, 0.5, 0.3)) < 1e-6);
    }

    #[test]
    fn rounded_corners_and_the_circle_between_touch_all_sides() {
        // A square of side 2 with one rounded corner and the circle in its middle, all a bit off;
        // a hole on the circle's axis follows it.
        let plane = |x: f64, y: f64| Support::Plane {
            origin: DVec3::new(x, y, 0.0),
            normal: DVec3::new(x, y, 0.0).normalize(),
        };
        let at = |x: f64, y: f64, radius: f64| Support::Cylinder {
            origin: DVec3::new(x, y, 0.0),
            axis: DVec3::Z,
            radius,
        };
        let mut supports = [
            plane(1.000_001, 0.0),
            plane(-1.0, 0.0),
            plane(0.0, 0.999_998),
            plane(0.0, -1.000_002),
            at(0.0, 1e-6, 1.000_001),
            at(0.9, 0.9, 0.1),
            at(0.0, 1e-6, 0.5),
        ];
        let contacts = [[0, 4], [4, 1], [2, 4], [3, 4], [0, 5], [2, 5]];
        make_exact(&mut supports, &contacts, 1e-5);
        for [a, b] in contacts {
            let (a, b) = if a == 4 { (b, a) } else { (a, b) };
            let gap = touch(&supports[a], &supports[b], 1e-5).unwrap().gap;
            assert!(gap.abs() < 1e-13, "{gap:e}");
        }
        assert_eq!(supports[4].origin(), supports[6].origin());
        assert!(supports[0].origin().distance(DVec3::X) < 5e-6);
    }

    #[test]
    fn bends_of_a_pipe_are_made_to_touch_it() {
        let along = [DVec3::X, DVec3::Y, DVec3::new(0.0, 0.6, 0.8)];
        let pipe = |i: usize, off: DVec3, radius: f64| Support::Cylinder {
            origin: [
                DVec3::ZERO,
                DVec3::new(2.0, 1.0, 0.0),
                DVec3::new(2.0, 3.0, 0.0),
            ][i] + off,
            axis: along[i],
            radius,
        };
        // Each in the plane of the two pipes, tangent to both.
        let bend = |i: usize, off: DVec3, major: f64| {
            let corner = [DVec3::new(2.0, 0.0, 0.0), DVec3::new(2.0, 3.0, 0.0)][i];
            let (d, e) = (-along[i], along[i + 1]);
            let half = (d.dot(e).acos() / 2.0).sin();
            let axis = along[i].cross(along[i + 1]).normalize();
            Support::Torus {
                center: corner + (d + e).normalize() * (0.5 / half) + off,
                axis: (axis + off).normalize(),
                major,
                minor: 0.1 + 1e-6,
            }
        };
        let off = DVec3::new(1e-6, -2e-6, 1.5e-6);
        let mut supports = [
            pipe(0, off, 0.1),
            pipe(1, -off, 0.1),
            pipe(2, DVec3::ZERO, 0.1),
            bend(0, off, 0.5 + 2e-6),
            bend(1, -off, 0.5 - 1e-6),
        ];
        let contacts = [[0, 3], [3, 1], [1, 4], [2, 4]];
        make_exact(&mut supports, &contacts, 1e-5);
        for [a, b] in [[0, 3], [1, 3], [1, 4], [2, 4]] {
            let gaps = touches(&supports[a], &supports[b], 1e-12);
            assert_eq!(gaps.count(), 2, "{:?} {:?}", supports[a], supports[b]);
            assert_eq!(supports[a].radius(), supports[b].radius());
        }
        assert!(supports[3].origin().distance(DVec3::new(1.5, 0.5, 0.0)) < 1e-5);
    }

    #[test]
    fn plane_that_cuts_stays() {
        let plane = Support::Plane {
            origin: DVec3::new(0.0, 0.4, 0.0),
            normal: DVec3::Y,
        };
        let mut supports = [plane, tube(0.0, 0.5)];
        make_exact(&mut supports, &[[0, 1]], 1e-5);
        assert_eq!(supports[0], plane);
        assert_eq!(
            contact(&plane, &tube(0.0, 0.5), DVec3::new(0.3, 0.4, 0.0), 1e-5),
            None
        );
    }

    #[test]
    fn cylinders_touch_from_outside_and_inside() {
        let near = DVec3::new(0.5, 1e-4, 0.0);
        for other in [tube(0.8, 0.3), tube(0.2, 0.3)] {
            let found = contact(&tube(0.0, 0.5), &other, near, 1e-6).unwrap();
            assert!(found.distance(DVec3::new(0.5, 0.0, 7.0)).abs() < 1e-15);
        }
        assert_eq!(contact(&tube(0.0, 0.5), &tube(0.9, 0.3), near, 1e-6), None);
        assert_eq!(contact(&tube(0.0, 0.5), &tube(0.0, 0.5), near, 1e-6), None);
    }
}
