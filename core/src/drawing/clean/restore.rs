//! Drawings of the corpus, spoiled and cleaned up again.

use std::sync::OnceLock;

use glam::DVec2;
use proptest::prelude::*;

use super::super::dataset::Drawings;
use super::super::{Curve2, Drawing, Edge, Limits};
use super::{CleanDrawing, CleanOptions, Piece, clean};

fn corpus() -> impl Iterator<Item = Drawing> {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../tests/corpus/sample.jsonl.zst"
    );
    Drawings::open(path).unwrap().map(Result::unwrap)
}

fn polylines(drawing: &Drawing) -> Vec<Vec<DVec2>> {
    drawing.edges.iter().map(|e| e.points.clone()).collect()
}

pub(super) fn cleaned(polylines: &[Vec<DVec2>]) -> CleanDrawing {
    clean(polylines, &CleanOptions::default(), &Limits::default()).unwrap()
}

/// How a cleaned drawing differs from the one it should be, up to numbering and direction.
fn difference(found: &Drawing, wanted: &Drawing, reach: f64) -> Option<String> {
    if found.vertices.len() != wanted.vertices.len() || found.edges.len() != wanted.edges.len() {
        return Some(format!(
            "{} vertices, {} edges instead of {}, {}",
            found.vertices.len(),
            found.edges.len(),
            wanted.vertices.len(),
            wanted.edges.len()
        ));
    }
    let mut taken = vec![false; wanted.edges.len()];
    for e in &found.edges {
        let ends = e.v.map(|v| found.vertices[v]);
        let middle = e.points[e.points.len() / 2];
        let off = |w: &Edge| {
            let other = w.v.map(|v| wanted.vertices[v]);
            let same = |i: usize| {
                ends[0].distance(other[i]) <= reach && ends[1].distance(other[1 - i]) <= reach
            };
            let closed = e.v[0] == e.v[1] && w.v[0] == w.v[1];
            let piece = Piece::new(w.points.clone(), w.curve, 0);
            (same(0) || same(1) || closed)
                .then(|| piece.point(piece.foot(middle).u).distance(middle))
        };
        let candidates = wanted.edges.iter().enumerate().filter(|(k, _)| !taken[*k]);
        let twin = candidates
            .filter_map(|(k, w)| off(w).map(|d| (k, d)))
            .filter(|(_, d)| *d < 1e-3)
            .min_by(|a, b| a.1.total_cmp(&b.1));
        match twin {
            Some((k, _)) => taken[k] = true,
            None => {
                return Some(format!(
                    "an edge from {} to {} is not there",
                    ends[0], ends[1]
                ));
            }
        }
    }
    None
}

/// Pseudo-random numbers in [0, 1) that depend on a seed alone.
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        // Knuth's linear congruential generator; the high bits are the random ones.
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, n: usize) -> usize {
        (self.roll() * n as f64) as usize
    }
}

/// What hidden-line drawings and careless hands do to a drawing's edges: cuts them into pieces,
/// gives pieces twice, turns them around, shuffles them, and moves every end by up to `jitter`.
/// Returns the pieces and the edge each one comes from.
fn spoiled(drawing: &Drawing, jitter: f64, dice: &mut Dice) -> (Vec<Vec<DVec2>>, Vec<usize>) {
    let mut pieces: Vec<(Vec<DVec2>, usize)> = Vec::new();
    for (k, e) in drawing.edges.iter().enumerate() {
        let mut cuts: Vec<f64> = Vec::new();
        while dice.roll() < 0.3 {
            // A polyline is known at its points only.
            let n = (e.points.len() - 1) as f64;
            cuts.push(match e.curve {
                Curve2::Polyline => (dice.roll() * n).round() / n,
                _ => dice.roll(),
            });
        }
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        cuts.retain(|u| *u > 0.0 && *u < 1.0);
        let mut rest = Piece::new(e.points.clone(), e.curve, k);
        rest.v = [0, 1];
        let stops: Vec<_> = cuts.iter().map(|&u| (u, 2, rest.point(u))).collect();
        // Only pieces that are long beside the tolerance.
        let parts = rest.split(&stops);
        let fine = |p: &Piece| e.is_straight() || p.points.len() > 3;
        let parts = match parts.iter().all(|p| p.length() > 0.01 && fine(p)) {
            true => parts,
            false => vec![rest],
        };
        for part in parts {
            let again = dice.roll() < 0.15;
            pieces.push((part.points.clone(), k));
            if again {
                pieces.push((part.points, k));
            }
        }
    }
    for i in (1..pieces.len()).rev() {
        pieces.swap(i, dice.below(i + 1));
    }
    for (points, _) in &mut pieces {
        if dice.roll() < 0.5 {
            points.reverse();
        }
        let n = points.len() - 1;
        for i in [0, n] {
            points[i] += DVec2::new(dice.roll() - 0.5, dice.roll() - 0.5) * jitter * 2.0;
        }
    }
    pieces.into_iter().unzip()
}

