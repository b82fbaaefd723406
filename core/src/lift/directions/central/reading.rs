//! Which readings the vanishing points and circles of a drawing allow.

use glam::{DMat3, DVec3};

use super::Open;
use super::circles::{self, Circle, Group};
use super::fit::{Fitted, fit};
use super::followers::Followers;
use super::frames;
use super::lines::Lines;
use super::pencils::{Pencil, pencils};
use crate::drawing::Drawing;
use crate::lift::Camera;
use crate::lift::directions::model_frame::USUAL;
use crate::lift::directions::{AGREE, Axis, Directions, Slant, columns, towards_viewer};

/// Axes that frames are sought around: of pencils, and of circles.
const PENCILS: usize = 8;
const GROUPS: usize = 8;

/// Hypotheses that are fitted, the most telling ones.
const FITTED: usize = 8;

/// What an arc that is a circle around an axis adds, and one that is certainly none takes away.
const CIRCLE: f64 = 2.0;
const STRAY_CIRCLE: f64 = 1.0;

/// Standard error, radians, of a normal that is certain.
const SURE: f64 = 1e-3;

/// Standard error, radians, of a circle's normal up to which others agree with it by chance seldom
/// enough.
const CLEAR: f64 = 2e-4;

/// What an axis adds whose lines are drawn vertically, but for their vanishing point.
const UPRIGHT: f64 = 1.0;

/// A reading of the evidence.
pub(super) struct Reading {
    pub(super) directions: Directions,
    /// Lines explained, and circles, which count twice.
    pub(super) constraints: usize,
    /// The same less the numbers fitted.
    pub(super) votes: f64,
    /// How much it looks like the axes of a part.
    pub(super) score: f64,
}

/// All readings under a camera, most likely first.
pub(super) fn readings(
    lines: &Lines,
    drawing: &Drawing,
    camera: Camera,
    open: Open,
) -> Vec<Reading> {
    let round = circles::circles(drawing, &camera, lines.precision);
    let found = pencils(lines, &camera, &[]);
    let groups = circles::groups(&round);
    let axes = found.iter().take(PENCILS).map(|p| (p.direction, p.error));
    let around = groups.iter().take(GROUPS).map(|g| (g.normal, g.error));
    let mut starts: Vec<(f64, DMat3, f64)> = Vec::new();
    for (axis, error) in axes.chain(around) {
        for (frame, error) in frames::around(lines, &camera, axis, error) {
            let followers = Followers::of_axes(lines, &round, &camera, &frame, error);
            starts.push((explained(lines, &round, &followers), frame, error));
        }
    }
    starts.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut fitted: Vec<Fitted> = Vec::new();
    let mut tried = 0;
    for (_, frame, error) in starts {
        let known = |f: &Fitted| is_same(&f.frame, &frame, AGREE * (f.error + error));
        if tried == FITTED || fitted.iter().any(known) {
            continue;
        }
        tried += 1;
        fitted.extend(fit(lines, &round, (frame, error), camera, open));
    }
    let mut all: Vec<Reading> = Vec::new();
    for (i, f) in fitted.iter().enumerate() {
        let known = |g: &Fitted| is_same(&f.frame, &g.frame, AGREE * (f.error + g.error));
        if !fitted[..i].iter().any(known) {
            all.extend(frame_reading(lines, &round, f, open));
        }
    }
    if open == Open::Nothing {
        all.extend(
            groups
                .iter()
                .map(|g| group_reading(lines, &round, g, camera)),
        );
        all.extend(
            found
                .iter()
                .map(|p| pencil_reading(lines, &round, p, camera)),
        );
    }
    all.retain(|r| r.votes > 0.0);
    all.sort_by(|a, b| b.score.total_cmp(&a.score));
    all
}

/// How much of the evidence follows a frame, less what contradicts it.
fn explained(lines: &Lines, round: &[Circle], followers: &Followers) -> f64 {
    let straight = lines.all.iter().zip(&followers.lines);
    let straight = straight.filter_map(|(l, i)| Some(lines.salience(l) * USUAL[(*i)?].weight));
    let circles = round.iter().zip(&followers.circles);
    straight.sum::<f64>() + circles.map(|(c, k)| roundness(c, k.is_some())).sum::<f64>()
}

fn roundness(circle: &Circle, explained: bool) -> f64 {
    match explained {
        true => CIRCLE,
        false if circle.error < SURE => -STRAY_CIRCLE,
        false => 0.0,
    }
}

