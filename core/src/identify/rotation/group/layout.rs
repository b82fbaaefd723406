//! How a loop lies in the face that it would be in, next to the face's other loops.

use glam::DVec2;

use super::body::Place;
use super::joins::{Joiner, State};
use super::links::{Link, LinkKind};
use super::shapes::Outline;

/// A plane of another part that is parallel to a loop's.
pub(super) struct Parallel {
    part: usize,
    /// Level of the loop's own plane in the middle of the loop, in its part.
    own: f64,
    /// Level of this one there, in its part.
    level: f64,
    /// Difference of level up to which they are one.
    slack: f64,
}

/// How fast thin walls become likelier as they grow, for a share of the face's extent.
const WALLS: f64 = 20.0;

/// Largest denominator of a round fraction.
const ROUNDEST: u32 = 20;

/// The least denominator of a fraction that a number is within an error.
fn denominator(x: f64, error: f64) -> Option<f64> {
    let mut all = (1..=ROUNDEST).map(f64::from);
    all.find(|n| (x * n - (x * n).round()).abs() < error * n)
}

impl Joiner<'_> {
    pub(super) fn clearance(&self, link: &Link) -> f64 {
        let (a, b) = (
            &self.shapes.loops[link.outer],
            &self.shapes.loops[link.inner],
        );
        let n = a.polygon.len();
        let step = b.polygon.len().div_ceil(12).max(1);
        let mut least = f64::INFINITY;
        for p in b.polygon.iter().step_by(step) {
            for i in 0..n {
                let (s, t) = (a.polygon[i], a.polygon[(i + 1) % n]);
                let d = t - s;
                let u =
                    ((*p - s).dot(d) / d.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
                least = least.min(p.distance_squared(s + d * u));
            }
        }
        (least.sqrt() / b.area.abs().sqrt().max(1e-6 * self.shapes.size)).min(2.0)
    }

    /// Extent of a loop in the plane of the one that it may share a face with, along the two axes of
    /// that plane if it is normal to the third: low, high.
    fn extent(&self, outer: usize, outline: usize) -> Option<(DVec2, DVec2)> {
        let [x, y, z] = self.shapes.frame()?;
        let plane = self.shapes.loops[outer].plane?;
        let normal = plane.normal();
        let pairs = [(x, [y, z]), (y, [x, z]), (z, [x, y])];
        let (_, [u, v]) = pairs
            .into_iter()
            .find(|(n, _)| n.dot(normal).abs() > 0.999)?;
        let places = self.shapes.loops[outline].polygon.iter().map(|p| {
            let place = plane.place(*p);
            DVec2::new(place.dot(*u), place.dot(*v))
        });
        let start = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        Some(places.fold(start, |(l, h), p| (l.min(p), h.max(p))))
    }

    /// Extents of the outer and the inner loop of a link in their plane, if it is one.
    fn extents(&self, link: &Link) -> Option<[(DVec2, DVec2); 2]> {
        let extent = |i| self.extent(link.outer, i);
        (link.kind == LinkKind::Coplanar)
            .then(|| extent(link.outer).zip(extent(link.inner)))
            .flatten()
            .map(<[_; 2]>::from)
    }

    /// Parts are laid out in round numbers, so that the places of walls and middles are round
    /// fractions of the face's extents. For each of the two directions the log-odds of the roundest
    /// against chance.
    pub(super) fn roundness(&self, link: &Link) -> f64 {
        let Some([(a, b), (c, d)]) = self.extents(link) else {
            return 0.0;
        };
        let evidence = |k: usize| {
            let whole = b[k] - a[k];
            let error = self.shapes.exactly() / whole;
            let at = |x: f64| {
                let n = denominator((x - a[k]) / whole, error);
                n.map_or(0.0, |n| -(2.0 * error * n * n).ln())
            };
            let places = [c[k], (c[k] + d[k]) / 2.0, d[k]];
            places.into_iter().map(at).fold(0.0, f64::max)
        };
        evidence(0) + evidence(1)
    }

    /// How thin the wall between a loop and the outline of its face is, in their plane along its
    /// axes: 1 if there is none, falling with its share of the face's extent.
    pub(super) fn thinness(&self, link: &Link) -> f64 {
        let Some([(a, b), (c, d)]) = self.extents(link) else {
            return 0.0;
        };
        let thin = |k: usize| (c[k] - a[k]).min(b[k] - d[k]) / (b[k] - a[k]);
        (-WALLS * thin(0).min(thin(1)).max(0.0)).exp()
    }

    fn same(&self, a: f64, b: f64) -> bool {
        (a - b).abs() < self.shapes.near()
    }

    /// Distance between the centres of two circles in their plane.
    fn eccentricity(&self, a: usize, b: usize) -> Option<f64> {
        let (p, q) = (self.shapes.loops[a].line?, self.shapes.loops[b].line?);
        let n = self.shapes.axes[p.axis];
        let d = q.at - p.at;
        let camera = &self.shapes.camera;
        let along = camera.drawn(n, p.at).normalize_or(DVec2::X);
        let facing = camera.facing(n, p.at).abs().max(1e-3);
        (p.axis == q.axis).then(|| d.perp_dot(along).hypot(d.dot(along) / facing))
    }

    pub(super) fn centred(&self, link: &Link) -> f64 {
        if let Some(d) = self.eccentricity(link.outer, link.inner)
            && self.same(d, 0.0)
        {
            return 2.0 * self.shapes.telling();
        }
        let [Some((a, b)), Some((c, d))] =
            [link.outer, link.inner].map(|i| self.extent(link.outer, i))
        else {
            return 0.0;
        };
        let (p, q) = (a + b, c + d);
        let hits = [self.same(p.x, q.x), self.same(p.y, q.y)];
        self.shapes.telling() * hits.iter().filter(|h| **h).count() as f64
    }

    pub(super) fn aligned(&self, link: &Link, state: &State) -> f64 {
        // On one circle around the outer one's centre.
        if let Some(d) = self.eccentricity(link.outer, link.inner)
            && state.inner[link.outer].iter().any(|&i| {
                i != link.inner
                    && self
                        .eccentricity(link.outer, i)
                        .is_some_and(|e| self.same(d, e))
            })
        {
            return 2.0 * self.shapes.telling();
        }
        let Some((a, b)) = self.extent(link.outer, link.inner) else {
            return 0.0;
        };
        let mut hits = [false; 2];
        for &other in state.inner[link.outer].iter().filter(|o| **o != link.inner) {
            let Some((c, d)) = self.extent(link.outer, other) else {
                continue;
            };
            for (k, hit) in hits.iter_mut().enumerate() {
                *hit |= self.same(a[k], c[k])
                    || self.same(b[k], d[k])
                    || self.same(a[k] + b[k], c[k] + d[k]);
            }
        }
        self.shapes.telling() * hits.iter().filter(|h| **h).count() as f64
    }

    /// Share of a part's planes parallel to the one it is linked in, but for those linked, that are
    /// in one plane with one placed.
    pub(super) fn level(&self, part: usize, place: Place, list: &[usize], state: &State) -> f64 {
        let loops = &self.shapes.loops;
        let (mut count, mut hits) = (0usize, 0usize);
        for &i in &self.shapes.parts[part].loops {
            let linked = list.iter().any(|&l| {
                let link = &self.links[l];
                link.outer == i || link.inner == i
            });
            if linked || loops[i].plane.is_none() {
                continue;
            }
            count += 1;
            let same = |other: &Parallel| {
                state.placed[other.part].is_some_and(|base| {
                    (other.own + place.shift - other.level - base.shift).abs() < other.slack
                })
            };
            let others = self.parallels[i].get_or_init(|| self.parallels_of(i));
            hits += usize::from(others.iter().any(same));
        }
        if count == 0 {
            0.0
        } else {
            hits as f64 / count as f64
        }
    }
}

