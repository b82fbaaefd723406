//! What speaks for and against a triple of edges, as numbers.

use glam::DVec2;

use super::Triples;
use super::crossing::Crossings;
use super::cycles::{LONG, shortest_cycles};
use super::ends::{End, ends};
use super::frame::{Agreement, Frame};
use super::rings::Rings;
use crate::drawing::{CoEdge, Drawing, Graph};
use crate::lift::directions::Directions;

macro_rules! features {
    ($($name:ident: $text:literal,)*) => {
        /// The features, in the order of a row.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Feature {
            $(#[doc = $text] $name,)*
        }

        impl Feature {
            /// All features, in the order of a row.
            pub const ALL: [Self; COUNT] = [$(Self::$name,)*];

            /// What the feature says.
            pub const fn text(self) -> &'static str {
                match self { $(Self::$name => $text,)* }
            }
        }

        /// Number of features.
        pub const COUNT: usize = [$(Feature::$name,)*].len();
    };
}

features! {
    ParallelSame: "Edges before and after are straight, parallel, and leave the same way.",
    ParallelOpposite: "They are straight, parallel, and leave opposite ways.",
    NearlySame: "They are straight, within a few degrees, and leave the same way.",
    NearlyOpposite: "They are straight, within a few degrees, and leave opposite ways.",
    TangentsSame: "They are curved and leave with parallel tangents, the same way.",
    TangentsOpposite: "They are curved and leave with parallel tangents, opposite ways.",
    MixedSame: "One is straight, one curved, and they leave the same way.",
    MixedOpposite: "One is straight, one curved, and they leave opposite ways.",
    CongruentStraight: "They are straight, and one is the other one shifted.",
    CongruentCurved: "They are curved, and one is the other one shifted.",
    SideStraight: "They leave to the same side of a straight edge; minus if not.",
    SideCurved: "They leave to the same side of a curved edge; minus if not.",
    CycleOne: "The edge is closed.",
    CycleTwo: "The shortest cycle through the triple has 2 edges.",
    CycleThree: "The shortest cycle through the triple has 3 edges.",
    CycleFour: "The shortest cycle through the triple has 4 edges.",
    CycleFive: "The shortest cycle through the triple has 5 edges.",
    CycleSix: "The shortest cycle through the triple has 6 edges.",
    CycleNone: "There is no short cycle through the triple.",
    Longer: "The cycle is longer than the shortest through the edge, in edges.",
    LongerAtEnds: "It is longer than the shortest with the same edge before; likewise after.",
    LongerAtEnd: "The larger of these two.",
    Cross: "The edges before and after cross in the drawing.",
    CrossingOpposite: "Two of the edges are opposite where smooth curves cross.",
    CrossingAdjacent: "Two of the edges are neighbours where smooth curves cross.",
    SmoothOne: "The edge goes on smoothly at one end.",
    SmoothBoth: "The edge goes on smoothly at both ends.",
    StraightOn: "Straight edges in line at a vertex of degree 4 or more.",
    SmoothOn: "Curved edges that go on smoothly at a vertex of degree 4 or more.",
    FoldBack: "Edges that leave a vertex of degree 4 or more the same way.",
    Plane: "The dominant directions put all three into one plane.",
    Cylinder: "The dominant directions put all three onto one cylinder, and no plane.",
    Neither: "The dominant directions rule out plane and cylinder.",
    RingMates: "Silhouettes at the ends of an arc mirror each other, or neither is in the triple; minus if they do not.",
    RingSame: "Silhouette between parallel circles, walked the same way around.",
    RingOpposite: "Silhouette between parallel circles, walked opposite ways around.",
    RingParallel: "Edges before and after are on parallel circles.",
    RingUnlike: "Edges before and after are on circles that are not parallel.",
    RingAll: "All three are on one circle.",
}

/// A row of features.
pub type Row = [f64; COUNT];

/// Computes the features of every triple of a drawing with these dominant directions, if it has any.
pub fn features(
    drawing: &Drawing,
    graph: &Graph,
    triples: &Triples,
    directions: Option<&Directions>,
) -> Vec<Row> {
    let cycles = shortest_cycles(graph, triples);
    Context::new(drawing, graph, directions).rows(triples, &cycles)
}

/// A row under construction.
struct Facts<'a>(&'a mut Row);

impl Facts<'_> {
    fn add(&mut self, feature: Feature, value: f64) {
        self.0[feature as usize] += value;
    }

    fn cycle(&mut self, length: u8, all: u8, first: u8, second: u8) {
        let size = match length {
            1 => Some(Feature::CycleOne),
            2 => Some(Feature::CycleTwo),
            3 => Some(Feature::CycleThree),
            4 => Some(Feature::CycleFour),
            5 => Some(Feature::CycleFive),
            6 => Some(Feature::CycleSix),
            LONG => Some(Feature::CycleNone),
            _ => None,
        };
        if let Some(feature) = size {
            self.add(feature, 1.0);
        }
        let excess = |least: u8| f64::from((length - least).min(4));
        self.add(Feature::Longer, excess(all));
        self.add(Feature::LongerAtEnds, excess(first) + excess(second));
        self.add(Feature::LongerAtEnd, excess(first).max(excess(second)));
    }
}

