//! A square grid of cells, and which of them a polygon covers or a segment passes.

use crate::{Bounds, Polygon, Vec2};

/// Cells between posts, columns and rows counted from the south-west.
#[derive(Clone, Debug, PartialEq)]
pub struct Cells {
    low: Vec2,
    step_m: f64,
    columns: usize,
    rows: usize,
}

/// How a cell lies to a polygon that it shares ground with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cell {
    /// All of it lies inside.
    Inside,
    /// The polygon's boundary runs through it.
    Rim {
        /// Does its middle lie inside?
        middle: bool,
    },
}

impl Cells {
    /// A grid over all of `bounds`.
    pub fn over(bounds: Bounds, step_m: f64) -> Self {
        let size = bounds.size() / step_m;
        let count = |v: f64| (v - 1e-6).ceil().max(1.0) as usize;
        Self { low: bounds.min, step_m, columns: count(size.x), rows: count(size.y) }
    }

    /// Width of a cell in metres.
    pub fn step_m(&self) -> f64 {
        self.step_m
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns and rows.
    pub fn size(&self) -> Vec2 {
        Vec2::new(self.columns as f64, self.rows as f64)
    }

    /// The cell that holds a place; `None` outside.
    pub fn at(&self, p: Vec2) -> Option<(usize, usize)> {
        let place = self.place(p);
        let inside = place.cmpge(Vec2::ZERO).all() && place.cmplt(self.size()).all();
        inside.then_some((place.x as usize, place.y as usize))
    }

    /// The middle of a cell.
    pub fn middle(&self, (column, row): (usize, usize)) -> Vec2 {
        self.back(Vec2::new(column as f64, row as f64) + 0.5)
    }

    /// Column and row of a place, with parts.
    pub fn place(&self, p: Vec2) -> Vec2 {
        (p - self.low) / self.step_m
    }

    /// The place of a column and row.
    pub fn back(&self, place: Vec2) -> Vec2 {
        self.low + place * self.step_m
    }

    /// All posts, row by row.
    pub fn posts(&self) -> impl Iterator<Item = Vec2> + '_ {
        (0..(self.columns + 1) * (self.rows + 1)).map(|post| self.post(post))
    }

    /// The place of a post.
    pub fn post(&self, post: usize) -> Vec2 {
        let (column, row) = (post % (self.columns + 1), post / (self.columns + 1));
        self.back(Vec2::new(column as f64, row as f64))
    }

    /// Posts of a cell: south-west, south-east, north-east, north-west.
    pub fn corners(&self, (column, row): (usize, usize)) -> [usize; 4] {
        let sw = row * (self.columns + 1) + column;
        let nw = sw + self.columns + 1;
        [sw, sw + 1, nw + 1, nw]
    }

    /// The cells that share ground with a polygon, row by row. O(cells + cells along its boundary).
    pub fn of(&self, polygon: &Polygon) -> Vec<((usize, usize), Cell)> {
        let mut rim: Vec<(usize, usize)> = Vec::new();
        for (a, b) in polygon.segments() {
            self.along(a.to_m(), b.to_m(), |cell| rim.push(cell));
        }
        // By rows, so that the inside can be found between the boundary's crossings.
        rim.sort_unstable_by_key(|(column, row)| (*row, *column));
        rim.dedup();
        let bounds = polygon.bounds();
        let low = self.place(bounds.min).clamp(Vec2::ZERO, self.size());
        let high = self.place(bounds.max).clamp(Vec2::ZERO, self.size());
        let (first, last) = (low.y as usize, (high.y.floor() as usize + 1).min(self.rows));
        let crossings = self.crossings(polygon, first, last);
        let mut out = Vec::new();
        let mut at = 0;
        for row in first..last {
            let mut passed = 0;
            let crossings = &crossings[row - first];
            for column in low.x as usize..(high.x.floor() as usize + 1).min(self.columns) {
                let middle = column as f64 + 0.5;
                passed += crossings[passed..].iter().take_while(|c| **c < middle).count();
                let middle = !passed.is_multiple_of(2);
                if rim.get(at) == Some(&(column, row)) {
                    at += 1;
                    out.push(((column, row), Cell::Rim { middle }));
                } else if middle {
                    out.push(((column, row), Cell::Inside));
                }
            }
        }
        out
    }

