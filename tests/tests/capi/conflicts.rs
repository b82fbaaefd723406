//! Wrong faces through the ABI: what the caller reads of them.

use serde_json::Value;

use super::abi::{Abi, OK};
use super::library;

/// Edges of a face, without their direction.
fn edges(face: &Value) -> Vec<i64> {
    let loops = face["loops"].as_array().unwrap().iter();
    loops
        .flat_map(|ring| ring.as_array().unwrap())
        .map(|k| k.as_i64().unwrap().abs())
        .collect()
}

#[test]
fn a_wrong_face_is_named_with_those_it_conflicts_with() {
    let path = library::root().join("tests/corpus/freecad/l_bracket_free.json");
    let json = std::fs::read(path).unwrap();
    let abi = Abi::load();
    let drawing = abi.read(&json).value.unwrap();
    let found = abi.identify(&drawing).value.unwrap();
    let right = abi.lift(&drawing, &found);
    assert_eq!((right.status, right.message.as_str()), (OK, ""));
    assert_eq!(right.value.unwrap()["conflicts"], serde_json::json!([]));

    // The first face and a neighbour of it are taken for one.
    let mut wrong = abi.faces_json(&found);
    let faces = wrong["faces"].as_array_mut().unwrap();
    let own = edges(&faces[0]);
    let beside = (1..faces.len())
        .find(|&f| edges(&faces[f]).iter().any(|e| own.contains(e)))
        .unwrap();
    let taken = faces.remove(beside)["loops"][0].clone();
    faces[0]["loops"].as_array_mut().unwrap().push(taken);
    let wrong = abi.read_faces(&drawing, &wrong.to_string()).value.unwrap();
    let lift = abi.lift(&drawing, &wrong).value.unwrap();

    let conflicts = lift["conflicts"].as_array().unwrap();
    let conflict = conflicts.iter().find(|c| c["face"] == 0).unwrap();
    let numbers = |key: &str| -> Vec<u64> {
        let list = conflict[key].as_array().unwrap().iter();
        list.map(|n| n.as_u64().unwrap()).collect()
    };
    let message = conflict["message"].as_str().unwrap();
    assert!(
        message.starts_with("face 1 conflicts with face"),
        "{message}"
    );
    // Faces are told from 1, vertices as they are numbered.
    let told: Vec<u64> = message
        .split(|c: char| !c.is_ascii_digit())
        .filter_map(|n| n.parse().ok())
        .collect();
    let others = numbers("others").into_iter().map(|f| f + 1);
    let expected: Vec<u64> = [1]
        .into_iter()
        .chain(others)
        .chain(numbers("vertices"))
        .collect();
    assert_eq!(told, expected, "{message}");
}
