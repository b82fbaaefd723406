//! Cylinders: axis, then radius and centre from the boundary seen along the axis.

use glam::{DVec2, DVec3};

use super::ERRORS;
use super::evidence::vertex;
use crate::drawing::SurfaceKind;
use crate::lift::Surface;
use crate::lift::circle::circle_fit;
use crate::lift::heights::Heights;
use crate::lift::sheet::Sheet;

/// Largest distance, relative to the drawing's size, of a boundary point from a cylinder: beyond it no
/// solid can be built.
const OFF_CYLINDER: f64 = 1e-4;

/// Radians around a cylinder below which its outline fixes the radius better than a circle through
/// its points.
const NARROW: f64 = 0.7;

/// Sine of the angle within which a plane is along a cylinder.
const UPRIGHT: f64 = 1e-3;

/// Axis, then radius and centre from the boundary seen along the axis: of the face with those that
/// outlines part it from, if they are one cylinder, else of the face alone.
pub(super) fn cylinder(sheet: &Sheet<'_>, heights: &Heights, face: usize) -> Option<Surface> {
    let whole = whole(sheet, heights, face);
    let enough = ERRORS * sheet.directions.precision;
    let joint = (whole.len() > 1)
        .then(|| fit(sheet, heights, &whole))
        .flatten();
    if let Some((surface, off)) = joint
        && off <= enough
    {
        return Some(surface);
    }
    let own = fit(sheet, heights, &[face]);
    own.filter(|(_, off)| *off < enough.max(OFF_CYLINDER * sheet.size))
        .map(|(surface, _)| surface)
}

/// A cylindrical face and those beyond its straight edges, which may be its outlines; sorted.
fn whole(sheet: &Sheet<'_>, heights: &Heights, face: usize) -> Vec<usize> {
    let mut whole = vec![face];
    for &e in sheet
        .edges_of(face)
        .iter()
        .filter(|&&e| sheet.is_straight(e))
    {
        whole.extend(sheet.neighbours(e).iter().filter(|&&f| {
            sheet.faces[f].kind == SurfaceKind::Cylinder && heights.are_known(&sheet.corners[f])
        }));
    }
    whole.sort_unstable();
    whole.dedup();
    whole
}

/// The cylinder of some faces, and the largest distance of their boundary from it.
fn fit(sheet: &Sheet<'_>, heights: &Heights, faces: &[usize]) -> Option<(Surface, f64)> {
    let axis = faces
        .iter()
        .find_map(|&f| cylinder_axis(sheet, heights, f))?;
    let u = axis.any_orthonormal_vector();
    let w = axis.cross(u);
    let seen = |p: DVec3| DVec2::new(p.dot(u), p.dot(w));
    let boundary: Vec<DVec3> = faces
        .iter()
        .flat_map(|&f| boundary_points(sheet, heights, f))
        .collect();
    let flat: Vec<DVec2> = boundary.iter().map(|&p| seen(p)).collect();
    let worst = |(center, radius): &(DVec2, f64)| {
        let off = flat.iter().map(|p| (p.distance(*center) - radius).abs());
        off.fold(0.0, f64::max)
    };
    let best = |found: Vec<(DVec2, f64)>| {
        let all = found.into_iter();
        all.min_by(|a, b| worst(a).total_cmp(&worst(b)))
    };
    let through = circle_fit(flat.iter().copied());
    let mut found: Vec<(DVec2, f64)> = through.iter().map(|c| (c.0, c.1)).collect();
    if through.is_none_or(|(center, _, _)| arc_width(&flat, center) < NARROW) {
        let vertices = faces.iter().flat_map(|&f| outlines(sheet, f));
        found.extend(vertices.filter_map(|v| {
            let p = vertex(sheet, heights, v);
            // On an outline the radius is at right angles to the view.
            let (_, ray) = sheet.camera().ray(sheet.drawing.vertices[v]);
            touching(&flat, seen(p), seen(axis.cross(ray).try_normalize()?))
        }));
    }
    let free = best(found);
    // A fillet: what touches a plane beside it and passes through all points as well.
    let enough = free.as_ref().map_or(0.0, &worst);
    let enough = enough.max(ERRORS * sheet.directions.precision);
    let sides = faces.iter().flat_map(|&f| sides(sheet, heights, f));
    let fillets = sides
        .filter(|(_, normal)| normal.dot(axis).abs() < UPRIGHT)
        .filter_map(|(p, normal)| touching(&flat, seen(p), seen(normal).try_normalize()?))
        .filter(|fillet| worst(fillet) <= enough);
    let (center, radius) = best(fillets.collect()).or(free)?;
    let middle = boundary.iter().sum::<DVec3>() / boundary.len() as f64;
    let surface = Surface::Cylinder {
        origin: u * center.x + w * center.y + axis * middle.dot(axis),
        axis,
        radius,
    };
    // A straight edge across the axis is on none.
    let chords = faces.iter().flat_map(|&f| chords(sheet, heights, f));
    let off = chords.map(|p| surface.distance(p).abs());
    Some((surface, off.fold(worst(&(center, radius)), f64::max)))
}

