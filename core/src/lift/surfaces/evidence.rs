//! What is known of the boundary of a face, or of the parts of one surface.

use glam::{DVec2, DVec3};

use super::flat::best_plane;
use super::ring::Ring;
use crate::drawing::{Curve2, Drawing};
use crate::lift::Surface;
use crate::lift::heights::Heights;
use crate::lift::sheet::Sheet;

/// Points of an edge may be this far off a circle, relative to the drawing's size.
const OFF_RING: f64 = 2e-4;

/// At most this many points of an edge count.
const POINTS: usize = 24;

/// A boundary edge whose place in space is known.
#[derive(Debug, Clone)]
pub(super) struct Bound {
    /// Points of it, ends included.
    pub(super) points: Vec<DVec3>,
    /// The circle that it is on, if it is one.
    pub(super) ring: Option<Ring>,
    /// The surface on its other side.
    pub(super) beside: Surface,
}

/// What is known of the boundary of a surface.
#[derive(Debug, Clone)]
pub(super) struct Evidence {
    /// Vertices of the surface.
    pub(super) vertices: Vec<DVec3>,
    pub(super) bounds: Vec<Bound>,
    /// Drawn points of the outlines: lines of sight that touch the surface.
    pub(super) outlines: Vec<DVec2>,
    /// Vertices on outlines, where the surface is seen edge-on.
    pub(super) outline_ends: Vec<DVec3>,
    /// Circles that outlines are drawn as, centre and radius: of a sphere.
    pub(super) discs: Vec<(DVec2, f64)>,
    /// Axes of the drawing.
    pub(super) directions: Vec<DVec3>,
    /// Half diagonal of the drawing.
    pub(super) size: f64,
}

/// A vertex in space.
pub(super) fn vertex(sheet: &Sheet<'_>, heights: &Heights, v: usize) -> DVec3 {
    sheet.place(sheet.drawing.vertices[v], heights.of(v))
}

impl Evidence {
    /// The evidence of the faces `part`, which are parts of one surface.
    pub(super) fn new(
        sheet: &Sheet<'_>,
        heights: &Heights,
        part: &[usize],
        known: &[Surface],
    ) -> Self {
        let mut edges: Vec<usize> = part
            .iter()
            .flat_map(|&f| sheet.edges_of(f))
            .copied()
            .collect();
        edges.sort_unstable();
        edges.dedup();
        let mut corners: Vec<usize> = part
            .iter()
            .flat_map(|&f| sheet.corners[f].iter().copied())
            .collect();
        corners.sort_unstable();
        corners.dedup();
        corners.retain(|&v| heights.known[v]);
        let mut evidence = Self {
            vertices: corners.iter().map(|&v| vertex(sheet, heights, v)).collect(),
            bounds: Vec::new(),
            outlines: Vec::new(),
            outline_ends: Vec::new(),
            discs: Vec::new(),
            directions: sheet.directions.axes.iter().map(|a| a.direction).collect(),
            size: sheet.size,
        };
        for e in edges {
            let outside = sheet.neighbours(e).iter().find(|f| !part.contains(f));
            match outside {
                // Between two parts: an outline.
                None => evidence.add_outline(sheet, heights, e),
                Some(&beside) if heights.are_known(&sheet.drawing.edges[e].v) => {
                    evidence
                        .bounds
                        .extend(bound(sheet, heights, e, known[beside]));
                }
                Some(_) => {}
            }
        }
        evidence
    }

    fn add_outline(&mut self, sheet: &Sheet<'_>, heights: &Heights, edge: usize) {
        let e = &sheet.drawing.edges[edge];
        self.outlines
            .extend(thinned(&e.points).map(|i| e.points[i]));
        let ends = e.v.into_iter().filter(|&v| heights.known[v]);
        self.outline_ends
            .extend(ends.map(|v| vertex(sheet, heights, v)));
        if let Curve2::Ellipse(arc) = &e.curve {
            self.discs.push((arc.center, arc.major.length()));
        }
    }

    /// All known points of the surface.
    pub(super) fn points(&self) -> impl Iterator<Item = DVec3> + '_ {
        let bounds = self.bounds.iter().flat_map(|b| b.points.iter().copied());
        self.vertices.iter().copied().chain(bounds)
    }

    /// Circles on the boundary, with the surface beside each.
    pub(super) fn rings(&self) -> impl Iterator<Item = (Ring, &Bound)> {
        self.bounds.iter().filter_map(|b| Some((b.ring?, b)))
    }
}

