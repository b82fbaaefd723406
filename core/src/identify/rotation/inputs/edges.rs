//! Numbers for edges, the same whichever way an edge is walked.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use super::Table;
use crate::drawing::{CoEdge, Curve2, Drawing, Edge, Projection};
use crate::identify::rotation::Triples;
use crate::identify::rotation::cycles::LONG;
use crate::identify::rotation::features::{Context, bell};

/// Numbers of an edge.
pub const EDGE: usize = 87;

/// Points along an edge; the first with the last, the second with the last but one and so on make
/// pairs.
const SAMPLES: usize = 8;

/// Rows of all edges; `cycles` are the lengths of the shortest cycles through the triples.
pub(super) fn rows(context: &Context<'_>, triples: &Triples, cycles: &[u8]) -> Vec<f32> {
    let drawing = context.drawing;
    let scale = Scale::new(drawing, context.size);
    let parallel = Parallel::new(context);
    let graph = context.graph;
    let mut in_component = vec![0usize; graph.component_count()];
    for edge in &drawing.edges {
        in_component[graph.component(edge.v[0])] += 1;
    }
    let mut table = Table::new(drawing.edges.len(), EDGE);
    for (e, edge) in drawing.edges.iter().enumerate() {
        points(&mut table, &scale, edge);
        curve(&mut table, &scale, context, e);
        ends(&mut table, context, e);
        table.push(parallel.share[e]);
        table.push(parallel.count[e].ln_1p() / 3.0);
        let fits = context.frame.fits(e);
        table.flag(fits.is_some());
        table.flag(fits.is_some_and(|f| f.straight));
        let block = &cycles[triples.of_edge(e)];
        let least = block.iter().copied().min().unwrap_or(LONG);
        table.one_hot(usize::from(least), 1, 8);
        let with = block.iter().filter(|&&c| c == least).count();
        table.push(with as f64 / block.len().max(1) as f64);
        let own = in_component[graph.component(edge.v[0])];
        table.push((own as f64).ln() / 5.0);
        table.push((drawing.edges.len() as f64).ln() / 5.0);
        table.push(own as f64 / drawing.edges.len() as f64);
        table.flag(matches!(drawing.projection, Projection::Perspective { .. }));
    }
    table.finish()
}

/// The frame of a drawing: origin in the middle of the bounding box, half diagonal 1.
struct Scale {
    middle: DVec2,
    size: f64,
}

impl Scale {
    fn new(drawing: &Drawing, size: f64) -> Self {
        let points = || drawing.edges.iter().flat_map(|e| &e.points);
        let min = points().fold(DVec2::INFINITY, |m, p| m.min(*p));
        let max = points().fold(DVec2::NEG_INFINITY, |m, p| m.max(*p));
        Self {
            middle: (min + max) / 2.0,
            size,
        }
    }

    fn point(&self, p: DVec2) -> DVec2 {
        (p - self.middle) / self.size
    }
}

/// Places along the edge. Sums over a pair of points and the product of two differences do not
/// change when the edge is walked backwards.
fn points(table: &mut Table, scale: &Scale, edge: &Edge) {
    let samples = resample(edge).map(|p| scale.point(p));
    let pair = |k: usize| (samples[k], samples[SAMPLES - 1 - k]);
    let (first, last) = pair(0);
    let (near, far) = pair(SAMPLES / 2 - 1);
    let (center, middle) = ((first + last) / 2.0, (near + far) / 2.0);
    table.point(center);
    table.point(middle);
    for k in 1..SAMPLES / 2 {
        let (a, b) = pair(k);
        table.point((a + b) / 2.0 - center);
    }
    let chord = last - first;
    let reference = chord.normalize_or_zero();
    for k in 1..SAMPLES / 2 {
        let (a, b) = pair(k);
        table.push((b - a).dot(reference));
        table.push((b - a).perp_dot(reference));
    }
    for frequency in [PI, TAU, 2.0 * TAU] {
        for wave in [f64::sin, f64::cos] {
            let at = |p: DVec2| DVec2::new(wave(frequency * p.x), wave(frequency * p.y));
            table.point(at(middle));
            table.point(at(first) + at(last));
        }
    }
    let double = turned(reference);
    table.point(double);
    table.point(turned(double));
    let length = edge.length() / scale.size;
    table.push(chord.length());
    table.push(length);
    table.push(length.max(1e-4).ln() / 3.0);
    table.push(chord.length() / length.max(1e-9));
}

