//! Variations of a drawing that have the same faces.

use glam::DVec2;

use crate::drawing::{Curve2, Drawing};

/// How drawings are varied for training. The default changes nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Augment {
    /// Mirror every other drawing.
    pub mirror: bool,
    /// Turn drawings by any angle.
    pub rotate: bool,
    /// Number vertices and edges anew.
    pub renumber: bool,
    /// Walk every other edge the other way.
    pub reverse: bool,
    /// Largest standard deviation of the error of coordinates, over the drawing's half diagonal;
    /// each drawing gets its own, from 0 up to this.
    pub noise: f64,
    /// Seed; the same seed gives the same variations of the same drawings in the same order.
    pub seed: u64,
}

impl Augment {
    /// The variation of a drawing that is number `index` of its data set.
    pub fn apply(&self, drawing: &Drawing, index: u64) -> Drawing {
        let mut random = Random::new(self.seed, index);
        let mut varied = drawing.clone();
        if self.renumber {
            let mut permutation = |n| random.permutation(n);
            let vertices = permutation(varied.vertices.len());
            let edges = permutation(varied.edges.len());
            varied = varied.renumbered(&vertices, &edges);
        }
        if self.reverse {
            reverse(&mut varied, &mut random);
        }
        let mirror = self.mirror && random.below(2) == 1;
        let turn = if self.rotate {
            DVec2::from_angle(random.unit() * std::f64::consts::TAU)
        } else {
            DVec2::X
        };
        let noise = self.noise * random.unit() * varied.size();
        if !mirror && turn == DVec2::X && noise == 0.0 {
            return varied;
        }
        if let Some(truth) = &mut varied.truth {
            // Places in space are not trained on; wrong ones must not be left.
            truth.vertices3d.clear();
            truth.edges3d.clear();
        }
        let shape = |p: DVec2| turn.rotate(if mirror { DVec2::new(-p.x, p.y) } else { p });
        let mut error = || DVec2::new(random.normal(), random.normal()) * noise;
        for v in &mut varied.vertices {
            *v = shape(*v) + error();
        }
        for edge in &mut varied.edges {
            let last = edge.points.len() - 1;
            for (k, p) in edge.points.iter_mut().enumerate() {
                *p = match k {
                    0 => varied.vertices[edge.v[0]],
                    k if k == last => varied.vertices[edge.v[1]],
                    _ => shape(*p) + error(),
                };
            }
            if !edge.is_straight() {
                edge.curve = match Curve2::recognise_within(&edge.points, 3.0 * noise) {
                    // Noise bends no line; what was curved stays so.
                    Curve2::Line => Curve2::Polyline,
                    curve => curve,
                };
            }
        }
        varied
    }
}

fn reverse(drawing: &mut Drawing, random: &mut Random) {
    let turned: Vec<bool> = drawing.edges.iter().map(|_| random.below(2) == 1).collect();
    for (edge, _) in drawing.edges.iter_mut().zip(&turned).filter(|(_, t)| **t) {
        edge.v.swap(0, 1);
        edge.points.reverse();
        if !edge.is_straight() {
            edge.curve = Curve2::recognise(&edge.points);
        }
    }
    let Some(truth) = &mut drawing.truth else {
        return;
    };
    for c in truth.faces.iter_mut().flat_map(|f| &mut f.loops).flatten() {
        if turned[c.edge()] {
            *c = c.mate();
        }
    }
    for (polyline, _) in truth.edges3d.iter_mut().zip(&turned).filter(|(_, t)| **t) {
        polyline.reverse();
    }
}

/// SplitMix64 (Steele, Lea and Flood 2014): small, and good enough for choices like these.
struct Random(u64);

impl Random {
    fn new(seed: u64, index: u64) -> Self {
        let mut random = Self(seed ^ index.wrapping_mul(0xD134_2543_DE82_EF95));
        random.next();
        random
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }

    /// Standard normal (Box and Muller 1958).
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.unit()).ln()).sqrt();
        radius * (self.unit() * std::f64::consts::TAU).cos()
    }

    fn permutation(&mut self, n: usize) -> Vec<usize> {
        let mut list: Vec<usize> = (0..n).collect();
        for k in (1..n).rev() {
            list.swap(k, self.below(k + 1));
        }
        list
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Graph;
    use crate::identify::rotation::{Triples, samples};

    const ALL: Augment = Augment {
        mirror: true,
        rotate: true,
        renumber: true,
        reverse: true,
        noise: 0.0,
        seed: 7,
    };

    fn scores(drawing: &Drawing) -> Vec<f64> {
        let graph = Graph::new(drawing);
        let triples = Triples::new(&graph);
        let mut scores = samples::hand_scores(drawing, &graph, &triples);
        scores.sort_by(f64::total_cmp);
        scores
    }

    #[test]
    fn varied_drawings_score_the_same() {
        // Not the two arcs: where edges go on smoothly, rounding decides on which side they leave.
        for drawing in [samples::cube(), samples::pyramid()] {
            let before = scores(&drawing);
            for index in 0..4 {
                let after = scores(&ALL.apply(&drawing, index));
                for (a, b) in before.iter().zip(&after) {
                    assert!((a - b).abs() < 1e-3, "{a} {b}");
                }
            }
        }
    }

    #[test]
    fn the_seed_decides() {
        let drawing = samples::pyramid();
        let noisy = Augment { noise: 1e-3, ..ALL };
        assert_eq!(noisy.apply(&drawing, 3), noisy.apply(&drawing, 3));
        assert_ne!(noisy.apply(&drawing, 3), noisy.apply(&drawing, 4));
        assert_eq!(Augment::default().apply(&drawing, 3), drawing);
    }
}