    /// For the rows of a range the columns where the boundary crosses their middle lines, ascending.
    fn crossings(&self, polygon: &Polygon, first: usize, last: usize) -> Vec<Vec<f64>> {
        let mut crossings = vec![Vec::new(); last - first];
        for (a, b) in polygon.segments() {
            let (a, b) = (self.place(a.to_m()), self.place(b.to_m()));
            let from = (a.y.min(b.y) - 0.5).ceil().max(first as f64) as usize;
            for (row, columns) in crossings.iter_mut().enumerate().skip(from - first) {
                let y = (row + first) as f64 + 0.5;
                if y >= a.y.max(b.y) {
                    break;
                }
                if (a.y > y) != (b.y > y) {
                    columns.push(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
                }
            }
        }
        crossings.iter_mut().for_each(|columns| columns.sort_by(f64::total_cmp));
        crossings
    }

    /// Visits the cells that a segment passes or touches, column by column.
    pub fn along(&self, a: Vec2, b: Vec2, mut visit: impl FnMut((usize, usize))) {
        const HAIR: f64 = 1e-6;
        let (a, b) = (self.place(a), self.place(b));
        let (a, b) = if a.x <= b.x { (a, b) } else { (b, a) };
        let range = |low: f64, high: f64, count: usize| {
            let from = (low - HAIR).floor().clamp(0.0, count as f64) as usize;
            let to = ((high + HAIR).floor() + 1.0).clamp(0.0, count as f64) as usize;
            from..to
        };
        for column in range(a.x, b.x, self.columns) {
            let y_at = |x: f64| match b.x - a.x {
                0.0 => None,
                width => Some(a.y + (b.y - a.y) * ((x - a.x) / width).clamp(0.0, 1.0)),
            };
            let (p, q) = match (y_at(column as f64 - HAIR), y_at(column as f64 + 1.0 + HAIR)) {
                (Some(p), Some(q)) => (p, q),
                _ => (a.y, b.y),
            };
            range(p.min(q), p.max(q), self.rows).for_each(|row| visit((column, row)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::GridPoint;

    #[test]
    fn cells_inside_and_on_the_rim_are_told_apart() {
        let ring = [(3.0, 3.0), (47.0, 8.0), (33.0, 41.0), (20.0, 22.0), (4.0, 44.0)];
        let ring = ring.map(|(x, y)| GridPoint::m(x, y)).to_vec();
        let polygon = Polygon::new(ring, vec![]).unwrap();
        let bounds = Bounds { min: Vec2::ZERO, max: Vec2::splat(50.0) };
        let cells = Cells::over(bounds, 2.5);
        let mut area_m2 = 0.0;
        for ((column, row), kind) in cells.of(&polygon) {
            let corners = cells.corners((column, row)).map(|post| cells.post(post));
            let holds = |p: Vec2| polygon.contains(GridPoint::round(p));
            match kind {
                // A middle on the boundary itself may count as either.
                Cell::Rim { middle } => {
                    let at = cells.middle((column, row));
                    let on_boundary = polygon.boundary_distance_m(at) < 0.002;
                    assert!(on_boundary || middle == holds(at), "{at}");
                }
                Cell::Inside => {
                    assert_eq!(corners.map(holds), [true; 4]);
                    area_m2 += 6.25;
                }
            }
        }
        let rim = cells.of(&polygon).iter().filter(|(_, kind)| *kind != Cell::Inside).count();
        assert!(area_m2 < polygon.area_m2());
        assert!(area_m2 + rim as f64 * 6.25 > polygon.area_m2());
        assert!(rim < 110, "{rim}");
    }
}
