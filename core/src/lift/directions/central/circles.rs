//! Normals of circles in perspective.

use glam::{DMat3, DVec2, DVec3};

use super::eigen;
use crate::drawing::{Curve2, Drawing, EllipseArc};
use crate::lift::Camera;
use crate::lift::directions::AGREE;

/// Arcs that are too short have axes less certain than this and are left out.
const UNCERTAIN: f64 = 0.01;

/// Cosine between a circle's normal and the ray to it, from which on the normal is poorly known.
const FACE_ON: f64 = 1.0 - 1e-4;

/// Agreement of normals beyond this, radians, means nothing.
const LOOSE: f64 = 0.05;

/// A drawn circle: two planes cut a cone over an ellipse in circles.
pub(super) use crate::lift::directions::DrawnNormals as Circle;

impl Circle {
    /// The one of its normals, signed alike, that agrees with a direction.
    pub(super) fn agreeing(&self, n: DVec3, error: f64) -> Option<DVec3> {
        let limit = (AGREE * (self.error + error)).min(LOOSE);
        let signed = self.normals.map(|m| m * m.dot(n).signum());
        let nearest = signed
            .into_iter()
            .min_by(|a, b| a.distance(n).total_cmp(&b.distance(n)));
        nearest.filter(|m| m.distance(n) < limit)
    }
}

/// Circles of one normal.
#[derive(Debug, Clone)]
pub(super) struct Group {
    pub(super) normal: DVec3,
    pub(super) error: f64,
    /// Indices of circles.
    pub(super) members: Vec<usize>,
}

/// All arcs that may be circles and show it well enough.
pub(in crate::lift::directions) fn circles(
    drawing: &Drawing,
    camera: &Camera,
    precision: f64,
) -> Vec<Circle> {
    let circle = |(edge, e): (usize, &crate::drawing::Edge)| match e.curve {
        Curve2::Ellipse(arc)
            if arc.uncertainty < UNCERTAIN
                && arc.residual < AGREE * precision
                && arc.ratio * arc.major.length() > 20.0 * precision =>
        {
            of_ellipse((edge, e.v), &arc, camera, precision)
        }
        _ => None,
    };
    drawing
        .edges
        .iter()
        .enumerate()
        .filter_map(circle)
        .collect()
}

/// The circular sections of the cone over an ellipse: with eigenvalues l1 > l2 > 0 > l3 of the
/// cone's matrix the normals are `sqrt(l1 - l2) e1 +- sqrt(l2 - l3) e3`.
fn of_ellipse(
    (edge, ends): (usize, [usize; 2]),
    arc: &EllipseArc,
    camera: &Camera,
    precision: f64,
) -> Option<Circle> {
    let Camera::Central { principal, focal } = *camera else {
        return None;
    };
    // On the cone u^2 + v^2 = t^2 with linear forms in space: the ellipse's own coordinates times t.
    let form = |axis: DVec2| {
        let a = axis / axis.length_squared();
        a.extend(a.dot(arc.center - principal) / focal)
    };
    let (u, v) = (form(arc.major), form(arc.minor()));
    let t = DVec3::new(0.0, 0.0, -focal.recip());
    let outer = |n: DVec3| DMat3::from_cols(n * n.x, n * n.y, n * n.z);
    let cone = outer(u) + outer(v) - outer(t);
    let [(l3, e3), (l2, _), (l1, e1)] = eigen::symmetric(cone);
    if !(l3 < 0.0 && l2 > 0.0) {
        return None;
    }
    let (a, b) = ((l1 - l2).max(0.0).sqrt(), (l2 - l3).sqrt());
    let normals = [a * e1 + b * e3, a * e1 - b * e3].map(DVec3::normalize);
    let (_, ray) = camera.ray(arc.center);
    let facing = normals.map(|n| n.dot(ray.normalize()).abs());
    let slant = (1.0 - facing[0].max(facing[1]).powi(2)).sqrt();
    (facing[0].max(facing[1]) < FACE_ON).then(|| Circle {
        edge,
        v: ends,
        normals,
        error: (arc.uncertainty + precision / arc.major.length()) / slant,
        center: arc.center,
        reach: arc.major.length(),
    })
}

/// Normals that circles show, those of most circles first. Of the two of a circle the false one
/// seldom is that of another circle.
pub(super) fn groups(circles: &[Circle]) -> Vec<Group> {
    let mut order: Vec<usize> = (0..circles.len()).collect();
    order.sort_by(|&a, &b| circles[a].error.total_cmp(&circles[b].error));
    let mut all: Vec<Group> = Vec::new();
    for &start in &order {
        for normal in circles[start].normals {
            let error = circles[start].error;
            if all
                .iter()
                .any(|g| g.normal.cross(normal).length() < AGREE * (g.error + error))
            {
                continue;
            }
            let (mut sum, mut weight, mut members) = (DVec3::ZERO, 0.0, Vec::new());
            for &i in &order {
                if let Some(n) = circles[i].agreeing(normal, error) {
                    let w = circles[i].error.powi(-2);
                    sum += n * w;
                    weight += w;
                    members.push(i);
                }
            }
            all.push(Group {
                normal: sum.normalize_or(normal),
                error: f64::sqrt(weight).recip(),
                members,
            });
        }
    }
    all.sort_by_key(|g| std::cmp::Reverse(g.members.len()));
    all
}

