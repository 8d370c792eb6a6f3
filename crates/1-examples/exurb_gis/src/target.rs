//! The target of a synthesis, drawn in GeoJSON or GeoPackage.
//!
//! 1. The polygons of the file are brought to the frame: the one given, or one at their own centre.
//! 2. Outlines that cross themselves are mended where hardly anything of them is in doubt.
//! 3. What touches becomes one area; the largest is the target.

use std::path::Path;

use exurb_geom::{Crs, Frame, GridPoint, LonLat, Polygon, Vec2, overlay};

use crate::geometry::{Geometry, Position};
use crate::{Error, geojson, geopackage};

/// Larger targets are refused, in km² (contract, section 2).
pub const LARGEST_KM2: f64 = 10_000.0;
/// Smaller ones hold no block, in m².
const SMALLEST_M2: f64 = 100.0;
/// An outline that crosses itself is mended when its largest piece is this share of all of them.
const MENDED_SHARE: f64 = 0.9;

/// The area of a new city.
#[derive(Clone, Debug)]
pub struct TargetArea {
    /// The frame it lies in.
    pub frame: Frame,
    /// Its outline.
    pub polygon: Polygon,
    /// What was mended or left out, one sentence each.
    pub warnings: Vec<String>,
}

/// The polygons of a file.
#[derive(Debug, Default)]
pub struct Outlines {
    /// Simple polygons.
    pub polygons: Vec<Geometry>,
    /// What their positions mean.
    pub system: System,
}

/// What positions mean.
#[derive(Debug, Default)]
pub enum System {
    /// The file does not say: degrees, or metres when they are too large for degrees.
    #[default]
    Unsaid,
    /// A coordinate system.
    Known(Crs),
    /// The frame of a city.
    Own(Frame),
}

/// Reads a target: the polygons of a GeoJSON or GeoPackage file, or the target of a city file of
/// our own, in the frame given or in one at the polygons' own centre (a city's frame is kept).
///
/// Polygons that touch become one; of separate ones the largest is taken, with a warning.
/// Coordinates beyond ±180 without a coordinate system are metres in the frame given, or at the
/// null island. Targets that are empty, cross themselves badly or exceed 10,000 km² are errors.
/// O(n log n).
pub fn read_target(path: &Path, frame: Option<&Frame>) -> Result<TargetArea, Error> {
    let file = path.display().to_string();
    let outlines = match geopackage::is_geopackage(path) {
        true => geopackage::outlines(path)?,
        false => geojson::outlines_of(path)?,
    };
    settle(outlines, &file, frame)
}

/// The target that `outlines` of the file `file` draw.
pub fn settle(
    mut outlines: Outlines,
    file: &str,
    frame: Option<&Frame>,
) -> Result<TargetArea, Error> {
    let error = |what: String| Error::Target { file: file.to_owned(), what };
    if outlines.polygons.is_empty() {
        return Err(error("holds no polygon; draw it as a Polygon or MultiPolygon".into()));
    }
    let (frame, place) = locate(&mut outlines, frame).map_err(error)?;
    let mut warnings = Vec::new();
    let mut areas = Vec::new();
    for polygon in &outlines.polygons {
        areas.extend(sound(polygon, &place, file, &mut warnings).map_err(error)?);
    }
    let mut areas = if areas.len() > 1 { overlay::union(&areas) } else { areas };
    areas.retain(Polygon::is_valid);
    let total_m2: f64 = areas.iter().map(Polygon::area_m2).sum();
    let count = areas.len();
    let largest = areas.into_iter().next().ok_or_else(|| error(NO_AREA.to_owned()))?;
    let area_m2 = largest.area_m2();
    if count > 1 {
        warnings.push(format!(
            "the target `{file}` has {count} separate areas: the largest is taken, {:.3} of \
             {:.3} km²; run the others one by one",
            area_m2 / 1e6,
            total_m2 / 1e6
        ));
    }
    check(area_m2).map_err(error)?;
    Ok(TargetArea { frame, polygon: largest, warnings })
}

fn check(area_m2: f64) -> Result<(), String> {
    if area_m2 > LARGEST_KM2 * 1e6 {
        return Err(TOO_LARGE.to_owned());
    }
    if area_m2 < SMALLEST_M2 {
        return Err(format!("has {area_m2:.1} m², too little for a city; draw a larger area"));
    }
    Ok(())
}

const NO_AREA: &str = "has no area; draw it as a Polygon or MultiPolygon";
const TOO_LARGE: &str = "is larger than 10,000 km²; draw a smaller area or several";
const CROSSES: &str = "crosses or touches itself; draw its outline without crossings";

