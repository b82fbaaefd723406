//! Refining a surface on all of its evidence at once.

use glam::DVec3;

use super::evidence::Evidence;
use super::judge::residuals;
use crate::lift::Surface;
use crate::lift::dense::solve;

/// Steps of refinement.
const STEPS: usize = 6;

/// What may change of a surface. A boundary often leaves its axis open within its own errors, and
/// what others say of the axis is better then.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Freedom {
    /// Lengths and the place along the axis.
    AlongAxis,
    /// All but the direction of the axis.
    Shifts,
    All,
}

/// Number of parameters: three shifts, two lengths, two turns of the axis.
const PARAMETERS: usize = 7;

/// Changes of a surface's parameters that it is free to make.
fn ways(surface: &Surface, freedom: Freedom) -> Vec<[f64; PARAMETERS]> {
    let unit = |k: usize| {
        let mut way = [0.0; PARAMETERS];
        way[k] = 1.0;
        way
    };
    let lengths: &[usize] = match surface {
        Surface::Cylinder { .. } | Surface::Cone { .. } | Surface::Sphere { .. } => &[3],
        Surface::Torus { .. } => &[3, 4],
        Surface::Plane { .. } | Surface::Unknown => return Vec::new(),
    };
    let turning = !matches!(surface, Surface::Sphere { .. });
    let mut ways: Vec<_> = lengths.iter().map(|&k| unit(k)).collect();
    if freedom == Freedom::AlongAxis && turning {
        let axis = surface.direction();
        ways.push([axis.x, axis.y, axis.z, 0.0, 0.0, 0.0, 0.0]);
    } else {
        ways.extend([0, 1, 2].map(unit));
    }
    if freedom == Freedom::All && turning {
        ways.extend([5, 6].map(unit));
    }
    ways
}

/// The surface with its parameters changed, lengths in units of `size`.
fn changed(surface: &Surface, x: &[f64; PARAMETERS], size: f64) -> Surface {
    let shift = DVec3::new(x[0], x[1], x[2]) * size;
    let turned = |axis: DVec3, a: f64, b: f64| {
        let (u, v) = axis.any_orthonormal_pair();
        (axis + u * a + v * b).normalize()
    };
    match *surface {
        Surface::Sphere { center, radius } => Surface::Sphere {
            center: center + shift,
            radius: radius + x[3] * size,
        },
        Surface::Cylinder {
            origin,
            axis,
            radius,
        } => Surface::Cylinder {
            origin: origin + shift,
            axis: turned(axis, x[5], x[6]),
            radius: radius + x[3] * size,
        },
        Surface::Cone { apex, axis, angle } => Surface::Cone {
            apex: apex + shift,
            axis: turned(axis, x[5], x[6]),
            angle: angle + x[3],
        },
        Surface::Torus {
            center,
            axis,
            major,
            minor,
        } => Surface::Torus {
            center: center + shift,
            axis: turned(axis, x[5], x[6]),
            major: major + x[3] * size,
            minor: minor + x[4] * size,
        },
        _ => *surface,
    }
}

/// The surface with the least squares of its residuals near the given one (Levenberg 1944, with
/// numerical slopes).
pub(super) fn refined(evidence: &Evidence, start: Surface, freedom: Freedom) -> Surface {
    const SLOPE: f64 = 1e-7;
    let ways = ways(&start, freedom);
    let n = ways.len();
    if n == 0 {
        return start;
    }
    let mut surface = start;
    let (mut now, mut then) = (Vec::new(), Vec::new());
    for _ in 0..STEPS {
        residuals(evidence, &surface, &mut now);
        if now.iter().any(|r| !r.is_finite()) {
            return start;
        }
        let mut columns = Vec::with_capacity(n);
        for way in &ways {
            let x = way.map(|w| w * SLOPE);
            residuals(evidence, &changed(&surface, &x, evidence.size), &mut then);
            columns.push(
                now.iter()
                    .zip(&then)
                    .map(|(a, b)| (b - a) / SLOPE)
                    .collect::<Vec<_>>(),
            );
        }
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let mut matrix: Vec<Vec<f64>> = (0..n)
            .map(|i| (0..n).map(|j| dot(&columns[i], &columns[j])).collect())
            .collect();
        let trace: f64 = (0..n).map(|i| matrix[i][i]).sum();
        // What the evidence leaves open stays.
        for (i, row) in matrix.iter_mut().enumerate() {
            row[i] += 1e-9 * trace;
        }
        let right = (0..n).map(|i| -dot(&columns[i], &now)).collect();
        let Some(x) = solve(matrix, right) else {
            return surface;
        };
        let largest = x.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        if !largest.is_finite() || largest > 0.1 {
            return surface;
        }
        let mut step = [0.0; PARAMETERS];
        for (way, share) in ways.iter().zip(&x) {
            step.iter_mut().zip(way).for_each(|(s, w)| *s += w * share);
        }
        surface = changed(&surface, &step, evidence.size);
        if largest < 1e-12 {
            break;
        }
    }
    surface
}