/// A unit vector at twice the angle: the same for a direction and its opposite.
fn turned(d: DVec2) -> DVec2 {
    DVec2::new(d.x * d.x - d.y * d.y, 2.0 * d.x * d.y)
}

/// What the edge was recognised as, and its ellipse or that of its ring.
fn curve(table: &mut Table, scale: &Scale, context: &Context<'_>, e: usize) {
    let edge = &context.drawing.edges[e];
    table.flag(matches!(edge.curve, Curve2::Line));
    table.flag(matches!(edge.curve, Curve2::Ellipse(_)));
    table.flag(matches!(edge.curve, Curve2::Polyline));
    table.flag(edge.v[0] == edge.v[1]);
    let own = match &edge.curve {
        Curve2::Ellipse(arc) => Some(arc),
        _ => None,
    };
    let Some(arc) = context.rings.ellipse(e).or(own) else {
        for _ in 0..9 {
            table.push(0.0);
        }
        return;
    };
    let (major, minor) = (arc.major.length(), arc.major.length() * arc.ratio);
    table.push(major / scale.size);
    table.push(minor / scale.size);
    table.push(arc.ratio);
    // In a round ellipse the direction of the axes says nothing.
    table.point(turned(arc.major.normalize_or_zero()) * (1.0 - arc.ratio));
    table.point(scale.point(arc.center));
    table.push(own.map_or(0.0, |a| a.sweep.abs() / TAU));
    table.push(arc.uncertainty.min(1.0));
}

/// Degrees and smooth continuations at both ends, without order.
fn ends(table: &mut Table, context: &Context<'_>, e: usize) {
    let graph = context.graph;
    let both = [CoEdge::new(e, false), CoEdge::new(e, true)];
    let degrees = both.map(|c| graph.degree(graph.origin(c)));
    for d in 2..=6 {
        let is = |x: usize| f64::from(u8::from(x.clamp(2, 6) == d));
        table.push(is(degrees[0]) + is(degrees[1]));
    }
    let smooth = both.map(|c| {
        let others = graph.leaving(graph.origin(c)).iter().filter(|&&o| o != c);
        let onwards = |o: &CoEdge| (context.end(*o).tangent + context.end(c).tangent).length();
        others.map(onwards).fold(2.0, f64::min)
    });
    for width in [0.05, 0.2] {
        let s = smooth.map(|x| bell(x, width));
        table.push(s[0].min(s[1]));
        table.push(s[0].max(s[1]));
    }
}

/// Points at equal steps along an edge's polyline, both ends included.
fn resample(edge: &Edge) -> [DVec2; SAMPLES] {
    let points = &edge.points;
    let total = edge.length();
    let (mut segment, mut before) = (0, 0.0);
    let mut samples = [points[0]; SAMPLES];
    for (k, sample) in samples.iter_mut().enumerate() {
        let target = total * k as f64 / (SAMPLES - 1) as f64;
        loop {
            let (a, b) = (points[segment], points[segment + 1]);
            let step = a.distance(b);
            if before + step >= target || segment + 2 == points.len() {
                let t = if step > 0.0 {
                    (target - before) / step
                } else {
                    0.0
                };
                *sample = a.lerp(b, t.clamp(0.0, 1.0));
                break;
            }
            before += step;
            segment += 1;
        }
    }
    samples[SAMPLES - 1] = points[points.len() - 1];
    samples
}

/// How many straight edges are parallel to each, itself included.
struct Parallel {
    count: Vec<f64>,
    /// Their part of the length of all straight edges.
    share: Vec<f64>,
}

impl Parallel {
    fn new(context: &Context<'_>) -> Self {
        let n = context.drawing.edges.len();
        let straight: Vec<usize> = (0..n)
            .filter(|&e| context.drawing.edges[e].is_straight())
            .collect();
        let end = |e: usize| context.end(CoEdge::new(e, false));
        let all: f64 = straight.iter().map(|&e| end(e).chord.length()).sum();
        let mut found = Self {
            count: vec![0.0; n],
            share: vec![0.0; n],
        };
        for &i in &straight {
            for &j in &straight {
                let (a, b) = (end(i), end(j));
                let width = 0.003 + context.noise(a) + context.noise(b);
                if a.tangent.perp_dot(b.tangent).abs() < width {
                    found.count[i] += 1.0;
                    found.share[i] += b.chord.length() / all.max(f64::MIN_POSITIVE);
                }
            }
        }
        found
    }
}
