//! The scale of a perspective drawing, which is free: one height is given, and in the end all are
//! scaled so that their mean is the focal length. A parallel drawing needs none of it.

use super::rows::{Tag, Unknowns};
use super::sheet::Sheet;
use super::system::{NullSpace, System};
use super::{Camera, LiftError};
use crate::drawing::Graph;

/// Vertices that are tried: each try that fails shows a part that holds less than half of all.
const TRIES: usize = 6;

/// Least height in the L1 norm, as a share of the focal length: nothing is drawn from nearer to the
/// camera's plane or from farther away than about this many times the usual distance.
const LOWEST: f64 = 0.02;

/// Gives the height of one vertex of the part that most vertices are tied to, and returns what the
/// system leaves open then.
pub(super) fn choose(
    sheet: &Sheet<'_>,
    unknowns: &Unknowns,
    system: &mut System<Tag>,
) -> Result<NullSpace, LiftError> {
    let Camera::Central { focal, .. } = *sheet.camera() else {
        return system.null_space();
    };
    for v in unknowns.vertices() {
        system.bound_below(v, LOWEST * focal);
    }
    let weight = sheet.directions.precision.recip();
    let mut tried = vec![false; sheet.drawing.vertices.len()];
    let mut best: Option<(usize, usize)> = None;
    for _ in 0..TRIES {
        let Some(v) = tried.iter().position(|t| !t) else {
            break;
        };
        system.sharpen();
        system.push([(v, 1.0)], focal, weight, Tag::Gauge);
        let null_space = left_open(focal, system, tried.len())?;
        let mut tied = 0;
        for (u, tried) in tried.iter_mut().enumerate() {
            if !null_space.is_free(u) {
                *tried = true;
                tied += 1;
            }
        }
        tried[v] = true;
        if 2 * tied > tried.len() {
            fix_mean(focal, &null_space, system, tried.len());
            return Ok(null_space);
        }
        system.retain(|row| row.tag != Tag::Gauge);
        if best.is_none_or(|(_, most)| tied > most) {
            best = Some((v, tied));
        }
    }
    system.sharpen();
    if let Some((v, _)) = best {
        system.push([(v, 1.0)], focal, weight, Tag::Gauge);
    }
    let null_space = left_open(focal, system, tried.len())?;
    fix_mean(focal, &null_space, system, tried.len());
    Ok(null_space)
}

/// What a system with one height given leaves open. A loose part has heights of any scale; the errors
/// of its rows may say that the scale is zero, which is none.
fn left_open(
    focal: f64,
    system: &mut System<Tag>,
    vertices: usize,
) -> Result<NullSpace, LiftError> {
    let all = vec![true; system.rows().len()];
    loop {
        let null_space = system.null_space()?;
        let x = system.minimise(&all)?;
        let vanishes = |v: usize| x[v].abs() < 0.5 * LOWEST * focal && !null_space.is_free(v);
        if !(0..vertices).any(vanishes) || !system.blur() {
            return Ok(null_space);
        }
    }
}

/// Gives the height of one vertex of every part of the drawing that has none, and returns what is
/// open then: loose parts of a perspective drawing have a scale each.
pub(super) fn choose_parts(
    sheet: &Sheet<'_>,
    system: &mut System<Tag>,
    null_space: NullSpace,
) -> Result<NullSpace, LiftError> {
    let Camera::Central { focal, .. } = *sheet.camera() else {
        return Ok(null_space);
    };
    let graph = Graph::new(sheet.drawing);
    let mut done = vec![false; graph.component_count()];
    let vertices = 0..sheet.drawing.vertices.len();
    for v in vertices.clone().filter(|&v| !null_space.is_free(v)) {
        done[graph.component(v)] = true;
    }
    let weight = sheet.directions.precision.recip();
    for v in vertices {
        if !std::mem::replace(&mut done[graph.component(v)], true) {
            system.push([(v, 1.0)], focal, weight, Tag::Gauge);
        }
    }
    system.null_space()
}

/// In the L1 norm the mean height is given instead of that of one vertex, which may be where the
/// rows conflict.
fn fix_mean(focal: f64, null_space: &NullSpace, system: &mut System<Tag>, vertices: usize) {
    let tied: Vec<usize> = (0..vertices).filter(|&v| !null_space.is_free(v)).collect();
    let sum = focal * tied.len() as f64;
    system.fix_sum(tied, sum);
}

/// Takes the weight of the one vertex' row away.
pub(super) fn release(system: &mut System<Tag>) {
    weigh(system, 0.0);
}

/// Gives it back.
pub(super) fn hold(sheet: &Sheet<'_>, system: &mut System<Tag>) {
    weigh(system, sheet.directions.precision.recip());
}

fn weigh(system: &mut System<Tag>, weight: f64) {
    let rows = system.rows_mut().iter_mut();
    rows.filter(|row| row.tag == Tag::Gauge)
        .for_each(|row| row.weight = weight);
}

/// Scales a solution so that the mean of the heights that are determined is the focal length.
pub(super) fn rescale(
    sheet: &Sheet<'_>,
    null_space: &NullSpace,
    system: &mut System<Tag>,
    x: &mut [f64],
) {
    let Camera::Central { focal, .. } = *sheet.camera() else {
        return;
    };
    let tied = (0..sheet.drawing.vertices.len()).filter(|&v| !null_space.is_free(v));
    let (sum, count) = tied.fold((0.0, 0usize), |(sum, n), v| (sum + x[v], n + 1));
    let factor = focal * count as f64 / sum;
    if !(factor.is_finite() && factor > 0.0) {
        return;
    }
    x.iter_mut().for_each(|h| *h *= factor);
    for row in system.rows_mut() {
        if row.tag == Tag::Gauge {
            row.rhs *= factor;
        }
    }
}

/// Whether all vertices whose height is determined are in front of the camera.
///
/// # Errors
/// [`LiftError::Behind`] names those that are not.
pub(super) fn in_front(
    sheet: &Sheet<'_>,
    null_space: &NullSpace,
    x: &[f64],
) -> Result<(), LiftError> {
    let Camera::Central { focal, .. } = *sheet.camera() else {
        return Ok(());
    };
    let vertices: Vec<usize> = (0..sheet.drawing.vertices.len())
        .filter(|&v| !null_space.is_free(v))
        .filter(|&v| x[v].is_nan() || x[v] < 0.5 * LOWEST * focal)
        .collect();
    if vertices.is_empty() {
        Ok(())
    } else {
        Err(LiftError::Behind { vertices })
    }
}
