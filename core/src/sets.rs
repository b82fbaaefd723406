//! Disjoint sets of numbers (Galler and Fischer 1964, "An improved equivalence algorithm").

/// Sets of the numbers 0 to n; at first each is alone.
pub(crate) struct Sets(Vec<usize>);

impl Sets {
    pub(crate) fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    /// The least number of the set that `x` is in.
    pub(crate) fn find(&mut self, mut x: usize) -> usize {
        while self.0[x] != x {
            self.0[x] = self.0[self.0[x]];
            x = self.0[x];
        }
        x
    }

    /// Makes one set of those of `a` and `b`; whether they were two.
    pub(crate) fn join(&mut self, a: usize, b: usize) -> bool {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b)] = a.min(b);
        a != b
    }

    /// The sets, each sorted, by their least numbers.
    pub(crate) fn groups(&mut self) -> Vec<Vec<usize>> {
        let mut groups: Vec<Vec<usize>> = Vec::new();
        let mut place = vec![0; self.0.len()];
        for x in 0..self.0.len() {
            let least = self.find(x);
            if least == x {
                place[x] = groups.len();
                groups.push(Vec::new());
            }
            groups[place[least]].push(x);
        }
        groups
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_grow_together_and_are_named_by_their_least() {
        let mut sets = Sets::new(6);
        assert!(sets.join(4, 2) && sets.join(5, 4) && sets.join(1, 0));
        assert!(!sets.join(5, 2));
        let roots: Vec<usize> = (0..6).map(|x| sets.find(x)).collect();
        assert_eq!(roots, [0, 0, 2, 3, 2, 2]);
        assert_eq!(sets.groups(), [vec![0, 1], vec![2, 4, 5], vec![3]]);
    }
}
