//! How a loop lies in the face that it would be in, next to the face's other loops.

use glam::DVec2;

use super::body::Place;
use super::joins::{Joiner, State};
use super::links::Link;

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
        let (Some((a, b)), Some((c, d))) = (
            self.extent(link.outer, link.outer),
            self.extent(link.outer, link.inner),
        ) else {
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
            let at = (loops[i].low + loops[i].high) / 2.0;
            hits += usize::from(loops.iter().any(|b| {
                b.part != part
                    && state.placed[b.part].is_some_and(|base| {
                        self.shapes.parallel(&loops[i], b).is_some_and(|(p, q)| {
                            (p.level(at) + place.shift - q.level(at) - base.shift).abs()
                                < self.shapes.slack(b.depth_error(self.shapes.error))
                        })
                    })
            }));
        }
        if count == 0 {
            0.0
        } else {
            hits as f64 / count as f64
        }
    }
}
