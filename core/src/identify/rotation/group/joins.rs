//! Ways to join a part to those that are placed.

use std::collections::BTreeSet;

use glam::DVec2;

use super::alike::Twin;
use super::body::{Place, fit};
use super::links::{Link, LinkKind, PARALLEL};
use super::score::{COUNT, Feature, JoinScorer, Row};
use super::shapes::Shapes;

/// One way to join a part: a place, and the links that it makes true.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Join {
    pub(super) place: Place,
    pub(super) links: Vec<usize>,
    pub(super) row: Row,
    pub(super) score: f64,
}

/// What a loop is used as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Role {
    /// Not linked to another.
    #[default]
    Free,
    /// One of the loops of a plane.
    Flat,
    /// One of the circles of a surface of revolution.
    Round,
}

/// Parts and loops so far.
#[derive(Debug, Clone)]
pub(super) struct State {
    pub(super) placed: Vec<Option<Place>>,
    pub(super) roles: Vec<Role>,
    /// Loops drawn inside each loop in its face.
    pub(super) inner: Vec<Vec<usize>>,
    /// Whether each loop is inside another one in its face.
    pub(super) hung: Vec<bool>,
}

impl State {
    /// Makes a link true.
    pub(super) fn apply(&mut self, link: &Link) {
        self.inner[link.outer].push(link.inner);
        self.hung[link.inner] = true;
        let role = match link.kind {
            LinkKind::Coplanar => Role::Flat,
            LinkKind::Coaxial => Role::Round,
        };
        self.roles[link.outer] = role;
        self.roles[link.inner] = role;
    }

    /// Whether a link does not contradict what loops are used as.
    pub(super) fn allows(&self, link: &Link, shapes: &Shapes) -> bool {
        if self.hung[link.outer] || self.hung[link.inner] || !self.inner[link.inner].is_empty() {
            return false;
        }
        let apart = |&other: &usize| !shapes.nested(other, link.inner);
        if !self.inner[link.outer].iter().all(apart) {
            return false;
        }
        let ends = [self.roles[link.outer], self.roles[link.inner]];
        match link.kind {
            LinkKind::Coplanar => !ends.contains(&Role::Round),
            LinkKind::Coaxial => ends == [Role::Free; 2],
        }
    }
}

/// What joins are made from.
pub(super) struct Joiner<'a> {
    pub(super) shapes: &'a Shapes,
    pub(super) links: &'a [Link],
    pub(super) scorer: &'a dyn JoinScorer,
    pub(super) main: usize,
    /// For each part those that look like it.
    pub(super) alike: Vec<Vec<Twin>>,
    /// Pairs of loops, outer and inner, that have a link.
    pub(super) joined: BTreeSet<(usize, usize)>,
}

