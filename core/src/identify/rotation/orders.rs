//! Cyclic orders of a few things, and the best of them.

use std::sync::OnceLock;

/// Largest degree whose `(d - 1)!` cyclic orders are all tried.
const EXACT: usize = 6;

/// What one place after another is worth: entry `(i, j)` if `j` follows `i`.
#[derive(Debug, Clone)]
pub(super) struct Gains {
    degree: usize,
    follows: Vec<f64>,
    /// Pairs of positions that are the two ends of one closed edge, see [`Gains::add_closed`].
    closed: Vec<(usize, usize, Vec<f64>)>,
}

/// The best order and how far it is ahead.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Best {
    /// Positions in cyclic order, beginning with 0.
    pub(super) order: Vec<usize>,
    /// Total gain.
    pub(super) gain: f64,
    /// Gain minus that of the second best order; infinite if there is only one.
    pub(super) margin: f64,
    /// The second best order, if there is one.
    pub(super) second: Option<Vec<usize>>,
}

impl Gains {
    /// No gains for orders of `degree` places.
    pub(super) fn new(degree: usize) -> Self {
        Self {
            degree,
            follows: vec![0.0; degree * degree],
            closed: Vec::new(),
        }
    }

    /// Adds to the gain of `j` after `i`.
    pub(super) fn add(&mut self, i: usize, j: usize, gain: f64) {
        self.follows[i * self.degree + j] += gain;
    }

    /// Adds an edge with both ends, `i` and `k`, at this vertex: it gains `table[before, after]`
    /// with the place before `i` and the one after `k`, and the same with the ends swapped
    /// (`before` the place after `i`, `after` the one before `k`). The table has `degree` columns.
    pub(super) fn add_closed(&mut self, i: usize, k: usize, table: Vec<f64>) {
        self.closed.push((i, k, table));
    }

    /// Gain of one order.
    pub(super) fn of(&self, order: &[usize]) -> f64 {
        let n = self.degree;
        let mut total = 0.0;
        for (k, &i) in order.iter().enumerate() {
            total += self.follows[i * n + order[(k + 1) % n]];
        }
        if !self.closed.is_empty() {
            let mut place = vec![0; n];
            for (k, &i) in order.iter().enumerate() {
                place[i] = k;
            }
            let after = |i: usize| order[(place[i] + 1) % n];
            let before = |i: usize| order[(place[i] + n - 1) % n];
            for (i, k, table) in &self.closed {
                total += table[before(*i) * n + after(*k)] + table[after(*i) * n + before(*k)];
            }
        }
        total
    }

    /// The best order: of all up to six places, beyond that the best that moving single places
    /// reaches from a greedy start and from `current`.
    pub(super) fn best(&self, current: Option<&[usize]>) -> Best {
        if self.degree <= EXACT {
            return self.best_of_all();
        }
        let greedy = self.improve(self.greedy());
        let best = match current {
            Some(order) => {
                let other = self.improve(order.to_vec());
                if self.of(&other) > self.of(&greedy) {
                    other
                } else {
                    greedy
                }
            }
            None => greedy,
        };
        let gain = self.of(&best);
        let (margin, second) = self
            .neighbours(&best)
            .map(|o| (gain - self.of(&o), Some(o)))
            .fold((f64::INFINITY, None), |a, b| if b.0 < a.0 { b } else { a });
        Best {
            order: rotate(best),
            gain,
            margin,
            second,
        }
    }

    fn best_of_all(&self) -> Best {
        let (mut first, mut second) = ((f64::NEG_INFINITY, 0), (f64::NEG_INFINITY, None));
        let orders = cyclic_orders(self.degree);
        for (k, order) in orders.iter().enumerate() {
            let gain = self.of(order);
            if gain > first.0 {
                if k > 0 {
                    second = (first.0, Some(first.1));
                }
                first = (gain, k);
            } else if gain > second.0 {
                second = (gain, Some(k));
            }
        }
        Best {
            order: orders[first.1].clone(),
            gain: first.0,
            margin: second.1.map_or(f64::INFINITY, |_| first.0 - second.0),
            second: second.1.map(|k| orders[k].clone()),
        }
    }

