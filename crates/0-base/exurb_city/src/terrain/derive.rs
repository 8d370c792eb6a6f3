//! Terrains made of a terrain.

use exurb_geom::Bounds;

use super::{Terrain, TerrainError};

impl Terrain {
    /// The part over `bounds`, whole cells, no smaller than a cell; `None` when they share no
    /// ground or nothing is known there.
    pub fn crop(&self, bounds: Bounds) -> Option<Self> {
        let cell = self.cell_m();
        let origin = self.first.to_m();
        let (low, high) = ((bounds.min - origin) / cell, (bounds.max - origin) / cell);
        let range = |low: f64, high: f64, count: usize| {
            let last = (count - 1) as f64;
            let (from, to) = (low.floor().max(0.0), high.ceil().min(last));
            (from < to).then_some((from as usize, to as usize))
        };
        let (west, east) = range(low.x, high.x, self.columns)?;
        let (south, north) = range(low.y, high.y, self.rows())?;
        let row = |row: usize| &self.heights[row * self.columns..][west..=east];
        let heights = (south..=north).flat_map(row).copied().collect();
        let first = exurb_geom::GridPoint::round(self.post(west, south));
        let part = Self::new(first, self.cell_mm, east - west + 1, heights).ok()?;
        Some(part.with_water_level(self.water_level_m))
    }

    /// The same ground over `bounds` with another cell, bilinear; missing where it was.
    pub fn resample(&self, bounds: Bounds, cell_m: f64) -> Result<Self, TerrainError> {
        let height = |p| self.height_m(p).map_or(f32::NAN, |h| h as f32);
        Ok(Self::over(bounds, cell_m, height)?.with_water_level(self.water_level_m))
    }

    /// The same terrain with heights in its gaps, smooth and no higher or lower than the known ones
    /// around: known heights are averaged over cells of twice the size until no gap is left, and
    /// gaps take over what the larger cells have, bilinear, from the largest down (push and pull).
    /// O(posts).
    #[must_use]
    pub fn filled(&self) -> Self {
        let mut heights = self.heights.clone();
        fill(&mut heights, self.columns);
        Self { heights, ..self.clone() }
    }
}

fn fill(heights: &mut [f32], columns: usize) {
    let rows = heights.len() / columns;
    if !heights.iter().any(|h| h.is_nan()) || columns * rows <= 1 {
        return;
    }
    let (wide, high) = (columns.div_ceil(2), rows.div_ceil(2));
    let mut coarse: Vec<f32> = (0..wide * high)
        .map(|i| {
            let (x, y) = (i % wide * 2, i / wide * 2);
            let cell = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
            let there = cell.iter().filter(|(x, y)| *x < columns && *y < rows);
            mean(there.map(|(x, y)| heights[y * columns + x]))
        })
        .collect();
    fill(&mut coarse, wide);
    for (i, height) in heights.iter_mut().enumerate().filter(|(_, h)| h.is_nan()) {
        *height = between(&coarse, wide, (i % columns, i / columns));
    }
}

fn mean(heights: impl Iterator<Item = f32>) -> f32 {
    let known = heights.filter(|h| !h.is_nan());
    let (sum, count) = known.fold((0.0, 0.0), |(sum, count), h| (sum + h, count + 1.0));
    sum / count
}

/// The coarse values at a post of the finer grid, whose posts lie a quarter off theirs.
fn between(coarse: &[f32], wide: usize, (x, y): (usize, usize)) -> f32 {
    let high = coarse.len() / wide;
    // The nearer post has three quarters, its neighbour on the other side one.
    let pair = |k: usize, count: usize| {
        let other = if k.is_multiple_of(2) { (k / 2).saturating_sub(1) } else { k / 2 + 1 };
        [(k / 2, 0.75_f32), (other.min(count - 1), 0.25)]
    };
    let mut sum = 0.0;
    for (row, of_row) in pair(y, high) {
        for (column, of_column) in pair(x, wide) {
            sum += coarse[row * wide + column] * of_row * of_column;
        }
    }
    sum
}
