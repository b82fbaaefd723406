//! Where the fit of a sweep starts: long arcs taken for circles around one axis.

use std::f64::consts::PI;

use glam::{DQuat, DVec2, DVec3};

use super::fit::{Fitted, Member};
use super::model::{Base, OWN, SHARED};
use crate::drawing::{Curve2, Drawing, EllipseArc, leaving};
use crate::lift::{Camera, circle_through};

/// A point this far off an ellipse, in sizes, is not of a circle.
const ROUND: f64 = 5e-6;

/// A track is off the ellipse nearest to it by no more than this share of the larger half axis, and that
/// ellipse is no narrower.
const OFF: f64 = 0.1;
const NARROW: f64 = 0.05;

/// Angle of an arc from which on its ellipse is known well enough, radians.
const LONG: f64 = 2.0;

/// Part of a track that is like an ellipse, radians.
const TURN: f64 = 5.5;

/// Circles are around one axis if they are off it by less than this share of their radius.
const ASIDE: f64 = 0.3;

/// Sine of the angle within which edges go on smoothly into each other.
const SMOOTH: f64 = 0.15;

/// Starts that are tried.
const STARTS: usize = 2;

/// A long edge that may be on a track.
#[derive(Debug, Clone)]
pub(super) struct Seed {
    pub(super) edge: usize,
    /// Its points as drawn, in sizes of the drawing, of its first turn.
    points: Vec<DVec2>,
    /// The ellipse nearest to them.
    arc: EllipseArc,
}

/// Points of an edge that are kept are so many at least, or turn by this much, radians.
const FEW: usize = 17;
const BEND: f64 = 0.12;

/// Points of an edge, in sizes of the drawing: no more than tell its shape.
pub(super) fn points(drawing: &Drawing, edge: usize) -> Vec<DVec2> {
    let size = drawing.size();
    let all = &drawing.edges[edge].points;
    let mut kept: Vec<DVec2> = Vec::new();
    let mut turned = f64::INFINITY;
    for (i, p) in all.iter().enumerate() {
        if let Some(next) = all.get(i + 1)
            && i > 0
        {
            turned += (*p - all[i - 1]).angle_to(next - p).abs();
        }
        if all.len() <= FEW || turned >= BEND || i + 1 == all.len() {
            kept.push(*p / size);
            turned = 0.0;
        }
    }
    kept
}

/// Long edges that are nearly arcs of ellipses, and not quite, longest first.
pub(super) fn seeds(drawing: &Drawing) -> Vec<Seed> {
    let size = drawing.size();
    let mut seeds: Vec<Seed> = Vec::new();
    for (edge, e) in drawing.edges.iter().enumerate() {
        let open = match e.curve {
            Curve2::Line => false,
            Curve2::Ellipse(arc) => arc.residual > ROUND * size,
            Curve2::Polyline => true,
        };
        if !open || e.v[0] == e.v[1] {
            continue;
        }
        let mut points = points(drawing, edge);
        points.truncate(first_turn(&points));
        let Some(arc) = Curve2::nearest_ellipse(&points) else {
            continue;
        };
        let reach = arc.major.length();
        if arc.residual < OFF * reach && arc.ratio > NARROW && arc.sweep.abs() > LONG && reach < 4.0
        {
            seeds.push(Seed { edge, points, arc });
        }
    }
    seeds.sort_by(|a, b| b.arc.sweep.abs().total_cmp(&a.arc.sweep.abs()));
    seeds
}

/// Number of points up to which a polyline has turned by less than a whole turn.
fn first_turn(points: &[DVec2]) -> usize {
    let mut turned = 0.0;
    for (i, p) in points.windows(3).enumerate() {
        let (d, e) = (p[1] - p[0], p[2] - p[1]);
        turned += d.angle_to(e);
        if f64::abs(turned) > TURN {
            return i + 2;
        }
    }
    points.len()
}

/// First guesses of a sweep that the seeds are on.
pub(super) fn starts(drawing: &Drawing, seeds: &[Seed], camera: Camera) -> Vec<Fitted> {
    let first = seeds.iter().take(STARTS);
    first
        .flat_map(|seed| {
            normals(&seed.arc, &camera)
                .into_iter()
                .map(move |n| (seed, n))
        })
        .filter_map(|(seed, normal)| start(drawing, seeds, seed, normal, camera))
        .collect()
}

/// Normals of a circle that is drawn about as an ellipse; the mirror image in depth says the same in
/// a parallel projection.
fn normals(arc: &EllipseArc, camera: &Camera) -> Vec<DVec3> {
    let slant = (1.0 - arc.ratio * arc.ratio).max(0.0).sqrt();
    let side = arc.minor().normalize_or_zero() * slant;
    let both = [side.extend(arc.ratio), (-side).extend(arc.ratio)];
    if camera.is_parallel() {
        return both[..1].to_vec();
    }
    let (_, ray) = camera.ray(arc.center);
    let turn = DQuat::from_rotation_arc(DVec3::Z, -ray.normalize());
    both.map(|n| turn * n).to_vec()
}

