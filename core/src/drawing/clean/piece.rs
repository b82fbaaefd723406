//! A piece of a curve between two vertices, as clean-up works on it.

use std::f64::consts::TAU;

use glam::DVec2;

use super::super::{Curve2, EllipseArc};
use super::span::Span;

/// Share of a polyline's step below which no span is left over at a cut.
const SHORT: f64 = 0.05;

/// A curve piece: part of an input edge, one of them, or several joined.
#[derive(Debug, Clone)]
pub(in super::super) struct Piece {
    /// First and second vertex.
    pub(in super::super) v: [usize; 2],
    /// Polyline between them, ends included.
    pub(super) points: Vec<DVec2>,
    pub(super) curve: Curve2,
    /// Input edges it was made from, sorted.
    pub(in super::super) sources: Vec<usize>,
    /// Places of the vertices that a line was joined over.
    pub(super) passed: Vec<DVec2>,
}

/// A place on a piece.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Foot {
    /// Distance from the point it was asked for, less what the polyline leaves open.
    pub(in super::super) distance: f64,
    /// Where on the piece, 0 at its first vertex to 1 at its second.
    pub(super) u: f64,
}

impl Piece {
    /// Piece of an input edge; a line keeps its ends only.
    pub(in super::super) fn new(points: Vec<DVec2>, curve: Curve2, source: usize) -> Self {
        let mut piece = Self {
            v: [0, 0],
            points,
            curve,
            sources: vec![source],
            passed: Vec::new(),
        };
        piece.straighten();
        piece
    }

    /// Leaves a line its two ends only.
    fn straighten(&mut self) {
        if let (Curve2::Line, [first, .., last]) = (self.curve, self.points.as_slice()) {
            self.points = vec![*first, *last];
        }
    }

    pub(super) fn is_closed(&self) -> bool {
        self.v[0] == self.v[1]
    }

    /// Length of the polyline.
    pub(in super::super) fn length(&self) -> f64 {
        self.points.windows(2).map(|w| w[0].distance(w[1])).sum()
    }

    /// First (0) or last (1) point.
    pub(super) fn end(&self, which: usize) -> DVec2 {
        let i = if which == 0 { 0 } else { self.points.len() - 1 };
        self.points[i]
    }

    /// The same piece walked the other way.
    pub(super) fn reversed(mut self) -> Self {
        self.v.reverse();
        self.points.reverse();
        if let Curve2::Ellipse(arc) = &mut self.curve {
            arc.start += arc.sweep;
            arc.sweep = -arc.sweep;
        }
        self
    }

    /// Moves the ends to new places and the points between along with them, so that a line stays a
    /// line and an arc an arc of (nearly) the same ellipse.
    pub(super) fn move_ends(&mut self, ends: [DVec2; 2]) {
        let old = [self.end(0), self.end(1)];
        if old == ends {
            return;
        }
        let (chord, new_chord) = (old[1] - old[0], ends[1] - ends[0]);
        if chord.length() > 0.2 * self.length() {
            // The similarity that takes the old chord to the new one, as a complex factor.
            let factor = DVec2::new(chord.dot(new_chord), chord.perp_dot(new_chord))
                / chord.length_squared();
            let map = |p: DVec2| ends[0] + factor.rotate(p - old[0]);
            for p in &mut self.points {
                *p = map(*p);
            }
            if let Curve2::Ellipse(arc) = &mut self.curve {
                arc.center = map(arc.center);
                arc.major = factor.rotate(arc.major);
            }
        } else {
            // Nearly or fully closed: the shift of the ends is spread along the length.
            let shift = [ends[0] - old[0], ends[1] - old[1]];
            let total = self.length();
            let mut walked = 0.0;
            let mut before = self.end(0);
            for p in &mut self.points {
                walked += p.distance(before);
                before = *p;
                *p += shift[0].lerp(shift[1], walked / total);
            }
            if let Curve2::Ellipse(arc) = &mut self.curve {
                arc.center += (shift[0] + shift[1]) / 2.0;
            }
        }
        let last = self.points.len() - 1;
        self.points[0] = ends[0];
        self.points[last] = ends[1];
    }

    /// Point at `u`.
    pub(in super::super) fn point(&self, u: f64) -> DVec2 {
        match &self.curve {
            Curve2::Ellipse(arc) => arc.point(arc.start + arc.sweep * u),
            _ => {
                let (i, t) = self.segment(u);
                Span::new(&self.points, i).point(t)
            }
        }
    }

    /// Direction of travel at `u`, not normalised.
    pub(super) fn tangent(&self, u: f64) -> DVec2 {
        match &self.curve {
            Curve2::Ellipse(arc) => arc.derivative(arc.start + arc.sweep * u) * arc.sweep,
            _ => {
                let (i, t) = self.segment(u);
                Span::new(&self.points, i).derivative(t)
            }
        }
    }

