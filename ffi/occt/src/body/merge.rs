//! Silhouettes taken out: faces that they part become one, and so do edges that they cut.

use std::collections::BTreeMap;

use faceformer::drawing::CoEdge;
use faceformer::plan::Plan;
use faceformer::polygon::contains;
use glam::{DVec2, DVec3};

use super::curve::joined;
use super::{Body, BodyEdge, BodyFace};
use crate::groups::Groups;

/// Steps along an edge of a filled face.
const STEPS: usize = 16;

/// The plan without silhouettes, but for those that keep a filled face from running around like a pipe:
/// no surface of one piece can be laid through its ends. If `apart`, all those of filled faces with several
/// loops stay.
pub(super) fn merged(plan: &Plan, apart: bool) -> Body {
    let all: Vec<bool> = plan.edges.iter().map(|e| e.silhouette).collect();
    let (body, groups) = without(plan, &all);
    let faces = body.faces.iter();
    let rings: Vec<bool> = faces
        .map(|face| face.is_filled_ring() && (apart || is_pipe(&body, face)))
        .collect();
    if !rings.contains(&true) {
        return body;
    }
    let mut some = all;
    for (face, &group) in plan.faces.iter().zip(&groups) {
        if rings[group as usize] {
            for coedge in face.loops.iter().flatten() {
                some[coedge.edge()] = false;
            }
        }
    }
    without(plan, &some).0
}

/// Whether a face runs around like a pipe: some of its loops is not within the largest, seen along that
/// one's normal.
fn is_pipe(body: &Body, face: &BodyFace) -> bool {
    let line = |walk: &Vec<CoEdge>| -> Vec<DVec3> {
        let points = |c: &CoEdge| body.points(*c, STEPS).into_iter().skip(1);
        walk.iter().flat_map(points).collect()
    };
    let lines: Vec<Vec<DVec3>> = face.loops.iter().map(line).collect();
    let area = |line: &[DVec3]| -> DVec3 {
        let next = line.iter().cycle().skip(1);
        let sides = line
            .iter()
            .zip(next)
            .map(|(p, q)| (*p - line[0]).cross(*q - line[0]));
        sides.sum()
    };
    let areas: Vec<DVec3> = lines.iter().map(|l| area(l)).collect();
    let size = |i: &usize| areas[*i].length();
    let outer = (0..lines.len()).max_by(|a, b| size(a).total_cmp(&size(b)));
    let Some((outer, normal)) = outer.and_then(|o| Some((o, areas[o].try_normalize()?))) else {
        return false;
    };
    let (u, v) = normal.any_orthonormal_pair();
    let flat = |p: &DVec3| DVec2::new(p.dot(u), p.dot(v));
    let bounds: Vec<DVec2> = lines[outer].iter().map(flat).collect();
    let others = (0..lines.len()).filter(|&i| i != outer);
    others
        .flat_map(|i| &lines[i])
        .any(|p| !contains(&bounds, flat(p)))
}

/// The plan without some silhouettes, and the face of the result that each of its faces is part of.
fn without(plan: &Plan, silhouettes: &[bool]) -> (Body, Vec<u32>) {
    let silhouette = |e: usize| silhouettes[e];
    let loops = plan.faces.iter().map(|f| &f.loops);
    let groups = Groups::new(loops, plan.edges.len(), silhouette).labels();
    let next = successors(plan);
    // The walk goes on past a silhouette in the face on its other side.
    let after = |coedge: CoEdge| -> Option<CoEdge> {
        let mut found = *next.get(&coedge.signed())?;
        for _ in 0..plan.edges.len() {
            if !silhouette(found.edge()) {
                return Some(found);
            }
            found = *next.get(&found.mate().signed())?;
        }
        None
    };
    let count = groups.iter().max().map_or(0, |m| *m as usize + 1);
    let mut faces: Vec<Option<BodyFace>> = vec![None; count];
    let mut seen = vec![[false; 2]; plan.edges.len()];
    for (f, face) in plan.faces.iter().enumerate() {
        let merged = faces[groups[f] as usize].get_or_insert_with(|| BodyFace {
            surface: face.surface.clone(),
            axis: DVec3::Z,
            loops: Vec::new(),
            source: f,
        });
        for &start in face.loops.iter().flatten() {
            if silhouette(start.edge()) || seen[start.edge()][usize::from(start.is_reversed())] {
                continue;
            }
            let mut walk = Vec::new();
            let mut at = Some(start);
            while let Some(coedge) = at {
                let mark = &mut seen[coedge.edge()][usize::from(coedge.is_reversed())];
                if *mark {
                    break;
                }
                *mark = true;
                walk.push(coedge);
                at = after(coedge);
            }
            merged.loops.push(walk);
        }
    }
    let edges = plan.edges.iter().enumerate();
    let mut body = Body {
        vertices: plan.vertices.clone(),
        edges: edges
            .map(|(e, edge)| BodyEdge {
                v: edge.v,
                curve: edge.curve.clone(),
                source: e,
            })
            .collect(),
        faces: faces.into_iter().flatten().collect(),
    };
    dissolve(plan, silhouettes, &mut body);
    compact(&mut body);
    (body, groups)
}

