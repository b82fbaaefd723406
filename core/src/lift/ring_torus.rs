//! Lines that meet a torus, and lines that touch it.

use glam::DVec3;

use super::Surface;

/// Steps along a line in which crossings are looked for.
const STEPS: usize = 48;

/// A line that misses the torus by less than this share of its minor radius is taken to touch it.
const TOUCHES: f64 = 0.02;

/// Two extremes are one where the slope between them is less than this share of that beside them.
const TURNS: f64 = 1e-3;

/// A line seen from a torus. With p = `from + t direction`, z is p's height over the plane of the
/// ring and rho its distance from the axis: z is linear in t and rho² quadratic.
struct Line {
    major: f64,
    minor: f64,
    /// Height at t = 0, and its slope.
    height: [f64; 2],
    /// Coefficients of rho², from the constant one.
    square: [f64; 3],
    /// Values of t between which the line is near the torus.
    range: [f64; 2],
}

impl Line {
    /// `None` if the line passes far away, or the surface is no torus.
    fn new(torus: &Surface, from: DVec3, direction: DVec3) -> Option<Self> {
        let Surface::Torus {
            center,
            axis,
            major,
            minor,
        } = *torus
        else {
            return None;
        };
        let reach = 1.05 * (major + minor);
        let scale = direction.length_squared();
        let middle = (center - from).dot(direction) / scale;
        // Measured from the point nearest to the centre, so that no digits are lost.
        let o = from + direction * middle - center;
        let half = ((reach * reach - o.length_squared()) / scale).sqrt();
        if !half.is_finite() {
            return None;
        }
        let height = [o.dot(axis), direction.dot(axis)];
        let (across, along) = (o - axis * height[0], direction - axis * height[1]);
        Some(Self {
            major,
            minor,
            height,
            square: [
                across.length_squared(),
                2.0 * across.dot(along),
                along.length_squared(),
            ],
            range: [middle - half, middle + half],
        })
    }

    /// The t that height and rho² are measured from.
    fn middle(&self) -> f64 {
        f64::midpoint(self.range[0], self.range[1])
    }

    /// Height and rho at t.
    fn place(&self, t: f64) -> (f64, f64) {
        let s = t - self.middle();
        let [a, b, c] = self.square;
        let square = a + s * (b + s * c);
        (self.height[0] + s * self.height[1], square.max(0.0).sqrt())
    }

    /// Distance from the torus, negative within.
    fn distance(&self, t: f64) -> f64 {
        let (z, rho) = self.place(t);
        let u = rho - self.major;
        (u * u + z * z).sqrt() - self.minor
    }

    /// The slope of the distance, times what has no sign.
    fn slope(&self, t: f64) -> f64 {
        let (z, rho) = self.place(t);
        let half = 0.5 * self.square[1] + self.square[2] * (t - self.middle());
        (rho - self.major) * half + z * self.height[1] * rho
    }

    /// Values of t where the distance is extreme, in order.
    fn extremes(&self) -> Vec<f64> {
        let [low, high] = self.range;
        let step = (high - low) / STEPS as f64;
        let mut found = Vec::new();
        let place = |i: usize| {
            let t = low + step * i as f64;
            (t, self.slope(t))
        };
        let (mut first, mut before) = (place(0), place(0));
        for i in 1..=STEPS {
            let here = place(i);
            if (before.1 < 0.0) != (here.1 < 0.0) {
                found.push(root(&|t| self.slope(t), before, here));
            } else {
                self.extremes_between(first, before, here, &mut found);
            }
            (first, before) = (before, here);
        }
        found
    }

    /// The two extremes, or the one, between three places with slopes of one sign, of which the middle one
    /// is the least: where an outline turns, a line of sight has two next to each other.
    fn extremes_between(
        &self,
        first: (f64, f64),
        middle: (f64, f64),
        last: (f64, f64),
        found: &mut Vec<f64>,
    ) {
        /// Thirds are taken off so often.
        const CUTS: usize = 24;
        let sign = middle.1.signum();
        let [a, b, c] = [first, middle, last].map(|p| p.1 * sign);
        if a.min(c) <= 0.0 || b >= a || b > c {
            return;
        }
        let value = |t: f64| self.slope(t) * sign;
        let (mut low, mut high) = (first.0, last.0);
        for _ in 0..CUTS {
            let third = (high - low) / 3.0;
            let (s, t) = (low + third, high - third);
            if value(s) < value(t) {
                high = t;
            } else {
                low = s;
            }
        }
        let t = f64::midpoint(low, high);
        let least = value(t);
        if least < 0.0 {
            let at = (t, least * sign);
            found.push(root(&|t| self.slope(t), first, at));
            found.push(root(&|t| self.slope(t), at, last));
        } else if least < TURNS * a.min(c) {
            found.push(t);
        }
    }
}

/// Values of t where the line `from + t direction` crosses or nearly touches a torus, in order.
pub(super) fn crossings(torus: &Surface, from: DVec3, direction: DVec3) -> Vec<f64> {
    let Some(line) = Line::new(torus, from, direction) else {
        return Vec::new();
    };
    let place = |t: f64| (t, line.distance(t));
    let extremes = line.extremes();
    let [low, high] = line.range;
    let mut found = Vec::new();
    let mut before = place(low);
    for (i, &t) in extremes.iter().chain([&high]).enumerate() {
        let here = place(t);
        if (before.1 < 0.0) != (here.1 < 0.0) {
            found.push(root(&|t| line.distance(t), before, here));
        } else if i < extremes.len() && here.1.abs() < TOUCHES * line.minor {
            // Between two extremes the distance runs one way: this one is not crossed before.
            let next = place(extremes.get(i + 1).copied().unwrap_or(high));
            if (next.1 < 0.0) == (here.1 < 0.0) && here.1.abs() <= before.1.abs() {
                found.push(t);
            }
        }
        before = here;
    }
    found
}

