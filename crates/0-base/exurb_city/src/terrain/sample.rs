//! Height, gradient and slope at a place. O(1): a few posts each.

use exurb_geom::Vec2;

use super::Terrain;

/// Where a place lies in the grid: its cell's south-west post and the shares of the way across.
struct At {
    column: usize,
    row: usize,
    share: Vec2,
}

impl Terrain {
    /// The height at `p`, bilinear between the four posts around it; `None` outside the grid and
    /// where one of them is missing.
    pub fn height_m(&self, p: Vec2) -> Option<f64> {
        let at = self.at(p)?;
        let height = at.blend(|dx, dy| f64::from(self.known(at.column + dx, at.row + dy)));
        (!height.is_nan()).then_some(height)
    }

    /// The gradient at `p`: uphill, as rise over run. Bilinear between those of the four posts
    /// around it, which are central differences, so that it has no steps. `None` as for
    /// [`Terrain::height_m`].
    pub fn gradient(&self, p: Vec2) -> Option<Vec2> {
        let at = self.at(p)?;
        let gradient = at.blend(|dx, dy| self.post_gradient(at.column + dx, at.row + dy));
        (!gradient.is_nan()).then_some(gradient)
    }

    /// The slope at `p`, rise over run: 1 is 45 degrees.
    pub fn slope(&self, p: Vec2) -> Option<f64> {
        self.gradient(p).map(Vec2::length)
    }

    /// The gradient at a post, by its neighbours; NaN where the post is missing, one-sided beside a
    /// missing neighbour and at the grid's edge, 0 along an axis without any.
    pub fn post_gradient(&self, column: usize, row: usize) -> Vec2 {
        let here = self.known(column, row);
        let known = |column: usize, row: usize| {
            let there = column < self.columns && row < self.rows();
            Some(f64::from(if there { self.known(column, row) } else { f32::NAN }))
                .filter(|h| !h.is_nan())
        };
        let slope = |before: Option<f64>, after: Option<f64>| {
            let here = f64::from(here);
            match (before, after) {
                (Some(a), Some(b)) => (b - a) / 2.0,
                (Some(a), None) => here - a,
                (None, Some(b)) => b - here,
                (None, None) => 0.0,
            }
        };
        let (west, south) = (column.wrapping_sub(1), row.wrapping_sub(1));
        let x = slope(known(west, row), known(column + 1, row));
        let y = slope(known(column, south), known(column, row + 1));
        if here.is_nan() { Vec2::NAN } else { Vec2::new(x, y) / self.cell_m() }
    }

    fn known(&self, column: usize, row: usize) -> f32 {
        self.heights[row * self.columns + column]
    }

    fn at(&self, p: Vec2) -> Option<At> {
        let grid = (p * 1000.0 - self.first_mm()) / f64::from(self.cell_mm);
        let last = Vec2::new(self.columns as f64, self.rows() as f64) - 1.0;
        if !(grid.cmpge(Vec2::ZERO).all() && grid.cmple(last).all()) {
            return None;
        }
        // On the last column and row the cell before is asked.
        let (column, row) =
            ((grid.x as usize).min(self.columns - 2), (grid.y as usize).min(self.rows() - 2));
        Some(At { column, row, share: grid - Vec2::new(column as f64, row as f64) })
    }

    fn first_mm(&self) -> Vec2 {
        Vec2::new(f64::from(self.first.x), f64::from(self.first.y))
    }
}

impl At {
    /// The four posts' values by their shares. A post of no share does not count.
    fn blend<V>(&self, value: impl Fn(usize, usize) -> V) -> V
    where
        V: std::ops::Mul<f64, Output = V> + std::ops::Add<Output = V>,
    {
        let Vec2 { x, y } = self.share;
        let along = |dy: usize| match x {
            0.0 => value(0, dy),
            1.0 => value(1, dy),
            _ => value(0, dy) * (1.0 - x) + value(1, dy) * x,
        };
        match y {
            0.0 => along(0),
            1.0 => along(1),
            _ => along(0) * (1.0 - y) + along(1) * y,
        }
    }
}
