//! The steps of planning, in their order.

use std::collections::BTreeMap;

use glam::{DMat3, DVec3};

use crate::Result;
use crate::drawing::{CoEdge, Drawing, SurfaceKind};
use crate::identify::Face;
use crate::lift::{Camera, Lift, LiftedCurve};

use super::curves::{self, Place};
use super::lengths::Lengths;
use super::orient::orient;
use super::snap::{Joint, Measured, snap};
use super::support::{Support, checked, oriented};
use super::uses::{Use, uses};
use super::vertices::Incidence;
use super::view::View;
use super::{Orientation, Plan, PlanEdge, PlanError, PlanFace, PlanOptions};
use super::{finish, graze, sample, side, silhouette, touch, upright};

/// Surfaces are snapped within this share of the drawing's size, and within ten times the lift's
/// residual, but never more than [`SNAP_MOST`].
const SNAP_LEAST: f64 = 1e-5;
const SNAP_MOST: f64 = 2e-3;

/// Vertices and edges may be this far off their surfaces, as a share of the drawing's size; a CAD
/// kernel gets no larger tolerance.
const LIMIT: f64 = 1e-4;

/// Curves may be drawn this share of the size away from where their surfaces meet, and so many times
/// the drawing's noise.
const DRAWN_GAP: f64 = 0.02;
const DRAWN_ERRORS: f64 = 4.0;

/// A dominant direction and a model axis are the same within this angle, radians.
const SAME_AXIS: f64 = 0.01;

/// Plans the B-rep of a lifted drawing.
///
/// `faces` are the ones that were lifted, in the same order. The plan's edges and vertices are the
/// drawing's, with the same numbers; its faces are in the order of `faces`.
///
/// # Errors
/// [`PlanError`] naming the face or edge that does not close, cannot be built or does not fit.
pub fn plan(drawing: &Drawing, faces: &[Face], lift: &Lift, options: &PlanOptions) -> Result<Plan> {
    check(drawing, faces, lift, options)?;
    let size = drawing.size();
    let least = SNAP_LEAST * size;
    let length = (10.0 * lift.residual).clamp(least, SNAP_MOST * size);
    let first = planned(drawing, faces, lift, options, length);
    if first.is_ok() || length <= least {
        return first;
    }
    // One doubtful face makes the residual large; snapping by as much may move what was right.
    planned(drawing, faces, lift, options, least).or(first)
}

