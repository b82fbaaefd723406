//! Time to identify the faces of a median drawing: one of the sample with 20 faces, a polyhedron,
//! which every engine takes, and one with cylinders.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use faceformer::Progress;
use faceformer::drawing::dataset::Drawings;
use faceformer::drawing::{Drawing, SurfaceKind};
use faceformer::identify::{EngineKind, engine};

const SAMPLE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../tests/corpus/sample.jsonl.zst"
);

/// The first drawing of the sample with 20 faces, all planes or not.
fn drawing(all_planes: bool) -> Drawing {
    let fits = |d: &Drawing| {
        let faces = &d.truth.as_ref().expect("the sample has truth").faces;
        let planes = faces.iter().all(|f| f.kind == SurfaceKind::Plane);
        faces.len() == 20 && planes == all_planes
    };
    let drawings = Drawings::open(SAMPLE).expect("the sample is there");
    let drawings = drawings.map(|d| d.expect("the sample can be read"));
    drawings
        .into_iter()
        .find(fits)
        .expect("the sample has a drawing with 20 faces")
}

fn identify(c: &mut Criterion) {
    for (name, all_planes) in [("polyhedron", true), ("curved", false)] {
        let drawing = drawing(all_planes);
        let mut group = c.benchmark_group(format!("identify/{name}-20-faces"));
        for kind in EngineKind::ALL {
            let engine = engine(kind);
            if engine.identify(&drawing, Progress::none()).is_err() {
                continue;
            }
            group.bench_function(kind.name(), |b| {
                b.iter(|| engine.identify(black_box(&drawing), Progress::none()))
            });
        }
        group.finish();
    }
}

criterion_group!(benches, identify);
criterion_main!(benches);
