//! The paper's networks in candle see drawings and sequences as they do in PyTorch.
//!
//! The fixture is made by `python -m faceformer_training.faceformer.fixture` from the tables of the
//! first 4 drawings of the corpus, see training/README.md.

use std::path::{Path, PathBuf};

use faceformer::drawing::dataset::Drawings;
use faceformer::identify::faceformer::inputs::Inputs;
use faceformer::identify::faceformer::{Hypothesis, Memory, Network, Variant};
use safetensors::SafeTensors;

const DRAWINGS: usize = 4;
const STRIDE: usize = 7;
const TOLERANCE: f32 = 1e-4;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/fixtures/faceformer")
        .join(name)
}

fn floats(tensors: &SafeTensors<'_>, name: &str) -> Vec<f32> {
    let data = tensors.tensor(name).unwrap().data().to_vec();
    let value = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    data.chunks_exact(4).map(value).collect()
}

fn ints(tensors: &SafeTensors<'_>, name: &str) -> Vec<u32> {
    let data = tensors.tensor(name).unwrap().data().to_vec();
    let value = |b: &[u8]| i32::from_le_bytes([b[0], b[1], b[2], b[3]]) as u32;
    data.chunks_exact(4).map(value).collect()
}

fn compare(name: &str, causal: bool) {
    let network = Network::read(&fixture(&format!("{name}.safetensors"))).unwrap();
    let bytes = std::fs::read(fixture("expected.safetensors")).unwrap();
    let expected = SafeTensors::deserialize(&bytes).unwrap();
    let mode = if causal { "causal" } else { "non-causal" };
    let mut memory_values = floats(&expected, &format!("{name}.memory")).into_iter();
    let mut tokens = ints(&expected, &format!("{name}.tokens")).into_iter();
    let mut lengths = ints(&expected, &format!("{name}.lengths")).into_iter();
    let mut sums = floats(&expected, &format!("{name}.{mode}")).into_iter();
    let config = *network.config();
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/corpus/sample.jsonl.zst");
    for drawing in Drawings::open(corpus).unwrap().take(DRAWINGS) {
        let drawing = drawing.unwrap();
        let inputs = Inputs::new(&drawing, config.variant, config.frame, config.points);
        let memory = network.encode(&inputs.points).unwrap();
        for row in memory.tokens().unwrap().iter().step_by(STRIDE) {
            for x in row {
                let off = (x - memory_values.next().unwrap()).abs();
                assert!(
                    off < TOLERANCE,
                    "{}: the memory is off by {off}",
                    drawing.id
                );
            }
        }
        let count = match config.variant {
            Variant::Faceformer => inputs.coedges.len().div_ceil(STRIDE),
            _ => 1,
        };
        let sequences: Vec<Vec<u32>> = (0..count)
            .map(|_| {
                let length = lengths.next().unwrap() as usize;
                tokens.by_ref().take(length).collect()
            })
            .collect();
        let found = log_probabilities(&network, &memory, causal, &sequences);
        for found in found {
            let off = (found - sums.next().unwrap()).abs();
            assert!(off < 1e-3, "{}: a sequence is off by {off}", drawing.id);
        }
    }
    assert!(memory_values.next().is_none() && tokens.next().is_none());
    assert!(lengths.next().is_none() && sums.next().is_none());
}

/// How likely the network finds sequences, all at once; those that end are dropped on the way.
fn log_probabilities(
    network: &Network,
    memory: &Memory,
    causal: bool,
    sequences: &[Vec<u32>],
) -> Vec<f32> {
    let variant = network.config().variant;
    let mut decoding = network.decode(memory, causal);
    let mut sums = vec![0.0; sequences.len()];
    let mut owners: Vec<usize> = (0..sequences.len()).collect();
    let mut rows: Vec<Hypothesis> = sequences.iter().map(|s| Hypothesis::new(s[0])).collect();
    while !rows.is_empty() {
        let logits = decoding.step(&mut rows).unwrap();
        let mut next = Vec::new();
        let mut still = Vec::new();
        for ((mut row, owner), logits) in rows.into_iter().zip(owners).zip(logits) {
            let token = sequences[owner][row.tokens.len()];
            let all = logits.iter().enumerate();
            let sum: f64 = all
                .filter(|(t, _)| variant.follows(*t))
                .map(|(_, &x)| f64::from(x).exp())
                .sum();
            sums[owner] += logits[token as usize] - sum.ln() as f32;
            row.tokens.push(token);
            if row.tokens.len() < sequences[owner].len() {
                next.push(row);
                still.push(owner);
            }
        }
        (rows, owners) = (next, still);
    }
    sums
}

#[test]
fn faces_are_those_of_pytorch() {
    compare("faceformer", true);
}

#[test]
fn faces_without_the_causal_mask_are_those_of_pytorch() {
    compare("faceformer", false);
}

#[test]
fn sequences_of_coedges_are_those_of_pytorch() {
    compare("seq2seq-coedge", true);
    compare("seq2seq-coedge", false);
}

#[test]
fn sequences_of_edges_are_those_of_pytorch() {
    compare("seq2seq", true);
    compare("seq2seq", false);
}