/// From a position of the file to the grid of the frame.
type Place = Box<dyn Fn(Position) -> Option<GridPoint>>;

/// The frame, and the way of the file's positions into it.
fn locate(outlines: &mut Outlines, wanted: Option<&Frame>) -> Result<(Frame, Place), String> {
    let metres = |p: Position| GridPoint::checked(Vec2::from_array(p));
    let crs = match &outlines.system {
        System::Own(own) => match wanted {
            None => return Ok((own.clone(), Box::new(metres))),
            Some(wanted) => {
                let (from, to) = (own.clone(), wanted.clone());
                let moved = move |p| to.project_to_grid(from.unproject(Vec2::from_array(p)));
                return Ok((wanted.clone(), Box::new(moved)));
            }
        },
        System::Known(crs) => crs.clone(),
        System::Unsaid if is_metres(&mut outlines.polygons) => {
            let frame = wanted.cloned().unwrap_or_else(Frame::null_island);
            return match outlines.polygons.iter_mut().all(|g| g.all(|p| metres(*p).is_some())) {
                true => Ok((frame, Box::new(metres))),
                false => Err("has coordinates that are no degrees and names no coordinate \
                              system; save it in EPSG:4326"
                    .to_owned()),
            };
        }
        System::Unsaid => Crs::wgs84(),
    };
    let center = to_degrees(&mut outlines.polygons, &crs)?;
    let frame = match wanted {
        Some(frame) => frame.clone(),
        None => Frame::new(center).map_err(|e| format!("has no place: {e}"))?,
    };
    let to = frame.clone();
    Ok((frame, Box::new(move |[lon, lat]| to.project_to_grid(LonLat { lon, lat }))))
}

/// Too large for degrees? A single stray does not tell.
fn is_metres(polygons: &mut [Geometry]) -> bool {
    let is_degrees = |p: &mut Position| p[0].abs() <= 180.0 && p[1].abs() <= 90.0;
    let (mut metres, mut all) = (0, 0);
    for polygon in polygons {
        polygon.all(|p| {
            metres += usize::from(!is_degrees(p));
            all += 1;
            true
        });
    }
    metres * 2 > all
}

/// Brings all positions to degrees; the middle of their box.
fn to_degrees(polygons: &mut [Geometry], crs: &Crs) -> Result<LonLat, String> {
    let (mut min, mut max) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    let all_placed = polygons.iter_mut().all(|polygon| {
        polygon.all(|p| {
            let Some(place) = crs.to_lonlat(p[0], p[1]) else { return false };
            *p = [place.lon, place.lat];
            for (i, v) in p.iter().enumerate() {
                (min[i], max[i]) = (min[i].min(*v), max[i].max(*v));
            }
            true
        })
    });
    if !all_placed {
        return Err("has coordinates out of range; check its coordinate system".to_owned());
    }
    if min[0] > max[0] {
        return Err(NO_AREA.to_owned());
    }
    if max[0] - min[0] >= 180.0 {
        return Err("spans 180 degrees and more; of an area across the antimeridian draw one side"
            .to_owned());
    }
    Ok(LonLat { lon: (min[0] + max[0]) / 2.0, lat: (min[1] + max[1]) / 2.0 })
}

/// The polygon on the grid, mended where it crosses itself a little.
fn sound(
    polygon: &Geometry,
    place: &Place,
    file: &str,
    warnings: &mut Vec<String>,
) -> Result<Vec<Polygon>, String> {
    let Geometry::Polygon(rings) = polygon else { return Ok(Vec::new()) };
    let far = "lies over 1,000 km from the centre of its frame; draw it nearer";
    let on_grid = |ring: &Vec<Position>| -> Result<Vec<GridPoint>, String> {
        ring.iter().map(|p| place(*p).ok_or_else(|| far.to_owned())).collect()
    };
    let rings: Vec<Vec<GridPoint>> = rings.iter().map(on_grid).collect::<Result<_, _>>()?;
    if let Some(polygon) = rings.first().and_then(|outer| {
        Polygon::new(outer.clone(), rings[1..].to_vec()).filter(Polygon::is_valid)
    }) {
        return Ok(vec![polygon]);
    }
    let mut pieces = overlay::covered(&rings);
    let total_m2: f64 = pieces.iter().map(Polygon::area_m2).sum();
    pieces.truncate(1);
    match pieces.first() {
        None => {}
        Some(largest) if largest.area_m2() < MENDED_SHARE * total_m2 => {
            return Err(CROSSES.to_owned());
        }
        Some(_) => {
            warnings.push(format!("the outline of the target `{file}` crossed itself: mended"))
        }
    }
    Ok(pieces)
}

#[cfg(test)]
mod tests;
