//! The score of one drawing.

use std::collections::BTreeMap;

use super::calibration::Bins;
use serde::{Deserialize, Serialize};

use crate::drawing::{CoEdge, SurfaceKind, Truth};
use crate::identify::{Face, Identification};

/// What was found in one drawing, next to what is true.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct DrawingScore {
    /// True faces.
    pub faces: usize,
    /// Predicted faces.
    pub predicted: usize,
    /// Predicted faces whose set of edges is a true face's.
    pub matched: usize,
    /// Matched faces with the right one of the paper's three classes.
    pub typed: usize,
    /// Matched faces with the right one of the six surface kinds.
    pub surfaced: usize,
    /// True loops.
    pub loops: usize,
    /// Predicted loops.
    pub loops_predicted: usize,
    /// Predicted loops whose set of edges is a true loop's.
    pub loops_matched: usize,
    /// Whether one of the first three sets of faces, the best one included, is all right.
    pub exact_top3: bool,
    /// Whether the engine refused the drawing.
    pub refused: bool,
    /// Confidences of the predicted faces, and whether they are true ones.
    pub face_bins: Bins,
    /// Confidences of the predicted loops that have one, and whether they are true ones.
    pub loop_bins: Bins,
    /// Time the engine took, in milliseconds.
    pub ms: f64,
}

impl DrawingScore {
    /// The score of what an engine found in `ms` milliseconds.
    pub fn of(truth: &Truth, found: &Identification, ms: f64) -> Self {
        let mut kinds = Table::default();
        let mut loops = Table::default();
        for face in &truth.faces {
            kinds.add(edges(face.loops.iter().flatten()), face.kind, true);
            for walk in &face.loops {
                loops.add(edges(walk), SurfaceKind::Plane, true);
            }
        }
        let mut true_sets = kinds.clone();
        for face in &found.faces {
            kinds.add(edges(face.loops.iter().flatten()), face.kind, false);
            for walk in &face.loops {
                loops.add(edges(walk), SurfaceKind::Plane, false);
            }
        }
        let (mut face_bins, mut loop_bins) = (Bins::default(), Bins::default());
        for face in &found.faces {
            let own = edges(face.loops.iter().flatten());
            face_bins.add(face.confidence, kinds.is_true(&own));
            for (walk, confidence) in face.loops.iter().zip(&face.evidence.loops) {
                loop_bins.add(*confidence, loops.is_true(&edges(walk)));
            }
        }
        let alternatives = found.alternatives.iter().take(2);
        let exact_top3 =
            kinds.is_exact() || alternatives.into_iter().any(|c| true_sets.equals(&c.faces));
        Self {
            faces: kinds.total(true),
            predicted: kinds.total(false),
            matched: kinds.common(|_| 0),
            typed: kinds.common(SurfaceKind::paper_class),
            surfaced: kinds.common(|kind| kind as usize),
            loops: loops.total(true),
            loops_predicted: loops.total(false),
            loops_matched: loops.common(|_| 0),
            exact_top3,
            refused: false,
            face_bins,
            loop_bins,
            ms,
        }
    }

    /// The score of a drawing that an engine refused: nothing found of what is there.
    pub fn refused(truth: &Truth) -> Self {
        Self {
            faces: truth.faces.len(),
            loops: truth.faces.iter().map(|face| face.loops.len()).sum(),
            refused: true,
            ..Self::default()
        }
    }

    /// Share of the predicted faces that are true, 0 to 1; 0 if none was predicted.
    pub fn precision(&self) -> f64 {
        share(self.matched, self.predicted)
    }

    /// Share of the true faces that were found, 0 to 1.
    pub fn recall(&self) -> f64 {
        share(self.matched, self.faces)
    }

    /// Share of the predicted loops that are true, 0 to 1; 0 if none was predicted.
    pub fn loop_precision(&self) -> f64 {
        share(self.loops_matched, self.loops_predicted)
    }

    /// Share of the true loops that were found, 0 to 1.
    pub fn loop_recall(&self) -> f64 {
        share(self.loops_matched, self.loops)
    }

    /// Whether the faces are the true ones, none missing and none too many.
    pub fn exact(&self) -> bool {
        !self.refused && self.matched == self.faces && self.matched == self.predicted
    }

    /// Whether the loops are the true ones, however they are grouped into faces.
    pub fn loops_exact(&self) -> bool {
        let all = self.loops_matched;
        !self.refused && all == self.loops && all == self.loops_predicted
    }
}

/// `part / whole`, and 0 for an empty whole.
pub(super) fn share(part: usize, whole: usize) -> f64 {
    if whole == 0 {
        0.0
    } else {
        part as f64 / whole as f64
    }
}

/// The sorted set of edges of some co-edges.
pub(super) fn edges<'a>(coedges: impl IntoIterator<Item = &'a CoEdge>) -> Vec<usize> {
    let mut edges: Vec<usize> = coedges.into_iter().map(|c| c.edge()).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// For every set of edges, the kinds of the true items and of the predicted ones.
#[derive(Debug, Clone, Default)]
struct Table(BTreeMap<Vec<usize>, [Vec<SurfaceKind>; 2]>);

impl Table {
    fn add(&mut self, edges: Vec<usize>, kind: SurfaceKind, is_true: bool) {
        self.0.entry(edges).or_default()[usize::from(!is_true)].push(kind);
    }

    fn total(&self, is_true: bool) -> usize {
        let side = usize::from(!is_true);
        self.0.values().map(|sides| sides[side].len()).sum()
    }

    /// One-to-one matches between true and predicted items of equal edges and equal class.
    fn common(&self, class: impl Fn(SurfaceKind) -> usize) -> usize {
        const CLASSES: usize = 6;
        let counts = |kinds: &[SurfaceKind]| {
            let mut counts = [0usize; CLASSES];
            for &kind in kinds {
                counts[class(kind)] += 1;
            }
            counts
        };
        self.0
            .values()
            .map(|[truth, found]| {
                let found = counts(found);
                let pairs = counts(truth).into_iter().zip(found);
                pairs.map(|(t, f)| t.min(f)).sum::<usize>()
            })
            .sum()
    }

    /// Whether a true item has these edges.
    fn is_true(&self, edges: &[usize]) -> bool {
        self.0
            .get(edges)
            .is_some_and(|[truth, _]| !truth.is_empty())
    }

    fn is_exact(&self) -> bool {
        self.0
            .values()
            .all(|[truth, found]| truth.len() == found.len())
    }

    /// Whether the faces are this table's true items; forgets the predicted ones it had.
    fn equals(&mut self, faces: &[Face]) -> bool {
        for [_, found] in self.0.values_mut() {
            found.clear();
        }
        for face in faces {
            match self.0.get_mut(&face.edge_set()) {
                Some([_, found]) => found.push(face.kind),
                None => return false,
            }
        }
        self.is_exact()
    }
}
