//! Where growth begins.

use exurb_city::City;
use exurb_geom::{Frame, GridPoint, LonLat, Polygon, Vec2};

use super::Learned;
use super::domains::Domains;
use super::error::Error;
use super::ground::Ground;
use super::params::{self, Params};
use super::plan::{Guide, Start};
use super::relief::Relief;

/// Where a drawn fragment says that growth begins.
#[derive(Clone, Copy, Debug)]
pub struct Like {
    /// Where it was drawn, if in the target.
    pub at: Option<Vec2>,
    /// The place in the only example.
    pub source: Vec2,
    /// By how much the example is turned to lie as it does, in radians.
    pub turn_rad: f64,
}

/// Growth begins as told: at the points of the guideline, at the named places, with the drawn fragment,
/// else from the streets that are there, else spread over the target, the first in its middle.
pub fn starts(
    city: &City,
    ground: &Ground,
    learned: &Learned,
    domains: &Domains,
    like: Option<Like>,
    params: &Params,
) -> Result<Vec<Start>, Error> {
    let target = &ground.target;
    let count = learned.vocabularies.len();
    let start = |i: usize, at: Vec2, source: Option<Vec2>| {
        let weights = domains.weights_at(at).filter(|_| params.guide.is_empty());
        let example = weights.map_or(i % count, heaviest);
        let center = learned.vocabularies[example].center;
        Start { at, example, source: source.unwrap_or(center) }
    };
    let in_areas: Vec<String> =
        params.areas.areas().iter().flat_map(|area| area.starts.clone()).collect();
    let named = [&params.guide, &params.start, &in_areas].into_iter().find(|list| !list.is_empty());
    if params.guide.is_empty()
        && let Some(Like { at, source, .. }) = like
    {
        let at = at.filter(|p| ground.relief.bears(*p));
        let middle = || spread(target, &ground.relief, 1).first().copied();
        let at = at.or_else(middle).ok_or(Error::NoLand)?;
        return Ok(vec![Start { at, example: 0, source }]);
    }
    let Some(named) = named else {
        if params.starts == 1 && ground.has_streets() {
            return Ok(Vec::new());
        }
        let places = spread(target, &ground.relief, (params.starts as usize).max(count));
        if places.is_empty() {
            return Err(Error::NoLand);
        }
        return Ok(places.into_iter().enumerate().map(|(i, at)| start(i, at, None)).collect());
    };
    let mut out = Vec::new();
    for (i, text) in named.iter().enumerate() {
        let (place, source) = params::parse_start(text).map_err(Error::Params)?;
        let at = in_frame(&city.frame, place)
            .filter(|p| !params.guide.is_empty() || target.contains(GridPoint::round(*p)))
            .ok_or_else(|| Error::StartOutside(text.clone()))?;
        if !ground.relief.bears(at) {
            return Err(Error::StartInWater(text.clone()));
        }
        let start = start(i, at, None);
        let source = source.and_then(|place| in_frame(&learned.frames[start.example], place));
        out.push(Start { source: source.unwrap_or(start.source), ..start });
    }
    // A guideline may run past the target.
    out.retain(|s| target.contains(GridPoint::round(s.at)));
    if out.is_empty() {
        return Err(Error::Params("no point of the guideline lies in the target".into()));
    }
    Ok(out)
}

/// The first of the greatest weights.
fn heaviest(weights: &[f64]) -> usize {
    (0..weights.len()).rev().max_by(|a, b| weights[*a].total_cmp(&weights[*b])).unwrap_or(0)
}

/// The guideline of the parameters. Its points need a place in the example each.
pub fn guide(city: &City, frames: &[Frame], params: &Params) -> Result<Option<Guide>, Error> {
    if params.guide.is_empty() {
        return Ok(None);
    }
    let (mut target, mut example) = (Vec::new(), Vec::new());
    for (i, text) in params.guide.iter().enumerate() {
        let outside = || Error::StartOutside(text.clone());
        let (place, source) = params::parse_start(text).map_err(Error::Params)?;
        let Some(source) = source else {
            return Err(Error::Params(format!(
                "the point {text} of the guideline has no place in the example; write LON,LAT=LON,LAT"
            )));
        };
        target.push(in_frame(&city.frame, place).ok_or_else(outside)?);
        example.push(in_frame(&frames[i % frames.len()], source).ok_or_else(outside)?);
    }
    Ok(Some(Guide::new(target, &example)))
}

fn in_frame(frame: &Frame, (lon, lat): params::Place) -> Option<Vec2> {
    frame.project(LonLat { lon, lat })
}

/// `count` places in the polygon on dry and gentle ground: its interior point, then each as far as
/// possible from the others and the edge, on a grid of about 40 × 40.
fn spread(target: &Polygon, relief: &Relief, count: usize) -> Vec<Vec2> {
    let bounds = target.bounds();
    let step = bounds.size() / 40.0;
    let grid: Vec<Vec2> = (1..40)
        .flat_map(|y| (1..40).map(move |x| Vec2::new(f64::from(x), f64::from(y))))
        .map(|k| bounds.min + k * step)
        .filter(|p| target.contains(GridPoint::round(*p)) && relief.bears(*p))
        .collect();
    let middle = target.interior_point();
    let near_middle = || {
        let off = |p: &Vec2| p.distance_squared(middle);
        grid.iter().copied().min_by(|a, b| off(a).total_cmp(&off(b)))
    };
    let first = if relief.bears(middle) { Some(middle) } else { near_middle() };
    let mut places: Vec<Vec2> = first.into_iter().collect();
    while !places.is_empty() && places.len() < count {
        let room = |p: &Vec2| {
            let others = places.iter().map(|q| q.distance(*p)).fold(f64::INFINITY, f64::min);
            others.min(2.0 * target.boundary_distance_m(*p))
        };
        let Some(next) = grid.iter().max_by(|a, b| room(a).total_cmp(&room(b))) else { break };
        places.push(*next);
    }
    places
}
