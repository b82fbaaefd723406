//! From a plan to the flat data that cross to C++, checked so that no index and no number there
//! can surprise the kernel.

use faceformer::drawing::CoEdge;
use faceformer::plan::{Curve3, Plan, PlanEdge, PlanFace, Surface3};
use glam::DVec3;

use crate::OcctError;
use crate::bridge::ffi;

/// Half diagonal of the model inside the kernel: OCCT's fixed precision of 1e-7 is then 1e-9 of it.
const INNER_SIZE: f64 = 100.0;

/// Largest tolerance allowed, as a share of the model's half diagonal.
const TOLERANCE: f64 = 1e-4;

/// OCCT's `Precision::Confusion`: no tolerance of a finished shape is smaller.
const CONFUSION: f64 = 1e-7;

/// Unit vectors may be this far from unit length.
const UNIT: f64 = 1e-6;

/// The model, in units in which its half diagonal is about [`INNER_SIZE`].
pub(crate) fn encode(plan: &Plan) -> Result<ffi::Model, OcctError> {
    if plan.faces.is_empty() || plan.edges.is_empty() {
        return Err(OcctError::Plan("it has no faces or no edges".to_owned()));
    }
    if plan.edges.len() >= i32::MAX as usize || plan.vertices.len() >= i32::MAX as usize {
        return Err(OcctError::Plan("it has too many edges".to_owned()));
    }
    let size = size(plan);
    if !size.is_finite() || size <= 0.0 {
        return Err(OcctError::Plan(
            "its vertices are not finite numbers or all the same point".to_owned(),
        ));
    }
    if size * TOLERANCE < CONFUSION {
        return Err(OcctError::Plan(format!(
            "its size {size:.1e} is too close to OCCT's precision of {CONFUSION:.0e}; scale it up"
        )));
    }
    // A power of two, so that scaling there and back changes no digit.
    let factor = (INNER_SIZE / size).log2().round().exp2();
    if !factor.is_normal() || !factor.recip().is_normal() {
        return Err(OcctError::Plan(format!(
            "its size {size:e} is out of range"
        )));
    }
    let edges = plan
        .edges
        .iter()
        .enumerate()
        .map(|(e, edge)| encode_edge(plan, e, edge, factor))
        .collect::<Result<_, _>>()?;
    let shells = Groups::of_faces(plan, |_| true)?.labels();
    let merged = Groups::of_faces(plan, |e| plan.edges[e].silhouette)?.labels();
    let faces = plan
        .faces
        .iter()
        .zip(&shells)
        .enumerate()
        .map(|(f, (face, &shell))| encode_face(f, face, shell, factor))
        .collect::<Result<_, _>>()?;
    let count = |labels: &[u32]| labels.iter().max().map_or(0, |m| m + 1);
    Ok(ffi::Model {
        points: plan.vertices.iter().map(|&p| point(p * factor)).collect(),
        edges,
        faces,
        shells: count(&shells),
        merged_faces: count(&merged),
        tolerance: TOLERANCE * size * factor,
        scale: factor.recip(),
    })
}

fn encode_edge(
    plan: &Plan,
    e: usize,
    edge: &PlanEdge,
    factor: f64,
) -> Result<ffi::Edge, OcctError> {
    let bad = |what: &str| OcctError::Plan(format!("edge {} {what}", e + 1));
    let [first, last] = edge.v;
    if first >= plan.vertices.len() || last >= plan.vertices.len() {
        return Err(bad("names a vertex that is not there"));
    }
    let zero = point(DVec3::ZERO);
    let mut out = ffi::Edge {
        first: first as u32,
        last: last as u32,
        kind: ffi::CurveKind::Line,
        center: zero,
        normal: zero,
        major: zero,
        ratio: 1.0,
        points: Vec::new(),
        silhouette: edge.silhouette,
    };
    let ellipse = |center: DVec3, normal: DVec3, major: DVec3, ratio: f64| {
        let finite = center.is_finite() && normal.is_finite() && major.is_finite();
        if !finite || !ratio.is_finite() {
            return Err(bad("has a number that is not finite"));
        }
        if (normal.length() - 1.0).abs() > UNIT {
            return Err(bad("has a normal that is not of unit length"));
        }
        if major.length() <= 0.0 || ratio <= 0.0 || ratio > 1.0 + UNIT {
            return Err(bad("has a curve without extent"));
        }
        if major.normalize().dot(normal).abs() > UNIT {
            return Err(bad(
                "has a major axis that is not in the plane of its curve",
            ));
        }
        Ok((
            point(center * factor),
            point(normal),
            point(major * factor),
            ratio.min(1.0),
        ))
    };
    match &edge.curve {
        Curve3::Line => {
            if first == last {
                return Err(bad("is straight but ends where it begins"));
            }
        }
        Curve3::Circle {
            center,
            normal,
            radius,
        } => {
            // Any radius vector may be the major axis of a circle.
            let arm = (plan.vertices[first] - *center).reject_from(*normal);
            let arm = arm.normalize_or(normal.any_orthogonal_vector().normalize_or_zero());
            out.kind = ffi::CurveKind::Ellipse;
            (out.center, out.normal, out.major, out.ratio) =
                ellipse(*center, *normal, arm * *radius, 1.0)?;
        }
        Curve3::Ellipse {
            center,
            normal,
            major,
            ratio,
        } => {
            out.kind = ffi::CurveKind::Ellipse;
            (out.center, out.normal, out.major, out.ratio) =
                ellipse(*center, *normal, *major, *ratio)?;
        }
        Curve3::Points { points } => {
            if points.len() < 2 || points.iter().any(|p| !p.is_finite()) {
                return Err(bad("needs two finite points or more"));
            }
            out.kind = ffi::CurveKind::Spline;
            out.points = points.iter().map(|&p| point(p * factor)).collect();
        }
    }
    Ok(out)
}

