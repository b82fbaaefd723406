//! The drawings that the benchmarks of all crates work on.

use std::path::Path;

use faceformer::drawing::dataset::Drawings;
use faceformer::drawing::{Drawing, SurfaceKind};

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
    // The crates that share this file lie at different depths of the repository.
    let sample = Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .map(|folder| folder.join("tests/corpus/sample.jsonl.zst"))
        .find(|path| path.exists());
    let mut drawings = Drawings::open(sample.expect("the sample is there"))
        .expect("the sample can be opened")
        .map(|d| d.expect("the sample can be read"));
    drawings
        .find(fits)
        .expect("the sample has a drawing with 20 faces")
}
