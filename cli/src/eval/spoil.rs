//! Faces and coordinates spoilt on purpose, to see what lifting survives.

use faceformer::drawing::{CleanOptions, Curve2, Drawing, Limits, SurfaceKind, clean};
use faceformer::identify::Face;
use glam::DVec2;

use super::random::Random;

/// Tries to find a pair of faces, for each face to spoil.
const TRIES: usize = 200;

/// Makes `count` faces wrong: two faces of different surfaces are taken for one, or an inner loop
/// is given to another face. Returns the wrong faces' indices; fewer than asked for if the drawing
/// has too few faces.
pub(crate) fn corrupt(faces: &mut Vec<Face>, count: usize, random: &mut Random) -> Vec<usize> {
    let mut wrong: Vec<usize> = Vec::new();
    let mut lent: Vec<usize> = Vec::new();
    for _ in 0..TRIES {
        if wrong.len() == count || faces.len() < 4 {
            break;
        }
        let (a, b) = (random.below(faces.len()), random.below(faces.len()));
        let touched = |f: &usize| wrong.contains(f) || lent.contains(f);
        // Two cylinder faces may be the halves of one, and faces that share no edge are seldom
        // taken for one.
        let round =
            faces[a].kind == SurfaceKind::Cylinder && faces[b].kind == SurfaceKind::Cylinder;
        if a == b || round || touched(&a) || touched(&b) {
            continue;
        }
        if faces[b].loops.len() > 1 && random.below(2) == 0 {
            // Coplanar faces could share the loop; neighbours are not coplanar.
            if !neighbours(&faces[a], &faces[b]) {
                continue;
            }
            let inner = 1 + random.below(faces[b].loops.len() - 1);
            let moved = faces[b].loops.remove(inner);
            faces[a].loops.push(moved);
            wrong.push(a);
            lent.push(b);
        } else if neighbours(&faces[a], &faces[b]) {
            let loops = std::mem::take(&mut faces[b].loops);
            faces[a].loops.extend(loops);
            wrong.push(a);
            lent.push(b);
        }
    }
    // Faces that were taken into another one are gone; the wrong ones keep their order.
    let mut kept = Vec::with_capacity(faces.len());
    let mut renumbered = Vec::new();
    for (f, face) in std::mem::take(faces).into_iter().enumerate() {
        if face.loops.is_empty() {
            continue;
        }
        if wrong.contains(&f) {
            renumbered.push(kept.len());
        }
        kept.push(face);
    }
    *faces = kept;
    renumbered
}

fn neighbours(a: &Face, b: &Face) -> bool {
    let own = a.edge_set();
    b.edge_set().iter().any(|e| own.contains(e))
}

/// Moves every vertex by normal noise whose deviation is a share of the drawing's size, and curves
/// with their ends; points of curves get noise of their own. What curves are is recognised anew.
pub(crate) fn shake(drawing: &mut Drawing, share: f64, random: &mut Random) {
    let deviation = share * drawing.size();
    let mut step = || DVec2::new(random.normal(), random.normal()) * deviation;
    let steps: Vec<DVec2> = drawing.vertices.iter().map(|_| step()).collect();
    for (p, s) in drawing.vertices.iter_mut().zip(&steps) {
        *p += *s;
    }
    for edge in &mut drawing.edges {
        let last = edge.points.len() - 1;
        let [from, to] = edge.v.map(|v| steps[v]);
        for (i, p) in edge.points.iter_mut().enumerate() {
            *p += from.lerp(to, i as f64 / last as f64);
        }
        let [first, end] = edge.v.map(|v| drawing.vertices[v]);
        (edge.points[0], edge.points[last]) = (first, end);
        edge.curve = if last == 1 {
            Curve2::Line
        } else {
            Curve2::recognise(&edge.points)
        };
    }
}

