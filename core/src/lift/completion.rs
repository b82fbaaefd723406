//! Loose parts of a drawing, tied by the surfaces that the other depths fix.
//!
//! A vertex on a known cylinder, cone, sphere or torus lies where its line of sight meets the
//! surface: at two depths or four, of which the vertices of one loose part agree on one in a
//! parallel projection. A vertex
//! of outlines lies where its line of sight touches the surface, or at the tip of a cone.

use glam::{DVec2, DVec3};

use super::Surface;
use super::fillets;
use super::heights::Heights;
use super::ring_torus::touches;
use super::sheet::Sheet;
use super::surfaces::surfaces_of;

/// Shifts of a part that differ by less than this share of the drawing's size agree.
const AGREE: f64 = 1e-4;

/// A line of sight at a smaller angle to the surface (its sine) does not tell the depth.
const GRAZING: f64 = 0.02;

/// A line of sight that passes a surface by less than this share of the drawing's size touches it.
const TOUCHES: f64 = 1e-3;

/// A crossing goes on from the one before it if it is that many times as near to it as any other.
const CLEARLY: f64 = 3.0;

/// A height that a surface gives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tie {
    pub(super) vertex: usize,
    pub(super) height: f64,
    /// Expected error.
    pub(super) error: f64,
    /// The face whose surface it is.
    pub(super) face: usize,
}

/// Ties for those of the loose groups that known surfaces place. With `any_kind` also by surfaces of
/// other kinds than was said, which what is known of a boundary so far may fit by chance.
pub(super) fn ties(
    sheet: &Sheet<'_>,
    heights: &Heights,
    groups: &[Vec<usize>],
    any_kind: bool,
) -> Vec<Tie> {
    // Only faces of loose vertices can tie them, and what is beside these faces may tell their
    // surface.
    let mut near = vec![false; sheet.faces.len()];
    for (face, corners) in sheet.corners.iter().enumerate() {
        if !heights.are_known(corners) {
            near[face] = true;
            let beside = sheet.edges_of(face).iter();
            beside
                .flat_map(|&e| sheet.neighbours(e))
                .for_each(|&f| near[f] = true);
        }
    }
    let mut surfaces = surfaces_of(sheet, heights, any_kind, |face| near[face]);
    fillets::fill(sheet, heights, &mut surfaces);
    groups
        .iter()
        .filter_map(|group| tie(sheet, heights, &surfaces, group))
        .collect()
}

/// A shift of a whole group in depth that one of its vertices asks for.
struct Shift {
    by: f64,
    tie: Tie,
}

fn tie(sheet: &Sheet<'_>, heights: &Heights, surfaces: &[Surface], group: &[usize]) -> Option<Tie> {
    let mut asked: Vec<Vec<Shift>> = Vec::new();
    for &vertex in group {
        for (face, surface) in surfaces.iter().enumerate() {
            let round = !matches!(surface, Surface::Plane { .. } | Surface::Unknown);
            if round && sheet.corners[face].binary_search(&vertex).is_ok() {
                let found = heights_on(sheet, heights, surface, vertex, face);
                let shift = |tie: Tie| Shift {
                    by: tie.height - heights.of(vertex),
                    tie,
                };
                asked.push(found.into_iter().map(shift).collect());
            }
        }
    }
    // The shift that most of them agree on; with one vertex, one that is the only one.
    let near = AGREE * sheet.size;
    let support = |by: f64| {
        let fits = |list: &&Vec<Shift>| list.iter().any(|s| (s.by - by).abs() < near + s.tie.error);
        asked.iter().filter(fits).count()
    };
    let all: Vec<&Shift> = asked.iter().flatten().collect();
    let best = all.iter().max_by(|a, b| {
        let (s, t) = (support(a.by), support(b.by));
        s.cmp(&t).then(b.tie.error.total_cmp(&a.tie.error))
    })?;
    let most = support(best.by);
    let rival = all
        .iter()
        .any(|s| (s.by - best.by).abs() > 2.0 * near + s.tie.error && support(s.by) == most);
    (!rival).then_some(best.tie)
}