/// Fewest circles beside each other that tell a normal, and the share of the larger one's size that
/// they are apart.
const BESIDE: usize = 2;
const APART: f64 = 0.1;

/// The normal that most circles beside each other have, if no other explains as many of them.
pub(super) fn apart(circles: &[Circle]) -> Option<Group> {
    let places = |group: &Group| {
        let mut seen: Vec<&Circle> = Vec::new();
        for circle in group.members.iter().map(|&i| &circles[i]) {
            let is_apart =
                |s: &&Circle| s.center.distance(circle.center) > APART * s.reach.max(circle.reach);
            if seen.iter().all(is_apart) {
                seen.push(circle);
            }
        }
        seen.len()
    };
    let all = groups(circles);
    let mut ranked: Vec<(usize, &Group)> = all.iter().map(|g| (places(g), g)).collect();
    ranked.sort_by_key(|(places, _)| std::cmp::Reverse(*places));
    let (most, first) = *ranked.first()?;
    let rival = ranked[1..]
        .iter()
        .any(|(places, g)| *places == most && g.members.iter().any(|m| first.members.contains(m)));
    (most >= BESIDE && !rival).then(|| first.clone())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Four circles around two normals, and one around a third.
    #[test]
    fn circles_beside_each_other_tell_their_normal() {
        let camera = Camera::Central {
            principal: DVec2::ZERO,
            focal: 2.5,
        };
        let [n, m, alone] = [[0.3, 0.5, 0.8], [0.9, -0.2, 0.3], [-0.5, 0.6, 0.4]]
            .map(|n| DVec3::from_array(n).normalize());
        let circle = |edge: usize, n: DVec3, center: [f64; 3]| {
            let (u, w) = n.any_orthonormal_pair();
            let points: Vec<DVec2> = (0..=24)
                .map(|i| 0.2 * f64::from(i))
                .map(|t| DVec3::from_array(center) + 0.3 * (t.cos() * u + t.sin() * w))
                .map(|p| camera.project(p))
                .collect();
            let Curve2::Ellipse(arc) = Curve2::recognise(&points) else {
                panic!("no ellipse");
            };
            of_ellipse((edge, [0; 2]), &arc, &camera, 1e-6).unwrap()
        };
        let mut all = vec![
            circle(0, n, [0.0, 0.0, -3.0]),
            circle(1, n, [0.6, 0.4, -3.5]),
            circle(2, m, [-0.7, 0.2, -3.2]),
            circle(3, m, [0.1, -0.8, -3.9]),
            circle(4, m, [-0.2, 0.9, -3.1]),
            circle(5, alone, [-0.5, -0.5, -3.3]),
        ];
        let first = apart(&all).unwrap();
        assert_eq!(first.members.len(), 3);
        assert!(first.normal.cross(m).length() < 1e-5);
        all.drain(2..5);
        let second = apart(&all).unwrap();
        assert!(second.normal.cross(n).length() < 1e-5);
        all.remove(1);
        // Two arcs of one circle have both of its normals.
        all.push(circle(6, n, [0.0, 0.0, -3.0]));
        assert!(apart(&all).is_none());
    }

    proptest! {
        #[test]
        fn one_of_the_normals_is_the_circles(
            n in prop::array::uniform3(-1.0..1.0f64),
            x in -0.8..0.8f64, y in -0.8..0.8f64, focal in 1.5..5.0f64,
        ) {
            let n = DVec3::from_array(n).normalize_or(DVec3::Y);
            let center = DVec3::new(x, y, -3.5);
            prop_assume!(n.dot(center.normalize()).abs() > 0.1);
            prop_assume!(n.dot(center.normalize()).abs() < 0.99);
            let camera = Camera::Central { principal: DVec2::new(0.1, 0.2), focal };
            let u = n.any_orthonormal_vector();
            let w = n.cross(u);
            let points: Vec<DVec2> = (0..=24)
                .map(|i| 0.2 * f64::from(i))
                .map(|t| camera.project(center + 0.5 * (t.cos() * u + t.sin() * w)))
                .collect();
            let Curve2::Ellipse(arc) = Curve2::recognise(&points) else {
                return Err(TestCaseError::fail("no ellipse"));
            };
            let circle = of_ellipse((0, [0; 2]), &arc, &camera, 1e-6).unwrap();
            let found = circle.agreeing(n, 1e-6).or(circle.agreeing(-n, 1e-6));
            prop_assert!(found.is_some_and(|m| m.cross(n).length() < 1e-6), "{circle:?} {n}");
        }
    }
}
