//! What kind of surface each loop looks as if it bounded, before and after grouping.
//!
//! The two loops of a whole circle that shares no vertex look alike, so nothing can tell which of
//! them bounds the plane and which the cylinder. Grouping takes both for plane, and what it makes
//! of them says which one is not.

use super::group::Grouping;
use super::{LoopKinds, Triples};
use crate::drawing::{CoEdge, Curve2, Drawing, Graph, SurfaceKind};
use crate::identify::kinds::{is_ring, kinds_of, ruled_out};

/// Least probability at which a whole circle may bound a plane: an outline of a ball does not.
const FLAT: f64 = 0.1;

/// The same, if its other loop is known to bound something else: of two kinds one is the plane.
const FLAT_BESIDE: f64 = 0.25;

/// What is added to probabilities before they are multiplied, so that none forbids a kind.
const DOUBT: f64 = 0.02;

type Shares = [f64; SurfaceKind::ALL.len()];

/// How the loops of a rotation system look.
pub(super) struct Looks {
    /// Kinds for grouping.
    pub(super) kinds: Vec<SurfaceKind>,
    /// Probabilities, where a model tells them.
    shares: Vec<Shares>,
    /// The other loop of a whole circle whose kinds are not known apart.
    twin: Vec<Option<usize>>,
}

impl Looks {
    /// The looks of loops; `told` is the model's opinion, `exact` whether what is drawn parallel is.
    pub(super) fn new(
        drawing: &Drawing,
        graph: &Graph,
        triples: &Triples,
        walks: &[Vec<CoEdge>],
        told: Option<&dyn LoopKinds>,
        exact: bool,
    ) -> Self {
        let Some(told) = told else {
            let walks: Vec<&[CoEdge]> = walks.iter().map(Vec::as_slice).collect();
            return Self {
                kinds: kinds_of(drawing, &walks),
                shares: Vec::new(),
                twin: vec![None; walks.len()],
            };
        };
        let mut shares = told.kinds(graph, triples, walks);
        if exact {
            for (own, walk) in shares.iter_mut().zip(walks) {
                let impossible = ruled_out(drawing, walk);
                for (share, kind) in own.iter_mut().zip(SurfaceKind::ALL) {
                    if Some(kind) == impossible {
                        *share = 0.0;
                    }
                }
            }
        }
        let flat = |s: &Shares| {
            let place = SurfaceKind::ALL
                .iter()
                .position(|k| *k == SurfaceKind::Plane);
            place.map_or(0.0, |p| s[p])
        };
        let twin: Vec<Option<usize>> = walks
            .iter()
            .enumerate()
            .map(|(i, walk)| {
                let &[only] = walk.as_slice() else {
                    return None;
                };
                let circle = matches!(drawing.edges[only.edge()].curve, Curve2::Ellipse(_));
                let other = walks.iter().position(|w| *w == [only.mate()])?;
                (circle && flat(&shares[i]) >= FLAT).then_some(other)
            })
            .collect();
        let kinds = shares
            .iter()
            .zip(&twin)
            .zip(walks)
            .map(|((s, twin), walk)| match (twin, likeliest(&[s], &[])) {
                (Some(_), _) => SurfaceKind::Plane,
                // An end is likelier than a tip that no line shows.
                (None, SurfaceKind::Cone) if flat(s) >= FLAT && is_ring(drawing, walk) => {
                    SurfaceKind::Plane
                }
                (None, kind) => kind,
            })
            .collect();
        Self {
            kinds,
            shares,
            twin,
        }
    }

    /// The kind of each face that a grouping makes of the loops.
    pub(super) fn of_faces(&self, grouping: &Grouping) -> Vec<SurfaceKind> {
        let mut face_of = vec![0; self.kinds.len()];
        for (f, list) in grouping.faces.iter().enumerate() {
            list.iter().for_each(|&i| face_of[i] = f);
        }
        let alone = |i: usize| grouping.faces[face_of[i]].len() == 1;
        let of = |(f, list): (usize, &Vec<usize>)| {
            let own = self.kinds[list[0]];
            if grouping.round[f] {
                return self.round(list);
            }
            if grouping.flat[f] {
                return SurfaceKind::Plane;
            }
            let (&[only], Some(twin)) = (list.as_slice(), self.twin[list[0]]) else {
                return own;
            };
            let plane = SurfaceKind::ALL
                .iter()
                .position(|k| *k == SurfaceKind::Plane);
            let flat = plane.map_or(0.0, |p| self.shares[only][p]);
            let curved = if alone(twin) {
                // A disc has no thickness: one of the two is a cap.
                only > twin
            } else {
                !grouping.round[face_of[twin]] || flat < FLAT_BESIDE
            };
            match curved {
                // No cylinder ends in one circle.
                true => likeliest(
                    &[&self.shares[only]],
                    &[SurfaceKind::Plane, SurfaceKind::Cylinder],
                ),
                false => SurfaceKind::Plane,
            }
        };
        grouping.faces.iter().enumerate().map(of).collect()
    }

