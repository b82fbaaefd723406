//! Cylinders of a draft: which faces are one, where they are about, and what they touch.

use glam::{DVec2, DVec3};

use super::draft::Draft;
use super::problem::{Condition, Dir, Shape};
use super::touches::touches;
use crate::drawing::SurfaceKind;
use crate::lift::circle_fit;

/// Cosine of the angle within which drawn tangents are one.
const SMOOTH: f64 = 0.82;

/// Cosine of the angle within which a cylinder stands upright on a plane that cuts it in an arc.
const UPRIGHT: f64 = 0.93;

/// Cylinders are halves of one if they differ by less than this share of the radius: cylinders that
/// touch differ by two radii, or are of another radius.
const HALF: f64 = 0.4;

pub(super) fn add_cylinders(draft: &mut Draft<'_, '_>) {
    let outlines = outlines(draft);
    let halves = halves(draft, &outlines);
    let groups = groups(draft, outlines.iter().chain(&halves));
    let mut added: Vec<(usize, Vec<usize>)> = Vec::new();
    for group in groups {
        let dir = direction(draft, &group);
        let dir = draft.add_dir(dir);
        let axis = draft.problem.direction(dir, &draft.problem.x);
        let points = boundary(draft, &group, axis);
        let Some((center, radius)) = circle(&points, axis) else {
            continue;
        };
        let place = draft.problem.add(&center.to_array());
        let radius = draft.problem.add(&[radius]);
        let body = draft.add_body(Shape::Cylinder { place, radius }, dir);
        added.push((body, group));
    }
    for (body, group) in &added {
        group.iter().for_each(|&f| draft.body_of[f] = *body);
    }
    for (body, _) in &added {
        for point in draft.corners(*body) {
            draft
                .problem
                .conditions
                .push(Condition::On { point, body: *body });
        }
    }
    for &e in &outlines {
        let [v, w] = draft.sheet.drawing.edges[e].v;
        if let Some([round, other]) = draft.beside(e)
            && round == other
            && draft.is_round(round)
        {
            let ends = [v, w].map(|point| Condition::Outline { point, round });
            draft.problem.conditions.extend(ends);
        }
    }
    along(draft);
    touches(draft);
}

/// Straight edges of cylinders follow their axes: both ends on it are not enough.
fn along(draft: &mut Draft<'_, '_>) {
    for e in 0..draft.sheet.drawing.edges.len() {
        let Some([a, b]) = draft.beside(e) else {
            continue;
        };
        let round = if draft.is_round(a) { a } else { b };
        if draft.sheet.is_straight(e) && draft.is_round(round) {
            let [from, to] = draft.sheet.drawing.edges[e].v;
            let across = [false, true].map(|second| Condition::Along {
                from,
                to,
                round,
                second,
            });
            draft.problem.conditions.extend(across);
        }
    }
}

/// Straight edges that part one cylinder: drawn along the tangents of the curves that end on them.
fn outlines(draft: &Draft<'_, '_>) -> Vec<usize> {
    let sheet = draft.sheet;
    let is_outline = |e: &usize| {
        let [f, g] = *sheet.neighbours(*e) else {
            return false;
        };
        let cylinders = [f, g]
            .iter()
            .all(|&f| draft.kind(f) == SurfaceKind::Cylinder);
        if !(cylinders && sheet.is_straight(*e)) {
            return false;
        }
        let [a, b] = sheet.drawing.edges[*e].v;
        let along = (sheet.drawing.vertices[b] - sheet.drawing.vertices[a]).normalize_or_zero();
        let tangents = [(a, f), (a, g), (b, f), (b, g)]
            .into_iter()
            .filter_map(|(v, f)| curve_tangent(draft, f, v));
        let (mut smooth, mut all) = (0, 0);
        for t in tangents {
            all += 1;
            smooth += usize::from(t.dot(along).abs() > SMOOTH);
        }
        2 * smooth >= all
    };
    (0..sheet.drawing.edges.len()).filter(is_outline).collect()
}

