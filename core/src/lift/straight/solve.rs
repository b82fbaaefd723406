//! The least-squares problem: vertices stay where they are drawn as far as what is straight allows.

use std::f64::consts::SQRT_2;

use glam::DVec2;

use super::circles::{Circle, circles, coaxial};
use super::parallelograms::Sides;
use crate::drawing::Drawing;
use crate::lift::directions::Directions;
use crate::lift::system::System;

/// Weight of what has to hold beside a drawn vertex.
const STRONG: f64 = 1e3;

/// Weight of a drawn point of a circle beside a vertex.
const POINT: f64 = 0.5;

/// Weight of staying for what nothing tells.
const WEAK: f64 = 1e-3;

/// Points of an arc that are looked at, beside its ends.
const POINTS: usize = 7;

/// Newton steps: edges that follow axes are linear, circles and free directions are not.
const STEPS: usize = 4;

/// What the reading says of the error counts as so many edges.
const PRIOR: f64 = 4.0;

/// The error of all is at most so many times that of most.
const WILD: f64 = 4.0;

/// Half of all normal errors are smaller than this many standard errors.
const QUARTILE: f64 = 0.6745;

/// Errors by which a vertex may be moved.
const TORN: f64 = 4.0;

/// Rounds of letting go, and the most conditions that are let go in one.
const ROUNDS: usize = 8;
const AT_ONCE: usize = 16;

/// What has to hold.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Condition {
    /// An edge is drawn along an axis.
    Along { edge: usize, axis: usize },
    /// A vertex is on a circle.
    On { vertex: usize, circle: usize },
    /// Two edges are one vector, the second one times a sign; what it is in one direction.
    Alike {
        edges: [usize; 2],
        sign: f64,
        direction: DVec2,
    },
    /// Two circles are around one line.
    Coaxial { circles: [usize; 2] },
}

/// A drawing with its conditions.
pub(super) struct Bundle<'a> {
    drawing: &'a Drawing,
    directions: &'a Directions,
    circles: Vec<Circle>,
    conditions: Vec<Condition>,
}

/// A solution.
pub(super) struct Fitted {
    pub(super) vertices: Vec<DVec2>,
    /// Standard error of most drawn coordinates.
    pub(super) typical: f64,
    /// That of all, with those that the conditions do not explain.
    pub(super) error: f64,
}

impl<'a> Bundle<'a> {
    pub(super) fn new(drawing: &'a Drawing, directions: &'a Directions, all: &[Sides]) -> Self {
        let mut conditions = Vec::new();
        for (axis, a) in directions.axes.iter().enumerate() {
            let along = a.edges.iter().map(|&edge| Condition::Along { edge, axis });
            conditions.extend(along);
        }
        for sides in all {
            let axis = sides
                .edges
                .first()
                .and_then(|m| directions.axis_of_edge(m.0));
            // Across an axis they are alike already.
            let along = axis.map(|k| directions.axes[k].direction.truncate().normalize());
            let ways = along.map_or(vec![DVec2::X, DVec2::Y], |along| vec![along]);
            for pair in sides.edges.windows(2) {
                let (edges, sign) = ([pair[0].0, pair[1].0], pair[0].1 * pair[1].1);
                conditions.extend(ways.iter().map(|&direction| Condition::Alike {
                    edges,
                    sign,
                    direction,
                }));
            }
        }
        let circles = circles(drawing, directions);
        for (circle, c) in circles.iter().enumerate() {
            let mut ends: Vec<usize> = c.edges.iter().flat_map(|&e| drawing.edges[e].v).collect();
            ends.sort_unstable();
            ends.dedup();
            conditions.extend(
                ends.into_iter()
                    .map(|vertex| Condition::On { vertex, circle }),
            );
        }
        let pairs = coaxial(&circles, directions).into_iter();
        conditions.extend(pairs.map(|circles| Condition::Coaxial { circles }));
        Self {
            drawing,
            directions,
            circles,
            conditions,
        }
    }

    /// Whether an edge follows an axis after all.
    pub(super) fn follows(&self, edge: usize) -> bool {
        let along = |c: &Condition| matches!(c, Condition::Along { edge: e, .. } if *e == edge);
        self.conditions.iter().any(along)
    }

