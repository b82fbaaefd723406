//! Scores from a trained model.
//!
//! [`network`] is the network, [`file`](read) how it comes from disk, and [`ModelScorer`] what the
//! engine uses. A process loads a model once, when it is first asked for.

mod file;
mod network;
mod ops;
mod product;

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

pub use crate::identify::weights::ModelError;
pub use file::{LIMIT, load, read};
pub use network::{Config, Encoded, Network};

use super::inputs::Inputs;
use super::{HandScorer, LoopKinds, Scores, TripleScorer, Triples};
use crate::drawing::{CoEdge, Drawing, Graph, SurfaceKind};
use crate::lift::directions::Directions;
use crate::{Progress, Stage};

/// Most edges that the model is asked about: the attention's tables grow with their square.
pub const MAX_EDGES: usize = 2_000;

/// Environment variable that names a model file for the whole process.
pub const VARIABLE: &str = "FACEFORMER_MODEL";

/// Name that stands for "no model": the hand-made scores.
pub const NONE: &str = "none";

/// Weights and description of the model that comes with the program; `training/README.md` says how
/// it was trained.
const SHIPPED: (&[u8], &str) = (
    include_bytes!("../../../../models/rotation.safetensors"),
    include_str!("../../../../models/rotation.json"),
);

/// The model to use: by `name`, else by [`VARIABLE`], else the one that comes with the program.
/// `None` stands for the hand-made scores.
///
/// # Errors
/// What to tell the user if that model cannot be used.
pub(super) fn choose(name: Option<&str>) -> Result<Option<ModelScorer>, String> {
    let set = std::env::var(VARIABLE).ok().filter(|s| !s.is_empty());
    match name.or(set.as_deref()) {
        Some(NONE) => Ok(None),
        Some(path) => ModelScorer::open(Path::new(path))
            .map(Some)
            .map_err(|e| format!("the model {path} is not used, the hand-made scores are: {e}")),
        None => shipped().map(Some).map_err(|e| {
            format!("the program's own model is not used, the hand-made scores are: {e}")
        }),
    }
}

/// The model that comes with the program, made once a process.
fn shipped() -> Result<ModelScorer, ModelError> {
    static MADE: OnceLock<Result<ModelScorer, ModelError>> = OnceLock::new();
    let (weights, text) = SHIPPED;
    let make = || load(weights.to_vec(), text).map(ModelScorer::new);
    MADE.get_or_init(make).clone()
}

/// Scores triples and tells kinds of loops by a trained model.
#[derive(Debug, Clone)]
pub struct ModelScorer {
    network: Arc<Network>,
}

impl ModelScorer {
    /// A scorer with that network.
    pub fn new(network: Network) -> Self {
        Self {
            network: Arc::new(network),
        }
    }

    /// The model in a file, read once a process.
    ///
    /// # Errors
    /// [`ModelError`]; a file that failed is tried anew when it is asked for again.
    pub fn open(path: &Path) -> Result<Self, ModelError> {
        static OPENED: Mutex<Option<HashMap<PathBuf, ModelScorer>>> = Mutex::new(None);
        let mut opened = OPENED.lock().unwrap_or_else(PoisonError::into_inner);
        let opened = opened.get_or_insert_default();
        if let Some(known) = opened.get(path) {
            return Ok(known.clone());
        }
        let scorer = Self::new(read(path)?);
        opened.insert(path.to_path_buf(), scorer.clone());
        Ok(scorer)
    }
}

impl TripleScorer for ModelScorer {
    fn score(
        &self,
        drawing: &Drawing,
        graph: &Graph,
        triples: &Triples,
        directions: Option<&Directions>,
        progress: Progress<'_>,
    ) -> crate::Result<Scores> {
        if graph.edge_count() > MAX_EDGES {
            let mut scores =
                HandScorer::default().score(drawing, graph, triples, directions, progress)?;
            scores.notices.push(format!(
                "the drawing has {} edges, more than the {MAX_EDGES} that the model takes; the \
                 hand-made scores are used",
                graph.edge_count()
            ));
            return Ok(scores);
        }
        let inputs = Inputs::with_directions(drawing, graph, triples, directions);
        progress.report(Stage::Identify, 0.1)?;
        // The tables fit each other and the network was checked, so candle cannot fail; if it does
        // all the same, the hand-made scores are as good as ever.
        let encoded = match self.network.encode(&inputs) {
            Ok(encoded) if encoded.scores.iter().all(|s| s.is_finite()) => encoded,
            failed => {
                let why = failed.map_or_else(|e| e.to_string(), |_| "no finite scores".to_owned());
                let mut scores =
                    Scores::from(inputs.hand.iter().map(|&x| x.into()).collect::<Vec<f64>>());
                scores.notices.push(format!(
                    "the model failed ({why}); the hand-made scores are used"
                ));
                return Ok(scores);
            }
        };
        Ok(Scores {
            log_odds: encoded.scores.iter().map(|&s| s.into()).collect(),
            kinds: Some(Box::new(Kinds {
                network: Arc::clone(&self.network),
                encoded,
            })),
            notices: Vec::new(),
        })
    }
}

/// The head that tells kinds, for one encoded drawing.
struct Kinds {
    network: Arc<Network>,
    encoded: Encoded,
}

impl LoopKinds for Kinds {
    fn kinds(
        &self,
        graph: &Graph,
        triples: &Triples,
        loops: &[Vec<CoEdge>],
    ) -> Vec<[f64; SurfaceKind::ALL.len()]> {
        let steps: Vec<Vec<(usize, usize)>> = loops
            .iter()
            .map(|walk| {
                let n = walk.len();
                let step = |k: usize| {
                    let before = graph.position(walk[(k + n - 1) % n].mate());
                    let after = graph.position(walk[(k + 1) % n]);
                    (triples.index(graph, walk[k], before, after), walk[k].edge())
                };
                (0..n).map(step).collect()
            })
            .collect();
        let Ok(logits) = self.network.kinds(&self.encoded, &steps) else {
            return vec![
                [1.0 / SurfaceKind::ALL.len() as f64; SurfaceKind::ALL.len()];
                loops.len()
            ];
        };
        logits.iter().map(|row| probabilities(row)).collect()
    }
}

/// Probabilities of what has these logits.
fn probabilities(logits: &[f32]) -> [f64; SurfaceKind::ALL.len()] {
    let largest = logits.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let mut shares = [0.0; SurfaceKind::ALL.len()];
    for (share, &x) in shares.iter_mut().zip(logits) {
        *share = f64::from(x - largest).exp();
    }
    let sum: f64 = shares.iter().sum();
    shares.map(|x| x / sum)
}

#[cfg(test)]
mod tests;
