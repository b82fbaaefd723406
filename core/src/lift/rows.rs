//! The rows of the depth problem (design, section 4).
//!
//! Unknowns are the depth z of every vertex and (a, b, c) of every planar face,
//! `z + a (x - x0) + b (y - y0) + c = 0` with (x0, y0) the mean of the face's vertices.

use super::sheet::Sheet;
use super::system::System;

/// What a row stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Tag {
    /// A vertex lies in a planar face.
    Incidence { face: usize, vertex: usize },
    /// A straight edge follows an axis.
    Edge { edge: usize },
    /// A planar face contains an axis' direction, because its edge follows it.
    Alignment { face: usize },
    /// A planar face is normal to an axis, because its arc is a circle around it.
    Disc { face: usize },
    /// The two ends of an arc lie in the plane of its circle.
    Chord { edge: usize },
    /// Points of a surface of revolution lie on its axis, or at a known distance from it.
    Revolved { face: usize },
    /// An edge is parallel to the longest one that is drawn parallel.
    Parallel { edge: usize },
    /// A planar face is the end of a right prism.
    Prism { face: usize },
    /// The end of a frustum is centred.
    Frustum { face: usize },
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

    pub(super) fn vertices(&self) -> std::ops::Range<usize> {
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
    discs(sheet, unknowns, &mut system);
    chords(sheet, &mut system);
    system
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
        let axis = sheet.axis(k);
        let drawn = axis.truncate();
        let d = sheet.drawing.vertices[e.v[1]] - sheet.drawing.vertices[e.v[0]];
        let rise = d.dot(drawn) / drawn.length_squared() * axis.z;
        let slope = axis.z / drawn.length();
        let error = sheet.directions.precision * (2.0 * (1.0 + slope * slope)).sqrt()
            + sheet.directions.error * d.length() / drawn.length_squared();
        system.push(
            [(e.v[1], 1.0), (e.v[0], -1.0)],
            rise,
            error.recip(),
            Tag::Edge { edge },
        );
    }
}

fn alignment(sheet: &Sheet<'_>, unknowns: &Unknowns, system: &mut System<Tag>) {
    for face in 0..sheet.faces.len() {
        let Some(p) = unknowns.plane(face) else {
            continue;
        };
        let mut extent = [0.0f64; 3];
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
                let terms = [(p, l.x), (p + 1, l.y)];
                system.push(terms, -l.z, error.recip(), Tag::Alignment { face });
            }
        }
    }
}

fn discs(sheet: &Sheet<'_>, unknowns: &Unknowns, system: &mut System<Tag>) {
    for face in 0..sheet.faces.len() {
        let Some(p) = unknowns.plane(face) else {
            continue;
        };
        let mut seen = [false; 3];
        for &edge in sheet.edges_of(face) {
            if let Some((k, _)) = sheet.circles[edge] {
                seen[k] = true;
            }
        }
        for k in (0..3).filter(|&k| seen[k]) {
            let n = sheet.axis(k);
            let weight = (sheet.directions.error / (n.z * n.z)).recip();
            system.push([(p, 1.0)], n.x / n.z, weight, Tag::Disc { face });
            system.push([(p + 1, 1.0)], n.y / n.z, weight, Tag::Disc { face });
        }
    }
}

fn chords(sheet: &Sheet<'_>, system: &mut System<Tag>) {
    for (edge, e) in sheet.drawing.edges.iter().enumerate() {
        if let (Some((k, _)), true) = (&sheet.circles[edge], e.v[0] != e.v[1]) {
            let n = sheet.axis(*k);
            let d = sheet.drawing.vertices[e.v[1]] - sheet.drawing.vertices[e.v[0]];
            let error = sheet.directions.precision / n.z
                + sheet.directions.error * d.length() / (n.z * n.z);
            system.push(
                [(e.v[1], 1.0), (e.v[0], -1.0)],
                -d.dot(n.truncate()) / n.z,
                error.recip(),
                Tag::Chord { edge },
            );
        }
    }
}
