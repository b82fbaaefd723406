//! The engine: score, decode, read off loops.

use super::cuts::Cuts;
use super::group::{Grouping, group};
use super::{Field, HandScorer, TripleScorer, Triples, model};
use crate::drawing::{CoEdge, Drawing, Graph, SurfaceKind};
use crate::identify::kinds::kinds_of;
use crate::identify::{
    Candidate, Engine, EngineKind, Evidence, Face, Identification, IdentifyError,
};
use crate::{Progress, Result, Stage};

/// Most edges at one vertex that the engine handles.
pub const MAX_DEGREE: usize = 24;

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
    /// the environment variable [`model::VARIABLE`], else the one that comes with the program, if
    /// there is one.
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
        progress.report(Stage::Identify, 0.0)?;
        let triples = Triples::new(&graph);
        let scores = self.scorer.score(drawing, &graph, &triples, progress)?;
        let mut notices = self.notices.clone();
        notices.extend(scores.notices);
        progress.report(Stage::Identify, 0.3)?;
        let field = Field::new(&graph, &triples, &scores.log_odds);
        let system = field.decode();
        progress.report(Stage::Identify, 0.6)?;
        let cuts = Cuts::new(&field, &system);
        let every = vec![true; graph.vertex_count()];
        let sureness: Vec<f64> = (0..graph.vertex_count())
            .map(|v| field.best_order(&system, v, &every).margin)
            .collect();
        let margin = |walk: &[CoEdge]| {
            let at = |c: &CoEdge| {
                let (u, v) = (graph.origin(*c), graph.head(*c));
                sureness[u].min(cuts.between(u, v))
            };
            walk.iter().map(at).fold(f64::INFINITY, f64::min)
        };
        let walks = system.loops();
        let kinds: Vec<SurfaceKind> = match &scores.kinds {
            Some(told) => {
                let kinds = told.kinds(&graph, &triples, &walks);
                kinds.into_iter().map(|(kind, _)| kind).collect()
            }
            None => kinds_of(
                drawing,
                &walks.iter().map(Vec::as_slice).collect::<Vec<_>>(),
            ),
        };
        let faces: Vec<Face> = walks
            .into_iter()
            .zip(kinds)
            .map(|(walk, kind)| {
                let margin = margin(&walk);
                Face {
                    kind,
                    loops: vec![walk],
                    confidence: confidence(margin),
                    evidence: Evidence {
                        votes: 1,
                        margin: margin.is_finite().then_some(margin),
                        residual: None,
                    },
                }
            })
            .collect();
        progress.report(Stage::Identify, 0.7)?;
        let mut candidates = group(drawing, &graph, &faces)
            .into_iter()
            .map(|grouping| Candidate {
                faces: merged(&faces, &grouping),
                score: grouping.score,
            });
        let best = candidates.next().map_or(faces.clone(), |c| c.faces);
        let alternatives = candidates.collect();
        progress.report(Stage::Identify, 1.0)?;
        Ok(Identification {
            engine: self.name().to_owned(),
            faces: best,
            alternatives,
            notices,
        })
    }
}

/// Probability that a loop is right whose least sure decision is ahead by `margin` log-odds.
fn confidence(margin: f64) -> f64 {
    1.0 / (1.0 + (-margin).exp())
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

/// The faces that a grouping makes of loops.
fn merged(loops: &[Face], grouping: &Grouping) -> Vec<Face> {
    let walk = |i: usize| {
        let mut walk = loops[i].loops[0].clone();
        if grouping.reversed[i] {
            walk.reverse();
            walk.iter_mut().for_each(|c| *c = c.mate());
        }
        walk
    };
    let whole = |list: &[usize]| {
        let kinds = list.iter().map(|&i| loops[i].kind);
        // Two circles with nothing drawn between them: of what they bound a cone is likeliest.
        let curved = |k: &SurfaceKind| *k != SurfaceKind::Plane;
        kinds.filter(curved).min().unwrap_or(SurfaceKind::Cone)
    };
    let faces = grouping
        .faces
        .iter()
        .zip(grouping.sureness.iter().zip(&grouping.round));
    faces
        .map(|(list, (sureness, round))| {
            let mut face = loops[list[0]].clone();
            if *round {
                face.kind = whole(list);
            }
            for &i in &list[1..] {
                face.confidence = face.confidence.min(loops[i].confidence);
                let margins = [face.evidence.margin, loops[i].evidence.margin];
                face.evidence.margin = margins.into_iter().flatten().reduce(f64::min);
            }
            face.loops = list.iter().map(|&i| walk(i)).collect();
            face.confidence *= sureness;
            face
        })
        .collect()
}
