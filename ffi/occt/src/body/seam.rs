//! Seams: curves along a surface where a face that runs around it meets itself.

use std::f64::consts::PI;

use faceformer::drawing::CoEdge;
use faceformer::plan::{Curve3, Surface3};
use glam::DVec3;

use super::chart::{Chart, wrapped};
use super::split::split;
use super::{Body, BodyEdge, sphere};
use crate::OcctError;

/// Steps along an edge when its way around the surface is followed.
const STEPS: usize = 48;

/// Angle within which a vertex is on the seam, radians.
const ON_SEAM: f64 = 1e-7;

/// A vertex this close to the axis, relative to its distance from the origin, is on it.
const ON_AXIS: f64 = 1e-6;

/// A point of a loop where it crosses a line of constant parameter.
#[derive(Debug, Clone, Copy)]
enum Crossing {
    Vertex(usize),
    /// Inside of an edge: the co-edge, the stretch of it, the share of the stretch.
    Inside(CoEdge, usize, f64),
}

/// Gives a face its seam if it needs one.
pub(super) fn close(body: &mut Body, f: usize) -> Result<(), OcctError> {
    if matches!(body.faces[f].surface, Surface3::Sphere { .. }) {
        body.faces[f].axis = sphere::axis(body, &body.faces[f]);
    }
    let face = &body.faces[f];
    let Some(chart) = Chart::new(&face.surface, face.axis) else {
        return Ok(());
    };
    let turns: Vec<[i32; 2]> = face.loops.iter().map(|w| turns(body, &chart, w)).collect();
    let around = |k: usize| -> Vec<usize> {
        let turning = turns.iter().enumerate().filter(|(_, t)| t[k] != 0);
        turning.map(|(i, _)| i).collect()
    };
    let (along_u, along_v) = (around(0), around(1));
    let source = face.source + 1;
    match (&along_u[..], &along_v[..]) {
        ([], []) => Some(()),
        (&[a, b], []) => bridge(body, f, &chart, [a, b], 0, turns[a][0]),
        ([], &[a, b]) => bridge(body, f, &chart, [a, b], 1, turns[a][1]),
        (&[a], []) if !chart.is_torus() => pole(body, f, &chart, a, turns[a][0]),
        _ => None,
    }
    .ok_or_else(|| OcctError::Face {
        face: source,
        what:
            "it runs around its surface in a way that has no seam; draw the outlines that split it"
                .to_owned(),
        partial: Vec::new(),
    })
}

/// How often a loop runs around the surface in either parameter, with its sign. A loop through the
/// apex of a cone or the pole of a sphere does not.
fn turns(body: &Body, chart: &Chart, walk: &[CoEdge]) -> [i32; 2] {
    let mut turned = [0.0; 2];
    let mut on_axis = false;
    for &coedge in walk {
        let points = body.points(coedge, STEPS);
        on_axis |= chart.off_axis(points[0]) < ON_AXIS;
        for pair in points.windows(2) {
            let [p, q] = [pair[0], pair[1]].map(|p| chart.place(p));
            turned[0] += wrapped(q[0] - p[0]);
            if chart.is_torus() {
                turned[1] += wrapped(q[1] - p[1]);
            }
        }
    }
    if on_axis {
        turned[0] = 0.0;
    }
    turned.map(|t| (t / (2.0 * PI)).round() as i32)
}

/// Where a loop crosses the line on which parameter `k` is `value`.
fn crossings(body: &Body, chart: &Chart, walk: &[CoEdge], k: usize, value: f64) -> Vec<Crossing> {
    let mut found = Vec::new();
    let off = |p: DVec3| wrapped(chart.place(p)[k] - value);
    for &coedge in walk {
        let points = body.points(coedge, STEPS);
        let last = points.len() - 1;
        let on = |i: usize| (i == 0 || i == last) && off(points[i]).abs() < ON_SEAM;
        if on(0) {
            found.push(Crossing::Vertex(body.start(coedge)));
        }
        for i in 0..last {
            let (a, b) = (off(points[i]), off(points[i + 1]));
            let near = a.abs() < PI / 2.0 && b.abs() < PI / 2.0;
            if near && (a < 0.0) != (b < 0.0) && !on(i) && !on(i + 1) {
                found.push(Crossing::Inside(coedge, i, a / (a - b)));
            }
        }
    }
    found
}

