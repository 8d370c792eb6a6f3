//! Points near a point, for points that stay: one flat list, sorted by the cells of a uniform grid.

use crate::{Bounds, Vec2};

/// An index of points, numbered from 0 in the order they were given.
#[derive(Clone, Debug)]
pub struct PointGrid {
    min: Vec2,
    cell_m: f64,
    columns: usize,
    rows: usize,
    /// Cell → range of `entries`, row by row.
    starts: Vec<u32>,
    entries: Vec<(Vec2, u32)>,
}

impl PointGrid {
    /// An index with square cells of `cell_m`, best near the usual search radius. Coarser where the
    /// points lie so far apart that there would be more than a few cells a point.
    pub fn new(points: &[Vec2], cell_m: f64) -> Self {
        let start = points.first().copied().unwrap_or_default();
        let bounds = points.iter().fold(Bounds { min: start, max: start }, |b, p| Bounds {
            min: b.min.min(*p),
            max: b.max.max(*p),
        });
        let most_cells = 8.0 * points.len() as f64 + 64.0;
        let size = bounds.size();
        let cell_m =
            cell_m.max((size.x * size.y / most_cells).sqrt()).max(size.max_element() / most_cells);
        let count = (size / cell_m).floor() + 1.0;
        let (columns, rows) = (count.x as usize, count.y as usize);
        let mut grid = Self {
            min: bounds.min,
            cell_m,
            columns,
            rows,
            starts: Vec::new(),
            entries: Vec::new(),
        };
        let mut keyed: Vec<(usize, Vec2, u32)> =
            (0..).zip(points).map(|(id, p)| (grid.cell(*p), *p, id)).collect();
        keyed.sort_by_key(|(cell, _, id)| (*cell, *id));
        grid.starts = vec![0; columns * rows + 1];
        for (cell, ..) in &keyed {
            grid.starts[cell + 1] += 1;
        }
        for cell in 0..columns * rows {
            grid.starts[cell + 1] += grid.starts[cell];
        }
        grid.entries = keyed.into_iter().map(|(_, p, id)| (p, id)).collect();
        grid
    }

    fn cell(&self, p: Vec2) -> usize {
        let place = (p - self.min) / self.cell_m;
        let column = (place.x as usize).min(self.columns - 1);
        (place.y as usize).min(self.rows - 1) * self.columns + column
    }

    /// Calls `visit` with the numbers of the points within `radius_m` of `p`, in order of cells.
    pub fn visit(&self, p: Vec2, radius_m: f64, mut visit: impl FnMut(u32)) {
        let low = ((p - radius_m - self.min) / self.cell_m).floor();
        let high = ((p + radius_m - self.min) / self.cell_m).floor();
        if high.min_element() < 0.0 || low.x >= self.columns as f64 || low.y >= self.rows as f64 {
            return;
        }
        // Float to integer conversion saturates, so that far away is the border.
        let (left, bottom) = (low.x.max(0.0) as usize, low.y.max(0.0) as usize);
        let (right, top) = (high.x as usize, high.y as usize);
        let square = radius_m * radius_m;
        for row in bottom..=top.min(self.rows - 1) {
            // The cells of a row lie side by side in the list.
            let row = row * self.columns;
            let from = self.starts[row + left] as usize;
            let to = self.starts[row + right.min(self.columns - 1) + 1] as usize;
            for (q, id) in &self.entries[from..to] {
                if q.distance_squared(p) <= square {
                    visit(*id);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn it_finds_what_a_walk_over_all_points_finds(
            points in proptest::collection::vec((-900.0..900.0_f64, -90.0..5_000.0_f64), 0..80),
            (x, y) in (-1_000.0..1_000.0_f64, -200.0..5_200.0_f64),
            radius_m in 0.0..800.0_f64,
            cell_m in 1.0..500.0_f64,
        ) {
            let points: Vec<Vec2> = points.into_iter().map(|(x, y)| Vec2::new(x, y)).collect();
            let p = Vec2::new(x, y);
            let mut found = Vec::new();
            PointGrid::new(&points, cell_m).visit(p, radius_m, |id| found.push(id));
            found.sort_unstable();
            let near = (0..).zip(&points).filter(|(_, q)| q.distance_squared(p) <= radius_m * radius_m);
            let expected: Vec<u32> = near.map(|(id, _)| id).collect();
            prop_assert_eq!(found, expected);
        }
    }
}
