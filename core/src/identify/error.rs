//! Errors of identification. Edges are numbered from 1, vertices from 0.

/// Why an engine refused a drawing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IdentifyError {
    /// The engine handles straight edges only.
    #[error("the engine {engine} handles straight edges only, and edge {edge} is curved")]
    CurvedEdge {
        /// Engine name.
        engine: &'static str,
        /// Edge number, from 1.
        edge: usize,
    },
    /// A vertex has fewer than two edges.
    #[error("edge {edge} ends freely at vertex {vertex}; connect or delete it")]
    DanglingEdge {
        /// Edge number, from 1.
        edge: usize,
        /// Vertex index, from 0.
        vertex: usize,
    },
    /// More edges meet at a vertex than the engine handles.
    #[error("{degree} edges meet at vertex {vertex}; the engine {engine} handles at most {limit}")]
    DegreeTooHigh {
        /// Engine name.
        engine: &'static str,
        /// Vertex index, from 0.
        vertex: usize,
        /// Edges at the vertex.
        degree: usize,
        /// Most that the engine handles.
        limit: usize,
    },
    /// The engine got stuck: no consistent set of faces remains.
    #[error("the engine {engine} found no consistent faces through edge {edge}")]
    NoFaces {
        /// Engine name.
        engine: &'static str,
        /// Edge number, from 1.
        edge: usize,
    },
    /// The text is no faces file.
    #[error(
        "not a faces file: {0}; expected what `faceformer identify` writes, or {{\"faces\": [...]}}"
    )]
    Format(String),
    /// A faces file does not fit the drawing.
    #[error("the faces do not fit the drawing: face {face}: {what}")]
    Mismatch {
        /// Face number, from 1.
        face: usize,
        /// What is wrong, naming the edge.
        what: String,
    },
    /// The engine needs a trained model, and none is named.
    #[error(
        "the engine {engine} needs a trained model: name its file with --model, the option \"model\" or \
         the environment variable FACEFORMER_MODEL"
    )]
    NoModel {
        /// Engine name.
        engine: &'static str,
    },
    /// The trained model cannot be used.
    #[error("the engine {engine} cannot use its model: {what}")]
    Model {
        /// Engine name.
        engine: &'static str,
        /// Why.
        what: String,
    },
    /// The drawing has more edges than the model has learned positions for.
    #[error(
        "the drawing has {edges} edges; the model of the engine {engine} takes at most {limit}"
    )]
    TooManyEdges {
        /// Engine name.
        engine: &'static str,
        /// Edges of the drawing.
        edges: usize,
        /// Most that the model takes.
        limit: usize,
    },
    /// No engine of that name.
    #[error("there is no engine named {0:?}; there are {names}", names = super::EngineKind::names())]
    UnknownEngine(String),
}
