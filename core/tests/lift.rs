//! Lifting of the sample corpus with its true faces.

use faceformer::Progress;
use faceformer::drawing::dataset::Drawings;
use faceformer::drawing::{Drawing, SurfaceKind};
use faceformer::identify::from_truth;
use faceformer::lift::{Lift, LiftOptions, Surface, depth_error, lift};
use glam::DVec3;

/// Largest depth error of a lifted drawing, in drawing units (design, section 7).
const LIFTED: f64 = 1e-3;

fn corpus() -> Vec<Drawing> {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../tests/corpus/sample.jsonl.zst"
    );
    let drawings = Drawings::open(path).expect("the corpus is there");
    drawings.map(|d| d.expect("the corpus is sound")).collect()
}

fn lifted(drawing: &Drawing) -> Option<(Lift, f64)> {
    let faces = from_truth(drawing)?.faces;
    let found = lift(drawing, &faces, &LiftOptions::default(), Progress::none()).ok()?;
    let error = depth_error(&found, drawing.truth.as_ref()?);
    Some((found, error))
}

fn kinds(drawing: &Drawing) -> impl Iterator<Item = SurfaceKind> + '_ {
    drawing
        .truth
        .iter()
        .flat_map(|t| t.faces.iter().map(|f| f.kind))
}

#[test]
fn corpus_is_lifted() {
    let (mut poly, mut round, mut all) = ([0, 0], [0, 0], [0, 0]);
    for drawing in corpus() {
        let ok = lifted(&drawing).is_some_and(|(_, error)| error < LIFTED);
        let count = |class: &mut [usize; 2]| {
            class[0] += usize::from(ok);
            class[1] += 1;
        };
        count(&mut all);
        if kinds(&drawing).all(|k| k == SurfaceKind::Plane) {
            count(&mut poly);
        }
        if kinds(&drawing).all(|k| matches!(k, SurfaceKind::Plane | SurfaceKind::Cylinder)) {
            count(&mut round);
        }
    }
    println!("lifted: polyhedra {poly:?}, planes and cylinders {round:?}, all {all:?}");
    assert_eq!((poly[1], round[1], all[1]), (122, 209, 300));
    assert!(poly[0] * 100 >= poly[1] * 98);
    assert!(round[0] * 100 >= round[1] * 97);
    assert!(all[0] * 100 >= all[1] * 85);
}

/// Every boundary point lies on the surface that was found for its face.
#[test]
fn corpus_surfaces_hold_their_boundaries() {
    let mut checked = 0;
    for drawing in corpus() {
        let Some((found, error)) = lifted(&drawing) else {
            continue;
        };
        let truth = drawing.truth.as_ref().expect("the corpus has truth");
        if error >= LIFTED {
            continue;
        }
        let (sign, offset) = alignment(&found, &truth.vertices3d);
        for (face, surface) in truth.faces.iter().zip(&found.surfaces) {
            let points = face
                .loops
                .iter()
                .flatten()
                .flat_map(|c| &truth.edges3d[c.edge()]);
            let points = points.map(|p| DVec3::new(p.x, p.y, sign * p.z + offset));
            let off = |distance: &dyn Fn(DVec3) -> f64| points.map(distance).fold(0.0, f64::max);
            // What is lifted of another kind may stand in for it.
            if *surface == Surface::Unknown || face.kind == SurfaceKind::Other {
                assert!(!matches!(face.kind, SurfaceKind::Plane), "{}", drawing.id);
                continue;
            }
            let worst = off(&|p| surface.distance(p).abs());
            assert!(
                worst < LIFTED,
                "{}: {surface:?} is off by {worst}",
                drawing.id
            );
            checked += 1;
        }
    }
    assert!(checked > 4000, "{checked}");
}

/// Sign and offset that take true depths to the lifted ones.
fn alignment(found: &Lift, truth: &[DVec3]) -> (f64, f64) {
    let fit = |sign: f64| {
        let shifts: Vec<f64> = found
            .depths
            .iter()
            .zip(truth)
            .map(|(z, t)| z - sign * t.z)
            .collect();
        let mean = shifts.iter().sum::<f64>() / shifts.len() as f64;
        let spread: f64 = shifts.iter().map(|s| (s - mean).abs()).sum();
        (spread, sign, mean)
    };
    let (a, b) = (fit(1.0), fit(-1.0));
    let best = if a.0 <= b.0 { a } else { b };
    (best.1, best.2)
}