/// The plan with surfaces snapped within a length.
fn planned(
    drawing: &Drawing,
    faces: &[Face],
    lift: &Lift,
    options: &PlanOptions,
    snap_length: f64,
) -> Result<Plan> {
    // What is inexact is planned as it was meant.
    let regular = lift.regular.as_ref().map(|r| r.applied(drawing));
    let drawing = regular.as_ref().unwrap_or(drawing);
    let uses = uses(drawing, faces)?;
    let mut notices: Vec<String> = lift.regular.iter().flat_map(|r| r.notices()).collect();
    let (upright, found) = upright::rotation(&lift.directions);
    let rotation = match options.orientation {
        Orientation::Drawn => DMat3::IDENTITY,
        Orientation::Upright => {
            if !found {
                let what = "no dominant direction is known; the model lies as it is drawn";
                notices.push(what.to_owned());
            }
            upright
        }
    };
    // The model's axes, exactly orthogonal and, if it stands upright, exactly X, Y and Z.
    let axes: Vec<DVec3> = DVec3::AXES
        .into_iter()
        .filter(|a| {
            let axis = upright.transpose() * *a;
            lift.directions
                .iter()
                .any(|d| d.cross(axis).length() < SAME_AXIS * d.length())
        })
        .map(|a| match options.orientation {
            Orientation::Drawn => upright.transpose() * a,
            Orientation::Upright => a,
        })
        .collect();
    let view = View::new(lift.camera, rotation);
    let size = drawing.size();
    let lifted: Vec<DVec3> = drawing
        .vertices
        .iter()
        .zip(&lift.depths)
        .map(|(p, z)| view.place(*p, *z))
        .collect();

    let measured = measured(drawing, faces, lift, &view, &lifted)?;
    let tips = (0..faces.len()).filter(|&f| matches!(measured[f].support, Support::Cone { .. }));
    notices.extend(tips.filter_map(|f| assumed_tip(faces, &uses, f)));
    let mut smooth = smooth_joints(drawing, faces, &uses, &measured, |e| {
        let ends = drawing.edges[e].v.map(|v| lifted[v]);
        let outlines = |u: &Use| {
            let surface = &measured[u.face].support;
            silhouette::is_outline(surface, &drawing.edges[e], ends, &view)
        };
        uses[e].iter().any(outlines)
    });
    if lift.regular.is_some() {
        // Halves of one cylinder have one surface already, and others are different ones.
        smooth.retain(|joint| {
            let pair = joint.faces.map(|f| measured[f].support);
            pair[0] == pair[1] || !pair.iter().all(|s| matches!(s, Support::Cylinder { .. }))
        });
    }
    let mut snapped = snap(&measured, &smooth, &axes, snap_length);
    notices.append(&mut snapped.notices);
    let incidence = Incidence::new(drawing, &uses, &snapped.of_face);
    touch::make_exact(&mut snapped.supports, &incidence.contacts(), snap_length);
    let grazing = graze::triples(&snapped.supports, incidence.supports(), snap_length);
    graze::make_exact(&mut snapped.supports, &grazing);
    let supports: Vec<Support> = snapped
        .of_face
        .iter()
        .map(|&s| snapped.supports[s])
        .collect();

    let curves = lift.curves.iter().filter(|c| c.points.len() > 2);
    let curves: BTreeMap<usize, LiftedCurve> = curves
        .map(|c| (c.edge, c.turned(view.rotation())))
        .collect();
    let silhouettes: Vec<bool> = uses
        .iter()
        .zip(&drawing.edges)
        .enumerate()
        .map(|(e, ([a, b], edge))| match supports[a.face] {
            // The edges of a section sweep along with it, and are smooth where outlines end.
            _ if curves.contains_key(&e) => false,
            Support::Unknown => supports[b.face] == Support::Unknown && drawing.is_fold(e),
            surface => {
                let ends = edge.v.map(|v| lifted[v]);
                // What stands in for a surface of another kind has outlines of its own: its parts
                // were taken together because only such edges part them.
                let other = |u: &Use| stands_in(faces[u.face].kind, &surface);
                snapped.of_face[a.face] == snapped.of_face[b.face]
                    && (silhouette::is_outline(&surface, edge, ends, &view)
                        || (other(a) && other(b) && (!edge.is_straight() || drawing.is_fold(e))))
            }
        })
        .collect();
    let outlines: Vec<Option<Support>> = uses
        .iter()
        .zip(&drawing.edges)
        .zip(&silhouettes)
        .map(|(([a, _], edge), silhouette)| {
            let ends = edge.v.map(|v| lifted[v]);
            let surface = &supports[a.face];
            // What stands in for another surface is seen edge-on elsewhere.
            (*silhouette && silhouette::is_outline(surface, edge, ends, &view))
                .then(|| silhouette::plane_of(surface, ends, &view))?
        })
        .collect();
    let noise = lift.regular.as_ref().map_or(0.0, |r| r.noise);
    let lengths = Lengths {
        drawn: DRAWN_GAP * size + DRAWN_ERRORS * noise,
        snap: snap_length,
        limit: LIMIT * size,
    };
    let vertices = incidence.meet(&snapped.supports, &outlines, &lifted, lengths)?;
    let sides = side::sides(drawing, faces, &uses, &supports, &vertices, &view);
    let mut edges = Vec::with_capacity(drawing.edges.len());
    for (e, (edge, [a, b])) in drawing.edges.iter().zip(&uses).enumerate() {
        let place = Place {
            edge: e,
            drawn: edge,
            ends: edge.v.map(|v| vertices[v]),
            lifted: curves.get(&e),
            faces: [a.face, b.face],
            supports: [supports[a.face], supports[b.face]],
            sides: [sides[a.face], sides[b.face]],
            same: snapped.of_face[a.face] == snapped.of_face[b.face],
            silhouette: silhouettes[e],
        };
        edges.push(PlanEdge {
            v: edge.v,
            curve: curves::curve(&place, &view, lengths)?,
            silhouette: silhouettes[e],
        });
    }

    let points = |co: CoEdge, steps: usize| {
        let mut points = sample::polyline(&edges[co.edge()], &vertices, steps);
        if co.is_reversed() {
            points.reverse();
        }
        points.pop();
        points
    };
    let loops: Vec<_> = faces.iter().map(|f| f.loops.clone()).collect();
    for (f, (face, support)) in faces.iter().zip(&supports).enumerate() {
        let Some(built) = support.kind() else {
            continue;
        };
        if stands_in(face.kind, support) {
            let said = match face.kind {
                SurfaceKind::Other => "of another kind".to_owned(),
                kind => format!("taken for a {}", kind.name()),
            };
            notices.push(format!(
                "face {}, {said}, is built as a {}",
                f + 1,
                built.name()
            ));
        }
    }
    let turned = orient(&loops, &supports, &uses, &view, |e| silhouettes[e], points)?;
    let faces = turned
        .into_iter()
        .zip(&supports)
        .enumerate()
        .map(|(f, (face, support))| PlanFace {
            surface: oriented(support, face.reversed),
            loops: face.loops,
            sources: vec![f],
        })
        .collect();
    let plan = Plan {
        vertices,
        edges,
        faces,
        notices,
    };
    Ok(finish::finish(plan, options))
}

