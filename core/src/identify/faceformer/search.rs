//! Decoding of whole sequences: greedy, or with a beam for each start.

use super::{Decoding, Hypothesis, TOKENS, Variant};

/// A decoded sequence.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Tokens, the first one included, and the end if there is one.
    pub tokens: Vec<u32>,
    /// Log-probability of each token after the first.
    pub log_probabilities: Vec<f32>,
    /// Whether the sequence ended; else it reached the largest length.
    pub ended: bool,
}

impl Found {
    fn new(hypothesis: Hypothesis, ended: bool) -> Self {
        Self {
            tokens: hypothesis.tokens,
            log_probabilities: hypothesis.log_probabilities,
            ended,
        }
    }
}

/// A sequence in the search, with the start that it comes from.
struct Alive {
    start: usize,
    hypothesis: Hypothesis,
}

/// The likeliest sequence from each start, all starts at once; `steps` is the largest length without
/// its end.
///
/// A beam of width 1 takes the likeliest token in every step. `allow` may forbid tokens: it gets the
/// tokens so far, and logits to set to minus infinity. `progress` hears the share done, and its error
/// ends the search.
///
/// # Errors
/// candle's as the inner result; what `progress` returns as the outer one.
pub fn search<E>(
    decoding: &mut Decoding<'_>,
    variant: Variant,
    starts: &[u32],
    steps: usize,
    beam: usize,
    allow: impl Fn(&[u32], &mut [f32]),
    progress: impl Fn(f64) -> Result<(), E>,
) -> Result<candle_core::Result<Vec<Found>>, E> {
    let beam = beam.max(1);
    let mut alive: Vec<Hypothesis> = starts.iter().map(|&t| Hypothesis::new(t)).collect();
    let mut owner: Vec<usize> = (0..starts.len()).collect();
    let mut best: Vec<Option<Found>> = vec![None; starts.len()];
    for step in 0..steps {
        if alive.is_empty() {
            break;
        }
        progress(step as f64 / steps as f64)?;
        let logits = match decoding.step(&mut alive) {
            Ok(logits) => logits,
            Err(error) => return Ok(Err(error)),
        };
        let last = step + 1 == steps;
        let mut next: Vec<Alive> = Vec::with_capacity(alive.len());
        let mut row = 0;
        while row < alive.len() {
            let start = owner[row];
            let end = (row..alive.len())
                .find(|&r| owner[r] != start)
                .unwrap_or(alive.len());
            let mut candidates: Vec<(f64, usize, u32, f32)> = Vec::new();
            for r in row..end {
                let mut logits = logits[r].clone();
                for (token, logit) in logits.iter_mut().enumerate().take(TOKENS) {
                    if !variant.follows(token) {
                        *logit = f32::NEG_INFINITY;
                    }
                }
                allow(&alive[r].tokens, &mut logits);
                let so_far = alive[r].log_probability();
                for (token, log_probability) in largest(&logits, beam) {
                    let whole = so_far + f64::from(log_probability);
                    candidates.push((whole, r, token, log_probability));
                }
            }
            candidates.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
            let least = |f: &Option<Found>| match f {
                Some(f) if f.ended => f.log_probabilities.iter().copied().map(f64::from).sum(),
                _ => f64::NEG_INFINITY,
            };
            for &(whole, r, token, log_probability) in candidates.iter().take(beam) {
                // Longer sequences are never likelier: what is behind the best end stays there.
                if whole <= least(&best[start]) {
                    break;
                }
                let mut hypothesis = alive[r].clone();
                hypothesis.tokens.push(token);
                hypothesis.log_probabilities.push(log_probability);
                if variant.ends(token) {
                    best[start] = Some(Found::new(hypothesis, true));
                } else if last {
                    best[start].get_or_insert_with(|| Found::new(hypothesis, false));
                } else {
                    next.push(Alive { start, hypothesis });
                }
            }
            row = end;
        }
        owner = next.iter().map(|a| a.start).collect();
        alive = next.into_iter().map(|a| a.hypothesis).collect();
    }
    let none = |start: u32| Found::new(Hypothesis::new(start), false);
    let found = best.into_iter().zip(starts);
    Ok(Ok(found
        .map(|(found, &start)| found.unwrap_or_else(|| none(start)))
        .collect()))
}

/// The largest `count` logits with their log-probabilities, the largest first.
fn largest(logits: &[f32], count: usize) -> Vec<(u32, f32)> {
    let top = logits.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    if top == f32::NEG_INFINITY {
        return Vec::new();
    }
    let sum: f32 = logits.iter().map(|x| (x - top).exp()).sum();
    let normal = top + sum.ln();
    let mut order: Vec<usize> = Vec::with_capacity(count + 1);
    for (token, x) in logits.iter().enumerate() {
        let place = order.partition_point(|&o| logits[o] >= *x);
        if place < count && *x > f32::NEG_INFINITY {
            order.insert(place, token);
            order.truncate(count);
        }
    }
    order
        .into_iter()
        .map(|token| (token as u32, logits[token] - normal))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_come_first_with_their_probabilities() {
        let logits = [0.0, 2.0, f32::NEG_INFINITY, 2.0, 1.0];
        let found = largest(&logits, 3);
        let tokens: Vec<u32> = found.iter().map(|f| f.0).collect();
        assert_eq!(tokens, [1, 3, 4]);
        let all: f32 = largest(&logits, 9).iter().map(|f| f.1.exp()).sum();
        assert!((all - 1.0).abs() < 1e-6);
        assert_eq!(largest(&[f32::NEG_INFINITY; 2], 1), []);
    }
}
