//! Faces that no engine found: the truth of a drawing, and faces files.

use serde::Deserialize;

use super::{Evidence, Face, Identification, IdentifyError};
use crate::drawing::{Drawing, Graph};

/// Engine name of an [`Identification`] made from a drawing's truth.
pub const TRUTH: &str = "truth";

/// Engine name of an [`Identification`] read from a file that names none.
pub const FILE: &str = "file";

/// The faces of a drawing's truth, or `None` if the drawing has no truth.
pub fn from_truth(drawing: &Drawing) -> Option<Identification> {
    let truth = drawing.truth.as_ref()?;
    let faces = truth.faces.iter().map(|face| Face {
        kind: face.kind,
        loops: face.loops.clone(),
        confidence: 1.0,
        evidence: Evidence {
            votes: 1,
            ..Evidence::default()
        },
    });
    Some(Identification {
        engine: TRUTH.to_owned(),
        faces: faces.collect(),
        alternatives: Vec::new(),
        notices: Vec::new(),
        vertices: Vec::new(),
    })
}

/// What a faces file may look like: an [`Identification`], or its faces alone.
#[derive(Deserialize)]
struct FacesFile {
    #[serde(default)]
    engine: Option<String>,
    faces: Vec<Face>,
    #[serde(default)]
    alternatives: Vec<super::Candidate>,
    #[serde(default)]
    notices: Vec<String>,
    #[serde(default)]
    vertices: Vec<f64>,
}

/// Reads faces for a drawing from JSON: an [`Identification`] or a bare `{"faces": [...]}`.
///
/// Every face is checked against the drawing: it has a loop, its co-edges are edges of the
/// drawing, each loop is a closed walk, and no co-edge is used twice. Whether the faces together
/// are a solid's is left to the later stages.
///
/// # Errors
/// [`IdentifyError::Format`] if the text is no faces file, [`IdentifyError::Mismatch`] with the
/// face and the edge if it does not fit the drawing.
pub fn read_faces(drawing: &Drawing, text: &str) -> Result<Identification, IdentifyError> {
    let file: FacesFile =
        serde_json::from_str(text).map_err(|e| IdentifyError::Format(e.to_string()))?;
    let graph = Graph::new(drawing);
    check(&graph, &file.faces, "")?;
    for (i, alternative) in file.alternatives.iter().enumerate() {
        check(
            &graph,
            &alternative.faces,
            &format!("in alternative {}, ", i + 1),
        )?;
    }
    Ok(Identification {
        engine: file.engine.unwrap_or_else(|| FILE.to_owned()),
        faces: file.faces,
        alternatives: file.alternatives,
        notices: file.notices,
        vertices: file.vertices,
    })
}

/// Checks each face on its own; `place` begins the message of what is wrong.
fn check(graph: &Graph, faces: &[Face], place: &str) -> Result<(), IdentifyError> {
    let mut used_by = vec![0usize; 2 * graph.edge_count()];
    for (i, face) in faces.iter().enumerate() {
        let number = i + 1;
        check_face(graph, face, number, &mut used_by).map_err(|what| IdentifyError::Mismatch {
            face: number,
            what: format!("{place}{what}"),
        })?;
    }
    Ok(())
}

