//! The result every engine gives, and the interface every engine has.

use serde::{Deserialize, Serialize};

use crate::drawing::{CoEdge, Drawing, SurfaceKind};
use crate::{Progress, Result};

/// What speaks for a face, as numbers that a later stage or a reader can weigh.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Evidence {
    /// How many starts or votes led to this face; 1 for engines that decide all at once.
    #[serde(default)]
    pub votes: usize,
    /// Smallest margin of the decisions along its loops, in the engine's own log-odds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub margin: Option<f64>,
    /// Largest distance of the face's vertices from its lifted surface, in drawing units.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub residual: Option<f64>,
    /// Probability that each of its loops is right, 0 to 1, whatever face it belongs to; empty if
    /// the engine cannot tell.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub loops: Vec<f64>,
}

/// A face of the solid as the drawing shows it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Face {
    /// Surface kind.
    #[serde(rename = "type")]
    pub kind: SurfaceKind,
    /// Closed walks of co-edges, the outer loop first where that is known. Directions are
    /// consistent within an engine's result, up to reversal of a connected component.
    pub loops: Vec<Vec<CoEdge>>,
    /// Probability that the face is right, 0 to 1, as far as the engine can tell.
    #[serde(default = "one")]
    pub confidence: f64,
    /// What speaks for it.
    #[serde(default)]
    pub evidence: Evidence,
}

fn one() -> f64 {
    1.0
}

impl Face {
    /// The face's edges (indices from 0), sorted and without repeats: what the paper's metric
    /// compares (section 4.3).
    pub fn edge_set(&self) -> Vec<usize> {
        let mut edges: Vec<usize> = self.loops.iter().flatten().map(|c| c.edge()).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }
}

/// One consistent set of faces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// Faces.
    pub faces: Vec<Face>,
    /// The engine's score, larger is better; comparable within one identification only.
    #[serde(default)]
    pub score: f64,
}

/// What an engine found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Identification {
    /// Name of the engine.
    pub engine: String,
    /// The best set of faces.
    pub faces: Vec<Face>,
    /// Further sets, best first, without the best one.
    #[serde(default)]
    pub alternatives: Vec<Candidate>,
    /// What the user should know, for instance a fallback that was taken.
    #[serde(default)]
    pub notices: Vec<String>,
    /// Probability that the edges around each vertex of the drawing follow each other as in the
    /// faces, 0 to 1; empty if the engine cannot tell.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub vertices: Vec<f64>,
}

impl Identification {
    /// Faces of a reading: 0 is the best set, 1 the first alternative.
    ///
    /// # Panics
    /// If there is no such reading.
    pub fn reading(&self, number: usize) -> &[Face] {
        match number.checked_sub(1) {
            None => &self.faces,
            Some(k) => &self.alternatives[k].faces,
        }
    }
}

/// A method that finds the faces of a drawing.
pub trait Engine: Send + Sync {
    /// Name on the command line and in results.
    fn name(&self) -> &'static str;

    /// Finds the faces.
    ///
    /// # Errors
    /// [`IdentifyError`](super::IdentifyError) if the engine cannot handle the drawing;
    /// [`Error::Cancelled`](crate::Error::Cancelled) if `progress` asked to stop.
    fn identify(&self, drawing: &Drawing, progress: Progress<'_>) -> Result<Identification>;
}