    /// The circle that an arc is of.
    pub(super) fn circle_of(&self, edge: usize) -> Option<&Circle> {
        self.circles.iter().find(|c| c.edges.contains(&edge))
    }

    /// Solves, and lets go of what pulls vertices too far away.
    pub(super) fn solve(&mut self) -> Option<Fitted> {
        let start = self.circles.clone();
        for _ in 0..ROUNDS {
            let (fitted, forces) = self.fit()?;
            let torn = TORN * fitted.typical;
            let drawn = &self.drawing.vertices;
            let is_torn = |v: usize| fitted.vertices[v].distance(drawn[v]) > torn;
            let mut pulling: Vec<(f64, usize)> = forces
                .iter()
                .enumerate()
                .filter(|(c, _)| self.vertices_of(*c).iter().any(|&v| is_torn(v)))
                .map(|(c, f)| (f.abs(), c))
                .collect();
            if pulling.is_empty() {
                return Some(fitted);
            }
            pulling.sort_by(|a, b| b.0.total_cmp(&a.0));
            // The strongest at each vertex, and no other one near it in one round.
            let mut touched = vec![false; drawn.len()];
            let mut gone = Vec::new();
            for (_, c) in pulling {
                let ends = self.vertices_of(c);
                if gone.len() < AT_ONCE && !ends.iter().any(|&v| touched[v]) {
                    ends.iter().for_each(|&v| touched[v] = true);
                    gone.push(c);
                }
            }
            let mut index = 0;
            self.conditions.retain(|_| {
                index += 1;
                !gone.contains(&(index - 1))
            });
            self.circles.clone_from(&start);
        }
        self.fit().map(|f| f.0)
    }

    fn vertices_of(&self, condition: usize) -> Vec<usize> {
        match self.conditions[condition] {
            Condition::Along { edge, .. } => self.drawing.edges[edge].v.to_vec(),
            Condition::On { vertex, .. } => vec![vertex],
            Condition::Alike { edges, .. } => {
                let ends = edges.map(|e| self.drawing.edges[e].v);
                ends.concat()
            }
            Condition::Coaxial { .. } => Vec::new(),
        }
    }

    /// Solves as it is; also how strongly each condition pulls.
    fn fit(&mut self) -> Option<(Fitted, Vec<f64>)> {
        let drawn = &self.drawing.vertices;
        let mut vertices = drawn.clone();
        let mut forces = vec![0.0; self.conditions.len()];
        for _ in 0..STEPS {
            let system = self.rows(&vertices);
            let x = system.minimise(&vec![true; system.rows().len()]).ok()?;
            for (row, force) in system.rows().iter().zip(&mut forces) {
                *force = row.residual(&x) * row.weight * row.weight;
            }
            let n = drawn.len();
            let at = |i: usize| DVec2::new(x[2 * i], x[2 * i + 1]);
            for (v, p) in vertices.iter_mut().enumerate() {
                *p += at(v);
            }
            for (i, c) in self.circles.iter_mut().enumerate() {
                let k = 2 * n + 3 * i;
                c.center += DVec2::new(x[k], x[k + 1]);
                c.radius = (c.radius + x[k + 2]).max(0.1 * c.radius);
            }
        }
        let finite = vertices.iter().all(|p| p.is_finite());
        finite.then(|| {
            let typical = self.typical_error();
            let squares = vertices
                .iter()
                .zip(drawn)
                .map(|(p, q)| p.distance_squared(*q));
            // Circles take as many conditions as they have numbers.
            let free = 3 * self.circles.len();
            let told = self.conditions.len().saturating_sub(free) as f64;
            let own = (squares.sum::<f64>() / (told + PRIOR)).sqrt();
            let error = own.clamp(typical, WILD * typical);
            (
                Fitted {
                    vertices,
                    typical,
                    error,
                },
                forces,
            )
        })
    }

