//! Loops and parts as drawn and lifted.

use glam::{DVec2, DVec3};

use super::axis::{AxisLine, axis_line, is_ring, ring_plane};
use super::tolerance::squared;
use crate::drawing::{Curve2, Drawing, Graph, SurfaceKind};
use crate::identify::Face;
use crate::lift::{Camera, Pieces, Tilt};
use crate::polygon;

/// A loop.
#[derive(Debug, Clone)]
pub(super) struct Outline {
    pub(super) part: usize,
    pub(super) vertices: Vec<usize>,
    /// As drawn, in the order of its walk.
    pub(super) polygon: Vec<DVec2>,
    /// Depth of each point of the polygon in its part.
    depths: Vec<f64>,
    pub(super) low: DVec2,
    pub(super) high: DVec2,
    /// Signed area as drawn, positive if counter-clockwise.
    pub(super) area: f64,
    /// Its plane, if it may bound one and the slope is known.
    pub(super) plane: Option<Tilt>,
    /// Error of its plane's normal, radians, that the drawing's leaves.
    pub(super) turn: f64,
    /// Whether it bounds no plane.
    pub(super) curved: bool,
    /// Kind of its surface as it looks alone.
    pub(super) kind: SurfaceKind,
    /// Whether it is one closed edge that is no circle: a silhouette, with a curved face on either
    /// side.
    pub(super) fold: bool,
    /// Whether it is a whole circle.
    pub(super) ring: bool,
    /// Direction in which its longest straight edge is drawn, if it bounds a curved face.
    pub(super) ruling: Option<DVec2>,
    /// Its corners as drawn, with depth in its part.
    pub(super) corners: Vec<(DVec2, f64)>,
    /// Axis of a circle, or of a curved face that is one of revolution.
    pub(super) line: Option<AxisLine>,
}

/// A part of the drawing that shares no vertex with the others.
#[derive(Debug, Clone)]
pub(super) struct Part {
    pub(super) loops: Vec<usize>,
    /// Points of its edges, with depth in the part.
    pub(super) samples: Vec<DVec3>,
    pub(super) low: DVec2,
    pub(super) high: DVec2,
    /// Whether it is one closed edge, whose two loops are alike.
    pub(super) is_circle: bool,
}

/// All loops and parts.
pub(super) struct Shapes {
    pub(super) loops: Vec<Outline>,
    pub(super) parts: Vec<Part>,
    /// Axes towards the viewer: three of a frame, or one, and those of oblique circles.
    pub(super) axes: Vec<DVec3>,
    /// Number of axes that are the drawing's own.
    own: usize,
    /// What was drawn how; depths here are [levels](Camera::level).
    pub(super) camera: Camera,
    /// Size of the drawing.
    pub(super) size: f64,
    /// Standard error of drawn coordinates.
    pub(super) error: f64,
}

impl Shapes {
    pub(super) fn new(drawing: &Drawing, graph: &Graph, pieces: &Pieces, faces: &[Face]) -> Self {
        let depths = edge_depths(drawing, pieces, faces);
        let loops: Vec<Outline> = faces
            .iter()
            .enumerate()
            .map(|(i, face)| outline(drawing, graph, pieces, &depths, i, face))
            .collect();
        let mut parts: Vec<Part> = (0..graph.component_count())
            .map(|_| Part {
                loops: Vec::new(),
                samples: Vec::new(),
                low: DVec2::INFINITY,
                high: DVec2::NEG_INFINITY,
                is_circle: false,
            })
            .collect();
        for (i, outline) in loops.iter().enumerate() {
            let part = &mut parts[outline.part];
            part.loops.push(i);
            part.low = part.low.min(outline.low);
            part.high = part.high.max(outline.high);
        }
        let mut edges = vec![0; parts.len()];
        for (e, edge) in drawing.edges.iter().enumerate() {
            let p = graph.component(edge.v[0]);
            edges[p] += 1;
            let last = edge.points.len() - 1;
            // The same places from either end.
            let places = [0.0, 0.27, 0.5, 0.73, 1.0];
            let picks = if edge.is_straight() {
                let (a, b) = (edge.points[0], edge.points[last]);
                let [y, z] = edge.v.map(|v| pieces.height(v));
                let level = |t: f64| pieces.camera.level(y + (z - y) * t);
                places.map(|t| a.lerp(b, t).extend(level(t)))
            } else {
                let nearest = places.map(|t| (last as f64 * t).round() as usize);
                nearest.map(|k| edge.points[k].extend(depths[e][k]))
            };
            parts[p].samples.extend(picks);
        }
        for (part, edges) in parts.iter_mut().zip(edges) {
            part.is_circle = edges == 1;
        }
        Self {
            loops,
            parts,
            axes: pieces.axes.clone(),
            own: pieces.axes.len(),
            camera: pieces.camera,
            size: drawing.size(),
            error: pieces.precision,
        }
    }

