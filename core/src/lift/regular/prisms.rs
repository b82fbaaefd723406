//! Short edges take their direction from what they are of.
//!
//! The side of a prism, be it a plate, a slot or a step, is a row of faces with four edges, of which
//! every second one follows the prism's axis. Each of them may be no longer than the noise, so that
//! it seems to follow any axis; together they tell which one. And an edge that leaves a plane does
//! not run in it, so that a plane whose normal is told by long edges leaves one axis only.

use crate::drawing::{CoEdge, Drawing, SurfaceKind};
use crate::identify::Face;
use crate::lift::directions::Directions;
use crate::sets::Sets;

/// Errors by which an edge may be off an axis that it follows.
const ERRORS: f64 = 3.5;

/// A row follows the axis that fits better than the others by this, in squared errors.
const CLEAR: f64 = 8.0;

/// An axis that is drawn shorter is seen from its end and has no direction in the drawing.
const END_ON: f64 = 0.05;

/// Edges of so many errors of their ends tell the plane of a face.
const LONG: f64 = 12.0;

/// The reading, with the edges of rows along the axes that the rows and the planes beside them tell.
pub(super) fn completed(drawing: &Drawing, faces: &[Face], mut reading: Directions) -> Directions {
    let error = std::f64::consts::SQRT_2 * reading.precision;
    let normals: Vec<Option<usize>> = faces.iter().map(|f| normal(drawing, f, &reading)).collect();
    for row in rows(drawing, faces, error) {
        let may: Vec<bool> = (0..reading.axes.len())
            .map(|k| {
                row.iter()
                    .all(|&e| may_follow(drawing, faces, &normals, e, k))
            })
            .collect();
        let misses = |k: usize| -> Vec<f64> {
            let offs = row.iter().map(|&e| off(drawing, &reading, e, k) / error);
            offs.collect()
        };
        let mut fits: Vec<(f64, usize)> = (0..reading.axes.len())
            .filter(|&k| may[k])
            .map(|k| (misses(k).iter().map(|m| m * m).sum(), k))
            .collect();
        fits.sort_by(|a, b| a.0.total_cmp(&b.0));
        let clear = match fits[..] {
            [] => false,
            [_] => may.contains(&false) || row.len() > 1,
            [best, second, ..] => row.len() > 1 && second.0 > best.0 + CLEAR,
        };
        let told = fits
            .first()
            .map(|f| f.1)
            .filter(|&k| clear && misses(k).iter().all(|m| m.abs() < ERRORS));
        for (k, axis) in reading.axes.iter_mut().enumerate() {
            axis.edges
                .retain(|e| !row.contains(e) || (may[k] && told.is_none()));
        }
        if let Some(k) = told {
            reading.axes[k].edges.extend(row);
            reading.axes[k].edges.sort_unstable();
        }
    }
    reading
}

/// The axis that a plane is normal to, if long edges along two others tell it.
fn normal(drawing: &Drawing, face: &Face, reading: &Directions) -> Option<usize> {
    if face.kind != SurfaceKind::Plane || !reading.is_frame() {
        return None;
    }
    let mut lengths = [0.0f64; 3];
    for e in face.edge_set() {
        if let Some(k) = reading.axis_of_edge(e) {
            let [a, b] = drawing.edges[e].v.map(|v| drawing.vertices[v]);
            lengths[k] = lengths[k].max(a.distance(b));
        }
    }
    let told: Vec<usize> = (0..3)
        .filter(|&k| lengths[k] > LONG * reading.precision)
        .collect();
    match told[..] {
        [i, j] => Some(3 - i - j),
        _ => None,
    }
}

/// Whether an edge may follow an axis: an edge of a plane runs in it, and one that leaves it does not.
fn may_follow(
    drawing: &Drawing,
    faces: &[Face],
    normals: &[Option<usize>],
    edge: usize,
    axis: usize,
) -> bool {
    let ends = drawing.edges[edge].v;
    faces.iter().zip(normals).all(|(face, normal)| {
        let Some(normal) = *normal else {
            return true;
        };
        let edges = face.edge_set();
        if edges.contains(&edge) {
            return axis != normal;
        }
        let on = ends.map(|v| edges.iter().any(|&e| drawing.edges[e].v.contains(&v)));
        on[0] == on[1] || axis == normal
    })
}

