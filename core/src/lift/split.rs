//! Faces taken apart into their loops when the rows of whole faces conflict.
//!
//! A face that is two faces, or has another one's loop, conflicts with all around it, and what its
//! loops say of each other is wrong, but each loop still lies in one plane. So every loop gets a
//! plane of its own, edges tie the depths of what they join, and loops of one face go together again
//! only if their planes are parallel and, where depth already tells, the same. What is loose then
//! is hung where it can be: into a face of the same slope around it.

use glam::DVec3;

use super::directions::Directions;
use super::evident::{encloses, is_around};
use super::sheet::Sheet;
use super::solve::{self, Solved};
use crate::drawing::{CoEdge, Drawing};
use crate::identify::Face;

/// Sine between normals of parallel planes.
const PARALLEL: f64 = 2e-3;

/// Distance, in standard errors of a coordinate, within which two planes are one.
const SAME: f64 = 50.0;

/// Loops that are hung, one after the other.
const HANGINGS: usize = 12;

/// Faces that agree with each other, and which of the given ones each came from.
pub(super) struct Split {
    pub(super) faces: Vec<Face>,
    pub(super) owners: Vec<usize>,
}

impl Split {
    /// Parts of some of the given faces.
    pub(super) fn parts_of(&self, faces: &[usize]) -> Vec<usize> {
        let parts = 0..self.owners.len();
        parts.filter(|&p| faces.contains(&self.owners[p])).collect()
    }
}

/// Takes faces apart where they conflict. `broken` are faces that are wrong by themselves. `None` if
/// the parts cannot be solved either.
pub(super) fn split(
    drawing: &Drawing,
    faces: &[Face],
    broken: &[usize],
    reading: &Directions,
) -> Option<Split> {
    if faces.iter().all(|f| f.loops.len() < 2) {
        return Some(Split {
            faces: faces.to_vec(),
            owners: (0..faces.len()).collect(),
        });
    }
    let (mut loops, mut owners) = (Vec::new(), Vec::new());
    for (owner, face) in faces.iter().enumerate() {
        for ring in &face.loops {
            loops.push(Face {
                loops: vec![ring.clone()],
                ..face.clone()
            });
            owners.push(owner);
        }
    }
    let sheet = Sheet::new(drawing, &loops, reading);
    let solved = solve::solve_open(&sheet).ok()?;
    let normals: Vec<Option<DVec3>> = (0..loops.len())
        .map(|l| normal(&sheet, &solved, l))
        .collect();
    // Of a face that is wrong by itself only what is drawn inside goes together.
    let inside = |owner: usize, outer: usize, l: usize| {
        !broken.contains(&owner) || is_around(drawing, &loops[outer].loops[0], &loops[l].loops[0])
    };
    let mut parts: Vec<(usize, Vec<usize>)> = Vec::new();
    for l in 0..loops.len() {
        let home = parts.iter_mut().find(|(owner, members)| {
            *owner == owners[l]
                && (!sheet.is_planar(l)
                    || (inside(*owner, members[0], l)
                        && members.iter().all(|&m| {
                            go_together(&sheet, &solved, [m, l], [normals[m], normals[l]])
                        })))
        });
        match home {
            Some((_, members)) => members.push(l),
            None => parts.push((owners[l], vec![l])),
        }
    }
    let join = |(owner, members): &(usize, Vec<usize>)| Face {
        loops: members
            .iter()
            .flat_map(|&l| loops[l].loops.clone())
            .collect(),
        ..faces[*owner].clone()
    };
    let mut split = Split {
        faces: parts.iter().map(join).collect(),
        owners: parts.iter().map(|p| p.0).collect(),
    };
    for _ in 0..HANGINGS {
        if !hang(drawing, &mut split, reading) {
            break;
        }
    }
    Some(split)
}

