use safetensors::tensor::{TensorView, serialize};

use super::*;
use crate::identify::rotation::{RotationEngine, samples};
use crate::identify::{Engine, Identification};

fn fixture(name: &str) -> Vec<u8> {
    std::fs::read(fixture_path(name)).unwrap()
}

fn fixture_path(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/rotation");
    folder.join(name)
}

fn description() -> String {
    String::from_utf8(fixture("model.json")).unwrap()
}

/// The fixture's weights with one tensor left out or changed, and a description that fits.
fn altered(
    name: &str,
    change: impl Fn(&TensorView<'_>) -> Option<(Vec<usize>, Vec<u8>)>,
) -> ModelError {
    use safetensors::SafeTensors;
    use sha2::{Digest, Sha256};
    let bytes = fixture("model.safetensors");
    let tensors = SafeTensors::deserialize(&bytes).unwrap();
    let mut list = Vec::new();
    for (key, view) in tensors.iter() {
        let same = Some((view.shape().to_vec(), view.data().to_vec()));
        let new = if key == name { change(&view) } else { same };
        if let Some((shape, data)) = new {
            list.push((key.to_owned(), view.dtype(), shape, data));
        }
    }
    let views = list.iter().map(|(key, dtype, shape, data)| {
        (
            key.clone(),
            TensorView::new(*dtype, shape.clone(), data).unwrap(),
        )
    });
    let weights = serialize(views, None).unwrap();
    let hash: String = Sha256::digest(&weights)
        .iter()
        .map(|b| format!("{b:02x}"))
        .collect();
    let mut text: serde_json::Value = serde_json::from_str(&description()).unwrap();
    text["sha256"] = hash.into();
    load(weights, &text.to_string()).unwrap_err()
}

#[test]
fn damaged_files_are_refused_by_what_is_wrong() {
    let weights = fixture("model.safetensors");
    assert!(load(weights.clone(), &description()).is_ok());
    let mut flipped = weights.clone();
    *flipped.last_mut().unwrap() ^= 1;
    assert!(matches!(
        load(flipped, &description()),
        Err(ModelError::Hash { .. })
    ));
    assert!(matches!(
        load(weights.clone(), "{}"),
        Err(ModelError::Description(_))
    ));
    let other = description().replace("\"edge\": ", "\"edge\": 1");
    assert_eq!(load(weights, &other).unwrap_err(), ModelError::Version);
    let long = vec![0; LIMIT as usize + 1];
    assert!(matches!(
        load(long, &description()),
        Err(ModelError::TooLarge { .. })
    ));
    assert!(matches!(
        read(Path::new("/nowhere.safetensors")),
        Err(ModelError::Read { .. })
    ));
}

#[test]
fn altered_weights_are_refused_by_name() {
    let missing = altered("hand", |_| None);
    assert_eq!(missing, ModelError::Missing("hand".to_owned()));
    let shape = altered("norm.weight", |view| {
        Some((vec![1, 16], view.data().to_vec()))
    });
    assert!(matches!(shape, ModelError::Shape { name, .. } if name == "norm.weight"));
    let values = altered("hand", |_| Some((vec![1], f32::NAN.to_le_bytes().to_vec())));
    assert_eq!(values, ModelError::Values("hand".to_owned()));
}

fn identify(model: Option<&str>) -> Identification {
    let engine = RotationEngine::with_model(model);
    engine.identify(&samples::cube(), Progress::none()).unwrap()
}

#[test]
fn a_model_is_used_or_its_failure_is_told() {
    let path = fixture_path("model.safetensors");
    let used = identify(path.to_str());
    assert_eq!(used.notices, Vec::<String>::new());
    let none = identify(Some(NONE));
    assert_eq!((none.faces.len(), none.notices.len()), (6, 0));
    let failed = identify(Some("/nowhere.safetensors"));
    assert_eq!(failed.faces, none.faces);
    assert_eq!(failed.notices.len(), 1);
    assert!(
        failed.notices[0].contains("/nowhere.safetensors"),
        "{:?}",
        failed.notices
    );
}

#[test]
fn numbering_and_walking_direction_do_not_change_scores() {
    use crate::identify::rotation::shards::Augment;
    let scorer = ModelScorer::open(&fixture_path("model.safetensors")).unwrap();
    let sorted = |drawing: &Drawing| {
        let graph = Graph::new(drawing);
        let triples = Triples::new(&graph);
        let directions = Directions::estimate(drawing).ok();
        let scores = scorer.score(
            drawing,
            &graph,
            &triples,
            directions.as_ref(),
            Progress::none(),
        );
        let mut log_odds = scores.unwrap().log_odds;
        log_odds.sort_by(f64::total_cmp);
        log_odds
    };
    let augment = Augment {
        renumber: true,
        reverse: true,
        ..Augment::default()
    };
    for drawing in [samples::cube(), samples::pyramid()] {
        let before = sorted(&drawing);
        let after = sorted(&augment.apply(&drawing, 1));
        for (a, b) in before.iter().zip(&after) {
            assert!((a - b).abs() < 0.02, "{a} {b}");
        }
    }
}
