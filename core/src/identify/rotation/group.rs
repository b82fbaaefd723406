//! Grouping loops into faces by lifting.
//!
//! Every loop is a face of its own at first. Lifting gives each planar loop a plane, and each part
//! of the drawing that shares no vertex with the others a depth of its own. Two loops may be one
//! face only if their planes are parallel, one is drawn inside the other, and they are walked in
//! opposite senses. Each such link of two parts implies how far one moves in depth; links that
//! imply the same move support each other (a through hole is two of them). Of a part's moves the
//! likeliest wins, the others are alternatives.

use glam::{DVec2, DVec3};

use crate::drawing::{Drawing, Graph, SurfaceKind};
use crate::identify::Face;
use crate::lift::{Pieces, Tilt};

/// Difference of slopes, relative to 1 + slope, up to which planes are parallel.
const PARALLEL: f64 = 5e-3;

/// Difference of depth, relative to the size of the drawing, up to which two moves are one.
const SAME: f64 = 4e-3;

/// Faces as lists of loop indices, with a score; the best first.
pub(super) struct Grouping {
    pub(super) faces: Vec<Vec<usize>>,
    pub(super) score: f64,
}

/// A loop as drawn and lifted.
struct Ring {
    part: usize,
    polygon: Vec<DVec2>,
    area: f64,
    plane: Option<Tilt>,
    vertices: Vec<usize>,
}

/// One way to join a part to the ones placed before it.
struct Join {
    /// Pairs (outer loop, inner loop).
    links: Vec<(usize, usize)>,
    shift: f64,
    score: f64,
}

/// Groups loops, each given as a face of one loop.
pub(super) fn group(drawing: &Drawing, graph: &Graph, loops: &[Face]) -> Vec<Grouping> {
    let alone = || (0..loops.len()).map(|i| vec![i]).collect::<Vec<_>>();
    let Ok(pieces) = Pieces::new(drawing, loops) else {
        return vec![Grouping {
            faces: alone(),
            score: 0.0,
        }];
    };
    let rings: Vec<Ring> = loops
        .iter()
        .enumerate()
        .map(|(i, face)| ring(drawing, graph, &pieces, i, face))
        .collect();
    Grouper {
        drawing,
        pieces: &pieces,
        rings,
        size: drawing.size(),
    }
    .run()
}

fn ring(drawing: &Drawing, graph: &Graph, pieces: &Pieces, index: usize, face: &Face) -> Ring {
    let mut polygon = Vec::new();
    let mut vertices = Vec::new();
    for c in face.loops.iter().flatten() {
        let points = &drawing.edges[c.edge()].points;
        let n = points.len() - 1;
        let walked = |k: usize| {
            if c.is_reversed() {
                points[n - k]
            } else {
                points[k]
            }
        };
        polygon.extend((0..n).map(walked));
        vertices.push(graph.origin(*c));
    }
    let area = area(&polygon);
    Ring {
        part: vertices.first().map_or(0, |&v| graph.component(v)),
        polygon,
        area,
        plane: (face.kind == SurfaceKind::Plane)
            .then(|| pieces.plane(index))
            .flatten(),
        vertices,
    }
}

fn area(polygon: &[DVec2]) -> f64 {
    let n = polygon.len();
    (0..n)
        .map(|i| polygon[i].perp_dot(polygon[(i + 1) % n]))
        .sum::<f64>()
        / 2.0
}

fn contains(polygon: &[DVec2], p: DVec2) -> bool {
    let mut inside = false;
    for i in 0..polygon.len() {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        if (a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x {
            inside = !inside;
        }
    }
    inside
}

struct Grouper<'a> {
    drawing: &'a Drawing,
    pieces: &'a Pieces,
    rings: Vec<Ring>,
    size: f64,
}

