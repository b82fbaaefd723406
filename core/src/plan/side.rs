//! From which side a curved face is seen.
//!
//! Outlines are drawn, so a face shows its surface's front or its back all over. Where a line of
//! sight crosses the surface more than once, this tells on which crossing the face is.

use glam::DVec3;

use crate::drawing::{Drawing, SurfaceKind};
use crate::identify::Face;

use super::support::Support;
use super::uses::Use;
use super::view::View;

/// Cosine between the normal and the view below which a surface is seen edge-on.
pub(super) const GRAZING: f64 = 0.05;

/// A face shows a side if no more than this share of what it is judged by shows the other.
const DISSENT: f64 = 0.1;

/// For every face: 1 if it is seen against the gradient of its surface, -1 if along it; `None` if
/// nothing tells. `uses` are those of every edge, `vertices` those of the drawing in
/// space.
pub(super) fn sides(
    drawing: &Drawing,
    faces: &[Face],
    uses: &[[Use; 2]],
    supports: &[Support],
    vertices: &[DVec3],
    view: &View,
) -> Vec<Option<f64>> {
    let judge = |f: usize| {
        let support = &supports[f];
        // What stands in for another surface has outlines of its own.
        if faces[f].kind == SurfaceKind::Other || !is_curved(support) {
            return None;
        }
        let mut votes = [0.0f64; 2];
        let mut vote = |p: DVec3| {
            let toward = support.gradient(p).dot(view.toward(p));
            if toward.abs() > GRAZING {
                votes[usize::from(toward < 0.0)] += 1.0;
            }
        };
        for e in faces[f].loops.iter().flatten().map(|c| c.edge()) {
            let edge = &drawing.edges[e];
            vote(vertices[edge.v[0]]);
            vote(vertices[edge.v[1]]);
            let plane = uses[e].iter().find_map(|u| match supports[u.face] {
                Support::Plane { .. } => Some(supports[u.face]),
                _ => None,
            });
            if let (Some(plane), false) = (plane, edge.is_straight()) {
                let (from, direction) = view.ray(edge.points[edge.points.len() / 2]);
                let crossings = plane.crossings(from, direction);
                crossings.iter().for_each(|t| vote(from + direction * *t));
            }
        }
        let [front, back] = votes;
        let all = front + back;
        (all > 0.0 && front.min(back) <= DISSENT * all)
            .then(|| if front > back { 1.0 } else { -1.0 })
    };
    (0..faces.len()).map(judge).collect()
}

fn is_curved(support: &Support) -> bool {
    !matches!(support, Support::Plane { .. } | Support::Unknown)
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec2};

    use super::*;
    use crate::drawing::{CoEdge, Curve2, Edge};
    use crate::identify::Evidence;
    use crate::lift::Camera;

    /// A strip of a cylinder around x between two generators, seen along z.
    fn strip(kind: SurfaceKind, z: f64) -> Option<f64> {
        let at = |x: f64, y: f64| DVec3::new(x, y, z);
        let vertices = [at(0.0, 0.9), at(1.0, 0.9), at(1.0, 1.0), at(0.0, 1.0)];
        let edges = (0..4).map(|i| {
            let v = [i, (i + 1) % 4];
            Edge {
                v,
                points: v.map(|v| vertices[v].truncate()).to_vec(),
                curve: Curve2::Line,
            }
        });
        let drawing = Drawing::orthographic(
            vertices
                .iter()
                .map(|p| p.truncate())
                .collect::<Vec<DVec2>>(),
            edges.collect(),
        );
        let face = Face {
            kind,
            loops: vec![(0..4).map(|e| CoEdge::new(e, false)).collect()],
            confidence: 1.0,
            evidence: Evidence::default(),
        };
        let cylinder = Support::Cylinder {
            origin: DVec3::ZERO,
            axis: DVec3::X,
            radius: 1.0,
        };
        let view = View::new(Camera::Parallel, DMat3::IDENTITY);
        let edge = Use {
            face: 0,
            walk: 0,
            reversed: false,
        };
        sides(
            &drawing,
            &[face],
            &[[edge; 2]; 4],
            &[cylinder],
            &vertices,
            &view,
        )[0]
    }

    #[test]
    fn face_shows_the_side_that_its_vertices_are_on() {
        assert_eq!(strip(SurfaceKind::Cylinder, 0.9), Some(1.0));
        assert_eq!(strip(SurfaceKind::Cylinder, -0.9), Some(-1.0));
        assert_eq!(strip(SurfaceKind::Other, 0.9), None);
        // Nothing but outlines.
        assert_eq!(strip(SurfaceKind::Cylinder, 0.01), None);
    }
}
