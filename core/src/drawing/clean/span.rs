//! One segment of a polyline, as the smooth curve that it stands for.

use glam::DVec2;

/// Turn at a point up to which a polyline is taken for smooth there; as for the steps of an
/// ellipse.
const SMOOTH: f64 = 0.9;

/// A cubic between two neighbouring points of a polyline, with the slopes of the parabolas through
/// three points each; the straight segment where the polyline has corners.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    ends: [DVec2; 2],
    /// Derivatives at the ends, for a parameter from 0 to 1.
    slopes: [DVec2; 2],
}

impl Span {
    /// The span from point `i` to the next one.
    pub(super) fn new(points: &[DVec2], i: usize) -> Self {
        let ends = [points[i], points[i + 1]];
        let chord = ends[1] - ends[0];
        let before = i.checked_sub(1).map(|h| ends[0] - points[h]);
        let after = points.get(i + 2).map(|next| *next - ends[1]);
        let smooth = |side: Option<DVec2>| side.is_none_or(|s| s.angle_to(chord).abs() < SMOOTH);
        let slopes = if smooth(before) && smooth(after) {
            let first = before.map(|d| slope_between(d, chord));
            let last = after.map(|d| slope_between(d, chord));
            // Without a neighbour the parabola of the other end goes on.
            [
                first.unwrap_or_else(|| 2.0 * chord - last.unwrap_or(chord)),
                last.unwrap_or_else(|| 2.0 * chord - first.unwrap_or(chord)),
            ]
        } else {
            [chord, chord]
        };
        Self { ends, slopes }
    }

    pub(super) fn point(&self, t: f64) -> DVec2 {
        let s = 1.0 - t;
        let [a, b] = self.ends;
        let [m, n] = self.slopes;
        a * (s * s * (1.0 + 2.0 * t)) + b * (t * t * (3.0 - 2.0 * t)) + (m * s - n * t) * (s * t)
    }

    pub(super) fn derivative(&self, t: f64) -> DVec2 {
        let s = 1.0 - t;
        let [a, b] = self.ends;
        let [m, n] = self.slopes;
        (b - a) * (6.0 * s * t) + m * (s * (1.0 - 3.0 * t)) + n * (t * (3.0 * t - 2.0))
    }

    /// Parameter of the point nearest to `p`, starting from a guess.
    pub(super) fn foot(&self, p: DVec2, guess: f64) -> f64 {
        let mut t = guess;
        for _ in 0..3 {
            let d = self.derivative(t);
            let step = (p - self.point(t)).dot(d) / d.length_squared().max(f64::MIN_POSITIVE);
            t = (t + step).clamp(0.0, 1.0);
        }
        t
    }

    /// How far the true curve may be off: the cubic is better than its chord by an order, so a
    /// tenth of the distance between the two.
    pub(super) fn doubt(&self) -> f64 {
        (self.slopes[0] - self.slopes[1]).length() / 80.0
    }
}

/// Slope, for the parameter of the second of two chords, where they meet.
fn slope_between(other: DVec2, chord: DVec2) -> DVec2 {
    let (l, m) = (other.length(), chord.length());
    let sum = (l + m).max(f64::MIN_POSITIVE);
    chord * (l / sum) + other * (m / l.max(f64::MIN_POSITIVE)) * (m / sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_span_of_a_circle_is_much_nearer_than_its_chord() {
        let points: Vec<DVec2> = (0..9)
            .map(|i| DVec2::from_angle(f64::from(i) * 0.2))
            .collect();
        for i in 0..8 {
            let span = Span::new(&points, i);
            for t in [0.0, 0.3, 0.5, 0.9, 1.0] {
                let off = (span.point(t).length() - 1.0).abs();
                assert!(off < 1e-4 && off <= span.doubt(), "{i} {t} {off}");
                let d = (span.point(t + 1e-6) - span.point(t - 1e-6)) / 2e-6;
                assert!(d.distance(span.derivative(t)) < 1e-6);
            }
            let p = span.point(0.4) * 1.01;
            assert!((span.foot(p, 0.7) - 0.4).abs() < 1e-3);
        }
    }

    #[test]
    fn corners_stay_corners() {
        let points = [DVec2::ZERO, DVec2::X, DVec2::ONE];
        assert_eq!(Span::new(&points, 0).point(0.5), DVec2::new(0.5, 0.0));
        assert_eq!(
            Span::new(&points[..2], 0).point(0.25),
            DVec2::new(0.25, 0.0)
        );
    }
}