fn restore(drawing: &Drawing, jitter: f64, seed: u64) -> Result<(), String> {
    let (pieces, origin) = spoiled(drawing, jitter, &mut Dice(seed));
    let c = cleaned(&pieces);
    if let Some(what) = difference(&c.drawing, drawing, 2.0 * jitter + 1e-5) {
        return Err(format!("{} seed {seed}: {what}", drawing.id));
    }
    // Every piece went into the edge it came from.
    let mut seen = vec![0; pieces.len()];
    for sources in &c.sources {
        for &s in sources {
            seen[s] += 1;
            if origin[s] != origin[sources[0]] {
                return Err(format!("{} seed {seed}: sources mix edges", drawing.id));
            }
        }
    }
    match seen.iter().all(|&n| n == 1) {
        true => Ok(()),
        false => Err(format!(
            "{} seed {seed}: sources are not complete",
            drawing.id
        )),
    }
}

/// Drawings that have nothing to clean up come back as they are.
#[test]
fn corpus_edges_alone_give_the_same_graphs() {
    for d in corpus() {
        let c = cleaned(&polylines(&d));
        assert_eq!(difference(&c.drawing, &d, 1e-5), None, "{}", d.id);
        for (e, sources) in c.sources.iter().enumerate() {
            assert_eq!(sources.len(), 1, "{} edge {e}", d.id);
        }
    }
}

/// Share of spoiled drawings that come back as they were.
#[test]
fn spoiled_drawings_are_restored() {
    for (jitter, least) in [(0.0, 0.99), (1e-6, 0.98), (1e-5, 0.96), (4e-5, 0.95)] {
        let (mut n, mut bad) = (0, 0);
        for d in corpus() {
            n += 1;
            if let Err(e) = restore(&d, jitter, n) {
                bad += 1;
                println!("{e}");
            }
        }
        println!("jitter {jitter}: {bad} of {n} differ");
        assert!(f64::from(bad) <= (1.0 - least) * n as f64);
    }
}

/// Number of vertices, and what each edge was made from.
type Cleaned = (usize, Vec<Vec<usize>>);

/// Cleans up a spoiled drawing of the corpus where it is and elsewhere.
fn here_and_there(seed: u64, turn: f64, log_scale: f64, far: f64) -> [Cleaned; 2] {
    static ALL: OnceLock<Vec<Drawing>> = OnceLock::new();
    let all = ALL.get_or_init(|| corpus().collect());
    let mut dice = Dice(seed);
    let drawing = &all[dice.below(all.len())];
    let (pieces, _) = spoiled(drawing, 0.0, &mut dice);
    let there = |p: &DVec2| (DVec2::from_angle(turn).rotate(*p) + far) * log_scale.exp();
    let moved: Vec<Vec<DVec2>> = pieces
        .iter()
        .map(|l| l.iter().map(there).collect())
        .collect();
    [pieces, moved].map(|p| {
        let c = cleaned(&p);
        (c.drawing.vertices.len(), c.sources)
    })
}

/// Here a curve is cut at one of its own sample points, up to rounding.
#[test]
fn a_curve_cut_at_a_sample_point_is_joined_wherever_it_lies() {
    for far in [0.0, 3.0, -36.38] {
        let [here, there] = here_and_there(8495434993719926118, 0.0, 0.0, far);
        assert_eq!(here, there, "{far}");
    }
}

proptest! {
    /// Clean-up depends on neither place, size nor orientation of the drawing.
    #[test]
    fn clean_up_moves_and_scales_with_the_drawing(
        seed: u64, turn in -3.0..3.0f64, log_scale in -12.0..12.0f64, far in -50.0..50.0f64
    ) {
        let [here, there] = here_and_there(seed, turn, log_scale, far);
        prop_assert_eq!(here, there);
    }
}
