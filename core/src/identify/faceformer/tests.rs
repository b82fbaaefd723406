use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::inputs::Inputs;
use super::walk::Walks;
use super::*;
use crate::drawing::{CoEdge, Drawing, Graph, SurfaceKind};
use crate::identify::postprocess::{Prediction, postprocess};
use crate::identify::{
    Engine, EngineKind, Face, IdentifyError, ModelError, engine_with_model, from_truth, testing,
};
use crate::{Error, Progress};

fn fixture(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/faceformer");
    folder.join(name)
}

fn network() -> Network {
    Network::read(&fixture("faceformer.safetensors")).unwrap()
}

fn inputs(network: &Network, drawing: &Drawing) -> Inputs {
    let config = network.config();
    Inputs::new(drawing, config.variant, config.frame, config.points)
}

fn refusal(engine: &dyn Engine, drawing: &Drawing) -> IdentifyError {
    match engine.identify(drawing, Progress::none()) {
        Err(Error::Identify(error)) => error,
        other => panic!("{other:?}"),
    }
}

fn starts(inputs: &Inputs) -> Vec<u32> {
    (0..inputs.coedges.len())
        .map(|i| (i + TOKENS) as u32)
        .collect()
}

fn nobody(_: f64) -> Result<(), Error> {
    Ok(())
}

#[test]
fn without_a_model_every_drawing_is_refused() {
    let cube = testing::cube();
    let none = engine_with_model(EngineKind::Seq2seq, Some("none"));
    let error = refusal(none.as_ref(), &cube);
    assert_eq!(error, IdentifyError::NoModel { engine: "seq2seq" });
    let absent = engine_with_model(EngineKind::Faceformer, Some("/nowhere.safetensors"));
    let error = refusal(absent.as_ref(), &cube).to_string();
    assert!(error.contains("/nowhere.safetensors"), "{error}");
    let path = fixture("faceformer.safetensors");
    let other = engine_with_model(EngineKind::Seq2seqCoedge, path.to_str());
    let error = refusal(other.as_ref(), &cube).to_string();
    assert!(error.contains("for the engine faceformer"), "{error}");
}

#[test]
fn the_model_that_comes_with_the_program_finds_a_cube_and_says_what_it_is() {
    let cube = testing::cube();
    let own = engine_with_model(EngineKind::Faceformer, None);
    let found = own.identify(&cube, Progress::none()).unwrap();
    let truth = from_truth(&cube).unwrap();
    let sets =
        |faces: &[Face]| -> BTreeSet<Vec<usize>> { faces.iter().map(Face::edge_set).collect() };
    assert!(sets(&found.faces).is_superset(&sets(&truth.faces)));
    assert!(found.notices[0].contains("trained"), "{:?}", found.notices);
}

#[test]
fn a_larger_drawing_than_the_model_knows_is_refused() {
    let sides = 200;
    let outline: Vec<[f64; 2]> = (0..sides)
        .map(|i| (f64::from(i) * std::f64::consts::TAU / f64::from(sides)).sin_cos())
        .map(|(y, x)| [x, y])
        .collect();
    let large = testing::prism(&outline, 1.0);
    let engine = FaceformerEngine::new(network(), DecodeOptions::default());
    let expected = IdentifyError::TooManyEdges {
        engine: "faceformer",
        edges: 600,
        limit: network().config().inputs / 2,
    };
    assert_eq!(refusal(&engine, &large), expected);
}

#[test]
fn damaged_models_are_refused() {
    let weights = std::fs::read(fixture("faceformer.safetensors")).unwrap();
    let text = std::fs::read_to_string(fixture("faceformer.json")).unwrap();
    assert!(Network::load(weights.clone(), &text).is_ok());
    let other = text.replace("\"heads\": 2", "\"heads\": 3");
    assert_eq!(
        Network::load(weights.clone(), &other).unwrap_err(),
        ModelError::Version
    );
    let other = text.replace("\"hidden\": 24", "\"hidden\": 25");
    assert!(matches!(
        Network::load(weights, &other).unwrap_err(),
        ModelError::Shape { .. }
    ));
}

#[test]
fn it_can_be_cancelled() {
    let engine = FaceformerEngine::new(network(), DecodeOptions::default());
    let stop = |_, share| share < 0.05;
    let found = engine.identify(&testing::cube(), Progress::new(&stop));
    assert_eq!(found, Err(Error::Cancelled));
}

#[test]
fn a_beam_as_wide_as_the_drawing_finds_the_likeliest_sequence() {
    let network = network();
    let inputs = inputs(&network, &testing::tetrahedron());
    let memory = network.encode(&inputs.points).unwrap();
    let variant = Variant::Faceformer;
    let starts = starts(&inputs);
    let found = search(
        &mut network.decode(&memory, true),
        variant,
        &starts,
        2,
        64,
        |_, _| (),
        nobody,
    );
    let found = found.unwrap().unwrap();
    // Every sequence of at most one further co-edge, and its end.
    let log_softmax = |logits: &[f32]| -> Vec<f64> {
        let sum: f64 = logits[1..].iter().map(|&x| f64::from(x).exp()).sum();
        logits.iter().map(|&x| f64::from(x) - sum.ln()).collect()
    };
    for (&start, found) in starts.iter().zip(&found) {
        let mut decoding = network.decode(&memory, true);
        let mut rows = vec![Hypothesis::new(start)];
        let first = log_softmax(&decoding.step(&mut rows).unwrap()[0]);
        let mut next: Vec<Hypothesis> = starts
            .iter()
            .map(|&token| {
                let mut row = rows[0].clone();
                row.tokens.push(token);
                row
            })
            .collect();
        let second = decoding.step(&mut next).unwrap();
        let mut best = (1..TOKENS).map(|t| first[t]).fold(f64::MIN, f64::max);
        for (row, logits) in next.iter().zip(&second) {
            let so_far = first[row.tokens[1] as usize];
            for end in &log_softmax(logits)[1..TOKENS] {
                best = best.max(so_far + end);
            }
        }
        let sum: f64 = found.log_probabilities.iter().copied().map(f64::from).sum();
        assert!(found.ended);
        assert!((sum - best).abs() < 1e-4, "{sum} {best}");
    }
}

#[test]
fn walks_are_all_that_is_decoded_if_asked() {
    let network = network();
    for drawing in [testing::cube(), testing::bracket(), testing::holed_cube()] {
        let graph = Graph::new(&drawing);
        let inputs = inputs(&network, &drawing);
        let memory = network.encode(&inputs.points).unwrap();
        let walks = Walks::new(
            &graph,
            &inputs.coedges,
            Variant::Faceformer,
            FurtherLoops::Sorted,
        );
        let found = search(
            &mut network.decode(&memory, true),
            Variant::Faceformer,
            &starts(&inputs),
            network.config().steps,
            3,
            |tokens, logits| walks.forbid(tokens, logits),
            nobody,
        );
        let predictions: Vec<Prediction> = found
            .unwrap()
            .unwrap()
            .iter()
            .filter(|f| f.ended)
            .map(|f| Prediction {
                kind: SurfaceKind::Plane,
                coedges: f.tokens[..f.tokens.len() - 1]
                    .iter()
                    .map(|&t| inputs.coedges[t as usize - TOKENS])
                    .collect::<Vec<CoEdge>>(),
                votes: 1,
            })
            .collect();
        let done = postprocess(&graph, &predictions);
        assert_eq!((done.unclosed, done.doubled), (0, 0));
        assert!(!done.faces.is_empty());
    }
}
