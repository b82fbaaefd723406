//! The paper's networks in candle decode what they decode in PyTorch.
//!
//! The fixture is made by `python -m faceformer_training.faceformer.fixture` from the tables of the
//! first 12 drawings of the corpus, see training/README.md.

use std::path::{Path, PathBuf};

use faceformer::Error;
use faceformer::drawing::dataset::Drawings;
use faceformer::identify::faceformer::inputs::Inputs;
use faceformer::identify::faceformer::{Network, TOKENS, Variant, search};
use safetensors::SafeTensors;

const DRAWINGS: usize = 12;
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
    let mut tokens = ints(&expected, &format!("{name}.{mode}.tokens")).into_iter();
    let mut lengths = ints(&expected, &format!("{name}.{mode}.lengths")).into_iter();
    let mut sums = floats(&expected, &format!("{name}.{mode}.log_probability")).into_iter();
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
        let starts: Vec<u32> = match config.variant {
            Variant::Faceformer => (0..inputs.coedges.len())
                .map(|i| (i + TOKENS) as u32)
                .collect(),
            _ => vec![Variant::SOS],
        };
        let found = search(
            &mut network.decode(&memory, causal),
            config.variant,
            &starts,
            config.steps,
            1,
            |_, _| (),
            |_| Ok::<(), Error>(()),
        );
        for found in found.unwrap().unwrap() {
            let length = lengths.next().unwrap() as usize;
            let same: Vec<u32> = tokens.by_ref().take(length).collect();
            assert_eq!(found.tokens, same, "{}", drawing.id);
            let sum: f32 = found.log_probabilities.iter().sum();
            let off = (sum - sums.next().unwrap()).abs();
            assert!(off < 1e-3, "{}: a sequence is off by {off}", drawing.id);
        }
    }
    assert!(memory_values.next().is_none() && tokens.next().is_none());
    assert!(lengths.next().is_none() && sums.next().is_none());
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
