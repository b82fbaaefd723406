//! The rows of the depth problem (design, section 4).
//!
//! Unknowns are the height h of every vertex, which is its depth z in a parallel projection and
//! inverse depth in a central one ([`Camera`]), and (a, b, c) of every planar face,
//! `h + a (x - x0) + b (y - y0) + c = 0` with (x0, y0) the mean of the face's vertices.

use std::ops::Range;

use glam::DVec3;

#[cfg(doc)]
use super::Camera;
use super::sheet::Sheet;
use super::system::System;

/// What a row stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Tag {
    /// A vertex lies in a planar face.
    Incidence { face: usize, vertex: usize },
    /// A straight edge follows an axis.
    Edge { edge: usize },
    /// A vertex' height, by which the scale of a perspective drawing is chosen.
    Gauge,
    /// A planar face contains an axis' direction, because its edge follows it.
    Alignment { face: usize },
    /// A planar face is normal to an axis, because its arc is a circle around it.
    Disc { face: usize },
    /// The two ends of an arc lie in the plane of its circle.
    Chord { edge: usize },
    /// Points of a surface of revolution lie on its axis, or at a known distance from it.
    Revolved { face: usize },
    /// Circles are around one axis.
    Coaxial,
    /// An edge is parallel to the longest one that is drawn parallel.
    Parallel { edge: usize },
    /// A planar face is the end of a right prism.
    Prism { face: usize },
    /// The end of a frustum is centred.
    Frustum { face: usize },
    /// Vertices of a swept section have the depths that its sweep gives them.
    Swept { edge: usize },
    /// Two points of a cylinder's boundary are on one line along its axis.
    Generator { face: usize },
}

/// Index of an unknown.
pub(super) struct Unknowns {
    vertices: usize,
    /// First of the three unknowns of each planar face.
    planes: Vec<Option<usize>>,
    pub(super) count: usize,
}

impl Unknowns {
    pub(super) fn new(sheet: &Sheet<'_>) -> Self {
        let vertices = sheet.drawing.vertices.len();
        let mut count = vertices;
        let planes = (0..sheet.faces.len())
            .map(|f| {
                sheet.is_planar(f).then(|| {
                    count += 3;
                    count - 3
                })
            })
            .collect();
        Self {
            vertices,
            planes,
            count,
        }
    }

    pub(super) fn vertices(&self) -> Range<usize> {
        0..self.vertices
    }

    pub(super) fn plane(&self, face: usize) -> Option<usize> {
        self.planes[face]
    }
}

/// The rows that need no guess.
pub(super) fn certain(sheet: &Sheet<'_>, unknowns: &Unknowns) -> System<Tag> {
    let mut system = System::new(unknowns.count);
    incidence(sheet, unknowns, &mut system);
    edges(sheet, &mut system);
    alignment(sheet, unknowns, &mut system);
    let axes = sheet.directions.axes.len();
    discs(sheet, unknowns, 0..axes, &mut system);
    chords(sheet, 0..axes, &mut system);
    swept(sheet, &mut system);
    for &(face, k) in &sheet.ends {
        if let Some(p) = unknowns.plane(face) {
            let tag = Tag::Prism { face };
            normal_to(sheet, face, p, sheet.axis(k), tag, &mut system);
        }
    }
    system
}

/// The same of circles around the normals beside the axes, which may agree by chance.
pub(super) fn beside_axes(sheet: &Sheet<'_>, unknowns: &Unknowns, system: &mut System<Tag>) {
    let further = sheet.directions.axes.len()..sheet.normals();
    discs(sheet, unknowns, further.clone(), system);
    chords(sheet, further, system);
}

fn incidence(sheet: &Sheet<'_>, unknowns: &Unknowns, system: &mut System<Tag>) {
    let weight = sheet.directions.precision.recip();
    for (face, corners) in sheet.corners.iter().enumerate() {
        let Some(p) = unknowns.plane(face) else {
            continue;
        };
        for &vertex in corners {
            let d = sheet.drawing.vertices[vertex] - sheet.middles[face];
            let terms = [(vertex, 1.0), (p, d.x), (p + 1, d.y), (p + 2, 1.0)];
            system.push(terms, 0.0, weight, Tag::Incidence { face, vertex });
        }
    }
}

fn edges(sheet: &Sheet<'_>, system: &mut System<Tag>) {
    for (edge, e) in sheet.drawing.edges.iter().enumerate() {
        let Some(k) = sheet.edge_axis[edge] else {
            continue;
        };
        along(sheet, e.v, sheet.axis(k), Tag::Edge { edge }, system);
    }
}

/// The row of two vertices on a line along a direction.
pub(super) fn along(
    sheet: &Sheet<'_>,
    [from, to]: [usize; 2],
    axis: DVec3,
    tag: Tag,
    system: &mut System<Tag>,
) {
    let [u, v] = [from, to].map(|v| sheet.drawing.vertices[v]);
    let drawn = sheet.camera().drawn(axis, u.midpoint(v)).length();
    let slope = axis.z / drawn;
    let error = sheet.directions.precision * (2.0 * (1.0 + slope * slope)).sqrt()
        + sheet.directions.error * u.distance(v) / (drawn * drawn);
    let row = sheet.camera().along(axis, u, v);
    let terms = [(to, row.to), (from, -row.from)];
    system.push(terms, row.rise, error.recip(), tag);
}

