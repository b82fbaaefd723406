//! Rows that rest on general position: what is parallel, centred or square in the drawing is so in
//! space. They are taken in turn, only as long as depths are open, and only where they are.

use glam::{DVec2, DVec3};

use super::camera::Relation;
use super::coaxial;
use super::directions::AGREE;
use super::revolved;
use super::rows::{Tag, Unknowns, along, beside_axes, normal_to};
use super::rulings::rulings;
use super::sheet::Sheet;
use super::similar;
use super::system::{Row, System};
use crate::drawing::{Curve2, SurfaceKind};

/// A height and the same height as another curve gives it differ by less than this share.
const SAME: f64 = 1e-3;

/// A set of rows that may be added.
pub(super) type Level = fn(&Sheet<'_>, &Unknowns, &mut System<Tag>);

/// The sets, surest first.
pub(super) const LEVELS: [Level; 14] = [
    parallel,
    // The sides of a frustum would pass for ends of prisms.
    frustums,
    similar::ends,
    prisms,
    beside_axes,
    revolved::on_one_axis,
    revolved::on_cylinder,
    rulings,
    revolved::equal_ends,
    generators,
    pencils,
    square,
    coaxial::discs,
    coaxial::on_one_line,
];

/// Edges that are drawn parallel are parallel: their rises are as their drawn lengths.
fn parallel(sheet: &Sheet<'_>, _: &Unknowns, system: &mut System<Tag>) {
    // A vanishing point says more: the direction itself.
    slanted(sheet, true, system);
    let ends = |edge: usize| {
        let [u, v] = sheet.drawing.edges[edge].v;
        (u, v, sheet.drawing.vertices[v] - sheet.drawing.vertices[u])
    };
    let precision = sheet.directions.precision;
    for cluster in &sheet.parallels {
        let Some((&first, others)) = cluster.split_first() else {
            continue;
        };
        let (u, v, whole) = ends(first);
        for &edge in others {
            let (s, t, part) = ends(edge);
            let share = part.dot(whole) / whole.length_squared();
            let terms = [(t, 1.0), (s, -1.0), (v, -share), (u, share)];
            // A rise of about the length, off by the end points' error.
            let error = 4.0 * precision * (1.0 + share.abs());
            system.push(terms, 0.0, error.recip(), Tag::Parallel { edge });
        }
    }
}

/// Edges through a common vanishing point are parallel. Those of a pyramid may look so too, so that
/// other rules go first.
fn pencils(sheet: &Sheet<'_>, _: &Unknowns, system: &mut System<Tag>) {
    slanted(sheet, false, system);
}

/// The wall of a slot: a planar face stands upright on a floor, which is normal to an axis, where the edge
/// between them follows another one. So does a wall with curved edges in any direction, as of a slot in a
/// dome.
fn square(sheet: &Sheet<'_>, unknowns: &Unknowns, system: &mut System<Tag>) {
    let count = sheet.directions.axes.len();
    // Normals of planar faces that circles or two axes tell.
    let level = |face: usize| {
        let around = sheet.edges_of(face).iter().find_map(|&e| sheet.circles[e]);
        let around = around.map(|(k, _)| k).filter(|&k| k < count);
        sheet.normal_axis(face).or(around)
    };
    for face in 0..sheet.faces.len() {
        let Some(p) = unknowns.plane(face) else {
            continue;
        };
        if level(face).is_some() {
            continue;
        }
        // The side of a pyramid is no wall; what a turned part's surface cuts is.
        let edges = || sheet.edges_of(face).iter().copied();
        let cut = edges().any(|e| !sheet.is_straight(e));
        let upright = |edge: usize| {
            let floor = sheet.neighbours(edge).iter().find(|f| **f != face)?;
            let up = level(*floor).filter(|_| sheet.is_planar(*floor))?;
            let along = match sheet.edge_axis[edge] {
                Some(k) if k == up => return None,
                Some(k) => sheet.axis(k),
                None if cut => on_level(sheet, edge, sheet.axis(up)),
                None => return None,
            };
            sheet.axis(up).cross(along).try_normalize()
        };
        let mut straight: Vec<usize> = edges().filter(|&e| sheet.is_straight(e)).collect();
        // What follows an axis is surest.
        straight.sort_by_key(|&e| sheet.edge_axis[e].is_none());
        if let Some(normal) = straight.into_iter().find_map(upright) {
            normal_to(sheet, face, p, normal, Tag::Prism { face }, system);
        }
    }
}

/// The way of a straight edge in a plane of that normal, of any length.
fn on_level(sheet: &Sheet<'_>, edge: usize, normal: DVec3) -> DVec3 {
    let camera = sheet.camera();
    let [a, b] = sheet.drawing.edges[edge]
        .v
        .map(|v| sheet.drawing.vertices[v]);
    let (from, ray) = camera.ray(a);
    let start = from + ray;
    camera.on_plane(b, normal, start) - start
}

fn slanted(sheet: &Sheet<'_>, usual: bool, system: &mut System<Tag>) {
    let slants = sheet.directions.slanted.iter();
    for slant in slants.filter(|s| s.usual == usual) {
        for &edge in &slant.edges {
            if sheet.is_cone_line(edge) {
                continue;
            }
            let v = sheet.drawing.edges[edge].v;
            along(sheet, v, slant.direction, Tag::Parallel { edge }, system);
        }
    }
}

/// A planar face whose vertices all send edges along one axis is the end of a right prism: it is
/// normal to the axis.
fn prisms(sheet: &Sheet<'_>, unknowns: &Unknowns, system: &mut System<Tag>) {
    for face in 0..sheet.faces.len() {
        let Some(p) = unknowns.plane(face) else {
            continue;
        };
        let mut leaving = sheet.leaving(face).map(|(_, edge)| sheet.edge_axis[edge]);
        let Some(Some(k)) = leaving.next() else {
            continue;
        };
        if leaving.all(|other| other == Some(k)) {
            normal_to(sheet, face, p, sheet.axis(k), Tag::Prism { face }, system);
        }
    }
}

/// The end of a frustum, whose edges follow two axes, is centred over the vertices that its oblique
/// edges lead to if it is drawn so: the mean of these edges follows the third axis.
fn frustums(sheet: &Sheet<'_>, _: &Unknowns, system: &mut System<Tag>) {
    for face in 0..sheet.faces.len() {
        let Some(normal) = sheet.normal_axis(face) else {
            continue;
        };
        let leaving: Vec<(usize, usize)> = sheet.leaving(face).collect();
        let mut from: Vec<usize> = leaving.iter().map(|l| l.0).collect();
        from.dedup();
        if leaving.len() < 3
            || from.len() != leaving.len()
            || from.len() != sheet.corners[face].len()
        {
            continue;
        }
        let far = |&(v, e): &(usize, usize)| {
            let [a, b] = sheet.drawing.edges[e].v;
            [v, if a == v { b } else { a }]
        };
        let leaving: Vec<[usize; 2]> = leaving.iter().map(far).collect();
        if !sheet.camera().is_parallel() {
            central_frustum(sheet, face, normal, &leaving, system);
        } else if let Some(row) = centred(sheet, face, &leaving, normal) {
            system.push(row.terms, row.rhs, row.weight, row.tag);
        }
    }
}

/// The row of a frustum's end that is centred along an axis, in a parallel projection, if it is drawn
/// so: `leaving` are its corners, each with what its oblique edge leads to.
pub(super) fn centred(
    sheet: &Sheet<'_>,
    face: usize,
    leaving: &[[usize; 2]],
    axis: usize,
) -> Option<Row<Tag>> {
    let share = (leaving.len() as f64).recip();
    let at = |v: usize| sheet.drawing.vertices[v];
    let mean: DVec2 = leaving.iter().map(|l| at(l[1]) - at(l[0])).sum::<DVec2>() * share;
    let axis = sheet.axis(axis);
    let drawn = axis.truncate();
    let off = mean.perp_dot(drawn.normalize_or_zero()).abs();
    let error =
        2.0 * sheet.directions.precision + sheet.directions.error * mean.length() / drawn.length();
    let terms = leaving.iter().flat_map(|l| [(l[1], share), (l[0], -share)]);
    (off < AGREE * error).then(|| Row {
        terms: terms.collect(),
        rhs: mean.dot(drawn) / drawn.length_squared() * axis.z,
        weight: drawn.length() / (4.0 * error),
        tag: Tag::Frustum { face },
    })
}

/// The same in a central projection, where the far vertices have to lie in a plane parallel to the
/// face: then the middles of both are drawn at known points.
fn central_frustum(
    sheet: &Sheet<'_>,
    face: usize,
    normal: usize,
    leaving: &[[usize; 2]],
    system: &mut System<Tag>,
) {
    let axis = sheet.axis(normal);
    let far: Vec<usize> = leaving.iter().map(|l| l[1]).collect();
    let across = |e: &usize| {
        let v = sheet.drawing.edges[*e].v;
        let level = sheet.edge_axis[*e].is_some_and(|k| k != normal);
        level && v.iter().all(|v| far.contains(v))
    };
    let joined = (0..sheet.drawing.edges.len()).filter(across).count();
    if joined + 1 < far.len() {
        return;
    }
    let middle = |end: usize| {
        let sum: DVec3 = leaving
            .iter()
            .map(|l| {
                let (_, ray) = sheet.camera().ray(sheet.drawing.vertices[l[end]]);
                ray / axis.dot(ray)
            })
            .sum();
        // In front of the camera, whichever way the axis points.
        sheet.camera().project(if sum.z > 0.0 { -sum } else { sum })
    };
    let (near, distant) = (middle(0), middle(1));
    let apart = distant - near;
    let drawn = sheet.camera().drawn(axis, near.midpoint(distant));
    let length = drawn.length();
    let off = apart.perp_dot(drawn).abs() / length;
    let error = 2.0 * sheet.directions.precision + sheet.directions.error * apart.length() / length;
    if off < AGREE * error {
        let [from, to] = [(0, near), (1, distant)]
            .map(|(end, at)| Depth::across(sheet, leaving[0][end], axis, at));
        let row = sheet.camera().along(axis, near, distant);
        let weight = length / (4.0 * error);
        from.relate(&to, row, weight, Tag::Frustum { face }, system);
    }
}

/// A line of a cylinder along its axis meets its boundary at two points whose depths differ by the
/// line's rise, wherever these are on planes or circles.
fn generators(sheet: &Sheet<'_>, unknowns: &Unknowns, system: &mut System<Tag>) {
    for (face, f) in sheet.faces.iter().enumerate() {
        if f.kind != SurfaceKind::Cylinder {
            continue;
        }
        let edges = sheet.edges_of(face);
        let Some(axis) = edges
            .iter()
            .find_map(|&e| sheet.edge_axis[e])
            .map(|k| sheet.axis(k))
        else {
            continue;
        };
        for &from in edges.iter().filter(|&&e| !sheet.is_straight(e)) {
            for &to in edges.iter().filter(|&&e| e != from) {
                for p in sheet.samples(from) {
                    let Some(start) = depth_at(sheet, unknowns, from, p) else {
                        continue;
                    };
                    let drawn = sheet.camera().drawn(axis, p);
                    let length = drawn.length();
                    let error = 10.0 * sheet.directions.precision / length / axis.z.abs().max(1e-3)
                        + sheet.directions.error * sheet.size / (length * length);
                    let Some(q) = only_hit(sheet, to, p, drawn) else {
                        continue;
                    };
                    let Some(end) = depth_at(sheet, unknowns, to, q) else {
                        continue;
                    };
                    let row = sheet.camera().along(axis, p, q);
                    let tag = Tag::Generator { face };
                    start.relate(&end, row, error.recip(), tag, system);
                }
            }
        }
    }
}

/// Height of a point as terms and a shift: `sum(terms) + shift`.
pub(super) struct Depth {
    pub(super) terms: Vec<(usize, f64)>,
    pub(super) shift: f64,
}

impl Depth {
    /// Height of the point `q` in the plane of normal `n` through a vertex drawn at `p`.
    pub(super) fn across(sheet: &Sheet<'_>, vertex: usize, n: DVec3, q: DVec2) -> Self {
        let row = sheet.camera().across(n, sheet.drawing.vertices[vertex], q);
        Self {
            terms: vec![(vertex, row.from / row.to)],
            shift: row.rise / row.to,
        }
    }

    /// Adds the row that relates this height to that of `other`, unless it relates a height to itself:
    /// of two halves of a circle only their errors would be left.
    pub(super) fn relate(
        &self,
        other: &Self,
        row: Relation,
        weight: f64,
        tag: Tag,
        system: &mut System<Tag>,
    ) {
        let from = self.terms.iter().map(|&(i, c)| (i, -c * row.from));
        let to = other.terms.iter().map(|&(i, c)| (i, c * row.to));
        if let ([(a, c)], [(b, d)]) = (&self.terms[..], &other.terms[..])
            && a == b
            && (d * row.to - c * row.from).abs() < SAME * (c * row.from).abs()
        {
            return;
        }
        let rhs = row.rise - row.to * other.shift + row.from * self.shift;
        system.push(from.chain(to), rhs, weight, tag);
    }
}

/// Depth of a point of an edge: a vertex', or by the circle's or the neighbouring face's plane.
fn depth_at(sheet: &Sheet<'_>, unknowns: &Unknowns, edge: usize, p: DVec2) -> Option<Depth> {
    let e = &sheet.drawing.edges[edge];
    let near =
        |v: &&usize| sheet.drawing.vertices[**v].distance(p) < AGREE * sheet.directions.precision;
    if let Some(&v) = e.v.iter().find(near) {
        return Some(Depth {
            terms: vec![(v, 1.0)],
            shift: 0.0,
        });
    }
    if let Some((k, _)) = sheet.circles[edge] {
        return Some(Depth::across(sheet, e.v[0], sheet.axis(k), p));
    }
    let (face, plane) = sheet
        .neighbours(edge)
        .iter()
        .find_map(|&f| Some((f, unknowns.plane(f)?)))?;
    let d = p - sheet.middles[face];
    Some(Depth {
        terms: vec![(plane, -d.x), (plane + 1, -d.y), (plane + 2, -1.0)],
        shift: 0.0,
    })
}

/// The point of an elliptic arc on the line through `p` along `d`, if there is exactly one that is
/// not at the line's grazing point.
fn only_hit(sheet: &Sheet<'_>, edge: usize, p: DVec2, d: DVec2) -> Option<DVec2> {
    let Curve2::Ellipse(arc) = sheet.drawing.edges[edge].curve else {
        return None;
    };
    // In the ellipse's own coordinates it is the unit circle.
    let own = |v: DVec2| {
        let minor = arc.minor();
        DVec2::new(
            v.dot(arc.major) / arc.major.length_squared(),
            v.dot(minor) / minor.length_squared(),
        )
    };
    let along = own(d).try_normalize()?;
    let start = own(p - arc.center);
    let off = along.perp_dot(start);
    let half = (1.0 - off * off).sqrt();
    // Nearly grazing, the point is poorly known.
    if half.is_nan() || half < 0.05 {
        return None;
    }
    let foot = along.perp() * off;
    let mut hits = [half, -half].into_iter().filter_map(|s| {
        let u = foot + along * s;
        let turn = (u.to_angle() - arc.start) * arc.sweep.signum();
        let inside = turn.rem_euclid(std::f64::consts::TAU) <= arc.sweep.abs();
        inside.then(|| arc.center + arc.major * u.x + arc.minor() * u.y)
    });
    let first = hits.next()?;
    hits.next().is_none().then_some(first)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lift::directions::Directions;
    use crate::lift::testing::{extrusion, turned};

    #[test]
    fn straight_edges_of_a_floor_are_where_its_normal_puts_them() {
        let turn = turned(25.0, 35.0, 10.0);
        let (drawing, faces) = extrusion(turn, &[[0.0, 0.0], [1.0, 0.2], [0.3, 0.9]], 0.6);
        let directions = Directions::estimate(&drawing).unwrap();
        let sheet = Sheet::new(&drawing, &faces, &directions);
        let truth = drawing.truth.as_ref().unwrap();
        let floor = faces.last().unwrap();
        for edge in floor.edge_set() {
            let [a, b] = drawing.edges[edge].v.map(|v| truth.vertices3d[v]);
            let found = on_level(&sheet, edge, turn * DVec3::Z);
            assert!(found.normalize().cross((b - a).normalize()).length() < 1e-9);
        }
    }
}