/// The middles of a face's straight edges.
fn chords<'a>(
    sheet: &'a Sheet<'_>,
    heights: &'a Heights,
    face: usize,
) -> impl Iterator<Item = DVec3> + 'a {
    let edges = sheet.edges_of(face).iter();
    edges.filter(|&&e| sheet.is_straight(e)).map(|&e| {
        let [a, b] = sheet.drawing.edges[e].v.map(|v| vertex(sheet, heights, v));
        a.midpoint(b)
    })
}

/// The planes beside straight edges of a cylinder: a vertex of each edge, and the plane's normal.
fn sides<'a>(
    sheet: &'a Sheet<'_>,
    heights: &'a Heights,
    face: usize,
) -> impl Iterator<Item = (DVec3, DVec3)> + 'a {
    let edges = sheet.edges_of(face).iter();
    edges
        .filter(|&&e| sheet.is_straight(e))
        .filter_map(move |&e| {
            let beside = sheet.neighbours(e).iter().find(|&&f| f != face)?;
            let normal = sheet
                .camera()
                .normal(heights.plane(*beside)?, sheet.middles[*beside])
                .try_normalize()?;
            Some((vertex(sheet, heights, sheet.drawing.edges[e].v[0]), normal))
        })
}

/// Direction of the straight edges of a cylinder, else the normal of a circle that bounds it.
fn cylinder_axis(sheet: &Sheet<'_>, heights: &Heights, face: usize) -> Option<DVec3> {
    let edges = sheet.edges_of(face);
    let known = edges.iter().find_map(|&e| sheet.edge_axis[e]);
    let around = edges.iter().find_map(|&e| sheet.circles[e].map(|c| c.0));
    if let Some(k) = known.or(around) {
        return Some(sheet.axis(k));
    }
    let mut sum = DVec3::ZERO;
    for &e in edges.iter().filter(|&&e| sheet.is_straight(e)) {
        let [a, b] = sheet.drawing.edges[e].v.map(|v| vertex(sheet, heights, v));
        let d = b - a;
        sum += if d.dot(sum) < 0.0 { -d } else { d };
    }
    sum.try_normalize()
}

/// Vertices of the boundary, and the points of its arcs that lie in known planes.
fn boundary_points(sheet: &Sheet<'_>, heights: &Heights, face: usize) -> Vec<DVec3> {
    let mut points: Vec<DVec3> = sheet.corners[face]
        .iter()
        .map(|&v| vertex(sheet, heights, v))
        .collect();
    for &e in sheet.edges_of(face) {
        if sheet.is_straight(e) {
            continue;
        }
        let edge = &sheet.drawing.edges[e];
        let inner = edge.points.get(1..edge.points.len() - 1).unwrap_or(&[]);
        let start = vertex(sheet, heights, edge.v[0]);
        let normal = match sheet.circles[e] {
            Some((k, _)) => Some(sheet.axis(k)),
            None => sheet.neighbours(e).iter().find_map(|&f| {
                let plane = heights.plane(f)?;
                Some(sheet.camera().normal(plane, sheet.middles[f]))
            }),
        };
        if let Some(n) = normal {
            let place = |p: &DVec2| sheet.camera().on_plane(*p, n, start);
            points.extend(inner.iter().map(place));
        }
    }
    points
}

