//! Diagnosis of a drawing before any identification.
//!
//! Findings come by severity: what no solid can be drawn like, what is probably a mistake, and what
//! is worth knowing.

mod parts;

use std::collections::{HashMap, HashSet};

use super::clean::{Piece, Touch, names, runs_along, touches};
use super::{Drawing, Finding, FindingKind, Graph, Severity};

/// Distance within which an end lies on an edge by intent where something is missing at it,
/// relative to the drawing's size; the tolerance of clean-up.
const NEAR: f64 = 2e-4;

/// Distance within which a complete vertex lies on an edge by intent: in a projection many come
/// nearer than [`NEAR`] by chance.
const EXACT: f64 = 5e-6;

/// Touches that are looked at; a drawing with more has said enough.
const MOST_TOUCHES: usize = 10_000;

/// Most edges that are usual at a vertex. Rotation systems, of which there are (d - 1)! at a
/// vertex, are out of reach soon after.
const USUAL_DEGREE: usize = 8;

/// What is doubtful about a drawing, most serious first. Edges are indices into the drawing.
pub fn diagnose(drawing: &Drawing) -> Vec<Finding> {
    let labels: Vec<String> = (1..=drawing.edges.len())
        .map(|k| format!("edge {k}"))
        .collect();
    findings(drawing, &labels)
}

/// [`diagnose`], calling the edges by the given names.
pub(super) fn findings(drawing: &Drawing, labels: &[String]) -> Vec<Finding> {
    let case = Case {
        drawing,
        labels,
        graph: Graph::new(drawing),
        size: drawing.size(),
    };
    let mut findings = case.vertices();
    findings.extend(case.touches());
    findings.extend(case.twins());
    findings.extend(parts::findings(&case));
    findings.sort_by_key(|f| f.severity);
    findings
}

/// A drawing under diagnosis.
struct Case<'a> {
    drawing: &'a Drawing,
    labels: &'a [String],
    graph: Graph,
    size: f64,
}

impl Case<'_> {
    fn finding(
        &self,
        severity: Severity,
        kind: FindingKind,
        message: String,
        edges: Vec<usize>,
        vertices: Vec<usize>,
    ) -> Finding {
        Finding {
            severity,
            kind,
            message,
            edges,
            points: vertices.iter().map(|&v| self.drawing.vertices[v]).collect(),
            vertices,
        }
    }

    /// Edges at a vertex, without repeats.
    fn edges_at(&self, v: usize) -> Vec<usize> {
        let mut edges: Vec<usize> = self.graph.leaving(v).iter().map(|c| c.edge()).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// Vertices with too few edges or very many.
    fn vertices(&self) -> Vec<Finding> {
        let mut found = Vec::new();
        for v in 0..self.graph.vertex_count() {
            let edges = self.edges_at(v);
            let name = names(self.labels, &edges);
            match (self.graph.degree(v), edges.len()) {
                (1, _) => found.push(self.finding(
                    Severity::Error,
                    FindingKind::Dangling,
                    format!(
                        "{name} ends where no other edge does; \
                         connect that end or delete the edge"
                    ),
                    edges,
                    vec![v],
                )),
                (2, 2) => found.push(self.finding(
                    Severity::Notice,
                    FindingKind::DegreeTwo,
                    format!(
                        "only {name} meet at a vertex, where solids nearly always have three \
                         edges; look whether one is missing there"
                    ),
                    edges,
                    vec![v],
                )),
                (degree, _) if degree > USUAL_DEGREE => found.push(self.finding(
                    Severity::Warning,
                    FindingKind::HighDegree,
                    format!(
                        "{degree} edges meet at one vertex ({name}); solids hardly ever have more \
                         than {USUAL_DEGREE}, so look whether several vertices fell together"
                    ),
                    edges,
                    vec![v],
                )),
                _ => {}
            }
        }
        found
    }

    /// Vertices on the inside of edges, and edges that lie on each other along a stretch.
    fn touches(&self) -> Vec<Finding> {
        let pieces: Vec<Piece> = self.drawing.edges.iter().enumerate().map(piece).collect();
        let reach = NEAR * self.size;
        let mut found = Vec::new();
        let mut told = HashSet::new();
        for touch in touches(&pieces, &self.drawing.vertices, reach, reach, MOST_TOUCHES) {
            let on = touch.piece;
            let ending = self.edges_at(touch.vertex);
            let along =
                |&&e: &&usize| runs_along(&pieces[on], &touch, &pieces[e], EXACT * self.size);
            if let Some(&other) = ending.iter().find(along) {
                // Each of the two may end on the other.
                if told.insert([on.min(other), on.max(other)]) {
                    found.push(self.overlap(vec![on.min(other), on.max(other)], touch.vertex));
                }
            } else if self.is_meant(&touch) {
                found.push(self.t_junction(on, ending, touch.vertex));
            }
        }
        found
    }

    fn overlap(&self, edges: Vec<usize>, vertex: usize) -> Finding {
        let message = format!(
            "{} lie on each other along a stretch; delete what is there twice, or turn the solid a \
             little before drawing it",
            names(self.labels, &edges)
        );
        let kind = FindingKind::Overlap;
        self.finding(Severity::Warning, kind, message, edges, vec![vertex])
    }

    fn t_junction(&self, on: usize, ending: Vec<usize>, vertex: usize) -> Finding {
        let label = &self.labels[on];
        let message = format!(
            "the end of {} lies on the inside of {label}; if they meet there, cut {label} at that \
             point",
            names(self.labels, &ending)
        );
        let edges = [vec![on], ending].concat();
        let kind = FindingKind::TJunction;
        self.finding(Severity::Warning, kind, message, edges, vec![vertex])
    }

    /// Whether a vertex on an edge is more than an accident of the projection.
    fn is_meant(&self, touch: &Touch) -> bool {
        let edges = self.edges_at(touch.vertex).len();
        let degree = self.graph.degree(touch.vertex);
        let wanting = degree == 1 || (degree == 2 && edges == 2);
        wanting || touch.foot.distance <= EXACT * self.size
    }

    /// Edges with the same ends and the same curve.
    fn twins(&self) -> Vec<Finding> {
        let mut found = Vec::new();
        let mut by_ends: HashMap<[usize; 2], Vec<Piece>> = HashMap::new();
        for (i, e) in self.drawing.edges.iter().enumerate() {
            let [a, b] = e.v;
            let others = by_ends.entry([a.min(b), a.max(b)]).or_default();
            let this = piece((i, e));
            let reach = EXACT * self.size;
            let twin = others
                .iter()
                .find(|o| this.lies_on(o, reach) && o.lies_on(&this, reach));
            let Some(twin) = twin else {
                others.push(this);
                continue;
            };
            found.push(self.overlap(vec![twin.sources[0], i], a));
        }
        found
    }
}

/// An edge of the drawing with the geometry of clean-up.
fn piece((index, edge): (usize, &super::Edge)) -> Piece {
    let mut piece = Piece::new(edge.points.clone(), edge.curve, index);
    piece.v = edge.v;
    piece
}

#[cfg(test)]
mod tests;
