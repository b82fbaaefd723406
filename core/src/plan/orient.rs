//! Orientation of all loops: seen from outside, every face is on the left of its edges.

use glam::DVec3;

use crate::drawing::CoEdge;
use crate::sets::Sets;

use super::PlanError;
use super::chart::{Sight, sides, volume};
use super::support::Support;
use super::uses::Use;
use super::view::View;

/// Steps along a curve when loops are measured.
const STEPS: usize = 24;

/// Areas that differ by less than this share may be in the wrong order: a polygon of [`STEPS`] corners is
/// one percent smaller than its circle.
const ALIKE: f64 = 0.05;

/// Steps along a curve when such areas are compared.
const FINE: usize = 32 * STEPS;

/// A face with its loops in the order and direction of the plan.
#[derive(Debug, Clone)]
pub(super) struct Oriented {
    /// Loops, outer first.
    pub(super) loops: Vec<Vec<CoEdge>>,
    /// Whether the outward normal is against the gradient of the surface.
    pub(super) reversed: bool,
}

/// A face while it is worked on; its loops are in the order that they are given in.
struct Draft {
    outer: usize,
    /// Whether each loop was turned around, so that the face is on the left against the gradient.
    turned: Vec<bool>,
    /// How sure that is: the areas that loops enclose in the drawing, of the squares of their lengths.
    sure: Vec<f64>,
    /// What each loop, as it is given, adds to the volume.
    volumes: Vec<f64>,
    low: DVec3,
    high: DVec3,
}

impl Draft {
    fn volume(&self) -> f64 {
        let shares = self.volumes.iter().zip(&self.turned);
        shares
            .map(|(v, turned)| if *turned { -v } else { *v })
            .sum()
    }

    /// The loops, outer first, each turned around or not.
    fn oriented(&self, loops: &[Vec<CoEdge>], reversed: bool) -> Vec<Vec<CoEdge>> {
        let mut order: Vec<usize> = (0..loops.len()).collect();
        order.sort_by_key(|&i| i != self.outer);
        let walk = |i: usize| {
            if self.turned[i] != reversed {
                loops[i].iter().rev().map(|c| c.mate()).collect()
            } else {
                loops[i].clone()
            }
        };
        order.into_iter().map(walk).collect()
    }
}

/// Orients the loops of all faces.
///
/// Loops of one face are tied by the drawing: outlines are drawn, so a face is seen from the front
/// or from behind all over, and in the drawing its outer loop runs the one way round and the others
/// the other way. Faces are tied by their common edges, which they walk in opposite directions.
/// What is left is one choice for each shell: its volume is positive, or negative if it is a void
/// inside another shell.
///
/// `points` gives the points along a co-edge at so many steps without the last one, `silhouette` tells
/// which edges are outlines, along which a face is seen edge-on.
pub(super) fn orient(
    loops: &[Vec<Vec<CoEdge>>],
    supports: &[Support],
    uses: &[[Use; 2]],
    view: &View,
    silhouette: impl Fn(usize) -> bool,
    points: impl Fn(CoEdge, usize) -> Vec<DVec3>,
) -> Result<Vec<Oriented>, PlanError> {
    let mut drafts: Vec<Draft> = loops
        .iter()
        .zip(supports)
        .map(|(loops, support)| draft(loops, support, view, &silhouette, &points))
        .collect();
    settle(&mut drafts, uses);
    let shells = propagate(&drafts, uses)?;
    let mut flips: Vec<bool> = vec![false; drafts.len()];
    let volumes: Vec<f64> = shells.iter().map(|s| shell_volume(s, &drafts)).collect();
    for (i, shell) in shells.iter().enumerate() {
        let inside =
            (0..shells.len()).any(|j| j != i && is_inside(&shells[i], &shells[j], &drafts));
        let turn = (volumes[i] < 0.0) != inside;
        for &(face, flip) in shell {
            flips[face] = flip != turn;
        }
    }
    let turned = drafts.iter().zip(loops).zip(flips);
    Ok(turned
        .map(|((draft, loops), reversed)| Oriented {
            loops: draft.oriented(loops, reversed),
            reversed,
        })
        .collect())
}