#[derive(Clone, Copy)]
struct Triple {
    before: CoEdge,
    edge: CoEdge,
    after: CoEdge,
}

/// What is known of a drawing before single triples are looked at.
pub(super) struct Context<'a> {
    pub(super) drawing: &'a Drawing,
    pub(super) graph: &'a Graph,
    pub(super) ends: Vec<End>,
    pub(super) rings: Rings,
    pub(super) crossings: Crossings,
    pub(super) frame: Frame,
    /// Half diagonal of the drawing, never 0.
    pub(super) size: f64,
}

impl<'a> Context<'a> {
    /// Looks at a drawing.
    pub(super) fn new(
        drawing: &'a Drawing,
        graph: &'a Graph,
        directions: Option<&Directions>,
    ) -> Self {
        let size = drawing.size().max(f64::MIN_POSITIVE);
        let ends = ends(drawing);
        let rings = Rings::new(drawing, graph);
        Self {
            drawing,
            graph,
            crossings: Crossings::new(graph, &ends, &rings, size),
            frame: Frame::new(drawing, directions),
            ends,
            rings,
            size,
        }
    }

    /// Rows of features; `cycles` are the triples' [`shortest_cycles`].
    pub(super) fn rows(&self, triples: &Triples, cycles: &[u8]) -> Vec<Row> {
        let mut rows = vec![[0.0; COUNT]; triples.len()];
        for e in 0..self.graph.edge_count() {
            let block = triples.of_edge(e);
            let shortest = |f: &dyn Fn(usize) -> bool| {
                let lengths = block.clone().filter(|&t| f(t)).map(|t| cycles[t]);
                lengths.min().unwrap_or(LONG)
            };
            let all = shortest(&|_| true);
            for t in block.clone() {
                let (before, after) = (triples.before(t), triples.after(t));
                let first = shortest(&|x| triples.before(x) == before);
                let second = shortest(&|x| triples.after(x) == after);
                let mut facts = Facts(&mut rows[t]);
                facts.cycle(cycles[t], all, first, second);
                let triple = Triple {
                    before,
                    edge: CoEdge::new(e, false),
                    after,
                };
                self.directions(&mut facts, triple);
                self.corners(&mut facts, triple);
                self.circles(&mut facts, triple);
            }
        }
        rows
    }

    pub(super) fn end(&self, c: CoEdge) -> &End {
        &self.ends[c.index()]
    }

    /// Compares the edges before and after: directions, sides, crossing, dominant directions.
    fn directions(&self, facts: &mut Facts<'_>, triple: Triple) {
        use Feature as F;
        let (p, n) = (self.end(triple.before), self.end(triple.after));
        let (e, m) = (self.end(triple.edge), self.end(triple.edge.mate()));
        let sine = p.tangent.perp_dot(n.tangent).abs();
        let same = p.tangent.dot(n.tangent) > 0.0;
        let pick = |a: F, b: F| if same { a } else { b };
        let near = bell(sine, 0.03);
        match (p.straight, n.straight) {
            (true, true) => {
                let width = 0.003 + self.noise(p) + self.noise(n);
                facts.add(
                    pick(F::ParallelSame, F::ParallelOpposite),
                    bell(sine, width),
                );
                facts.add(pick(F::NearlySame, F::NearlyOpposite), near);
            }
            (false, false) => facts.add(pick(F::TangentsSame, F::TangentsOpposite), near),
            _ => facts.add(pick(F::MixedSame, F::MixedOpposite), near),
        }
        if p.straight == n.straight && triple.before.edge() != triple.after.edge() {
            let longer = p.chord.length().max(n.chord.length()).max(1e-3 * self.size);
            let shift = (p.chord - n.chord).length() + (p.bulge - n.bulge).length();
            let feature = if p.straight {
                F::CongruentStraight
            } else {
                F::CongruentCurved
            };
            facts.add(feature, bell(shift / longer, 0.02));
        }
        let sides = e.tangent.perp_dot(p.tangent).signum() * m.tangent.perp_dot(n.tangent).signum();
        facts.add(
            if e.straight {
                F::SideStraight
            } else {
                F::SideCurved
            },
            -sides,
        );
        if self.cross(triple.before, triple.after) {
            facts.add(F::Cross, 1.0);
        }
        match self
            .frame
            .agreement([triple.before, triple.edge, triple.after].map(CoEdge::edge))
        {
            Agreement::Unknown => {}
            Agreement::Plane => facts.add(F::Plane, 1.0),
            Agreement::Cylinder => facts.add(F::Cylinder, 1.0),
            Agreement::None => facts.add(F::Neither, 1.0),
        }
    }

