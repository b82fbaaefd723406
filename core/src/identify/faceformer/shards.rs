//! Tables for training: what the network sees with the true faces, many drawings in one safetensors
//! file.
//!
//! `faceformer features --for faceformer` writes them and `training/` reads them; one file serves
//! all three variants. Tables of all drawings follow each other; `*_start` say where each one's
//! begin, with the end of the last one added. With N drawings, E edges, F faces and L loops in all:
//!
//! | tensor | shape | what |
//! |---|---|---|
//! | `points` | f16 `[E, POINTS, 2]` | points along each edge, in the frame `fitted` |
//! | `coedges` | i32 `[2 E]` | co-edges lowest first, as indices `2 edge + reversed` in each drawing |
//! | `edges` | i32 `[E]` | edges lowest first, each as its lower co-edge |
//! | `loop_coedges`, `loop_start` | i32, `[L + 1]` | co-edges along each loop |
//! | `face_start` | i32 `[F + 1]` | loops of each face |
//! | `face_kinds` | u8 `[F]` | the paper's classes: plane, cylinder, other |
//! | `edge_start`, `faces_start` | i32 `[N + 1]` | edges and faces of each drawing |
//!
//! The metadata hold `ids`, `format` and `tables`, which is "faceformer".

use std::collections::HashMap;
use std::path::Path;

use half::f16;
use safetensors::tensor::{Dtype, TensorView, serialize_to_file};

use super::inputs::{coedge_order, edge_order, edge_points};
use super::{FORMAT, Frame};
use crate::drawing::{CoEdge, Drawing, Truth};

/// Points of an edge in the tables, as many as the authors have.
pub const POINTS: usize = 50;

/// Tables of many drawings, in memory.
#[derive(Debug)]
pub struct Shard {
    ids: Vec<String>,
    points: Vec<[f16; 2]>,
    coedges: Vec<i32>,
    edges: Vec<i32>,
    loop_coedges: Vec<i32>,
    loop_start: Vec<i32>,
    face_start: Vec<i32>,
    face_kinds: Vec<u8>,
    edge_start: Vec<i32>,
    faces_start: Vec<i32>,
}

impl Default for Shard {
    fn default() -> Self {
        let start = || vec![0];
        Self {
            ids: Vec::new(),
            points: Vec::new(),
            coedges: Vec::new(),
            edges: Vec::new(),
            loop_coedges: Vec::new(),
            loop_start: start(),
            face_start: start(),
            face_kinds: Vec::new(),
            edge_start: start(),
            faces_start: start(),
        }
    }
}

impl Shard {
    /// Number of drawings.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// Adds a drawing; says whether it could: not without a truth whose loops use every co-edge
    /// once.
    pub fn add(&mut self, drawing: &Drawing) -> bool {
        let Some(truth) = drawing.truth.as_ref().filter(|t| is_complete(drawing, t)) else {
            return false;
        };
        let index = |c: &CoEdge| c.index() as i32;
        self.ids.push(drawing.id.clone());
        self.points
            .extend(edge_points(drawing, Frame::Fitted, POINTS));
        self.coedges.extend(coedge_order(drawing).iter().map(index));
        self.edges.extend(edge_order(drawing).iter().map(index));
        for face in &truth.faces {
            for walk in &face.loops {
                self.loop_coedges.extend(walk.iter().map(index));
                self.loop_start.push(self.loop_coedges.len() as i32);
            }
            self.face_start.push(self.loop_start.len() as i32 - 1);
            self.face_kinds.push(face.kind.paper_class() as u8);
        }
        self.edge_start.push(self.edges.len() as i32);
        self.faces_start.push(self.face_kinds.len() as i32);
        true
    }

    /// Writes the tables.
    ///
    /// # Errors
    /// What the file system says.
    pub fn write(&self, path: &Path) -> std::io::Result<()> {
        let ints = |x: &[i32]| x.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
        let points: Vec<u8> = self
            .points
            .iter()
            .flatten()
            .flat_map(|v| v.to_le_bytes())
            .collect();
        let lists = [
            ("coedges", &self.coedges),
            ("edges", &self.edges),
            ("loop_coedges", &self.loop_coedges),
            ("loop_start", &self.loop_start),
            ("face_start", &self.face_start),
            ("edge_start", &self.edge_start),
            ("faces_start", &self.faces_start),
        ]
        .map(|(name, list)| (name, list.len(), ints(list)));
        let shape = vec![self.points.len() / POINTS, POINTS, 2];
        let mut views = vec![
            ("points", TensorView::new(Dtype::F16, shape, &points)),
            (
                "face_kinds",
                TensorView::new(Dtype::U8, vec![self.face_kinds.len()], &self.face_kinds),
            ),
        ];
        for (name, len, bytes) in &lists {
            views.push((name, TensorView::new(Dtype::I32, vec![*len], bytes)));
        }
        let views: Vec<(&str, TensorView<'_>)> = views
            .into_iter()
            .map(|(name, view)| view.map(|v| (name, v)).map_err(std::io::Error::other))
            .collect::<Result<_, _>>()?;
        let ids = serde_json::to_string(&self.ids).map_err(std::io::Error::other)?;
        let metadata = HashMap::from([
            ("format".to_owned(), FORMAT.to_string()),
            ("tables".to_owned(), "faceformer".to_owned()),
            ("ids".to_owned(), ids),
        ]);
        serialize_to_file(views, Some(metadata), path).map_err(std::io::Error::other)
    }
}

fn is_complete(drawing: &Drawing, truth: &Truth) -> bool {
    let mut uses = vec![0usize; 2 * drawing.edges.len()];
    for c in truth.faces.iter().flat_map(|f| &f.loops).flatten() {
        match uses.get_mut(c.index()) {
            Some(n) => *n += 1,
            None => return false,
        }
    }
    uses.iter().all(|&n| n == 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::testing;

    #[test]
    fn only_whole_truths_are_added() {
        let mut shard = Shard::default();
        assert!(shard.add(&testing::holed_cube()));
        let mut part = testing::cube();
        part.truth.as_mut().unwrap().faces.pop();
        assert!(!shard.add(&part));
        part.truth = None;
        assert!(!shard.add(&part));
        assert!(shard.add(&testing::cube()));
        assert_eq!((shard.len(), shard.is_empty()), (2, false));
        assert_eq!(shard.edge_start, [0, 24, 36]);
        assert_eq!(shard.faces_start, [0, 10, 16]);
        assert_eq!(shard.face_start[..3], [0, 2, 4]);
        assert_eq!(shard.points.len(), 36 * POINTS);
    }
}