/// Moves every end of every edge on its own, curves with their ends, so that ends that were one point
/// miss each other by up to a share of the drawing's size, and cleans up what is left: edges without
/// vertices. The edges keep their numbers, and the drawing loses its truth.
///
/// # Errors
/// What clean-up made otherwise, if it did not give one edge for each.
pub(crate) fn part(drawing: &Drawing, share: f64, random: &mut Random) -> Result<Drawing, String> {
    let reach = share * drawing.size() / 2.0;
    // Evenly over a disc.
    let mut step = || {
        let (radius, turn) = (random.unit().sqrt(), random.unit());
        DVec2::from_angle(turn * std::f64::consts::TAU) * radius * reach
    };
    let polylines: Vec<Vec<DVec2>> = drawing
        .edges
        .iter()
        .map(|edge| {
            let (from, to) = (step(), step());
            let last = (edge.points.len() - 1) as f64;
            let points = edge.points.iter().enumerate();
            points
                .map(|(i, p)| *p + from.lerp(to, i as f64 / last))
                .collect()
        })
        .collect();
    let cleaned = clean(&polylines, &CleanOptions::default(), &Limits::default())
        .map_err(|e| e.to_string())?;
    let mut edges = vec![None; drawing.edges.len()];
    for (edge, sources) in cleaned.drawing.edges.into_iter().zip(&cleaned.sources) {
        match sources.as_slice() {
            [only] if edges[*only].is_none() => edges[*only] = Some(edge),
            several => return Err(format!("edges {several:?} were joined or cut")),
        }
    }
    let edges: Option<Vec<_>> = edges.into_iter().collect();
    Ok(Drawing {
        id: drawing.id.clone(),
        source: drawing.source.clone(),
        projection: drawing.projection,
        vertices: cleaned.drawing.vertices,
        edges: edges.ok_or("an edge was lost")?,
        truth: None,
    })
}

#[cfg(test)]
mod tests {
    use faceformer::drawing::{CoEdge, Edge};
    use faceformer::identify::Evidence;

    use super::*;

    fn face(edges: &[&[usize]]) -> Face {
        let walk = |l: &&[usize]| l.iter().map(|&e| CoEdge::new(e, false)).collect();
        Face {
            kind: SurfaceKind::Plane,
            loops: edges.iter().map(walk).collect(),
            confidence: 1.0,
            evidence: Evidence::default(),
        }
    }

    /// A prism over a triangle, drawn.
    fn prism() -> Drawing {
        let base = [(0.0, 0.0), (1.0, 0.1), (0.4, 0.7)].map(|(x, y)| DVec2::new(x, y));
        let top = base.map(|p| p + DVec2::new(0.3, 1.5));
        let vertices: Vec<DVec2> = base.into_iter().chain(top).collect();
        let ends = [0, 1, 2].map(|i| [i, (i + 1) % 3]);
        let upper = ends.map(|v| v.map(|i| i + 3));
        let risers = [0, 1, 2].map(|i| [i, i + 3]);
        let edge = |v: [usize; 2]| Edge {
            v,
            points: v.map(|i| vertices[i]).to_vec(),
            curve: Curve2::Line,
        };
        Drawing {
            id: "prism".to_owned(),
            source: String::new(),
            projection: faceformer::drawing::Projection::Orthographic,
            edges: [ends, upper, risers]
                .concat()
                .into_iter()
                .map(edge)
                .collect(),
            vertices,
            truth: None,
        }
    }

    #[test]
    fn small_gaps_are_closed_and_edges_keep_their_numbers() {
        let prism = prism();
        let mended = part(&prism, 1e-4, &mut Random::new(1, "prism")).unwrap();
        assert_eq!(mended.vertices.len(), 6);
        for (a, b) in prism.edges.iter().zip(&mended.edges) {
            let middle = |e: &Edge| (e.points[0] + e.points[1]) / 2.0;
            assert!(middle(a).distance(middle(b)) < 1e-3);
            assert_ne!(a.points, b.points);
        }
    }

    /// A cube's faces.
    fn cube() -> Vec<Face> {
        let rings = [
            [0, 1, 2, 3],
            [4, 5, 6, 7],
            [0, 8, 4, 9],
            [1, 9, 5, 10],
            [2, 10, 6, 11],
            [3, 11, 7, 8],
        ];
        rings.iter().map(|r| face(&[r])).collect()
    }

    #[test]
    fn two_faces_become_one() {
        for seed in 0..20 {
            let mut faces = cube();
            let wrong = corrupt(&mut faces, 1, &mut Random::new(seed, "cube"));
            assert_eq!((wrong.len(), faces.len()), (1, 5));
            assert_eq!(faces[wrong[0]].loops.len(), 2);
        }
        let mut faces = cube();
        let wrong = corrupt(&mut faces, 2, &mut Random::new(3, "cube"));
        assert_eq!((wrong.len(), faces.len()), (2, 4));
    }
}
