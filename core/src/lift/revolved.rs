//! Rows from surfaces of revolution: what lies on one axis, and what lies on one cylinder.
//!
//! They are among the assumed rows: a centre that is drawn on a circle's axis is taken to be there.

use glam::DVec2;

use super::Surface;
use super::assumed::Depth;
use super::camera::Relation;
use super::circle::{DrawnCircle, circle_through};
use super::directions::AGREE;
use super::rows::{Tag, Unknowns};
use super::sheet::Sheet;
use super::surfaces::touching;
use super::system::System;
use crate::drawing::{Curve2, SurfaceKind};

/// Ratio of the axes from which an ellipse is a sphere's outline.
const OUTLINE: f64 = 1.0 - 1e-5;

/// A point of an axis, and how well it is drawn.
pub(super) struct Center {
    pub(super) at: DVec2,
    pub(super) depth: Depth,
    pub(super) error: f64,
}

/// Centres, tips and rings of vertices of one surface of revolution lie on its axis.
pub(super) fn on_one_axis(sheet: &Sheet<'_>, _: &Unknowns, system: &mut System<Tag>) {
    for whole in touching(sheet) {
        let mut edges: Vec<usize> = whole
            .iter()
            .flat_map(|&f| sheet.edges_of(f))
            .copied()
            .collect();
        edges.sort_unstable();
        edges.dedup();
        for k in 0..sheet.normals() {
            let mut centers = circles(sheet, &edges, k);
            let tips = tips(sheet, &edges);
            // The tip of a drill may be all that lies on the axis.
            if centers.is_empty() && tips.is_empty() {
                continue;
            }
            let ring = ring(sheet, &edges, k, whole[0], system);
            if centers.is_empty() && ring.is_none() {
                continue;
            }
            if centers.is_empty() {
                centers.extend(ring);
                centers.extend(tips);
            } else {
                centers.extend(tips);
                centers.extend(outlines(sheet, whole[0], &edges));
                centers.extend(ring);
            }
            link(sheet, &centers, k, Tag::Revolved { face: whole[0] }, system);
        }
        bends(sheet, &edges, whole[0], system);
        half_bends(sheet, &edges, whole[0], system);
    }
}

pub(super) fn center_of(
    sheet: &Sheet<'_>,
    vertex: usize,
    k: usize,
    circle: &DrawnCircle,
) -> Center {
    let n = sheet.axis(k);
    let facing = sheet.camera().facing(n, circle.center);
    Center {
        at: circle.center,
        depth: Depth::across(sheet, vertex, n, circle.center),
        error: (sheet.directions.precision * circle.gain + sheet.directions.error * circle.radius)
            / (facing * facing),
    }
}

fn circles(sheet: &Sheet<'_>, edges: &[usize], k: usize) -> Vec<Center> {
    let around = edges.iter().filter_map(|&e| {
        let (axis, circle) = sheet.circles[e].as_ref()?;
        (*axis == k).then(|| center_of(sheet, sheet.drawing.edges[e].v[0], k, circle))
    });
    around.collect()
}

/// Vertices where straight edges of the surface itself meet: tips of cones.
fn tips(sheet: &Sheet<'_>, edges: &[usize]) -> Vec<Center> {
    let own = |&e: &&usize| {
        sheet.is_straight(*e) && sheet.neighbours(*e).iter().all(|&f| !sheet.is_planar(f))
    };
    let ends = edges
        .iter()
        .filter(own)
        .flat_map(|&e| sheet.drawing.edges[e].v);
    let mut ends: Vec<usize> = ends.collect();
    ends.sort_unstable();
    let mut met: Vec<usize> = ends
        .windows(2)
        .filter(|w| w[0] == w[1])
        .map(|w| w[0])
        .collect();
    met.dedup();
    let tip = |v: usize| Center {
        at: sheet.drawing.vertices[v],
        depth: Depth {
            terms: vec![(v, 1.0)],
            shift: 0.0,
        },
        error: sheet.directions.precision,
    };
    met.into_iter().map(tip).collect()
}