/// Other straight edges between faces of cylinders that go on smoothly and are about one.
fn halves(draft: &mut Draft<'_, '_>, outlines: &[usize]) -> Vec<usize> {
    let mut found = Vec::new();
    for e in 0..draft.sheet.drawing.edges.len() {
        let [f, g] = *draft.sheet.neighbours(e) else {
            continue;
        };
        let round = [f, g].map(|f| draft.kind(f) == SurfaceKind::Cylinder);
        if round != [true; 2]
            || !draft.sheet.is_straight(e)
            || outlines.contains(&e)
            || !is_smooth(draft, e, f, g)
        {
            continue;
        }
        let dir = direction(draft, &[f, g]);
        let dir = draft.add_dir(dir);
        let axis = draft.problem.direction(dir, &draft.problem.x);
        let circles = [f, g].map(|f| circle(&boundary(draft, &[f], axis), axis));
        if let [Some((p, r)), Some((q, s))] = circles {
            let apart = (q - p).reject_from_normalized(axis).length();
            if apart.max((r - s).abs()) < HALF * r.max(s) {
                found.push(e);
            }
        }
    }
    found
}

/// Tangent of the curved edge of a face that leaves a vertex.
fn curve_tangent(draft: &Draft<'_, '_>, face: usize, v: usize) -> Option<DVec2> {
    let sheet = draft.sheet;
    let edges = sheet.edges_of(face).iter();
    let e = edges
        .copied()
        .find(|&e| !sheet.is_straight(e) && sheet.drawing.edges[e].v.contains(&v))?;
    leaving(draft, e, v)
}

/// Unit tangent of an edge that leaves a vertex.
fn leaving(draft: &Draft<'_, '_>, edge: usize, v: usize) -> Option<DVec2> {
    let e = &draft.sheet.drawing.edges[edge];
    let n = e.points.len();
    let third = ((n - 1) / 3).max(1);
    let at = |i: usize| e.points[if e.v[0] == v { i } else { n - 1 - i }];
    let t = if draft.sheet.is_straight(edge) || third < 2 {
        at(third.min(n - 1)) - at(0)
    } else {
        // The parabola through three points.
        at(third / 2) * 4.0 - at(0) * 3.0 - at(2 * (third / 2))
    };
    t.try_normalize()
}

/// Cylindrical faces that are parts of one.
fn groups<'a>(draft: &Draft<'_, '_>, joins: impl Iterator<Item = &'a usize>) -> Vec<Vec<usize>> {
    let faces = draft.sheet.faces.len();
    let mut root: Vec<usize> = (0..faces).collect();
    let find = |root: &[usize], mut i: usize| {
        while root[i] != i {
            i = root[i];
        }
        i
    };
    for &e in joins {
        if let [f, g] = *draft.sheet.neighbours(e) {
            let (f, g) = (find(&root, f), find(&root, g));
            root[f.max(g)] = f.min(g);
        }
    }
    let mut groups: Vec<Vec<usize>> = vec![Vec::new(); faces];
    for f in (0..faces).filter(|&f| draft.kind(f) == SurfaceKind::Cylinder) {
        groups[find(&root, f)].push(f);
    }
    groups.retain(|g| !g.is_empty());
    groups
}