    /// The three axes of the drawing's frame, if it has one.
    pub(super) fn frame(&self) -> Option<&[DVec3; 3]> {
        self.axes[..self.own].try_into().ok()
    }

    /// The part that is drawn largest.
    pub(super) fn main_part(&self) -> Option<usize> {
        let extent = |p: usize| (self.parts[p].high - self.parts[p].low).length();
        (0..self.parts.len()).max_by(|&a, &b| {
            let bulky = |p: usize| !self.parts[p].is_circle;
            bulky(a)
                .cmp(&bulky(b))
                .then(extent(a).total_cmp(&extent(b)))
        })
    }

    /// Whether of two loops one is drawn inside the other, by a point of each.
    pub(super) fn nested(&self, i: usize, j: usize) -> bool {
        let (a, b) = (&self.loops[i], &self.loops[j]);
        let first = |x: &Outline, y: &Outline| {
            let p = y.polygon.get(y.polygon.len() / 2);
            p.is_some_and(|p| x.contains(*p))
        };
        first(a, b) || first(b, a)
    }

    /// Volume that a part's loops enclose, each closed by a surface of its own; positive if they
    /// are counter-clockwise seen from outside.
    pub(super) fn volume(&self, part: usize) -> f64 {
        let loops = &self.parts[part].loops;
        loops.iter().map(|&i| self.loops[i].below()).sum()
    }
}

impl Outline {
    /// Depth of the loop's surface at a drawn point inside it, in its part; for a curved one
    /// between its boundary on either side.
    pub(super) fn depth(&self, p: DVec2) -> f64 {
        if let Some(plane) = self.plane {
            return plane.level(p);
        }
        // Distance and depth of the nearest boundary point on either side, along a ruling if the
        // surface has them: between these the depth is linear.
        let ruling = self.ruling.unwrap_or(DVec2::X);
        let across = |q: DVec2| ruling.perp_dot(q - p);
        let mut sides: [Option<(f64, f64)>; 2] = [None; 2];
        let n = self.polygon.len();
        for i in 0..n {
            let k = (i + 1) % n;
            let (a, b) = (self.polygon[i], self.polygon[k]);
            let (s, e) = (across(a), across(b));
            if (s > 0.0) == (e > 0.0) {
                continue;
            }
            let t = s / (s - e);
            let (x, z) = (
                (a.lerp(b, t) - p).dot(ruling),
                self.depths[i] + t * (self.depths[k] - self.depths[i]),
            );
            let side = &mut sides[usize::from(x >= 0.0)];
            if side.is_none_or(|s| x.abs() < s.0) {
                *side = Some((x.abs(), z));
            }
        }
        match sides {
            [Some((d, y)), Some((e, z))] if d + e > 0.0 => (y * e + z * d) / (d + e),
            [Some((_, z)), _] | [_, Some((_, z))] => z,
            _ => self.depths.iter().sum::<f64>() / n.max(1) as f64,
        }
    }

    /// Points of its boundary, with depth in its part.
    pub(super) fn boundary(&self) -> impl Iterator<Item = (DVec2, f64)> + '_ {
        self.polygon
            .iter()
            .copied()
            .zip(self.depths.iter().copied())
    }

    /// Whether a drawn point is inside.
    pub(super) fn contains(&self, p: DVec2) -> bool {
        p.cmpge(self.low).all() && p.cmple(self.high).all() && polygon::contains(&self.polygon, p)
    }

    /// Mean depth of a fan of triangles over the loop times its signed area.
    fn below(&self) -> f64 {
        let n = self.polygon.len();
        let Some(&o) = self.polygon.first() else {
            return 0.0;
        };
        (1..n.saturating_sub(1))
            .map(|i| {
                let area = (self.polygon[i] - o).perp_dot(self.polygon[i + 1] - o) / 2.0;
                area * (self.depths[0] + self.depths[i] + self.depths[i + 1]) / 3.0
            })
            .sum()
    }
}