/// The loops of a face, each turned so that the face is on the left against the gradient.
fn draft(
    loops: &[Vec<CoEdge>],
    support: &Support,
    view: &View,
    silhouette: &impl Fn(usize) -> bool,
    points: &impl Fn(CoEdge, usize) -> Vec<DVec3>,
) -> Draft {
    let polyline = |walk: &[CoEdge], steps: usize| -> Vec<DVec3> {
        walk.iter().flat_map(|c| points(*c, steps)).collect()
    };
    let polylines: Vec<_> = loops.iter().map(|walk| polyline(walk, STEPS)).collect();
    let all = || polylines.iter().flatten();
    // A surface that says nothing is taken to have its gradient towards the viewer.
    let bounds = loops.iter().flatten().filter(|c| !silhouette(c.edge()));
    let facing: Option<f64> = bounds
        .map(|c| {
            let seen = |p: &DVec3| support.gradient(*p).dot(view.toward(*p));
            points(*c, STEPS).iter().map(seen).sum::<f64>()
        })
        .reduce(|a, b| a + b);
    let areas: Vec<f64> = polylines.iter().map(|p| drawn_area(p, view)).collect();
    let largest = areas.iter().fold(0.0, |m: f64, a| m.max(a.abs()));
    let rivals: Vec<usize> = (0..loops.len())
        .filter(|&i| areas[i].abs() >= (1.0 - ALIKE) * largest)
        .collect();
    let outer = match rivals[..] {
        [only] => only,
        _ => {
            let area = |i: usize| drawn_area(&polyline(&loops[i], FINE), view).abs();
            let rivals = rivals.iter().map(|&i| (area(i), i));
            rivals.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(0, |r| r.1)
        }
    };
    // Half of a whole sphere or ring is taken as it is given.
    let front = facing.map_or(areas[outer] > 0.0, |f| f >= 0.0);
    let turned: Vec<bool> = (0..loops.len())
        .map(|i| (areas[i] > 0.0) != ((i == outer) == front))
        .collect();
    let middle = all().sum::<DVec3>() / all().count().max(1) as f64;
    let sight = Sight {
        toward: view.toward(middle),
        front,
    };
    let sure = |i: usize| {
        let drawn = |p: DVec3| view.project(p);
        let length = sides(&polylines[i]).map(|(p, q)| drawn(p).distance(drawn(q)));
        areas[i].abs() / length.sum::<f64>().powi(2)
    };
    let each = || 0..loops.len();
    Draft {
        outer,
        sure: each().map(sure).collect(),
        volumes: each()
            .map(|i| volume(support, &polylines[i], sight))
            .collect(),
        turned,
        low: all().fold(DVec3::INFINITY, |m, p| m.min(*p)),
        high: all().fold(DVec3::NEG_INFINITY, |m, p| m.max(*p)),
    }
}

/// Turns loops around of which the drawing tells the way round least, where neighbours would disagree
/// otherwise: an outline with cusps crosses what it bounds.
fn settle(drafts: &mut [Draft], uses: &[[Use; 2]]) {
    let mut first = vec![0];
    for draft in &*drafts {
        first.push(first[first.len() - 1] + draft.turned.len());
    }
    let count = first[drafts.len()];
    // Each loop as it is given and turned around; what goes together is in one set.
    let mut ways = Sets::new(2 * count);
    let tie = |ways: &mut Sets, a: usize, b: usize, differ: bool| -> bool {
        let other = |x: usize| (x + count) % (2 * count);
        if ways.find(a) == ways.find(if differ { b } else { other(b) }) {
            return false;
        }
        let b = if differ { other(b) } else { b };
        ways.join(a, b);
        ways.join(other(a), other(b));
        true
    };
    for [a, b] in uses {
        // Two loops walk their edge in opposite directions.
        let same = a.reversed == b.reversed;
        if !tie(
            &mut ways,
            first[a.face] + a.walk,
            first[b.face] + b.walk,
            same,
        ) {
            return;
        }
    }
    let mut loops: Vec<(f64, usize, usize, usize)> = Vec::new();
    for (f, draft) in drafts.iter().enumerate() {
        let surest = (0..draft.sure.len()).max_by(|&a, &b| draft.sure[a].total_cmp(&draft.sure[b]));
        for i in (0..draft.sure.len()).filter(|i| Some(*i) != surest) {
            loops.push((draft.sure[i], f, i, surest.unwrap_or(0)));
        }
    }
    loops.sort_by(|a, b| b.0.total_cmp(&a.0));
    for (_, f, i, surest) in loops {
        let turned = &mut drafts[f].turned;
        let differ = turned[i] != turned[surest];
        if !tie(&mut ways, first[f] + i, first[f] + surest, differ) {
            turned[i] = !turned[i];
        }
    }
}

/// Signed area of a closed polyline in the drawing, positive if counter-clockwise.
fn drawn_area(points: &[DVec3], view: &View) -> f64 {
    let origin = points
        .first()
        .map_or(glam::DVec2::ZERO, |p| view.project(*p));
    sides(points)
        .map(|(p, q)| (view.project(p) - origin).perp_dot(view.project(q) - origin) / 2.0)
        .sum()
}

/// Faces of one shell, each with whether it is turned around to fit the first.
type Shell = Vec<(usize, bool)>;

