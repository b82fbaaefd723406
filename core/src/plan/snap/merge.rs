//! Surfaces that are one.

use glam::DVec3;

use crate::plan::support::Support;

use super::{Group, LARGEST_TURN};

/// Halves of one cylinder may differ by this share of the radius: they were lifted one by one.
const HALVES: f64 = 0.02;

/// Joins cylinder faces that meet along a straight edge and are nearly the same.
pub(super) fn halves(groups: Vec<Group>, smooth: &[[usize; 2]]) -> Vec<Group> {
    let mut root: Vec<usize> = (0..groups.len()).collect();
    let find = |root: &[usize], mut i: usize| {
        while root[i] != i {
            i = root[i];
        }
        i
    };
    for &[a, b] in smooth {
        if near(&groups[a].support, &groups[b].support) {
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

/// Whether two cylinders are the same to within [`HALVES`].
fn near(a: &Support, b: &Support) -> bool {
    let (
        Support::Cylinder {
            origin: p,
            axis: u,
            radius: r,
        },
        Support::Cylinder {
            origin: q,
            axis: v,
            radius: s,
        },
    ) = (*a, *b)
    else {
        return false;
    };
    (r - s).abs() <= HALVES * r.min(s)
        && (q - p).reject_from_normalized(u).length() <= HALVES * r.min(s)
        && u.cross(v).length() <= LARGEST_TURN
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

/// Gives cylinders the axis of a larger one that they share it with, and the radius of a larger
/// one that is equal; returns how many changed.
pub(super) fn cylinders(groups: &mut [Group], tolerance: f64) -> usize {
    let mut order: Vec<usize> = (0..groups.len())
        .filter(|&g| matches!(groups[g].support, Support::Cylinder { .. }))
        .collect();
    order.sort_by(|&a, &b| groups[b].extent.total_cmp(&groups[a].extent));
    let mut changed = 0;
    for i in 1..order.len() {
        let old = groups[order[i]].support;
        for &model in &order[..i] {
            let Support::Cylinder { radius: r, .. } = groups[model].support else {
                continue;
            };
            let model = groups[model].support;
            let Support::Cylinder {
                origin,
                axis,
                radius,
            } = groups[order[i]].support
            else {
                continue;
            };
            let aside = (model.origin() - origin).reject_from_normalized(axis);
            let coaxial = same_direction(&model, &old) && aside.length() <= tolerance;
            groups[order[i]].support = Support::Cylinder {
                origin: if coaxial {
                    let d = model.direction();
                    model.origin() + d * d.dot(origin - model.origin())
                } else {
                    origin
                },
                axis: if coaxial { model.direction() } else { axis },
                radius: if (radius - r).abs() <= tolerance {
                    r
                } else {
                    radius
                },
            };
        }
        changed += usize::from(groups[order[i]].support != old);
    }
    changed
}

/// Joins cylinders with one axis and one radius.
pub(super) fn equal_cylinders(groups: Vec<Group>) -> Vec<Group> {
    let mut out: Vec<Group> = Vec::with_capacity(groups.len());
    for group in groups {
        let twin = out
            .iter_mut()
            .find(|other| match (group.support, other.support) {
                (
                    Support::Cylinder { axis, radius, .. },
                    Support::Cylinder {
                        origin: q,
                        radius: s,
                        ..
                    },
                ) => {
                    let aside = (q - group.support.origin()).reject_from_normalized(axis);
                    radius == s
                        && same_direction(&group.support, &other.support)
                        && aside.length() <= 1e-9 * radius
                }
                _ => false,
            });
        match twin {
            Some(other) => other.join(group),
            None => out.push(group),
        }
    }
    out
}