fn frame_reading(lines: &Lines, round: &[Circle], f: &Fitted, open: Open) -> Option<Reading> {
    let mut axes = columns(&f.frame).map(|direction| Axis {
        direction: towards_viewer(direction),
        edges: Vec::new(),
        circles: Vec::new(),
    });
    let mut slanted: Vec<Slant> = Vec::new();
    for (line, i) in lines.all.iter().zip(&f.followers.lines) {
        let Some(i) = *i else {
            continue;
        };
        if let Some(axis) = axes.get_mut(i) {
            axis.edges.push(line.edge);
        } else {
            let direction = f.frame * USUAL[i].direction;
            match slanted.iter_mut().find(|s| s.direction == direction) {
                Some(slant) => slant.edges.push(line.edge),
                None => slanted.push(Slant {
                    direction,
                    edges: vec![line.edge],
                    circles: Vec::new(),
                    error: f.error,
                    usual: true,
                }),
            }
        }
    }
    for (circle, k) in round.iter().zip(&f.followers.circles) {
        if let Some(axis) = k.and_then(|k| axes.get_mut(k)) {
            axis.circles.push(circle.edge);
        }
    }
    // A frame without an edge or circle on some axis needs more to be believed.
    let bare = axes
        .iter()
        .filter(|a| a.edges.is_empty() && a.circles.is_empty());
    let bare = bare.count();
    let constraints = f.followers.constraints();
    let votes = constraints as f64 - (3 + open.count() + bare) as f64;
    let upright = axes.iter().any(|a| {
        let sideways = a.direction.x.abs();
        sideways < AGREE * f.error && a.direction.y.abs() > 0.1
    });
    (bare < 2).then(|| Reading {
        score: explained(lines, round, &f.followers) + if upright { UPRIGHT } else { 0.0 },
        constraints,
        votes,
        directions: Directions {
            axes: axes.into(),
            slanted,
            swept: Vec::new(),
            camera: f.camera,
            error: f.error,
            precision: lines.precision,
        },
    })
}

/// Adds pencils of the lines that follow nothing else.
pub(super) fn add_pencils(lines: &Lines, directions: &mut Directions) {
    let of_axes = directions.axes.iter().map(|a| &a.edges);
    let of_slants = directions.slanted.iter().map(|s| &s.edges);
    let used: Vec<usize> = of_axes.chain(of_slants).flatten().copied().collect();
    let used: Vec<bool> = lines.all.iter().map(|l| used.contains(&l.edge)).collect();
    let slant = |p: Pencil| Slant {
        direction: p.direction,
        edges: p.members.iter().map(|&i| lines.all[i].edge).collect(),
        circles: Vec::new(),
        error: p.error,
        usual: false,
    };
    let found = pencils(lines, &directions.camera, &used);
    directions.slanted.extend(found.into_iter().map(slant));
}

/// Adds the normals of the circles that are around no axis. The false normals of two circles agree
/// only where both are drawn around one point, as the two arcs are that an outline parts, so that
/// circles apart are asked for, and more of them than any other normal has.
pub(super) fn add_normals(lines: &Lines, drawing: &Drawing, directions: &mut Directions) {
    let used = |e: usize| directions.axes.iter().any(|a| a.circles.contains(&e));
    let mut round = circles::circles(drawing, &directions.camera, lines.precision);
    round.retain(|c| c.error < CLEAR && !used(c.edge));
    while let Some(group) = circles::apart(&round) {
        let edges: Vec<usize> = group.members.iter().map(|&i| round[i].edge).collect();
        round.retain(|c| !edges.contains(&c.edge));
        directions.slanted.push(Slant {
            direction: towards_viewer(group.normal),
            edges: Vec::new(),
            circles: edges,
            error: group.error,
            usual: false,
        });
    }
}

/// One axis alone, of circles and the lines along it.
fn group_reading(lines: &Lines, round: &[Circle], group: &Group, camera: Camera) -> Reading {
    axis_reading(lines, round, (group.normal, group.error), camera)
}

/// One axis alone, of lines and the circles around it.
fn pencil_reading(lines: &Lines, round: &[Circle], pencil: &Pencil, camera: Camera) -> Reading {
    axis_reading(lines, round, (pencil.direction, pencil.error), camera)
}

fn axis_reading(
    lines: &Lines,
    round: &[Circle],
    (direction, error): (DVec3, f64),
    camera: Camera,
) -> Reading {
    let along: Vec<bool> = lines
        .all
        .iter()
        .map(|l| lines.follows(&camera, l, direction, error))
        .collect();
    let around: Vec<bool> = round
        .iter()
        .map(|c| {
            c.agreeing(direction, error)
                .or(c.agreeing(-direction, error))
                .is_some()
        })
        .collect();
    let edges = lines.all.iter().zip(&along).filter(|(_, a)| **a);
    let circles = round.iter().zip(&around).filter(|(_, a)| **a);
    let axis = Axis {
        direction: towards_viewer(direction),
        edges: edges.clone().map(|(l, _)| l.edge).collect(),
        circles: circles.clone().map(|(c, _)| c.edge).collect(),
    };
    let straight: f64 = edges.map(|(l, _)| lines.salience(l)).sum();
    let shown = round.iter().zip(&around).map(|(c, a)| roundness(c, *a));
    let constraints = axis.edges.len() + 2 * axis.circles.len();
    Reading {
        score: straight + shown.sum::<f64>(),
        constraints,
        votes: constraints as f64 - 2.0,
        directions: Directions {
            axes: vec![axis],
            slanted: Vec::new(),
            swept: Vec::new(),
            camera,
            error,
            precision: lines.precision,
        },
    }
}

/// Whether two frames have the same axes.
fn is_same(a: &DMat3, b: &DMat3, tolerance: f64) -> bool {
    columns(b)
        .iter()
        .all(|v| columns(a).iter().any(|u| u.cross(*v).length() < tolerance))
}
