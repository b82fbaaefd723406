//! A grid of points for finding those near a polyline.

use glam::DVec2;

/// Points sorted into square cells, about one a cell.
#[derive(Debug)]
pub(super) struct PointGrid {
    origin: DVec2,
    cell: f64,
    width: usize,
    height: usize,
    first: Vec<u32>,
    index: Vec<u32>,
}

impl PointGrid {
    /// Sorts the points in time linear in their number.
    pub(super) fn new(points: &[DVec2]) -> Self {
        let min = points.iter().fold(DVec2::INFINITY, |m, p| m.min(*p));
        let max = points.iter().fold(DVec2::NEG_INFINITY, |m, p| m.max(*p));
        let extent = if points.is_empty() {
            DVec2::ZERO
        } else {
            max - min
        };
        let side = (points.len() as f64).sqrt().clamp(1.0, 500.0).ceil();
        let cell = (extent.max_element() / side).max(f64::MIN_POSITIVE);
        let cells = |x: f64| (x / cell) as usize + 1;
        let mut grid = Self {
            origin: if points.is_empty() { DVec2::ZERO } else { min },
            cell,
            width: cells(extent.x),
            height: cells(extent.y),
            first: Vec::new(),
            index: vec![0; points.len()],
        };
        let cell_of: Vec<usize> = points
            .iter()
            .map(|p| {
                let [i, j] = grid.cell(*p);
                j * grid.width + i
            })
            .collect();
        grid.first = vec![0; grid.width * grid.height + 1];
        for &c in &cell_of {
            grid.first[c + 1] += 1;
        }
        for c in 1..grid.first.len() {
            grid.first[c] += grid.first[c - 1];
        }
        let mut fill = grid.first.clone();
        for (p, &c) in cell_of.iter().enumerate() {
            grid.index[fill[c] as usize] = p as u32;
            fill[c] += 1;
        }
        grid
    }

    /// Indices of all points within `reach` of a polyline, sorted; and some that are farther.
    pub(super) fn near(&self, polyline: &[DVec2], reach: f64) -> Vec<usize> {
        let mut found = Vec::new();
        for w in polyline.windows(2) {
            self.near_segment(w[0], w[1], reach, &mut found);
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    fn near_segment(&self, a: DVec2, b: DVec2, reach: f64, found: &mut Vec<usize>) {
        // Row by row, the columns that the segment passes there, widened by the reach.
        let (low, high) = if a.y <= b.y { (a, b) } else { (b, a) };
        let [_, j0] = self.cell(low - reach);
        let [_, j1] = self.cell(high + reach);
        let slope = (high.x - low.x) / (high.y - low.y).max(f64::MIN_POSITIVE);
        for j in j0..=j1 {
            let y = self.origin.y + self.cell * j as f64;
            let x_at = |y: f64| {
                let y = y.clamp(low.y, high.y);
                let x = low.x + slope * (y - low.y);
                x.clamp(low.x.min(high.x), low.x.max(high.x))
            };
            let (x0, x1) = (x_at(y - reach), x_at(y + self.cell + reach));
            // A level segment is passed whole in its row.
            let level = high.y - low.y <= f64::EPSILON * self.cell;
            let (x0, x1) = if level { (low.x, high.x) } else { (x0, x1) };
            let [i0, _] = self.cell(DVec2::new(x0.min(x1) - reach, y));
            let [i1, _] = self.cell(DVec2::new(x0.max(x1) + reach, y));
            let row = j * self.width;
            let span = self.first[row + i0] as usize..self.first[row + i1 + 1] as usize;
            found.extend(self.index[span].iter().map(|&p| p as usize));
        }
    }

    /// Cell of a place; places outside belong to the nearest cell.
    fn cell(&self, p: DVec2) -> [usize; 2] {
        let q = (p - self.origin) / self.cell;
        [
            (q.x.max(0.0) as usize).min(self.width - 1),
            (q.y.max(0.0) as usize).min(self.height - 1),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn distance(p: DVec2, a: DVec2, b: DVec2) -> f64 {
        let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(if t.is_nan() { a } else { a.lerp(b, t) })
    }

    proptest! {
        #[test]
        fn no_near_point_is_missed(
            points in prop::collection::vec(prop::array::uniform2(-1.0..1.0f64), 0..60),
            line in prop::collection::vec(prop::array::uniform2(-1.2..1.2f64), 2..5),
            reach in 0.0..0.2f64,
            level: bool,
        ) {
            let points: Vec<DVec2> = points.into_iter().map(DVec2::from).collect();
            let mut line: Vec<DVec2> = line.into_iter().map(DVec2::from).collect();
            if level {
                line[1].y = line[0].y;
            }
            let found = PointGrid::new(&points).near(&line, reach);
            for (i, p) in points.iter().enumerate() {
                if line.windows(2).any(|w| distance(*p, w[0], w[1]) <= reach) {
                    prop_assert!(found.contains(&i));
                }
            }
        }
    }

    #[test]
    fn few_points_are_looked_at() {
        let points: Vec<DVec2> = (0..10_000)
            .map(|i| DVec2::new(f64::from(i % 100), f64::from(i / 100)))
            .collect();
        let line = [DVec2::new(3.0, 2.0), DVec2::new(90.0, 71.0)];
        assert!(PointGrid::new(&points).near(&line, 0.01).len() < 500);
    }
}
