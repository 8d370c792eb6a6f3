//! The target of a synthesis, drawn as GeoJSON.

use std::io::Read;
use std::path::Path;

use exurb_city::FeatureShape;
use exurb_geom::{Crs, Frame, GridPoint, LonLat, Polygon, Vec2};

use super::read::{open, system};
use super::stream::{self, Json, Properties, Sink, Stop};
use crate::Error;
use crate::geometry::Geometry;

/// Larger targets are refused, in km² (contract, section 2).
pub const LARGEST_KM2: f64 = 10_000.0;
/// Smaller ones hold no block, in m².
const SMALLEST_M2: f64 = 100.0;

/// Reads a target: the largest polygon of a GeoJSON file, or the target of a city file of our own,
/// in the frame given or in one at the polygon's own centre.
///
/// Coordinates beyond ±180 without a `crs` member are metres in the frame given, or at the null
/// island. Targets that are empty, cross themselves or exceed 10,000 km² are errors. O(n log n).
pub fn read_target(path: &Path, frame: Option<&Frame>) -> Result<(Frame, Polygon), Error> {
    let (file, input) = open(path)?;
    read_target_stream(input, &file, frame)
}

/// [`read_target`] from anywhere.
pub(crate) fn read_target_stream(
    input: impl Read,
    file: &str,
    frame: Option<&Frame>,
) -> Result<(Frame, Polygon), Error> {
    let error = |what: String| Error::Target { file: file.to_owned(), what };
    let mut found = Found::default();
    stream::read(input, &mut found)
        .map_err(|source| Error::Json { file: file.to_owned(), source })?;
    let crs = system(found.crs.as_ref())
        .map_err(|crs| Error::CoordinateSystem { file: file.to_owned(), crs })?;
    let mut polygons = if found.declared.is_empty() { found.polygons } else { found.declared };
    if polygons.is_empty() {
        return Err(error("holds no polygon; draw it as a Polygon or MultiPolygon".into()));
    }
    let (frame, placed) = place(&mut polygons, crs, frame).map_err(error)?;
    let largest = placed
        .into_iter()
        .max_by(|a, b| a.area_m2().total_cmp(&b.area_m2()))
        .ok_or_else(|| error(NO_AREA.to_owned()))?;
    check(&largest).map_err(error)?;
    Ok((frame, largest))
}

fn check(target: &Polygon) -> Result<(), String> {
    let area_m2 = target.area_m2();
    if area_m2 > LARGEST_KM2 * 1e6 {
        return Err(TOO_LARGE.to_owned());
    }
    if area_m2 < SMALLEST_M2 {
        return Err(format!("has {area_m2:.1} m², too little for a city; draw a larger area"));
    }
    if !target.is_valid() {
        return Err("crosses or touches itself; draw its outline without crossings".to_owned());
    }
    Ok(())
}

const NO_AREA: &str = "has no area; draw it as a Polygon or MultiPolygon";
const TOO_LARGE: &str = "is larger than 10,000 km²; draw a smaller area or several";

/// The polygons in `frame` or one at their own centre; those without area go.
fn place(
    polygons: &mut [Geometry],
    crs: Option<Crs>,
    frame: Option<&Frame>,
) -> Result<(Frame, Vec<Polygon>), String> {
    let is_degrees = |p: &mut [f64; 2]| p[0].abs() <= 180.0 && p[1].abs() <= 90.0;
    if crs.is_none() && !polygons.iter_mut().all(|g| g.all(is_degrees)) {
        let frame = frame.cloned().unwrap_or_else(Frame::null_island);
        let place = |p| GridPoint::checked(Vec2::from_array(p));
        return Ok((frame, on_grid(polygons, place)?));
    }
    let crs = crs.unwrap_or_else(Crs::wgs84);
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
    let center = LonLat { lon: (min[0] + max[0]) / 2.0, lat: (min[1] + max[1]) / 2.0 };
    let frame = match frame {
        Some(frame) => frame.clone(),
        None => Frame::new(center).map_err(|e| format!("has no place: {e}"))?,
    };
    let project = |[lon, lat]: [f64; 2]| frame.project_to_grid(LonLat { lon, lat });
    let placed = on_grid(polygons, project)?;
    Ok((frame, placed))
}

fn on_grid(
    polygons: &[Geometry],
    place: impl Fn([f64; 2]) -> Option<GridPoint>,
) -> Result<Vec<Polygon>, String> {
    let far = || "lies over 1,000 km from the centre of its frame; draw it nearer".to_owned();
    let mut out = Vec::new();
    for polygon in polygons {
        let Geometry::Polygon(rings) = polygon else { continue };
        if rings.iter().flatten().any(|p| place(*p).is_none()) {
            return Err(far());
        }
        if let Some(FeatureShape::Polygon(polygon)) = polygon.to_grid(&place) {
            out.push(polygon);
        }
    }
    Ok(out)
}

/// The polygons of a file.
#[derive(Default)]
struct Found {
    crs: Option<Json>,
    /// Of features that say they are the target.
    declared: Vec<Geometry>,
    polygons: Vec<Geometry>,
}

impl Sink for Found {
    fn member(&mut self, key: &str, value: Json) {
        if key == "crs" {
            self.crs = Some(value);
        }
    }

    fn feature(&mut self, geometry: Option<Geometry>, properties: &Properties) -> Result<(), Stop> {
        let is_target = properties.get("element").and_then(Json::as_str) == Some("target");
        let list = if is_target { &mut self.declared } else { &mut self.polygons };
        let parts = geometry.map(Geometry::into_parts).unwrap_or_default();
        list.extend(parts.into_iter().filter(|part| matches!(part, Geometry::Polygon(_))));
        Ok(())
    }
}
