//! Terrain over polygons.

use exurb_geom::{GridPoint, Polygon};

use super::Terrain;

/// A polygon is looked at in about this many places at most.
const SAMPLES: f64 = 250_000.0;

/// What the ground of an area is like.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Relief {
    /// Mean height in metres.
    pub mean_m: f64,
    /// Lowest and highest place.
    pub range_m: (f64, f64),
    /// Mean slope, rise over run.
    pub slope: f64,
}

impl Terrain {
    /// The share of a polygon's area, 0 to 1, where no height is known.
    pub fn missing_share(&self, polygon: &Polygon) -> f64 {
        let points = self.points_of(polygon);
        let missing = points.iter().filter(|p| self.height_m(p.to_m()).is_none()).count();
        missing as f64 / points.len() as f64
    }

    /// Mean height, range and mean slope over a polygon; `None` where nothing is known of it.
    pub fn relief(&self, polygon: &Polygon) -> Option<Relief> {
        let mut relief =
            Relief { range_m: (f64::INFINITY, f64::NEG_INFINITY), ..Relief::default() };
        let mut count = 0.0;
        for p in self.points_of(polygon) {
            let (height, slope) = (self.height_m(p.to_m()), self.slope(p.to_m()));
            let (Some(height), Some(slope)) = (height, slope) else { continue };
            relief.mean_m += height;
            relief.slope += slope;
            relief.range_m = (relief.range_m.0.min(height), relief.range_m.1.max(height));
            count += 1.0;
        }
        relief.mean_m /= count;
        relief.slope /= count;
        (count > 0.0).then_some(relief)
    }

    /// Places all over a polygon, a cell apart or, in large ones, farther.
    fn points_of(&self, polygon: &Polygon) -> Vec<GridPoint> {
        polygon.lattice((polygon.area_m2() / SAMPLES).sqrt().max(self.cell_m()))
    }
}
