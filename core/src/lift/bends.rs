//! Normals of circles that bends of pipes tell.
//!
//! A circle is drawn as one of two, so that one by itself tells no normal. The ends of a bend are equal
//! circles, and by symmetry the line between their centres makes equal angles with their normals: it
//! runs along their sum or difference. In a parallel projection two bends are drawn with the same ends,
//! of which the outlines tell the one. A pipe's next end follows from the one before it so.

use glam::{DVec2, DVec3};

use super::Camera;
use super::circle::{DrawnCircle, circle_through};
use super::directions::{AGREE, Directions, DrawnNormals, Slant, drawn_normals, towards_viewer};
use super::ring_torus::touching_gap;
use super::surfaces::{Ring, bend_between};
use crate::drawing::{Drawing, SurfaceKind};
use crate::identify::Face;
use crate::sets::Sets;

/// Circles whose centres are drawn nearer to each other than this share of their size are one.
const SAME: f64 = 1e-2;

/// Largest sine by which the centres' line may be off the direction that the normals ask for.
const OFF: f64 = 5e-3;

/// Largest difference, relative, of the radii of a bend's ends.
const UNEQUAL: f64 = 5e-3;

/// Sine between normals that are as good as parallel: a bend by half a turn.
const PARALLEL: f64 = 1e-2;

/// A bend must fit its outlines that many times as well as any other.
const CLEARLY: f64 = 4.0;

/// Largest distance by which lines of sight to the outlines may miss a bend, as a share of its tube's radius:
/// circles around one axis, too, may be drawn as the ends of a bend.
const MISSES: f64 = 0.01;

/// Points of an outline that are looked at.
const POINTS: usize = 8;

/// A pipe's bend as it is drawn.
struct Bend {
    ends: [End; 2],
    /// Points of its outlines.
    outlines: Vec<DVec2>,
}

/// An end of a bend as it is drawn: arcs of one circle.
struct End {
    arcs: Vec<DrawnNormals>,
    points: Vec<DVec2>,
}

/// A normal that an end may have, with its circle.
#[derive(Clone, Copy)]
struct Look {
    normal: DVec3,
    error: f64,
    circle: DrawnCircle,
}

/// A reading with the normals of circles that bends join to circles of known normals; in a central
/// projection also of bends whose both ends are unknown. With the number of arcs that were told.
pub(super) fn extended(
    drawing: &Drawing,
    faces: &[Face],
    mut reading: Directions,
) -> (Directions, usize) {
    let bent = |f: &Face| matches!(f.kind, SurfaceKind::Torus | SurfaceKind::Other);
    if !faces.iter().any(bent) {
        return (reading, 0);
    }
    let normals = drawn_normals(drawing, &reading.camera, reading.precision);
    let open = |n: &DrawnNormals| known(&reading, n.edge).is_none();
    if !normals.iter().any(open) {
        return (reading, 0);
    }
    let mut bends = bends(drawing, faces, &normals);
    let mut told = 0;
    while let Some(slant) = bends.iter().find_map(|b| b.told(&reading, &normals)) {
        told += slant.circles.len();
        reading.slanted.push(slant);
        bends.retain(|b| b.ends.iter().any(|end| end.known(&reading).is_none()));
    }
    (reading, told)
}

/// Direction and error of the normal that a circle is known to have.
fn known(reading: &Directions, edge: usize) -> Option<(DVec3, f64)> {
    let mut all = reading.normals().enumerate();
    all.find_map(|(k, (n, arcs))| arcs.contains(&edge).then(|| (n, reading.normal_error(k))))
}

/// Bends: curved faces between two circles.
fn bends(drawing: &Drawing, faces: &[Face], normals: &[DrawnNormals]) -> Vec<Bend> {
    let mut beside: Vec<Vec<usize>> = vec![Vec::new(); drawing.edges.len()];
    for (f, face) in faces.iter().enumerate() {
        for e in face.edge_set() {
            if let Some(list) = beside.get_mut(e) {
                list.push(f);
            }
        }
    }
    let round = |e: usize| normals.iter().find(|n| n.edge == e);
    let mut parts = Sets::new(faces.len());
    for (e, list) in beside.iter().enumerate() {
        if let [a, b] = list[..]
            && faces[a].kind == faces[b].kind
            && round(e).is_none()
        {
            parts.join(a, b);
        }
    }
    let bent =
        |part: &Vec<usize>| matches!(faces[part[0]].kind, SurfaceKind::Torus | SurfaceKind::Other);
    let mut all = Vec::new();
    for part in parts.groups().into_iter().filter(bent) {
        let (mut arcs, mut outlines) = (Some(Vec::new()), Vec::new());
        for (e, list) in beside.iter().enumerate() {
            let own = list.iter().filter(|f| part.contains(f)).count();
            if own > 1 {
                let points = &drawing.edges[e].points;
                outlines.extend(points.iter().step_by(points.len().div_ceil(POINTS)));
            } else if own == 1 {
                arcs = arcs.zip(round(e)).map(|(mut arcs, arc)| {
                    arcs.push(*arc);
                    arcs
                });
            }
        }
        if let Some(ends) = arcs.map(|arcs| ends(drawing, arcs))
            && let Ok(ends) = <[End; 2]>::try_from(ends)
        {
            all.push(Bend { ends, outlines });
        }
    }
    all
}

