//! Vertices, recomputed from the surfaces that meet there.

use glam::DVec3;

use crate::drawing::Drawing;

use super::PlanError;
use super::lengths::Lengths;
use super::support::{Support, meet};
use super::uses::Use;
use super::{graze, touch};

/// A wall this close to a circle, in drawing units, was made to touch it.
const TOUCHES: f64 = 1e-12;

/// What meets at one vertex.
#[derive(Debug, Clone, Default)]
struct Corner {
    /// Edges and the faces beside them, from 0.
    beside: Vec<(usize, usize)>,
    /// Different supports of those faces.
    supports: Vec<usize>,
}

/// What meets at each vertex.
#[derive(Debug)]
pub(super) struct Incidence {
    corners: Vec<Corner>,
    of_face: Vec<usize>,
}

impl Incidence {
    pub(super) fn new(drawing: &Drawing, uses: &[[Use; 2]], of_face: &[usize]) -> Self {
        let mut corners = vec![Corner::default(); drawing.vertices.len()];
        for (e, pair) in uses.iter().enumerate() {
            for v in drawing.edges[e].v {
                let corner = &mut corners[v];
                corner.beside.extend(pair.iter().map(|u| (e, u.face)));
                corner.supports.extend(pair.iter().map(|u| of_face[u.face]));
            }
        }
        for corner in &mut corners {
            corner.supports.sort_unstable();
            corner.supports.dedup();
        }
        Self {
            corners,
            of_face: of_face.to_vec(),
        }
    }

    /// Pairs of supports that share a vertex, each once.
    pub(super) fn contacts(&self) -> Vec<[usize; 2]> {
        let mut pairs: Vec<[usize; 2]> = self
            .corners
            .iter()
            .flat_map(|c| pairs(&c.supports))
            .collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// The supports at each vertex.
    pub(super) fn supports(&self) -> impl Iterator<Item = &[usize]> {
        self.corners.iter().map(|c| &c.supports[..])
    }

    /// The vertices where their surfaces meet, near the lifted ones. A silhouette's vertex lies in
    /// the plane of the outline as well, one where surfaces touch on the line of contact.
    ///
    /// # Errors
    /// [`PlanError::OffSurface`] if a vertex stays off one of its surfaces.
    pub(super) fn meet(
        &self,
        supports: &[Support],
        outlines: &[Option<Support>],
        lifted: &[DVec3],
        lengths: Lengths,
    ) -> Result<Vec<DVec3>, PlanError> {
        let mut vertices = Vec::with_capacity(lifted.len());
        for (corner, start) in self.corners.iter().zip(lifted) {
            let mut surfaces: Vec<Support> = corner.supports.iter().map(|&s| supports[s]).collect();
            for [a, b] in pairs(&corner.supports) {
                surfaces.extend(touch::contact(
                    &supports[a],
                    &supports[b],
                    *start,
                    lengths.snap,
                ));
            }
            for triple in graze::triples(supports, [&corner.supports[..]].into_iter(), TOUCHES) {
                surfaces.extend(graze::contact(triple, supports));
            }
            for &(e, _) in &corner.beside {
                if let Some(outline) = outlines[e]
                    && !surfaces.contains(&outline)
                {
                    surfaces.push(outline);
                }
            }
            let held = meet(*start, &surfaces);
            // Surfaces that only seemed to touch are not held together.
            let off = |p: DVec3| {
                let gaps = corner
                    .supports
                    .iter()
                    .map(|&s| supports[s].distance(p).abs());
                gaps.fold(0.0, f64::max)
            };
            let p = if off(held) <= lengths.limit {
                held
            } else {
                meet(*start, &surfaces[..corner.supports.len()])
            };
            for &(e, f) in &corner.beside {
                let gap = supports[self.of_face[f]].distance(p).abs();
                if gap.is_nan() || gap > lengths.limit {
                    return Err(PlanError::OffSurface {
                        edge: e + 1,
                        face: f + 1,
                        gap,
                    });
                }
            }
            vertices.push(p);
        }
        Ok(vertices)
    }
}

/// All pairs of a list.
fn pairs(list: &[usize]) -> impl Iterator<Item = [usize; 2]> {
    list.iter()
        .enumerate()
        .flat_map(move |(i, &a)| list[i + 1..].iter().map(move |&b| [a, b]))
}
