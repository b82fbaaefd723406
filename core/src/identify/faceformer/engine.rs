//! The engine: encode, decode, read off faces, post-process.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::inputs::Inputs;
use super::walk::Walks;
use super::{Found, Network, TOKENS, Variant, search};
use crate::drawing::{CoEdge, Drawing, Graph, SurfaceKind};
use crate::identify::kinds::kind_of;
use crate::identify::postprocess::{Prediction, postprocess};
use crate::identify::rotation::model::{NONE, VARIABLE};
use crate::identify::{Engine, EngineKind, Identification, IdentifyError, ModelError, orient};
use crate::{Progress, Result, Stage};

/// Weights and description of the model that comes with the program; `training/README.md` says how
/// it was trained.
const SHIPPED: (&[u8], &str) = (
    include_bytes!("../../../models/faceformer.safetensors"),
    include_str!("../../../models/faceformer.json"),
);

/// What the user is told of it.
const SMALL: &str = "the program's own model of the engine faceformer is a tenth of the paper's in size and trained \
     for about an hour and a half on one CPU core: it shows the method, not the paper's accuracy";

/// How sequences are decoded. The default is the paper's setting.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DecodeOptions {
    /// Whether tokens see only those before them, as in training. The authors' released program
    /// decodes without that mask.
    pub causal: bool,
    /// Sequences that are kept from each start; 1 is greedy.
    pub beam: usize,
    /// Allow only co-edges that continue the walk.
    pub walks_only: bool,
}

impl Default for DecodeOptions {
    fn default() -> Self {
        Self {
            causal: true,
            beam: 1,
            walks_only: false,
        }
    }
}

/// Faces from a trained pointer network; see the [module](super).
#[derive(Debug)]
pub struct FaceformerEngine {
    variant: Variant,
    network: std::result::Result<Arc<Network>, IdentifyError>,
    options: DecodeOptions,
    notices: Vec<String>,
}

impl FaceformerEngine {
    /// The engine with that network, of the variant that the network is.
    pub fn new(network: Network, options: DecodeOptions) -> Self {
        Self {
            variant: network.config().variant,
            network: Ok(Arc::new(network)),
            options,
            notices: Vec::new(),
        }
    }

    /// The engine with the model in the file `name`, or in the one that the environment variable
    /// [`VARIABLE`] names, or with the small one of the variant [`Variant::Faceformer`] that comes
    /// with the program.
    ///
    /// If there is none, or it cannot be used, every drawing is refused with the reason: unlike the
    /// rotation engine this one can do nothing without.
    pub fn with_model(variant: Variant, name: Option<&str>, options: DecodeOptions) -> Self {
        let set = std::env::var(VARIABLE).ok().filter(|s| !s.is_empty());
        let engine = kind(variant).name();
        let name = name.or(set.as_deref());
        let own = name.is_none() && variant == Variant::Faceformer;
        let network = match name {
            None if own => shipped().map_err(|e| IdentifyError::Model {
                engine,
                what: e.to_string(),
            }),
            None | Some(NONE) => Err(IdentifyError::NoModel { engine }),
            Some(path) => open(Path::new(path))
                .map_err(|e| format!("{path}: {e}"))
                .and_then(|network| match network.config().variant {
                    own if own == variant => Ok(network),
                    own => Err(format!("{path}: it is for the engine {}", kind(own))),
                })
                .map_err(|what| IdentifyError::Model { engine, what }),
        };
        Self {
            variant,
            network,
            options,
            notices: if own {
                vec![SMALL.to_owned()]
            } else {
                Vec::new()
            },
        }
    }

    fn failed(&self, error: candle_core::Error) -> IdentifyError {
        IdentifyError::Model {
            engine: self.name(),
            what: error.to_string(),
        }
    }
}

/// The engine's name by the variant.
fn kind(variant: Variant) -> EngineKind {
    match variant {
        Variant::Faceformer => EngineKind::Faceformer,
        Variant::Seq2seqCoedge => EngineKind::Seq2seqCoedge,
        Variant::Seq2seq => EngineKind::Seq2seq,
    }
}

/// The model that comes with the program, made once a process.
fn shipped() -> std::result::Result<Arc<Network>, ModelError> {
    static MADE: OnceLock<std::result::Result<Arc<Network>, ModelError>> = OnceLock::new();
    let (weights, text) = SHIPPED;
    let make = || Network::load(weights.to_vec(), text).map(Arc::new);
    MADE.get_or_init(make).clone()
}

