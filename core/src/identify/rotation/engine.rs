//! The engine: score, decode, read off loops.

use super::canonical::Canonical;
use super::frame::Frame;
use super::reading::{Doubts, Reader};
use super::variants::variants;
use super::{Field, HandScorer, TripleScorer, Triples, model};
use crate::drawing::{Drawing, Graph};
use crate::identify::{Engine, EngineKind, Identification, IdentifyError};
use crate::lift::Readings;
use crate::{Progress, Result, Stage};

/// Most edges at one vertex that the engine handles.
pub const MAX_DEGREE: usize = 24;

/// Sets of faces that are given at most, the best one included.
const CANDIDATES: usize = 6;

/// Faces from a rotation system; see the [module](super).
pub struct RotationEngine {
    scorer: Box<dyn TripleScorer>,
    notices: Vec<String>,
}

impl RotationEngine {
    /// The engine with scores from `scorer`.
    pub fn new(scorer: Box<dyn TripleScorer>) -> Self {
        Self {
            scorer,
            notices: Vec::new(),
        }
    }

    /// The engine with the model that is asked for: by `name`, a file or [`model::NONE`], else by
    /// the environment variable [`model::VARIABLE`], else the one that comes with the program.
    ///
    /// A model that cannot be used is replaced by the hand-made scores, and every result says so.
    pub fn with_model(name: Option<&str>) -> Self {
        match model::choose(name) {
            Ok(Some(scorer)) => Self::new(Box::new(scorer)),
            Ok(None) => Self::default(),
            Err(notice) => Self {
                notices: vec![notice],
                ..Self::default()
            },
        }
    }
}

impl Default for RotationEngine {
    /// The engine with the hand-made scores.
    fn default() -> Self {
        Self::new(Box::new(HandScorer::default()))
    }
}

impl Engine for RotationEngine {
    fn name(&self) -> &'static str {
        EngineKind::Rotation.name()
    }

    fn identify(&self, drawing: &Drawing, progress: Progress<'_>) -> Result<Identification> {
        let graph = Graph::new(drawing);
        check_degrees(&graph)?;
        let canonical = Canonical::new(drawing, &graph);
        let found = self.found(&canonical.drawing, progress)?;
        Ok(canonical.as_given(found))
    }
}

impl RotationEngine {
    /// The faces of a drawing, none of whose vertices is refused.
    fn found(&self, drawing: &Drawing, progress: Progress<'_>) -> Result<Identification> {
        let lifts = Readings::new(drawing);
        let directions = lifts.directions();
        let drawing = lifts.straight().unwrap_or(drawing);
        let graph = Graph::new(drawing);
        progress.report(Stage::Identify, 0.0)?;
        let triples = Triples::new(&graph);
        let scores =
            self.scorer
                .score(drawing, &graph, &triples, directions.as_deref(), progress)?;
        let mut notices = self.notices.clone();
        notices.extend(scores.notices);
        progress.report(Stage::Identify, 0.3)?;
        let field = Field::new(&graph, &triples, &scores.log_odds);
        let system = field.decode();
        progress.report(Stage::Identify, 0.6)?;
        let doubts = Doubts::new(&field, &system);
        let readings = variants(&field, system, &doubts);
        let frame = (readings.len() > 1).then(|| Frame::new(drawing, directions.as_deref()));
        let reader = Reader {
            drawing,
            readings: &lifts,
            field: &field,
            kinds: scores.kinds.as_deref(),
            frame: frame.as_ref(),
        };
        let mut sure = Vec::with_capacity(readings.len());
        let mut candidates = Vec::new();
        for (k, reading) in readings.iter().enumerate() {
            progress.report(
                Stage::Identify,
                0.6 + 0.4 * k as f64 / readings.len() as f64,
            )?;
            let doubts = Doubts::new(&field, &reading.system);
            let own = reader.candidates(reading, &doubts);
            candidates.extend(own.into_iter().map(|c| (k, c)));
            sure.push(doubts.vertices());
        }
        // Stable: of equals, the reading with the better score comes first.
        candidates.sort_by(|a, b| b.1.score.total_cmp(&a.1.score));
        candidates.truncate(CANDIDATES);
        let top = candidates.first().map_or(0.0, |(_, c)| c.score);
        candidates.iter_mut().for_each(|(_, c)| c.score -= top);
        let mut candidates = candidates.into_iter();
        let (faces, vertices) = candidates
            .next()
            .map(|(k, c)| (c.faces, sure.swap_remove(k)))
            .unwrap_or_default();
        let alternatives = candidates.map(|(_, c)| c).collect();
        progress.report(Stage::Identify, 1.0)?;
        Ok(Identification {
            engine: EngineKind::Rotation.name().to_owned(),
            faces,
            alternatives,
            notices,
            vertices,
        })
    }
}

/// Refuses edges that end freely and vertices with too many edges to be one of a solid's.
fn check_degrees(graph: &Graph) -> Result<(), IdentifyError> {
    for vertex in 0..graph.vertex_count() {
        let degree = graph.degree(vertex);
        if degree == 1 {
            return Err(IdentifyError::DanglingEdge {
                edge: graph.leaving(vertex)[0].edge() + 1,
                vertex,
            });
        }
        if degree > MAX_DEGREE {
            return Err(IdentifyError::DegreeTooHigh {
                engine: EngineKind::Rotation.name(),
                vertex,
                degree,
                limit: MAX_DEGREE,
            });
        }
    }
    Ok(())
}
