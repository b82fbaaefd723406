//! Surfaces that are one.

use glam::DVec3;

use crate::plan::support::Support;

use super::{Group, Joint, LARGEST_TURN};

/// Halves of one surface may differ by this share of the radius: they were lifted one by one.
const HALVES: f64 = 0.02;

/// Joins faces of one curved surface that meet along an edge and are nearly the same: beyond an
/// outline the surface goes on in any case, elsewhere a common one has to fit both within `tolerance`.
pub(super) fn halves(groups: Vec<Group>, smooth: &[Joint], tolerance: f64) -> Vec<Group> {
    let mut root: Vec<usize> = (0..groups.len()).collect();
    let find = |root: &[usize], mut i: usize| {
        while root[i] != i {
            i = root[i];
        }
        i
    };
    let one = |joint: &Joint| {
        let pair = joint.faces.map(|f| &groups[f]);
        let fits_both = || {
            let whole = average(pair.map(Clone::clone).into());
            whole.is_some_and(|w| pair.iter().all(|part| part.fits(&w.support, tolerance)))
        };
        near(&pair[0].support, &pair[1].support) && (joint.outline || fits_both())
    };
    for joint in smooth {
        if one(joint) {
            let [a, b] = joint.faces;
            let (a, b) = (find(&root, a), find(&root, b));
            root[a.max(b)] = a.min(b);
        }
    }
    let mut parts: Vec<Vec<Group>> = groups.iter().map(|_| Vec::new()).collect();
    for (g, group) in groups.into_iter().enumerate() {
        parts[find(&root, g)].push(group);
    }
    parts.into_iter().filter_map(average).collect()
}

/// Whether two surfaces are the same to within [`HALVES`].
fn near(a: &Support, b: &Support) -> bool {
    if a == b && !matches!(a, Support::Plane { .. } | Support::Unknown) {
        return true;
    }
    let close = |x: f64, y: f64| (x - y).abs() <= HALVES * x.abs().min(y.abs());
    let apart = a.origin().distance(b.origin());
    let aligned = a.direction().cross(b.direction()).length() <= LARGEST_TURN;
    match (*a, *b) {
        (
            Support::Cylinder {
                origin: p,
                axis: u,
                radius: r,
            },
            Support::Cylinder {
                origin: q,
                radius: s,
                ..
            },
        ) => {
            let aside = (q - p).reject_from_normalized(u).length();
            close(r, s) && aside <= HALVES * r.min(s) && aligned
        }
        (Support::Sphere { radius: r, .. }, Support::Sphere { radius: s, .. }) => {
            close(r, s) && apart <= HALVES * r.min(s)
        }
        (
            Support::Torus {
                major: m, minor: r, ..
            },
            Support::Torus {
                major: n, minor: s, ..
            },
        ) => close(m, n) && close(r, s) && apart <= HALVES * r.min(s) && aligned,
        _ => false,
    }
}

/// One group with the mean of the cylinders, weighted by the extent of their faces.
fn average(parts: Vec<Group>) -> Option<Group> {
    let mut parts = parts.into_iter();
    let mut whole = parts.next()?;
    let parts: Vec<Group> = parts.collect();
    if parts.is_empty() {
        return Some(whole);
    }
    let first = whole.support;
    if !matches!(first, Support::Cylinder { .. }) {
        for part in parts {
            // The larger part's surface is the surer one.
            if part.extent > whole.extent {
                whole.support = part.support;
            }
            whole.join(part);
        }
        return Some(whole);
    }
    let (mut weight, mut place, mut direction, mut size) = (0.0, DVec3::ZERO, DVec3::ZERO, 0.0);
    for part in std::iter::once(&whole).chain(&parts) {
        if let Support::Cylinder {
            origin,
            axis,
            radius,
        } = part.support
        {
            let w = part.extent.max(f64::MIN_POSITIVE);
            // All origins beside the first one, so that their mean lies on the mean axis.
            let beside = origin + axis * axis.dot(first.origin() - origin);
            weight += w;
            place += beside * w;
            direction += axis * w * axis.dot(first.direction()).signum();
            size += radius * w;
        }
    }
    if let (Some(axis), true) = (direction.try_normalize(), weight > 0.0) {
        whole.support = Support::Cylinder {
            origin: place / weight,
            axis,
            radius: size / weight,
        };
    }
    for part in parts {
        whole.join(part);
    }
    Some(whole)
}