/// How far an edge's second end is drawn off the line along an axis through its first.
fn off(drawing: &Drawing, reading: &Directions, edge: usize, axis: usize) -> f64 {
    let [a, b] = drawing.edges[edge].v.map(|v| drawing.vertices[v]);
    let drawn = reading
        .camera
        .drawn(reading.axes[axis].direction, a.midpoint(b));
    if drawn.length() < END_ON {
        (b - a).length()
    } else {
        drawn.normalize().perp_dot(b - a)
    }
}

/// Straight edges in rows of faces with four edges, each opposite the next.
fn rows(drawing: &Drawing, faces: &[Face], error: f64) -> Vec<Vec<usize>> {
    let mut sets = Sets::new(drawing.edges.len());
    let vector = |c: &CoEdge| {
        let [a, b] = drawing.edges[c.edge()].v.map(|v| drawing.vertices[v]);
        if c.is_reversed() { a - b } else { b - a }
    };
    for face in faces {
        let [walk] = &face.loops[..] else {
            continue;
        };
        let [a, b, c, d] = &walk[..] else {
            continue;
        };
        for [one, two] in [[a, c], [b, d]] {
            let straight = [one, two].map(|c| drawing.edges[c.edge()].is_straight());
            if straight != [true; 2] {
                continue;
            }
            // Opposite sides of a loop run against each other.
            let (s, t) = (vector(one), -vector(two));
            let (short, long) = if s.length() < t.length() {
                (s, t)
            } else {
                (t, s)
            };
            if long.normalize_or_zero().perp_dot(short).abs() < ERRORS * error {
                sets.join(one.edge(), two.edge());
            }
        }
    }
    let mut rows = vec![Vec::new(); drawing.edges.len()];
    for e in (0..drawing.edges.len()).filter(|&e| drawing.edges[e].is_straight()) {
        rows[sets.find(e)].push(e);
    }
    rows.retain(|row| !row.is_empty());
    rows
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;
    use crate::lift::Camera;
    use crate::lift::directions::Axis;
    use crate::lift::regular::tests::BRACKET;
    use crate::lift::testing::{extrusion, turned};

    /// A thin plate with a notch, and its reading: edges in its plane are right, those across it are
    /// said to follow the plate's first axis, or none.
    fn plate(wrong: bool) -> (Drawing, Vec<Face>, Directions, Vec<usize>) {
        let turn = turned(0.6, 0.7, 0.05);
        let (drawing, faces) = extrusion(turn, &BRACKET, 0.02);
        let axes = DVec3::AXES.map(|axis| turn * axis);
        let along = |e: usize| {
            let places = &drawing.truth.as_ref().unwrap().vertices3d;
            let [a, b] = drawing.edges[e].v.map(|v| places[v]);
            let d = (b - a).normalize();
            (0..3).find(|&k| d.cross(axes[k]).length() < 1e-6).unwrap()
        };
        let edges = 0..drawing.edges.len();
        let (across, flat): (Vec<usize>, Vec<usize>) = edges.partition(|&e| along(e) == 2);
        let axes = (0..3).map(|k| Axis {
            direction: axes[k],
            edges: flat
                .iter()
                .chain(across.iter().filter(|_| wrong))
                .copied()
                .filter(|&e| along(e) == k || (along(e) == 2 && k == 0))
                .collect(),
            circles: Vec::new(),
        });
        let reading = Directions {
            axes: axes.collect(),
            slanted: Vec::new(),
            swept: Vec::new(),
            camera: Camera::Parallel,
            error: 0.01,
            precision: 0.005,
        };
        (drawing, faces, reading, across)
    }

    #[test]
    fn edges_across_a_plate_follow_the_axis_that_its_ends_leave() {
        for wrong in [false, true] {
            let (drawing, faces, reading, across) = plate(wrong);
            let mut expected = reading.clone();
            expected.axes[0].edges.retain(|e| !across.contains(e));
            expected.axes[2].edges = across;
            assert_eq!(completed(&drawing, &faces, reading), expected);
        }
    }

    #[test]
    fn edges_across_a_tapered_plate_follow_none() {
        let (mut drawing, faces, reading, across) = plate(true);
        // Each leads far to a side of its own.
        for (i, &e) in across.iter().enumerate() {
            let [_, v] = drawing.edges[e].v;
            drawing.vertices[v] += DVec2::from_angle(i as f64) * 0.2;
        }
        let found = completed(&drawing, &faces, reading);
        let follows = |e: &usize| found.axis_of_edge(*e).is_some();
        assert!(!across.iter().all(follows));
        assert!(across.iter().all(|e| found.axis_of_edge(*e) != Some(0)));
    }
}
