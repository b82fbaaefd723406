//! Right angles of the truth that a lift has exactly.

use faceformer::drawing::{CoEdge, Drawing};
use faceformer::identify::Face;
use faceformer::lift::{Lift, Surface, true_lift};

/// Cosine of an angle that is a right one: of the truth, whose coordinates are rounded, and of a lift.
const TRUE: f64 = 1e-4;
const EXACT: f64 = 1e-9;

/// Edges between two planes that meet at a right angle in the true solid.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct RightAngles {
    /// Number of them.
    pub(crate) wanted: usize,
    /// Those that lie between two planes at a right angle in the lift, within 1e-9.
    pub(crate) exact: usize,
}

impl RightAngles {
    /// Counts those of a drawing that was lifted with some faces; none without a truth in space.
    pub(crate) fn of(drawing: &Drawing, faces: &[Face], lift: &Lift) -> Self {
        let mut found = Self::default();
        let (Some(truth), Some(real)) = (&drawing.truth, true_lift(drawing)) else {
            return found;
        };
        let real_loops = truth.faces.iter().map(|f| &f.loops);
        let own_loops = faces.iter().map(|f| &f.loops);
        let [real_sides, own_sides] = [sides(drawing, real_loops), sides(drawing, own_loops)];
        for (real_pair, own_pair) in real_sides.iter().zip(&own_sides) {
            if cosine(&real.surfaces, real_pair).is_some_and(|c| c < TRUE) {
                found.wanted += 1;
                let exact = cosine(&lift.surfaces, own_pair).is_some_and(|c| c < EXACT);
                found.exact += usize::from(exact);
            }
        }
        found
    }
}

/// Faces at every edge.
fn sides<'a>(
    drawing: &Drawing,
    faces: impl Iterator<Item = &'a Vec<Vec<CoEdge>>>,
) -> Vec<Vec<usize>> {
    let mut sides = vec![Vec::new(); drawing.edges.len()];
    for (face, loops) in faces.enumerate() {
        for edge in loops.iter().flatten().map(|c| c.edge()) {
            if let Some(at) = sides.get_mut(edge) {
                at.push(face);
            }
        }
    }
    sides
}

/// Magnitude of the cosine of the angle between two faces; `None` if they are not two planes.
fn cosine(surfaces: &[Surface], pair: &[usize]) -> Option<f64> {
    let &[a, b] = pair else {
        return None;
    };
    match (surfaces.get(a)?, surfaces.get(b)?) {
        (Surface::Plane { normal: m, .. }, Surface::Plane { normal: n, .. }) => {
            Some(m.dot(*n).abs())
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use faceformer::Progress;
    use faceformer::drawing::dataset::Drawings;
    use faceformer::identify::from_truth;
    use faceformer::lift::{LiftOptions, lift};

    use super::*;

    #[test]
    fn a_tilted_plane_has_no_exact_right_angles() {
        let path = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../tests/corpus/sample.jsonl.zst"
        );
        let mut drawings = Drawings::open(path).unwrap().map(Result::unwrap);
        let block = drawings.find(|d| d.id == "moteus/00038#o0").unwrap();
        let faces = from_truth(&block).unwrap().faces;
        let mut lifted = lift(&block, &faces, &LiftOptions::default(), Progress::none()).unwrap();
        for surface in &mut lifted.surfaces {
            if let Surface::Plane { normal, .. } = surface {
                let nearest = lifted
                    .directions
                    .iter()
                    .max_by(|a, b| a.dot(*normal).abs().total_cmp(&b.dot(*normal).abs()));
                *normal = *nearest.unwrap();
            }
        }
        let straight = RightAngles::of(&block, &faces, &lifted);
        assert!(straight.wanted > 11, "{straight:?}");
        assert_eq!(straight.exact, straight.wanted);
        let own = faces[0].edge_set().len();
        if let Surface::Plane { normal, .. } = &mut lifted.surfaces[0] {
            *normal = (*normal + glam::DVec3::new(1e-6, 2e-6, 3e-6)).normalize();
        }
        let tilted = RightAngles::of(&block, &faces, &lifted);
        assert_eq!(tilted.wanted, straight.wanted);
        assert!(
            (1..=own).contains(&(straight.exact - tilted.exact)),
            "{tilted:?}"
        );
    }
}
