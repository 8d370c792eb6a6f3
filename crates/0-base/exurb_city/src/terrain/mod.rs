//! The ground of a city: heights on a regular grid of its frame.
//!
//! Heights stand at *posts*. Post (0, 0) is the south-west one; columns count eastwards, rows
//! northwards, and the list of heights runs row by row from the south. (Rasters in files run from
//! the north: readers and writers turn the rows.) As a raster, a post is the middle of its cell.
//! Heights are metres above the terrain's own zero, usually the sea's level; a height that is not
//! known is NaN, and [`Terrain`] never holds infinities.
//!
//! | part | what it holds |
//! |---|---|
//! | [`Terrain`] | the grid |
//! | `sample` | height, gradient and slope at a place |
//! | `area` | statistics over polygons: what is missing, mean, lowest |
//! | `derive` | other terrains: cut out, resampled, gaps filled |
//! | `lay` | putting a terrain under a city: water, heights of junctions |
//! | `sketched` | plausible ground for a sketch of land uses |

mod area;
mod changed;
mod derive;
mod lay;
mod sample;
mod sketched;
#[cfg(test)]
mod tests;

use exurb_geom::grid::LIMIT_MM;
use exurb_geom::{Bounds, GridPoint, Vec2};

pub use area::Relief;
pub use changed::changed;
pub use lay::elevate;
pub use sketched::{SKETCH_CELL_M, SketchedUse, sketched, sketched_areas};

/// Heights beyond this many metres are slips of a file and count as missing.
const HIGHEST_M: f32 = 20_000.0;
/// Most posts of a terrain: 256 MB of heights.
const MOST_POSTS: usize = 1 << 26;

/// Heights on a square grid of a city's frame.
#[derive(Clone, Debug)]
pub struct Terrain {
    first: GridPoint,
    cell_mm: u32,
    columns: usize,
    heights: Vec<f32>,
    range_m: (f32, f32),
    water_level_m: Option<f64>,
}

/// Why heights are no terrain.
#[derive(Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "the messages say it")]
pub enum TerrainError {
    #[error("a terrain needs two columns and rows of heights, not {columns} x {rows}")]
    Size { columns: usize, rows: usize },
    #[error("{0} heights are no whole rows")]
    Rows(usize),
    #[error("a terrain has at most {MOST_POSTS} heights, not {0}; take a larger cell")]
    TooMany(usize),
    #[error("the terrain's cells of {0} m reach too far from the city's origin")]
    Reach(f64),
    #[error("no height is known")]
    Empty,
}

impl Terrain {
    /// A terrain whose south-west post is `first`, with posts `cell_mm` millimetres apart and
    /// `columns` of them in each row of `heights`, from the south. What is not finite or beyond
    /// 20 km is missing.
    pub fn new(
        first: GridPoint,
        cell_mm: u32,
        columns: usize,
        mut heights: Vec<f32>,
    ) -> Result<Self, TerrainError> {
        let rows = heights.len().checked_div(columns).unwrap_or(0);
        if columns < 2 || rows < 2 {
            return Err(TerrainError::Size { columns, rows });
        }
        if rows * columns != heights.len() {
            return Err(TerrainError::Rows(heights.len()));
        }
        if heights.len() > MOST_POSTS {
            return Err(TerrainError::TooMany(heights.len()));
        }
        let last = |from: i32, n: usize| i64::from(from) + i64::from(cell_mm) * (n as i64 - 1);
        let farthest = last(first.x, columns).max(last(first.y, rows));
        let nearest = i64::from(first.x.min(first.y));
        if cell_mm == 0 || farthest > i64::from(LIMIT_MM) || nearest < -i64::from(LIMIT_MM) {
            return Err(TerrainError::Reach(f64::from(cell_mm) / 1000.0));
        }
        let mut range_m = (f32::INFINITY, f32::NEG_INFINITY);
        for height in &mut heights {
            if height.abs() <= HIGHEST_M {
                range_m = (range_m.0.min(*height), range_m.1.max(*height));
            } else {
                *height = f32::NAN;
            }
        }
        if range_m.0 > range_m.1 {
            return Err(TerrainError::Empty);
        }
        Ok(Self { first, cell_mm, columns, heights, range_m, water_level_m: None })
    }

