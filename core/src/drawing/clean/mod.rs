//! Clean-up of plain edge lists into a graph.
//!
//! A list of curves says where edges are, and only by nearness which ends meet. Two tolerances
//! keep what is exact apart from what is sloppy. Within the rounding of the numbers, ends are one
//! vertex, and what lies on each other or continues each other is one edge. Within the larger
//! tolerance an end is joined, or an edge cut at it, only where something is missing: a vertex
//! with fewer than three ends. In a wireframe of thirty vertices one in six has a complete vertex
//! within 2e-4 of an edge in front of or behind it, so nearness alone says nothing.
//!
//! The order matters. Pieces are joined before edges are cut at ends that lie on them: a hidden-
//! line drawing cuts an edge where another one crosses over it, and that cut must vanish, not cut
//! the other one too.

mod duplicate;
mod gather;
mod join;
mod net;
mod piece;
mod snap;
mod span;
mod split;

use glam::DVec2;

use super::format::{Raw, RawEdge};
use super::recognise::spread;
use super::{
    CleanDrawing, Curve2, Drawing, DrawingError, Edge, EllipseArc, FindingKind, Limits, Report,
    diagnose,
};
use net::Net;
pub(super) use net::names;
pub(super) use piece::Piece;
pub(super) use split::{Touch, runs_along, touches};

/// How clean-up works. Distances are relative to the drawing's size, here the largest distance of a
/// point from the mean of all, which turning the drawing does not change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CleanOptions {
    /// Distance within which an end is taken for one with another end, or on an edge, where
    /// something is missing.
    ///
    /// The default is 2e-4: end points of exported and traced drawings miss each other by less
    /// (the Faceformer release uses the same figure), and it is several times below the shortest
    /// edges of real parts (1.6e-3 of the size in 10,000 drawings). Where more than half of all ends
    /// have no partner so near, it is no limit: ends up to 1.2e-2 apart are gathered.
    pub tolerance: f64,
    /// Distance within which points are always one.
    ///
    /// The default is 5e-6: two points that were rounded to six decimals, or computed by a hidden-
    /// line algorithm, are no farther apart.
    pub rounding: f64,
}