fn normal(sheet: &Sheet<'_>, solved: &Solved, face: usize) -> Option<DVec3> {
    let plane = solved.plane(face)?;
    sheet
        .camera()
        .normal(plane, sheet.middles[face])
        .try_normalize()
}

/// Whether two loops may lie in one plane, as far as their slopes and depths are known.
fn go_together(
    sheet: &Sheet<'_>,
    solved: &Solved,
    [a, b]: [usize; 2],
    normals: [Option<DVec3>; 2],
) -> bool {
    let [Some(n), Some(m)] = normals else {
        return true;
    };
    let (Some(&u), Some(&v)) = (sheet.corners[a].first(), sheet.corners[b].first()) else {
        return true;
    };
    if n.cross(m).length() > PARALLEL {
        return false;
    }
    let place = |v: usize| sheet.place(sheet.drawing.vertices[v], solved.height(v));
    let apart = (place(v) - place(u)).dot(n).abs();
    !solved.are_tied(sheet, u, v) || apart < SAME * sheet.directions.precision
}

/// Hangs one loose part: gives a planar loop of it to a face of the same slope that is drawn around
/// it, of several to the one that keeps the part within the heights of all that is not loose.
fn hang(drawing: &Drawing, split: &mut Split, reading: &Directions) -> bool {
    let sheet = Sheet::new(drawing, &split.faces, reading);
    let Ok(solved) = solve::solve_open(&sheet) else {
        return false;
    };
    let loose = solved.loose(&sheet);
    // The scale of a loose part is open too in a central projection.
    if loose.is_empty() || !sheet.camera().is_parallel() {
        return false;
    }
    let is_loose = |v: usize| loose.binary_search(&v).is_ok();
    // A loop that was taken out of a face belongs somewhere else; any other one may be a face.
    let homeless = |l: usize| split.owners[..l].contains(&split.owners[l]);
    let place = |v: usize| sheet.place(drawing.vertices[v], solved.height(v));
    let mut best: Option<((bool, f64), usize, usize)> = None;
    for (l, face) in split.faces.iter().enumerate() {
        let Some(&u) = sheet.corners[l].first() else {
            continue;
        };
        let Some(n) = normal(&sheet, &solved, l).filter(|_| is_loose(u)) else {
            continue;
        };
        let part: Vec<usize> = loose
            .iter()
            .copied()
            .filter(|&v| solved.are_tied(&sheet, u, v))
            .collect();
        for h in 0..split.faces.len() {
            let Some(&v) = sheet.corners[h].first().filter(|v| !is_loose(**v)) else {
                continue;
            };
            let slope = normal(&sheet, &solved, h);
            let alike = slope.is_some_and(|m| m.cross(n).length() < PARALLEL);
            let around = |ring: &Vec<CoEdge>| encloses(drawing, ring, &sheet.corners[l]);
            if !alike || h == l || !split.faces[h].loops.first().is_some_and(around) {
                continue;
            }
            let rest = (0..drawing.vertices.len()).filter(|&w| !is_loose(w));
            let heights = rest.map(|w| place(w).dot(n));
            let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), z| {
                (a.min(z), b.max(z))
            });
            let shift = place(v).dot(n) - place(u).dot(n);
            let outside = part
                .iter()
                .map(|&w| place(w).dot(n) + shift)
                .map(|z| (low - z).max(z - high).max(0.0))
                .fold(0.0, f64::max);
            // Of alike ones the face nearest to the viewer.
            let far = 1e-6 * -sheet.place(sheet.middles[h], solved.height(v)).z;
            let several = if face.loops.len() > 1 { 1e-3 } else { 0.0 };
            let badness = (!homeless(l), outside + far + several);
            if best.is_none_or(|(least, ..)| badness < least) {
                best = Some((badness, l, h));
            }
        }
    }
    let Some((_, l, h)) = best else {
        return false;
    };
    let copy: Vec<Vec<CoEdge>> = split.faces[l].loops.clone();
    split.faces[h].loops.extend(copy);
    true
}