impl Grouper<'_> {
    fn run(&self) -> Vec<Grouping> {
        let parts = self.rings.iter().map(|r| r.part + 1).max().unwrap_or(0);
        let mut owner: Vec<usize> = (0..self.rings.len()).collect();
        self.join_within_parts(&mut owner);
        let extent = |part: usize| {
            let points = self
                .rings
                .iter()
                .filter(|r| r.part == part)
                .flat_map(|r| &r.polygon);
            let (lo, hi) = points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| {
                (l.min(*p), h.max(*p))
            });
            (hi - lo).length()
        };
        let mut waiting: Vec<usize> = (0..parts).collect();
        waiting.sort_by(|a, b| extent(*b).total_cmp(&extent(*a)));
        let mut placed: Vec<Option<f64>> = vec![None; parts];
        if !waiting.is_empty() {
            placed[waiting.remove(0)] = Some(0.0);
        }
        let mut chosen: Vec<(Join, Vec<Join>)> = Vec::new();
        while !waiting.is_empty() {
            let mut best: Option<(f64, usize, Vec<Join>)> = None;
            for (at, &part) in waiting.iter().enumerate() {
                let joins = self.joins(part, &placed);
                let Some(first) = joins.first() else { continue };
                let lead = first.score - joins.get(1).map_or(first.score - 4.0, |j| j.score);
                if best.as_ref().is_none_or(|b| lead > b.0) {
                    best = Some((lead, at, joins));
                }
            }
            let Some((_, at, mut joins)) = best else {
                break;
            };
            let part = waiting.remove(at);
            let first = joins.remove(0);
            placed[part] = Some(first.shift);
            chosen.push((first, joins));
        }
        let faces = |replaced: Option<(usize, usize)>| {
            let mut owner = owner.clone();
            for (k, (first, others)) in chosen.iter().enumerate() {
                let join = match replaced {
                    Some((at, other)) if at == k => &others[other],
                    _ => first,
                };
                for &(outer, inner) in &join.links {
                    let (from, to) = (owner[inner], owner[outer]);
                    owner
                        .iter_mut()
                        .filter(|o| **o == from)
                        .for_each(|o| *o = to);
                }
            }
            gather(&owner)
        };
        let mut others: Vec<(f64, (usize, usize))> = Vec::new();
        for (k, (first, rest)) in chosen.iter().enumerate() {
            for (j, join) in rest.iter().enumerate() {
                others.push((join.score - first.score, (k, j)));
            }
        }
        others.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut all = vec![Grouping {
            faces: faces(None),
            score: 0.0,
        }];
        all.extend(others.into_iter().take(4).map(|(score, at)| Grouping {
            faces: faces(Some(at)),
            score,
        }));
        all
    }

    fn parallel(&self, i: usize, j: usize) -> Option<(Tilt, Tilt)> {
        let (p, q) = (self.rings[i].plane?, self.rings[j].plane?);
        let slope = 1.0 + p.a.hypot(p.b);
        ((p.a - q.a).hypot(p.b - q.b) < PARALLEL * slope * slope).then_some((p, q))
    }

    /// Share of loop `j`'s points drawn inside loop `i`.
    fn inside(&self, i: usize, j: usize) -> f64 {
        let (outer, inner) = (&self.rings[i], &self.rings[j]);
        if inner.area.abs() >= outer.area.abs() {
            return 0.0;
        }
        let n = inner.polygon.len();
        let hits = inner
            .polygon
            .iter()
            .filter(|p| contains(&outer.polygon, **p))
            .count();
        hits as f64 / n.max(1) as f64
    }

    fn share_vertex(&self, i: usize, j: usize) -> bool {
        self.rings[i]
            .vertices
            .iter()
            .any(|v| self.rings[j].vertices.contains(v))
    }

    /// Loops of one part in one plane, one inside the other.
    fn join_within_parts(&self, owner: &mut [usize]) {
        for j in 0..self.rings.len() {
            let mut best: Option<usize> = None;
            for i in 0..self.rings.len() {
                let (a, b) = (&self.rings[i], &self.rings[j]);
                if i == j || a.part != b.part || a.area * b.area >= 0.0 || self.share_vertex(i, j) {
                    continue;
                }
                let Some((p, q)) = self.parallel(i, j) else {
                    continue;
                };
                let Some(&at) = b.polygon.first() else {
                    continue;
                };
                let slope = 1.0 + p.a.hypot(p.b);
                if (p.depth(at) - q.depth(at)).abs() > SAME * slope * self.size
                    || self.inside(i, j) < 0.95
                {
                    continue;
                }
                if best.is_none_or(|k| a.area.abs() < self.rings[k].area.abs()) {
                    best = Some(i);
                }
            }
            if let Some(i) = best {
                let (from, to) = (owner[j], owner[i]);
                owner
                    .iter_mut()
                    .filter(|o| **o == from)
                    .for_each(|o| *o = to);
            }
        }
    }

    /// The ways to join a part to those placed, best first.
    fn joins(&self, part: usize, placed: &[Option<f64>]) -> Vec<Join> {
        let mut links: Vec<(f64, bool, f64, usize, usize)> = Vec::new();
        for (j, b) in self.rings.iter().enumerate() {
            for (i, a) in self.rings.iter().enumerate() {
                let other = if a.part == part { b.part } else { a.part };
                if (a.part == part) == (b.part == part) {
                    continue;
                }
                let Some(base) = placed[other] else { continue };
                let Some((p, q)) = self.parallel(i, j) else {
                    continue;
                };
                let inside = self.inside(i, j);
                if inside < 0.9 {
                    continue;
                }
                let Some(&at) = b.polygon.first() else {
                    continue;
                };
                let shift = if b.part == part {
                    base + p.depth(at) - q.depth(at)
                } else {
                    base + q.depth(at) - p.depth(at)
                };
                links.push((shift, a.area * b.area > 0.0, inside, i, j));
            }
        }
        links.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut joins = Vec::new();
        for same_sense in [false, true] {
            let list: Vec<_> = links.iter().filter(|l| l.1 == same_sense).collect();
            let mut start = 0;
            while start < list.len() {
                let mut end = start + 1;
                while end < list.len() && list[end].0 - list[start].0 < 3.0 * SAME * self.size {
                    end += 1;
                }
                joins.push(self.join(part, placed, &list[start..end]));
                start = end;
            }
        }
        joins.sort_by(|a, b| b.score.total_cmp(&a.score));
        joins
    }

    fn join(
        &self,
        part: usize,
        placed: &[Option<f64>],
        links: &[&(f64, bool, f64, usize, usize)],
    ) -> Join {
        let shift = links.iter().map(|l| l.0).sum::<f64>() / links.len() as f64;
        // An inner loop belongs to the smallest outer one around it.
        let mut pairs: Vec<(usize, usize)> = Vec::new();
        for &&(.., i, j) in links {
            match pairs.iter_mut().find(|p| p.1 == j) {
                Some(pair) => {
                    if self.rings[i].area.abs() < self.rings[pair.0].area.abs() {
                        pair.0 = i;
                    }
                }
                None => pairs.push((i, j)),
            }
        }
        let inside = self.inside_body(part, placed, shift);
        let size: f64 = pairs
            .iter()
            .map(|&(i, j)| (self.rings[j].area / self.rings[i].area).abs().sqrt())
            .sum::<f64>()
            / pairs.len() as f64;
        let score = 3.0 * pairs.len() as f64 + 3.0 * inside + size;
        Join {
            links: pairs,
            shift,
            score,
        }
    }

    /// Share of a part's vertices inside the box of what is placed, along the axes.
    fn inside_body(&self, part: usize, placed: &[Option<f64>], shift: f64) -> f64 {
        let point = |v: usize, by: f64| {
            let p = self.drawing.vertices[v].extend(self.pieces.depth(v) + by);
            match self.pieces.axes.as_slice() {
                [x, y, z] => DVec3::new(p.dot(*x), p.dot(*y), p.dot(*z)),
                [x] => DVec3::splat(p.dot(*x)),
                _ => p,
            }
        };
        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        for ring in &self.rings {
            if let Some(by) = placed[ring.part] {
                for &v in &ring.vertices {
                    low = low.min(point(v, by));
                    high = high.max(point(v, by));
                }
            }
        }
        let slack = DVec3::splat(SAME * self.size);
        let (low, high) = (low - slack, high + slack);
        let (mut hits, mut count) = (0, 0);
        for &v in self
            .rings
            .iter()
            .filter(|r| r.part == part)
            .flat_map(|r| &r.vertices)
        {
            let p = point(v, shift);
            count += 1;
            hits += usize::from(p.cmpge(low).all() && p.cmple(high).all());
        }
        f64::from(hits as u32) / f64::from(count.max(1) as u32)
    }
}

fn gather(owner: &[usize]) -> Vec<Vec<usize>> {
    let mut faces: Vec<Vec<usize>> = vec![Vec::new(); owner.len()];
    for (i, &o) in owner.iter().enumerate() {
        faces[o].push(i);
    }
    faces.retain(|f| !f.is_empty());
    faces
}
