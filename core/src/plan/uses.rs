//! Which faces use which edges.

use crate::drawing::Drawing;
use crate::identify::Face;

use super::PlanError;

/// A place where a face uses an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Use {
    /// Face, from 0.
    pub(super) face: usize,
    /// Loop of the face, from 0.
    pub(super) walk: usize,
    /// Whether the loop walks the edge backwards.
    pub(super) reversed: bool,
}

/// The two uses of every edge.
///
/// # Errors
/// [`PlanError::OpenLoop`], [`PlanError::EdgeUse`] or [`PlanError::OwnNeighbour`] if the faces do
/// not close: every edge is to border two different faces.
pub(super) fn uses(drawing: &Drawing, faces: &[Face]) -> Result<Vec<[Use; 2]>, PlanError> {
    let mut found: Vec<Vec<Use>> = vec![Vec::new(); drawing.edges.len()];
    for (f, face) in faces.iter().enumerate() {
        if face.loops.is_empty() || face.loops.iter().any(Vec::is_empty) {
            return Err(PlanError::Input(format!("face {} has no edges", f + 1)));
        }
        for (w, walk) in face.loops.iter().enumerate() {
            for (i, co) in walk.iter().enumerate() {
                let next = walk[(i + 1) % walk.len()];
                let ends = |edge: usize| drawing.edges.get(edge).map(|e| e.v);
                let (Some(v), Some(v_next)) = (ends(co.edge()), ends(next.edge())) else {
                    let what = format!("face {} names an edge that is not drawn", f + 1);
                    return Err(PlanError::Input(what));
                };
                if v[usize::from(!co.is_reversed())] != v_next[usize::from(next.is_reversed())] {
                    return Err(PlanError::OpenLoop {
                        face: f + 1,
                        edge: co.edge() + 1,
                    });
                }
                found[co.edge()].push(Use {
                    face: f,
                    walk: w,
                    reversed: co.is_reversed(),
                });
            }
        }
    }
    let pairs = found.iter().enumerate().map(|(e, uses)| match uses[..] {
        [a, b] if a.face == b.face => Err(PlanError::OwnNeighbour {
            edge: e + 1,
            face: a.face + 1,
        }),
        [a, b] => Ok([a, b]),
        _ => Err(PlanError::EdgeUse {
            edge: e + 1,
            uses: uses.len(),
            faces: uses.iter().map(|u| u.face + 1).collect(),
        }),
    });
    pairs.collect()
}
