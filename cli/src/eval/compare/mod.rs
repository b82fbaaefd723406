//! The solid of a drawing beside the solid of its truth.

mod chamfer;
mod tree;

use std::collections::BTreeMap;

use faceformer::Progress;
use faceformer::drawing::{Drawing, SurfaceKind, Truth};
use faceformer::identify::{Face, from_truth};
use faceformer::lift::{Camera, Lift, Surface, true_lift};
use faceformer::plan::{Orientation, Plan, PlanOptions, plan, polyline};
use faceformer_occt::{FaceCounts, Solid, build};
use glam::{DMat3, DVec3};

/// Triangles stay this close to the faces, in drawing units.
const DEFLECTION: f64 = 1e-4;

/// Largest Chamfer distance of a solid that counts as right, in drawing units (half diagonal 1).
const CHAMFER: f64 = 1e-3;

/// Largest relative error of a volume that counts as right.
const VOLUME: f64 = 0.01;

/// Points closer to a line than this share of its length are on it.
const FLAT: f64 = 1e-3;

/// How a valid solid compares with the true one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Compared {
    /// Whether the Chamfer distance is below 1e-3.
    pub(crate) near: bool,
    /// Whether the volume is right within 1%.
    pub(crate) volume: bool,
    /// Faces of the solid by kind.
    pub(crate) faces: FaceCounts,
    /// Faces of the true solid by kind.
    pub(crate) true_faces: FaceCounts,
    /// Sum of the two mean distances, drawing units.
    pub(crate) chamfer: f64,
}

/// The true solid of a drawing.
struct True {
    lift: Lift,
    plan: Plan,
    solid: Solid,
}

/// Compares a solid, built from `lift` by `plan`, with the true one. The words say why there is no
/// truth to compare with.
pub(super) fn compare(
    drawing: &Drawing,
    truth: &Truth,
    faces: &[Face],
    lift: &Lift,
    built: (&Plan, &Solid),
) -> Result<Compared, String> {
    let real = true_solid(drawing)?;
    let place = place(drawing, faces, lift, built.0)?;
    // Only a parallel projection leaves open which end is near, and only a central one the scale.
    let (scale, ways) = match lift.camera {
        Camera::Parallel => (1.0, &[1.0, -1.0][..]),
        Camera::Central { .. } => (factor(lift, &real.lift), &[1.0][..]),
    };
    let triangles = |solid: &Solid| solid.triangles(DEFLECTION).map_err(|e| e.to_string());
    let own = triangles(built.1)?;
    let other = chamfer::Surface::new(triangles(&real.solid)?).ok_or("the truth has no area")?;
    let mut chamfer = f64::INFINITY;
    for way in ways {
        let turn = |p: DVec3| place(p) * scale * DVec3::new(1.0, 1.0, *way);
        let moved = own.iter().map(|t| t.map(turn)).collect();
        if let Some(moved) = chamfer::Surface::new(moved) {
            chamfer = chamfer.min(moved.chamfer(&other));
        }
        if chamfer < CHAMFER {
            break;
        }
    }
    let [volume, expected] = [built.1, &real.solid].map(|s| s.report().volume);
    Ok(Compared {
        near: chamfer < CHAMFER,
        volume: (volume * scale.powi(3) - expected).abs() <= VOLUME * expected,
        faces: built.1.report().face_counts,
        true_faces: true_counts(truth, &real.plan),
        chamfer,
    })
}

/// The solid of the truth, in the camera frame.
fn true_solid(drawing: &Drawing) -> Result<True, String> {
    let lift = true_lift(drawing).ok_or("the drawing has no truth in space")?;
    let faces = from_truth(drawing)
        .ok_or("the drawing has no true faces")?
        .faces;
    if let Some(f) = lift.surfaces.iter().position(|s| *s == Surface::Unknown) {
        return Err(format!("the surface of true face {} is not known", f + 1));
    }
    let options = PlanOptions {
        orientation: Orientation::Drawn,
        ..PlanOptions::default()
    };
    let plan = plan(drawing, &faces, &lift, &options).map_err(|e| e.to_string())?;
    let solid = build(&plan, Progress::none()).map_err(|e| e.to_string())?;
    Ok(True { lift, plan, solid })
}

/// True faces by kind; faces that a silhouette parts are one.
fn true_counts(truth: &Truth, plan: &Plan) -> FaceCounts {
    let mut group: Vec<usize> = (0..truth.faces.len()).collect();
    let mut beside: BTreeMap<usize, usize> = BTreeMap::new();
    for (f, face) in truth.faces.iter().enumerate() {
        for edge in face.loops.iter().flatten().map(|c| c.edge()) {
            if !plan.edges[edge].silhouette {
                continue;
            }
            if let Some(g) = beside.insert(edge, f) {
                let (from, to) = (group[f], group[g]);
                group
                    .iter_mut()
                    .filter(|x| **x == from)
                    .for_each(|x| *x = to);
            }
        }
    }
    let mut counts = FaceCounts::default();
    for (f, face) in truth.faces.iter().enumerate() {
        if group[f] != f && group[..f].contains(&group[f]) {
            continue;
        }
        let count = match face.kind {
            SurfaceKind::Plane => &mut counts.plane,
            SurfaceKind::Cylinder => &mut counts.cylinder,
            SurfaceKind::Cone => &mut counts.cone,
            SurfaceKind::Sphere => &mut counts.sphere,
            SurfaceKind::Torus => &mut counts.torus,
            SurfaceKind::Other => &mut counts.other,
        };
        *count += 1;
    }
    counts
}

