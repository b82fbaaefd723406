//! Ways to join a part to those that are placed.

use std::cell::OnceCell;
use std::collections::BTreeSet;

use super::alike::{Twin, alike};
use super::body::{Bodies, Place};
use super::layout::Parallel;
use super::links::{Link, LinkKind};
use super::score::{COUNT, Feature, JoinScorer, Row};
use super::shapes::Shapes;
use super::volume::Rays;

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
    /// One of the loops of another curved surface.
    Curved,
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
            LinkKind::Pierced => Role::Curved,
        };
        // A surface of revolution stays one when it gets a hole.
        if (self.roles[link.outer], role) != (Role::Round, Role::Curved) {
            self.roles[link.outer] = role;
        }
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
            LinkKind::Coplanar => ends.iter().all(|e| matches!(e, Role::Free | Role::Flat)),
            LinkKind::Coaxial => ends == [Role::Free; 2],
            LinkKind::Pierced => ends[0] != Role::Flat && ends[1] == Role::Free,
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
    bodies: Bodies,
    rays: Rays,
    /// For each loop the planes that are parallel to its own, found when they are asked for.
    pub(super) parallels: Vec<OnceCell<Vec<Parallel>>>,
    /// Pairs of loops, outer and inner, that have a link.
    pub(super) joined: BTreeSet<(usize, usize)>,
}

impl<'a> Joiner<'a> {
    pub(super) fn new(shapes: &'a Shapes, links: &'a [Link], scorer: &'a dyn JoinScorer) -> Self {
        Self {
            shapes,
            links,
            scorer,
            main: shapes.main_part().unwrap_or(0),
            alike: alike(shapes),
            bodies: Bodies::new(shapes),
            rays: Rays::new(shapes),
            parallels: shapes.loops.iter().map(|_| OnceCell::new()).collect(),
            joined: links.iter().map(|l| (l.outer, l.inner)).collect(),
        }
    }
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
            let slack = |m: &(bool, f64, usize)| self.shapes.slack(self.links[m.2].error);
            let widest = slack(&moves[start]);
            let same =
                |m: &(bool, f64, usize)| m.0 == turned && m.1 - first < 2.0 * widest.max(slack(m));
            let end = start + moves[start..].iter().take_while(|m| same(m)).count();
            let cluster = &moves[start..end];
            let shift = cluster.iter().map(|m| m.1).sum::<f64>() / cluster.len() as f64;
            let place = Place { shift, turned };
            let mut list: Vec<usize> = cluster.iter().map(|m| m.2).collect();
            let pierces = |l: usize| self.links[l].kind == LinkKind::Pierced;
            if list.iter().all(|&l| pierces(l)) {
                // Where a hole ends in a curved surface is not known as exactly.
                let mut more: Vec<&(bool, f64, usize)> = moves
                    .iter()
                    .filter(|m| m.0 == turned && pierces(m.2) && !list.contains(&m.2))
                    .collect();
                more.sort_by(|a, b| (a.1 - shift).abs().total_cmp(&(b.1 - shift).abs()));
                let own = |l: &usize| self.part(self.links[*l].inner) == part;
                for m in more {
                    let ends = |l: &usize| self.links[*l].inner == self.links[m.2].inner;
                    if own(&m.2) && !list.iter().any(ends) {
                        list.push(m.2);
                    }
                }
            }
            let list = self.select(list, state);
            let kept = cluster.iter().filter(|m| list.contains(&m.2));
            let ends = kept.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), m| {
                (low.min(m.1), high.max(m.1))
            });
            let slack = cluster.iter().map(slack).fold(0.0, f64::max);
            let spread = (ends.1 - ends.0).max(0.0) / slack;
            let row = self.row(part, place, &list, spread, state);
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

    fn row(&self, part: usize, place: Place, list: &[usize], spread: f64, state: &State) -> Row {
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
        set(Feature::Spread, spread);
        set(Feature::Area, mean(&|l| of_kind(l, LinkKind::Coplanar)));
        set(Feature::Narrow, mean(&|l| of_kind(l, LinkKind::Coaxial)));
        set(Feature::Skips, mean(&|l| share(self.skips(l))));
        if self.shapes.parts[part].is_circle {
            set(
                Feature::Lonely,
                share(links().all(|l| l.kind == LinkKind::Coplanar)),
            );
        }
        set(Feature::Fits, share(links().any(|l| l.fits)));
        set(Feature::Clearance, mean(&|l| self.clearance(l)));
        set(Feature::Round, mean(&|l| self.roundness(l)));
        set(Feature::Thin, mean(&|l| self.thinness(l)));
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
            let fit = self
                .bodies
                .fit(self.shapes, part, place.shift, &state.placed);
            let (right, wrong) = if boss {
                (fit.outside, fit.inside)
            } else {
                (fit.inside, fit.outside)
            };
            set(Feature::Boss, share(boss));
            set(Feature::Right, right);
            set(Feature::Wrong, wrong);
            set(Feature::Pierced, fit.pierced);
            let [inside, outside] =
                self.rays
                    .inside_and_outside(self.shapes, part, place.shift, &state.placed);
            set(Feature::Astray, share(if boss { inside } else { outside }));
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
}
