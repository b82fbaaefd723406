//! The B-rep as the kernel wants it: without silhouettes, with seams.
//!
//! A plan has the drawing's edges, silhouettes included. Here the faces that silhouettes part
//! become one, edges that met only at a silhouette's end become one, and a face that runs around
//! its surface gets a seam, a curve along the surface that it meets itself in.

mod chart;
mod curve;
mod merge;
mod seam;
mod sphere;
mod split;

use faceformer::drawing::CoEdge;
use faceformer::plan::{Curve3, Plan, PlanEdge, Surface3};
use glam::DVec3;

use crate::OcctError;

/// A B-rep without silhouettes; lengths in the plan's units.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    pub(crate) vertices: Vec<DVec3>,
    pub(crate) edges: Vec<BodyEdge>,
    pub(crate) faces: Vec<BodyFace>,
}

/// An edge.
#[derive(Debug, Clone)]
pub(crate) struct BodyEdge {
    pub(crate) v: [usize; 2],
    pub(crate) curve: Curve3,
    /// Edge of the plan (from 0) that it came from; of a seam, one of its face.
    pub(crate) source: usize,
}

/// A face.
#[derive(Debug, Clone)]
pub(crate) struct BodyFace {
    pub(crate) surface: Surface3,
    /// Axis of the parameter plane, which a sphere leaves open.
    pub(crate) axis: DVec3,
    /// Outer loop first; none if the face is a whole sphere or torus.
    pub(crate) loops: Vec<Vec<CoEdge>>,
    /// Face of the plan (from 0) that it came from.
    pub(crate) source: usize,
}

impl Body {
    /// The body of a plan; if `apart`, without making one of the parts of filled faces that have several
    /// loops then.
    ///
    /// # Errors
    /// [`OcctError::Plan`] for indices out of range, [`OcctError::Face`] if a face runs around its
    /// surface in a way that has no seam.
    pub(crate) fn new(plan: &Plan, apart: bool) -> Result<Self, OcctError> {
        check(plan)?;
        let mut body = merge::merged(plan, apart);
        for face in 0..body.faces.len() {
            seam::close(&mut body, face)?;
        }
        Ok(body)
    }

    /// Points along a co-edge, both ends included.
    fn points(&self, coedge: CoEdge, steps: usize) -> Vec<DVec3> {
        let mut points = self.edges[coedge.edge()].points(&self.vertices, steps);
        if coedge.is_reversed() {
            points.reverse();
        }
        points
    }

    /// Vertex where a co-edge begins.
    pub(crate) fn start(&self, coedge: CoEdge) -> usize {
        self.edges[coedge.edge()].v[usize::from(coedge.is_reversed())]
    }

    /// Vertex where a co-edge ends.
    fn end(&self, coedge: CoEdge) -> usize {
        self.start(coedge.mate())
    }
}

impl BodyFace {
    /// Whether it is filled between several loops.
    pub(crate) fn is_filled_ring(&self) -> bool {
        matches!(self.surface, Surface3::Filled) && self.loops.len() > 1
    }
}

impl BodyEdge {
    fn points(&self, vertices: &[DVec3], steps: usize) -> Vec<DVec3> {
        let edge = PlanEdge {
            v: self.v,
            curve: self.curve.clone(),
            silhouette: false,
        };
        faceformer::plan::polyline(&edge, vertices, steps)
    }
}

/// Whether all indices of a plan are there.
fn check(plan: &Plan) -> Result<(), OcctError> {
    for (e, edge) in plan.edges.iter().enumerate() {
        if edge.v.iter().any(|&v| v >= plan.vertices.len()) {
            let what = format!("edge {} names a vertex that is not there", e + 1);
            return Err(OcctError::Plan(what));
        }
        if let Curve3::Points { points, .. } = &edge.curve
            && (points.len() < 2 || points.iter().any(|p| !p.is_finite()))
        {
            let what = format!("edge {} needs two finite points or more", e + 1);
            return Err(OcctError::Plan(what));
        }
    }
    for (f, face) in plan.faces.iter().enumerate() {
        if face.loops.is_empty() || face.loops.iter().any(Vec::is_empty) {
            let what = format!("face {} has no loop, or an empty one", f + 1);
            return Err(OcctError::Plan(what));
        }
        for e in face.loops.iter().flatten().map(|c: &CoEdge| c.edge()) {
            if e >= plan.edges.len() {
                let what = format!("face {} names edge {}, which is not there", f + 1, e + 1);
                return Err(OcctError::Plan(what));
            }
        }
    }
    Ok(())
}