/// The co-edge after each in its loop, by signed number.
fn successors(plan: &Plan) -> BTreeMap<i64, CoEdge> {
    let mut next = BTreeMap::new();
    for walk in plan.faces.iter().flat_map(|f| &f.loops) {
        for (i, coedge) in walk.iter().enumerate() {
            next.insert(coedge.signed(), walk[(i + 1) % walk.len()]);
        }
    }
    next
}

/// Joins two edges of one curve where only a silhouette ended.
fn dissolve(plan: &Plan, silhouettes: &[bool], body: &mut Body) {
    let size = plan
        .vertices
        .iter()
        .fold(0.0f64, |m, p| m.max(p.distance(plan.vertices[0])));
    for v in 0..plan.vertices.len() {
        let mut edges = plan.edges.iter().zip(silhouettes);
        let cut = edges.any(|(e, silhouette)| *silhouette && e.v.contains(&v));
        if !cut {
            continue;
        }
        let used = |e: &usize| {
            body.faces
                .iter()
                .flat_map(|f| &f.loops)
                .flatten()
                .any(|c| c.edge() == *e)
        };
        let at: Vec<usize> = (0..body.edges.len())
            .filter(|&e| !silhouettes[e] && body.edges[e].v.contains(&v))
            .filter(used)
            .collect();
        let [first, second] = at[..] else {
            continue;
        };
        // The first one towards the vertex, the second one away from it.
        let ins = CoEdge::new(first, body.edges[first].v[1] != v);
        let out = CoEdge::new(second, body.edges[second].v[0] != v);
        let Some(whole) = joined(body, ins, out, 1e-5 * size) else {
            continue;
        };
        body.edges[first] = whole;
        for walk in body.faces.iter_mut().flat_map(|f| &mut f.loops) {
            walk.retain(|c| c.edge() != second);
            for coedge in walk.iter_mut().filter(|c| c.edge() == first) {
                // The joined edge runs as the first one did towards the vertex.
                *coedge = CoEdge::new(first, coedge.is_reversed() != ins.is_reversed());
            }
        }
    }
}

/// Drops edges and vertices that no face uses.
fn compact(body: &mut Body) {
    let mut used = vec![false; body.edges.len()];
    for coedge in body.faces.iter().flat_map(|f| &f.loops).flatten() {
        used[coedge.edge()] = true;
    }
    let mut edge_at = vec![0; body.edges.len()];
    let mut vertex_at: BTreeMap<usize, usize> = BTreeMap::new();
    let mut edges = Vec::new();
    let mut vertices = Vec::new();
    for (e, mut edge) in std::mem::take(&mut body.edges).into_iter().enumerate() {
        if used[e] {
            edge_at[e] = edges.len();
            edge.v = edge.v.map(|v| {
                *vertex_at.entry(v).or_insert_with(|| {
                    vertices.push(body.vertices[v]);
                    vertices.len() - 1
                })
            });
            edges.push(edge);
        }
    }
    for coedge in body.faces.iter_mut().flat_map(|f| &mut f.loops).flatten() {
        *coedge = CoEdge::new(edge_at[coedge.edge()], coedge.is_reversed());
    }
    body.edges = edges;
    body.vertices = vertices;
}