    /// Kind of a surface of revolution between loops.
    fn round(&self, list: &[usize]) -> SurfaceKind {
        if !self.shares.is_empty() {
            let rows: Vec<&Shares> = list.iter().map(|&i| &self.shares[i]).collect();
            return likeliest(&rows, &[SurfaceKind::Plane]);
        }
        // Two circles with nothing drawn between them: of what they bound a cone is likeliest.
        let kinds = list.iter().map(|&i| self.kinds[i]);
        let curved = |k: &SurfaceKind| *k != SurfaceKind::Plane;
        kinds.filter(curved).min().unwrap_or(SurfaceKind::Cone)
    }
}

/// The kind that all rows agree on best, but for some.
fn likeliest(rows: &[&Shares], without: &[SurfaceKind]) -> SurfaceKind {
    let support = |k: usize| rows.iter().map(|r| (r[k] + DOUBT).ln()).sum::<f64>();
    let kinds = SurfaceKind::ALL.iter().enumerate();
    kinds
        .filter(|(_, kind)| !without.contains(kind))
        .max_by(|a, b| support(a.0).total_cmp(&support(b.0)))
        .map_or(SurfaceKind::Other, |(_, kind)| *kind)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use glam::DVec2;

    use super::*;
    use crate::drawing::Edge;

    fn shares(list: &[(SurfaceKind, f64)]) -> Shares {
        SurfaceKind::ALL.map(|k| list.iter().find(|l| l.0 == k).map_or(0.0, |l| l.1))
    }

    fn grouping(faces: &[&[usize]], round: &[bool]) -> Grouping {
        Grouping {
            faces: faces.iter().map(|f| f.to_vec()).collect(),
            sureness: vec![1.0; faces.len()],
            round: round.to_vec(),
            flat: vec![false; faces.len()],
            reversed: vec![false; faces.iter().map(|f| f.len()).sum()],
            score: 0.0,
        }
    }

    /// A pin: two circles, each with two loops that look alike.
    #[test]
    fn what_is_left_of_a_pin_are_its_ends() {
        use SurfaceKind::{Cylinder, Plane, Sphere};
        let end = shares(&[(Plane, 0.4), (Cylinder, 0.6)]);
        let looks = Looks {
            kinds: vec![Plane; 4],
            shares: vec![end; 4],
            twin: vec![Some(1), Some(0), Some(3), Some(2)],
        };
        let pin = grouping(&[&[0, 2], &[1], &[3]], &[true, false, false]);
        assert_eq!(looks.of_faces(&pin), [Cylinder, Plane, Plane]);
        // With a dome instead of one end, a plane is too unlikely.
        let dome = shares(&[(Plane, 0.15), (Cylinder, 0.45), (Sphere, 0.4)]);
        let looks = Looks {
            shares: vec![end, end, dome, dome],
            ..looks
        };
        assert_eq!(looks.of_faces(&pin)[2], Sphere);
        // A dimple in a plane: its circle's other loop is in the plane.
        let dimple = grouping(&[&[0, 2], &[1], &[3]], &[false; 3]);
        assert_ne!(looks.of_faces(&dimple)[2], Plane);
    }

    /// Always of one opinion.
    struct Told(Shares);

    impl LoopKinds for Told {
        fn kinds(&self, _: &Graph, _: &Triples, loops: &[Vec<CoEdge>]) -> Vec<Shares> {
            vec![self.0; loops.len()]
        }
    }

    /// The end of a pin, its circle cut in two by the outlines.
    #[test]
    fn an_end_is_likelier_than_a_tip_that_no_line_shows() {
        use SurfaceKind::{Cone, Cylinder, Plane};
        let half = |from: f64| -> Edge {
            let at = |k: i32| DVec2::from_angle(from + PI * f64::from(k) / 24.0);
            let points: Vec<DVec2> = (0..=24).map(|k| at(k) * DVec2::new(1.0, 0.4)).collect();
            Edge::drawn(if from == 0.0 { [0, 1] } else { [1, 0] }, points)
        };
        let drawing =
            Drawing::orthographic(vec![DVec2::X, DVec2::NEG_X], vec![half(0.0), half(PI)]);
        let graph = Graph::new(&drawing);
        let triples = Triples::new(&graph);
        let end = vec![CoEdge::new(0, false), CoEdge::new(1, false)];
        let looks = |list: &[(SurfaceKind, f64)], walk: &[CoEdge]| {
            let told = Told(shares(list));
            let walks = [walk.to_vec()];
            Looks::new(&drawing, &graph, &triples, &walks, Some(&told), true).kinds[0]
        };
        assert_eq!(looks(&[(Plane, 0.2), (Cone, 0.8)], &end), Plane);
        assert_eq!(looks(&[(Plane, 0.02), (Cone, 0.98)], &end), Cone);
        assert_eq!(looks(&[(Plane, 0.2), (Cylinder, 0.8)], &end), Cylinder);
        assert_eq!(looks(&[(Plane, 0.2), (Cone, 0.8)], &end[..1]), Cone);
    }
}
