//! A lift made from a drawing's truth, so that planning and building are measured on their own.
#![allow(unreachable_pub)]

use faceformer::drawing::{Drawing, Projection, SurfaceKind, Truth, TruthFace};
use faceformer::lift::{Camera, Lift, LiftMethod, Surface};
use glam::{DMat3, DVec2, DVec3};

/// The true depths and surfaces; `None` without a truth.
pub fn true_lift(drawing: &Drawing) -> Option<Lift> {
    let truth = drawing.truth.as_ref()?;
    let mean = truth.vertices3d.iter().map(|p| p.z).sum::<f64>() / truth.vertices3d.len() as f64;
    // In perspective depth has no free offset.
    let (mean, camera) = match drawing.projection {
        Projection::Orthographic => (mean, Camera::Parallel),
        Projection::Perspective { focal } => {
            let principal = DVec2::ZERO;
            let focal = focal?;
            (0.0, Camera::Central { principal, focal })
        }
    };
    let surfaces = truth.faces.iter().map(|face| surface(truth, face, mean));
    Some(Lift {
        depths: truth.vertices3d.iter().map(|p| p.z - mean).collect(),
        camera,
        surfaces: surfaces.collect(),
        directions: truth.directions.clone(),
        method: LiftMethod::Exact,
        residual: 1e-6,
        conflicts: Vec::new(),
        regular: None,
        curves: Vec::new(),
    })
}

fn surface(truth: &Truth, face: &TruthFace, mean: f64) -> Surface {
    let lower = |p: &DVec3| *p - DVec3::Z * mean;
    let polylines: Vec<Vec<DVec3>> = face
        .loops
        .iter()
        .flatten()
        .map(|co| truth.edges3d[co.edge()].iter().map(lower).collect())
        .collect();
    let points: Vec<DVec3> = polylines.concat();
    match face.kind {
        SurfaceKind::Plane => fit_plane(&points),
        SurfaceKind::Cylinder => fit_cylinder(&polylines, &points, &truth.directions),
        _ => Surface::Unknown,
    }
}

fn centroid(points: &[DVec3]) -> DVec3 {
    points.iter().sum::<DVec3>() / points.len() as f64
}

/// Directions of least and of largest spread, by power iteration on the spread and its inverse.
fn spread_axes(points: &[DVec3]) -> (DVec3, DVec3) {
    let middle = centroid(points);
    // Not singular even if all points lie exactly in a plane.
    let square = |p: &DVec3| p.distance_squared(middle);
    let total: f64 = points.iter().map(square).sum();
    let mut spread = DMat3::from_diagonal(DVec3::splat(1e-13 * total));
    for p in points {
        let d = *p - middle;
        spread += DMat3::from_cols(d * d.x, d * d.y, d * d.z);
    }
    let power = |m: DMat3| {
        let mut v = DVec3::new(0.36, 0.48, 0.8);
        for _ in 0..200 {
            v = (m * v).normalize_or_zero();
        }
        v
    };
    (power(spread.inverse()), power(spread))
}

fn fit_plane(points: &[DVec3]) -> Surface {
    Surface::Plane {
        origin: centroid(points),
        normal: spread_axes(points).0,
    }
}

/// The best of the cylinders along straight edges, model axes and normals of plane arcs, refined.
fn fit_cylinder(polylines: &[Vec<DVec3>], points: &[DVec3], directions: &[DVec3]) -> Surface {
    let straight = polylines.iter().filter(|p| p.len() == 2);
    let mut axes: Vec<DVec3> = straight.map(|p| (p[1] - p[0]).normalize()).collect();
    axes.extend(directions);
    let arcs = polylines.iter().filter(|p| p.len() > 2);
    axes.extend(arcs.map(|p| spread_axes(p).0));
    let fits = axes
        .into_iter()
        .filter_map(|axis| circle_along(axis, points));
    let best = fits.min_by(|a, b| gap(a, points).total_cmp(&gap(b, points)));
    let Some(start) = best else {
        return Surface::Unknown;
    };
    let (origin, axis, radius) = refine(start, points);
    Surface::Cylinder {
        origin,
        axis,
        radius,
    }
}

type Tube = (DVec3, DVec3, f64);

fn off(tube: &Tube, p: DVec3) -> f64 {
    (p - tube.0).reject_from_normalized(tube.1).length() - tube.2
}

fn gap(tube: &Tube, points: &[DVec3]) -> f64 {
    points.iter().map(|p| off(tube, *p).powi(2)).sum()
}

/// Circle through the points seen along an axis, algebraic fit (Kasa 1976).
fn circle_along(axis: DVec3, points: &[DVec3]) -> Option<Tube> {
    let (x, y) = axis.any_orthonormal_pair();
    let middle = centroid(points);
    let mut matrix = DMat3::from_diagonal(DVec3::splat(1e-15));
    let mut right = DVec3::ZERO;
    for p in points {
        let d = *p - middle;
        let row = DVec3::new(x.dot(d), y.dot(d), 1.0);
        matrix += DMat3::from_cols(row * row.x, row * row.y, row * row.z);
        right += row * (row.x * row.x + row.y * row.y);
    }
    let k = matrix.inverse() * right;
    let radius = (k.z + (k.x * k.x + k.y * k.y) / 4.0).sqrt();
    let origin = middle + x * (k.x / 2.0) + y * (k.y / 2.0);
    (radius.is_finite() && radius > 0.0).then_some((origin, axis, radius))
}

/// Gauss-Newton with steps that lower the gap, over two turns of the axis, two shifts, the radius.
fn refine(mut tube: Tube, points: &[DVec3]) -> Tube {
    for _ in 0..40 {
        let (x, y) = tube.1.any_orthonormal_pair();
        let moved = |k: [f64; 5]| -> Tube {
            let axis = (tube.1 + x * k[0] + y * k[1]).normalize();
            (tube.0 + x * k[2] + y * k[3], axis, tube.2 + k[4])
        };
        let h = 1e-6;
        let mut normal = [[0.0; 6]; 5];
        for p in points {
            let mut row = [0.0; 6];
            for i in 0..5 {
                let (mut plus, mut minus) = ([0.0; 5], [0.0; 5]);
                (plus[i], minus[i]) = (h, -h);
                row[i] = (off(&moved(plus), *p) - off(&moved(minus), *p)) / (2.0 * h);
            }
            row[5] = -off(&tube, *p);
            for i in 0..5 {
                for j in 0..6 {
                    normal[i][j] += row[i] * row[j];
                }
            }
        }
        for (i, row) in normal.iter_mut().enumerate() {
            row[i] += 1e-9;
        }
        let Some(step) = solve(normal) else { break };
        let next = moved(step);
        if gap(&next, points) >= gap(&tube, points) {
            break;
        }
        tube = next;
    }
    tube
}

/// Gauss elimination with pivots.
fn solve(mut m: [[f64; 6]; 5]) -> Option<[f64; 5]> {
    for c in 0..5 {
        let pivot = (c..5).max_by(|&a, &b| m[a][c].abs().total_cmp(&m[b][c].abs()))?;
        m.swap(c, pivot);
        if m[c][c] == 0.0 {
            return None;
        }
        for r in 0..5 {
            if r != c {
                let f = m[r][c] / m[c][c];
                let row = m[c];
                for (x, y) in m[r].iter_mut().zip(row) {
                    *x -= f * y;
                }
            }
        }
    }
    Some(std::array::from_fn(|i| m[i][5] / m[i][i]))
}