/// A value of parameter `k` at which the loops `ends` are crossed once each and no other is, such
/// that splitting costs least; with the crossings.
fn line(
    body: &Body,
    f: usize,
    chart: &Chart,
    ends: &[usize],
    k: usize,
) -> Option<(f64, Vec<Crossing>)> {
    let loops = &body.faces[f].loops;
    let vertices = ends.iter().flat_map(|&l| &loops[l]).map(|c| body.start(*c));
    let mut values: Vec<f64> = vertices.map(|v| chart.place(body.vertices[v])[k]).collect();
    values.extend((0..16).map(|i| 0.1 + PI / 8.0 * f64::from(i)));
    let mut best: Option<(usize, f64, Vec<Crossing>)> = None;
    for value in values {
        let mut own = Vec::new();
        let clear = (0..loops.len()).all(|l| {
            let found = crossings(body, chart, &loops[l], k, value);
            let wanted = usize::from(ends.contains(&l));
            let fits = found.len() == wanted;
            own.extend(found);
            fits
        });
        let cost = own.iter().map(|c| cost(body, c)).sum();
        if clear && best.as_ref().is_none_or(|b| cost < b.0) {
            best = Some((cost, value, own));
        }
    }
    best.map(|(_, value, own)| (value, own))
}

/// What it costs to have a seam end at a crossing: splitting exact curves is better than those
/// through points, and cutting off a short end is worst.
fn cost(body: &Body, crossing: &Crossing) -> usize {
    let Crossing::Inside(coedge, step, _) = *crossing else {
        return 0;
    };
    let edge = &body.edges[coedge.edge()];
    let last = edge.points(&body.vertices, STEPS).len() - 2;
    let short = usize::from(step < 2 || step + 2 > last);
    let exact = !matches!(edge.curve, Curve3::Points { .. });
    if exact { 1 + short } else { 3 + 3 * short }
}

/// The vertex of a crossing; an edge is split for it if need be.
fn vertex(body: &mut Body, chart: &Chart, crossing: Crossing, k: usize, value: f64) -> usize {
    let (coedge, step, share) = match crossing {
        Crossing::Vertex(v) => return v,
        Crossing::Inside(coedge, step, share) => (coedge, step, share),
    };
    let points = body.points(coedge, STEPS);
    let curve = body.edges[coedge.edge()].curve.clone();
    let at = |share: f64| beside(&curve, &points, step, share);
    let off = |share: f64| wrapped(chart.place(at(share))[k] - value);
    let (mut low, mut high) = (0.0, 1.0);
    let below = off(low) < 0.0;
    let mut middle = share;
    for _ in 0..50 {
        if (off(middle) < 0.0) == below {
            low = middle;
        } else {
            high = middle;
        }
        middle = f64::midpoint(low, high);
    }
    let steps = points.len() - 1;
    let step = if coedge.is_reversed() {
        steps - 1 - step
    } else {
        step
    };
    split(body, coedge.edge(), at(middle), step, steps)
}

/// The point of a curve at a share of one of its steps.
fn beside(curve: &Curve3, points: &[DVec3], step: usize, share: f64) -> DVec3 {
    let (p, q) = (points[step], points[step + 1]);
    let chord = p.lerp(q, share);
    match *curve {
        Curve3::Line => chord,
        Curve3::Circle { center, radius, .. } => {
            center + (chord - center).normalize_or_zero() * radius
        }
        Curve3::Ellipse {
            center,
            normal,
            major,
            ratio,
        } => {
            let minor = normal.cross(major) * ratio;
            let d = chord - center;
            let x = d.dot(major) / major.length_squared();
            let y = d.dot(minor) / minor.length_squared();
            let long = x.hypot(y);
            center + (major * x + minor * y) / long
        }
        Curve3::Points { .. } => {
            // The cubic through the points around (Catmull and Rom 1974).
            let before = if step > 0 {
                points[step - 1]
            } else {
                p * 2.0 - q
            };
            let after = points.get(step + 2).copied().unwrap_or(q * 2.0 - p);
            let (m, n) = ((q - before) / 2.0, (after - p) / 2.0);
            let (t, s) = (share, 1.0 - share);
            p * (1.0 + 2.0 * t) * s * s + m * t * s * s + q * t * t * (3.0 - 2.0 * t)
                - n * t * t * s
        }
    }
}

