//! From a plan to the flat data that cross to C++, checked so that no index and no number there
//! can surprise the kernel.

use std::f64::consts::FRAC_PI_2;

use faceformer::plan::{Curve3, Plan, Surface3};
use glam::DVec3;

use crate::OcctError;
use crate::body::{Body, BodyEdge, BodyFace};
use crate::bridge::ffi;
use crate::groups::Groups;

/// Half diagonal of the model inside the kernel: OCCT's fixed precision of 1e-7 is then 1e-9 of it.
const INNER_SIZE: f64 = 100.0;

/// Largest tolerance allowed, as a share of the model's half diagonal.
const TOLERANCE: f64 = 1e-4;

/// The same where faces are filled: a surface laid through many edges misses some, and the report says by
/// how much.
const FILLED_TOLERANCE: f64 = 5e-4;

/// OCCT's `Precision::Confusion`: no tolerance of a finished shape is smaller.
const CONFUSION: f64 = 1e-7;

/// Unit vectors may be this far from unit length.
const UNIT: f64 = 1e-6;

/// A model, and which edges and faces of the plan (from 0) its own are.
pub(crate) struct Encoded {
    /// In units in which its half diagonal is about [`INNER_SIZE`].
    pub(crate) model: ffi::Model,
    pub(crate) edges: Vec<usize>,
    pub(crate) faces: Vec<usize>,
    /// Whether some face is filled between several loops.
    pub(crate) rings: bool,
}

/// The model of a plan; `apart` as for [`Body::new`].
pub(crate) fn encode(plan: &Plan, apart: bool) -> Result<Encoded, OcctError> {
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
    for (f, face) in plan.faces.iter().enumerate() {
        check_surface(f, &face.surface)?;
    }
    let body = Body::new(plan, apart)?;
    let edges = body
        .edges
        .iter()
        .map(|edge| encode_edge(&body, edge, factor))
        .collect::<Result<_, _>>()?;
    let loops = body.faces.iter().map(|f| &f.loops);
    let shells = Groups::new(loops, body.edges.len(), |_| true).labels();
    let faces = body
        .faces
        .iter()
        .zip(&shells)
        .map(|(face, &shell)| encode_face(&body, face, shell, factor))
        .collect();
    Ok(Encoded {
        edges: body.edges.iter().map(|e| e.source).collect(),
        faces: body.faces.iter().map(|f| f.source).collect(),
        rings: body.faces.iter().any(BodyFace::is_filled_ring),
        model: ffi::Model {
            points: body.vertices.iter().map(|&p| point(p * factor)).collect(),
            edges,
            faces,
            shells: shells.iter().max().map_or(0, |m| m + 1),
            tolerance: TOLERANCE * size * factor,
            filled_tolerance: FILLED_TOLERANCE * size * factor,
            scale: factor.recip(),
        },
    })
}

fn encode_edge(body: &Body, edge: &BodyEdge, factor: f64) -> Result<ffi::Edge, OcctError> {
    let bad = |what: &str| OcctError::Plan(format!("edge {} {what}", edge.source + 1));
    let [first, last] = edge.v;
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
        tangents: Vec::new(),
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
            let arm = (body.vertices[first] - *center).reject_from(*normal);
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
        Curve3::Points { points, tangents } => {
            out.kind = ffi::CurveKind::Spline;
            out.points = points.iter().map(|&p| point(p * factor)).collect();
            let known = tangents.filter(|t| t.iter().all(|t| t.is_finite()));
            out.tangents = known.into_iter().flatten().map(point).collect();
        }
    }
    Ok(out)
}

/// Whether the numbers of a surface make sense.
fn check_surface(f: usize, surface: &Surface3) -> Result<(), OcctError> {
    let bad = |what: &str| Err(OcctError::Plan(format!("face {} {what}", f + 1)));
    let (origin, direction, lengths) = match *surface {
        Surface3::Plane { origin, normal } => (origin, normal, [1.0; 2]),
        Surface3::Cylinder {
            origin,
            axis,
            radius,
            ..
        } => (origin, axis, [radius; 2]),
        Surface3::Cone {
            apex, axis, angle, ..
        } => (apex, axis, [angle, FRAC_PI_2 - angle]),
        Surface3::Sphere { center, radius, .. } => (center, DVec3::Z, [radius; 2]),
        Surface3::Torus {
            center,
            axis,
            major,
            minor,
            ..
        } => (center, axis, [major, minor]),
        Surface3::Filled => return Ok(()),
    };
    let positive = |x: f64| x.is_finite() && x > 0.0;
    if !origin.is_finite() || !direction.is_finite() || !lengths.into_iter().all(positive) {
        return bad("has a surface with a number that cannot be used");
    }
    if (direction.length() - 1.0).abs() > UNIT {
        return bad("has a normal or axis that is not of unit length");
    }
    Ok(())
}

fn encode_face(body: &Body, face: &BodyFace, shell: u32, factor: f64) -> ffi::Face {
    let zero = DVec3::ZERO;
    // Kind, origin, direction, the two lengths or angles, which side is out.
    let (kind, origin, direction, [first, second], hollow) = match face.surface {
        Surface3::Plane { origin, normal } => {
            (ffi::SurfaceType::Plane, origin, normal, [0.0; 2], false)
        }
        Surface3::Cylinder {
            origin,
            axis,
            radius,
            hollow,
        } => (
            ffi::SurfaceType::Cylinder,
            origin,
            axis,
            [radius * factor, 0.0],
            hollow,
        ),
        Surface3::Cone {
            apex,
            axis,
            angle,
            hollow,
        } => {
            // Placed beside the face, which may be far from the apex.
            let vertices = face.loops.iter().flatten().map(|c| body.start(*c));
            let heights = vertices.map(|v| axis.dot(body.vertices[v] - apex));
            let height = heights.fold(0.0, f64::max);
            let radius = height * angle.tan() * factor;
            let kind = ffi::SurfaceType::Cone;
            (kind, apex + axis * height, axis, [radius, angle], hollow)
        }
        Surface3::Sphere {
            center,
            radius,
            hollow,
        } => (
            ffi::SurfaceType::Sphere,
            center,
            face.axis,
            [radius * factor, 0.0],
            hollow,
        ),
        Surface3::Torus {
            center,
            axis,
            major,
            minor,
            hollow,
        } => (
            ffi::SurfaceType::Torus,
            center,
            axis,
            [major * factor, minor * factor],
            hollow,
        ),
        Surface3::Filled => (ffi::SurfaceType::Filled, zero, DVec3::Z, [0.0; 2], false),
    };
    ffi::Face {
        kind,
        origin: point(origin * factor),
        direction: point(direction),
        first,
        second,
        hollow,
        loops: face
            .loops
            .iter()
            .map(|l| ffi::Loop {
                coedges: l.iter().map(|c| c.signed() as i32).collect(),
            })
            .collect(),
        shell,
        source: face.source as u32 + 1,
    }
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
            Curve3::Points { points, .. } => points.iter().for_each(|&p| add(p)),
            _ => {}
        }
    }
    if finite {
        (high - low).length() / 2.0
    } else {
        f64::NAN
    }
}