/// The axis of a group: what most of its straight edges and circles follow, else the direction of
/// a plane that cuts it in an arc and that its straight edges are about normal to, else that of its
/// straight edges.
fn direction(draft: &mut Draft<'_, '_>, group: &[usize]) -> Dir {
    let sheet = draft.sheet;
    let mut votes = [0.0f64; 3];
    let mut sum = DVec3::ZERO;
    let mut planes: Vec<usize> = Vec::new();
    for &f in group {
        for &e in sheet.edges_of(f) {
            let length = sheet.drawing.edges[e].length();
            if let Some(k) = sheet.edge_axis[e] {
                votes[k] += length;
            }
            if let Some((k, _)) = sheet.circles[e] {
                votes[k] += length;
            }
            if sheet.is_straight(e) {
                let [a, b] = sheet.drawing.edges[e].v.map(|v| draft.place(v));
                sum += if (b - a).dot(sum) < 0.0 { a - b } else { b - a };
            } else if let Some(pair) = draft.beside(e) {
                planes.extend(pair.into_iter().filter(|&b| draft.is_plane(b)));
            }
        }
    }
    let top = (0..3).max_by(|&i, &j| votes[i].total_cmp(&votes[j]));
    if let Some(k) = top.filter(|&k| votes[k] > 0.0) {
        return Dir::Fixed(DVec3::AXES[k]);
    }
    let straight = sum.try_normalize();
    for body in planes {
        let dir = draft.problem.bodies[body].dir;
        let normal = draft.problem.direction(dir, &draft.problem.x);
        if straight.is_none_or(|s| s.dot(normal).abs() > UPRIGHT) {
            return draft.problem.dirs[dir];
        }
    }
    let at = draft.problem.add(&[0.0, 0.0]);
    Dir::Free {
        base: straight.unwrap_or(DVec3::Z),
        at,
    }
}

/// Points of a group's boundary: its corners, and points of curves on planes.
fn boundary(draft: &Draft<'_, '_>, group: &[usize], axis: DVec3) -> Vec<DVec3> {
    let sheet = draft.sheet;
    let mut points = Vec::new();
    for &f in group {
        points.extend(sheet.corners[f].iter().map(|&v| draft.place(v)));
        for &e in sheet.edges_of(f).iter().filter(|&&e| !sheet.is_straight(e)) {
            let plane = draft
                .beside(e)
                .and_then(|pair| pair.into_iter().find(|&b| draft.is_plane(b)));
            let Some(plane) = plane else {
                continue;
            };
            let normal = draft
                .problem
                .direction(draft.problem.bodies[plane].dir, &draft.problem.x);
            let facing = (draft.problem.rotation * normal).z.abs();
            if facing < 0.05 || normal.dot(axis).abs() < 0.2 {
                continue;
            }
            let edge = &sheet.drawing.edges[e];
            let start = draft.place(edge.v[0]);
            let inner = &edge.points[1..edge.points.len() - 1];
            points.extend(
                inner
                    .iter()
                    .map(|p| draft.onto(plane, *p / draft.size, start)),
            );
        }
    }
    points
}

/// Centre and radius of the circle around an axis next to points.
fn circle(points: &[DVec3], axis: DVec3) -> Option<(DVec3, f64)> {
    let (u, w) = axis.any_orthonormal_pair();
    let flat = |p: &DVec3| DVec2::new(p.dot(u), p.dot(w));
    let middle = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
    let (center, radius, _) = circle_fit(points.iter().map(flat))?;
    // A circle larger than the drawing is a line with noise.
    (radius < 3.0).then(|| {
        (
            u * center.x + w * center.y + axis * axis.dot(middle),
            radius,
        )
    })
}

/// Whether two faces go on smoothly into each other along an edge, as far as the edges at its ends
/// show it.
pub(super) fn is_smooth(draft: &Draft<'_, '_>, edge: usize, f: usize, g: usize) -> bool {
    let sheet = draft.sheet;
    let (mut smooth, mut all) = (0, 0);
    for v in sheet.drawing.edges[edge].v {
        let next = |face: usize| {
            let edges = sheet.edges_of(face).iter().copied();
            let mut at = edges.filter(|&e| e != edge && sheet.drawing.edges[e].v.contains(&v));
            at.next().and_then(|e| leaving(draft, e, v))
        };
        if let (Some(s), Some(t)) = (next(f), next(g)) {
            all += 1;
            smooth += usize::from(s.dot(t) < -SMOOTH);
        }
    }
    all > 0 && 2 * smooth >= all
}
