//! Which edges stand in which relation.

use glam::DVec2;

use super::Corners;
use super::nearby::Nearby;
use crate::drawing::CoEdge;
use crate::identify::rotation::features::{Context, bell};
use crate::identify::rotation::rings::Rings;

macro_rules! relations {
    ($($name:ident: $text:literal,)*) => {
        /// The relations, in the order of their bits.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Relation {
            $(#[doc = $text] $name,)*
        }

        impl Relation {
            /// All relations, in the order of their bits.
            pub const ALL: [Self; RELATIONS] = [$(Self::$name,)*];

            const fn bit(self) -> u16 {
                1 << self as u16
            }
        }

        /// Number of relations.
        pub const RELATIONS: usize = [$(Relation::$name,)*].len();
    };
}

relations! {
    Same: "They are the same edge.",
    Adjacent: "They share a vertex.",
    Joined: "They share both vertices.",
    Smooth: "One goes on smoothly as the other at a vertex.",
    Parallel: "They are straight and parallel.",
    NearlyParallel: "They are straight and parallel within a few degrees.",
    Collinear: "They are straight and on one line.",
    Congruent: "One is the other one shifted.",
    SameRing: "They are arcs of one ellipse.",
    ParallelRings: "They are arcs of ellipses of one shape and direction.",
    Cycle: "They are on a shortest cycle through a corner at one of them.",
    Linked: "An edge joins them.",
    SharePlane: "The dominant directions allow a plane through both.",
    ShareCylinder: "The dominant directions allow a cylinder through both.",
    Apart: "They are in different components of the graph.",
}

/// Sine of the angle up to which straight edges are parallel, beside what rounding explains.
const PARALLEL: f64 = 0.003;
/// The same for nearly parallel ones.
const NEARLY: f64 = 0.12;
/// Distance, over the drawing's size, from a line on which a point lies.
const ON_LINE: f64 = 0.004;
/// Difference of two chords, over the longer, up to which edges are congruent.
const CONGRUENT: f64 = 0.02;

/// The table of all pairs, row by row.
pub(super) fn table(context: &Context<'_>, corners: &Corners, nearby: &Nearby) -> Vec<u16> {
    let n = context.graph.edge_count();
    let mut table = vec![0u16; n * n];
    for i in 0..n {
        table[i * n + i] |= Relation::Same.bit();
        for j in 0..i {
            let bits = geometry(context, i, j);
            table[i * n + j] |= bits;
            table[j * n + i] |= bits;
        }
    }
    let mut mark = |i: usize, j: usize, relation: Relation| {
        if i != j {
            table[i * n + j] |= relation.bit();
            table[j * n + i] |= relation.bit();
        }
    };
    for (k, (_, outer, middle)) in corners.iter(context.graph).enumerate() {
        let (i, j) = (outer.edge(), middle.edge());
        mark(i, j, Relation::Adjacent);
        let (a, b) = (context.end(outer), context.end(middle));
        if bell((a.tangent + b.tangent).length(), 0.05) > 0.5 {
            mark(i, j, Relation::Smooth);
        }
        if context.graph.head(outer) == context.graph.head(middle) {
            mark(i, j, Relation::Joined);
        }
        if !nearby.members[k].is_empty() {
            mark(i, j, Relation::Cycle);
        }
        for &other in &nearby.members[k] {
            mark(i, other as usize, Relation::Cycle);
            mark(j, other as usize, Relation::Cycle);
        }
        for far in context.graph.leaving(context.graph.head(middle)) {
            mark(i, far.edge(), Relation::Linked);
        }
    }
    table
}

fn geometry(context: &Context<'_>, i: usize, j: usize) -> u16 {
    let mut bits = 0;
    let mut set = |relation: Relation| bits |= relation.bit();
    let [a, b] = [i, j].map(|e| context.end(CoEdge::new(e, false)));
    let graph = context.graph;
    let component = |e: usize| graph.component(graph.origin(CoEdge::new(e, false)));
    if component(i) != component(j) {
        set(Relation::Apart);
    }
    if a.straight && b.straight {
        let sine = a.tangent.perp_dot(b.tangent).abs();
        if sine < NEARLY {
            set(Relation::NearlyParallel);
            if sine < PARALLEL + context.noise(a) + context.noise(b) {
                set(Relation::Parallel);
            }
            if on_one_line(context, i, j) {
                set(Relation::Collinear);
            }
        }
    }
    if a.straight == b.straight {
        let longer = a
            .chord
            .length()
            .max(b.chord.length())
            .max(1e-3 * context.size);
        let shift = (a.chord - b.chord)
            .length()
            .min((a.chord + b.chord).length());
        if shift + (a.bulge - b.bulge).length() < CONGRUENT * longer {
            set(Relation::Congruent);
        }
    }
    let [ring_i, ring_j] = [i, j].map(|e| context.rings.of(e));
    if ring_i.is_some() && ring_i == ring_j {
        set(Relation::SameRing);
    } else if let [Some(p), Some(q)] = [i, j].map(|e| context.rings.ellipse(e))
        && Rings::parallel(p, q)
    {
        set(Relation::ParallelRings);
    }
    if let [Some(f), Some(g)] = [i, j].map(|e| context.frame.fits(e)) {
        if f.planes & g.planes != 0 {
            set(Relation::SharePlane);
        }
        if f.cylinders & g.cylinders != 0 {
            set(Relation::ShareCylinder);
        }
    }
    bits
}

/// Whether the ends of the shorter of two straight edges lie on the line through the longer.
fn on_one_line(context: &Context<'_>, i: usize, j: usize) -> bool {
    let ends = |e: usize| {
        context.drawing.edges[e]
            .v
            .map(|v| context.drawing.vertices[v])
    };
    let length = |[p, q]: [DVec2; 2]| p.distance(q);
    let (a, b) = (ends(i), ends(j));
    let (long, short) = if length(a) >= length(b) {
        (a, b)
    } else {
        (b, a)
    };
    let along = (long[1] - long[0]).normalize_or_zero();
    let off = |p: DVec2| along.perp_dot(p - long[0]).abs();
    along != DVec2::ZERO && short.iter().all(|&p| off(p) < ON_LINE * context.size)
}
