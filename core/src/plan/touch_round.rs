//! Round surfaces that touch: fillets beside what they round, and bends of pipes.
//!
//! Around a common axis surfaces are lines and circles in the half plane of distance from the axis
//! and height along it, and touch where these do.

use glam::{DVec2, DVec3};

use super::support::Support;

/// Sine of the angle within which directions are parallel, or at right angles.
const ANGLE: f64 = 1e-7;

/// What a surface is in the half plane beside its axis: x the distance from it, y the height.
#[derive(Debug, Clone, Copy)]
enum Profile {
    /// Through a point, with a unit normal.
    Line(DVec2, DVec2),
    Circle(DVec2, f64),
}

/// A surface that crosses both of two touching surfaces where they touch: a vertex there is held on
/// it. `None` if they do not touch within `tolerance`.
pub(super) fn contact(a: &Support, b: &Support, tolerance: f64) -> Option<Support> {
    across(a, b, tolerance)
        .or_else(|| across(b, a, tolerance))
        .or_else(|| coaxial(a, b, tolerance))
}

/// How far a pipe and its bend, a torus, miss touching each other, if by less than `tolerance`: two unit
/// directions, how far the torus is off along each, and the slope of that with the radius of its spine.
pub(super) fn bend(
    pipe: &Support,
    torus: &Support,
    tolerance: f64,
) -> Option<[(DVec3, f64, f64); 2]> {
    let (
        &Support::Cylinder {
            origin,
            axis,
            radius,
        },
        &Support::Torus {
            center,
            axis: around,
            major,
            minor,
        },
    ) = (pipe, torus)
    else {
        return None;
    };
    if axis.dot(around).abs() > ANGLE || (radius - minor).abs() > tolerance {
        return None;
    }
    let aside = around.cross(axis).try_normalize()?;
    let off = center - origin;
    let side = aside.dot(off).signum();
    let gaps = [
        (around, around.dot(off), 0.0),
        (aside, aside.dot(off) - side * major, -side),
    ];
    gaps.iter().all(|g| g.1.abs() <= tolerance).then_some(gaps)
}

/// The plane across where a pipe goes on straight after its bend: they touch in a circle.
fn across(pipe: &Support, torus: &Support, tolerance: f64) -> Option<Support> {
    bend(pipe, torus, tolerance).map(|_| Support::Plane {
        origin: torus.origin(),
        normal: pipe.direction(),
    })
}

/// Turns bends into the plane of the pipes beside them, and gives them the pipes' radius; `contacts` are
/// pairs of supports, the torus last.
pub(super) fn line_up(supports: &mut [Support], contacts: &[[usize; 2]], tolerance: f64) {
    /// Sine of the angle that a bend may be turned by.
    const TURN: f64 = 1e-4;
    for t in 0..supports.len() {
        let Support::Torus { axis, minor, .. } = supports[t] else {
            continue;
        };
        let pipes = contacts
            .iter()
            .filter(|c| c[1] == t)
            .map(|c| supports[c[0]]);
        let pipes: Vec<(DVec3, f64)> = pipes
            .filter_map(|pipe| match pipe {
                Support::Cylinder {
                    axis: along,
                    radius,
                    ..
                } if along.dot(axis).abs() < TURN && (radius - minor).abs() <= tolerance => {
                    Some((along, radius))
                }
                _ => None,
            })
            .collect();
        let Some(&(first, radius)) = pipes.first() else {
            continue;
        };
        let normals = pipes.iter().map(|(along, _)| first.cross(*along));
        let longest = normals.max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        let normal = match longest {
            Some(normal) if normal.length() > 0.1 => normal * normal.dot(axis).signum(),
            _ => axis.reject_from_normalized(first),
        };
        if let Support::Torus { center, major, .. } = supports[t]
            && let Some(axis) = normal.try_normalize()
        {
            let lined = Support::Torus {
                center,
                axis,
                major,
                minor: radius,
            };
            let touched = |c: &&[usize; 2]| c[1] == t;
            let bends = |c: &[usize; 2]| bend(&supports[c[0]], &lined, tolerance).is_some();
            if contacts.iter().filter(touched).any(bends) {
                supports[t] = lined;
            }
        }
    }
}

fn coaxial(a: &Support, b: &Support, tolerance: f64) -> Option<Support> {
    // Where a ball goes on as a pipe, several pipes may: two circles of contact and the ball hold a
    // vertex already, and a little error in either would move it.
    let torus = |s: &Support| matches!(s, Support::Torus { .. });
    if !torus(a) && !torus(b) {
        return None;
    }
    let (origin, axis) = a.axis().or_else(|| b.axis())?;
    let profiles = |s| profile(s, origin, axis, tolerance);
    let (at, across) = match (profiles(a)?, profiles(b)?) {
        (Profile::Line(..), Profile::Line(..)) => return None,
        (Profile::Line(p, normal), Profile::Circle(center, radius))
        | (Profile::Circle(center, radius), Profile::Line(p, normal)) => {
            let off = normal.dot(center - p);
            if (off.abs() - radius).abs() > tolerance {
                return None;
            }
            (center - normal * off, normal)
        }
        (Profile::Circle(c, r), Profile::Circle(d, s)) => {
            let apart = c.distance(d);
            let across = (d - c).try_normalize()?;
            if (apart - r - s).abs() <= tolerance {
                (c + across * r, across)
            } else if (apart - (r - s).abs()).abs() <= tolerance {
                (c + across * r * (r - s).signum(), across)
            } else {
                return None;
            }
        }
    };
    // On the axis they touch in a point, which their own equations hold.
    if at.x <= tolerance {
        return None;
    }
    Some(if across.x.abs() > across.y.abs() {
        Support::Plane {
            origin: origin + axis * at.y,
            normal: axis,
        }
    } else {
        Support::Cylinder {
            origin,
            axis,
            radius: at.x,
        }
    })
}

