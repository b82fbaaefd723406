//! Directions that parts are made of, in the coordinates of their own frame.

use std::f64::consts::PI;
use std::sync::LazyLock;

use glam::DVec3;

/// A direction in the model's frame and how much an edge along it speaks for the frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Usual {
    pub(super) direction: DVec3,
    pub(super) weight: f64,
}

/// Weights of edges at 15, 30, 45, 60 and 75 degrees to two axes and at right angles to the third.
const SLANTED: [f64; 5] = [0.3, 0.6, 0.8, 0.6, 0.3];

/// The axes first, then the slanted directions.
pub(super) static USUAL: LazyLock<Vec<Usual>> = LazyLock::new(|| {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let mut all: Vec<Usual> = axes
        .iter()
        .map(|&direction| Usual {
            direction,
            weight: 1.0,
        })
        .collect();
    for k in 0..3 {
        let (u, w) = (axes[(k + 1) % 3], axes[(k + 2) % 3]);
        for (step, &weight) in (1..).zip(&SLANTED) {
            let angle = f64::from(step) * PI / 12.0;
            for side in [angle, -angle] {
                let direction = u * side.cos() + w * side.sin();
                all.push(Usual { direction, weight });
            }
        }
    }
    all
});