/// Vertices on straight edges between two curved faces: outlines, as far as a drawing tells.
fn outlines<'a>(sheet: &'a Sheet<'_>, face: usize) -> impl Iterator<Item = usize> + 'a {
    sheet
        .edges_of(face)
        .iter()
        .filter(|&&e| {
            sheet.is_straight(e) && sheet.neighbours(e).iter().all(|&f| !sheet.is_planar(f))
        })
        .map(|&e| sheet.drawing.edges[e].v[0])
}

/// Circle through `p` whose centre lies along `side` from it, closest to the other points: a point
/// q on it has `|q - p|^2 = 2 r side.(q - p)`.
pub(in crate::lift) fn touching(points: &[DVec2], p: DVec2, side: DVec2) -> Option<(DVec2, f64)> {
    let (mut top, mut bottom) = (0.0, 0.0);
    for q in points.iter().map(|q| *q - p) {
        let s = 2.0 * side.dot(q);
        top += s * q.length_squared();
        bottom += s * s;
    }
    let r = top / bottom;
    r.is_finite().then(|| (p + side * r, r.abs()))
}

/// Angle that points take around a centre: a full turn less the widest gap.
fn arc_width(points: &[DVec2], center: DVec2) -> f64 {
    let mut angles: Vec<f64> = points.iter().map(|p| (*p - center).to_angle()).collect();
    angles.sort_by(f64::total_cmp);
    let around = angles.first().map(|a| a + std::f64::consts::TAU);
    let next = angles.iter().skip(1).copied().chain(around);
    let gap = angles
        .iter()
        .zip(next)
        .map(|(a, b)| b - a)
        .fold(0.0, f64::max);
    std::f64::consts::TAU - gap
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lift::directions::Directions;
    use crate::lift::solve;
    use crate::lift::testing::{extrusion, turned};

    #[test]
    fn fillet_of_which_only_its_edges_are_known_touches_the_planes_beside_it() {
        // A bevelled corner, of which nothing tells a plane from a fillet.
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.8, 0.7], [0.0, 0.7]];
        let (drawing, mut faces) = extrusion(turned(25.0, 35.0, 10.0), &corners, 0.6);
        let bevel = (0..faces.len())
            .find(|&f| {
                let edges = faces[f].edge_set();
                edges.iter().any(|&e| {
                    let truth = drawing.truth.as_ref().unwrap();
                    let [a, b] = drawing.edges[e].v.map(|v| truth.vertices3d[v]);
                    (a.distance(b) - 0.08f64.sqrt()).abs() < 1e-9
                }) && edges.len() == 4
            })
            .unwrap();
        faces[bevel].kind = SurfaceKind::Cylinder;
        let directions = Directions::estimate(&drawing).unwrap();
        let sheet = Sheet::new(&drawing, &faces, &directions);
        let heights = solve::solve(&sheet).unwrap().heights(&sheet);
        let found = fit(&sheet, &heights, &[bevel]);
        let Some((Surface::Cylinder { radius, .. }, off)) = found else {
            panic!("{found:?}");
        };
        assert!((radius - 0.2).abs() < 1e-6, "{radius}");
        // The straight edges of its ends are chords of a quarter turn.
        let sagitta = 0.2 * (1.0 - f64::to_radians(45.0).cos());
        assert!((off - sagitta).abs() < 1e-6, "{off}");
        assert_eq!(cylinder(&sheet, &heights, bevel), None);
        let all = super::super::surfaces(&sheet, &heights);
        assert!(
            matches!(all[bevel], Surface::Plane { .. }),
            "{:?}",
            all[bevel]
        );
    }
}