/// Checks face `number`; `used_by[c]` is the last face that used co-edge `c`.
fn check_face(
    graph: &Graph,
    face: &Face,
    number: usize,
    used_by: &mut [usize],
) -> Result<(), String> {
    if face.loops.is_empty() {
        return Err("it has no loop".to_owned());
    }
    if !(0.0..=1.0).contains(&face.confidence) {
        return Err(format!("confidence {} is not 0 to 1", face.confidence));
    }
    for (l, walk) in face.loops.iter().enumerate() {
        if walk.is_empty() {
            return Err(format!("loop {} has no edges", l + 1));
        }
        for c in walk {
            let Some(last) = used_by.get_mut(c.index()) else {
                return Err(format!(
                    "it names edge {}, but the drawing has only {}",
                    c.edge() + 1,
                    graph.edge_count()
                ));
            };
            if *last == number {
                return Err(format!("it walks edge {} twice the same way", c.edge() + 1));
            }
            *last = number;
        }
        for (i, &c) in walk.iter().enumerate() {
            let next = walk[(i + 1) % walk.len()];
            if graph.head(c) != graph.origin(next) {
                return Err(format!(
                    "loop {} is not closed: {} ends at vertex {}, and the next, {}, starts at \
                     vertex {}",
                    l + 1,
                    c.signed(),
                    graph.head(c),
                    next.signed(),
                    graph.origin(next)
                ));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::testing;
    use super::*;

    fn read(text: &str) -> Result<Identification, IdentifyError> {
        read_faces(&testing::cube(), text)
    }

    fn fault(text: &str) -> String {
        read(text).unwrap_err().to_string()
    }

    #[test]
    fn truth_is_read_back_from_its_json() {
        let cube = testing::cube();
        let truth = from_truth(&cube).unwrap();
        assert_eq!(truth.faces.len(), 6);
        let text = serde_json::to_string(&truth).unwrap();
        assert_eq!(read_faces(&cube, &text).unwrap(), truth);
        let unknown = Drawing {
            truth: None,
            ..cube
        };
        assert_eq!(from_truth(&unknown), None);
    }

    #[test]
    fn bare_faces_are_enough() {
        let walk = testing::cube().truth.unwrap().faces.remove(0).loops;
        let text = format!(
            r#"{{"faces":[{{"type":"plane","loops":{}}}]}}"#,
            serde_json::to_string(&walk).unwrap()
        );
        let found = read(&text).unwrap();
        assert_eq!(found.engine, FILE);
        assert_eq!(found.faces[0].loops, walk);
        assert_eq!(found.faces[0].confidence, 1.0);
    }

    #[test]
    fn faults_name_face_and_edge() {
        for (text, parts) in [
            (
                r#"{"faces":[{"type":"plane","loops":[[1,2,3,13]]}]}"#,
                ["face 1", "edge 13"],
            ),
            (
                r#"{"faces":[{"type":"plane","loops":[[1,3]]}]}"#,
                ["face 1", "1 ends at vertex"],
            ),
            (
                r#"{"faces":[{"type":"plane","loops":[[1,1]]}]}"#,
                ["face 1", "edge 1 twice"],
            ),
            (
                r#"{"faces":[{"type":"plane","loops":[]}]}"#,
                ["face 1", "no loop"],
            ),
            (
                r#"{"faces":[{"type":"plane","loops":[[]]}]}"#,
                ["face 1", "loop 1"],
            ),
            (
                r#"{"faces":[{"type":"plane","loops":[[0]]}]}"#,
                ["not a faces file", "0 is no"],
            ),
            (
                r#"{"faces":[{"type":"flat","loops":[[1]]}]}"#,
                ["not a faces file", "flat"],
            ),
            (r#"{"solid":1}"#, ["not a faces file", "faces"]),
            (
                r#"{"faces":[],"alternatives":[{"faces":[{"type":"plane","loops":[[99]]}]}]}"#,
                ["alternative 1", "edge 99"],
            ),
        ] {
            let fault = fault(text);
            for part in parts {
                assert!(fault.contains(part), "{text}: {fault}");
            }
        }
    }

    proptest! {
        #[test]
        fn what_is_accepted_is_made_of_closed_walks(
            loops in prop::collection::vec(prop::collection::vec(-14..14i64, 0..5), 0..3),
            turn in 0..4usize,
        ) {
            let cube = testing::cube();
            let mut loops = loops;
            if turn > 0 {
                let mut walk: Vec<i64> = cube.truth.as_ref().unwrap().faces[turn].loops[0]
                    .iter().map(|c| c.signed()).collect();
                walk.rotate_left(turn);
                loops.insert(0, walk);
            }
            let text = serde_json::json!({"faces": [{"type": "cone", "loops": loops}]});
            match read(&text.to_string()) {
                Ok(found) => {
                    let graph = Graph::new(&cube);
                    for walk in &found.faces[0].loops {
                        for (i, &c) in walk.iter().enumerate() {
                            let next = walk[(i + 1) % walk.len()];
                            prop_assert_eq!(graph.head(c), graph.origin(next));
                        }
                    }
                    prop_assert!(!loops.is_empty());
                }
                Err(IdentifyError::Mismatch { face, .. }) => prop_assert_eq!(face, 1),
                Err(IdentifyError::Format(_)) => {
                    prop_assert!(loops.iter().flatten().any(|&k| k == 0));
                }
                Err(other) => prop_assert!(false, "{}", other),
            }
        }
    }
}
