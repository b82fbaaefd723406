//! Lines that meet a torus, and lines that touch it.

use glam::DVec3;

use super::Surface;

/// Steps along a line in which crossings are looked for.
const STEPS: usize = 48;

/// A line that misses the torus by less than this share of its minor radius is taken to touch it.
const TOUCHES: f64 = 0.02;

/// Distances from the torus at equal steps of the part of a line that is near it: the step, the
/// first value of t, the distances.
fn samples(torus: &Surface, from: DVec3, direction: DVec3) -> Option<(f64, f64, Vec<f64>)> {
    let Surface::Torus {
        center,
        major,
        minor,
        ..
    } = *torus
    else {
        return None;
    };
    let reach = 1.05 * (major + minor);
    let o = from - center;
    let scale = direction.length_squared();
    let middle = -o.dot(direction) / scale;
    let half = ((reach * reach - (o + direction * middle).length_squared()) / scale).sqrt();
    if !half.is_finite() {
        return None;
    }
    let step = 2.0 * half / STEPS as f64;
    let first = middle - half;
    let value = |i: usize| torus.distance(from + direction * (first + step * i as f64));
    Some((step, first, (0..=STEPS).map(value).collect()))
}

/// Values of t where the line `from + t direction` crosses or nearly touches a torus, in order.
pub(super) fn crossings(torus: &Surface, from: DVec3, direction: DVec3) -> Vec<f64> {
    let Some((step, first, values)) = samples(torus, from, direction) else {
        return Vec::new();
    };
    let Surface::Torus { minor, .. } = *torus else {
        return Vec::new();
    };
    let at = |t: f64| torus.distance(from + direction * t);
    let mut found = Vec::new();
    for i in 0..STEPS {
        let t = first + step * i as f64;
        if (values[i] < 0.0) != (values[i + 1] < 0.0) {
            found.push(bisect(&at, t, t + step));
        } else if i > 0 && extreme(&values, i) {
            // Between two steps of one sign the line may still dip in and out, or touch.
            let sign = values[i].signum();
            let best = narrow(&|t| sign * at(t), t - step, t + step);
            if sign * at(best) < 0.0 {
                found.push(bisect(&at, t - step, best));
                found.push(bisect(&at, best, t + step));
            } else if at(best).abs() < TOUCHES * minor {
                found.push(best);
            }
        }
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
    let Some((step, first, values)) = samples(torus, from, direction) else {
        return Vec::new();
    };
    let at = |t: f64| torus.distance(from + direction * t);
    let mut found = Vec::new();
    for i in 1..STEPS {
        let t = first + step * i as f64;
        for sign in [1.0, -1.0] {
            let v = |j: usize| sign * values[j];
            if v(i) <= v(i - 1) && v(i) <= v(i + 1) {
                let best = narrow(&|t| sign * at(t), t - step, t + step);
                found.push((best, at(best).abs()));
            }
        }
    }
    found
}

fn extreme(values: &[f64], i: usize) -> bool {
    let same = (values[i - 1] < 0.0) == (values[i] < 0.0);
    let size = |j: usize| values[j].abs();
    same && size(i) <= size(i - 1) && size(i) <= size(i + 1)
}

fn bisect(f: &impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let below = f(low) < 0.0;
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if (f(middle) < 0.0) == below {
            low = middle;
        } else {
            high = middle;
        }
    }
    f64::midpoint(low, high)
}

/// Place of the least value between two bounds: parabolas through the last three places, golden
/// sections where they do not help (Brent 1973).
fn narrow(f: &impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    const SHARE: f64 = 0.381_966_011_250_105_1;
    const STEPS: usize = 40;
    let enough = 1e-10 * (high - low);
    let mut x = low + SHARE * (high - low);
    let (mut w, mut v) = (x, x);
    let mut fx = f(x);
    let (mut fw, mut fv) = (fx, fx);
    let (mut step, mut before) = (0.0f64, 0.0f64);
    for _ in 0..STEPS {
        let middle = f64::midpoint(low, high);
        if (x - middle).abs() <= 2.0 * enough - 0.5 * (high - low) {
            break;
        }
        let r = (x - w) * (fx - fv);
        let q = (x - v) * (fx - fw);
        let p = (x - v) * q - (x - w) * r;
        let q = 2.0 * (q - r);
        let parabola = if q > 0.0 { -p / q } else { p / -q };
        let useful = parabola.is_finite()
            && parabola.abs() < 0.5 * before.abs()
            && x + parabola > low
            && x + parabola < high;
        before = step;
        step = if useful {
            parabola
        } else {
            before = if x < middle { high - x } else { low - x };
            SHARE * before
        };
        let u = x + step.abs().max(enough).copysign(step);
        let fu = f(u);
        if fu <= fx {
            if u < x {
                high = x;
            } else {
                low = x;
            }
            (v, fv, w, fw, x, fx) = (w, fw, x, fx, u, fu);
        } else {
            if u < x {
                low = u;
            } else {
                high = u;
            }
            if fu <= fw || w == x {
                (v, fv, w, fw) = (w, fw, u, fu);
            } else if fu <= fv || v == x || v == w {
                (v, fv) = (u, fu);
            }
        }
    }
    x
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
    fn the_least_value_is_found_quickly() {
        use std::cell::Cell;
        for (low, high, least) in [(-1.0, 2.0, 0.3), (0.0, 1.0, 0.999), (-5.0, 5.0, -4.0)] {
            let calls = Cell::new(0);
            let f = |t: f64| {
                calls.set(calls.get() + 1);
                (t - least).powi(2) + 0.3 * (t - least).powi(4)
            };
            let found = narrow(&f, low, high);
            assert!((found - least).abs() < 1e-7, "{found} for {least}");
            // Golden sections alone take 43 for the longest of these.
            assert!(calls.get() < 35, "{}", calls.get());
        }
        // No slope at the least value.
        let kinked = narrow(&|t: f64| (t - 0.4).abs(), 0.0, 1.0);
        assert!((kinked - 0.4).abs() < 1e-6, "{kinked}");
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
}