fn encode_face(f: usize, face: &PlanFace, shell: u32, factor: f64) -> Result<ffi::Face, OcctError> {
    let bad = |what: &str| OcctError::Plan(format!("face {} {what}", f + 1));
    if face.loops.is_empty() || face.loops.iter().any(Vec::is_empty) {
        return Err(bad("has no loop, or an empty one"));
    }
    let (kind, origin, direction, radius, hollow) = match face.surface {
        Surface3::Plane { origin, normal } => (ffi::SurfaceType::Plane, origin, normal, 1.0, false),
        Surface3::Cylinder {
            origin,
            axis,
            radius,
            hollow,
        } => (ffi::SurfaceType::Cylinder, origin, axis, radius, hollow),
    };
    if !origin.is_finite() || !direction.is_finite() || !radius.is_finite() || radius <= 0.0 {
        return Err(bad("has a surface with a number that cannot be used"));
    }
    if (direction.length() - 1.0).abs() > UNIT {
        return Err(bad("has a normal or axis that is not of unit length"));
    }
    Ok(ffi::Face {
        kind,
        origin: point(origin * factor),
        direction: point(direction),
        radius: radius * factor,
        hollow,
        loops: face
            .loops
            .iter()
            .map(|l| ffi::Loop {
                coedges: l.iter().map(|c| c.signed() as i32).collect(),
            })
            .collect(),
        shell,
    })
}

fn point(p: DVec3) -> ffi::Point {
    ffi::Point {
        x: p.x,
        y: p.y,
        z: p.z,
    }
}

/// Half diagonal of the box around vertices, circles and curve points; NaN if one is NaN.
fn size(plan: &Plan) -> f64 {
    let mut low = DVec3::INFINITY;
    let mut high = DVec3::NEG_INFINITY;
    let mut finite = true;
    let mut add = |p: DVec3| {
        finite &= p.is_finite();
        low = low.min(p);
        high = high.max(p);
    };
    plan.vertices.iter().for_each(|&p| add(p));
    for edge in &plan.edges {
        // Only whole circles reach beyond their vertices by more than a small factor.
        match &edge.curve {
            Curve3::Circle { center, .. } | Curve3::Ellipse { center, .. }
                if edge.v[0] == edge.v[1] =>
            {
                if let Some(&p) = plan.vertices.get(edge.v[0]) {
                    add(*center * 2.0 - p);
                }
            }
            Curve3::Points { points } => points.iter().for_each(|&p| add(p)),
            _ => {}
        }
    }
    if finite {
        (high - low).length() / 2.0
    } else {
        f64::NAN
    }
}

/// Faces grouped by the edges they share.
struct Groups(Vec<usize>);

impl Groups {
    fn of_faces(plan: &Plan, joins: impl Fn(usize) -> bool) -> Result<Self, OcctError> {
        let mut groups = Self((0..plan.faces.len()).collect());
        let mut seen = vec![None; plan.edges.len()];
        for (f, face) in plan.faces.iter().enumerate() {
            for e in face.loops.iter().flatten().map(|c: &CoEdge| c.edge()) {
                let Some(first) = seen.get_mut(e) else {
                    let what = format!("face {} names edge {}, which is not there", f + 1, e + 1);
                    return Err(OcctError::Plan(what));
                };
                match *first {
                    None => *first = Some(f),
                    Some(g) if joins(e) => groups.join(f, g),
                    Some(_) => {}
                }
            }
        }
        Ok(groups)
    }

    fn root(&self, mut f: usize) -> usize {
        while self.0[f] != f {
            f = self.0[f];
        }
        f
    }

    /// The smaller index becomes the root, so that labels are in the order of the faces.
    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }

    /// Group of every face, numbered from 0 in the order of their first faces.
    fn labels(&self) -> Vec<u32> {
        let mut labels = vec![0; self.0.len()];
        let mut next = 0;
        for f in 0..labels.len() {
            let root = self.root(f);
            if root == f {
                labels[f] = next;
                next += 1;
            } else {
                labels[f] = labels[root];
            }
        }
        labels
    }
}
