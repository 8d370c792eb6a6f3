//! What the ground lets streets do: nothing under water, nothing too steep (Nishida et al. 2015,
//! sections 4.3.2 and 4.3.4).
//!
//! The paper gives no limits; its program allows a spread of 0.3 rad within a patch and ground of 36°.
//! Here a street has a limit for its own grade and one for the ground under it, both parameters.

use std::sync::Arc;

use exurb_city::area::WITHOUT_STREETS;
use exurb_city::{Area, City, Land};
use exurb_geom::{GridPoint, Polygon, Vec2, polyline, trig};

use super::params::Params;

/// Places along a street that are looked at, in metres.
const STEP_M: f64 = 4.0;
/// The grade of a street is that over this length, in metres.
const GRADE_OVER_M: f64 = 32.0;
/// Streets keep this far from water to both sides, in metres.
const SHORE_M: f64 = 6.0;
/// Steps of a street that is bent, in metres.
const BENT_STEP_M: f64 = 24.0;
/// How much of its last direction a bent street keeps, against the one it wants.
const SWING: f64 = 0.7;
/// A street that would be too steep turns towards the contour in steps of this, in radians.
const TURN_RAD: f64 = 0.15;

/// The ground that streets grow on.
#[derive(Debug)]
pub struct Relief {
    land: Option<Land>,
    /// Ground kept free of streets, as if it were water.
    parks: Option<Land>,
    most_slope: f64,
    most_grade: f64,
    /// Beyond it nothing is known of water.
    known: Polygon,
}

/// Areas of the parameters that streets leave alone; paths drawn there are given streets.
pub fn parks(params: &Params) -> impl Iterator<Item = Area> + '_ {
    let parks = params.areas.areas().iter().filter(|area| WITHOUT_STREETS.contains(&&*area.usage));
    parks.filter_map(|area| {
        Some(Area { id: 0, polygon: area.polygon()?, class: area.usage.as_str().into() })
    })
}

/// What the ground says to a street.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It may lie there.
    Fine,
    /// It runs into water.
    Wet,
    /// It runs through a park or cemetery.
    Kept,
    /// It is too steep, or the ground under it is.
    Steep,
}

impl Relief {
    /// The ground of a city.
    pub fn of(city: &City, params: &Params) -> Self {
        let land = Land::of(city);
        let land = (land.has_terrain() || land.has_water()).then_some(land);
        let mut kept = City::empty(city.frame.clone(), city.target.clone());
        let is_kept = |area: &&Area| WITHOUT_STREETS.contains(&&*area.class);
        let known = city.land_use.iter().filter(is_kept).cloned();
        kept.water = Arc::new(known.chain(parks(params)).collect());
        let parks = (!kept.water.is_empty()).then(|| Land::of(&kept));
        Self {
            land,
            parks,
            most_slope: params.slope,
            most_grade: params.grade,
            known: city.target.clone(),
        }
    }

    /// Is there any water?
    pub fn has_water(&self) -> bool {
        self.land.as_ref().is_some_and(Land::has_water)
    }

    /// Is it known whether `p` lies in water?
    pub fn is_known(&self, p: Vec2) -> bool {
        self.known.contains(GridPoint::round(p))
    }

    /// Does `p` lie in water or on ground kept free?
    pub fn is_closed(&self, p: Vec2) -> bool {
        self.is_wet(p) || self.parks.as_ref().is_some_and(|parks| parks.is_wet(p))
    }

    /// Does `p` lie in water?
    pub fn is_wet(&self, p: Vec2) -> bool {
        self.land.as_ref().is_some_and(|land| land.is_wet(p))
    }

    /// May streets lie at `p`?
    pub fn bears(&self, p: Vec2) -> bool {
        let fits = |land: &Land| land.slope(p) <= self.most_slope;
        !self.is_closed(p) && self.land.as_ref().is_none_or(fits)
    }