/// Heights at which a vertex may lie on a surface.
fn heights_on(
    sheet: &Sheet<'_>,
    heights: &Heights,
    surface: &Surface,
    vertex: usize,
    face: usize,
) -> Vec<Tie> {
    let (from, ray) = sheet.camera().ray(sheet.drawing.vertices[vertex]);
    let precision = sheet.directions.precision;
    let kind = sheet.faces[face].kind;
    // Edges between two parts of the surface: its outlines.
    let inside = |e: &usize| {
        let faces = sheet.neighbours(*e);
        faces.len() == 2
            && faces.contains(&face)
            && faces.iter().all(|&f| sheet.faces[f].kind == kind)
            && sheet.circles[*e].is_none()
    };
    let tie = |t: f64, error: f64| Tie {
        vertex,
        height: sheet.camera().height((from + ray * t).z),
        error,
        face,
    };
    let outlines = sheet.edges_at(vertex).iter().filter(|e| inside(e)).count();
    if outlines > 0 {
        let touching = touching(surface, from, ray, TOUCHES * sheet.size);
        let known = touching.map(|t| tie(t, 10.0 * precision));
        // Where nothing else meets, no line of sight crosses the surface.
        if known.is_some() || outlines == sheet.edges_at(vertex).len() {
            return known.into_iter().collect();
        }
    }
    let side = side(sheet, heights, surface, face);
    let slope = |t: f64| surface.gradient(from + ray * t).dot(ray.normalize());
    let mut crossings = surface.crossings(from, ray);
    crossings.retain(|&t| slope(t).abs() > GRAZING);
    let seen = |t: &f64| side.is_none_or(|s| s == slope(*t).signum());
    let mut found: Vec<f64> = crossings.iter().copied().filter(seen).collect();
    if found.len() > 1
        && let Some(end) = followed(sheet, heights, surface, vertex, face)
    {
        let nearest = |a: &f64, b: &f64| (a - end).abs().total_cmp(&(b - end).abs());
        found = crossings.into_iter().min_by(nearest).into_iter().collect();
    }
    let ties = found.into_iter();
    ties.map(|t| tie(t, 4.0 * precision / slope(t).abs()))
        .collect()
}

/// Where the line of sight of a vertex meets a surface if an edge of its face leads there from a known
/// vertex: along the edge the crossing moves without a jump.
fn followed(
    sheet: &Sheet<'_>,
    heights: &Heights,
    surface: &Surface,
    vertex: usize,
    face: usize,
) -> Option<f64> {
    let own = sheet.edges_of(face);
    let edges = sheet.edges_at(vertex).iter();
    let mut edges = edges.filter(|e| own.binary_search(e).is_ok());
    edges.find_map(|&e| {
        let edge = &sheet.drawing.edges[e];
        let mut points = edge.points.clone();
        let start = match edge.v {
            [u, v] if v == vertex => u,
            [_, u] => {
                points.reverse();
                u
            }
        };
        let place = sheet.place(*points.first()?, heights.of(start));
        heights.known[start]
            .then(|| along(sheet, surface, &points, place))
            .flatten()
    })
}

/// Where the last of drawn points meets a surface if all of them are on one curve there, from a place on.
fn along(sheet: &Sheet<'_>, surface: &Surface, points: &[DVec2], start: DVec3) -> Option<f64> {
    let (&first, others) = points.split_first()?;
    let (from, ray) = sheet.camera().ray(first);
    let mut at = (start - from).dot(ray) / ray.length_squared();
    let (mut rate, mut last) = (0.0, first);
    for &p in others {
        let step = p.distance(last);
        let ahead = at + rate * step;
        let (from, ray) = sheet.camera().ray(p);
        let crossings = surface.crossings_from(from, ray, ahead);
        let (&next, rival) = (crossings.first()?, crossings.get(1));
        if rival.is_some_and(|r| (r - ahead).abs() < CLEARLY * (next - ahead).abs()) {
            return None;
        }
        if step > 0.0 {
            rate = (next - at) / step;
        }
        (at, last) = (next, p);
    }
    Some(at)
}

/// Where a line of sight touches a surface, or ends at the tip of a cone, if it does within a distance.
fn touching(surface: &Surface, from: DVec3, ray: DVec3, tolerance: f64) -> Option<f64> {
    let nearest = |p: DVec3| (p - from).dot(ray) / ray.length_squared();
    match *surface {
        Surface::Sphere { center, radius } => {
            let t = nearest(center);
            let off = (from + ray * t).distance(center) - radius;
            (off.abs() < tolerance).then_some(t)
        }
        Surface::Cylinder {
            origin,
            axis,
            radius,
        } => {
            let across = ray.reject_from_normalized(axis);
            let t = (origin - from).dot(across) / across.length_squared();
            let off = (from + ray * t - origin)
                .reject_from_normalized(axis)
                .length()
                - radius;
            (off.abs() < tolerance).then_some(t)
        }
        Surface::Cone { apex, .. } => {
            let t = nearest(apex);
            let tip = (from + ray * t).distance(apex) < tolerance;
            let double = || match surface.crossings(from, ray)[..] {
                [s, t] => Some(f64::midpoint(s, t)),
                _ => None,
            };
            let t = if tip { Some(t) } else { double() };
            t.filter(|&t| surface.distance(from + ray * t).abs() < tolerance)
        }
        Surface::Torus { .. } => touches(surface, from, ray, tolerance).pop(),
        Surface::Plane { .. } | Surface::Unknown => None,
    }
}

