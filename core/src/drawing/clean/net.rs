//! The net of pieces and vertices that clean-up works on.

use glam::DVec2;

use super::super::{Finding, FindingKind, Severity};
use super::piece::Piece;

/// Pieces, the vertices they meet at, and what was done so far.
#[derive(Debug)]
pub(super) struct Net<'a> {
    /// What the input edges are called.
    pub(super) labels: &'a [String],
    pub(super) vertices: Vec<DVec2>,
    pub(super) pieces: Vec<Piece>,
    pub(super) findings: Vec<Finding>,
}

impl Net<'_> {
    /// Number of piece ends at each vertex.
    pub(super) fn degrees(&self) -> Vec<usize> {
        let mut degrees = vec![0; self.vertices.len()];
        for v in self.pieces.iter().flat_map(|p| p.v) {
            degrees[v] += 1;
        }
        degrees
    }

    /// Vertices where something may be missing: fewer than three ends meet there, and it is not
    /// where a closed curve begins.
    pub(super) fn wanting(&self) -> Vec<bool> {
        let mut wanting: Vec<bool> = self.degrees().iter().map(|d| (1..3).contains(d)).collect();
        for p in self.pieces.iter().filter(|p| p.is_closed()) {
            wanting[p.v[0]] = false;
        }
        wanting
    }

    /// Pieces at each vertex; a closed piece is there twice.
    pub(super) fn incidence(&self) -> Vec<Vec<usize>> {
        let mut at = vec![Vec::new(); self.vertices.len()];
        for (i, p) in self.pieces.iter().enumerate() {
            for v in p.v {
                at[v].push(i);
            }
        }
        at
    }

    /// Moves the ends of all pieces to where their vertices are now.
    pub(super) fn follow_vertices(&mut self) {
        for p in &mut self.pieces {
            p.move_ends(p.v.map(|v| self.vertices[v]));
        }
    }

    /// Renumbers the vertices so that only those with pieces are left.
    pub(super) fn drop_unused_vertices(&mut self) {
        let mut number = vec![usize::MAX; self.vertices.len()];
        let mut kept = Vec::new();
        for v in self.pieces.iter_mut().flat_map(|p| &mut p.v) {
            if number[*v] == usize::MAX {
                number[*v] = kept.len();
                kept.push(self.vertices[*v]);
            }
            *v = number[*v];
        }
        self.vertices = kept;
    }

    /// Records what was done about some input edges.
    pub(super) fn note(
        &mut self,
        kind: FindingKind,
        message: String,
        mut edges: Vec<usize>,
        points: Vec<DVec2>,
    ) {
        edges.sort_unstable();
        edges.dedup();
        self.findings.push(Finding {
            severity: Severity::Notice,
            kind,
            message,
            edges,
            vertices: Vec::new(),
            points,
        });
    }

    /// The names of input edges, for a message.
    pub(super) fn names(&self, edges: &[usize]) -> String {
        names(self.labels, edges)
    }
}

/// Most edges that a message names.
const SHOWN: usize = 4;

/// The names of edges, for a message.
pub(in super::super) fn names(labels: &[String], edges: &[usize]) -> String {
    let mut text = String::new();
    for (i, &e) in edges.iter().take(SHOWN).enumerate() {
        let last = i + 1 == edges.len();
        text += match i {
            0 => "",
            _ if last => " and ",
            _ => ", ",
        };
        text += &labels[e];
    }
    if edges.len() > SHOWN {
        text += &format!(" and {} more", edges.len() - SHOWN);
    }
    text
}

/// The name of one edge that was made from several.
pub(super) fn joint_name(labels: &[String], edges: &[usize]) -> String {
    let mut shown: Vec<&str> = edges
        .iter()
        .take(SHOWN)
        .map(|&e| labels[e].as_str())
        .collect();
    if edges.len() > SHOWN {
        shown.push("...");
    }
    shown.join(" + ")
}

/// Union of two sorted lists.
pub(super) fn union(a: &[usize], b: &[usize]) -> Vec<usize> {
    let mut all = [a, b].concat();
    all.sort_unstable();
    all.dedup();
    all
}