    /// Height in metres; 0 on level ground.
    pub fn height_m(&self, p: Vec2) -> f64 {
        self.land.as_ref().map_or(0.0, |land| land.height_m(p))
    }

    /// May a street lie along `line`? O(length).
    pub fn verdict(&self, line: &[Vec2]) -> Verdict {
        if self.land.is_none() && self.parks.is_none() {
            return Verdict::Fine;
        }
        let total = polyline::length(line);
        let count = (total / STEP_M).ceil().max(1.0) as usize;
        let places: Vec<Vec2> = (0..=count)
            .map(|i| polyline::point_at(line, total * i as f64 / count as f64))
            .collect();
        if self.parks.as_ref().is_some_and(|parks| places.iter().any(|p| parks.is_wet(*p))) {
            return Verdict::Kept;
        }
        let Some(land) = &self.land else { return Verdict::Fine };
        let is_wet = |i: usize| {
            let (p, before) = (places[i], places[i.max(1) - 1]);
            let aside = (places[i.max(1)] - before).perp().normalize_or_zero() * SHORE_M;
            [Vec2::ZERO, aside, -aside].iter().any(|d| land.is_wet(p + *d))
        };
        if land.has_water() && (0..=count).any(is_wet) {
            return Verdict::Wet;
        }
        if !land.has_terrain() {
            return Verdict::Fine;
        }
        let heights: Vec<f64> = places.iter().map(|p| land.height_m(*p)).collect();
        let steps = ((GRADE_OVER_M / STEP_M) as usize).min(count);
        let step_m = total / count as f64 * steps as f64;
        let too_steep = heights.windows(steps + 1).any(|w| {
            (w[steps] - w[0]).abs() > 0.9 * self.most_grade * step_m.max(GRADE_OVER_M / 2.0)
        }) || places.iter().any(|p| land.slope(*p) > self.most_slope);
        if too_steep { Verdict::Steep } else { Verdict::Fine }
    }

    /// The direction nearest to `heading` in which a street of that length is not too steep: it turns
    /// towards the contour as far as it must (section 4.3.4).
    pub fn bent(&self, at: Vec2, heading: Vec2, length_m: f64) -> Vec2 {
        let Some(land) = self.land.as_ref().filter(|land| land.has_terrain()) else {
            return heading;
        };
        let grade = |d: Vec2| {
            (land.height_m(at + d * length_m) - land.height_m(at)).abs() / length_m.max(1.0)
        };
        // Some room below the limit, since the ground is not even.
        let fits = |d: &Vec2| grade(*d) <= 0.8 * self.most_grade;
        let turned = (0..=10).flat_map(|k| {
            let turn = f64::from(k) * TURN_RAD;
            [trig::rotate(heading, turn), trig::rotate(heading, -turn)]
        });
        let turned: Vec<Vec2> = turned.collect();
        let gentlest = || turned.iter().copied().min_by(|a, b| grade(*a).total_cmp(&grade(*b)));
        turned.iter().copied().find(|d| fits(d)).or_else(gentlest).unwrap_or(heading)
    }

    /// `line` from its beginning, turned towards the contour wherever it would be too steep; about as
    /// long.
    pub fn along_slope(&self, line: &[Vec2]) -> Vec<Vec2> {
        let total = polyline::length(line);
        let count = (total / BENT_STEP_M).ceil().max(1.0) as usize;
        let step_m = total / count as f64;
        let mut out = vec![line[0]];
        let mut before = Vec2::ZERO;
        for i in 0..count {
            let [from, to] = [i, i + 1].map(|k| polyline::point_at(line, step_m * k as f64));
            let wanted = (to - from).normalize_or(before);
            // Part of the last direction stays, so that the street swings and does not jag.
            let heading = (wanted + before * SWING).normalize_or(wanted);
            let at = out[i];
            before = self.bent(at, heading, step_m);
            out.push(at + before * step_m);
        }
        out
    }
}
