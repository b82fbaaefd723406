//! The released Faceformer JSON: one polyline a co-edge, mates in `pairings`, no vertices.

use std::collections::BTreeMap;

use glam::DVec3;
use serde::Deserialize;

use super::super::{
    CleanDrawing, CoEdge, Curve2, Drawing, DrawingError, Edge, Finding, FindingKind, Limits,
    Report, Severity, SurfaceKind, Truth, TruthFace, clean, diagnose,
};
use super::parse::{Raw, RawEdge};

/// Distance within which end points are one vertex, relative to the drawing's size; the release's
/// own figure.
const SAME_VERTEX: f64 = 2e-4;

/// What only the release's files hold.
#[derive(Debug, Default)]
pub(in super::super) struct Release {
    /// Co-edge to mate, each pair once.
    pub(super) pairings: Option<BTreeMap<String, usize>>,
    pub(super) faces: Option<Vec<ReleaseFace>>,
    pub(super) edges3d: Vec<Vec<DVec3>>,
    pub(super) directions: Vec<DVec3>,
}

/// A face: loops of co-edges, with OCCT's `GeomAbs_SurfaceType` or without.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
pub(in super::super) enum ReleaseFace {
    Typed(usize, Vec<Vec<usize>>),
    Bare(Vec<Vec<usize>>),
}

/// The drawing of a release file. Each edge's sources are its two co-edges; edges run as the first
/// of them does.
pub(super) fn read(raw: Raw, limits: &Limits) -> Result<CleanDrawing, DrawingError> {
    let labels = raw.labels();
    let coedges = pair(&raw)?;
    let mut sources: Vec<Vec<usize>> = vec![Vec::new(); raw.edges.len() / 2];
    for (i, c) in coedges.iter().enumerate() {
        sources[c.edge()].push(i);
    }
    let release = raw.release;
    let mut drawing = Drawing {
        id: raw.id,
        source: raw.source,
        projection: raw.projection,
        vertices: Vec::new(),
        edges: sources.iter().map(|s| edge(&raw.edges[s[0]])).collect(),
        truth: None,
    };
    let size = drawing.check_input(limits)?;
    check_mates(&raw.edges, &sources, SAME_VERTEX * size)?;
    drawing.vertices = clean::assign_vertices(&mut drawing.edges, SAME_VERTEX * size)?;
    let mut findings = Vec::new();
    if let Some(faces) = release.faces {
        let mut untyped = false;
        let faces = faces.into_iter().map(|f| {
            untyped |= matches!(f, ReleaseFace::Bare(_));
            face(f, &coedges, &drawing.edges)
        });
        let faces = faces.collect::<Result<_, _>>()?;
        if untyped {
            findings.push(no_types());
        }
        let edges3d = space_curves(release.edges3d, &sources, coedges.len())?;
        drawing.truth = Some(Truth {
            faces,
            vertices3d: space_vertices(&drawing, &edges3d),
            edges3d,
            directions: release.directions,
        });
    }
    drawing.check(limits)?;
    let drawing = drawing.recognised();
    let names: Vec<String> = sources.iter().map(|s| labels[s[0]].clone()).collect();
    for finding in diagnose::findings(&drawing, &names) {
        findings.push(finding.about_sources(&sources));
    }
    Ok(CleanDrawing {
        drawing,
        sources,
        report: Report {
            findings,
            tolerance: Some(SAME_VERTEX * size),
        },
    })
}

/// The co-edge that each polyline of the file is.
fn pair(raw: &Raw) -> Result<Vec<CoEdge>, DrawingError> {
    let wrong = |what: String| Err(DrawingError::Format(what));
    let n = raw.edges.len();
    let mut mate = vec![usize::MAX; n];
    for (key, &j) in raw.release.pairings.iter().flatten() {
        let Ok(i) = key.parse::<usize>() else {
            return wrong(format!(
                "`pairings` has the key {key:?}, which is no number"
            ));
        };
        if i >= n || j >= n || i == j || mate[i] != usize::MAX || mate[j] != usize::MAX {
            return wrong(format!(
                "`pairings` makes {i} and {j} mates, but one is not there or has another mate"
            ));
        }
        mate[i] = j;
        mate[j] = i;
    }
    if let Some(i) = mate.iter().position(|&j| j == usize::MAX) {
        return wrong(format!(
            "co-edge {i} (counted from 0) has no mate in `pairings`"
        ));
    }
    let mut coedges = vec![CoEdge::new(0, false); n];
    let firsts = (0..n).filter(|&i| i < mate[i]);
    for (edge, i) in firsts.enumerate() {
        coedges[i] = CoEdge::new(edge, false);
        coedges[mate[i]] = CoEdge::new(edge, true);
    }
    Ok(coedges)
}

fn edge(raw: &RawEdge) -> Edge {
    Edge {
        v: [0, 0],
        points: raw.points.clone(),
        curve: Curve2::Polyline,
    }
}