    /// Segment of the polyline at `u`, and where in it.
    fn segment(&self, u: f64) -> (usize, f64) {
        let x = u.clamp(0.0, 1.0) * (self.points.len() - 1) as f64;
        let i = (x as usize).min(self.points.len() - 2);
        (i, x - i as f64)
    }

    /// Nearest place on the piece.
    pub(in super::super) fn foot(&self, p: DVec2) -> Foot {
        match &self.curve {
            Curve2::Ellipse(arc) => foot_on_arc(arc, p),
            _ => self.foot_on_polyline(p),
        }
    }

    /// Whether this piece lies on another one, as far as a few of its points tell.
    pub(in super::super) fn lies_on(&self, other: &Self, reach: f64) -> bool {
        let on = |u: &f64| other.foot(self.point(*u)).distance <= reach;
        [0.25, 0.5, 0.75].iter().all(on)
    }

    fn foot_on_polyline(&self, p: DVec2) -> Foot {
        let n = self.points.len() - 1;
        let mut best = Foot {
            distance: f64::INFINITY,
            u: 0.0,
        };
        let mut at = 0;
        for (i, w) in self.points.windows(2).enumerate() {
            let d = w[1] - w[0];
            let t = ((p - w[0]).dot(d) / d.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            let distance = p.distance(w[0] + d * t);
            if distance < best.distance {
                at = i;
                best = Foot {
                    distance,
                    u: (i as f64 + t) / n as f64,
                };
            }
        }
        if let Curve2::Polyline = self.curve {
            let span = Span::new(&self.points, at);
            let t = span.foot(p, best.u * n as f64 - at as f64);
            best.u = (at as f64 + t) / n as f64;
            best.distance = (p.distance(span.point(t)) - span.doubt()).max(0.0);
        }
        best
    }

    /// The pieces between the vertices at the given places, which are sorted and inside.
    pub(super) fn split(&self, cuts: &[(f64, usize, DVec2)]) -> Vec<Self> {
        let first = (0.0, self.v[0], self.end(0));
        let last = (1.0, self.v[1], self.end(1));
        let stops: Vec<_> = [first].iter().chain(cuts).chain(&[last]).copied().collect();
        let part = |w: &[(f64, usize, DVec2)]| {
            let ((u0, v0, p0), (u1, v1, p1)) = (w[0], w[1]);
            let mut piece = Self {
                v: [v0, v1],
                points: self.between(u0, u1),
                curve: self.curve,
                sources: self.sources.clone(),
                passed: Vec::new(),
            };
            if let Curve2::Ellipse(arc) = &mut piece.curve {
                arc.start += arc.sweep * u0;
                arc.sweep *= u1 - u0;
            }
            piece.move_ends([p0, p1]);
            piece
        };
        stops.windows(2).map(part).collect()
    }

    /// The polyline from `u0` to `u1`. An arc is sampled anew, at least as finely as the format
    /// asks for, so that it is recognised again when it is read.
    fn between(&self, u0: f64, u1: f64) -> Vec<DVec2> {
        match &self.curve {
            Curve2::Line => vec![self.point(u0), self.point(u1)],
            Curve2::Ellipse(arc) => {
                let turn = (arc.sweep * (u1 - u0)).abs();
                let n = ((turn / TAU * 64.0).ceil() as usize).max(8);
                (0..=n)
                    .map(|i| self.point(u0 + (u1 - u0) * i as f64 / n as f64))
                    .collect()
            }
            Curve2::Polyline => {
                let n = (self.points.len() - 1) as f64;
                // A point that all but coincides with the cut would leave a span without direction.
                let inside = |i: &usize| u0 * n + SHORT < *i as f64 && (*i as f64) + SHORT < u1 * n;
                let mut points = vec![self.point(u0)];
                points.extend(
                    (0..self.points.len())
                        .filter(inside)
                        .map(|i| self.points[i]),
                );
                points.push(self.point(u1));
                points
            }
        }
    }
}

/// Nearest place on an arc to a point that is near it.
fn foot_on_arc(arc: &EllipseArc, p: DVec2) -> Foot {
    let mut t = arc.parameter(p);
    for _ in 0..4 {
        // Newton on the squared distance's derivative, with the curvature term left out where it
        // would turn the step around.
        let (off, d) = (arc.point(t) - p, arc.derivative(t));
        let second = d.length_squared() - off.dot(arc.point(t) - arc.center);
        t -= off.dot(d) / second.max(0.5 * d.length_squared());
    }
    let walked = if arc.sweep < 0.0 {
        (arc.start - t).rem_euclid(TAU)
    } else {
        (t - arc.start).rem_euclid(TAU)
    };
    let sweep = arc.sweep.abs();
    let u = if walked <= sweep {
        walked / sweep
    } else if walked - sweep < TAU - walked {
        1.0
    } else {
        0.0
    };
    Foot {
        distance: p.distance(arc.point(arc.start + arc.sweep * u)),
        u,
    }
}
