//! The drawing as it was meant, and its lift, from a draft that is fitted.

use glam::{DMat3, DVec2, DVec3};

use super::draft::Draft;
use super::problem::Dir;
use super::report::{Regular, Snap};
use crate::drawing::{Curve2, Drawing};
use crate::lift::directions::{Axis, Directions};
use crate::lift::heights::Heights;
use crate::lift::sheet::Sheet;
use crate::lift::{Lift, LiftMethod, Surface, conflicts, surfaces};

/// Steps in which a point is moved onto two surfaces.
const STEPS: usize = 20;

/// Sine of the angle within which an edge follows an axis.
const ALONG: f64 = 1e-6;

/// The lift of a fitted draft, with the drawing as it was meant.
pub(super) fn lift(draft: &Draft<'_, '_>, violation: f64, snapped: Vec<Snap>) -> Lift {
    let sheet = draft.sheet;
    let size = draft.size;
    let rotation = draft.problem.rotation;
    let camera = *sheet.camera();
    let places: Vec<DVec3> = (0..sheet.drawing.vertices.len())
        .map(|v| rotation * draft.place(v) * size)
        .collect();
    let vertices: Vec<DVec2> = places.iter().map(|p| camera.project(*p)).collect();
    let moved = vertices.iter().zip(&sheet.drawing.vertices);
    let moved = moved.map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
    let regular = Regular {
        noise: draft.noise * size,
        moved,
        curves: curves(draft, &vertices),
        vertices,
        snapped,
    };
    // In a parallel projection the place in depth is free.
    let mean = if camera.is_parallel() {
        places.iter().map(|p| p.z).sum::<f64>() / places.len().max(1) as f64
    } else {
        0.0
    };
    let depths: Vec<f64> = places.iter().map(|p| p.z - mean).collect();
    let mut found: Vec<Surface> = (0..sheet.faces.len())
        .map(|f| {
            let surface = draft.problem.surface(draft.body_of[f], &draft.problem.x);
            scaled(surface.turned(rotation), size).lowered(mean)
        })
        .collect();
    let drawing = regular.applied(sheet.drawing);
    let directions = directions(draft, &drawing, &places);
    let after = Sheet::new(&drawing, sheet.faces, &directions);
    if camera.is_parallel() && found.contains(&Surface::Unknown) {
        let heights = heights(&after, &depths, &found);
        let others = surfaces::surfaces(&after, &heights);
        for (own, other) in found.iter_mut().zip(others) {
            if *own == Surface::Unknown {
                *own = other;
            }
        }
    }
    Lift {
        conflicts: conflicts::conflicts(&after, &depths, &found, &[]),
        depths,
        camera,
        surfaces: found,
        directions: directions.axes.iter().map(|a| a.direction).collect(),
        method: LiftMethod::Regular,
        residual: violation * size,
        regular: Some(regular),
        curves: Vec::new(),
    }
}

/// Points of all edges: on both surfaces beside them, or moved with their ends.
fn curves(draft: &Draft<'_, '_>, vertices: &[DVec2]) -> Vec<Vec<DVec2>> {
    let drawing = draft.sheet.drawing;
    let edges = drawing.edges.iter().enumerate();
    edges
        .map(|(e, edge)| {
            let last = edge.points.len() - 1;
            let ends = edge.v.map(|v| vertices[v]);
            let steps = [ends[0] - edge.points[0], ends[1] - edge.points[last]];
            let along = |i: usize| i as f64 / last as f64;
            let with_ends = |i: usize| edge.points[i] + steps[0].lerp(steps[1], along(i));
            let mut points: Vec<DVec2> = (0..=last).map(with_ends).collect();
            (points[0], points[last]) = (ends[0], ends[1]);
            if draft.sheet.is_straight(e) {
                for (i, p) in points.iter_mut().enumerate().take(last).skip(1) {
                    *p = ends[0].lerp(ends[1], along(i));
                }
                return points;
            }
            let known = |b: usize| draft.is_plane(b) || draft.is_round(b);
            let Some([a, b]) = draft
                .beside(e)
                .filter(|[a, b]| a != b && known(*a) && known(*b))
            else {
                return points;
            };
            let [start, end] = edge.v.map(|v| draft.place(v));
            let first = if draft.is_plane(a) { a } else { b };
            let pair = [a, b].map(|b| draft.problem.surface(b, &draft.problem.x));
            let mut near = start;
            for (i, point) in points.iter_mut().enumerate().take(last).skip(1) {
                let rough = if edge.v[0] == edge.v[1] {
                    near
                } else {
                    start.lerp(end, along(i)).lerp(near, 0.5)
                };
                let place = both(draft.onto(first, *point / draft.size, rough), &pair);
                near = place;
                let drawn = draft.problem.camera.project(draft.problem.rotation * place);
                *point = drawn * draft.size;
            }
            points
        })
        .collect()
}

