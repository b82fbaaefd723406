//! The network in candle gives what it gives in PyTorch.
//!
//! The fixture is made by `python -m faceformer_training.rotation.fixture` from the tables of the
//! first 100 drawings of the corpus, see training/README.md.

use std::path::{Path, PathBuf};

use faceformer::drawing::dataset::Drawings;
use faceformer::drawing::{CoEdge, Graph};
use faceformer::identify::rotation::Triples;
use faceformer::identify::rotation::inputs::Inputs;
use faceformer::identify::rotation::model::read;
use safetensors::SafeTensors;

const DRAWINGS: usize = 100;
const STRIDE: usize = 7;
const TOLERANCE: f32 = 1e-4;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/fixtures/rotation")
        .join(name)
}

fn floats(tensors: &SafeTensors<'_>, name: &str) -> Vec<f32> {
    let data = tensors.tensor(name).unwrap().data().to_vec();
    let value = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    data.chunks_exact(4).map(value).collect()
}

#[test]
fn logits_are_those_of_pytorch() {
    let network = read(&fixture("model.safetensors")).unwrap();
    let bytes = std::fs::read(fixture("expected.safetensors")).unwrap();
    let expected = SafeTensors::deserialize(&bytes).unwrap();
    let mut scores = floats(&expected, "scores").into_iter();
    let mut kinds = floats(&expected, "kinds").into_iter();
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/corpus/sample.jsonl.zst");
    let mut worst = 0.0f32;
    for drawing in Drawings::open(corpus).unwrap().take(DRAWINGS) {
        let drawing = drawing.unwrap();
        let graph = Graph::new(&drawing);
        let triples = Triples::new(&graph);
        let inputs = Inputs::new(&drawing, &graph, &triples);
        let encoded = network.encode(&inputs).unwrap();
        for (t, score) in encoded.scores.iter().enumerate().step_by(STRIDE) {
            let off = (score - scores.next().unwrap()).abs();
            assert!(
                off < TOLERANCE,
                "{}: triple {t} is off by {off}",
                drawing.id
            );
            worst = worst.max(off);
        }
        let step = |walk: &[CoEdge], k: usize| {
            let n = walk.len();
            let before = graph.position(walk[(k + n - 1) % n].mate());
            let after = graph.position(walk[(k + 1) % n]);
            (
                triples.index(&graph, walk[k], before, after),
                walk[k].edge(),
            )
        };
        let truth = drawing.truth.as_ref().unwrap();
        let loops = truth.faces.iter().flat_map(|f| &f.loops);
        let steps: Vec<Vec<(usize, usize)>> = loops
            .map(|walk| (0..walk.len()).map(|k| step(walk, k)).collect())
            .collect();
        let logits = network.kinds(&encoded, &steps).unwrap();
        for x in logits.iter().step_by(STRIDE).flatten() {
            let off = (x - kinds.next().unwrap()).abs();
            assert!(off < TOLERANCE, "{}: a kind is off by {off}", drawing.id);
            worst = worst.max(off);
        }
    }
    assert!(scores.next().is_none() && kinds.next().is_none());
    println!("largest difference {worst:.1e}");
}
