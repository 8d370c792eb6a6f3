//! From a raster in its own coordinates to a terrain in a city's frame.

use exurb_city::{Terrain, TerrainError};
use exurb_geom::{Bounds, Frame, GridPoint, LonLat, Vec2};
use rayon::prelude::*;

use crate::dem::Place;
use crate::{Dem, Error};

/// Most posts of a terrain: finer rasters are averaged over larger cells.
const MOST_POSTS: f64 = 16e6;
/// No height map has pixels smaller than this, in metres.
const LEAST_PIXEL_M: f64 = 0.001;
/// Finer cells say nothing of a city.
const LEAST_CELL_M: f64 = 0.5;
/// Nearer than this many pixels to a pixel's middle, its height is taken as it is.
const ON_PIXEL: f64 = 1e-4;

impl Dem {
    /// The terrain over `bounds` in the frame, with posts `cell_m` apart, or as far apart as the
    /// raster's pixels (to three digits); farther where there would be more than 16 million.
    ///
    /// Heights are cubic between pixels, never beyond those around; linear and then nearest where
    /// some of these are missing. Pixels finer than the posts are averaged. On a raster in the
    /// frame's own plane the posts are its pixels. O(posts).
    pub fn onto(
        &self,
        frame: &Frame,
        bounds: Bounds,
        cell_m: Option<f64>,
    ) -> Result<Terrain, Error> {
        let error = |source| Error::Terrain { file: self.file.clone(), source };
        let map = Mapping { dem: self, frame, bounds };
        let pixel_m = map.pixel_m(bounds).ok_or_else(|| self.elsewhere(frame, bounds))?;
        if pixel_m < LEAST_PIXEL_M {
            let what = format!("has pixels of {pixel_m:e} m; what it says of its place is wrong");
            return Err(Error::content(&self.file, what));
        }
        let (first, cell_m) = match (cell_m, map.aligned(pixel_m)) {
            (Some(cell_m), _) => (bounds.min, cell_m),
            (None, Some(first)) => (first, pixel_m),
            (None, None) => (bounds.min, rounded(pixel_m.max(LEAST_CELL_M))),
        };
        let size = bounds.max - first;
        let cell_m = cell_m.max((size.x * size.y / MOST_POSTS).sqrt());
        let over = Bounds { min: first, max: bounds.max };
        let (first, cell_mm, columns, rows) = Terrain::grid_over(over, cell_m).map_err(error)?;
        let fine = (f64::from(cell_mm) / 1000.0 / pixel_m / 1.2).ceil().clamp(1.0, 16.0) as usize;
        let heights: Vec<f32> = (0..rows)
            .into_par_iter()
            .flat_map_iter(|row| (0..columns).map(move |column| (column, row)))
            .map(|(column, row)| map.height(&Post { first, cell_mm, column, row }, fine))
            .collect();
        match Terrain::new(first, cell_mm, columns, heights) {
            Err(TerrainError::Empty) => Err(self.elsewhere(frame, bounds)),
            other => other.map_err(error),
        }
    }

    fn elsewhere(&self, frame: &Frame, bounds: Bounds) -> Error {
        let words =
            |[a, b]: [LonLat; 2]| format!("{:.4},{:.4},{:.4},{:.4}", a.lon, a.lat, b.lon, b.lat);
        let city = words([frame.unproject(bounds.min), frame.unproject(bounds.max)]);
        let what = match self.extent() {
            Some(extent) => format!("it covers {}, the city {city}", words(extent)),
            None => format!("the city covers {city}"),
        };
        Error::Elsewhere { file: self.file.clone(), what }
    }
}

/// Three digits.
fn rounded(metres: f64) -> f64 {
    let mut unit = 0.001;
    while metres / unit >= 1000.0 {
        unit *= 10.0;
    }
    (metres / unit).round() * unit
}

/// A post of the terrain to be.
struct Post {
    first: GridPoint,
    cell_mm: u32,
    column: usize,
    row: usize,
}

impl Post {
    /// A place around it, by shares of a cell.
    fn at(&self, dx: f64, dy: f64) -> Vec2 {
        let step = f64::from(self.cell_mm);
        let mm = |first: i32, n: usize, d: f64| f64::from(first) + step * (n as f64 + d);
        Vec2::new(mm(self.first.x, self.column, dx), mm(self.first.y, self.row, dy)) / 1000.0
    }
}

/// From the frame to columns and rows of the raster.
struct Mapping<'a> {
    dem: &'a Dem,
    frame: &'a Frame,
    /// What a raster without a place is stretched over.
    bounds: Bounds,
}