/// The rows of a planar face, `p` its first unknown, that is normal to a direction.
pub(super) fn normal_to(
    sheet: &Sheet<'_>,
    face: usize,
    p: usize,
    n: DVec3,
    tag: Tag,
    system: &mut System<Tag>,
) {
    normal_within(sheet, (face, p), (n, sheet.directions.error), tag, system);
}

/// The same of a direction with its standard error, radians.
fn normal_within(
    sheet: &Sheet<'_>,
    (face, p): (usize, usize),
    (n, error): (DVec3, f64),
    tag: Tag,
    system: &mut System<Tag>,
) {
    let facing = sheet.camera().facing(n, sheet.middles[face]);
    let weight = (error / (facing * facing)).recip();
    for (unknown, slope) in [(p, n.x / facing), (p + 1, n.y / facing)] {
        slope_row(sheet, (p, [(unknown, 1.0)]), slope, weight, tag, system);
    }
}

/// A row about the slope of a plane, whose first unknown is `p`.
fn slope_row<const N: usize>(
    sheet: &Sheet<'_>,
    (p, terms): (usize, [(usize, f64); N]),
    rhs: f64,
    weight: f64,
    tag: Tag,
    system: &mut System<Tag>,
) {
    match sheet.camera().constant() {
        None => system.push(terms, rhs, weight, tag),
        Some(c) => system.push(
            terms.into_iter().chain([(p + 2, rhs * c)]),
            0.0,
            weight,
            tag,
        ),
    }
}

fn alignment(sheet: &Sheet<'_>, unknowns: &Unknowns, system: &mut System<Tag>) {
    for face in 0..sheet.faces.len() {
        let Some(p) = unknowns.plane(face) else {
            continue;
        };
        let mut extent = vec![0.0f64; sheet.directions.axes.len()];
        for &edge in sheet.edges_of(face) {
            if let Some(k) = sheet.edge_axis[edge] {
                extent[k] = extent[k].max(sheet.drawing.edges[edge].length());
            }
        }
        for (k, &length) in extent.iter().enumerate() {
            if length > 0.0 {
                let l = sheet.axis(k);
                // The error of a direction over the length of the edge that shows it.
                let error = sheet.directions.error + sheet.directions.precision / length;
                let d = sheet.camera().drawn(l, sheet.middles[face]);
                let terms = [(p, d.x), (p + 1, d.y)];
                let tag = Tag::Alignment { face };
                slope_row(sheet, (p, terms), -l.z, error.recip(), tag, system);
            }
        }
    }
}

fn discs(sheet: &Sheet<'_>, unknowns: &Unknowns, around: Range<usize>, system: &mut System<Tag>) {
    for face in 0..sheet.faces.len() {
        let Some(p) = unknowns.plane(face) else {
            continue;
        };
        let mut seen = vec![false; sheet.normals()];
        for &edge in sheet.edges_of(face) {
            if let Some((k, _)) = sheet.circles[edge] {
                seen[k] = true;
            }
        }
        for k in around.clone().filter(|&k| seen[k]) {
            let normal = (sheet.axis(k), sheet.directions.normal_error(k));
            normal_within(sheet, (face, p), normal, Tag::Disc { face }, system);
        }
    }
}

fn chords(sheet: &Sheet<'_>, around: Range<usize>, system: &mut System<Tag>) {
    for (edge, e) in sheet.drawing.edges.iter().enumerate() {
        if let (Some((k, _)), true) = (&sheet.circles[edge], e.v[0] != e.v[1])
            && around.contains(k)
        {
            let n = sheet.axis(*k);
            let [u, v] = e.v.map(|v| sheet.drawing.vertices[v]);
            let facing = sheet.camera().facing(n, u.midpoint(v)).abs();
            let error = sheet.directions.precision / facing
                + sheet.directions.normal_error(*k) * u.distance(v) / (facing * facing);
            let row = sheet.camera().across(n, u, v);
            let terms = [(e.v[1], row.to), (e.v[0], -row.from)];
            system.push(terms, row.rise, error.recip(), Tag::Chord { edge });
        }
    }
}

fn swept(sheet: &Sheet<'_>, system: &mut System<Tag>) {
    let camera = sheet.camera();
    for sweep in &sheet.directions.swept {
        let weight = sweep.error().recip();
        let mut ends = sweep.ends(sheet.drawing);
        let Some((_, first, depth)) = ends.next() else {
            continue;
        };
        for (edge, v, z) in ends {
            let row = camera.apart(camera.height(depth), camera.height(z));
            let terms = [(v, row.to), (first, -row.from)];
            system.push(terms, row.rise, weight, Tag::Swept { edge });
        }
    }
}
