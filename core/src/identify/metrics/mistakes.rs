//! Which faces of a drawing are wrong, and how (paper, section 4.3, qualitative results).

use std::collections::BTreeMap;

use super::score::edges;
use crate::drawing::Truth;
use crate::identify::Face;

/// What is wrong in a set of faces; all three empty where it is the truth.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Mistakes {
    /// Predicted faces whose set of edges is no true face's, or one that was predicted before.
    pub wrong: Vec<usize>,
    /// Predicted faces with the edges of a true face and not its class of the paper's three.
    pub mistyped: Vec<usize>,
    /// True faces that no predicted face has the edges of.
    pub missed: Vec<usize>,
}

impl Mistakes {
    /// The mistakes of `faces` against a drawing's truth; all indices count from 0.
    ///
    /// Matching is one to one, in the order of the faces; where several true faces have the same
    /// edges, one of the predicted face's class is taken first.
    pub fn of(truth: &Truth, faces: &[Face]) -> Self {
        let mut open: BTreeMap<Vec<usize>, Vec<usize>> = BTreeMap::new();
        for (f, face) in truth.faces.iter().enumerate() {
            open.entry(edges(face.loops.iter().flatten()))
                .or_default()
                .push(f);
        }
        let mut mistakes = Self::default();
        for (f, face) in faces.iter().enumerate() {
            let class = face.kind.paper_class();
            let of_class = |t: &usize| truth.faces[*t].kind.paper_class() == class;
            match open.get_mut(&face.edge_set()) {
                Some(same) if !same.is_empty() => match same.iter().position(of_class) {
                    Some(k) => drop(same.remove(k)),
                    None => {
                        same.remove(0);
                        mistakes.mistyped.push(f);
                    }
                },
                _ => mistakes.wrong.push(f),
            }
        }
        mistakes.missed = open.into_values().flatten().collect();
        mistakes.missed.sort_unstable();
        mistakes
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.wrong.is_empty() && self.mistyped.is_empty() && self.missed.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::SurfaceKind;
    use crate::identify::{from_truth, testing};

    #[test]
    fn each_mistake_is_in_its_list() {
        let cube = testing::cube();
        let mut faces = from_truth(&cube).unwrap().faces;
        let truth = cube.truth.unwrap();
        assert!(Mistakes::of(&truth, &faces).is_empty());
        faces[1].kind = SurfaceKind::Torus;
        faces[2].loops[0].pop();
        faces.push(faces[0].clone());
        let mistakes = Mistakes::of(&truth, &faces);
        assert_eq!(mistakes.wrong, [2, 6]);
        assert_eq!(mistakes.mistyped, [1]);
        assert_eq!(mistakes.missed, [2]);
    }

    #[test]
    fn of_faces_with_the_same_edges_the_one_of_the_class_is_taken() {
        let cube = testing::cube();
        let mut truth = cube.truth.clone().unwrap();
        let mut faces = from_truth(&cube).unwrap().faces;
        let mut twin = truth.faces[0].clone();
        twin.kind = SurfaceKind::Cylinder;
        truth.faces.insert(0, twin);
        faces.push(faces[0].clone());
        faces.last_mut().unwrap().kind = SurfaceKind::Cylinder;
        assert!(Mistakes::of(&truth, &faces).is_empty());
    }
}