/// The profile of a surface around an axis; `None` if it is not around it.
fn profile(support: &Support, origin: DVec3, axis: DVec3, tolerance: f64) -> Option<Profile> {
    let d = support.origin() - origin;
    let height = d.dot(axis);
    let centred = d.reject_from_normalized(axis).length() <= tolerance;
    let parallel = support.direction().cross(axis).length() < ANGLE;
    let up = support.direction().dot(axis).signum();
    match *support {
        Support::Plane { .. } => {
            parallel.then_some(Profile::Line(DVec2::new(0.0, height), DVec2::Y))
        }
        _ if !centred => None,
        Support::Sphere { radius, .. } => Some(Profile::Circle(DVec2::new(0.0, height), radius)),
        _ if !parallel => None,
        Support::Cylinder { radius, .. } => Some(Profile::Line(DVec2::new(radius, 0.0), DVec2::X)),
        Support::Cone { angle, .. } => {
            let normal = DVec2::new(angle.cos(), -up * angle.sin());
            Some(Profile::Line(DVec2::new(0.0, height), normal))
        }
        Support::Torus { major, minor, .. } => {
            Some(Profile::Circle(DVec2::new(major, height), minor))
        }
        Support::Unknown => None,
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const AT: DVec3 = DVec3::new(0.3, -0.2, 0.1);

    fn axis() -> DVec3 {
        DVec3::new(0.2, 0.9, -0.4).normalize()
    }

    fn torus(height: f64, major: f64, minor: f64) -> Support {
        Support::Torus {
            center: AT + axis() * height,
            axis: axis(),
            major,
            minor,
        }
    }

    /// Points where both surfaces and the one across them are met.
    fn meets(a: &Support, b: &Support, near: DVec3) {
        let across = contact(a, b, 1e-9).expect("they touch");
        let p = crate::plan::support::meet(near, &[*a, *b, across]);
        for s in [a, b, &across] {
            assert!(s.distance(p).abs() < 1e-9, "{s:?} {}", s.distance(p));
        }
        let (g, h) = (a.gradient(p), b.gradient(p));
        assert!(g.cross(h).length() < 1e-6, "they do not touch there");
        assert!(across.gradient(p).cross(g).length() > 0.5);
    }

    proptest! {
        #[test]
        fn fillets_touch_what_they_round(
            major in 0.3..1.0f64,
            minor in 0.02..0.2f64,
            turn in -3.0..3.0f64,
        ) {
            let (u, v) = axis().any_orthonormal_pair();
            let out = u * turn.cos() + v * turn.sin();
            let tube = torus(0.0, major, minor);
            let plane = Support::Plane { origin: AT + axis() * minor, normal: -axis() };
            meets(&plane, &tube, AT + out * (major + 1e-3) + axis() * minor);
            for side in [-1.0, 1.0] {
                let radius = major + side * minor;
                let wall = Support::Cylinder { origin: AT - axis() * 2.0, axis: -axis(), radius };
                meets(&tube, &wall, AT + out * radius + axis() * 1e-3);
                // Tubes side by side.
                meets(&tube, &torus(0.0, major + 2.0 * side * minor, minor), AT + out * radius);
            }
            for angle in [0.3f64, 0.8, 1.2] {
                // Apex where the line at the angle touches the tube's circle.
                let height = -(major + minor / angle.cos()) / angle.tan();
                let cone = Support::Cone { apex: AT + axis() * height, axis: axis(), angle };
                let line = DVec2::new(angle.cos(), -angle.sin());
                let off = line.dot(DVec2::new(major, 0.0) - DVec2::new(0.0, height));
                prop_assume!((off.abs() - minor).abs() < 1e-9);
                let touch = DVec2::new(major, 0.0) - line * off;
                meets(&tube, &cone, AT + out * touch.x + axis() * touch.y);
            }
        }
    }

    #[test]
    fn a_bend_touches_its_pipe() {
        let (u, v) = axis().any_orthonormal_pair();
        let tube = torus(0.0, 0.7, 0.1);
        let pipe = Support::Cylinder {
            origin: AT + u * 0.7 + v * 3.0,
            axis: v,
            radius: 0.1,
        };
        meets(&pipe, &tube, AT + u * 0.8 + v * 1e-3);
        meets(&tube, &pipe, AT + u * 0.7 + axis() * 0.1);
        let thinner = Support::Cylinder {
            origin: AT + u * 0.7,
            axis: v,
            radius: 0.09,
        };
        assert_eq!(contact(&thinner, &tube, 1e-9), None);
    }

    #[test]
    fn balls_touch_fillets_only() {
        let ball = Support::Sphere {
            center: AT,
            radius: 0.4,
        };
        let wall = Support::Cylinder {
            origin: AT + axis(),
            axis: axis(),
            radius: 0.4,
        };
        assert_eq!(contact(&wall, &ball, 1e-9), None);
        let fillet = torus(0.0, 0.5, 0.1);
        meets(&fillet, &ball, AT + axis().any_orthonormal_vector() * 0.4);
        // In one point only.
        let plane = Support::Plane {
            origin: AT + axis() * 0.4,
            normal: axis(),
        };
        assert_eq!(contact(&plane, &ball, 1e-9), None);
        assert_eq!(contact(&plane, &wall, 1e-9), None);
    }
}
