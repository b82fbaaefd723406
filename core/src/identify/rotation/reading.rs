//! From a rotation system to faces: loops, their kinds and confidences, and their grouping.

use super::calibration::{self, LOOPS, VERTICES};
use super::cuts::Cuts;
use super::frame::Frame;
use super::group::{Grouping, group};
use super::looks::Looks;
use super::variants::{Variant, plausibility};
use super::{Field, LoopKinds, RotationSystem};
use crate::drawing::{CoEdge, Drawing, Graph, SurfaceKind};
use crate::identify::{Candidate, Evidence, Face};
use crate::lift::Readings;

/// Log-odds against a reading for each of its planes that no plane of the axes holds.
const BENT: f64 = 2.0;

/// What readings of one drawing share.
pub(super) struct Reader<'a> {
    pub(super) drawing: &'a Drawing,
    /// Its directions.
    pub(super) readings: &'a Readings<'a>,
    pub(super) field: &'a Field<'a>,
    pub(super) kinds: Option<&'a dyn LoopKinds>,
    /// The drawing's axes, if readings have rivals that what lifts decides between.
    pub(super) frame: Option<&'a Frame>,
}

/// How sure the choices of a rotation system are.
pub(super) struct Doubts<'a> {
    graph: &'a Graph,
    cuts: Cuts,
    /// Lead of the best order at each vertex over the second, log-odds.
    pub(super) margins: Vec<f64>,
}

impl<'a> Doubts<'a> {
    pub(super) fn new(field: &Field<'a>, system: &RotationSystem) -> Self {
        let graph = field.graph();
        let every = vec![true; graph.vertex_count()];
        let margin = |v| field.margin(system, v, &every);
        Self {
            graph,
            cuts: Cuts::new(field, system),
            margins: (0..graph.vertex_count()).map(margin).collect(),
        }
    }

    pub(super) fn cuts(&self) -> &Cuts {
        &self.cuts
    }

    /// Probability that the order at each vertex is right.
    pub(super) fn vertices(&self) -> Vec<f64> {
        let sure = |m: &f64| calibration::confidence(*m, VERTICES);
        self.margins.iter().map(sure).collect()
    }

    /// Least margin of the choices along a walk.
    fn along(&self, walk: &[CoEdge]) -> f64 {
        let at = |c: &CoEdge| {
            let (u, v) = (self.graph.origin(*c), self.graph.head(*c));
            self.margins[u].min(self.cuts.between(u, v))
        };
        walk.iter().map(at).fold(f64::INFINITY, f64::min)
    }
}

impl Reader<'_> {
    /// The faces that a reading may mean, the likeliest first; scores are log-odds, comparable
    /// between readings.
    pub(super) fn candidates(&self, variant: &Variant, doubts: &Doubts<'_>) -> Vec<Candidate> {
        let graph = self.field.graph();
        let walks = variant.system.loops();
        let looks = Looks::new(
            self.drawing,
            graph,
            self.field.triples(),
            &walks,
            self.kinds,
            self.readings.straight().is_none(),
        );
        let faces: Vec<Face> = walks
            .into_iter()
            .zip(&looks.kinds)
            .map(|(walk, &kind)| {
                let margin = doubts.along(&walk);
                let confidence = calibration::confidence(margin, LOOPS);
                Face {
                    kind,
                    loops: vec![walk],
                    confidence,
                    evidence: Evidence {
                        votes: 1,
                        margin: margin.is_finite().then_some(margin),
                        residual: None,
                        loops: vec![confidence],
                    },
                }
            })
            .collect();
        let groupings = group(self.readings, graph, &faces);
        let mut candidates: Vec<Candidate> = groupings
            .iter()
            .map(|grouping| Candidate {
                faces: merged(&faces, &looks, grouping),
                score: grouping.score,
            })
            .collect();
        let mut score = plausibility(graph, &variant.system) - variant.loss;
        if let Some(frame) = self.frame {
            let bent = faces.iter().filter(|f| f.kind == SurfaceKind::Plane);
            let bent = bent.filter(|f| frame.is_bent(f.loops[0].iter().map(|c| c.edge())));
            score -= BENT * bent.count() as f64;
        }
        candidates.iter_mut().for_each(|c| c.score += score);
        candidates
    }
}

/// The faces that a grouping makes of loops.
fn merged(loops: &[Face], looks: &Looks, grouping: &Grouping) -> Vec<Face> {
    let walk = |i: usize| {
        let mut walk = loops[i].loops[0].clone();
        if grouping.reversed[i] {
            walk.reverse();
            walk.iter_mut().for_each(|c| *c = c.mate());
        }
        walk
    };
    let faces = grouping
        .faces
        .iter()
        .zip(looks.of_faces(grouping))
        .zip(&grouping.sureness);
    faces
        .map(|((list, kind), sureness)| {
            let mut face = loops[list[0]].clone();
            face.kind = kind;
            for &i in &list[1..] {
                face.confidence = face.confidence.min(loops[i].confidence);
                let margins = [face.evidence.margin, loops[i].evidence.margin];
                face.evidence.margin = margins.into_iter().flatten().reduce(f64::min);
            }
            face.loops = list.iter().map(|&i| walk(i)).collect();
            face.evidence.loops = list.iter().map(|&i| loops[i].confidence).collect();
            face.confidence *= calibration::grouping(*sureness);
            face
        })
        .collect()
}
