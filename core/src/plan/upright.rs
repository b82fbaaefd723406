//! Standing the model up: which dominant direction becomes which axis.

use glam::{DMat3, DVec3};

/// Rotation from the camera frame to model axes, and whether it stands on dominant directions.
///
/// - Up, Z, is the direction drawn most steeply, the way that is upwards in the drawing.
/// - X and Y are the other two such that the viewer stands over the quarter +X, -Y, as in
///   FreeCAD's isometric view: X is drawn to the right and towards the viewer, Y to the right and
///   away.
///
/// Two directions give the third; one is completed with the drawing's horizontal. Without any the
/// camera frame stays: the rotation is the identity.
pub(super) fn rotation(directions: &[DVec3]) -> (DMat3, bool) {
    let mut frame: Vec<DVec3> = Vec::new();
    for d in directions {
        // Exactly orthogonal (Gram-Schmidt); one that depends on the others adds nothing.
        let rest = frame.iter().fold(*d, |r, f| r.reject_from_normalized(*f));
        if let Some(unit) = rest.try_normalize()
            && rest.length() > 0.5 * d.length()
            && frame.len() < 3
        {
            frame.push(unit);
        }
    }
    match frame[..] {
        [] => return (DMat3::IDENTITY, false),
        [a] => {
            let right = DVec3::X.reject_from_normalized(a);
            // An axis drawn horizontally is completed with the drawing's vertical.
            let b = right.normalize_or(DVec3::Y);
            frame.extend([b, a.cross(b)]);
        }
        [a, b] => frame.push(a.cross(b)),
        _ => {}
    }
    let steepest = (0..3).max_by(|&i, &j| frame[i].y.abs().total_cmp(&frame[j].y.abs()));
    let up = frame.remove(steepest.unwrap_or(0));
    let z = if up.y < 0.0 { -up } else { up };
    // The four frames with this Z; the viewer is towards +z of the camera frame.
    let x = [frame[0], frame[1], -frame[0], -frame[1]]
        .into_iter()
        .max_by(|a, b| {
            let quarter = |x: DVec3| x.z.min(-z.cross(x).z);
            quarter(*a).total_cmp(&quarter(*b))
        })
        .unwrap_or(DVec3::X);
    let y = z.cross(x);
    (DMat3::from_cols(x, y, z).transpose(), true)
}

#[cfg(test)]
mod tests {
    use glam::DQuat;
    use proptest::prelude::*;

    use super::*;

    /// Model axes as FreeCAD's isometric view shows them.
    fn isometric() -> [DVec3; 3] {
        let right = DVec3::new(1.0, 1.0, 0.0).normalize();
        let toward = DVec3::new(1.0, -1.0, 1.0).normalize();
        let up = toward.cross(right);
        let camera = DMat3::from_cols(right, up, toward).transpose();
        DVec3::AXES.map(|a| camera * a)
    }

    #[test]
    fn isometric_view_gives_the_axes_in_any_order_and_sign() {
        let [x, y, z] = isometric();
        for directions in [[x, y, z], [z, x, y], [-y, z, -x], [-z, -y, x]] {
            let (rotation, upright) = rotation(&directions);
            assert!(upright);
            assert!((rotation * x).distance(DVec3::X) < 1e-12);
            assert!((rotation * z).distance(DVec3::Z) < 1e-12);
        }
    }

    #[test]
    fn two_directions_give_the_third_and_none_gives_the_camera() {
        let [x, _, z] = isometric();
        assert!((rotation(&[z, x]).0 * z).distance(DVec3::Z) < 1e-12);
        assert_eq!(rotation(&[]), (DMat3::IDENTITY, false));
    }

    proptest! {
        #[test]
        fn rotation_is_proper_and_up_is_up(
            axis in prop::array::uniform3(-1.0..1.0f64),
            angle in -3.0..3.0f64,
            count in 1usize..4,
        ) {
            let axis = DVec3::from_array(axis).normalize_or(DVec3::X);
            let turn = DQuat::from_axis_angle(axis, angle);
            let directions = DVec3::AXES.map(|a| turn * a);
            let (rotation, _) = rotation(&directions[..count]);
            prop_assert!((rotation.determinant() - 1.0).abs() < 1e-9);
            prop_assert!((rotation * rotation.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-9));
            let up = rotation.transpose() * DVec3::Z;
            prop_assert!(up.y >= -1e-12);
            for d in &directions[..count] {
                let turned = (rotation * *d).abs();
                prop_assert!(turned.max_element() > 1.0 - 1e-9, "{turned}");
            }
        }
    }
}
