//! What is known of the boundary of a face, or of the parts of one surface.

use glam::{DVec2, DVec3};

use super::flat::best_plane;
use super::ring::Ring;
use super::wholes;
use crate::drawing::{Curve2, SurfaceKind};
use crate::lift::heights::Heights;
use crate::lift::sheet::Sheet;
use crate::lift::{Camera, Surface};

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

/// A line of sight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sight {
    pub(super) from: DVec3,
    /// Unit.
    pub(super) direction: DVec3,
}

impl Sight {
    /// The line of all points drawn at `p`.
    pub(super) fn new(camera: &Camera, p: DVec2) -> Self {
        let (from, ray) = camera.ray(p);
        Self {
            from,
            direction: ray.normalize(),
        }
    }

    /// Distance of a point from the line.
    pub(super) fn distance(&self, p: DVec3) -> f64 {
        (p - self.from)
            .reject_from_normalized(self.direction)
            .length()
    }

    /// Distance from an axis, a line through `origin`.
    pub(super) fn apart(&self, origin: DVec3, axis: DVec3) -> f64 {
        let between = (self.from - origin).reject_from_normalized(axis);
        let across = self.direction.reject_from_normalized(axis);
        if across.length() < 1e-9 {
            return between.length();
        }
        between.reject_from(across).length()
    }

    /// Distance from a cone where it is least, negative if the line enters it; infinite if it comes
    /// ever nearer, as steep lines do.
    pub(super) fn cone_gap(&self, apex: DVec3, axis: DVec3, angle: f64) -> f64 {
        let (sin, cos) = angle.sin_cos();
        let climb = self.direction.dot(axis);
        let across = 1.0 - climb * climb;
        // With s from the point nearest to the axis, rho² = apart² + across s²; the distance
        // rho cos - height sin is least where rho grows by the slope per s.
        let slope = climb * sin / cos;
        let rest = across - slope * slope;
        if rest <= 0.0 {
            return f64::INFINITY;
        }
        let apart = self.apart(apex, axis);
        let s = slope * apart / (across * rest).sqrt();
        let from = self.from - apex;
        let nearest = -(from - axis * from.dot(axis)).dot(self.direction) / across;
        let height = from.dot(axis) + climb * (nearest + s);
        (apart * apart + across * s * s).sqrt() * cos - height * sin
    }
}

/// What is known of the boundary of a surface.
#[derive(Debug, Clone)]
pub(super) struct Evidence {
    /// Vertices of the surface.
    pub(super) vertices: Vec<DVec3>,
    pub(super) bounds: Vec<Bound>,
    /// Lines of sight to the drawn points of the outlines: they touch the surface.
    pub(super) outlines: Vec<Sight>,
    /// Whether some outline is bent, as none of a cylinder or cone is.
    pub(super) bent: bool,
    /// Vertices on outlines, where the surface is seen edge-on, with their lines of sight.
    pub(super) outline_ends: Vec<(DVec3, Sight)>,
    /// Circles that outlines are drawn as, centre and radius: of a sphere in a parallel projection.
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
            bent: false,
            outline_ends: Vec::new(),
            discs: Vec::new(),
            directions: sheet.directions.axes.iter().map(|a| a.direction).collect(),
            size: sheet.size,
        };
        let outside = |e: usize| sheet.neighbours(e).iter().find(|f| !part.contains(f));
        // Of a surface of no kind seams part some faces and outlines others, if any is told to be one.
        let may_have_seams = wholes::kind(sheet, part) == SurfaceKind::Other
            && sheet.camera().is_parallel()
            && edges
                .iter()
                .any(|&e| outside(e).is_none() && wholes::is_fold(sheet, e));
        for e in edges {
            match outside(e) {
                None if may_have_seams && !wholes::is_fold(sheet, e) => {}
                // Between two parts: an outline.
                None => evidence.add_outline(sheet, heights, e),
                // The other part is not taken for one.
                Some(&beside) if wholes::is_outline(sheet, e, [part[0], beside]) => {
                    evidence.add_outline(sheet, heights, e);
                }
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
        let sight = |p: DVec2| Sight::new(sheet.camera(), p);
        self.bent |= !sheet.is_straight(edge);
        self.outlines
            .extend(thinned(&e.points).map(|i| sight(e.points[i])));
        let ends = e.v.into_iter().filter(|&v| heights.known[v]);
        let end = |v: usize| (vertex(sheet, heights, v), sight(sheet.drawing.vertices[v]));
        self.outline_ends.extend(ends.map(end));
        if let (Curve2::Ellipse(arc), true) = (&e.curve, sheet.camera().is_parallel()) {
            self.discs.push((arc.center, arc.major.length()));
        }
    }

    /// All known points of the surface.
    pub(super) fn points(&self) -> impl Iterator<Item = DVec3> + '_ {
        let bounds = self.bounds.iter().flat_map(|b| b.points.iter().copied());
        self.vertices.iter().copied().chain(bounds)
    }

    /// Whether one circle at most is known, which is on surfaces of all kinds.
    pub(super) fn is_one_circle(&self) -> bool {
        let rings = self.rings().count();
        rings == self.bounds.len() && rings + self.outlines.len() < 2
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
    let planar = |normal: DVec3| {
        let place = |p: &DVec2| sheet.camera().on_plane(*p, normal, ends[0]);
        let points: Vec<DVec3> = drawn.iter().map(place).collect();
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
    let sight = Sight::new(sheet.camera(), sheet.drawing.vertices[e.v[0]]);
    match beside {
        Surface::Plane { normal, .. } if normal.dot(sight.direction).abs() > 0.02 => {
            Some(planar(normal))
        }
        Surface::Plane { .. } => None,
        Surface::Unknown => free_circle(sheet, edge, ends).map(planar),
        _ => {
            if let Some(normal) = free_circle(sheet, edge, ends) {
                return Some(planar(normal));
            }
            let points = on_surface(sheet.camera(), &beside, &drawn, ends)?;
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

/// Normal of the circle that an edge is drawn as in a parallel projection, if the depths of its ends
/// tell which of the two.
fn free_circle(sheet: &Sheet<'_>, edge: usize, ends: [DVec3; 2]) -> Option<DVec3> {
    /// Relative uncertainty of the axes up to which an ellipse tells its plane.
    const UNCERTAIN: f64 = 2e-3;
    let Curve2::Ellipse(arc) = &sheet.drawing.edges[edge].curve else {
        return None;
    };
    let chord = ends[1] - ends[0];
    let unclear = arc.uncertainty > UNCERTAIN || arc.ratio > 0.999;
    if unclear || chord.length() < 1e-3 * sheet.size || !sheet.camera().is_parallel() {
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
fn on_surface(
    camera: &Camera,
    surface: &Surface,
    drawn: &[DVec2],
    ends: [DVec3; 2],
) -> Option<Vec<DVec3>> {
    let along = |p: DVec2, end: DVec3| {
        let (from, ray) = camera.ray(p);
        (end - from).dot(ray) / ray.length_squared()
    };
    let mut points = vec![ends[0]];
    let mut places = vec![along(drawn[0], ends[0])];
    for p in &drawn[1..drawn.len() - 1] {
        let expected = match places[..] {
            [.., a, b] => 2.0 * b - a,
            _ => places[0],
        };
        let (from, ray) = camera.ray(*p);
        let t = *surface.crossings_from(from, ray, expected).first()?;
        points.push(from + ray * t);
        places.push(t);
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
