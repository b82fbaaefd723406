//! How much of a part is inside of what is placed, along lines of sight.
//!
//! A part whose loops are each closed by a surface of their own is a closed body, which a line of
//! sight enters and leaves by turns. A pocket's opening and the same outline in the face it opens in
//! cancel out, so the solid is what is inside an odd number of its parts.

use std::cell::OnceCell;

use glam::DVec2;

use super::body::Place;
use super::shapes::{Outline, Shapes};

/// Most lines of sight through a part.
const MOST: usize = 96;

/// Share of a part that is some of it: less are errors.
const SOME: f64 = 3e-3;

/// A line of sight.
#[derive(Debug, Clone)]
struct Ray {
    /// Levels at which it enters and leaves the part, rising, in the part.
    own: Vec<f64>,
    /// The same of other parts that it meets, each in that part.
    others: Vec<(usize, Vec<f64>)>,
}

/// Lines of sight through every part, made when they are asked for.
pub(super) struct Rays(Vec<OnceCell<Vec<Ray>>>);

impl Rays {
    pub(super) fn new(shapes: &Shapes) -> Self {
        Self(shapes.parts.iter().map(|_| OnceCell::new()).collect())
    }

    /// Whether a part at a depth is partly inside the parts placed, and partly outside of them:
    /// more of it than the drawing's errors make.
    pub(super) fn inside_and_outside(
        &self,
        shapes: &Shapes,
        part: usize,
        shift: f64,
        placed: &[Option<Place>],
    ) -> [bool; 2] {
        let rays = self.0[part].get_or_init(|| rays(shapes, part));
        let slack = shapes.slack(shapes.error);
        let mut all = 0.0;
        let mut sums = [0.0; 2];
        for ray in rays {
            let others = ray.others.iter().filter_map(|(p, levels)| {
                let place = placed[*p]?;
                Some(levels.iter().map(move |x| x + place.shift - shift))
            });
            let mut solid: Vec<f64> = others.flatten().collect();
            solid.sort_by(f64::total_cmp);
            let (mut length, mut within) = (0.0, 0.0);
            for own in ray.own.chunks_exact(2) {
                length += own[1] - own[0];
                let cut = |x: &[f64]| (own[1].min(x[1]) - own[0].max(x[0])).max(0.0);
                within += solid.chunks_exact(2).map(cut).sum::<f64>();
            }
            all += length;
            for (sum, x) in sums.iter_mut().zip([within, length - within]) {
                if x > slack {
                    *sum += x;
                }
            }
        }
        sums.map(|sum| sum > SOME * all)
    }
}

fn rays(shapes: &Shapes, part: usize) -> Vec<Ray> {
    let loops = &shapes.parts[part].loops;
    let corners: usize = loops.iter().map(|&i| shapes.loops[i].corners.len()).sum();
    // What a place is does not depend on how loops are walked and numbered.
    let shares: &[f64] = if 2 * corners + loops.len() <= MOST {
        &[0.4, 0.8]
    } else {
        &[0.6]
    };
    let mut all = Vec::new();
    for &i in loops {
        let corners = &shapes.loops[i].corners;
        let middle = corners.iter().map(|c| c.0).sum::<DVec2>() / corners.len().max(1) as f64;
        let mut places = vec![middle];
        if loops.len() + corners.len() <= MOST {
            for &t in shares {
                places.extend(corners.iter().map(|c| middle.lerp(c.0, t)));
            }
        }
        all.extend(places.into_iter().filter_map(|p| ray(shapes, part, p)));
    }
    all
}

/// The line of sight that is drawn at a point, if it goes through the part.
fn ray(shapes: &Shapes, part: usize, at: DVec2) -> Option<Ray> {
    let own = crossings(shapes, part, at).filter(|own| !own.is_empty())?;
    let mut others = Vec::new();
    for other in (0..shapes.parts.len()).filter(|&p| p != part) {
        let levels = crossings(shapes, other, at)?;
        if !levels.is_empty() {
            others.push((other, levels));
        }
    }
    Some(Ray { own, others })
}

/// Levels at which the line of sight drawn at a point enters and leaves a part; `None` if it does
/// not do so by turns, as where it meets an edge.
fn crossings(shapes: &Shapes, part: usize, at: DVec2) -> Option<Vec<f64>> {
    let whole = &shapes.parts[part];
    if at.cmplt(whole.low).any() || at.cmpgt(whole.high).any() {
        return Some(Vec::new());
    }
    let hit = |o: &&Outline| o.contains(at);
    let outlines = whole.loops.iter().map(|&i| &shapes.loops[i]);
    let mut levels: Vec<f64> = outlines.filter(hit).map(|o| o.depth(at)).collect();
    levels.sort_by(f64::total_cmp);
    levels.len().is_multiple_of(2).then_some(levels)
}

#[cfg(test)]
mod tests {
    use super::super::tests::{in_perspective, lifted};
    use super::*;
    use crate::identify::testing::holed_cube;

    #[test]
    fn a_hole_is_inside_where_both_its_ends_are_in_faces() {
        for drawing in [holed_cube(), in_perspective(holed_cube())] {
            lifted(&drawing, |shapes, links| {
                let main = shapes.main_part().unwrap();
                let hole = 1 - main;
                let mut placed = vec![None; 2];
                placed[main] = Some(Place {
                    shift: 0.0,
                    turned: false,
                });
                let rays = Rays::new(shapes);
                let at = |shift: f64| rays.inside_and_outside(shapes, hole, shift, &placed);
                let own = links
                    .iter()
                    .filter(|l| shapes.loops[l.inner].part == hole)
                    .map(|l| l.offset);
                let own: Vec<f64> = own.collect();
                let twice = |x: &&f64| own.iter().filter(|y| (*x - **y).abs() < 1e-6).count() > 1;
                let through = *own.iter().find(twice).unwrap();
                assert_eq!(at(through), [true, false]);
                assert_eq!(at(through + 0.5 * shapes.size), [true, true]);
                assert_eq!(at(through + 5.0 * shapes.size), [false, true]);
            });
        }
    }
}