/// The seeds as circles around an axis through the middle of one of them.
fn start(
    drawing: &Drawing,
    seeds: &[Seed],
    around: &Seed,
    axis: DVec3,
    camera: Camera,
) -> Option<Fitted> {
    let center = circle_through(&around.points, axis, &camera)?.center;
    let origin = camera.unit(center);
    let base = Base {
        camera,
        axis,
        origin,
    };
    let (u, v) = base.sides();
    let along = camera.drawn(axis, center).normalize_or_zero();
    let mut circles: Vec<(usize, f64, f64)> = Vec::new();
    let mut members: Vec<Member> = Vec::new();
    for seed in seeds {
        let Some(circle) = circle_through(&seed.points, axis, &camera) else {
            continue;
        };
        let aside = (circle.center - center).perp_dot(along).abs();
        if circle.residual > ASIDE * circle.radius || aside > ASIDE * circle.radius {
            continue;
        }
        // The point of the axis nearest to the line of sight of the circle's centre.
        let (from, ray) = camera.ray(circle.center);
        let across = ray.cross(axis).cross(ray);
        let height = across.dot(from - origin) / across.dot(axis);
        let middle = origin + axis * height;
        let unfolded = seed.points.iter().map(|p| {
            let d = camera.on_plane(*p, axis, middle) - middle;
            DVec2::new(d.dot(u), d.dot(v))
        });
        let out: Vec<DVec2> = unfolded.collect();
        let radius = out.iter().map(|d| d.length()).sum::<f64>() / out.len() as f64;
        let mut at: Vec<f64> = out.iter().map(|d| d.to_angle()).collect();
        unwrap(&mut at);
        let beside = members.iter().find_map(|m| {
            let (of, end) = joined(drawing, (seed.edge, &seed.points), (m.edge, &m.points))?;
            Some((m.track, m.at[end] - at[of]))
        });
        let (track, ahead) = match beside {
            Some(known) => known,
            None => {
                circles.push((circles.len(), radius, height));
                let mean = |t: &[f64]| t.iter().sum::<f64>() / t.len() as f64;
                let ahead = members.first().map_or(0.0, |m| mean(&m.at) - mean(&at));
                (circles.len() - 1, ahead)
            }
        };
        let turns = (ahead / (2.0 * PI)).round() * 2.0 * PI;
        at.iter_mut().for_each(|t| *t += turns);
        members.push(Member {
            edge: seed.edge,
            track,
            points: seed.points.clone(),
            at,
        });
    }
    let count = circles.len() as f64;
    let radius = circles.iter().map(|c| c.1).sum::<f64>() / count;
    let height = circles.iter().map(|c| c.2).sum::<f64>() / count;
    let mut x = vec![0.0; SHARED + OWN * circles.len()];
    (x[3], x[6]) = (radius, height);
    for (track, r, h) in circles {
        let first = SHARED + OWN * track;
        (x[first], x[first + 1]) = (r - radius, h - height);
    }
    (!members.is_empty()).then_some(Fitted { base, x, members })
}

/// Takes whole turns out of the steps between angles.
fn unwrap(angles: &mut [f64]) {
    for i in 1..angles.len() {
        let step = angles[i] - angles[i - 1];
        angles[i] -= (step / (2.0 * PI)).round() * 2.0 * PI;
    }
}

/// Where two edges, each with its points, go on into each other: the indices of the points of each at
/// the vertex between.
pub(super) fn joined(
    drawing: &Drawing,
    (a, p): (usize, &[DVec2]),
    (b, q): (usize, &[DVec2]),
) -> Option<(usize, usize)> {
    let (va, vb) = (drawing.edges[a].v, drawing.edges[b].v);
    for (i, s) in va.iter().enumerate() {
        for (j, t) in vb.iter().enumerate() {
            if s == t && away(p, i == 1).dot(away(q, j == 1)) < -(1.0 - SMOOTH * SMOOTH).sqrt() {
                return Some((i * (p.len() - 1), j * (q.len() - 1)));
            }
        }
    }
    None
}

/// Unit tangent of a polyline at its first or last point, away from that.
fn away(points: &[DVec2], from_end: bool) -> DVec2 {
    let last = points.len() - 1;
    leaving([0, 1, 2].map(|i: usize| {
        points[if from_end {
            last - i.min(last)
        } else {
            i.min(last)
        }]
    }))
}
