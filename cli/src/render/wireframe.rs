//! The drawing with its faces as coloured translucent patches.

use faceformer::drawing::{CoEdge, Drawing};
use faceformer::identify::Face;
use glam::DVec2;

use super::INK;
use super::page::{Anchor, Page, Stroke};
use super::palette::Rgb;
use super::polygon;
use super::view::View;

/// What is numbered in the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Labels {
    /// Nothing.
    None,
    /// Faces, from 1, in the order of the identification.
    Faces,
    /// Edges, from 1, as in loops.
    Edges,
}

const PATCH_OPACITY: f64 = 0.38;

/// Draws the faces, the edges on top and the labels. `colours` has one entry a face. Edges that
/// do not border exactly two faces are dashed.
pub(crate) fn draw(
    page: &mut Page,
    view: &View,
    drawing: &Drawing,
    faces: &[Face],
    colours: &[Rgb],
    labels: Labels,
) {
    let rings: Vec<Vec<Vec<DVec2>>> = faces
        .iter()
        .map(|face| {
            let rings = face.loops.iter().map(|l| ring(drawing, l));
            rings
                .map(|r| r.into_iter().map(|p| view.place(p)).collect())
                .collect()
        })
        .collect();
    // Large patches first, so that small ones stay visible on top.
    let mut order: Vec<usize> = (0..faces.len()).collect();
    let area = |f: &usize| {
        rings[*f]
            .iter()
            .map(|r| polygon::ring_area(r).abs())
            .fold(0.0, f64::max)
    };
    order.sort_by(|a, b| area(b).total_cmp(&area(a)));
    for &f in &order {
        page.area(&rings[f], colours[f], PATCH_OPACITY, None);
    }
    draw_edges(page, view, drawing, faces);
    match labels {
        Labels::None => {}
        Labels::Faces => {
            let unit = view.unit();
            let mut taken = Vec::new();
            // Small faces have the least choice of place.
            for &f in order.iter().rev() {
                let at = polygon::label_point(&rings[f], &taken, unit)
                    .or_else(|| mean(rings[f].iter().flatten()));
                let Some(at) = at else { continue };
                taken.push(at);
                // In a narrow face the label is smaller, as far as it can be read.
                let room = polygon::boundary_distance(&rings[f], at);
                let radius = unit * (room / unit).clamp(0.7, 1.0);
                page.disc(at, radius, colours[f].scaled(0.62));
                let white = Rgb(255, 255, 255);
                let number = (f + 1).to_string();
                page.text(at, &number, 1.15 * radius, white, Anchor::Middle, false);
            }
        }
        Labels::Edges => {
            let mut taken = Vec::new();
            for (e, edge) in drawing.edges.iter().enumerate() {
                let points: Vec<DVec2> = edge.points.iter().map(|p| view.place(*p)).collect();
                let at = free_place(&points, &taken, 1.6 * view.unit());
                taken.push(at);
                let number = (e + 1).to_string();
                page.text(at, &number, 1.2 * view.unit(), INK, Anchor::Middle, true);
            }
        }
    }
}

/// Edges (indices from 0) that do not border exactly two faces, or one face twice.
pub(crate) fn open_edges(drawing: &Drawing, faces: &[Face]) -> Vec<usize> {
    let mut uses = vec![0usize; drawing.edges.len()];
    for coedge in faces.iter().flat_map(|f| f.loops.iter().flatten()) {
        if let Some(count) = uses.get_mut(coedge.edge()) {
            *count += 1;
        }
    }
    (0..uses.len()).filter(|&e| uses[e] != 2).collect()
}

fn draw_edges(page: &mut Page, view: &View, drawing: &Drawing, faces: &[Face]) {
    let open = open_edges(drawing, faces);
    for (e, edge) in drawing.edges.iter().enumerate() {
        let points: Vec<DVec2> = edge.points.iter().map(|p| view.place(*p)).collect();
        let stroke = Stroke {
            colour: INK,
            width: 0.14 * view.unit(),
            dashed: !faces.is_empty() && open.binary_search(&e).is_ok(),
        };
        page.line(&points, stroke);
    }
}

/// The points of a loop in drawing units; the last point is not repeated.
pub(crate) fn ring(drawing: &Drawing, coedges: &[CoEdge]) -> Vec<DVec2> {
    let mut points = Vec::new();
    for c in coedges {
        let Some(edge) = drawing.edges.get(c.edge()) else {
            continue;
        };
        let ends = edge.points.len().saturating_sub(1);
        if c.is_reversed() {
            points.extend(edge.points.iter().rev().take(ends));
        } else {
            points.extend(edge.points.iter().take(ends));
        }
    }
    points
}

/// The point of a polyline at a share of its length, 0 to 1.
fn along(points: &[DVec2], share: f64) -> DVec2 {
    let total: f64 = points.windows(2).map(|w| w[0].distance(w[1])).sum();
    let mut left = total * share;
    for w in points.windows(2) {
        let length = w[0].distance(w[1]);
        if left <= length && length > 0.0 {
            return w[0].lerp(w[1], left / length);
        }
        left -= length;
    }
    points.last().copied().unwrap_or(DVec2::ZERO)
}

/// A place on a polyline, near its middle, that is at least `gap` away from those in `taken` if
/// there is one.
fn free_place(points: &[DVec2], taken: &[DVec2], gap: f64) -> DVec2 {
    [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8]
        .into_iter()
        .map(|share| along(points, share))
        .find(|p| taken.iter().all(|t| t.distance(*p) >= gap))
        .unwrap_or_else(|| along(points, 0.5))
}

fn mean<'a>(points: impl Iterator<Item = &'a DVec2>) -> Option<DVec2> {
    let (sum, count) = points.fold((DVec2::ZERO, 0u32), |(s, n), p| (s + *p, n + 1));
    (count > 0).then(|| sum / f64::from(count))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_of_the_length() {
        let points = [DVec2::ZERO, DVec2::X, DVec2::new(1.0, 3.0)];
        assert_eq!(along(&points, 0.5), DVec2::new(1.0, 1.0));
        assert_eq!(along(&points, 1.0), points[2]);
        assert_eq!(along(&[DVec2::ONE, DVec2::ONE], 0.5), DVec2::ONE);
    }

    #[test]
    fn a_taken_middle_is_left_free() {
        let points = [DVec2::ZERO, DVec2::new(10.0, 0.0)];
        let place = |taken: &[DVec2]| free_place(&points, taken, 1.5).x;
        assert_eq!(place(&[]), 5.0);
        assert_eq!(place(&[DVec2::new(5.0, 0.0)]), 3.0);
        assert_eq!(place(&[DVec2::new(4.5, 0.0)]), 6.0);
    }
}
