//! Frames that a few pieces of evidence would fix: three clusters, a circle and a cluster, two
//! circles, a prism's edges and two of its base at a usual angle.

use glam::{DMat3, DVec2, DVec3};

use super::evidence::Evidence;

/// Clusters and circle groups that hypotheses are made from; the rest only vote.
const CLUSTERS: usize = 12;
const CIRCLES: usize = 8;

/// Clusters that prisms are made from.
const PRISM_CLUSTERS: usize = 6;

/// Squared cosines of the angles, other than right ones, that two edges of a base often make: 60,
/// 45 and 30 degrees.
const BASE_ANGLES: [f64; 3] = [0.25, 0.5, 0.75];

/// A frame (columns are unit axes) and about how well it is known, in radians.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hypothesis {
    pub(super) frame: DMat3,
    pub(super) error: f64,
}

/// All frames worth a vote. Every frame stands for its reversal in depth too.
pub(super) fn frames(evidence: &Evidence) -> Vec<Hypothesis> {
    let mut all = Vec::new();
    let clusters = &evidence.clusters[..evidence.clusters.len().min(CLUSTERS)];
    let circles = &evidence.circles[..evidence.circles.len().min(CIRCLES)];
    let errors: Vec<f64> = clusters
        .iter()
        .map(|c| c.error(evidence.precision))
        .collect();
    for (i, a) in clusters.iter().enumerate() {
        for (j, b) in clusters.iter().enumerate().skip(i + 1) {
            for (k, c) in clusters.iter().enumerate().skip(j + 1) {
                let frame = from_drawn(a.direction, b.direction, c.direction);
                all.extend(
                    frame.and_then(|frame| hypothesis(frame, errors[i] + errors[j] + errors[k])),
                );
            }
        }
    }
    let prisms = &clusters[..clusters.len().min(PRISM_CLUSTERS)];
    for (i, along) in prisms.iter().enumerate() {
        for (j, a) in prisms.iter().enumerate() {
            for (k, b) in prisms.iter().enumerate().skip(j + 1) {
                if i == j || i == k {
                    continue;
                }
                for squared in BASE_ANGLES {
                    let found = from_prism(along.direction, a.direction, b.direction, squared);
                    let error = errors[i] + errors[j] + errors[k];
                    all.extend(
                        found
                            .into_iter()
                            .flatten()
                            .filter_map(|f| hypothesis(f, error)),
                    );
                }
            }
        }
    }
    for (i, group) in circles.iter().enumerate() {
        let axis = group.normal;
        for (cluster, error) in clusters.iter().zip(&errors) {
            let frame = from_axis(axis, cluster.direction);
            all.extend(frame.and_then(|f| hypothesis(f, group.error + error)));
        }
        for other in &circles[i + 1..] {
            let n = other.normal;
            // Of the two relative signs, the one in which the planes are at right angles.
            let reversed = (n.truncate()).extend(-n.z);
            let error = group.error + other.error;
            for second in [n, reversed] {
                if axis.dot(second).abs() < 10.0 * error {
                    all.extend(orthonormal(axis, second).and_then(|f| hypothesis(f, error)));
                }
            }
        }
    }
    all
}

/// Frame whose axes are drawn along three directions (design, section 4): with `d_i` the drawn
/// unit directions, `z_i^2 = -(d_i.d_j)(d_i.d_k)/(d_j.d_k)` and `z_i z_j = -d_i.d_j`.
fn from_drawn(a: DVec2, b: DVec2, c: DVec2) -> Option<DMat3> {
    let (ab, ac, bc) = (a.dot(b), a.dot(c), b.dot(c));
    if ab * ac * bc >= 0.0 {
        return None;
    }
    let za = (-ab * ac / bc).sqrt();
    let axis = |d: DVec2, z: f64| d.extend(z).normalize();
    orthonormal(axis(a, za), axis(b, -ab / za))
}

