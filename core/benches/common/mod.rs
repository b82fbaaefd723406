//! The drawings that the benchmarks of all crates work on.

use faceformer::drawing::dataset::Drawings;
use faceformer::drawing::{Drawing, SurfaceKind};

const SAMPLE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../tests/corpus/sample.jsonl.zst"
);

/// Drawings of 20 faces, about the median of machine parts: the first polyhedron of the sample, and
/// the first part of planes and cylinders.
pub(crate) fn drawings() -> [(&'static str, Drawing); 2] {
    [
        ("polyhedron-20-faces", first(false)),
        ("cylinders-20-faces", first(true)),
    ]
}

fn first(with_cylinders: bool) -> Drawing {
    let fits = |d: &Drawing| {
        let faces = &d.truth.as_ref().expect("the sample has truth").faces;
        let of = |kind| faces.iter().filter(|f| f.kind == kind).count();
        let (planes, cylinders) = (of(SurfaceKind::Plane), of(SurfaceKind::Cylinder));
        faces.len() == 20 && planes + cylinders == 20 && (cylinders > 0) == with_cylinders
    };
    let mut drawings = Drawings::open(SAMPLE)
        .expect("the sample is there")
        .map(|d| d.expect("the sample can be read"));
    drawings
        .find(fits)
        .expect("the sample has a drawing with 20 faces")
}