impl Default for CleanOptions {
    fn default() -> Self {
        Self {
            tolerance: 2e-4,
            rounding: 5e-6,
        }
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
    let input = Drawing {
        id: raw.id,
        source: raw.source,
        projection: raw.projection,
        vertices: Vec::new(),
        edges: raw.edges.into_iter().map(Edge::unplaced).collect(),
        truth: None,
    };
    input.check_input(limits)?;
    let size = spread(input.edges.iter().flat_map(|e| e.points.iter().copied()));
    let reach = options.tolerance.max(options.rounding) * size;
    let exact = options.rounding * size;
    let mut net = Net {
        labels: &labels,
        vertices: Vec::new(),
        pieces: Vec::new(),
        findings: Vec::new(),
    };
    for (i, e) in input.edges.into_iter().enumerate() {
        net.take(i, e, exact);
    }
    if net.pieces.is_empty() {
        return Err(DrawingError::ZeroLength { edge: 1 });
    }
    let noise = net.tidy(reach, exact, size)?;
    net.drop_unused_vertices();
    let drawing = Drawing {
        id: input.id,
        source: input.source,
        projection: input.projection,
        vertices: net.vertices,
        edges: net.pieces.iter().map(|p| p.edge(noise)).collect(),
        truth: None,
    };
    drawing.check(limits)?;
    let sources: Vec<Vec<usize>> = net.pieces.into_iter().map(|p| p.sources).collect();
    let mut findings = net.findings;
    let names: Vec<String> = sources
        .iter()
        .map(|s| net::joint_name(&labels, s))
        .collect();
    for finding in diagnose::findings(&drawing, &names) {
        findings.push(finding.about_sources(&sources));
    }
    Ok(CleanDrawing {
        drawing,
        sources,
        report: Report {
            findings,
            tolerance: Some(reach),
        },
    })
}

/// Gives edges without vertices theirs, where their ends are within `reach` of each other; returns
/// the places of the vertices.
///
/// # Errors
/// [`DrawingError::ZeroLength`] naming an edge without points.
pub(super) fn assign_vertices(edges: &mut [Edge], reach: f64) -> Result<Vec<DVec2>, DrawingError> {
    if let Some(edge) = edges.iter().position(|e| e.points.len() < 2) {
        return Err(DrawingError::ZeroLength { edge: edge + 1 });
    }
    let ends = edges.iter().map(|e| {
        let ends = vec![e.points[0], e.points[e.points.len() - 1]];
        Piece::new(ends, Curve2::Line, 0)
    });
    let mut net = Net {
        labels: &[],
        vertices: Vec::new(),
        pieces: ends.collect(),
        findings: Vec::new(),
    };
    snap::make_vertices(&mut net, reach);
    for (e, piece) in edges.iter_mut().zip(&net.pieces) {
        e.v = piece.v;
    }
    Ok(net.vertices)
}

impl Edge {
    /// An edge of the input, without vertices and not recognised yet.
    fn unplaced(raw: RawEdge) -> Self {
        Self {
            v: [0, 0],
            points: raw.points,
            curve: Curve2::Polyline,
        }
    }
}

/// The points without those that are no farther than `least` from the one before: they say nothing
/// of where the curve goes. The ends stay.
fn apart(mut points: Vec<DVec2>, least: f64) -> Vec<DVec2> {
    let last = points[points.len() - 1];
    points.dedup_by(|p, kept| p.distance(*kept) <= least);
    if points.len() > 1 && points[points.len() - 1] != last {
        points.pop();
    }
    if points[points.len() - 1] != last {
        points.push(last);
    }
    points
}

impl Net<'_> {
    /// Takes an input edge in, unless it has no length.
    fn take(&mut self, source: usize, edge: Edge, exact: f64) {
        if edge.points.len() < 2 || edge.length() <= exact {
            let message = format!(
                "{} has no length and was left out; delete it",
                self.labels[source]
            );
            let place = edge.points.first().copied().into_iter().collect();
            self.note(FindingKind::ZeroLength, message, vec![source], place);
            return;
        }
        let points = apart(edge.points, exact);
        let curve = Curve2::recognise_within(&points, exact);
        self.pieces.push(Piece::new(points, curve, source));
    }

    /// The clean-up itself. Returns the distance within which the input turned out to be exact.
    fn tidy(&mut self, reach: f64, exact: f64, size: f64) -> Result<f64, DrawingError> {
        let gathered = gather::gather(self, reach, size);
        let wide = gathered.unwrap_or(reach);
        let mut noise = wide;
        if gathered.is_none() {
            noise = snap::estimate_noise(self, exact, reach);
            // A vertex of many ends spreads wider than its nearest pairs do.
            let spread = if noise > exact { 2.0 * noise } else { exact };
            snap::make_vertices(self, spread.min(reach));
            self.unite(noise, exact, reach)?;
        }
        let moved = snap::close_gaps(self, wide);
        let noise = noise.max(moved).min(wide);
        self.unite(noise, exact, reach)?;
        split::split_at_ends(self, wide, exact)?;
        self.unite(noise, exact, reach)?;
        Ok(noise)
    }

    /// Makes one of what lies on each other and of what continues each other, to within `noise`.
    fn unite(&mut self, noise: f64, exact: f64, reach: f64) -> Result<(), DrawingError> {
        split::split_overlaps(self, noise, reach)?;
        // Moving the ends of a curve moves its middle several times as far.
        let apart = if noise > exact { reach } else { exact };
        duplicate::merge_duplicates(self, apart);
        join::join_pieces(self, noise);
        Ok(())
    }
}

impl Piece {
    /// The finished edge.
    fn edge(&self, noise: f64) -> Edge {
        let curve = match self.curve {
            Curve2::Ellipse(arc) => {
                let traced = arc
                    .along(&self.points, self.is_closed(), noise)
                    .unwrap_or(arc);
                let off = self.points.iter().map(|p| self.foot(*p).distance);
                Curve2::Ellipse(EllipseArc {
                    residual: off.fold(0.0, f64::max),
                    ..traced
                })
            }
            other => other,
        };
        Edge {
            v: self.v,
            points: self.points.clone(),
            curve,
        }
    }
}

#[cfg(test)]
mod restore;
#[cfg(test)]
mod tests;