/// Frames whose first axis is drawn along `d`, with two directions at right angles to it drawn along
/// `a` and `b` that make an angle of squared cosine `squared`; the second axis is along `a`.
///
/// With z the axis' rise for unit drawn length, those of a and b are -(d.a)/z and -(d.b)/z, and the
/// angle is a quadratic equation in z^2.
fn from_prism(d: DVec2, a: DVec2, b: DVec2, squared: f64) -> [Option<DMat3>; 2] {
    let (da, db, ab) = (d.dot(a), d.dot(b), a.dot(b));
    let quadratic = ab * ab - squared;
    let linear = 2.0 * da * db * ab - squared * (da * da + db * db);
    let constant = (1.0 - squared) * (da * db).powi(2);
    let root = (linear * linear - 4.0 * quadratic * constant).sqrt();
    // Stable roots: no difference of nearly equal numbers.
    let q = -0.5 * (linear + root.copysign(linear));
    [q / quadratic, constant / q].map(|t| {
        let rise = Some(t).filter(|t| *t > 0.0 && t.is_finite())?.sqrt();
        orthonormal(d.extend(rise), a.extend(-da / rise))
    })
}

/// Frame with a known axis and a second one at right angles to it that is drawn along `d`.
fn from_axis(axis: DVec3, d: DVec2) -> Option<DMat3> {
    if axis.z.abs() < 1e-9 {
        return None;
    }
    orthonormal(axis, d.extend(-d.dot(axis.truncate()) / axis.z))
}

fn orthonormal(a: DVec3, b: DVec3) -> Option<DMat3> {
    let a = a.try_normalize()?;
    let b = b.reject_from_normalized(a).try_normalize()?;
    let frame = DMat3::from_cols(a, b, a.cross(b));
    frame.is_finite().then_some(frame)
}

/// The error of an axis' tilt grows as the axis gets parallel to the page, or the frame to the view.
fn hypothesis(frame: DMat3, error: f64) -> Option<Hypothesis> {
    let flattest = frame.transpose().z_axis.abs().min_element();
    let error = error / flattest.max(1e-6);
    (error < 0.2).then_some(Hypothesis { frame, error })
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, EulerRot};

    use super::*;

    #[test]
    fn three_drawn_directions_give_their_frame_up_to_reversal() {
        for (yaw, pitch, roll) in [(0.4, 0.6, 0.1), (2.0, -0.9, 1.0), (-1.2, 0.3, 2.5)] {
            let truth = DMat3::from_euler(EulerRot::ZYX, roll, yaw, pitch);
            let [a, b, c] = truth.to_cols_array_2d().map(DVec3::from_array);
            let unit = |v: DVec3| v.truncate().normalize();
            let found = from_drawn(unit(a), -unit(b), unit(c)).unwrap();
            let mirror = |v: DVec3| v.truncate().extend(-v.z);
            let close = |f: &dyn Fn(DVec3) -> DVec3| {
                let [p, q, r] = found.to_cols_array_2d().map(DVec3::from_array);
                [(p, a), (q, b), (r, c)]
                    .iter()
                    .all(|(x, y)| (x.dot(f(*y)).abs() - 1.0).abs() < 1e-9)
            };
            assert!(close(&|v| v) || close(&mirror));
        }
    }

    #[test]
    fn a_hexagon_gives_the_frame_of_its_prism() {
        let turn = DMat3::from_euler(EulerRot::ZYX, 0.3, 0.7, -0.5);
        let drawn = |v: DVec3| (turn * v).truncate().normalize();
        let side = |degrees: f64| drawn(DQuat::from_rotation_z(degrees.to_radians()) * DVec3::X);
        let found = from_prism(drawn(DVec3::Z), side(0.0), side(60.0), 0.25);
        let axis = turn * DVec3::Z;
        let mirrored = axis * DVec3::new(1.0, 1.0, -1.0);
        assert!(found.iter().flatten().any(|f| {
            [axis, mirrored]
                .iter()
                .any(|a| f.x_axis.cross(*a).length() < 1e-9)
        }));
    }

    #[test]
    fn directions_of_no_right_angles_give_none() {
        let d = |degrees: f64| DVec2::from_angle(degrees.to_radians());
        assert!(from_drawn(d(0.0), d(20.0), d(40.0)).is_none());
    }
}
