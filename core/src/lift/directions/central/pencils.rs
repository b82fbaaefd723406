//! Pencils: lines through one vanishing point.

use glam::{DMat3, DVec3};

use super::eigen;
use super::lines::{Line, Lines};
use crate::lift::Camera;

/// Lines whose pairs are tried, and lines that vote; the longest ones.
const PAIRED: usize = 36;
const VOTING: usize = 120;

/// Pencils that are kept.
const KEPT: usize = 16;

/// Fewest lines: any two meet.
const FEWEST: usize = 3;

/// Error of a direction, radians, beyond which it says nothing.
const VAGUE: f64 = 0.02;

/// Lines through one vanishing point.
#[derive(Debug, Clone)]
pub(super) struct Pencil {
    /// Unit direction of the lines in space.
    pub(super) direction: DVec3,
    /// Its standard error, radians.
    pub(super) error: f64,
    /// Indices of lines.
    pub(super) members: Vec<usize>,
    /// How much the lines say together.
    pub(super) salience: f64,
}

/// Pencils of at least three lines, the most telling ones first. `used` lines take no part.
pub(super) fn pencils(lines: &Lines, camera: &Camera, used: &[bool]) -> Vec<Pencil> {
    let free = |i: &usize| !used.get(*i).copied().unwrap_or(false);
    let voters: Vec<usize> = (0..lines.all.len()).filter(free).take(VOTING).collect();
    let paired = &voters[..voters.len().min(PAIRED)];
    let mut starts: Vec<Pencil> = Vec::new();
    // Pairs that a pencil holds: they would give it again.
    let mut held = vec![[false; PAIRED]; paired.len()];
    for (k, &i) in paired.iter().enumerate() {
        let (n, n_error) = lines.plane(camera, &lines.all[i]);
        for (l, &j) in paired.iter().enumerate().skip(k + 1) {
            if held[k][l] || meet(&lines.all[i], &lines.all[j]) {
                continue;
            }
            let (m, m_error) = lines.plane(camera, &lines.all[j]);
            let cross = n.cross(m);
            let error = (n_error + m_error) / cross.length();
            if error >= VAGUE {
                continue;
            }
            let Some(start) = gather(lines, camera, &voters, cross.normalize(), error) else {
                continue;
            };
            let at = |m: &usize| paired.iter().position(|p| p == m);
            let inside: Vec<usize> = start.members.iter().filter_map(at).collect();
            for (s, &a) in inside.iter().enumerate() {
                inside[s + 1..].iter().for_each(|&b| held[a][b] = true);
            }
            starts.push(start);
        }
    }
    starts.sort_by(|a, b| b.salience.total_cmp(&a.salience));
    let mut kept: Vec<Pencil> = Vec::new();
    for start in starts {
        if kept.len() == KEPT {
            break;
        }
        // A pair of one pencil gives about the whole of it.
        let covered = |p: &Pencil| {
            let known = start.members.iter().filter(|m| p.members.contains(m));
            2 * known.count() > start.members.len()
        };
        if kept.iter().any(covered) {
            continue;
        }
        let all: Vec<usize> = (0..lines.all.len()).filter(free).collect();
        let (direction, error) = least_squares(lines, camera, &start.members);
        kept.extend(gather(lines, camera, &all, direction, error).map(|p| {
            let (direction, error) = least_squares(lines, camera, &p.members);
            Pencil {
                direction,
                error,
                ..p
            }
        }));
    }
    kept
}

/// Whether two lines share a vertex, so that they are not parallel.
fn meet(a: &Line, b: &Line) -> bool {
    a.v.iter().any(|v| b.v.contains(v))
}

fn gather(
    lines: &Lines,
    camera: &Camera,
    among: &[usize],
    direction: DVec3,
    error: f64,
) -> Option<Pencil> {
    let follows = |i: &usize| lines.follows(camera, &lines.all[*i], direction, error);
    let members: Vec<usize> = among.iter().copied().filter(follows).collect();
    let salience = members.iter().map(|&i| lines.salience(&lines.all[i])).sum();
    (members.len() >= FEWEST).then_some(Pencil {
        direction,
        error,
        members,
        salience,
    })
}

/// The direction closest to all planes through the camera and a line, with its error.
fn least_squares(lines: &Lines, camera: &Camera, members: &[usize]) -> (DVec3, f64) {
    let mut information = DMat3::ZERO;
    for &i in members {
        let (n, error) = lines.plane(camera, &lines.all[i]);
        let n = n / error;
        information += DMat3::from_cols(n * n.x, n * n.y, n * n.z);
    }
    let [(_, direction), (second, _), _] = eigen::symmetric(information);
    (direction, second.sqrt().recip())
}