/// Walks over common edges from face to face.
fn propagate(drafts: &[Draft], uses: &[[Use; 2]]) -> Result<Vec<Shell>, PlanError> {
    let mut neighbours: Vec<Vec<(usize, bool, usize)>> = vec![Vec::new(); drafts.len()];
    for (e, [a, b]) in uses.iter().enumerate() {
        // Both walk the edge the same way: one of them has to turn.
        let way = |u: &Use| u.reversed != drafts[u.face].turned[u.walk];
        let turn = way(a) == way(b);
        neighbours[a.face].push((b.face, turn, e));
        neighbours[b.face].push((a.face, turn, e));
    }
    let mut flip: Vec<Option<bool>> = vec![None; drafts.len()];
    let mut shells = Vec::new();
    for start in 0..drafts.len() {
        if flip[start].is_some() {
            continue;
        }
        flip[start] = Some(false);
        let mut shell = vec![(start, false)];
        let mut next = 0;
        while let Some(&(face, own)) = shell.get(next) {
            next += 1;
            for &(other, turn, edge) in &neighbours[face] {
                let wanted = own != turn;
                match flip[other] {
                    None => {
                        flip[other] = Some(wanted);
                        shell.push((other, wanted));
                    }
                    Some(found) if found != wanted => {
                        return Err(PlanError::NotOrientable {
                            edge: edge + 1,
                            faces: vec![face + 1, other + 1],
                        });
                    }
                    Some(_) => {}
                }
            }
        }
        shells.push(shell);
    }
    Ok(shells)
}

fn shell_volume(shell: &Shell, drafts: &[Draft]) -> f64 {
    let share = |&(face, flip): &(usize, bool)| {
        let volume = drafts[face].volume();
        if flip { -volume } else { volume }
    };
    shell.iter().map(share).sum()
}

/// Whether a shell's box lies inside another shell's box.
fn is_inside(inner: &Shell, outer: &Shell, drafts: &[Draft]) -> bool {
    let bounds = |shell: &Shell| {
        shell.iter().fold(
            (DVec3::INFINITY, DVec3::NEG_INFINITY),
            |(low, high), (f, _)| (low.min(drafts[*f].low), high.max(drafts[*f].high)),
        )
    };
    let (low, high) = bounds(inner);
    let (outer_low, outer_high) = bounds(outer);
    low.cmpgt(outer_low).all() && high.cmplt(outer_high).all()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lift::Camera;
    use glam::DMat3;

    #[test]
    fn a_doubtful_loop_follows_its_neighbours() {
        // Two faces with both loops in common, of which one is drawn so that its way round is not clear.
        let ring = |sure: f64, turned: bool| Draft {
            outer: 0,
            turned: vec![false, turned],
            sure: vec![0.05, sure],
            volumes: vec![0.0; 2],
            low: DVec3::ZERO,
            high: DVec3::ONE,
        };
        let both = |walk: usize| {
            [(0, false), (1, true)].map(|(face, reversed)| Use {
                face,
                walk,
                reversed,
            })
        };
        let uses = [both(0), both(1)];
        let mut drafts = vec![ring(0.04, true), ring(0.001, false)];
        settle(&mut drafts, &uses);
        assert_eq!(drafts[0].turned, [false, true]);
        assert_eq!(drafts[1].turned, [false, true]);
        assert!(propagate(&drafts, &uses).is_ok());
    }

    #[test]
    fn outer_loop_of_a_thin_ring_is_the_larger_circle_however_its_edges_are_cut() {
        // The inner circle in halves, of twice the points, and the outer one in one piece.
        let loops = [vec![1, 2], vec![-3]].map(|walk: Vec<i64>| {
            let coedges = walk.into_iter().filter_map(CoEdge::from_signed);
            coedges.collect::<Vec<_>>()
        });
        let points = |co: CoEdge, steps: usize| {
            let (radius, from, turn) =
                [(0.997, 0.0, 0.5), (0.997, 0.5, 0.5), (1.0, 0.0, 1.0)][co.edge()];
            let angle = |i: usize| (from + turn * i as f64 / steps as f64) * std::f64::consts::TAU;
            let place = |i| DVec3::new(angle(i).cos(), angle(i).sin(), 0.0) * radius;
            let mut all: Vec<DVec3> = (0..=steps).map(place).collect();
            if co.is_reversed() {
                all.reverse();
            }
            all.pop();
            all
        };
        let plane = Support::Plane {
            origin: DVec3::ZERO,
            normal: DVec3::Z,
        };
        let view = View::new(Camera::Parallel, DMat3::IDENTITY);
        let draft = draft(&loops, &plane, &view, &|_| false, &points);
        assert_eq!(draft.oriented(&loops, false)[0][0].edge(), 2);
        assert_eq!(draft.turned, [true, true]);
    }
}
