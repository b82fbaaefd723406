//! Which face of the plan each triangle of a solid's mesh belongs to.

use faceformer::plan::{Plan, PlanFace, Surface3};
use glam::{DVec2, DVec3, Vec3Swizzles};

use super::mesh::Mesh;
use super::polygon;

/// The plan's face of each triangle, or `None` where none fits. Plan and mesh lie in the drawing's
/// frame, so a face's outline in the drawing tells coplanar faces apart: `outlines` has the drawn
/// rings of each face of the plan.
pub(crate) fn owners(mesh: &Mesh, plan: &Plan, outlines: &[Vec<Vec<DVec2>>]) -> Vec<Option<usize>> {
    let tolerance = 1e-3 * mesh.size();
    (0..mesh.triangles.len())
        .map(|t| {
            let corners = mesh.corners(t);
            let normal = mesh.normal(t);
            let fits = |face: &&(usize, &PlanFace)| {
                on_surface(&face.1.surface, corners, normal, tolerance)
            };
            let faces = || plan.faces.iter().enumerate();
            let center = (corners[0] + corners[1] + corners[2]).xy() / 3.0;
            let inside = |f: &usize| {
                outlines
                    .get(*f)
                    .is_some_and(|rings| polygon::contains(rings, center))
            };
            let known = || faces().filter(|face| fits(&face)).map(|(f, _)| f);
            // A filled surface is not known here, and takes what no other has.
            let filled = faces().filter(|f| f.1.surface == Surface3::Filled);
            let filled: Vec<usize> = filled.map(|(f, _)| f).collect();
            let candidates = || known().chain(filled.iter().copied());
            candidates().find(inside).or_else(|| candidates().next())
        })
        .collect()
}

/// Whether two faces lie on one surface, so that the side between them is no edge of the solid.
pub(crate) fn same_surface(a: &Surface3, b: &Surface3, tolerance: f64) -> bool {
    match (a, b) {
        (
            Surface3::Plane { origin, normal },
            Surface3::Plane {
                origin: other,
                normal: n,
            },
        ) => normal.dot(*n) > 0.9999 && (*other - *origin).dot(*normal).abs() < tolerance,
        (
            Surface3::Cylinder {
                origin,
                axis,
                radius,
                ..
            },
            Surface3::Cylinder {
                origin: other,
                axis: direction,
                radius: r,
                ..
            },
        ) => {
            axis.dot(*direction).abs() > 0.9999
                && (radius - r).abs() < tolerance
                && (*other - *origin).reject_from_normalized(*axis).length() < tolerance
        }
        _ => a == b,
    }
}

fn on_surface(surface: &Surface3, corners: [DVec3; 3], facing: DVec3, tolerance: f64) -> bool {
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    let straight = if matches!(surface, Surface3::Plane { .. }) {
        0.99
    } else {
        0.9
    };
    facing.dot(surface.normal(middle)) > straight
        && corners
            .iter()
            .all(|p| surface.distance(*p).abs() < tolerance)
}

#[cfg(test)]
mod tests {
    use faceformer::drawing::CoEdge;

    use super::super::mesh::tests::tetrahedron;
    use super::*;

    fn plane(origin: DVec3, normal: DVec3) -> PlanFace {
        PlanFace {
            surface: Surface3::Plane { origin, normal },
            loops: vec![vec![CoEdge::new(0, false)]],
            sources: vec![0],
        }
    }

    #[test]
    fn triangles_find_their_planes() {
        let slope = DVec3::ONE.normalize();
        let plan = Plan {
            vertices: Vec::new(),
            edges: Vec::new(),
            faces: vec![plane(DVec3::X, slope), plane(DVec3::ZERO, -DVec3::Z)],
            notices: Vec::new(),
        };
        let owners = owners(&tetrahedron(), &plan, &[]);
        assert_eq!(owners, [Some(1), None, None, Some(0)]);
    }

    #[test]
    fn halves_of_a_cylinder_are_one_surface() {
        let cylinder = |origin, axis, radius| Surface3::Cylinder {
            origin,
            axis,
            radius,
            hollow: false,
        };
        let a = cylinder(DVec3::ZERO, DVec3::Z, 1.0);
        assert!(same_surface(&a, &cylinder(DVec3::Z, -DVec3::Z, 1.0), 1e-6));
        assert!(!same_surface(&a, &cylinder(DVec3::X, DVec3::Z, 1.0), 1e-6));
        assert!(!same_surface(&a, &cylinder(DVec3::Z, DVec3::Z, 2.0), 1e-6));
        let plane = plane(DVec3::ZERO, DVec3::Z).surface;
        assert!(!same_surface(&a, &plane, 1e-6));
    }
}
