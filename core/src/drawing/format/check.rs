//! What makes a drawing valid: the promises of [`Drawing`] that every later stage relies on.

use glam::DVec2;

use super::super::{Curve2, Drawing, DrawingError, Edge, Limits, Projection, Truth};
use super::parse::Raw;

/// Largest distance of an edge's end from its vertex, relative to the drawing's size. Files round
/// their numbers, and a hundredth of a percent is below what can be seen.
const END_GAP: f64 = 1e-4;

/// Shortest edge, relative to the drawing's size: below the rounding of ordinary files an edge has
/// no direction.
const SHORTEST: f64 = 1e-6;

/// Error of the coordinates of a drawing that is taken at its word, relative to its size: files
/// have six decimals.
const ROUNDING: f64 = 2e-6;

/// Sizes in which squares and their products neither overflow nor vanish.
const SIZES: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// Largest distance from the origin, in sizes: beyond it doubles cannot tell the points apart to
/// better than the tolerances used here.
const FARTHEST: f64 = 1e8;

impl Raw {
    /// The drawing that an interchange file describes; its curves are not recognised yet.
    pub(super) fn into_drawing(self) -> Result<Drawing, DrawingError> {
        let vertices = self
            .vertices
            .ok_or_else(|| DrawingError::Format("missing field `vertices`".into()))?;
        let edges = (1..).zip(self.edges).map(|(edge, e)| {
            let v = e.v.ok_or(DrawingError::NoVertices { edge })?;
            Ok(Edge {
                v,
                points: e.points,
                curve: Curve2::Polyline,
            })
        });
        Ok(Drawing {
            id: self.id,
            source: self.source,
            projection: self.projection,
            vertices,
            edges: edges.collect::<Result<_, _>>()?,
            truth: self.truth,
        })
    }
}

impl Drawing {
    /// Checks everything that later stages rely on: sizes within `limits`, finite numbers, edges
    /// that have a length and end at vertices that exist (to 1e-4 of the size), no vertex without
    /// an edge, and a truth that fits.
    ///
    /// # Errors
    /// [`DrawingError`] with the first thing that is wrong.
    pub fn check(&self, limits: &Limits) -> Result<(), DrawingError> {
        self.check_limits(limits)?;
        self.check_numbers()?;
        let size = check_size(self)?;
        let mut used = vec![false; self.vertices.len()];
        for (edge, e) in (1..).zip(&self.edges) {
            self.check_edge(edge, e, size)?;
            for v in e.v {
                used[v] = true;
            }
        }
        if let Some(vertex) = used.iter().position(|u| !u) {
            return Err(DrawingError::UnusedVertex { vertex });
        }
        match &self.truth {
            Some(truth) => self.check_truth(truth),
            None => Ok(()),
        }
    }

    /// Checks an input that has no vertices yet; returns its size.
    pub(in super::super) fn check_input(&self, limits: &Limits) -> Result<f64, DrawingError> {
        self.check_limits(limits)?;
        self.check_numbers()?;
        check_size(self)
    }

    /// The same drawing with end points moved onto their vertices and every curve recognised.
    pub(super) fn recognised(mut self) -> Self {
        let noise = ROUNDING * self.size();
        for e in &mut self.edges {
            let ends = e.v.map(|v| self.vertices[v]);
            if let [first, .., last] = e.points.as_mut_slice() {
                *first = ends[0];
                *last = ends[1];
            }
            e.curve = Curve2::recognise_within(&e.points, noise);
        }
        self
    }

    fn check_limits(&self, limits: &Limits) -> Result<(), DrawingError> {
        let within = |what, found, limit| match found > limit {
            true => Err(DrawingError::TooLarge { what, found, limit }),
            false => Ok(()),
        };
        within("edges", self.edges.len(), limits.edges)?;
        within(
            "vertices",
            self.vertices.len(),
            limits.edges.saturating_mul(2),
        )?;
        let mut total = 0;
        for e in &self.edges {
            within("points in one edge", e.points.len(), limits.points)?;
            total += e.points.len();
        }
        within("points", total, limits.total_points)?;
        if self.edges.is_empty() {
            return Err(DrawingError::Empty);
        }
        Ok(())
    }

    fn check_numbers(&self) -> Result<(), DrawingError> {
        if let Some(vertex) = self.vertices.iter().position(|p| !p.is_finite()) {
            return Err(DrawingError::VertexNotFinite { vertex });
        }
        for (edge, e) in (1..).zip(&self.edges) {
            if e.points.iter().any(|p| !p.is_finite()) {
                return Err(DrawingError::NotFinite { edge });
            }
        }
        match self.projection {
            Projection::Perspective { focal: Some(f) } if !(f.is_finite() && f > 0.0) => {
                Err(DrawingError::Format(format!(
                    "the focal length of a perspective must be a positive number, and is {f}"
                )))
            }
            _ => Ok(()),
        }
    }

