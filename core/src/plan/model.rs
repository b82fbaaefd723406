//! The neutral B-rep.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::drawing::CoEdge;

/// Curve of an edge in space; it runs from the edge's first vertex to its second.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Curve3 {
    /// Straight segment.
    Line,
    /// Circle or arc, counter-clockwise around `normal`; whole if the edge's vertices are equal.
    Circle {
        /// Centre.
        center: DVec3,
        /// Unit normal; its sign tells the way the arc is walked.
        normal: DVec3,
        /// Radius.
        radius: f64,
    },
    /// Ellipse or arc, counter-clockwise around `normal`; whole if the edge's vertices are equal.
    Ellipse {
        /// Centre.
        center: DVec3,
        /// Unit normal; its sign tells the way the arc is walked.
        normal: DVec3,
        /// Semi-major axis as a vector.
        major: DVec3,
        /// Minor over major semi-axis, in (0, 1].
        ratio: f64,
    },
    /// Curve through points, both ends included; to be interpolated.
    Points {
        /// Points in order, at least two.
        points: Vec<DVec3>,
        /// Unit tangents at the first and the last point, along the curve, if they are known.
        #[serde(default)]
        tangents: Option<[DVec3; 2]>,
    },
}

/// Surface of a face in space.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Surface3 {
    /// Plane with its outward unit normal.
    Plane {
        /// A point of the plane.
        origin: DVec3,
        /// Unit normal, out of the solid.
        normal: DVec3,
    },
    /// Circular cylinder.
    Cylinder {
        /// A point of the axis.
        origin: DVec3,
        /// Unit direction of the axis.
        axis: DVec3,
        /// Radius.
        radius: f64,
        /// Whether the solid is outside the cylinder, as around a hole.
        hollow: bool,
    },
    /// One nappe of a circular cone.
    Cone {
        /// The apex.
        apex: DVec3,
        /// Unit direction of the axis, from the apex into the cone.
        axis: DVec3,
        /// Angle between axis and surface, radians, between 0 and a right angle.
        angle: f64,
        /// Whether the solid is outside the cone, as at a countersink.
        hollow: bool,
    },
    /// Sphere.
    Sphere {
        /// Centre.
        center: DVec3,
        /// Radius.
        radius: f64,
        /// Whether the solid is outside the sphere.
        hollow: bool,
    },
    /// Torus.
    Torus {
        /// Centre.
        center: DVec3,
        /// Unit direction of the axis.
        axis: DVec3,
        /// Radius of the spine.
        major: f64,
        /// Radius of the tube.
        minor: f64,
        /// Whether the solid is outside the tube, as at the fillet of an inner corner.
        hollow: bool,
    },
    /// A surface of no known kind: it is to be laid through the face's edges.
    Filled,
}

/// An edge of the plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlanEdge {
    /// First and second vertex, indices from 0.
    pub v: [usize; 2],
    /// Curve.
    pub curve: Curve3,
    /// Whether it is a silhouette: it splits one surface and is no edge of the final solid.
    pub silhouette: bool,
}

/// A face of the plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlanFace {
    /// Surface.
    pub surface: Surface3,
    /// Loops of co-edges of the plan's edges, outer first; seen from outside the face is on the
    /// left.
    pub loops: Vec<Vec<CoEdge>>,
    /// Faces of the drawing (from 0) that it came from.
    pub sources: Vec<usize>,
}

/// A neutral B-rep in model units, camera frame turned so that the model stands upright.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// Vertices.
    pub vertices: Vec<DVec3>,
    /// Edges.
    pub edges: Vec<PlanEdge>,
    /// Faces; each edge has one co-edge in each of two loops.
    pub faces: Vec<PlanFace>,
    /// What was snapped, for the user.
    #[serde(default)]
    pub notices: Vec<String>,
}
