//! Rows from the straight lines of a cone: they meet at its apex, which is on the axis of its circles.

use glam::DVec2;

use super::assumed::Depth;
use super::directions::AGREE;
use super::revolved::{Center, center_of};
use super::rows::{Tag, Unknowns};
use super::sheet::Sheet;
use super::system::System;
use crate::drawing::SurfaceKind;

/// Sine of the angle between two lines of a cone below which they do not tell where they meet.
const NARROW: f64 = 0.02;

/// Gain of a circle whose centre is known.
const KNOWN: f64 = 50.0;

/// The ends of a cone's line are as high as its apex and its circle tell, which the drawing shows both.
pub(super) fn rulings(sheet: &Sheet<'_>, _: &Unknowns, system: &mut System<Tag>) {
    for (face, f) in sheet.faces.iter().enumerate() {
        if f.kind != SurfaceKind::Cone {
            continue;
        }
        let lines: Vec<usize> = sheet.edges_of(face).to_vec();
        let lines: Vec<usize> = lines
            .into_iter()
            .filter(|&e| sheet.is_straight(e))
            .collect();
        let circle = sheet.edges_of(face).iter().find_map(|&e| {
            let (k, circle) = sheet.circles[e]?;
            let v = sheet.drawing.edges[e].v[0];
            (circle.gain < KNOWN).then(|| (k, center_of(sheet, v, k, &circle)))
        });
        if let (Some((k, center)), Some((apex, error))) = (circle, apex(sheet, &lines))
            && let Some((apex, error)) = raised(sheet, k, &center, apex, error)
        {
            for &line in &lines {
                relate(sheet, line, &apex, error, Tag::Revolved { face }, system);
            }
        }
    }
}

/// Where lines meet, with its error, by the two that meet at the largest angle.
fn apex(sheet: &Sheet<'_>, lines: &[usize]) -> Option<(DVec2, f64)> {
    let line = |e: usize| {
        let [u, v] = sheet.drawing.edges[e].v.map(|v| sheet.drawing.vertices[v]);
        (u, v - u)
    };
    let pairs = lines.iter().enumerate();
    let pairs = pairs.flat_map(|(i, &a)| lines[i + 1..].iter().map(move |&b| (line(a), line(b))));
    let sine = |((_, d), (_, e)): &((DVec2, DVec2), (DVec2, DVec2))| {
        d.normalize_or_zero().perp_dot(e.normalize_or_zero()).abs()
    };
    let ((u, d), (v, e)) = pairs.max_by(|a, b| sine(a).total_cmp(&sine(b)))?;
    let sine = sine(&((u, d), (v, e)));
    let at = u + d * ((v - u).perp_dot(e) / d.perp_dot(e));
    let far = [(u, d), (v, e)].map(|(p, d)| 1.0 + 2.0 * at.distance(p + d * 0.5) / d.length());
    let error = sheet.directions.precision * far[0].max(far[1]) / sine;
    (sine > NARROW && at.is_finite()).then_some((at, error))
}

/// A cone's apex on the axis `k` of its circle.
struct Apex {
    at: DVec2,
    depth: Depth,
}

/// The apex with its height and the height's error, if it is drawn on the circle's axis.
fn raised(
    sheet: &Sheet<'_>,
    k: usize,
    center: &Center,
    at: DVec2,
    error: f64,
) -> Option<(Apex, f64)> {
    let axis = sheet.axis(k);
    let apart = at - center.at;
    let drawn = sheet.camera().drawn(axis, center.at.midpoint(at));
    let length = drawn.length();
    let off = apart.perp_dot(drawn).abs() / length;
    let turned = sheet.directions.normal_error(k) * apart.length() / length;
    if off > AGREE * (error + center.error) + turned {
        return None;
    }
    let row = sheet.camera().along(axis, center.at, at);
    let share = row.from / row.to;
    let terms = center.depth.terms.iter().map(|&(v, c)| (v, c * share));
    let depth = Depth {
        terms: terms.collect(),
        shift: center.depth.shift * share + row.rise / row.to,
    };
    let error = (2.0 * (error + center.error) + turned) / length;
    error.is_finite().then_some((Apex { at, depth }, error))
}

/// The row of the two ends of a line through an apex: heights change evenly along what is drawn.
fn relate(
    sheet: &Sheet<'_>,
    line: usize,
    apex: &Apex,
    error: f64,
    tag: Tag,
    system: &mut System<Tag>,
) {
    let ends = sheet.drawing.edges[line].v;
    let away = ends.map(|v| sheet.drawing.vertices[v].distance(apex.at));
    let (near, far) = if away[0] < away[1] { (0, 1) } else { (1, 0) };
    let share = away[near] / away[far];
    let own = apex
        .depth
        .terms
        .iter()
        .map(|&(v, c)| (v, c * (share - 1.0)));
    let terms = [(ends[near], 1.0), (ends[far], -share)]
        .into_iter()
        .chain(own);
    let rhs = apex.depth.shift * (1.0 - share);
    let error = error * (1.0 - share) + 4.0 * sheet.directions.precision;
    system.push(terms, rhs, error.recip(), tag);
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::lift::directions::Directions;
    use crate::lift::system::Row;
    use crate::lift::testing::{Scene, turned};

    /// Half a frustum between two lines of its cone.
    #[test]
    fn the_lines_of_a_cone_are_as_high_as_its_apex_tells() {
        let turn = turned(0.6, 0.7, 0.1);
        let far = Scene::central(turn, DVec3::Z * -6.0, DVec2::ZERO, 3.0);
        for mut scene in [Scene::new(turn), far] {
            let (tip, share) = (DVec3::Z * 2.0, 0.4);
            let ends = [DVec3::X, DVec3::new(-0.4, 0.2, 0.0).normalize()];
            let base = scene.arc(DVec3::ZERO, DVec3::Z, ends[0], ends[1]);
            let rest = scene.arc(DVec3::ZERO, DVec3::Z, ends[1], ends[0]);
            let small = ends.map(|e| e * (1.0 - share));
            let top = scene.arc(tip * share, DVec3::Z, small[0], small[1]);
            let lines = ends.map(|e| scene.line(e, e.lerp(tip, share)));
            scene.face(SurfaceKind::Cone, &[vec![base, lines[1], top, lines[0]]]);
            scene.face(SurfaceKind::Plane, &[vec![base, rest]]);
            let (drawing, faces) = scene.finish();
            let directions = Directions::estimate(&drawing).unwrap();
            let truth = drawing.truth.as_ref().unwrap();
            let fits = |d: &Directions| {
                let sheet = Sheet::new(&drawing, &faces, d);
                let unknowns = Unknowns::new(&sheet);
                let mut system = System::new(unknowns.count);
                rulings(&sheet, &unknowns, &mut system);
                let places = truth.vertices3d.iter();
                let heights: Vec<f64> = places.map(|p| d.camera.height(p.z)).collect();
                let off = |r: &Row<Tag>| (r.residual(&heights) * r.weight).abs();
                system.rows().len() == 2 && system.rows().iter().all(|r| off(r) < 1.0)
            };
            // A parallel projection shows the reversed cone as well.
            let reversed = directions.camera.is_parallel() && fits(&directions.clone().reversed());
            assert!(fits(&directions) != reversed);
        }
    }
}
