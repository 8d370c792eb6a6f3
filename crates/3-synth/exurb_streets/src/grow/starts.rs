//! Where growth begins.

use exurb_city::City;
use exurb_geom::{Frame, GridPoint, LonLat, Polygon, Vec2};

use super::error::Error;
use super::ground::Ground;
use super::learn::Vocabulary;
use super::params::{self, Params};
use super::plan::{Guide, Start};
use super::relief::Relief;

/// Growth begins as told: at the points of the guideline, at the named places, else from the streets
/// that are there, else spread over the target, the first in its middle. `frames` are those of the
/// examples.
pub fn starts(
    city: &City,
    ground: &Ground,
    vocabularies: &[Vocabulary],
    frames: &[Frame],
    params: &Params,
) -> Result<Vec<Start>, Error> {
    let target = &ground.target;
    let count = vocabularies.len();
    let start = |i: usize, at: Vec2, source: Option<Vec2>| {
        let example = i % count;
        Start { at, example, source: source.unwrap_or(vocabularies[example].center) }
    };
    let named = if params.guide.is_empty() { &params.start } else { &params.guide };
    if named.is_empty() && params.starts == 1 && ground.has_streets() {
        return Ok(Vec::new());
    }
    if named.is_empty() {
        let places = spread(target, &ground.relief, (params.starts as usize).max(count));
        if places.is_empty() {
            return Err(Error::NoLand);
        }
        return Ok(places.into_iter().enumerate().map(|(i, at)| start(i, at, None)).collect());
    }
    let mut out = Vec::new();
    for (i, text) in named.iter().enumerate() {
        let (place, source) = params::parse_start(text).map_err(Error::Params)?;
        let at = in_frame(&city.frame, place)
            .filter(|p| !params.guide.is_empty() || target.contains(GridPoint::round(*p)))
            .ok_or_else(|| Error::StartOutside(text.clone()))?;
        if !ground.relief.bears(at) {
            return Err(Error::StartInWater(text.clone()));
        }
        let source = source.and_then(|place| in_frame(&frames[i % count], place));
        out.push(start(i, at, source));
    }
    // A guideline may run past the target.
    out.retain(|s| target.contains(GridPoint::round(s.at)));
    if out.is_empty() {
        return Err(Error::Params("no point of the guideline lies in the target".into()));
    }
    Ok(out)
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
