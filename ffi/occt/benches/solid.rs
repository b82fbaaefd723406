//! Time from a median drawing with its faces to a checked solid: each stage alone, then all of them.

#[path = "../../../core/benches/common/mod.rs"]
mod common;

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use faceformer::Progress;
use faceformer::drawing::Drawing;
use faceformer::identify::{Face, from_truth};
use faceformer::lift::{Lift, LiftOptions, lift};
use faceformer::plan::{Plan, PlanOptions, plan};
use faceformer_occt::build;

fn lifted(drawing: &Drawing, faces: &[Face]) -> Lift {
    lift(drawing, faces, &LiftOptions::default(), Progress::none()).expect("the drawing lifts")
}

fn planned(drawing: &Drawing, faces: &[Face], lift: &Lift) -> Plan {
    plan(drawing, faces, lift, &PlanOptions::default()).expect("the lift can be planned")
}

fn solid(c: &mut Criterion) {
    let none = Progress::none();
    for (name, drawing) in common::drawings() {
        // True faces: the subject is what comes after them.
        let faces = from_truth(&drawing).expect("the sample has truth").faces;
        let lift = lifted(&drawing, &faces);
        let plan = planned(&drawing, &faces, &lift);
        build(&plan, none).expect("the plan gives a solid");
        let mut group = c.benchmark_group(format!("solid/{name}"));
        group.bench_function("lift", |b| b.iter(|| lifted(black_box(&drawing), &faces)));
        group.bench_function("plan", |b| {
            b.iter(|| planned(black_box(&drawing), &faces, &lift))
        });
        group.bench_function("build", |b| b.iter(|| build(black_box(&plan), none)));
        group.bench_function("lift-plan-build", |b| {
            b.iter(|| {
                let lift = lifted(black_box(&drawing), &faces);
                build(&planned(&drawing, &faces, &lift), none)
            })
        });
        group.finish();
    }
}

criterion_group!(benches, solid);
criterion_main!(benches);