impl Joiner<'_> {
    /// The joins of a part, best first; `own` are the links to other parts.
    pub(super) fn joins(&self, part: usize, own: &[usize], state: &State) -> Vec<Join> {
        let mut moves: Vec<(bool, f64, usize)> = Vec::new();
        for &l in own {
            let link = &self.links[l];
            let (a, b) = (self.part(link.outer), self.part(link.inner));
            let (other, sign) = if b == part { (a, 1.0) } else { (b, -1.0) };
            let Some(place) = state.placed[other] else {
                continue;
            };
            let turned = place.turned ^ link.same_sense;
            // Turned over, a circle is itself with its two loops exchanged.
            if state.allows(link, self.shapes) && !(turned && self.shapes.parts[part].is_circle) {
                moves.push((turned, place.shift + sign * link.offset, l));
            }
        }
        moves.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut joins = Vec::new();
        let mut start = 0;
        while start < moves.len() {
            let (turned, first, _) = moves[start];
            let same =
                |m: &(bool, f64, usize)| m.0 == turned && m.1 - first < 2.0 * self.shapes.tolerance;
            let end = start + moves[start..].iter().take_while(|m| same(m)).count();
            let cluster = &moves[start..end];
            let shift = cluster.iter().map(|m| m.1).sum::<f64>() / cluster.len() as f64;
            let place = Place { shift, turned };
            let list = self.select(cluster.iter().map(|m| m.2).collect(), state);
            let row = self.row(part, place, &list, state);
            joins.push(Join {
                place,
                links: list,
                score: self.scorer.score(&row),
                row,
            });
            start = end;
        }
        joins.sort_by(|a, b| b.score.total_cmp(&a.score));
        joins
    }

    fn part(&self, outline: usize) -> usize {
        self.shapes.loops[outline].part
    }

    /// Of links that imply one place those that can be together: a loop is inside of the smallest
    /// one around it, and in one face only.
    fn select(&self, mut list: Vec<usize>, state: &State) -> Vec<usize> {
        let area = |i: usize| self.shapes.loops[i].area.abs();
        list.sort_by(|&a, &b| {
            let (p, q) = (&self.links[a], &self.links[b]);
            area(p.outer).total_cmp(&area(q.outer)).then(a.cmp(&b))
        });
        let mut trial = State {
            placed: Vec::new(),
            roles: state.roles.clone(),
            inner: state.inner.clone(),
            hung: state.hung.clone(),
        };
        list.retain(|&l| {
            let link = &self.links[l];
            let good = trial.allows(link, self.shapes);
            if good {
                trial.apply(link);
            }
            good
        });
        list
    }

    fn row(&self, part: usize, place: Place, list: &[usize], state: &State) -> Row {
        let mut row = [0.0; COUNT];
        let mut set = |f: Feature, x: f64| row[f as usize] = x;
        let links = || list.iter().map(|&l| &self.links[l]);
        let count = list.len().max(1) as f64;
        let mean = |f: &dyn Fn(&Link) -> f64| links().map(f).sum::<f64>() / count;
        set(Feature::More, count.min(4.0) - 1.0);
        let share = |yes: bool| if yes { 1.0 } else { 0.0 };
        set(
            Feature::Coaxial,
            share(links().any(|l| l.kind == LinkKind::Coaxial)),
        );
        set(Feature::Doubtful, mean(&|l| share(l.doubtful)));
        let host = links().any(|l| self.part(l.outer) == part);
        set(Feature::Host, share(host));
        let other = |l: &Link| {
            let p = self.part(l.outer);
            if p == part { self.part(l.inner) } else { p }
        };
        set(Feature::Main, mean(&|l| share(other(l) == self.main)));
        set(
            Feature::Shared,
            mean(&|l| share(!state.inner[l.outer].is_empty())),
        );
        let loops = &self.shapes.loops;
        let width = |l: &Link| (loops[l.inner].area / loops[l.outer].area).abs().sqrt();
        let of_kind = |l: &Link, kind| if l.kind == kind { width(l) } else { 0.0 };
        set(Feature::Area, mean(&|l| of_kind(l, LinkKind::Coplanar)));
        set(Feature::Narrow, mean(&|l| of_kind(l, LinkKind::Coaxial)));
        set(Feature::Skips, mean(&|l| share(self.skips(l))));
        if self.shapes.parts[part].is_circle {
            set(
                Feature::Lonely,
                share(links().all(|l| l.kind == LinkKind::Coplanar)),
            );
        }
        set(Feature::Clearance, mean(&|l| self.clearance(l)));
        set(Feature::Centred, mean(&|l| self.centred(l)));
        set(Feature::Aligned, mean(&|l| self.aligned(l, state)));
        set(Feature::Alike, self.as_twins(part, list, state));
        set(Feature::Level, self.level(part, place, list, state));
        let depth_of = |l: &Link| {
            let a = &loops[l.outer];
            let by = state.placed[a.part].map_or(place.shift, |p| p.shift);
            a.plane.map(|p| p.c - by)
        };
        let flat: Vec<&Link> = links().filter(|l| l.kind == LinkKind::Coplanar).collect();
        let first = flat.first().and_then(|l| depth_of(l));
        set(
            Feature::Through,
            share(flat.iter().any(|l| depth_of(l) != first)),
        );
        if let Some(link) = flat.first()
            && !host
            && !self.shapes.parts[part].is_circle
        {
            let boss = self.is_boss(part, place, link, state);
            let fit = fit(self.shapes, part, place.shift, &state.placed);
            let (right, wrong) = if boss {
                (fit.outside, fit.inside)
            } else {
                (fit.inside, fit.outside)
            };
            set(Feature::Boss, share(boss));
            set(Feature::Right, right);
            set(Feature::Wrong, wrong);
            set(Feature::Pierced, fit.pierced);
        }
        row
    }

    /// Whether a part is on the outer side of the face that its loop is in.
    fn is_boss(&self, part: usize, place: Place, link: &Link, state: &State) -> bool {
        let outer = &self.shapes.loops[link.outer];
        let (Some(plane), Some(base)) = (outer.plane, state.placed[outer.part]) else {
            return false;
        };
        let above: f64 = self.shapes.parts[part]
            .samples
            .iter()
            .map(|s| s.z + place.shift - base.shift - plane.level(s.truncate()))
            .sum();
        let to_viewer = (outer.area > 0.0) != base.turned;
        (above > 0.0) == to_viewer
    }

    /// Whether a third loop around the same axis is drawn between two.
    fn skips(&self, link: &Link) -> bool {
        let between = |l: &Link| {
            l.kind == LinkKind::Coaxial
                && l.outer == link.outer
                && l.inner != link.inner
                && self.shapes.nested(l.inner, link.inner)
                && self.shapes.loops[l.inner].area.abs() > self.shapes.loops[link.inner].area.abs()
                && self.part(l.inner) != self.part(link.inner)
        };
        link.kind == LinkKind::Coaxial && self.links.iter().any(between)
    }

    fn clearance(&self, link: &Link) -> f64 {
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

    /// Extent of a loop along the two axes of its plane, if it is normal to the third: low, high.
    fn extent(&self, outline: usize) -> Option<(DVec2, DVec2)> {
        let [x, y, z] = self.shapes.axes.as_slice() else {
            return None;
        };
        let outline = &self.shapes.loops[outline];
        let plane = outline.plane?;
        if !self.shapes.camera.is_parallel() {
            return None;
        }
        let normal = plane.normal();
        let pairs = [(x, [y, z]), (y, [x, z]), (z, [x, y])];
        let (_, [u, v]) = pairs
            .into_iter()
            .find(|(n, _)| n.dot(normal).abs() > 0.999)?;
        let (u, v) = (u.truncate(), v.truncate());
        let det = u.perp_dot(v);
        let ends = outline
            .polygon
            .iter()
            .map(|p| DVec2::new(p.perp_dot(v), u.perp_dot(*p)) / det)
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| {
                (l.min(p), h.max(p))
            });
        Some(ends)
    }

    fn same(&self, a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-3 * self.shapes.size
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

    fn centred(&self, link: &Link) -> f64 {
        if let Some(d) = self.eccentricity(link.outer, link.inner)
            && self.same(d, 0.0)
        {
            return 2.0;
        }
        let (Some((a, b)), Some((c, d))) = (self.extent(link.outer), self.extent(link.inner))
        else {
            return 0.0;
        };
        let (p, q) = (a + b, c + d);
        let hits = [self.same(p.x, q.x), self.same(p.y, q.y)];
        hits.iter().filter(|h| **h).count() as f64
    }

    fn aligned(&self, link: &Link, state: &State) -> f64 {
        // On one circle around the outer one's centre.
        if let Some(d) = self.eccentricity(link.outer, link.inner)
            && state.inner[link.outer].iter().any(|&i| {
                i != link.inner
                    && self
                        .eccentricity(link.outer, i)
                        .is_some_and(|e| self.same(d, e))
            })
        {
            return 2.0;
        }
        let Some((a, b)) = self.extent(link.inner) else {
            return 0.0;
        };
        let mut hits = [false; 2];
        for &other in state.inner[link.outer].iter().filter(|o| **o != link.inner) {
            let Some((c, d)) = self.extent(other) else {
                continue;
            };
            for (k, hit) in hits.iter_mut().enumerate() {
                *hit |= self.same(a[k], c[k])
                    || self.same(b[k], d[k])
                    || self.same(a[k] + b[k], c[k] + d[k]);
            }
        }
        hits.iter().filter(|h| **h).count() as f64
    }

    /// Share of a part's planes parallel to the one it is linked in, but for those linked, that are
    /// in one plane with one placed.
    fn level(&self, part: usize, place: Place, list: &[usize], state: &State) -> f64 {
        let loops = &self.shapes.loops;
        let (mut count, mut hits) = (0usize, 0usize);
        for &i in &self.shapes.parts[part].loops {
            let linked = list.iter().any(|&l| {
                let link = &self.links[l];
                link.outer == i || link.inner == i
            });
            let Some(p) = loops[i].plane else { continue };
            if linked {
                continue;
            }
            count += 1;
            let at = (loops[i].low + loops[i].high) / 2.0;
            hits += usize::from(loops.iter().any(|b| {
                b.part != part
                    && state.placed[b.part].is_some_and(|base| {
                        b.plane.is_some_and(|q| {
                            p.normal().cross(q.normal()).length() < PARALLEL
                                && (p.level(at) + place.shift - q.level(at) - base.shift).abs()
                                    < self.shapes.tolerance
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