impl Joiner<'_> {
    /// The planes of other parts that are parallel to a loop's.
    fn parallels_of(&self, outline: usize) -> Vec<Parallel> {
        let own = &self.shapes.loops[outline];
        let at = (own.low + own.high) / 2.0;
        let others = self.shapes.loops.iter().filter(|b| b.part != own.part);
        let parallel = |b: &Outline| {
            let (p, q) = self.shapes.parallel(own, b)?;
            Some(Parallel {
                part: b.part,
                own: p.level(at),
                level: q.level(at),
                slack: self.shapes.slack(b.depth_error(self.shapes.error)),
            })
        };
        others.filter_map(parallel).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::score::HandJoinScorer;
    use super::super::tests::{in_perspective, lifted};
    use super::*;
    use crate::identify::testing::holed_cube;

    #[test]
    fn round_fractions_have_small_denominators() {
        assert_eq!(denominator(0.3, 1e-4), Some(10.0));
        assert_eq!(denominator(2.0 / 3.0 + 5e-5, 1e-4), Some(3.0));
        assert_eq!(denominator(0.3003, 1e-4), None);
        assert_eq!(denominator(f64::NAN, 1e-4), None);
    }

    #[test]
    fn a_hole_has_the_same_place_in_either_projection() {
        // From 0.3 to 0.6 of the face: 3/5 is the roundest place, and the wall is 0.3 of it.
        for drawing in [holed_cube(), in_perspective(holed_cube())] {
            lifted(&drawing, |shapes, links| {
                let main = shapes.main_part().unwrap();
                let joiner = Joiner::new(shapes, links, &HandJoinScorer);
                let ends: Vec<&Link> = links
                    .iter()
                    .filter(|l| shapes.loops[l.outer].part == main)
                    .filter(|l| (joiner.thinness(l) - (-0.3 * WALLS).exp()).abs() < 1e-4)
                    .collect();
                assert!(ends.len() >= 2, "{links:?}");
                let round = joiner.roundness(ends[0]);
                let error = shapes.exactly() / (shapes.size * 2.0);
                assert!(round > 2.0 * -(2.0 * error * 100.0).ln(), "{round}");
            });
        }
    }
}