/// Joins two loops that run around by a seam between them.
fn bridge(
    body: &mut Body,
    f: usize,
    chart: &Chart,
    ends: [usize; 2],
    k: usize,
    turn: i32,
) -> Option<()> {
    let (value, found) = line(body, f, chart, &ends, k)?;
    let mut vertices = [0; 2];
    // The crossings come in the order of the loops.
    let mut order = [0, 1];
    order.sort_by_key(|&i| ends[i]);
    for (crossing, i) in found.into_iter().zip(order) {
        vertices[i] = vertex(body, chart, crossing, k, value);
    }
    let face = &body.faces[f];
    let forwards = (turn > 0) != is_hollow(&face.surface);
    let curve = seam(&face.surface, chart, k, value, forwards);
    let edge = add_seam(body, f, vertices, curve);
    let loops = &mut body.faces[f].loops;
    let [a, b] = ends.map(|l| loops[l].clone());
    let mut whole = rotated(body, a, vertices[0])?;
    whole.push(CoEdge::new(edge, false));
    whole.extend(rotated(body, b, vertices[1])?);
    whole.push(CoEdge::new(edge, true));
    replace(body, f, &ends, whole);
    Some(())
}

/// Joins a loop around an apex or a pole to it.
fn pole(body: &mut Body, f: usize, chart: &Chart, l: usize, turn: i32) -> Option<()> {
    let surface = body.faces[f].surface.clone();
    let up = (turn > 0) != is_hollow(&surface);
    let point = match surface {
        // The apex is below the loop.
        Surface3::Cone { apex, .. } if !up => apex,
        Surface3::Sphere { center, radius, .. } => {
            center + chart.axis * if up { radius } else { -radius }
        }
        _ => return None,
    };
    let (value, found) = line(body, f, chart, &[l], 0)?;
    let start = vertex(body, chart, *found.first()?, 0, value);
    body.vertices.push(point);
    let end = body.vertices.len() - 1;
    let curve = seam(&surface, chart, 0, value, up);
    let edge = add_seam(body, f, [start, end], curve);
    let own = body.faces[f].loops[l].clone();
    let mut whole = rotated(body, own, start)?;
    whole.extend([CoEdge::new(edge, false), CoEdge::new(edge, true)]);
    replace(body, f, &[l], whole);
    Some(())
}

fn is_hollow(surface: &Surface3) -> bool {
    match *surface {
        Surface3::Cylinder { hollow, .. }
        | Surface3::Cone { hollow, .. }
        | Surface3::Sphere { hollow, .. }
        | Surface3::Torus { hollow, .. } => hollow,
        Surface3::Plane { .. } | Surface3::Filled => false,
    }
}

/// The curve on which parameter `k` is `value`. Across a turn in u it runs to larger v if
/// `forwards`; across a turn in v, to smaller u: the face is on the left of its loops.
fn seam(surface: &Surface3, chart: &Chart, k: usize, value: f64, forwards: bool) -> Curve3 {
    let out = chart.outwards(value);
    let way = if forwards { 1.0 } else { -1.0 };
    match *surface {
        Surface3::Sphere { center, radius, .. } => Curve3::Circle {
            center,
            normal: out.cross(chart.axis) * way,
            radius,
        },
        Surface3::Torus {
            center,
            axis,
            major,
            minor,
            ..
        } if k == 0 => Curve3::Circle {
            center: center + out * major,
            normal: out.cross(axis) * way,
            radius: minor,
        },
        Surface3::Torus {
            center,
            axis,
            major,
            minor,
            ..
        } => Curve3::Circle {
            center: center + axis * minor * value.sin(),
            normal: -axis * way,
            radius: major + minor * value.cos(),
        },
        _ => Curve3::Line,
    }
}

fn add_seam(body: &mut Body, f: usize, v: [usize; 2], curve: Curve3) -> usize {
    let first = body.faces[f].loops[0][0].edge();
    let source = body.edges[first].source;
    body.edges.push(BodyEdge { v, curve, source });
    body.edges.len() - 1
}

/// A loop that begins at a vertex of it.
fn rotated(body: &Body, mut walk: Vec<CoEdge>, vertex: usize) -> Option<Vec<CoEdge>> {
    let start = walk.iter().position(|c| body.start(*c) == vertex)?;
    walk.rotate_left(start);
    Some(walk)
}

/// Puts one loop, the first, in the place of others.
fn replace(body: &mut Body, f: usize, old: &[usize], whole: Vec<CoEdge>) {
    let loops = std::mem::take(&mut body.faces[f].loops);
    let rest = loops.into_iter().enumerate();
    let rest = rest.filter(|(l, _)| !old.contains(l)).map(|(_, walk)| walk);
    body.faces[f].loops = std::iter::once(whole).chain(rest).collect();
}