/// Mates are one polyline walked both ways.
fn check_mates(edges: &[RawEdge], sources: &[Vec<usize>], reach: f64) -> Result<(), DrawingError> {
    for s in sources {
        let (a, b) = (&edges[s[0]].points, &edges[s[1]].points);
        let same = a.len() == b.len()
            && a.iter()
                .zip(b.iter().rev())
                .all(|(p, q)| p.distance(*q) <= reach);
        if !same {
            return Err(DrawingError::Format(format!(
                "co-edges {} and {} (counted from 0) are mates, but not the same curve",
                s[0], s[1]
            )));
        }
    }
    Ok(())
}

fn face(face: ReleaseFace, coedges: &[CoEdge], edges: &[Edge]) -> Result<TruthFace, DrawingError> {
    let (kind, loops) = match face {
        ReleaseFace::Typed(kind, loops) => (Some(kind), loops),
        ReleaseFace::Bare(loops) => (None, loops),
    };
    let coedge = |i: usize| {
        coedges.get(i).copied().ok_or_else(|| {
            let n = coedges.len();
            DrawingError::Truth(format!("a face names co-edge {i}, but there are only {n}"))
        })
    };
    let loops = loops
        .into_iter()
        .map(|l| l.into_iter().map(coedge).collect())
        .collect::<Result<Vec<Vec<CoEdge>>, _>>()?;
    let straight = || {
        let mut all = loops.iter().flatten();
        all.all(|c| edges[c.edge()].points.len() == 2)
    };
    // The values of OCCT's GeomAbs_SurfaceType.
    let kind = match kind {
        Some(0) => SurfaceKind::Plane,
        Some(1) => SurfaceKind::Cylinder,
        Some(2) => SurfaceKind::Cone,
        Some(3) => SurfaceKind::Sphere,
        Some(4) => SurfaceKind::Torus,
        None if straight() => SurfaceKind::Plane,
        _ => SurfaceKind::Other,
    };
    Ok(TruthFace { kind, loops })
}

fn no_types() -> Finding {
    Finding {
        severity: Severity::Notice,
        kind: FindingKind::NoFaceTypes,
        message:
            "the file does not say what surfaces its faces are; those with straight edges only \
                  are taken for planes, the rest is `other`"
                .into(),
        edges: Vec::new(),
        vertices: Vec::new(),
        points: Vec::new(),
    }
}

/// The polyline in space of each edge; none if the file has none.
fn space_curves(
    mut edges3d: Vec<Vec<DVec3>>,
    sources: &[Vec<usize>],
    coedges: usize,
) -> Result<Vec<Vec<DVec3>>, DrawingError> {
    if edges3d.is_empty() {
        return Ok(edges3d);
    }
    if edges3d.len() != coedges {
        return Err(DrawingError::Truth(format!(
            "it has {} edges3d for {coedges} co-edges",
            edges3d.len()
        )));
    }
    Ok(sources
        .iter()
        .map(|s| std::mem::take(&mut edges3d[s[0]]))
        .collect())
}

