//! What methods ask of the ground: how high, how steep, wet or dry, how far to the water.
//!
//! A [`Land`] is made once of a city and answers from grids: no call walks a polygon, so that a
//! method may ask millions of times.

mod shores;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use exurb_geom::{Bounds, Polygon, Vec2};

use crate::{City, Terrain};
use shores::Shores;

/// Water this far from the target still counts: rivers are crossed and shores kept from there.
const MARGIN_M: f64 = 500.0;

/// The ground of a city, for asking.
///
/// A city without a terrain is flat at height 0. Where a terrain knows no height, those around it
/// stand in; beyond its edge, the edge's.
#[derive(Debug)]
pub struct Land {
    terrain: Option<Arc<Terrain>>,
    water_level_m: f64,
    shores: Shores,
}

impl Land {
    /// The ground of `city`: O(posts + vertices of its water · log).
    pub fn of(city: &City) -> Self {
        let whole = |terrain: &Arc<Terrain>| match terrain.missing() {
            0 => Arc::clone(terrain),
            _ => Arc::new(terrain.filled()),
        };
        let level = city.terrain.as_ref().and_then(|terrain| terrain.water_level_m());
        let bounds = city.target.bounds().grown(MARGIN_M);
        let water: Vec<&Polygon> = city.water.iter().map(|area| &area.polygon).collect();
        Self {
            terrain: city.terrain.as_ref().map(whole),
            water_level_m: level.unwrap_or(f64::NEG_INFINITY),
            shores: Shores::of(&water, bounds),
        }
    }

    /// Is there a terrain? Otherwise the land is flat.
    pub fn has_terrain(&self) -> bool {
        self.terrain.is_some()
    }

    /// Is there any water?
    pub fn has_water(&self) -> bool {
        !self.shores.is_empty() || self.water_level_m > f64::NEG_INFINITY
    }

    /// Height in metres.
    pub fn height_m(&self, p: Vec2) -> f64 {
        let height = |t: &Arc<Terrain>| t.height_m(nearest(t.bounds(), p));
        self.terrain.as_ref().and_then(height).unwrap_or(0.0)
    }

    /// Uphill, as rise over run; see [`Terrain::gradient`].
    pub fn gradient(&self, p: Vec2) -> Vec2 {
        let gradient = |t: &Arc<Terrain>| t.gradient(nearest(t.bounds(), p));
        self.terrain.as_ref().and_then(gradient).unwrap_or(Vec2::ZERO)
    }

    /// Slope, rise over run.
    pub fn slope(&self, p: Vec2) -> f64 {
        self.gradient(p).length()
    }

    /// Is `p` in a water area, or under the terrain's water level?
    pub fn is_wet(&self, p: Vec2) -> bool {
        self.shores.is_wet(p)
            || (self.water_level_m > f64::NEG_INFINITY && self.height_m(p) < self.water_level_m)
    }

    /// Distance to the nearest water area in metres, 0 in it; infinite where there is none within
    /// the target and 500 m around. It is that to the shore nearest to the middle of the place's
    /// cell (10 m wide, more over 100 km²), so at most 1.4 cell widths too large.
    pub fn water_distance_m(&self, p: Vec2) -> f64 {
        self.shores.distance_m(p)
    }
}

fn nearest(bounds: Bounds, p: Vec2) -> Vec2 {
    p.clamp(bounds.min, bounds.max)
}