/// Arcs in sets that are of one circle each.
fn ends(drawing: &Drawing, arcs: Vec<DrawnNormals>) -> Vec<End> {
    let mut ends: Vec<End> = Vec::new();
    for arc in arcs {
        let points = &drawing.edges[arc.edge].points;
        let same = |end: &&mut End| {
            let own = &end.arcs[0];
            own.center.distance(arc.center) < SAME * own.reach
                && (own.reach - arc.reach).abs() < SAME * own.reach
        };
        match ends.iter_mut().find(same) {
            Some(end) => {
                end.arcs.push(arc);
                end.points.extend(points);
            }
            None => ends.push(End {
                arcs: vec![arc],
                points: points.clone(),
            }),
        }
    }
    ends
}

impl End {
    fn known(&self, reading: &Directions) -> Option<(DVec3, f64)> {
        self.arcs.iter().find_map(|arc| known(reading, arc.edge))
    }

    /// The normal that is known, or the two that are possible.
    fn looks(&self, reading: &Directions) -> Vec<Look> {
        let best = self.arcs.iter().min_by(|a, b| a.error.total_cmp(&b.error));
        let normals = match (self.known(reading), best) {
            (Some(known), _) => vec![known],
            (None, Some(arc)) => arc.normals.map(|n| (n, arc.error)).to_vec(),
            (None, None) => Vec::new(),
        };
        let look = |(normal, error): (DVec3, f64)| {
            let circle = circle_through(&self.points, normal, &reading.camera)?;
            Some(Look {
                normal,
                error,
                circle,
            })
        };
        normals.into_iter().filter_map(look).collect()
    }
}

impl Bend {
    /// The normal of an end that is not known, if the bend tells it.
    fn told(&self, reading: &Directions, normals: &[DrawnNormals]) -> Option<Slant> {
        let is_known = self.ends.each_ref().map(|end| end.known(reading).is_some());
        // In a parallel projection a bend and its reversal in depth are drawn alike.
        if is_known == [true; 2] || (is_known == [false; 2] && reading.camera.is_parallel()) {
            return None;
        }
        let [first, second] = self.ends.each_ref().map(|end| end.looks(reading));
        let mut fitting: Vec<(f64, Look, Look)> = Vec::new();
        for a in &first {
            for b in &second {
                let limit = (AGREE * AGREE * (a.error + b.error)).min(OFF);
                if let Some(apart) = apart(&reading.camera, a, b, limit) {
                    fitting.push((self.gap(&reading.camera, a, b, apart), *a, *b));
                }
            }
        }
        fitting.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (gap, a, b) = *fitting.first()?;
        if gap > MISSES * a.circle.radius
            || (fitting.get(1)).is_some_and(|rival| rival.0 <= CLEARLY * gap)
        {
            return None;
        }
        let look = if is_known[0] { b } else { a };
        let alike = |n: &&DrawnNormals| {
            known(reading, n.edge).is_none() && n.agrees(look.normal, look.error)
        };
        Some(Slant {
            direction: towards_viewer(look.normal),
            edges: Vec::new(),
            circles: normals.iter().filter(alike).map(|n| n.edge).collect(),
            error: look.error,
            usual: false,
        })
    }

    /// Distance by which lines of sight to the outlines usually miss the torus between two circles, drawing
    /// units.
    fn gap(&self, camera: &Camera, a: &Look, b: &Look, apart: DVec3) -> f64 {
        let ring = |look: &Look, center: DVec3| Ring {
            center,
            normal: look.normal,
            radius: a.circle.radius,
        };
        let from = camera.unit(a.circle.center);
        let Some(torus) = bend_between(&ring(a, from), &ring(b, from + apart)) else {
            return f64::INFINITY;
        };
        let sights = self.outlines.iter().map(|p| camera.ray(*p));
        let gaps = sights.map(|(from, ray)| touching_gap(&torus, from, ray));
        let mut gaps: Vec<f64> = gaps.collect();
        gaps.sort_by(f64::total_cmp);
        gaps.get(gaps.len() / 2).copied().unwrap_or(f64::INFINITY)
    }
}

/// The way from the centre of one circle to that of another, drawing units, if they may be the ends of
/// one bend; the first at the distance where lengths are drawn as they are.
fn apart(camera: &Camera, a: &Look, b: &Look, limit: f64) -> Option<DVec3> {
    let [from, to] = [a, b].map(|look| camera.unit(look.circle.center));
    let share = a.circle.radius / b.circle.radius;
    if a.normal.cross(b.normal).length() < PARALLEL {
        let apart = to * share - from;
        let level = apart.normalize_or_zero().dot(a.normal).abs() < limit;
        return (level && !camera.is_parallel()).then_some(apart);
    }
    let apart = match camera {
        Camera::Parallel if (share - 1.0).abs() > UNEQUAL => return None,
        Camera::Parallel => to - from,
        // Equal circles are as far away as they are drawn small.
        Camera::Central { .. } => to * share - from,
    };
    let along = |sign: f64| {
        let d = a.normal + b.normal * sign;
        let d = if camera.is_parallel() {
            d.with_z(0.0)
        } else {
            d
        };
        let aside = apart
            .normalize_or_zero()
            .cross(d.normalize_or_zero())
            .length();
        (aside, sign)
    };
    let (aside, sign) = [along(1.0), along(-1.0)]
        .into_iter()
        .min_by(|a, b| a.0.total_cmp(&b.0))?;
    let d = a.normal + b.normal * sign;
    let rise = match camera {
        Camera::Parallel => apart.dot(d.with_z(0.0)) / d.truncate().length_squared() * d.z,
        Camera::Central { .. } => 0.0,
    };
    (aside < limit).then_some(apart + DVec3::Z * rise)
}