impl Mapping<'_> {
    /// Column and row of a place.
    fn pixel(&self, p: Vec2) -> Option<Vec2> {
        match &self.dem.place {
            Place::Stretched => {
                let share = (p - self.bounds.min) / (self.bounds.max - self.bounds.min);
                let size = Vec2::new(self.dem.columns as f64, self.dem.rows() as f64);
                // Edges are those of the outer pixels.
                Some(Vec2::new(share.x, 1.0 - share.y) * size - 0.5)
            }
            Place::Georeferenced { affine, crs } => {
                let (x, y) = crs.from_lonlat(self.frame.unproject(p))?;
                affine.inverse(x, y).map(|(column, row)| Vec2::new(column, row))
            }
        }
    }

    /// Change of column and row for each metre east, and for each metre north.
    fn slopes(&self, p: Vec2) -> Option<(Vec2, Vec2)> {
        const STEP_M: f64 = 50.0;
        let slope =
            |step: Vec2| Some((self.pixel(p + step)? - self.pixel(p - step)?) / (2.0 * STEP_M));
        Some((slope(Vec2::X * STEP_M)?, slope(Vec2::Y * STEP_M)?))
    }

    /// The smaller side of a pixel in metres.
    fn pixel_m(&self, bounds: Bounds) -> Option<f64> {
        let (east, north) = self.slopes(bounds.center())?;
        let column = Vec2::new(east.x, north.x).length();
        let row = Vec2::new(east.y, north.y).length();
        let pixel_m = 1.0 / column.max(row);
        (pixel_m.is_finite() && pixel_m > 0.0).then_some(pixel_m)
    }

    /// Where the raster's pixels are those of the plane, the first post on one of them.
    fn aligned(&self, pixel_m: f64) -> Option<Vec2> {
        let Bounds { min, max } = self.bounds;
        let whole_mm = (pixel_m * 1000.0).round() / 1000.0;
        let off = (whole_mm - pixel_m).abs() / pixel_m;
        let (low, high) = (self.pixel(min)?, self.pixel(max)?);
        let expected = Vec2::new(max.x - min.x, min.y - max.y) / whole_mm;
        let straight = (high - low - expected).abs().max_element() < 0.01;
        let after = |v: f64| (v - (v + 0.001).floor()).max(0.0);
        let beyond = Vec2::new(after(low.x), after(-low.y)) * whole_mm;
        (straight && off < 1e-6 && !matches!(self.dem.place, Place::Stretched))
            .then_some(min - beyond)
    }

    /// The height at a post: a mean over its cell where pixels are finer.
    fn height(&self, post: &Post, fine: usize) -> f32 {
        if fine <= 1 {
            return self.pixel(post.at(0.0, 0.0)).map_or(f32::NAN, |p| self.dem.height(p));
        }
        let share = |k: usize| (k as f64 + 0.5) / fine as f64 - 0.5;
        let (mut sum, mut count) = (0.0, 0.0);
        for k in 0..fine * fine {
            let p = self.pixel(post.at(share(k % fine), share(k / fine)));
            let height = p.map_or(f32::NAN, |p| self.dem.height(p));
            if height.is_finite() {
                (sum, count) = (sum + height, count + 1.0);
            }
        }
        sum / count
    }
}

impl Dem {
    /// The height at a column and row, cubic (Catmull and Rom) where the sixteen pixels around are
    /// known, within their range; else linear between four; else the nearest; else NaN.
    fn height(&self, p: Vec2) -> f32 {
        let last = Vec2::new(self.columns as f64, self.rows() as f64) - 1.0;
        let inside = p.cmpge(Vec2::splat(-0.5)).all() && p.cmple(last + 0.5).all();
        if !inside {
            return f32::NAN;
        }
        let nearest = p.round().clamp(Vec2::ZERO, last);
        if (p - nearest).abs().max_element() < ON_PIXEL {
            return self.known(nearest.x as i64, nearest.y as i64);
        }
        let p = p.clamp(Vec2::ZERO, last);
        let low = p.floor();
        let share = p - low;
        let (x, y) = (low.x as i64, low.y as i64);
        let mut around = [[f64::NAN; 4]; 4];
        for (j, row) in around.iter_mut().enumerate() {
            for (i, height) in row.iter_mut().enumerate() {
                *height = f64::from(self.known(x + i as i64 - 1, y + j as i64 - 1));
            }
        }
        let cubic = weighted(&around, catmull_rom(share.x), catmull_rom(share.y));
        if cubic.is_finite() {
            let all = || around.iter().flatten().copied();
            let (least, most) =
                (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
            return cubic.clamp(least, most) as f32;
        }
        let linear = |t: f64| [0.0, 1.0 - t, t, 0.0];
        let linear = weighted(&around, linear(share.x), linear(share.y));
        if linear.is_finite() {
            linear as f32
        } else {
            self.known(nearest.x as i64, nearest.y as i64)
        }
    }

    fn known(&self, column: i64, row: i64) -> f32 {
        let inside =
            (0..self.columns as i64).contains(&column) && (0..self.rows() as i64).contains(&row);
        if inside { self.heights[row as usize * self.columns + column as usize] } else { f32::NAN }
    }
}

/// The sum of heights by their weights; those of weight 0 do not count.
fn weighted(heights: &[[f64; 4]; 4], across: [f64; 4], down: [f64; 4]) -> f64 {
    let mut sum = 0.0;
    for (row, of_row) in heights.iter().zip(down).filter(|(_, w)| *w != 0.0) {
        for (height, of_column) in row.iter().zip(across).filter(|(_, w)| *w != 0.0) {
            sum += height * of_column * of_row;
        }
    }
    sum
}

/// Weights of four neighbours, the place lying `t` of the way from the second to the third.
fn catmull_rom(t: f64) -> [f64; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [
        (-t3 + 2.0 * t2 - t) / 2.0,
        (3.0 * t3 - 5.0 * t2 + 2.0) / 2.0,
        (-3.0 * t3 + 4.0 * t2 + t) / 2.0,
        (t3 - t2) / 2.0,
    ]
}
