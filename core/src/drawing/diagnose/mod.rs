//! Diagnosis of a drawing before any identification.

use super::{Drawing, Finding, FindingKind, Graph, Severity};

/// What is doubtful about a drawing, most serious first. Edges are indices into the drawing.
pub fn diagnose(drawing: &Drawing) -> Vec<Finding> {
    let labels: Vec<String> = (1..=drawing.edges.len())
        .map(|k| format!("edge {k}"))
        .collect();
    findings(drawing, &labels)
}

/// [`diagnose`], calling the edges by the given names.
pub(super) fn findings(drawing: &Drawing, labels: &[String]) -> Vec<Finding> {
    let graph = Graph::new(drawing);
    let mut findings = Vec::new();
    for v in 0..graph.vertex_count() {
        if let &[c] = graph.leaving(v) {
            findings.push(Finding {
                severity: Severity::Error,
                kind: FindingKind::Dangling,
                message: format!(
                    "{} ends where no other edge does; connect that end or delete the edge",
                    labels[c.edge()]
                ),
                edges: vec![c.edge()],
                vertices: vec![v],
                points: vec![drawing.vertices[v]],
            });
        }
    }
    findings
}
