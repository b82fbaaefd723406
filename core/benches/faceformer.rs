//! Time to identify the faces of a median drawing by the paper's model, at the paper's size and at the
//! small preset's.
//!
//! The weights are random, for none are shipped. Every sequence is as long as that of a true face at
//! the most, and few end before, so the times are those of a trained model or a little above.

mod common;

use std::hint::black_box;

use candle_core::{DType, Device};
use candle_nn::{VarBuilder, VarMap};
use criterion::{Criterion, criterion_group, criterion_main};
use faceformer::Progress;
use faceformer::drawing::Drawing;
use faceformer::identify::Engine;
use faceformer::identify::faceformer::{
    Config, DecodeOptions, FORMAT, FaceformerEngine, Frame, FurtherLoops, Network, Variant,
};

/// Mean number of co-edges of a face's sequence from each of its co-edges, rounded up.
fn mean_length(drawing: &Drawing) -> usize {
    let faces = &drawing.truth.as_ref().expect("the sample has truth").faces;
    let sizes = faces.iter().map(|f| f.loops.iter().map(Vec::len).sum());
    let (sum, squares) = sizes.fold((0, 0), |(s, q), n: usize| (s + n, q + n * n));
    squares.div_ceil(sum)
}

fn network(width: usize, heads: usize, layers: usize, hidden: usize, steps: usize) -> Network {
    let config = Config {
        variant: Variant::Faceformer,
        width,
        heads,
        encoder_layers: layers,
        decoder_layers: layers,
        hidden,
        points: 50,
        inputs: 320,
        steps,
        frame: Frame::Fitted,
        further_loops: FurtherLoops::Sorted,
        format: FORMAT,
    };
    let vars = VarMap::new();
    let vb = VarBuilder::from_varmap(&vars, DType::F32, &Device::Cpu);
    Network::new(config, &vb).expect("the shapes fit each other")
}

fn identify(c: &mut Criterion) {
    for (name, drawing) in common::drawings() {
        let mut group = c.benchmark_group(format!("identify/{name}"));
        let steps = mean_length(&drawing);
        for (size, width, heads, layers, hidden) in
            [("paper", 512, 8, 6, 1024), ("small", 192, 6, 4, 384)]
        {
            let network = network(width, heads, layers, hidden, steps);
            let engine = FaceformerEngine::new(network, DecodeOptions::default());
            group.bench_function(format!("faceformer-{size}"), |b| {
                // Faces of random weights are none; the refusal comes after all the work.
                b.iter(|| engine.identify(black_box(&drawing), Progress::none()))
            });
        }
        group.finish();
    }
}

criterion_group!(benches, identify);
criterion_main!(benches);