/// The motion that takes a planned solid back into the camera frame: the plan made anew as it is
/// drawn has the same edges there.
fn place(
    drawing: &Drawing,
    faces: &[Face],
    lift: &Lift,
    upright: &Plan,
) -> Result<impl Fn(DVec3) -> DVec3 + use<>, String> {
    let options = PlanOptions {
        orientation: Orientation::Drawn,
        ..PlanOptions::default()
    };
    let drawn = plan(drawing, faces, lift, &options).map_err(|e| e.to_string())?;
    // Curves may be of other kinds in the other plan; vertices are the same.
    let middles = |plan: &Plan| -> Vec<DVec3> {
        let edges = plan.edges.iter();
        edges
            .map(|e| polyline(e, &plan.vertices, 4))
            .map(|line| line[line.len() / 2])
            .collect()
    };
    let mut ends = [upright, &drawn].map(|plan| plan.vertices.clone());
    if corners(&ends[1]).is_none() {
        ends = [upright, &drawn].map(middles);
    }
    let [from, to] = ends;
    let [a, b, c] = corners(&to).ok_or("the solid has no extent")?;
    let frame = |p: &[DVec3]| -> Option<DMat3> {
        let x = (p[b] - p[a]).try_normalize()?;
        let y = (p[c] - p[a]).reject_from_normalized(x).try_normalize()?;
        Some(DMat3::from_cols(x, y, x.cross(y)))
    };
    let same = from.len() == to.len();
    let frames = same.then(|| Some((frame(&from)?, frame(&to)?))).flatten();
    let (f, t) = frames.ok_or("its plans differ")?;
    let turn = t * f.transpose();
    let (start, end) = (from[a], to[a]);
    Ok(move |p: DVec3| turn * (p - start) + end)
}

/// Three points far from each other and from one line, as far as there are.
fn corners(points: &[DVec3]) -> Option<[usize; 3]> {
    let furthest = |away: &dyn Fn(DVec3) -> f64| {
        (0..points.len()).max_by(|&i, &j| away(points[i]).total_cmp(&away(points[j])))
    };
    let a = furthest(&|p| p.distance(*points.first().unwrap_or(&p)))?;
    let b = furthest(&|p| p.distance(points[a]))?;
    let line = (points[b] - points[a]).try_normalize()?;
    let aside = |p: DVec3| (p - points[a]).reject_from_normalized(line).length();
    let c = furthest(&aside)?;
    (aside(points[c]) > FLAT * points[a].distance(points[b])).then_some([a, b, c])
}

/// The scale of a lifted perspective drawing, which is free: that of the truth.
fn factor(lift: &Lift, real: &Lift) -> f64 {
    let pairs = || lift.depths.iter().zip(&real.depths);
    let (both, own) = pairs().fold((0.0, 0.0), |(b, o), (z, t)| (b + z * t, o + z * z));
    both / own
}

#[cfg(test)]
mod tests {
    use faceformer::drawing::dataset::Drawings;
    use faceformer::lift::{LiftOptions, lift};

    use super::*;

    fn drawing(id: &str) -> Drawing {
        let path = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../tests/corpus/sample.jsonl.zst"
        );
        let mut drawings = Drawings::open(path).unwrap().map(Result::unwrap);
        drawings.find(|d| d.id == id).unwrap()
    }

    /// Compares a drawing, lifted with its true faces, after a change to its lift.
    fn compared(id: &str, change: impl Fn(&mut Lift)) -> Compared {
        let drawing = drawing(id);
        let faces = from_truth(&drawing).unwrap().faces;
        let mut lift = lift(&drawing, &faces, &LiftOptions::default(), Progress::none()).unwrap();
        change(&mut lift);
        let plan = plan(&drawing, &faces, &lift, &PlanOptions::default()).unwrap();
        let solid = build(&plan, Progress::none()).unwrap();
        let truth = drawing.truth.as_ref().unwrap();
        compare(&drawing, truth, &faces, &lift, (&plan, &solid)).unwrap()
    }

    /// Planes, cylinders, a cone and tori.
    const MIXED: &str = "asitus/00016#o0";

    #[test]
    fn a_right_solid_is_right_in_all_ways() {
        let found = compared(MIXED, |_| ());
        assert!(found.near && found.volume, "{found:?}");
        assert_eq!(found.faces, found.true_faces);
        assert!(found.chamfer < 1e-4, "{found:?}");
    }

    #[test]
    fn the_reversal_in_depth_is_as_right() {
        let drawing = drawing(MIXED);
        let faces = from_truth(&drawing).unwrap().faces;
        let options = LiftOptions { flip: true };
        let flipped = lift(&drawing, &faces, &options, Progress::none()).unwrap();
        let found = compared(MIXED, |lift| *lift = flipped.clone());
        assert!(found.near && found.volume, "{found:?}");
    }

    #[test]
    fn a_stretched_solid_is_wrong() {
        // A block, 5% too deep.
        let found = compared("moteus/00038#o0", |lift| {
            let stretch = DVec3::new(1.0, 1.0, 1.05);
            lift.depths.iter_mut().for_each(|z| *z *= stretch.z);
            for surface in &mut lift.surfaces {
                if let Surface::Plane { origin, normal } = surface {
                    *origin *= stretch;
                    *normal = (*normal / stretch).normalize();
                }
            }
            lift.directions.clear();
        });
        assert!(!found.near && !found.volume, "{found:?}");
    }

    #[test]
    fn corners_span_a_plane() {
        let points = [
            DVec3::ZERO,
            DVec3::X,
            DVec3::X * 2.0,
            DVec3::new(1.0, 0.1, 0.0),
        ];
        let mut found = corners(&points).unwrap();
        found.sort_unstable();
        assert_eq!(found, [0, 2, 3]);
        assert_eq!(corners(&[]), None);
    }
}