    /// The terrain over `bounds` whose posts, about `cell_m` metres apart (rounded to the
    /// millimetre), have the heights `height_m` gives for their places.
    pub fn over(
        bounds: Bounds,
        cell_m: f64,
        mut height_m: impl FnMut(Vec2) -> f32,
    ) -> Result<Self, TerrainError> {
        let (first, cell_mm, columns, rows) = Self::grid_over(bounds, cell_m)?;
        let place = |i: usize| post(first, cell_mm, i % columns, i / columns);
        let heights = (0..columns * rows).map(|i| height_m(place(i))).collect();
        Self::new(first, cell_mm, columns, heights)
    }

    /// South-west post, cell in millimetres, columns and rows of the grid that covers `bounds` with
    /// cells of about `cell_m` metres.
    pub fn grid_over(
        bounds: Bounds,
        cell_m: f64,
    ) -> Result<(GridPoint, u32, usize, usize), TerrainError> {
        let first = GridPoint::round(bounds.min);
        let cell_mm = (cell_m * 1000.0).round().clamp(1.0, f64::from(LIMIT_MM)) as u32;
        let size_mm = (bounds.max - first.to_m()) * 1000.0;
        // A thousandth of a cell less does not need another one.
        let count = |mm: f64| (mm / f64::from(cell_mm) - 0.001).ceil().max(1.0) as usize + 1;
        let (columns, rows) = (count(size_mm.x), count(size_mm.y));
        match columns.checked_mul(rows) {
            Some(n) if n <= MOST_POSTS => Ok((first, cell_mm, columns, rows)),
            _ => Err(TerrainError::TooMany(columns.saturating_mul(rows))),
        }
    }

    /// The same terrain with everything up to `level_m` under water; see [`crate::City::lay`].
    #[must_use]
    pub fn with_water_level(mut self, level_m: Option<f64>) -> Self {
        self.water_level_m = level_m.filter(|level| level.is_finite());
        self
    }

    /// The south-west post.
    pub fn first(&self) -> GridPoint {
        self.first
    }

    /// Distance of neighbouring posts in millimetres.
    pub fn cell_mm(&self) -> u32 {
        self.cell_mm
    }

    /// Distance of neighbouring posts in metres.
    pub fn cell_m(&self) -> f64 {
        f64::from(self.cell_mm) / 1000.0
    }

    /// Posts in a row.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.heights.len() / self.columns
    }

    /// All heights, row by row from the south-west; NaN where not known.
    pub fn heights(&self) -> &[f32] {
        &self.heights
    }

    /// Lowest and highest known height.
    pub fn range_m(&self) -> (f32, f32) {
        self.range_m
    }

    /// Everything up to here is under water.
    pub fn water_level_m(&self) -> Option<f64> {
        self.water_level_m
    }

    /// The place of a post.
    pub fn post(&self, column: usize, row: usize) -> Vec2 {
        post(self.first, self.cell_mm, column, row)
    }

    /// Where heights are known at most: from the first post to the last.
    pub fn bounds(&self) -> Bounds {
        Bounds { min: self.first.to_m(), max: self.post(self.columns - 1, self.rows() - 1) }
    }

    /// Number of posts without a height.
    pub fn missing(&self) -> usize {
        self.heights.iter().filter(|h| h.is_nan()).count()
    }
}

fn post(first: GridPoint, cell_mm: u32, column: usize, row: usize) -> Vec2 {
    let at = |from: i32, n: usize| (f64::from(from) + f64::from(cell_mm) * n as f64) / 1000.0;
    Vec2::new(at(first.x, column), at(first.y, row))
}

/// Equal when places, heights and water level are; missing heights are equal.
impl PartialEq for Terrain {
    fn eq(&self, other: &Self) -> bool {
        let same = |(a, b): (&f32, &f32)| a == b || (a.is_nan() && b.is_nan());
        (self.first, self.cell_mm, self.columns) == (other.first, other.cell_mm, other.columns)
            && self.water_level_m == other.water_level_m
            && self.heights.len() == other.heights.len()
            && self.heights.iter().zip(&other.heights).all(same)
    }
}