    fn check_edge(&self, edge: usize, e: &Edge, size: f64) -> Result<(), DrawingError> {
        let [Some(&first), Some(&last)] = [e.points.first(), e.points.last()] else {
            return Err(DrawingError::ZeroLength { edge });
        };
        for (v, end) in e.v.into_iter().zip([first, last]) {
            let Some(at) = self.vertices.get(v) else {
                return Err(DrawingError::NoSuchVertex {
                    edge,
                    vertex: v,
                    vertices: self.vertices.len(),
                });
            };
            let gap = at.distance(end);
            if gap > END_GAP * size {
                return Err(DrawingError::EndMismatch {
                    edge,
                    vertex: v,
                    gap,
                });
            }
        }
        // A closed edge needs a point besides its ends, or it goes nowhere.
        let closed_flat = e.v[0] == e.v[1] && e.points.len() < 3;
        if closed_flat || e.length() <= SHORTEST * size {
            return Err(DrawingError::ZeroLength { edge });
        }
        Ok(())
    }

    fn check_truth(&self, truth: &Truth) -> Result<(), DrawingError> {
        let wrong = |what: String| Err(DrawingError::Truth(what));
        let mut faces_of = vec![0usize; 2 * self.edges.len()];
        for (face, f) in (1..).zip(&truth.faces) {
            if f.loops.is_empty() || f.loops.iter().any(Vec::is_empty) {
                return wrong(format!("face {face} has no loop, or an empty one"));
            }
            for l in &f.loops {
                for (i, c) in l.iter().enumerate() {
                    let Some(edge) = self.edges.get(c.edge()) else {
                        return wrong(format!(
                            "face {face} names edge {}, but there are only {}",
                            c.edge() + 1,
                            self.edges.len()
                        ));
                    };
                    let next = l[(i + 1) % l.len()];
                    let head = edge.v[usize::from(!c.is_reversed())];
                    if let Some(n) = self.edges.get(next.edge())
                        && n.v[usize::from(next.is_reversed())] != head
                    {
                        return wrong(format!(
                            "in face {face}, {next:?} does not start where {c:?} ends"
                        ));
                    }
                    if faces_of[c.index()] != 0 {
                        return wrong(format!(
                            "co-edge {c:?} is in face {} and again in face {face}",
                            faces_of[c.index()]
                        ));
                    }
                    faces_of[c.index()] = face;
                }
            }
        }
        if let Some(i) = faces_of.iter().position(|&f| f == 0) {
            let c = super::super::CoEdge::from_index(i);
            return wrong(format!("co-edge {c:?} is in no face"));
        }
        let (nv, ne) = (self.vertices.len(), self.edges.len());
        if ![0, nv].contains(&truth.vertices3d.len()) {
            return wrong(format!(
                "it has {} vertices3d for {nv} vertices",
                truth.vertices3d.len()
            ));
        }
        if ![0, ne].contains(&truth.edges3d.len()) {
            return wrong(format!(
                "it has {} edges3d for {ne} edges",
                truth.edges3d.len()
            ));
        }
        for (edge, (e, e3)) in (1..).zip(self.edges.iter().zip(&truth.edges3d)) {
            if e.points.len() != e3.len() {
                return wrong(format!(
                    "edge {edge} has {} points and {} in edges3d",
                    e.points.len(),
                    e3.len()
                ));
            }
        }
        if ![0, 3].contains(&truth.directions.len()) {
            return wrong(format!(
                "it has {} directions, not 3",
                truth.directions.len()
            ));
        }
        let mut numbers = truth
            .vertices3d
            .iter()
            .chain(truth.edges3d.iter().flatten())
            .chain(&truth.directions);
        if numbers.any(|p| !p.is_finite()) {
            return wrong("a number in it is not finite".into());
        }
        Ok(())
    }
}

/// The drawing's size, if numbers of that size can be computed with.
fn check_size(drawing: &Drawing) -> Result<f64, DrawingError> {
    let size = drawing.size();
    let far = drawing
        .edges
        .iter()
        .flat_map(|e| &e.points)
        .fold(DVec2::ZERO, |m, p| m.max(p.abs()))
        .max_element();
    if size == 0.0 {
        return Err(DrawingError::ZeroLength { edge: 1 });
    }
    if !SIZES.contains(&size) || far > FARTHEST * size {
        return Err(DrawingError::Scale { size, far });
    }
    Ok(size)
}
