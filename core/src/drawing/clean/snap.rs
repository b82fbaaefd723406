//! End points that meet become one vertex.

use std::collections::HashMap;

use glam::DVec2;

use super::super::FindingKind;
use super::net::Net;
use super::piece::Piece;

/// Share of ends without an exact partner from which on a drawing is taken for drawn by hand.
const SLOPPY: f64 = 0.05;

/// Points that stand for clusters, in cells as large as the reach.
struct Seeds {
    reach: f64,
    cells: HashMap<[i64; 2], Vec<usize>>,
    places: Vec<DVec2>,
}

impl Seeds {
    fn new(reach: f64) -> Self {
        Self {
            reach,
            cells: HashMap::new(),
            places: Vec::new(),
        }
    }

    fn cell(&self, p: DVec2) -> [i64; 2] {
        (p / self.reach).floor().to_array().map(|x| x as i64)
    }

    fn add(&mut self, p: DVec2) -> usize {
        let seed = self.places.len();
        let cell = self.cell(p);
        self.cells.entry(cell).or_default().push(seed);
        self.places.push(p);
        seed
    }

    /// The nearest seed within reach that is allowed, and how far it is.
    fn nearest(&self, p: DVec2, allowed: impl Fn(usize) -> bool) -> Option<(f64, usize)> {
        let [i, j] = self.cell(p);
        (i - 1..=i + 1)
            .flat_map(|i| (j - 1..=j + 1).map(move |j| [i, j]))
            .filter_map(|cell| self.cells.get(&cell))
            .flatten()
            .map(|&s| (self.places[s].distance(p), s))
            .filter(|&(d, s)| d <= self.reach && allowed(s))
            .min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// How exact the ends are: the distance within which ends that were meant to be one point lie.
///
/// In an exact drawing every end has another one within `exact`, whatever else comes near in the
/// projection. Where more than a few ends have none there, but one within `reach`, the ends were
/// drawn by hand or traced, and their gaps tell how well.
pub(super) fn estimate_noise(net: &Net<'_>, exact: f64, reach: f64) -> f64 {
    let ends: Vec<DVec2> = net
        .pieces
        .iter()
        .flat_map(|p| [p.end(0), p.end(1)])
        .collect();
    let mut seeds = Seeds::new(reach);
    for &p in &ends {
        seeds.add(p);
    }
    let gap = |(i, p): (usize, &DVec2)| seeds.nearest(*p, |s| s != i).map(|(d, _)| d);
    let gaps = ends.iter().enumerate().filter_map(gap);
    let open: Vec<f64> = gaps.filter(|d| *d > exact).collect();
    if open.len() < 3 || open.len() as f64 <= SLOPPY * ends.len() as f64 {
        return exact;
    }
    open.into_iter().fold(0.0, f64::max)
}

/// Makes the vertices: ends within `reach` of the first end of a cluster are one vertex, at the
/// mean of the cluster.
pub(super) fn make_vertices(net: &mut Net<'_>, reach: f64) {
    let mut seeds = Seeds::new(reach);
    let mut sums: Vec<(DVec2, f64)> = Vec::new();
    for piece in &mut net.pieces {
        piece.v = [piece.end(0), piece.end(1)].map(|p| {
            let vertex = seeds.nearest(p, |_| true).map(|(_, s)| s);
            let vertex = vertex.unwrap_or_else(|| {
                sums.push((DVec2::ZERO, 0.0));
                seeds.add(p)
            });
            sums[vertex].0 += p;
            sums[vertex].1 += 1.0;
            vertex
        });
    }
    net.vertices = sums.iter().map(|(sum, n)| *sum / *n).collect();
    net.follow_vertices();
}

/// Joins vertices where something is missing with vertices within `reach`; complete vertices are
/// never joined with each other, near as they may be drawn. Pieces not longer than `reach` whose
/// ends become one are dropped. Returns how far an end was moved at most.
pub(super) fn close_gaps(net: &mut Net<'_>, reach: f64) -> f64 {
    let degrees = net.degrees();
    let wanting = net.wanting();
    let incidence = net.incidence();
    let mut seeds = Seeds::new(reach);
    let mut cluster = vec![usize::MAX; net.vertices.len()];
    let mut members: Vec<Vec<usize>> = Vec::new();
    let complete = (0..degrees.len()).filter(|&v| degrees[v] > 0 && !wanting[v]);
    for v in complete {
        cluster[v] = seeds.add(net.vertices[v]);
        members.push(vec![v]);
    }
    for v in (0..degrees.len()).filter(|&v| wanting[v]) {
        let p = net.vertices[v];
        let found = seeds.nearest(p, |s| {
            let collapses = |i: &usize| {
                let piece = &net.pieces[*i];
                let [a, b] = piece.v;
                let other = if a == v { b } else { a };
                cluster[other] == s && !may_close(piece, reach)
            };
            !incidence[v].iter().any(collapses)
        });
        let s = found.map(|(_, s)| s).unwrap_or_else(|| {
            members.push(Vec::new());
            seeds.add(p)
        });
        cluster[v] = s;
        members[s].push(v);
    }
    let moved = move_members(net, &members, &degrees, &wanting);
    for list in members.iter().filter(|list| list.len() > 1) {
        note_gap(net, list, &incidence);
    }
    for v in net.pieces.iter_mut().flat_map(|p| &mut p.v) {
        *v = members[cluster[*v]][0];
    }
    for list in members.iter().filter(|list| list.len() > 1) {
        net.vertices[list[0]] = moved.1[cluster[list[0]]];
    }
    drop_collapsed(net, reach);
    net.follow_vertices();
    moved.0
}

/// Whether both ends of a piece may become one vertex: it is too short to keep, or it is a long
/// curve that comes back to where it began.
fn may_close(piece: &Piece, reach: f64) -> bool {
    let length = piece.length();
    length <= reach || length > 10.0 * reach
}

/// Where each cluster's vertex goes, and the longest way there: a complete vertex stays, else it
/// is the mean of the ends.
fn move_members(
    net: &Net<'_>,
    members: &[Vec<usize>],
    degrees: &[usize],
    wanting: &[bool],
) -> (f64, Vec<DVec2>) {
    let mut farthest = 0f64;
    let places = members.iter().map(|list| {
        let place = match list.iter().find(|&&v| !wanting[v]) {
            Some(&v) => net.vertices[v],
            None => {
                let weight: f64 = list.iter().map(|&v| degrees[v] as f64).sum();
                let ends = list.iter().map(|&v| net.vertices[v] * degrees[v] as f64);
                ends.sum::<DVec2>() / weight
            }
        };
        for &v in list {
            farthest = farthest.max(net.vertices[v].distance(place));
        }
        place
    });
    let places = places.collect();
    (farthest, places)
}

fn note_gap(net: &mut Net<'_>, list: &[usize], incidence: &[Vec<usize>]) {
    let places: Vec<DVec2> = list.iter().map(|&v| net.vertices[v]).collect();
    let widest = places
        .iter()
        .flat_map(|a| places.iter().map(|b| a.distance(*b)))
        .fold(0.0, f64::max);
    let pieces = list.iter().flat_map(|&v| &incidence[v]);
    let mut edges: Vec<usize> = pieces
        .flat_map(|&i| net.pieces[i].sources.clone())
        .collect();
    edges.sort_unstable();
    edges.dedup();
    let message = format!(
        "ends of {} are {widest:.1e} apart and were joined; draw them to one point",
        net.names(&edges)
    );
    net.note(FindingKind::Snapped, message, edges, places);
}

fn drop_collapsed(net: &mut Net<'_>, reach: f64) {
    let pieces = std::mem::take(&mut net.pieces);
    let (gone, kept): (Vec<_>, Vec<_>) = pieces
        .into_iter()
        .partition(|p| p.is_closed() && p.length() <= reach);
    net.pieces = kept;
    for p in gone {
        let message = format!(
            "{} is as short as the tolerance and was left out; delete it or draw it longer",
            net.names(&p.sources)
        );
        net.note(FindingKind::ZeroLength, message, p.sources, p.points);
    }
}