/// The point of two surfaces next to a point.
pub(super) fn both(start: DVec3, pair: &[Surface; 2]) -> DVec3 {
    let mut p = start;
    for _ in 0..STEPS {
        let (g, h) = (pair[0].gradient(p), pair[1].gradient(p));
        let (r, s) = (pair[0].distance(p), pair[1].distance(p));
        // The shortest step onto both tangent planes.
        let c = g.dot(h);
        let det = 1.0 - c * c;
        if det < 1e-9 {
            break;
        }
        let step = -g * ((r - c * s) / det) - h * ((s - c * r) / det);
        if !step.is_finite() {
            break;
        }
        p += step;
        if step.length() < 1e-15 {
            break;
        }
    }
    p
}

fn scaled(surface: Surface, size: f64) -> Surface {
    let mut surface = surface.with_origin(surface.origin() * size);
    if let Surface::Cylinder { radius, .. } = &mut surface {
        *radius *= size;
    }
    surface
}

/// The axes with the edges and circles that follow them now.
fn directions(draft: &Draft<'_, '_>, drawing: &Drawing, places: &[DVec3]) -> Directions {
    let old = draft.sheet.directions;
    let rotation: DMat3 = draft.problem.rotation;
    let axes = [rotation.x_axis, rotation.y_axis, rotation.z_axis];
    let axes = axes.into_iter().take(old.axes.len()).enumerate();
    let axes = axes.map(|(k, direction)| {
        let along = |e: usize| {
            let [a, b] = drawing.edges[e].v.map(|v| places[v]);
            let d = b - a;
            draft.sheet.is_straight(e)
                && d.length() > 0.0
                && d.cross(direction).length() <= ALONG * d.length()
        };
        let around = |e: usize| {
            matches!(drawing.edges[e].curve, Curve2::Ellipse(_))
                && draft.beside(e).is_some_and(|pair| {
                    pair.into_iter().any(|b| {
                        draft.is_plane(b)
                            && draft.problem.dirs[draft.problem.bodies[b].dir]
                                == Dir::Fixed(DVec3::AXES[k])
                    })
                })
        };
        let edges = 0..drawing.edges.len();
        Axis {
            direction: if direction.z < 0.0 {
                -direction
            } else {
                direction
            },
            edges: edges.clone().filter(|&e| along(e)).collect(),
            circles: edges.filter(|&e| around(e)).collect(),
        }
    });
    Directions {
        axes: axes.collect(),
        ..old.clone()
    }
}

/// Heights of what is regular now; in a parallel projection.
fn heights(sheet: &Sheet<'_>, depths: &[f64], surfaces: &[Surface]) -> Heights {
    let plane = |(f, surface): (usize, &Surface)| match *surface {
        Surface::Plane { origin, normal } if normal.z.abs() > 1e-6 => {
            let [a, b] = [normal.x / normal.z, normal.y / normal.z];
            let d = sheet.middles[f] - origin.truncate();
            Some([a, b, a * d.x + b * d.y - origin.z])
        }
        _ => None,
    };
    Heights {
        vertices: depths.to_vec(),
        planes: surfaces.iter().enumerate().map(plane).collect(),
        known: vec![true; depths.len()],
    }
}