/// Joins planes of one direction at one place.
pub(super) fn planes(groups: Vec<Group>, tolerance: f64) -> Vec<Group> {
    let mut out: Vec<Group> = Vec::with_capacity(groups.len());
    for group in groups {
        let twin = out.iter_mut().find(|other| {
            matches!(other.support, Support::Plane { .. })
                && matches!(group.support, Support::Plane { .. })
                && same_direction(&group.support, &other.support)
                && other.support.distance(group.support.origin()).abs() <= tolerance
        });
        match twin {
            // The larger face's plane is the surer one.
            Some(other) => {
                if group.extent > other.extent {
                    other.support = group.support;
                }
                other.join(group);
            }
            None => out.push(group),
        }
    }
    out
}

fn same_direction(a: &Support, b: &Support) -> bool {
    a.direction().cross(b.direction()).length() < 1e-9
}

/// Gives curved surfaces the axis of a larger one that they share it with, and the radii of a
/// larger one of their kind that are equal; returns how many changed.
pub(super) fn round(groups: &mut [Group], tolerance: f64) -> usize {
    let curved = |s: &Support| !matches!(s, Support::Plane { .. } | Support::Unknown);
    let mut order: Vec<usize> = (0..groups.len())
        .filter(|&g| curved(&groups[g].support))
        .collect();
    order.sort_by(|&a, &b| groups[b].extent.total_cmp(&groups[a].extent));
    let mut changed = 0;
    for i in 1..order.len() {
        let old = groups[order[i]].support;
        for &model in &order[..i] {
            let model = groups[model].support;
            let own = groups[order[i]].support;
            groups[order[i]].support =
                equal_radii(coaxial(own, &model, tolerance), &model, tolerance);
        }
        changed += usize::from(groups[order[i]].support != old);
    }
    changed
}

/// A surface moved onto the axis of another one, if it is within `tolerance` of it.
fn coaxial(own: Support, model: &Support, tolerance: f64) -> Support {
    let Some((origin, direction)) = model.axis() else {
        return own;
    };
    let aside = (own.origin() - origin).reject_from_normalized(direction);
    let turned = own.axis().is_some() && !same_direction(model, &own);
    if turned || aside.length() > tolerance {
        return own;
    }
    let way = if direction.dot(own.direction()) < 0.0 {
        -direction
    } else {
        direction
    };
    own.with_origin(own.origin() - aside).with_direction(way)
}

/// A surface with the radii of another one of its kind that are equal within `tolerance`.
fn equal_radii(mut own: Support, model: &Support, tolerance: f64) -> Support {
    let snap = |x: &mut f64, y: f64| {
        if (*x - y).abs() <= tolerance {
            *x = y;
        }
    };
    match (&mut own, *model) {
        (Support::Cylinder { radius, .. }, Support::Cylinder { radius: r, .. })
        | (Support::Sphere { radius, .. }, Support::Sphere { radius: r, .. }) => snap(radius, r),
        (
            Support::Torus { major, minor, .. },
            Support::Torus {
                major: m, minor: r, ..
            },
        ) => {
            snap(minor, r);
            snap(major, m);
        }
        _ => {}
    }
    own
}

/// Joins curved surfaces that are one.
pub(super) fn equal(groups: Vec<Group>) -> Vec<Group> {
    let mut out: Vec<Group> = Vec::with_capacity(groups.len());
    for group in groups {
        let twin = out.iter_mut().find(|o| is_same(&o.support, &group.support));
        match twin {
            Some(other) => other.join(group),
            None => out.push(group),
        }
    }
    out
}

fn is_same(a: &Support, b: &Support) -> bool {
    match (*a, *b) {
        (Support::Plane { .. } | Support::Unknown, _) => false,
        (Support::Cylinder { axis, radius, .. }, Support::Cylinder { radius: s, .. }) => {
            let aside = (b.origin() - a.origin()).reject_from_normalized(axis);
            radius == s && same_direction(a, b) && aside.length() <= 1e-9 * radius
        }
        (Support::Sphere { radius, .. }, Support::Sphere { radius: s, .. }) => {
            radius == s && a.origin().distance(b.origin()) <= 1e-9 * radius
        }
        _ => a == b,
    }
}