    fn greedy(&self) -> Vec<usize> {
        let n = self.degree;
        let mut order = vec![0];
        let mut free: Vec<usize> = (1..n).collect();
        while let Some(&last) = order.last() {
            let gain = |i: usize| self.follows[last * n + i];
            let Some(k) = (0..free.len()).max_by(|&a, &b| gain(free[a]).total_cmp(&gain(free[b])))
            else {
                break;
            };
            order.push(free.swap_remove(k));
        }
        order
    }

    fn improve(&self, mut order: Vec<usize>) -> Vec<usize> {
        let mut gain = self.of(&order);
        // Each round gains something, so it ends; the bound keeps rounding from cycling.
        for _ in 0..4 * self.degree {
            let better = self
                .neighbours(&order)
                .map(|o| (self.of(&o), o))
                .max_by(|a, b| a.0.total_cmp(&b.0));
            match better {
                Some((g, o)) if g > gain => (gain, order) = (g, o),
                _ => break,
            }
        }
        order
    }

    /// Orders in which one place stands elsewhere.
    fn neighbours<'a>(&self, order: &'a [usize]) -> impl Iterator<Item = Vec<usize>> + 'a {
        let n = self.degree;
        (0..n).flat_map(move |from| {
            // Left out: staying, the swap that the neighbour's move makes, and last to first.
            let other = move |&to: &usize| to != from && to + 1 != from && (from, to) != (n - 1, 0);
            (0..n - 1).filter(other).map(move |to| {
                let mut moved = order.to_vec();
                let place = moved.remove(from);
                moved.insert(to, place);
                moved
            })
        })
    }
}

/// The same cyclic order, beginning with place 0.
fn rotate(mut order: Vec<usize>) -> Vec<usize> {
    if let Some(k) = order.iter().position(|&i| i == 0) {
        order.rotate_left(k);
    }
    order
}

/// All cyclic orders of up to six places, each beginning with 0.
pub(super) fn cyclic_orders(degree: usize) -> &'static [Vec<usize>] {
    static TABLE: OnceLock<Vec<Vec<Vec<usize>>>> = OnceLock::new();
    let table = TABLE.get_or_init(|| {
        let mut table = vec![vec![Vec::new()], vec![vec![0]]];
        for d in 2..=EXACT {
            // Each order of d places is one of d - 1 with the last place put in anywhere.
            let orders = table[d - 1].iter().flat_map(|order| {
                (1..d).map(move |k| {
                    let mut longer = order.clone();
                    longer.insert(k, d - 1);
                    longer
                })
            });
            let orders: Vec<Vec<usize>> = orders.collect();
            table.push(orders);
        }
        table
    });
    &table[degree.min(EXACT)]
}

/// Whether all orders of this degree are tried.
pub(super) fn is_exact(degree: usize) -> bool {
    degree <= EXACT
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn there_are_d_minus_one_factorial_orders() {
        let mut expected = 1;
        for d in 1..=EXACT {
            let mut orders = cyclic_orders(d).to_vec();
            orders.sort();
            orders.dedup();
            assert_eq!(orders.len(), expected);
            expected *= d;
        }
    }

    #[test]
    fn margin_is_to_the_second_best() {
        let mut gains = Gains::new(3);
        gains.add(0, 1, 2.0);
        gains.add(0, 2, 0.5);
        let best = gains.best(None);
        assert_eq!(best.order, [0, 1, 2]);
        assert_eq!(best.margin, 1.5);
        assert_eq!(Gains::new(2).best(None).margin, f64::INFINITY);
    }

    proptest! {
        #[test]
        fn a_planted_order_of_any_degree_is_found(
            order in (3usize..12).prop_flat_map(|d| Just((0..d).collect::<Vec<_>>()).prop_shuffle())
        ) {
            let n = order.len();
            let mut gains = Gains::new(n);
            for k in 0..n {
                gains.add(order[k], order[(k + 1) % n], 1.0);
            }
            let best = gains.best(None);
            prop_assert_eq!(best.gain, n as f64);
            prop_assert_eq!(best.order, rotate(order));
            prop_assert!(best.margin > 0.0);
        }
    }
}