/// The outline of a sphere is a circle around its centre, at its centre's depth.
fn outlines(sheet: &Sheet<'_>, face: usize, edges: &[usize]) -> Vec<Center> {
    // In a central projection it is neither.
    let is_sphere = sheet.camera().is_parallel()
        && matches!(
            sheet.faces[face].kind,
            SurfaceKind::Sphere | SurfaceKind::Other
        );
    let outline = |&e: &usize| match sheet.drawing.edges[e].curve {
        Curve2::Ellipse(arc) if is_sphere && arc.ratio > OUTLINE && arc.uncertainty < 1e-3 => {
            let v = sheet.drawing.edges[e].v[0];
            Some(Center {
                at: arc.center,
                depth: Depth {
                    terms: vec![(v, 1.0)],
                    shift: 0.0,
                },
                error: sheet.directions.precision + arc.uncertainty * arc.major.length(),
            })
        }
        _ => None,
    };
    edges.iter().filter_map(outline).collect()
}

/// Ends of edges along the axis, where walls of a prism are cut by the surface: if they are drawn
/// on one circle around the axis, they are at one height. Outlines are no walls: by symmetry the four
/// ends of a cylinder's are always on a circle.
fn ring(
    sheet: &Sheet<'_>,
    edges: &[usize],
    k: usize,
    face: usize,
    system: &mut System<Tag>,
) -> Option<Center> {
    let open = |&&e: &&usize| !sheet.is_straight(e) && sheet.circles[e].is_none();
    let is_wall = |e: &usize| {
        sheet.edge_axis[*e] == Some(k)
            && edges.binary_search(e).is_err()
            && sheet.neighbours(*e).iter().any(|&f| sheet.is_planar(f))
    };
    let ends = edges
        .iter()
        .filter(open)
        .flat_map(|&e| sheet.drawing.edges[e].v);
    let mut ends: Vec<usize> = ends
        .filter(|&v| sheet.edges_at(v).iter().any(is_wall))
        .collect();
    ends.sort_unstable();
    ends.dedup();
    let n = sheet.axis(k);
    let points: Vec<DVec2> = ends.iter().map(|&v| sheet.drawing.vertices[v]).collect();
    let circle = circle_through(&points, n, sheet.camera())?;
    let facing = sheet.camera().facing(n, circle.center);
    let error =
        (sheet.directions.precision + sheet.directions.error * circle.radius) / (facing * facing);
    if ends.len() < 4 || circle.residual > 3.0 * AGREE * error {
        return None;
    }
    let first = ends[0];
    for (&v, p) in ends.iter().zip(&points).skip(1) {
        let row = sheet.camera().across(n, points[0], *p);
        let weight = (2.0 * error).recip();
        let terms = [(v, row.to), (first, -row.from)];
        system.push(terms, row.rise, weight, Tag::Revolved { face });
    }
    Some(center_of(sheet, first, k, &circle))
}

/// Rows between each centre and the first one that is drawn on the same axis.
pub(super) fn link(
    sheet: &Sheet<'_>,
    centers: &[Center],
    k: usize,
    tag: Tag,
    system: &mut System<Tag>,
) {
    let axis = sheet.axis(k);
    let Some((first, others)) = centers.split_first() else {
        return;
    };
    for other in others {
        let apart = other.at - first.at;
        let drawn = sheet.camera().drawn(axis, first.at.midpoint(other.at));
        let length = drawn.length();
        let error = first.error + other.error;
        let off = apart.perp_dot(drawn).abs() / length;
        if off < AGREE * error + sheet.directions.error * apart.length() / length {
            let error =
                2.0 * error / length + sheet.directions.error * apart.length() / (length * length);
            let row = sheet.camera().along(axis, first.at, other.at);
            first
                .depth
                .relate(&other.depth, row, error.recip(), tag, system);
        }
    }
}

/// A pipe's bend: by symmetry the centre of its one end is as far along the one normal as along the
/// other from the centre of its other end, which the drawing shows.
fn bends(sheet: &Sheet<'_>, edges: &[usize], face: usize, system: &mut System<Tag>) {
    let count = sheet.normals();
    for i in 0..count {
        for j in i + 1..count {
            let (from, to) = (circles(sheet, edges, i), circles(sheet, edges, j));
            let (Some(from), Some(to)) = (from.first(), to.first()) else {
                continue;
            };
            let apart = to.at - from.at;
            let error = from.error + to.error + sheet.directions.error * apart.length();
            let diagonals = [1.0, -1.0].map(|sign| sheet.axis(i) + sheet.axis(j) * sign);
            let aside = diagonals.map(|d| {
                let drawn = sheet.camera().drawn(d, from.at.midpoint(to.at));
                apart.perp_dot(drawn).abs()
            });
            let best = usize::from(aside[1] < aside[0]);
            if aside[best] < AGREE * error && apart.length() > 20.0 * error {
                let along = diagonals[best];
                let row = sheet.camera().along(along, from.at, to.at);
                let drawn = sheet.camera().drawn(along, from.at.midpoint(to.at));
                let weight = drawn.length() / (2.0 * error);
                let tag = Tag::Revolved { face };
                from.depth.relate(&to.depth, row, weight, tag, system);
            }
        }
    }
}

