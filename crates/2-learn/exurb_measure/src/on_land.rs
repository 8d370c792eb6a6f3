//! Streets and the ground under them: water crossed, and how steep they are.

use exurb_city::{City, Land};
use exurb_geom::{Vec2, polyline};
use serde::{Deserialize, Serialize};

/// Places along a street that are looked at, in metres.
const STEP_M: f64 = 4.0;
/// The grade of a street is that over this length, in metres: shorter rises are the terrain's noise.
const GRADE_OVER_M: f64 = 32.0;

/// Streets on the ground.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OnLand {
    /// Kilometres of bridges.
    pub bridge_km: f64,
    /// Metres of streets in water that are neither bridge nor tunnel.
    pub in_water_m: f64,
    /// The steepest grade of a street on the ground, rise over run; none without terrain.
    pub steepest_grade: Option<f64>,
    /// The steepest ground under a street, rise over run; none without terrain.
    pub steepest_slope: Option<f64>,
}

/// Measures the streets on the ground of the target; `None` for a city with neither terrain nor
/// water. O(length of streets).
pub fn on_land(city: &City) -> Option<OnLand> {
    let land = Land::of(city);
    if !land.has_terrain() && !land.has_water() {
        return None;
    }
    let mut out =
        OnLand { bridge_km: 0.0, in_water_m: 0.0, steepest_grade: None, steepest_slope: None };
    for (_, edge) in city.streets.edges() {
        if edge.data.bridge {
            out.bridge_km += edge.length_m() / 1000.0;
        }
        if edge.data.bridge || edge.data.tunnel {
            continue;
        }
        let line = edge.line_m();
        let inside = |p: &Vec2| city.target.contains(exurb_geom::GridPoint::round(*p));
        let places = polyline::resample(&line, STEP_M);
        // A street may leave the target and come back.
        let parts = places.chunk_by(|p, q| inside(p) == inside(q));
        for part in parts.filter(|part| inside(&part[0])) {
            out.in_water_m += part.iter().filter(|p| land.is_wet(**p)).count() as f64 * STEP_M;
            if land.has_terrain() {
                let slope = part.iter().map(|p| land.slope(*p)).fold(0.0, f64::max);
                out.steepest_slope = Some(out.steepest_slope.unwrap_or(0.0).max(slope));
                let grade = steepest(&land, part);
                out.steepest_grade = Some(out.steepest_grade.unwrap_or(0.0).max(grade));
            }
        }
    }
    Some(out)
}

/// The steepest grade over [`GRADE_OVER_M`]; that of the whole where it is half as long at least, else
/// 0.
fn steepest(land: &Land, places: &[Vec2]) -> f64 {
    let steps = ((GRADE_OVER_M / STEP_M) as usize).min(places.len().saturating_sub(1));
    if (steps as f64) * STEP_M < GRADE_OVER_M / 2.0 {
        return 0.0;
    }
    let heights: Vec<f64> = places.iter().map(|p| land.height_m(*p)).collect();
    let run_m = steps as f64 * STEP_M;
    heights.windows(steps + 1).map(|w| (w[steps] - w[0]).abs() / run_m).fold(0.0, f64::max)
}
