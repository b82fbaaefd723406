//! Clean-up of plain edge lists into a graph.

mod snap;

use glam::DVec2;

use super::format::{Raw, RawEdge};
use super::{
    CleanDrawing, Curve2, Drawing, DrawingError, Edge, Finding, FindingKind, Limits, Report,
    Severity, diagnose,
};

/// How clean-up works.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CleanOptions {
    /// Distance within which points are one, relative to the drawing's size.
    ///
    /// The default is 2e-4: end points of exported and traced drawings miss each other by less
    /// (the Faceformer release uses the same figure), and it is several times below the shortest
    /// edges of real parts (1.6e-3 of the size in 50,000 drawings).
    pub tolerance: f64,
}

impl Default for CleanOptions {
    fn default() -> Self {
        Self { tolerance: 2e-4 }
    }
}

/// Turns a list of polylines into a drawing.
///
/// # Errors
/// [`DrawingError`] if the list is empty, too large or has numbers that are not finite.
pub fn clean(
    polylines: &[Vec<DVec2>],
    options: &CleanOptions,
    limits: &Limits,
) -> Result<CleanDrawing, DrawingError> {
    let edges = polylines.iter().map(|points| RawEdge {
        points: points.clone(),
        ..RawEdge::default()
    });
    let raw = Raw {
        edges: edges.collect(),
        ..Raw::default()
    };
    clean_raw(raw, options, limits)
}

pub(super) fn clean_raw(
    raw: Raw,
    options: &CleanOptions,
    limits: &Limits,
) -> Result<CleanDrawing, DrawingError> {
    let labels = raw.labels();
    let mut drawing = Drawing {
        id: raw.id,
        source: raw.source,
        projection: raw.projection,
        vertices: Vec::new(),
        edges: raw
            .edges
            .into_iter()
            .map(|e| Edge {
                v: [0, 0],
                points: e.points,
                curve: Curve2::Polyline,
            })
            .collect(),
        truth: None,
    };
    let size = drawing.check_input(limits)?;
    let tolerance = options.tolerance * size;
    let mut findings = Vec::new();
    let mut sources = Vec::new();
    let mut kept = Vec::new();
    for (i, e) in drawing.edges.drain(..).enumerate() {
        if e.length() > tolerance {
            sources.push(vec![i]);
            kept.push(e);
        } else {
            findings.push(Finding {
                severity: Severity::Notice,
                kind: FindingKind::ZeroLength,
                message: format!("{} has no length and was left out; delete it", labels[i]),
                edges: vec![i],
                vertices: Vec::new(),
                points: e.points.first().copied().into_iter().collect(),
            });
        }
    }
    drawing.edges = kept;
    snap::snap(&mut drawing, tolerance);
    for e in &mut drawing.edges {
        e.curve = Curve2::recognise(&e.points);
    }
    drawing.check(limits)?;
    let names: Vec<String> = sources.iter().map(|s| labels[s[0]].clone()).collect();
    findings.extend(
        diagnose::findings(&drawing, &names)
            .into_iter()
            .map(|f| Finding {
                edges: f.edges.iter().flat_map(|&e| sources[e].clone()).collect(),
                ..f
            }),
    );
    Ok(CleanDrawing {
        drawing,
        sources,
        report: Report {
            findings,
            tolerance: Some(tolerance),
        },
    })
}
