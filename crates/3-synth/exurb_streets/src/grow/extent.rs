//! The ground of an example that a piece may bring along.
//!
//! What lies inside the map and not far from every street: a large block or a park comes along with the
//! streets around it, open sea and country do not.

use exurb_geom::{Bounds, GridPoint, Polygon, Vec2, polyline};

/// Side of the squares that are told apart, in metres.
const CELL_M: f64 = 25.0;

/// Ground on a grid.
#[derive(Clone, Debug)]
pub struct Extent {
    bounds: Bounds,
    columns: usize,
    covered: Vec<bool>,
}

impl Extent {
    /// The ground of `area` within `reach_m` of one of the lines. O(area + lines · reach²).
    pub fn of(area: &Polygon, lines: impl Iterator<Item = Vec<Vec2>>, reach_m: f64) -> Self {
        let bounds = area.bounds();
        let size = (bounds.size() / CELL_M).ceil().max(Vec2::ONE);
        let (columns, rows) = (size.x as usize, size.y as usize);
        let mut near = vec![false; columns * rows];
        for p in lines.flat_map(|line| polyline::resample(&line, CELL_M)) {
            let place = ((p - bounds.min) / CELL_M).floor();
            if place.min_element() >= 0.0 && place.x < size.x && place.y < size.y {
                near[place.y as usize * columns + place.x as usize] = true;
            }
        }
        let reach = (reach_m / CELL_M).round() as usize;
        // Along rows, then along columns: squares within a square of twice the reach.
        let along = |from: &[bool], length: usize, step: usize, starts: Vec<usize>| {
            let mut out = vec![false; from.len()];
            for start in starts {
                let mut last = None;
                for order in [false, true] {
                    let index = |k: usize| start + step * if order { length - 1 - k } else { k };
                    for k in 0..length {
                        if from[index(k)] {
                            last = Some(k);
                        }
                        out[index(k)] |= last.is_some_and(|last| k - last <= reach);
                    }
                    last = None;
                }
            }
            out
        };
        let wide = along(&near, columns, 1, (0..rows).map(|row| row * columns).collect());
        let mut covered = along(&wide, rows, columns, (0..columns).collect());
        for (i, is_covered) in covered.iter_mut().enumerate() {
            let place = Vec2::new((i % columns) as f64, (i / columns) as f64) + 0.5;
            *is_covered &= area.contains(GridPoint::round(bounds.min + place * CELL_M));
        }
        Self { bounds, columns, covered }
    }

    /// Does the ground at `p` come along?
    pub fn covers(&self, p: Vec2) -> bool {
        let place = (p - self.bounds.min) / CELL_M;
        let rows = self.covered.len() / self.columns;
        place.min_element() >= 0.0
            && place.x < self.columns as f64
            && place.y < rows as f64
            && self.covered[place.y as usize * self.columns + place.x as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ground_near_streets_comes_along_and_the_sea_does_not() {
        let area = Polygon::rectangle(GridPoint::m(0.0, 0.0), GridPoint::m(2000.0, 1000.0));
        let street = vec![Vec2::new(100.0, 500.0), Vec2::new(900.0, 500.0)];
        let extent = Extent::of(&area, std::iter::once(street), 200.0);
        assert!(extent.covers(Vec2::new(500.0, 650.0)) && extent.covers(Vec2::new(1050.0, 480.0)));
        assert!(
            !extent.covers(Vec2::new(500.0, 800.0)) && !extent.covers(Vec2::new(1500.0, 500.0))
        );
        assert!(!extent.covers(Vec2::new(-10.0, 500.0)));
    }
}
