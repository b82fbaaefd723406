//! Time to identify the faces of a median drawing, one polyhedron, which every engine takes, and one
//! with cylinders.

mod common;

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use faceformer::Progress;
use faceformer::identify::{EngineKind, engine};

fn identify(c: &mut Criterion) {
    for (name, drawing) in common::drawings() {
        let mut group = c.benchmark_group(format!("identify/{name}"));
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
