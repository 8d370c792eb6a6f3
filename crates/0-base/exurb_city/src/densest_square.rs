//! The densest square of a map, which stands for a city in comparisons (fidelity: all windows of
//! one comparison have the same size; a real city's is the square that holds most street length).

use exurb_geom::{Bounds, GridPoint, Vec2, polyline};

use crate::{City, Part};

/// Side of the square in metres.
pub const SIDE_M: f64 = 5000.0;
/// Cells of the search are as small as keeps their number below this.
const MOST_CELLS: f64 = 4e6;

/// The axis-parallel square of 5 km that holds most length of the given streets, or all of `extent`
/// along the sides where that is shorter. Places are tried every 50 m (coarser above 100 km), ties
/// go to the south-west. O(street length + cells).
pub fn densest_square<'a>(
    streets: impl IntoIterator<Item = &'a [GridPoint]>,
    extent: Bounds,
) -> Bounds {
    let size = extent.size();
    // Cells divide the side evenly.
    let fits = |cell: &f64| (size.x / cell) * (size.y / cell) < MOST_CELLS;
    let cell_m = [50.0, 100.0, 250.0, 500.0, 1000.0].into_iter().find(fits).unwrap_or(SIDE_M);
    let cells = |length: f64| ((length / cell_m) as usize + 1).min(1 << 12);
    let (columns, rows) = (cells(size.x), cells(size.y));
    let sums = prefix_sums(&lengths(streets, extent, cell_m, columns, rows), columns, rows);

    let steps = |length: f64| ((length - SIDE_M) / cell_m).max(0.0) as usize;
    let reach = |length: f64| ((SIDE_M.min(length) / cell_m).ceil() as usize).max(1);
    let (dx, dy) = (reach(size.x), reach(size.y));
    let sum = |x: usize, y: usize| {
        let (x1, y1) = ((x + dx).min(columns), (y + dy).min(rows));
        let at = |x: usize, y: usize| sums[y * (columns + 1) + x];
        at(x1, y1) - at(x, y1) - at(x1, y) + at(x, y)
    };
    let mut best = (f64::NEG_INFINITY, Vec2::ZERO);
    for y in 0..=steps(size.y).min(rows - 1) {
        for x in 0..=steps(size.x).min(columns - 1) {
            // Rounding of sums must not decide between equals.
            if sum(x, y) > best.0 + 1e-3 {
                best = (sum(x, y), Vec2::new(x as f64, y as f64) * cell_m);
            }
        }
    }
    let min = extent.min + best.1;
    Bounds { min, max: (min + SIDE_M).min(extent.max) }
}

/// Street length by cell, row by row from the south-west.
fn lengths<'a>(
    streets: impl IntoIterator<Item = &'a [GridPoint]>,
    extent: Bounds,
    cell_m: f64,
    columns: usize,
    rows: usize,
) -> Vec<f64> {
    let mut out = vec![0.0; columns * rows];
    for line in streets {
        for w in line.windows(2) {
            for piece in polyline::resample(&[w[0].to_m(), w[1].to_m()], cell_m / 2.0).windows(2) {
                let middle = (piece[0] + piece[1]) / 2.0;
                if extent.contains(middle) {
                    let at = (middle - extent.min) / cell_m;
                    let (x, y) = ((at.x as usize).min(columns - 1), (at.y as usize).min(rows - 1));
                    out[y * columns + x] += piece[0].distance(piece[1]);
                }
            }
        }
    }
    out
}

/// `sums[y][x]` is the sum of all cells south-west of cell corner (x, y).
fn prefix_sums(cells: &[f64], columns: usize, rows: usize) -> Vec<f64> {
    let wide = columns + 1;
    let mut sums = vec![0.0; wide * (rows + 1)];
    for y in 0..rows {
        let mut row = 0.0;
        for x in 0..columns {
            row += cells[y * columns + x];
            sums[(y + 1) * wide + x + 1] = sums[y * wide + x + 1] + row;
        }
    }
    sums
}

/// The densest square of a city's own streets.
pub fn of_city(city: &City) -> Bounds {
    densest_square(city.streets.edges().map(|(_, e)| e.line()), city.target.bounds())
}

/// That half of a box.
pub fn half(bounds: Bounds, part: Part) -> Bounds {
    let Bounds { mut min, mut max } = bounds;
    let middle = bounds.center();
    match part {
        Part::West => max.x = middle.x,
        Part::East => min.x = middle.x,
        Part::South => max.y = middle.y,
        Part::North => min.y = middle.y,
    }
    Bounds { min, max }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(a: (f64, f64), b: (f64, f64)) -> [GridPoint; 2] {
        [GridPoint::m(a.0, a.1), GridPoint::m(b.0, b.1)]
    }

    #[test]
    fn the_square_moves_to_the_streets() {
        let extent = Bounds { min: Vec2::ZERO, max: Vec2::new(20_000.0, 7_000.0) };
        let streets = [
            line((100.0, 3000.0), (19_000.0, 3000.0)),
            line((12_010.0, 2_510.0), (16_990.0, 6_990.0)),
        ];
        let found = densest_square(streets.iter().map(|l| &l[..]), extent);
        assert_eq!(found.size(), Vec2::splat(SIDE_M));
        assert!(found.contains(Vec2::new(12_010.0, 2_510.0)), "{found:?}");
        assert!(found.contains(Vec2::new(16_990.0, 6_990.0)), "{found:?}");
    }

    #[test]
    fn a_small_map_is_its_own_square_and_halves_meet() {
        let extent = Bounds { min: Vec2::new(-900.0, 0.0), max: Vec2::new(900.0, 8_000.0) };
        let found = densest_square([&line((0.0, 7_990.0), (10.0, 7_990.0))[..]], extent);
        assert_eq!((found.min.x, found.max.x, found.max.y), (-900.0, 900.0, 8_000.0));
        assert_eq!(half(found, Part::West).max.x, half(found, Part::East).min.x);
        assert_eq!(half(found, Part::South).max.y, half(found, Part::North).min.y);
    }
}