    /// Standard error of most drawn coordinates, by the median of how far edges along axes are drawn
    /// aside, beside what the reading says.
    fn typical_error(&self) -> f64 {
        let mut offs: Vec<f64> = self
            .conditions
            .iter()
            .filter_map(|c| match *c {
                Condition::Along { edge, axis } => {
                    let [u, v] = self.drawing.edges[edge].v.map(|v| self.drawing.vertices[v]);
                    let along = self.directions.axes[axis].direction.truncate().normalize();
                    Some((v - u).perp_dot(along).abs())
                }
                _ => None,
            })
            .collect();
        offs.sort_by(f64::total_cmp);
        let count = offs.len() as f64;
        let median = offs
            .get(offs.len() / 2)
            .map_or(0.0, |m| m / (QUARTILE * SQRT_2));
        let prior = self.directions.precision;
        ((count * median * median + PRIOR * prior * prior) / (count + PRIOR))
            .sqrt()
            .max(prior)
    }

    /// Rows about the next step, those of the conditions first.
    fn rows(&self, vertices: &[DVec2]) -> System<()> {
        let n = vertices.len();
        let circle = |c: usize| 2 * n + 3 * c;
        let mut system = System::new(2 * n + 3 * self.circles.len());
        // What an edge is in a direction, its terms and its value.
        let part = |edge: usize, d: DVec2| {
            let [u, v] = self.drawing.edges[edge].v;
            let terms = [
                (2 * v, d.x),
                (2 * v + 1, d.y),
                (2 * u, -d.x),
                (2 * u + 1, -d.y),
            ];
            (terms, (vertices[v] - vertices[u]).dot(d))
        };
        for condition in &self.conditions {
            match *condition {
                Condition::Along { edge, axis } => {
                    let d = self.directions.axes[axis].direction.truncate().normalize();
                    let (terms, off) = part(edge, d.perp());
                    system.push(terms, -off, STRONG, ());
                }
                Condition::Alike {
                    edges: [e, f],
                    sign,
                    direction,
                } => {
                    let (terms, one) = part(e, direction);
                    let (others, other) = part(f, direction * sign);
                    let terms = terms.into_iter().chain(others.map(|(i, c)| (i, -c)));
                    system.push(terms, other - one, STRONG, ());
                }
                Condition::On { vertex, circle: c } => {
                    let (own, at) = (&self.circles[c], circle(c));
                    let s = own.slope(vertices[vertex]);
                    let scale = s.length().recip();
                    let terms = [
                        (2 * vertex, s.x),
                        (2 * vertex + 1, s.y),
                        (at, -s.x),
                        (at + 1, -s.y),
                        (at + 2, -1.0),
                    ];
                    let terms = terms.map(|(i, c)| (i, c * scale));
                    system.push(terms, -own.outside(vertices[vertex]) * scale, STRONG, ());
                }
                Condition::Coaxial { circles: [a, b] } => {
                    let axis = self.directions.axes[self.circles[a].axis].direction;
                    let s = axis.truncate().normalize_or(DVec2::X).perp();
                    let (i, j) = (circle(a), circle(b));
                    let terms = [(j, s.x), (j + 1, s.y), (i, -s.x), (i + 1, -s.y)];
                    let apart = self.circles[b].center - self.circles[a].center;
                    system.push(terms, -apart.dot(s), STRONG, ());
                }
            }
        }
        for (v, (p, q)) in vertices.iter().zip(&self.drawing.vertices).enumerate() {
            system.push([(2 * v, 1.0)], q.x - p.x, 1.0, ());
            system.push([(2 * v + 1, 1.0)], q.y - p.y, 1.0, ());
        }
        for (c, own) in self.circles.iter().enumerate() {
            let at = circle(c);
            for &e in &own.edges {
                let points = &self.drawing.edges[e].points;
                let last = points.len() - 1;
                for i in 1..=POINTS {
                    let p = points[i * last / (POINTS + 1)];
                    let s = own.slope(p);
                    let scale = s.length().recip();
                    let terms = [(at, -s.x), (at + 1, -s.y), (at + 2, -1.0)];
                    let terms = terms.map(|(i, c)| (i, c * scale));
                    system.push(terms, -own.outside(p) * scale, POINT, ());
                }
            }
        }
        for i in 2 * n..system.unknowns() {
            system.push([(i, 1.0)], 0.0, WEAK, ());
        }
        system
    }
}
