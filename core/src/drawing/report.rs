//! What clean-up and diagnosis have to say about a drawing.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::Drawing;

/// How much a finding matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// No solid can be drawn like this; it must be mended.
    Error,
    /// Probably a mistake in the drawing.
    Warning,
    /// Worth knowing, often right.
    Notice,
}

/// What a finding is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum FindingKind {
    /// An input edge without length was dropped.
    ZeroLength,
    /// Ends of input edges that missed each other were joined.
    Snapped,
    /// Input edges that lie on each other became one.
    Duplicate,
    /// Input edges that continue each other became one.
    Joined,
    /// An input edge was split where others end on it.
    Split,
    /// An edge ends where no other edge does.
    Dangling,
    /// Exactly two edge ends meet at a vertex.
    DegreeTwo,
    /// An edge ends on the inside of another one.
    TJunction,
    /// The drawing falls into parts that share no vertex.
    IsolatedPart,
    /// Unusually many edges meet at a vertex.
    HighDegree,
    /// Two edges lie on each other along a stretch.
    Overlap,
    /// The file's faces have no surface types.
    NoFaceTypes,
}

/// One thing that clean-up did or diagnosis found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// How much it matters.
    pub severity: Severity,
    /// What it is about.
    pub kind: FindingKind,
    /// What it is and what to do, naming the edges.
    pub message: String,
    /// Edges concerned, indices from 0: of the input in a [`CleanDrawing`], of the drawing from
    /// [`diagnose`](super::diagnose()).
    pub edges: Vec<usize>,
    /// Vertices concerned, indices from 0 into the drawing's vertices.
    pub vertices: Vec<usize>,
    /// Where it is, in drawing units.
    pub points: Vec<DVec2>,
}

impl Finding {
    /// The same finding about input edges instead of the drawing's.
    pub(super) fn about_sources(mut self, sources: &[Vec<usize>]) -> Self {
        let edges = self.edges.iter().flat_map(|&e| &sources[e]);
        self.edges = edges.copied().collect();
        self.edges.sort_unstable();
        self.edges.dedup();
        self
    }
}

/// All findings about one input.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Report {
    /// Findings: first what clean-up did, then what diagnosis found.
    pub findings: Vec<Finding>,
    /// Distance within which clean-up took points for one, in drawing units; absent if the input
    /// was not cleaned.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
}

impl Report {
    /// Whether the drawing shows no solid as it is.
    pub fn has_errors(&self) -> bool {
        self.findings.iter().any(|f| f.severity == Severity::Error)
    }
}

/// A drawing with the way it came from its input.
#[derive(Debug, Clone, PartialEq)]
pub struct CleanDrawing {
    /// The drawing.
    pub drawing: Drawing,
    /// For each edge of the drawing the input edges (indices from 0) that it was made from, sorted.
    pub sources: Vec<Vec<usize>>,
    /// What clean-up did and diagnosis found.
    pub report: Report,
}