/// Indices of a list of points, both ends and at most [`POINTS`] between.
fn thinned(points: &[DVec2]) -> impl Iterator<Item = usize> + use<> {
    let last = points.len().saturating_sub(1);
    let steps = last.clamp(1, POINTS);
    (0..=steps).map(move |i| i * last / steps)
}

/// An edge in space, if its place is known: straight, a circle around an axis, on a plane, on
/// another known surface, or drawn as an ellipse that is a circle through its lifted ends.
fn bound(sheet: &Sheet<'_>, heights: &Heights, edge: usize, beside: Surface) -> Option<Bound> {
    let e = &sheet.drawing.edges[edge];
    let ends = e.v.map(|v| vertex(sheet, heights, v));
    let tolerance = OFF_RING * sheet.size;
    if sheet.is_straight(edge) {
        return Some(Bound {
            points: vec![ends[0], ends[0].midpoint(ends[1]), ends[1]],
            ring: None,
            beside,
        });
    }
    let drawn: Vec<DVec2> = thinned(&e.points).map(|i| e.points[i]).collect();
    let on_plane = |normal: DVec3| -> Vec<DVec3> {
        let depth = |p: &DVec2| {
            let d = *p - ends[0].truncate();
            ends[0].z - d.dot(normal.truncate()) / normal.z
        };
        drawn.iter().map(|p| p.extend(depth(p))).collect()
    };
    let planar = |normal: DVec3| {
        let points = on_plane(normal);
        let ring = Ring::through(&points, Some(normal), tolerance);
        Bound {
            points,
            ring,
            beside,
        }
    };
    if let Some((k, _)) = sheet.circles[edge] {
        return Some(planar(sheet.axis(k)));
    }
    match beside {
        Surface::Plane { normal, .. } if normal.z.abs() > 0.02 => Some(planar(normal)),
        Surface::Plane { .. } => None,
        Surface::Unknown => free_circle(sheet.drawing, edge, ends, sheet.size).map(planar),
        _ => {
            if let Some(normal) = free_circle(sheet.drawing, edge, ends, sheet.size) {
                return Some(planar(normal));
            }
            let points = on_surface(&beside, &drawn, ends)?;
            let normal = best_plane(&points).map(|p| p.1);
            let ring = normal.and_then(|n| Ring::through(&points, Some(n), tolerance));
            Some(Bound {
                points,
                ring,
                beside,
            })
        }
    }
}

/// Normal of the circle that an edge is drawn as, if the depths of its ends tell which of the two.
fn free_circle(drawing: &Drawing, edge: usize, ends: [DVec3; 2], size: f64) -> Option<DVec3> {
    /// Relative uncertainty of the axes up to which an ellipse tells its plane.
    const UNCERTAIN: f64 = 2e-3;
    let Curve2::Ellipse(arc) = &drawing.edges[edge].curve else {
        return None;
    };
    let chord = ends[1] - ends[0];
    if arc.uncertainty > UNCERTAIN || arc.ratio > 0.999 || chord.length() < 1e-3 * size {
        return None;
    }
    let slant = (1.0 - arc.ratio * arc.ratio).sqrt();
    let side = arc.minor().normalize() * slant;
    let normals = [side.extend(arc.ratio), (-side).extend(arc.ratio)];
    let off = normals.map(|n| chord.normalize().dot(n).abs());
    let (best, other) = if off[0] <= off[1] { (0, 1) } else { (1, 0) };
    (off[best] < 5e-3 && off[other] > 10.0 * off[best] + 5e-3).then(|| normals[best])
}

/// Drawn points lifted onto a surface, such that the curve runs on smoothly from its first end.
fn on_surface(surface: &Surface, drawn: &[DVec2], ends: [DVec3; 2]) -> Option<Vec<DVec3>> {
    let mut points = vec![ends[0]];
    for p in &drawn[1..drawn.len() - 1] {
        let expected = match points[..] {
            [.., a, b] => 2.0 * b.z - a.z,
            _ => ends[0].z,
        };
        let z = surface
            .crossings(p.extend(0.0), DVec3::Z)
            .into_iter()
            .min_by(|a, b| (a - expected).abs().total_cmp(&(b - expected).abs()))?;
        points.push(p.extend(z));
    }
    // A curve that ends at another depth has gone astray.
    let [.., before, last] = points[..] else {
        return None;
    };
    let jump = (ends[1].z - last.z).abs();
    let step = last.distance(before) + last.distance(ends[1]);
    points.push(ends[1]);
    (jump <= 4.0 * step).then_some(points)
}