    /// Looks at the corners at both ends of the edge.
    fn corners(&self, facts: &mut Facts<'_>, triple: Triple) {
        use Feature as F;
        let mut smoothness = [0.0; 2];
        let corners = [
            (triple.before, triple.edge),
            (triple.after, triple.edge.mate()),
        ];
        for (s, (at, other)) in smoothness.iter_mut().zip(corners) {
            let (this, that) = (self.end(at), self.end(other));
            *s = bell((this.tangent + that.tangent).length(), 0.05);
            let v = self.graph.origin(at);
            if self.graph.degree(v) < 4 {
                continue;
            }
            let (i, j) = (self.graph.position(at), self.graph.position(other));
            let (opposite, adjacent) = self.crossings.opposite_and_adjacent(v, i, j);
            facts.add(F::CrossingOpposite, opposite);
            facts.add(F::CrossingAdjacent, adjacent);
            let straight = this.straight && that.straight;
            facts.add(if straight { F::StraightOn } else { F::SmoothOn }, *s);
            facts.add(F::FoldBack, bell(this.tangent.distance(that.tangent), 0.05));
        }
        facts.add(F::SmoothBoth, smoothness[0].min(smoothness[1]));
        facts.add(F::SmoothOne, (smoothness[0] - smoothness[1]).abs());
    }

    /// Looks at circles that the edges are parts of.
    fn circles(&self, facts: &mut Facts<'_>, triple: Triple) {
        use Feature as F;
        let Triple {
            before,
            edge,
            after,
        } = triple;
        let [p, e, n] = [before, edge, after].map(|c| self.rings.of(c.edge()));
        if p.is_some() && p == e && e == n {
            facts.add(F::RingAll, 1.0);
        }
        if let Some(mates) = self.ring_mates(triple) {
            facts.add(F::RingMates, mates);
        }
        let [Some(a), Some(b)] = [before, after].map(|c| self.rings.ellipse(c.edge())) else {
            return;
        };
        if e == p || e == n {
            return;
        }
        if !Rings::parallel(a, b) {
            facts.add(F::RingUnlike, 1.0);
            return;
        }
        facts.add(F::RingParallel, 1.0);
        let [u, v] = [before, after].map(|c| self.drawing.vertices[self.graph.origin(c)]);
        let slant = Rings::slant(a, u, self.end(edge).tangent).max(Rings::slant(
            b,
            v,
            self.end(edge.mate()).tangent,
        ));
        let tangential = bell(slant, 0.1);
        let same = Rings::turns_left(a, u, self.end(before).tangent)
            == Rings::turns_left(b, v, self.end(after).tangent);
        facts.add(if same { F::RingSame } else { F::RingOpposite }, tangential);
    }

    /// For an arc with something tangential at both ends: 1 if the triple goes on along the circle
    /// at both ends or at none and the ends mirror each other, or neither is so; -1 otherwise.
    fn ring_mates(&self, triple: Triple) -> Option<f64> {
        let ellipse = self.rings.ellipse(triple.edge.edge())?;
        let ends = [
            (triple.edge, triple.before),
            (triple.edge.mate(), triple.after),
        ];
        let mut on_ring = 0;
        for (arc, chosen) in ends {
            let v = self.graph.origin(arc);
            let next = self.rings.continuation(self.graph, arc)?;
            let other = self.third(v, [arc, next])?;
            let at = self.drawing.vertices[v];
            if Rings::slant(ellipse, at, self.end(other).tangent) > 0.15 {
                return None;
            }
            on_ring += usize::from(chosen == next);
        }
        let [u, v] = ends.map(|(c, _)| self.drawing.vertices[self.graph.origin(c)]);
        let mirrored = bell(Rings::asymmetry(ellipse, u, v), 0.03);
        let together = if on_ring == 1 { -1.0 } else { 1.0 };
        Some(together * (2.0 * mirrored - 1.0))
    }

    /// The one co-edge at a vertex of degree 3 besides two others.
    fn third(&self, vertex: usize, known: [CoEdge; 2]) -> Option<CoEdge> {
        let leaving = self.graph.leaving(vertex);
        let mut others = leaving.iter().filter(|c| !known.contains(c));
        others.next().copied().filter(|_| leaving.len() == 3)
    }

    /// Angle that rounding of coordinates can turn a straight edge by, radians.
    pub(super) fn noise(&self, end: &End) -> f64 {
        1e-5 * self.size / end.chord.length().max(1e-6 * self.size)
    }

    fn cross(&self, a: CoEdge, b: CoEdge) -> bool {
        let (a, b) = (&self.drawing.edges[a.edge()], &self.drawing.edges[b.edge()]);
        if a.v.iter().any(|v| b.v.contains(v)) {
            return false;
        }
        a.points.windows(2).any(|s| {
            b.points.windows(2).any(|t| {
                let side = |o: DVec2, d: DVec2, x: DVec2| (d - o).perp_dot(x - o);
                side(s[0], s[1], t[0]) * side(s[0], s[1], t[1]) < 0.0
                    && side(t[0], t[1], s[0]) * side(t[0], t[1], s[1]) < 0.0
            })
        })
    }
}

/// 1 at 0, falling to 0.6 at `width` and to nothing at three times that.
pub(super) fn bell(x: f64, width: f64) -> f64 {
    (-0.5 * (x / width).powi(2)).exp()
}