/// The network in a file, read once a process; a file that failed is tried anew.
fn open(path: &Path) -> std::result::Result<Arc<Network>, ModelError> {
    static OPENED: Mutex<Option<HashMap<PathBuf, Arc<Network>>>> = Mutex::new(None);
    let mut opened = OPENED.lock().unwrap_or_else(PoisonError::into_inner);
    let opened = opened.get_or_insert_default();
    if let Some(known) = opened.get(path) {
        return Ok(Arc::clone(known));
    }
    let network = Arc::new(Network::read(path)?);
    opened.insert(path.to_path_buf(), Arc::clone(&network));
    Ok(network)
}

impl Engine for FaceformerEngine {
    fn name(&self) -> &'static str {
        kind(self.variant).name()
    }

    fn identify(&self, drawing: &Drawing, progress: Progress<'_>) -> Result<Identification> {
        let network = self.network.as_ref().map_err(Clone::clone)?;
        let config = network.config();
        let graph = Graph::new(drawing);
        progress.report(Stage::Identify, 0.0)?;
        let inputs = Inputs::new(drawing, self.variant, config.frame, config.points);
        let tokens = inputs.coedges.len();
        if tokens > config.inputs {
            let per_edge = tokens / graph.edge_count();
            return Err(IdentifyError::TooManyEdges {
                engine: self.name(),
                edges: graph.edge_count(),
                limit: config.inputs / per_edge,
            }
            .into());
        }
        let memory = network.encode(&inputs.points).map_err(|e| self.failed(e))?;
        progress.report(Stage::Identify, 0.1)?;
        let starts: Vec<u32> = match self.variant {
            Variant::Faceformer => (TOKENS..TOKENS + tokens).map(|t| t as u32).collect(),
            _ => vec![Variant::SOS],
        };
        let walks = Walks::new(&graph, &inputs.coedges, self.variant, config.further_loops);
        let found = search(
            &mut network.decode(&memory, self.options.causal),
            self.variant,
            &starts,
            config.steps,
            self.options.beam,
            |tokens, logits| {
                if self.options.walks_only {
                    walks.forbid(tokens, logits);
                }
            },
            |share| progress.report(Stage::Identify, 0.1 + 0.8 * share),
        )?
        .map_err(|e| self.failed(e))?;
        let mut faces = match self.variant {
            Variant::Faceformer => {
                let predictions: Vec<Prediction> = found
                    .iter()
                    .filter_map(|f| one_face(f, &inputs.coedges))
                    .collect();
                postprocess(&graph, &predictions).faces
            }
            Variant::Seq2seqCoedge | Variant::Seq2seq => {
                self.all_faces(&found[0], &inputs.coedges, drawing, &graph)
            }
        };
        if faces.is_empty() {
            return Err(IdentifyError::NoFaces {
                engine: self.name(),
                edge: 1,
            }
            .into());
        }
        orient(&graph, &mut faces);
        progress.report(Stage::Identify, 1.0)?;
        Ok(Identification {
            engine: self.name().to_owned(),
            faces,
            alternatives: Vec::new(),
            notices: self.notices.clone(),
            vertices: Vec::new(),
        })
    }
}

impl FaceformerEngine {
    /// The faces of a sequence of all of them. It tells no types, so they are told by the look of the
    /// first loop; a face's confidence is the probability of its tokens.
    fn all_faces(
        &self,
        found: &Found,
        coedges: &[CoEdge],
        drawing: &Drawing,
        graph: &Graph,
    ) -> Vec<crate::identify::Face> {
        let mut faces = Vec::new();
        for (tokens, log_probability) in cut(found) {
            let mut face: Vec<CoEdge> = tokens
                .iter()
                .map(|&t| coedges[t as usize - TOKENS])
                .collect();
            if self.variant == Variant::Seq2seq {
                face = directed(graph, &face);
            }
            let prediction = Prediction {
                kind: SurfaceKind::Plane,
                coedges: face,
                votes: 1,
            };
            for mut face in postprocess(graph, &[prediction]).faces {
                let set = face.edge_set();
                if faces
                    .iter()
                    .any(|f: &crate::identify::Face| f.edge_set() == set)
                {
                    continue;
                }
                face.kind = kind_of(drawing, &face.loops[0]);
                face.confidence = log_probability.exp();
                faces.push(face);
            }
        }
        faces
    }
}

