//! Directions of planes and cylinders.

use glam::DVec3;

use crate::plan::support::Support;

use super::{Group, LARGEST_TURN};

/// Turns normals and axes to common directions; returns how many changed by more than rounding.
///
/// Large surfaces go first, so that small ones, whose directions are less sure, follow them.
pub(super) fn directions(groups: &mut [Group], axes: &[DVec3], tolerance: f64) -> usize {
    let mut order: Vec<usize> = (0..groups.len()).collect();
    order.sort_by(|&a, &b| groups[b].extent.total_cmp(&groups[a].extent));
    let mut known: Vec<DVec3> = axes.to_vec();
    let mut changed = 0;
    for g in order {
        let group = &mut groups[g];
        let old = group.support.direction();
        if old == DVec3::ZERO {
            continue;
        }
        // Axes first, then other faces' directions, then the nearest ones normal to an axis.
        let normal_to_axis = axes.iter().map(|a| old.reject_from_normalized(*a));
        let mut candidates = known.iter().copied().chain(normal_to_axis);
        let snapped = candidates.find_map(|d| {
            let unit = d.try_normalize()?;
            let unit = if unit.dot(old) < 0.0 { -unit } else { unit };
            if unit.distance(old) > LARGEST_TURN {
                return None;
            }
            let turned = turned(group, unit);
            group.fits(&turned, tolerance).then_some(turned)
        });
        if let Some(support) = snapped {
            changed += usize::from(support.direction().distance(old) > 1e-9);
            group.support = support;
        }
        let new = group.support.direction();
        if !known.iter().any(|k| k.cross(new).length() < 1e-12) {
            known.push(new);
        }
    }
    changed
}

/// The surface with another direction, moved to fit the points again.
fn turned(group: &Group, direction: DVec3) -> Support {
    let count = group.points.len().max(1) as f64;
    let middle = group.points.iter().sum::<DVec3>() / count;
    let old = group.support;
    match old.axis() {
        // Turned about the point of the axis beside the points.
        Some((origin, axis)) => {
            let along = axis.dot(middle - origin);
            let along = if group.points.is_empty() { 0.0 } else { along };
            let pivot = origin + axis * along;
            old.with_origin(pivot - direction * along)
                .with_direction(direction)
        }
        // The plane through the points' centroid.
        None if !group.points.is_empty() => old.with_origin(middle).with_direction(direction),
        None => old.with_direction(direction),
    }
}
