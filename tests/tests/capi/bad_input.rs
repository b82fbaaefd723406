//! Bad input through the ABI: an answer that names what is wrong, never a crash, never a wait.

use std::fmt::Write;
use std::time::{Duration, Instant};

use super::abi::{Abi, BAD_INPUT, FAILED, OK};

fn refused(json: &[u8]) -> String {
    let abi = Abi::load();
    let answer = abi.read(json);
    assert_eq!(answer.status, BAD_INPUT, "{}", answer.message);
    assert!(!answer.message.is_empty());
    answer.message
}

#[test]
fn garbage_is_refused() {
    for json in [
        "",
        "garbage",
        "{",
        "[[[[",
        "7",
        "null",
        "{\"edges\": \"many\"}",
        "\0\0\0",
    ] {
        refused(json.as_bytes());
    }
    refused(b"\xff\xfe{\"edges\": []}");
    refused(&[b'['; 100_000]);
}

#[test]
fn an_empty_drawing_is_refused() {
    for json in [r#"{"edges": []}"#, r#"{"vertices": [], "edges": []}"#] {
        let message = refused(json.as_bytes());
        assert!(message.contains("no edges"), "{message}");
    }
}

#[test]
fn numbers_that_are_none_are_refused() {
    for number in ["NaN", "Infinity", "-Infinity", "1e999", "null", "\"1\""] {
        let json = format!(r#"{{"edges": [{{"points": [[0, 0], [{number}, 1]]}}]}}"#);
        refused(json.as_bytes());
    }
}

#[test]
fn a_million_edges_are_refused_soon() {
    let mut json = String::from(r#"{"edges": ["#);
    for i in 0..1_000_000 {
        let comma = if i > 0 { "," } else { "" };
        write!(json, r#"{comma}{{"points":[[{i},0],[{i},1]]}}"#).unwrap();
    }
    json.push_str("]}");
    // The library may have to be built first.
    Abi::load();
    let start = Instant::now();
    let message = refused(json.as_bytes());
    let time = start.elapsed();
    assert!(
        message.contains("edges") && message.contains("limit"),
        "{message}"
    );
    assert!(time < Duration::from_secs(20), "it took {time:?}");
}

#[test]
fn an_open_wire_is_read_diagnosed_and_has_no_faces() {
    let abi = Abi::load();
    let json = r#"{"edges": [
        {"name": "Edge1", "points": [[0, 0], [2, 0]]},
        {"name": "Edge2", "points": [[2, 0], [2, 1]]},
        {"name": "Edge3", "points": [[2, 1], [0, 1]]}
    ]}"#;
    let answer = abi.read(json.as_bytes());
    assert_eq!(answer.status, OK, "{}", answer.message);
    let drawing = answer.value.unwrap();
    let report = abi.report(&drawing);
    let dangling: Vec<_> = report["findings"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|f| f["severity"] == "error" && f["kind"] == "dangling")
        .map(|f| f["edges"].clone())
        .collect();
    assert!(dangling.contains(&serde_json::json!([0])), "{report}");
    let faces = abi.identify(&drawing);
    assert_eq!(faces.status, FAILED);
    assert!(
        faces.value.is_none() && faces.message.contains("edge"),
        "{}",
        faces.message
    );
}