/// The face that was decoded from one start, if it ended.
fn one_face(found: &Found, coedges: &[CoEdge]) -> Option<Prediction> {
    let (&end, face) = found.tokens.split_last()?;
    let kind = match end {
        1 => SurfaceKind::Plane,
        2 => SurfaceKind::Cylinder,
        3 => SurfaceKind::Other,
        _ => return None,
    };
    Some(Prediction {
        kind,
        coedges: face.iter().map(|&t| coedges[t as usize - TOKENS]).collect(),
        votes: 1,
    })
}

/// Cuts a sequence of all faces into its faces, each with its log-probability, its end included. What
/// follows the last end is left out: it is part of a face only.
fn cut(found: &Found) -> Vec<(Vec<u32>, f64)> {
    let mut faces = Vec::new();
    let (mut face, mut sum) = (Vec::new(), 0.0);
    for (&token, &log_probability) in found.tokens[1..].iter().zip(&found.log_probabilities) {
        sum += f64::from(log_probability);
        if token >= TOKENS as u32 {
            face.push(token);
            continue;
        }
        if !face.is_empty() {
            faces.push((std::mem::take(&mut face), sum));
        }
        sum = 0.0;
    }
    faces
}

/// Directs a set of edges so that they are closed walks, where they can be: every walk goes on along
/// the first unused edge until it is back where it began.
fn directed(graph: &Graph, edges: &[CoEdge]) -> Vec<CoEdge> {
    let mut left: Vec<CoEdge> = edges.to_vec();
    let mut walks = Vec::with_capacity(left.len());
    while !left.is_empty() {
        let first = left.remove(0);
        let start = graph.origin(first);
        let mut last = first;
        walks.push(first);
        while graph.head(last) != start {
            let at = graph.head(last);
            let onward = left
                .iter()
                .position(|&c| graph.origin(c) == at || graph.head(c) == at);
            let Some(place) = onward else {
                break;
            };
            let c = left.remove(place);
            last = if graph.origin(c) == at { c } else { c.mate() };
            walks.push(last);
        }
    }
    walks
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::testing;

    #[test]
    fn a_set_of_edges_becomes_closed_walks() {
        let drawing = testing::holed_cube();
        let graph = Graph::new(&drawing);
        for face in &drawing.truth.as_ref().unwrap().faces {
            let mut edges: Vec<CoEdge> = face
                .loops
                .iter()
                .flatten()
                .map(|c| CoEdge::new(c.edge(), false))
                .collect();
            edges.sort();
            let prediction = Prediction {
                kind: SurfaceKind::Plane,
                coedges: directed(&graph, &edges),
                votes: 1,
            };
            let faces = postprocess(&graph, &[prediction]).faces;
            assert_eq!(faces.len(), 1);
            assert_eq!(faces[0].loops.len(), face.loops.len());
        }
        // Three edges of a square are no walk.
        let open = [0, 1, 2].map(|e| CoEdge::new(e, false));
        let prediction = Prediction {
            kind: SurfaceKind::Plane,
            coedges: directed(&graph, &open),
            votes: 1,
        };
        assert_eq!(postprocess(&graph, &[prediction]).unclosed, 1);
    }

    #[test]
    fn sequences_are_cut_at_their_separators() {
        let found = Found {
            tokens: vec![1, 4, 5, 2, 6, 7, 3],
            log_probabilities: vec![-1.0; 6],
            ended: true,
        };
        assert_eq!(cut(&found), [(vec![4, 5], -3.0), (vec![6, 7], -3.0)]);
        let unended = Found {
            tokens: vec![1, 4, 5, 2, 6, 7],
            log_probabilities: vec![-1.0; 5],
            ended: false,
        };
        assert_eq!(cut(&unended), [(vec![4, 5], -3.0)]);
    }

    #[test]
    fn the_end_of_a_sequence_is_the_type() {
        let coedges: Vec<CoEdge> = (0..4).map(CoEdge::from_index).collect();
        let found = |end| Found {
            tokens: vec![7, 4, end],
            log_probabilities: vec![0.0; 2],
            ended: true,
        };
        let face = one_face(&found(2), &coedges).unwrap();
        assert_eq!(face.kind, SurfaceKind::Cylinder);
        assert_eq!(face.coedges, [coedges[3], coedges[0]]);
        assert_eq!(one_face(&found(5), &coedges), None);
    }
}