/// Vertices in space: the means of the ends that meet there.
fn space_vertices(drawing: &Drawing, edges3d: &[Vec<DVec3>]) -> Vec<DVec3> {
    if edges3d.is_empty() {
        return Vec::new();
    }
    let mut sums = vec![(DVec3::ZERO, 0.0); drawing.vertices.len()];
    for (e, points) in drawing.edges.iter().zip(edges3d) {
        for (v, p) in e.v.into_iter().zip([points.first(), points.last()]) {
            if let Some(p) = p {
                sums[v].0 += *p;
                sums[v].1 += 1.0;
            }
        }
    }
    sums.iter().map(|(sum, n)| *sum / *n).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use serde_json::{Value, json};

    use super::super::super::dataset::Drawings;
    use super::super::read;
    use super::*;

    fn corpus() -> impl Iterator<Item = Drawing> {
        let path = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../tests/corpus/sample.jsonl.zst"
        );
        Drawings::open(path).unwrap().map(Result::unwrap)
    }

    /// Writes a drawing as the release does: co-edges sorted by coordinates.
    fn released(drawing: &Drawing, types: bool) -> Value {
        let truth = drawing.truth.as_ref().unwrap();
        let n = 2 * drawing.edges.len();
        let mut order: Vec<CoEdge> = (0..n).map(CoEdge::from_index).collect();
        let walk = |c: &CoEdge| {
            let e = &drawing.edges[c.edge()];
            let mut line: Vec<[f64; 5]> = e
                .points
                .iter()
                .zip(&truth.edges3d[c.edge()])
                .map(|(p, q)| [p.x, p.y, q.x, q.y, q.z])
                .collect();
            if c.is_reversed() {
                line.reverse();
            }
            line
        };
        order.sort_by(|a, b| walk(a).partial_cmp(&walk(b)).unwrap());
        let place = |c: CoEdge| order.iter().position(|o| *o == c).unwrap();
        let faces = truth.faces.iter().map(|f| {
            let loops: Vec<Vec<usize>> = f
                .loops
                .iter()
                .map(|l| l.iter().map(|c| place(*c)).collect())
                .collect();
            let number = match f.kind {
                SurfaceKind::Plane => 0,
                SurfaceKind::Cylinder => 1,
                SurfaceKind::Cone => 2,
                SurfaceKind::Sphere => 3,
                SurfaceKind::Torus => 4,
                SurfaceKind::Other => 10,
            };
            if types {
                json!([number, loops])
            } else {
                json!(loops)
            }
        });
        let pairings = (0..n).filter_map(|i| {
            let j = place(order[i].mate());
            (i < j).then(|| (i.to_string(), json!(j)))
        });
        json!({
            "edges": order.iter().map(|c| walk(c).iter().map(|p| [p[0], p[1]]).collect())
                .collect::<Vec<Vec<[f64; 2]>>>(),
            "edges3d": order.iter().map(|c| walk(c).iter().map(|p| [p[2], p[3], p[4]]).collect())
                .collect::<Vec<Vec<[f64; 3]>>>(),
            "shrinked_edges": [],
            "faces_indices": faces.collect::<Vec<_>>(),
            "dominant_directions": truth.directions,
            "pairings": pairings.collect::<serde_json::Map<_, _>>(),
        })
    }

    /// Faces as sets of edges, an edge by its sorted ends and length, in millionths.
    fn faces(d: &Drawing) -> BTreeSet<(SurfaceKind, Vec<[i64; 5]>)> {
        let key = |c: &CoEdge| {
            let e = &d.edges[c.edge()];
            let mut ends = e.v.map(|v| (d.vertices[v] * 1e6).round().to_array());
            ends.sort_by(|a, b| a.partial_cmp(b).unwrap());
            let [[a, b], [c, d]] = ends;
            [a, b, c, d, (e.length() * 1e4).round()].map(|x| x as i64)
        };
        let truth = d.truth.as_ref().unwrap();
        let faces = truth.faces.iter().map(|f| {
            let mut edges: Vec<_> = f.loops.iter().flatten().map(key).collect();
            edges.sort_unstable();
            (f.kind, edges)
        });
        faces.collect()
    }

    #[test]
    fn corpus_survives_the_release_format() {
        for drawing in corpus().take(120) {
            let text = released(&drawing, true).to_string();
            let c = read(&text, &Limits::default()).unwrap();
            assert_eq!(
                c.drawing.vertices.len(),
                drawing.vertices.len(),
                "{}",
                drawing.id
            );
            assert_eq!(faces(&c.drawing), faces(&drawing), "{}", drawing.id);
            let truth = c.drawing.truth.as_ref().unwrap();
            for (p, q) in c.drawing.vertices.iter().zip(&truth.vertices3d) {
                assert!(p.distance(q.truncate()) < 1e-5);
            }
            assert_eq!(truth.directions, drawing.truth.as_ref().unwrap().directions);
            assert!(c.sources.iter().all(|s| s.len() == 2));
        }
    }

    #[test]
    fn without_types_planes_are_told_by_their_edges_and_it_is_said() {
        let drawing = corpus().next().unwrap();
        let c = read(&released(&drawing, false).to_string(), &Limits::default()).unwrap();
        let truth = c.drawing.truth.unwrap();
        assert!(truth.faces.iter().all(|f| f.kind == SurfaceKind::Plane));
        assert_eq!(c.report.findings[0].kind, FindingKind::NoFaceTypes);
    }

    #[test]
    fn a_file_without_faces_is_a_drawing_without_truth() {
        let drawing = corpus().next().unwrap();
        let mut value = released(&drawing, true);
        value.as_object_mut().unwrap().remove("faces_indices");
        let c = read(&value.to_string(), &Limits::default()).unwrap();
        assert_eq!(c.drawing.truth, None);
        assert_eq!(c.drawing.edges.len(), drawing.edges.len());
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let drawing = corpus().next().unwrap();
        let good = released(&drawing, true);
        let last = good["edges"].as_array().unwrap().len() - 1;
        let refuse = |change: &dyn Fn(&mut Value)| {
            let mut value = good.clone();
            change(&mut value);
            read(&value.to_string(), &Limits::default()).unwrap_err()
        };
        let format = |e: DrawingError| matches!(e, DrawingError::Format(_));
        let truth = |e: DrawingError| matches!(e, DrawingError::Truth(_));
        assert!(format(refuse(&|v| v["pairings"] = json!({}))));
        assert!(format(refuse(&|v| v["pairings"]["x"] = json!(1))));
        assert!(format(refuse(&|v| v["pairings"]["0"] = json!(9999))));
        assert!(format(refuse(
            &|v| v["edges"][last] = json!([[0, 0], [0.5, 0.1]])
        )));
        assert!(truth(refuse(
            &|v| v["faces_indices"][0] = json!([0, [[0, 9999]]])
        )));
        assert!(truth(refuse(&|v| v["faces_indices"][0] = json!("plane"))));
        assert!(truth(refuse(&|v| v["edges3d"] = json!([[[0, 0, 0]]]))));
        assert!(truth(refuse(
            &|v| v["dominant_directions"] = json!([[1, 0, 0]])
        )));
    }
}