/// The sign of a surface's gradient along the lines of sight at the known vertices of a face, and in
/// the middle of its known circles; a face is seen from one side.
fn side(sheet: &Sheet<'_>, heights: &Heights, surface: &Surface, face: usize) -> Option<f64> {
    let place = |v: usize| sheet.place(sheet.drawing.vertices[v], heights.of(v));
    let corners = sheet.corners[face].iter().filter(|&&v| heights.known[v]);
    let corners = corners.map(|&v| (sheet.drawing.vertices[v], place(v)));
    let middles = sheet.edges_of(face).iter().filter_map(|&e| {
        let (k, _) = sheet.circles[e]?;
        let edge = &sheet.drawing.edges[e];
        let middle = *edge.points.get(edge.points.len() / 2)?;
        let on_circle = |start| sheet.camera().on_plane(middle, sheet.axis(k), start);
        heights.known[edge.v[0]].then(|| (middle, on_circle(place(edge.v[0]))))
    });
    let slopes = corners.chain(middles).map(|(drawn, p)| {
        let (_, ray) = sheet.camera().ray(drawn);
        surface.gradient(p).dot(ray.normalize())
    });
    let clear: Vec<f64> = slopes
        .filter(|s| s.abs() > GRAZING)
        .map(f64::signum)
        .collect();
    let first = *clear.first()?;
    clear.iter().all(|s| *s == first).then_some(first)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{CoEdge, Drawing, Edge, SurfaceKind};
    use crate::identify::{Evidence, Face};
    use crate::lift::Camera;
    use crate::lift::directions::Directions;

    /// An edge around a torus that is seen from its side, so that lines of sight cross it four times.
    #[test]
    fn an_edge_from_a_known_vertex_tells_where_it_leads() {
        let torus = Surface::Torus {
            center: DVec3::ZERO,
            axis: DVec3::Y,
            major: 0.4,
            minor: 0.1,
        };
        for far in [1.0, -1.0] {
            let at = |i: i32| {
                let (turn, tube) = (1.1 + 0.04 * f64::from(i), 0.3f64);
                let out = 0.4 + 0.1 * tube.cos();
                DVec3::new(out * turn.cos(), 0.1 * tube.sin(), far * out * turn.sin())
            };
            let points: Vec<DVec3> = (0..=16).map(at).collect();
            let drawn = points.iter().map(|p| p.truncate());
            let vertices = [0, 16].map(|i: usize| points[i].truncate());
            let edge = Edge::drawn([0, 1], drawn.collect());
            let drawing = Drawing::orthographic(vertices.to_vec(), vec![edge]);
            let faces = [Face {
                kind: SurfaceKind::Torus,
                loops: vec![vec![CoEdge::new(0, false)]],
                confidence: 1.0,
                evidence: Evidence::default(),
            }];
            let directions = Directions {
                axes: Vec::new(),
                slanted: Vec::new(),
                swept: Vec::new(),
                camera: Camera::Parallel,
                error: 1e-6,
                precision: 1e-6,
            };
            let sheet = Sheet::new(&drawing, &faces, &directions);
            let heights = |start: bool| Heights {
                vertices: vec![points[0].z, 0.0],
                planes: vec![None],
                known: vec![start, false],
            };
            let found = |start| heights_on(&sheet, &heights(start), &torus, 1, 0);
            assert_eq!(found(false).len(), 4);
            let [only] = found(true)[..] else {
                panic!("{:?}", found(true));
            };
            assert!((only.height - points[16].z).abs() < 1e-6, "{only:?}");
        }
    }

    /// Lines of sight along z that graze surfaces beside the origin.
    #[test]
    fn lines_of_sight_touch_surfaces_where_they_graze_them() {
        let center = DVec3::new(0.0, 0.0, 4.0);
        let cylinder = Surface::Cylinder {
            origin: center + DVec3::Y * 7.0,
            axis: DVec3::Y,
            radius: 0.5,
        };
        let sphere = Surface::Sphere {
            center,
            radius: 0.5,
        };
        let torus = Surface::Torus {
            center,
            axis: DVec3::Y,
            major: 0.4,
            minor: 0.1,
        };
        for surface in [cylinder, sphere, torus] {
            let at = |x: f64| touching(&surface, DVec3::X * x, DVec3::Z * 2.0, 1e-3);
            let t = at(0.5).unwrap_or_else(|| panic!("{surface:?}"));
            assert!((t - 2.0).abs() < 1e-6, "{surface:?} {t}");
            assert_eq!(at(0.45), None, "{surface:?}");
        }
        let cone = Surface::Cone {
            apex: center,
            axis: DVec3::Y,
            angle: 0.4,
        };
        let tip = touching(&cone, DVec3::ZERO, DVec3::Z, 1e-3);
        assert!(tip.is_some_and(|t| (t - 4.0).abs() < 1e-9), "{tip:?}");
        // At the height h the cone is h tan(0.4) wide.
        let side = DVec3::new(2.0 * 0.4f64.tan(), 2.0, 0.0);
        let found = touching(&cone, side, DVec3::Z, 1e-3);
        assert!(found.is_some_and(|t| (t - 4.0).abs() < 1e-3), "{found:?}");
        assert_eq!(touching(&cone, side * 1.1 + DVec3::Y, DVec3::X, 1e-3), None);
    }
}