/// How far a line is from touching a torus: the least magnitude of the distance where it is
/// extreme along the line; infinite if it passes far away.
pub(super) fn touching_gap(torus: &Surface, from: DVec3, direction: DVec3) -> f64 {
    let extremes = extremes(torus, from, direction).into_iter();
    extremes.fold(f64::INFINITY, |m, (_, gap)| m.min(gap))
}

/// Values of t where the line `from + t direction` touches a torus within `tolerance`.
pub(super) fn touches(torus: &Surface, from: DVec3, direction: DVec3, tolerance: f64) -> Vec<f64> {
    let all = extremes(torus, from, direction).into_iter();
    let least = all.min_by(|a, b| a.1.total_cmp(&b.1));
    let near = least.filter(|(_, gap)| *gap < tolerance);
    near.into_iter().map(|(t, _)| t).collect()
}

/// Places along a line where the distance from a torus is extreme, with its magnitude.
fn extremes(torus: &Surface, from: DVec3, direction: DVec3) -> Vec<(f64, f64)> {
    let Some(line) = Line::new(torus, from, direction) else {
        return Vec::new();
    };
    let found = line.extremes().into_iter();
    found.map(|t| (t, line.distance(t).abs())).collect()
}

/// Where a function is zero between two places, given with values of unlike signs (regula falsi with
/// the halving of Illinois; sections in two where that is slow).
fn root(f: &impl Fn(f64) -> f64, mut low: (f64, f64), mut high: (f64, f64)) -> f64 {
    const STEPS: usize = 80;
    let enough = 1e-14 * (high.0 - low.0);
    // Whether the last place became the lower end.
    let mut last = None;
    for step in 0..STEPS {
        let secant = low.0 - low.1 * (high.0 - low.0) / (high.1 - low.1);
        let inside = secant > low.0 && secant < high.0;
        let t = if inside && step % 4 != 3 {
            secant
        } else {
            f64::midpoint(low.0, high.0)
        };
        let value = f(t);
        if value == 0.0 || high.0 - low.0 < enough {
            return t;
        }
        let is_low = (value < 0.0) == (low.1 < 0.0);
        let (taken, other) = if is_low {
            (&mut low, &mut high)
        } else {
            (&mut high, &mut low)
        };
        *taken = (t, value);
        if last == Some(is_low) {
            other.1 *= 0.5;
        }
        last = Some(is_low);
    }
    f64::midpoint(low.0, high.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TORUS: Surface = Surface::Torus {
        center: DVec3::ZERO,
        axis: DVec3::Z,
        major: 2.0,
        minor: 0.5,
    };

    #[test]
    fn a_line_through_the_ring_crosses_four_times() {
        let found = crossings(&TORUS, DVec3::new(-7.0, 0.0, 0.1), DVec3::X);
        assert_eq!(found.len(), 4);
        let out = (0.25f64 - 0.01).sqrt();
        assert!((found[0] - (7.0 - 2.0 - out)).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn a_root_is_found_quickly() {
        use std::cell::Cell;
        for (low, high, zero) in [(-1.0, 2.0, 0.3), (0.0, 1.0, 0.999), (-5.0, 5.0, -4.0)] {
            let calls = Cell::new(0);
            let f = |t: f64| {
                calls.set(calls.get() + 1);
                (t - zero) + 0.3 * (t - zero).powi(3)
            };
            let found = root(&f, (low, f(low)), (high, f(high)));
            assert!((found - zero).abs() < 1e-12, "{found} for {zero}");
            // Sections in two alone take 46.
            assert!(calls.get() < 30, "{}", calls.get());
        }
    }

    #[test]
    fn a_line_that_misses_a_little_touches() {
        let over = |height: f64| crossings(&TORUS, DVec3::new(-7.0, 2.0, height), DVec3::X);
        assert_eq!(over(0.499).len(), 2);
        assert_eq!(over(0.505).len(), 1);
        assert_eq!(over(0.6).len(), 0);
    }

    #[test]
    fn lines_that_touch_are_told() {
        let touching = touching_gap(&TORUS, DVec3::new(2.5, 0.0, 9.0), DVec3::Z);
        assert!(touching < 1e-9);
        let inner = touching_gap(&TORUS, DVec3::new(0.0, 1.5, 9.0), DVec3::Z);
        assert!(inner < 1e-9);
        let far = touching_gap(&TORUS, DVec3::new(2.4, 0.0, 9.0), DVec3::Z);
        assert!(far > 0.05);
    }

    /// On the inside of a torus a line that touches it may nearly follow it: its distance is extreme twice
    /// within one step.
    #[test]
    fn a_line_that_nearly_follows_the_torus_touches_it() {
        for place in 1..20 {
            let tube = 2.0 + 0.05 * f64::from(place);
            let (sin, cos) = tube.sin_cos();
            let out = 2.0 + 0.5 * cos;
            let at = DVec3::new(out, 0.0, 0.5 * sin);
            // The direction in which the surface does not bend (Euler 1760).
            let flat = (-0.5 * cos / out).sqrt().atan();
            for turn in [-0.02, -0.005, -0.001, 0.0, 0.001, 0.005, 0.02] {
                let (s, c) = f64::sin_cos(flat + turn);
                let direction = DVec3::new(-sin * s, c, cos * s);
                let gap = touching_gap(&TORUS, at - direction * 3.01, direction);
                assert!(gap < 1e-6, "{tube} {turn} {gap}");
            }
        }
    }
}