/// A pipe's bend by half a turn: its ends, equal circles beside each other around one direction,
/// lie in one plane.
fn half_bends(sheet: &Sheet<'_>, edges: &[usize], face: usize, system: &mut System<Tag>) {
    if sheet.faces[face].kind != SurfaceKind::Torus {
        return;
    }
    for k in 0..sheet.normals() {
        let rings: Vec<(usize, DrawnCircle)> = edges
            .iter()
            .filter_map(|&e| {
                let (axis, circle) = sheet.circles[e]?;
                (axis == k).then_some((sheet.drawing.edges[e].v[0], circle))
            })
            .collect();
        let Some(&(first, own)) = rings.first() else {
            continue;
        };
        let n = sheet.axis(k);
        for &(v, circle) in &rings[1..] {
            let apart = circle.center - own.center;
            let drawn = sheet.camera().drawn(n, own.center.midpoint(circle.center));
            let aside = apart.perp_dot(drawn.normalize_or_zero()).abs();
            // In a central projection equal circles are drawn the larger the nearer they are.
            let row = sheet.camera().across(n, own.center, circle.center);
            let unequal = (circle.radius * row.to - own.radius * row.from).abs();
            if unequal > 1e-3 * own.radius * row.from.abs() || aside < 0.1 * own.radius {
                continue;
            }
            let (from, to) = (
                center_of(sheet, first, k, &own),
                center_of(sheet, v, k, &circle),
            );
            let weight = (from.error + to.error).recip();
            let tag = Tag::Revolved { face };
            from.depth.relate(&to.depth, row, weight, tag, system);
        }
    }
}

/// The ends of a pipe that are no circles around one axis are equally large: in a central projection
/// their heights are as their radii.
pub(super) fn equal_ends(sheet: &Sheet<'_>, _: &Unknowns, system: &mut System<Tag>) {
    if sheet.camera().is_parallel() {
        return;
    }
    for (face, f) in sheet.faces.iter().enumerate() {
        if !matches!(f.kind, SurfaceKind::Torus | SurfaceKind::Other) {
            continue;
        }
        let rings: Vec<(usize, usize, DrawnCircle)> = sheet
            .edges_of(face)
            .iter()
            .filter_map(|&e| {
                let (k, circle) = sheet.circles[e]?;
                Some((sheet.drawing.edges[e].v[0], k, circle))
            })
            .collect();
        let [(first, k, own), (v, l, other)] = rings[..] else {
            continue;
        };
        let from = center_of(sheet, first, k, &own);
        let to = center_of(sheet, v, l, &other);
        let apart = other.center - own.center;
        let along = sheet
            .camera()
            .drawn(sheet.axis(k), own.center.midpoint(other.center));
        let aside = apart.perp_dot(along.normalize_or_zero()).abs();
        if k == l && aside < 0.1 * own.radius {
            continue;
        }
        let size = (own.radius * other.radius).sqrt();
        let row = Relation {
            to: own.radius / size,
            from: other.radius / size,
            rise: 0.0,
        };
        let precision = sheet.directions.precision * (own.gain + other.gain) / size;
        let error = sheet.camera().height(-sheet.size) * (precision + sheet.directions.error);
        let tag = Tag::Revolved { face };
        from.depth
            .relate(&to.depth, row, error.recip(), tag, system);
    }
}