/// Depths of the points of every edge: on a circle's plane, on a neighbouring plane, else between
/// the ends.
fn edge_depths(drawing: &Drawing, pieces: &Pieces, faces: &[Face]) -> Vec<Vec<f64>> {
    let mut plane_of = vec![None; drawing.edges.len()];
    for (i, face) in faces.iter().enumerate() {
        let plane = (face.kind == SurfaceKind::Plane)
            .then(|| pieces.plane(i))
            .flatten();
        for c in face.loops.iter().flatten() {
            if plane.is_some() {
                plane_of[c.edge()] = plane;
            }
        }
    }
    let mut all = Vec::with_capacity(drawing.edges.len());
    for (e, edge) in drawing.edges.iter().enumerate() {
        let [y, z] = edge.v.map(|v| pieces.height(v));
        let camera = pieces.camera;
        let n = (edge.points.len() - 1) as f64;
        let start = edge.points[0];
        let depth = |(k, p): (usize, &DVec2)| {
            let between = camera.level(y + (z - y) * k as f64 / n);
            if edge.is_straight() {
                return between;
            }
            if let Some((axis, _)) = pieces.circle(e) {
                let across = camera.across(pieces.axes[axis], start, *p);
                return camera.level((across.from * y + across.rise) / across.to);
            }
            match plane_of[e] {
                Some(t) => camera.level(y) + t.level(*p) - t.level(start),
                None => between,
            }
        };
        all.push(edge.points.iter().enumerate().map(depth).collect());
    }
    all
}

fn outline(
    drawing: &Drawing,
    graph: &Graph,
    pieces: &Pieces,
    edge_depths: &[Vec<f64>],
    index: usize,
    face: &Face,
) -> Outline {
    let mut polygon = Vec::new();
    let mut depths = Vec::new();
    let mut part = 0;
    let mut vertices = Vec::new();
    let mut corners = Vec::new();
    let mut longest = DVec2::ZERO;
    for c in face.loops.iter().flatten() {
        let v = graph.origin(*c);
        part = graph.component(v);
        vertices.push(v);
        corners.push((drawing.vertices[v], pieces.camera.level(pieces.height(v))));
        let points = &drawing.edges[c.edge()].points;
        let chord = points[points.len() - 1] - points[0];
        if drawing.edges[c.edge()].is_straight() && chord.length() > longest.length() {
            longest = chord;
        }
        let n = points.len() - 1;
        for k in 0..n {
            let k = if c.is_reversed() { n - k } else { k };
            polygon.push(points[k]);
            depths.push(edge_depths[c.edge()][k]);
        }
    }
    let (low, high) = polygon
        .iter()
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| {
            (l.min(*p), h.max(*p))
        });
    // A closed edge that shares no vertex and is no circle is the outline of a curved surface.
    let fold = match face.loops.concat().as_slice() {
        [only] => {
            pieces.circle(only.edge()).is_none()
                && matches!(drawing.edges[only.edge()].curve, Curve2::Polyline)
        }
        _ => false,
    };
    let curved = face.kind != SurfaceKind::Plane || fold;
    let ring = is_ring(drawing, pieces, face);
    let plane = match curved {
        // What looks like the end of a cone may be in a plane.
        true if ring => ring_plane(drawing, pieces, face),
        true => None,
        false => pieces.plane(index),
    };
    let area = polygon::signed_area(&polygon);
    let turn = pieces.precision * (high - low).length() / area.abs().max(f64::MIN_POSITIVE);
    let plane = plane.map(|p| squared(p, pieces, turn, (low + high) / 2.0));
    let mut outline = Outline {
        part,
        vertices,
        area,
        polygon,
        depths,
        low,
        high,
        plane,
        turn,
        curved,
        kind: face.kind,
        fold,
        ring,
        ruling: (curved && longest != DVec2::ZERO).then(|| longest.normalize()),
        corners,
        line: None,
    };
    if outline.ring || outline.curved {
        // A face of revolution goes around its axis.
        outline.line = axis_line(drawing, pieces, face).filter(|l| outline.contains(l.at));
    }
    outline
}
