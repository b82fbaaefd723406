//! Incidence of a drawing: which co-edges leave which vertex.

use super::{CoEdge, Drawing};

/// Incidence tables of a drawing, in compressed rows.
#[derive(Debug, Clone)]
pub struct Graph {
    origins: Vec<u32>,
    first: Vec<u32>,
    leaving: Vec<CoEdge>,
    position: Vec<u32>,
    component: Vec<u32>,
    components: usize,
}

impl Graph {
    /// Builds the tables in time linear in the drawing's size.
    pub fn new(drawing: &Drawing) -> Self {
        let n = drawing.vertices.len();
        let origins: Vec<u32> = drawing
            .edges
            .iter()
            .flat_map(|e| [e.v[0] as u32, e.v[1] as u32])
            .collect();
        let mut first = vec![0u32; n + 1];
        for &v in &origins {
            first[v as usize + 1] += 1;
        }
        for v in 0..n {
            first[v + 1] += first[v];
        }
        let mut fill = first.clone();
        let mut leaving = vec![CoEdge::from_index(0); origins.len()];
        let mut position = vec![0u32; origins.len()];
        for (i, &v) in origins.iter().enumerate() {
            let v = v as usize;
            leaving[fill[v] as usize] = CoEdge::from_index(i);
            position[i] = fill[v] - first[v];
            fill[v] += 1;
        }
        let (component, components) = label_components(n, &origins, &first, &leaving);
        Self {
            origins,
            first,
            leaving,
            position,
            component,
            components,
        }
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.first.len() - 1
    }

    /// Number of edges.
    pub fn edge_count(&self) -> usize {
        self.origins.len() / 2
    }

    /// All co-edges, by index.
    pub fn coedges(&self) -> impl Iterator<Item = CoEdge> + use<> {
        (0..self.origins.len()).map(CoEdge::from_index)
    }

    /// Vertex where a co-edge starts.
    pub fn origin(&self, c: CoEdge) -> usize {
        self.origins[c.index()] as usize
    }

    /// Vertex where a co-edge ends.
    pub fn head(&self, c: CoEdge) -> usize {
        self.origins[c.mate().index()] as usize
    }

    /// Co-edges that start at a vertex, by index; a closed edge is there twice.
    pub fn leaving(&self, vertex: usize) -> &[CoEdge] {
        &self.leaving[self.first[vertex] as usize..self.first[vertex + 1] as usize]
    }

    /// Number of edge ends at a vertex.
    pub fn degree(&self, vertex: usize) -> usize {
        self.leaving(vertex).len()
    }

    /// Place of a co-edge in [`leaving`](Self::leaving) of its origin.
    pub fn position(&self, c: CoEdge) -> usize {
        self.position[c.index()] as usize
    }

    /// Connected component of a vertex, from 0.
    pub fn component(&self, vertex: usize) -> usize {
        self.component[vertex] as usize
    }

    /// Number of connected components.
    pub fn component_count(&self) -> usize {
        self.components
    }
}

fn label_components(
    n: usize,
    origins: &[u32],
    first: &[u32],
    leaving: &[CoEdge],
) -> (Vec<u32>, usize) {
    let mut component = vec![u32::MAX; n];
    let mut count = 0;
    let mut stack = Vec::new();
    for start in 0..n {
        if component[start] != u32::MAX {
            continue;
        }
        component[start] = count;
        stack.push(start);
        while let Some(v) = stack.pop() {
            for c in &leaving[first[v] as usize..first[v + 1] as usize] {
                let w = origins[c.mate().index()] as usize;
                if component[w] == u32::MAX {
                    component[w] = count;
                    stack.push(w);
                }
            }
        }
        count += 1;
    }
    (component, count as usize)
}