/// A vertex on a cylinder with a known circle lies at one of two depths, in front of the axis or
/// behind it, as all of the face does.
pub(super) fn on_cylinder(sheet: &Sheet<'_>, _: &Unknowns, system: &mut System<Tag>) {
    for (face, f) in sheet.faces.iter().enumerate() {
        if f.kind != SurfaceKind::Cylinder {
            continue;
        }
        let known = sheet.edges_of(face).iter().find_map(|&e| {
            let (k, circle) = sheet.circles[e].as_ref()?;
            let middle = sheet.drawing.edges[e]
                .points
                .get(sheet.drawing.edges[e].points.len() / 2)?;
            Some((e, *k, *circle, *middle))
        });
        let Some((edge, k, circle, middle)) = known else {
            continue;
        };
        let (n, r) = (sheet.axis(k), circle.radius);
        let center = center_of(sheet, sheet.drawing.edges[edge].v[0], k, &circle);
        // The circle where lengths are drawn as they are, see `circle_through`.
        let cylinder = Surface::Cylinder {
            origin: sheet.camera().unit(center.at),
            axis: n,
            radius: r,
        };
        let crossings = |p: DVec2| {
            let (from, ray) = sheet.camera().ray(p);
            let mut all = cylinder.crossings(from, ray);
            all.sort_by(f64::total_cmp);
            (from, ray, all)
        };
        // Whether the face is at the first crossing or at the second.
        let (from, ray, all) = crossings(middle);
        let own = n.dot(cylinder.origin() - from) / n.dot(ray);
        let second = match all[..] {
            [a, b] => (own - b).abs() < (own - a).abs(),
            _ => continue,
        };
        for &v in &sheet.corners[face] {
            let p = sheet.drawing.vertices[v];
            let (from, ray, all) = crossings(p);
            let Some(&t) = all.get(usize::from(second)) else {
                continue;
            };
            let across = ray.reject_from_normalized(n);
            let gradient = cylinder.gradient(from + ray * t);
            let half = gradient.dot(across.normalize_or_zero()).abs();
            // Near the outline the depth is poorly known.
            if half.is_nan() || half < 0.1 {
                continue;
            }
            let slant = across.length() / ray.length();
            let error = (center.error + 2.0 * sheet.directions.precision) / half / slant
                + sheet.directions.error * p.distance(center.at) / (slant * slant);
            let own = Depth {
                terms: vec![(v, 1.0)],
                shift: 0.0,
            };
            let [from, to] =
                [cylinder.origin(), from + ray * t].map(|p| sheet.camera().height(p.z));
            let row = sheet.camera().apart(from, to);
            let weight = (2.0 * error).recip();
            let tag = Tag::Revolved { face };
            center.depth.relate(&own, row, weight, tag, system);
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::drawing::Drawing;
    use crate::lift::directions::Directions;
    use crate::lift::testing::{Scene, turned};

    /// A shaft of three pieces, of which the middle one is called a cone, in perspective. The ends of
    /// outlines are on a circle by symmetry, and both halves of a circle have one centre: neither says
    /// anything of depth.
    #[test]
    fn outlines_and_halves_of_one_circle_tell_no_depth() {
        let mut scene = Scene::central(turned(0.6, 0.7, 0.1), DVec3::Z * -7.0, DVec2::ZERO, 3.0);
        let mut rings = Vec::new();
        for (z, length) in [(-1.5, 1.0), (-0.5, 0.6), (0.1, 1.0)] {
            let [start, end] = scene.wall(DVec3::Z * z, DVec3::Z * length, 0.5);
            rings.extend([start, end]);
        }
        let (drawing, mut faces) = scene.finish();
        faces[2].kind = SurfaceKind::Cone;
        faces[3].kind = SurfaceKind::Cone;
        let directions = Directions::estimate(&drawing).unwrap();
        let rows = |drawing: &Drawing| {
            let sheet = Sheet::new(drawing, &faces, &directions);
            let unknowns = Unknowns::new(&sheet);
            let mut system = System::new(unknowns.count);
            on_one_axis(&sheet, &unknowns, &mut system);
            system.rows().to_vec()
        };
        let truth = drawing.truth.as_ref().unwrap();
        let places = truth.vertices3d.iter();
        let heights: Vec<f64> = places.map(|p| directions.camera.height(p.z)).collect();
        for row in rows(&drawing) {
            let largest = row.terms.iter().fold(0.0f64, |m, t| m.max(t.1.abs()));
            assert!(largest > 0.1, "{row:?}");
            assert!((row.residual(&heights) * row.weight).abs() < 1.0, "{row:?}");
        }
        // Where the circles are not told, nothing is left.
        let mut waved = drawing.clone();
        for edge in &mut waved.edges {
            if !matches!(edge.curve, Curve2::Line) {
                let last = edge.points.len() - 1;
                for (i, p) in edge.points.iter_mut().enumerate().take(last).skip(1) {
                    p.x += 0.01 * (i as f64).sin();
                }
                edge.curve = Curve2::recognise(&edge.points);
            }
        }
        assert_eq!(rows(&waved), []);
    }
}
