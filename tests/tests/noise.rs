//! Drawings by hand: what is inexact becomes an exact solid.

use std::path::Path;

use faceformer_tests::{faceformer, output_dir, prism};
use serde_json::Value;

/// Profile of a bracket and its width; all angles are right.
const PROFILE: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [1.4, 0.0],
    [1.4, 0.5],
    [0.6, 0.5],
    [0.6, 1.1],
    [0.0, 1.1],
];
const WIDTH: f64 = 0.8;
const VOLUME: f64 = (1.4 * 0.5 + 0.6 * 0.6) * WIDTH;

/// Noise, as a share of half the diagonal of the drawing, and how many drawings are shaken by it.
const NOISE: f64 = 0.005;
const DRAWINGS: u64 = 12;

/// An edge of length 1 that is drawn half as long is off by 2 sqrt(2) noises, and a volume by as
/// much for each of its three sides; no drawing is off by three times that.
const OFF: f64 = 0.12;

/// A repeatable stream of nearly normal numbers: sums of twelve even ones (Knuth's MMIX).
struct Normal(u64);

impl Normal {
    fn next(&mut self) -> f64 {
        let mut unit = || {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1u64 << 53) as f64
        };
        (0..12).map(|_| unit()).sum::<f64>() - 6.0
    }
}

/// The bracket seen from above and from the side, its vertices off by normal noise, and its faces.
fn shaken_bracket(seed: u64) -> (Value, Value) {
    let ((sin, cos), (down, up)) = (0.7f64.sin_cos(), 0.6f64.sin_cos());
    let seen = |[x, z]: [f64; 2], y: f64| [cos * x + sin * y, up * z + down * (cos * y - sin * x)];
    let mut vertices: Vec<[f64; 2]> = [0.0, WIDTH]
        .into_iter()
        .flat_map(|y| PROFILE.map(|p| seen(p, y)))
        .collect();
    let span = |c: usize| {
        let all = vertices.iter().map(|v| v[c]);
        all.clone().fold(f64::MIN, f64::max) - all.fold(f64::MAX, f64::min)
    };
    let size = span(0).hypot(span(1)) / 2.0;
    let mut normal = Normal(seed);
    for v in &mut vertices {
        *v = v.map(|x| x + normal.next() * NOISE * size);
    }
    prism(&vertices)
}

/// Unit normals of the faces of a plan or a lift.
fn normals(surfaces: impl Iterator<Item = Value>) -> Vec<[f64; 3]> {
    surfaces
        .map(|s| {
            let n = &s["normal"];
            [0, 1, 2].map(|i| n[i].as_f64().unwrap())
        })
        .collect()
}

/// Whether all angles between normals are right, to rounding.
fn are_right(normals: &[[f64; 3]]) -> bool {
    let dot = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>().abs();
    let right = |d: f64| d < 1e-9 || (d - 1.0).abs() < 1e-9;
    normals
        .iter()
        .all(|a| normals.iter().all(|b| right(dot(a, b))))
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn a_bracket_by_hand_becomes_an_exact_solid() {
    let dir = output_dir("noise-bracket");
    let [drawing, faces, out] = ["drawing.json", "faces.json", "out.json"].map(|f| dir.join(f));
    for seed in 0..DRAWINGS {
        let (content, list) = shaken_bracket(seed);
        std::fs::write(&drawing, content.to_string()).unwrap();
        std::fs::write(&faces, list.to_string()).unwrap();
        let arguments = [
            "solid",
            text(&drawing),
            "--faces",
            text(&faces),
            "-o",
            text(&out),
        ];
        // It succeeds only with a solid that OpenCASCADE finds valid and closed.
        faceformer(arguments).ok();
        let record: Value = serde_json::from_slice(&std::fs::read(&out).unwrap()).unwrap();
        assert_eq!(record["lift"]["method"], "regular", "seed {seed}");
        let all = |list: &Value| list.as_array().unwrap().clone().into_iter();
        let lifted = normals(all(&record["lift"]["surfaces"]));
        assert!(
            lifted.len() == 8 && are_right(&lifted),
            "seed {seed}: {lifted:?}"
        );
        let faces = all(&record["plan"]["faces"]).map(|f| f["surface"].clone());
        let planned = normals(faces);
        assert!(
            planned.len() == 8 && are_right(&planned),
            "seed {seed}: {planned:?}"
        );
        assert_eq!(record["report"]["faces"], 8);
        let volume = record["report"]["volume"].as_f64().unwrap();
        assert!((volume / VOLUME - 1.0).abs() < OFF, "seed {seed}: {volume}");
    }
}