/// Whether the arguments belong together.
fn check(
    drawing: &Drawing,
    faces: &[Face],
    lift: &Lift,
    options: &PlanOptions,
) -> Result<(), PlanError> {
    let bad = |what: String| Err(PlanError::Input(what));
    let (vertices, depths) = (drawing.vertices.len(), lift.depths.len());
    if vertices != depths {
        return bad(format!("{vertices} vertices are drawn and {depths} lifted"));
    }
    if faces.len() != lift.surfaces.len() {
        let (given, lifted) = (faces.len(), lift.surfaces.len());
        return bad(format!("{given} faces are given and {lifted} lifted"));
    }
    if faces.is_empty() {
        return bad("there are no faces".to_owned());
    }
    if let Some(regular) = &lift.regular
        && (regular.vertices.len() != vertices
            || regular.curves.len() != drawing.edges.len()
            || regular.curves.iter().any(|c| c.len() < 2))
    {
        return bad("the regular drawing is another one".to_owned());
    }
    if let Camera::Central { focal, .. } = lift.camera
        && !(focal.is_finite() && focal > 0.0)
    {
        return bad(format!("the focal length {focal} is not a positive number"));
    }
    if let Some(v) = lift.depths.iter().position(|z| !z.is_finite()) {
        return bad(format!("vertex {v} has no depth"));
    }
    if !options.scale.is_finite() || options.scale <= 0.0 {
        return bad(format!(
            "the scale {} is not a positive number",
            options.scale
        ));
    }
    Ok(())
}

/// The faces' surfaces in the plan's frame, with the points that they must pass through.
fn measured(
    drawing: &Drawing,
    faces: &[Face],
    lift: &Lift,
    view: &View,
    lifted: &[DVec3],
) -> Result<Vec<Measured>, PlanError> {
    let mut measured = Vec::with_capacity(faces.len());
    for (f, (face, surface)) in faces.iter().zip(&lift.surfaces).enumerate() {
        let support = checked(surface).map_err(|what| PlanError::Surface {
            face: f + 1,
            what: what.to_owned(),
        })?;
        let corners = face.loops.iter().flatten().map(|co| {
            let edge = &drawing.edges[co.edge()];
            lifted[edge.v[usize::from(co.is_reversed())]]
        });
        measured.push(Measured {
            support: support.turned(view.rotation()),
            points: corners.collect(),
        });
    }
    Ok(measured)
}

/// What is said of a cone that only the end of a cylinder bounds: nothing drawn shows how deep it is.
fn assumed_tip(faces: &[Face], uses: &[[Use; 2]], face: usize) -> Option<String> {
    let kind = |u: &Use| faces[u.face].kind;
    let [ring] = &faces[face].loops[..] else {
        return None;
    };
    let ends_cylinder = ring.iter().all(|co| {
        let mut kinds = uses[co.edge()].iter().map(kind);
        kinds.any(|k| k == SurfaceKind::Cylinder)
    });
    (faces[face].kind == SurfaceKind::Cone && ends_cylinder).then(|| {
        format!(
            "the tip of face {} is not drawn; that of a drill was assumed",
            face + 1
        )
    })
}

/// Whether a surface is there in the place of one of another kind.
fn stands_in(kind: SurfaceKind, support: &Support) -> bool {
    kind == SurfaceKind::Other || support.kind().is_some_and(|own| own != kind)
}

/// Pairs of faces that an outline may part: straight, unless the surface is a sphere or a torus, or
/// one that stands in for another kind. `is_outline` tells which edges are outlines of a face's surface
/// as it was lifted.
fn smooth_joints(
    drawing: &Drawing,
    faces: &[Face],
    uses: &[[Use; 2]],
    measured: &[Measured],
    is_outline: impl Fn(usize) -> bool,
) -> Vec<Joint> {
    let doubly_curved = |face: usize| {
        let support = &measured[face].support;
        matches!(support, Support::Sphere { .. } | Support::Torus { .. })
    };
    let other = |u: &Use| stands_in(faces[u.face].kind, &measured[u.face].support);
    uses.iter()
        .zip(&drawing.edges)
        .enumerate()
        .filter(|(_, ([a, b], edge))| {
            edge.is_straight() != doubly_curved(a.face) || (other(a) && other(b))
        })
        .map(|(e, ([a, b], _))| Joint {
            faces: [a.face, b.face],
            outline: is_outline(e),
        })
        .collect()
}
