//! `faceformer check`: what clean-up did to a drawing and what is wrong with it.

use std::fmt::Write as _;

use faceformer::drawing::{CleanDrawing, Graph, Projection, Severity};
use serde_json::json;

use crate::args::CheckArgs;
use crate::failure::Failure;
use crate::output::{json_line, print};
use crate::source;

/// Reports on a drawing; fails with the first error found in it.
///
/// # Errors
/// [`Failure::Unusable`] after the report if there is a finding of severity error; [`Failure::Read`]
/// and [`Failure::Drawing`] if there is no drawing at all.
pub(crate) fn run(args: &CheckArgs) -> Result<(), Failure> {
    let clean = source::load(&args.drawing)?;
    let report = if args.json {
        json_line(&as_json(&clean))?
    } else {
        as_text(&clean).into_bytes()
    };
    print(&report)?;
    let mut errors = clean
        .report
        .findings
        .iter()
        .filter(|f| f.severity == Severity::Error);
    match errors.next() {
        None => Ok(()),
        Some(first) => Err(Failure::Unusable {
            name: source::shown(&args.drawing).to_owned(),
            first: first.message.clone(),
            further: errors.count(),
        }),
    }
}

fn as_json(clean: &CleanDrawing) -> serde_json::Value {
    json!({
        "drawing": clean.drawing,
        "sources": clean.sources,
        "findings": clean.report.findings,
        "tolerance": clean.report.tolerance,
    })
}

fn as_text(clean: &CleanDrawing) -> String {
    let drawing = &clean.drawing;
    let graph = Graph::new(drawing);
    let curved = drawing.edges.iter().filter(|e| !e.is_straight()).count();
    let projection = match drawing.projection {
        Projection::Orthographic => "orthographic",
        Projection::Perspective { .. } => "perspective",
    };
    let parts = match graph.component_count() {
        1 => "1 connected part".to_owned(),
        n => format!("{n} connected parts"),
    };
    let mut text = format!(
        "{} edges ({curved} curved), {} vertices, {parts}, {projection}\n",
        graph.edge_count(),
        graph.vertex_count(),
    );
    for finding in &clean.report.findings {
        let severity = match finding.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Notice => "notice",
        };
        // Writing to a string cannot fail.
        writeln!(text, "{severity}: {}", finding.message).ok();
    }
    if clean.report.findings.is_empty() {
        text.push_str("nothing to report\n");
    }
    text
}
