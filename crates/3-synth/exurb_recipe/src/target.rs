//! Where a new city lies: its frame and its outline.

use std::path::Path;

use exurb_city::{City, ImportOptions, Imported};
use exurb_geom::{Frame, GridPoint, Polygon, Vec2};
use exurb_operation::Run;

use crate::format::Format;
use crate::{Error, Size, Target, open};

/// The empty city of a target: a rectangle lies in the first example's frame around its centre, the
/// polygon of a file in a frame of its own, whose origin is the polygon's centre. The target of a
/// city file brings its ground: terrain and water.
pub fn begin(
    target: &Target,
    first: Option<&City>,
    folder: &Path,
    run: &Run,
) -> Result<City, Error> {
    match target {
        Target::Size(size) => Ok(rectangle(*size, first)),
        Target::File(file) => {
            let (frame, polygon) = read(file, None, folder, run)?;
            let mut city = City::empty(frame, polygon);
            let path = open::locate(file, folder)?;
            if open::format_of(&path)? == Format::GeoPackage
                && let Ok(Imported { city: given, .. }) =
                    open::open_city(&path, &ImportOptions::default())
                && given.frame == city.frame
            {
                (city.terrain, city.water) = (given.terrain, given.water);
                city.metadata.credit(&given.metadata.attribution);
            }
            Ok(city)
        }
    }
}

/// The polygon of a file, in the given frame.
pub fn read_in_frame(
    file: &Path,
    frame: &Frame,
    folder: &Path,
    run: &Run,
) -> Result<Polygon, Error> {
    read(file, Some(frame), folder, run).map(|(_, polygon)| polygon)
}

/// The area drawn in a GeoJSON or GeoPackage file, or the extent of another map. What is mended or
/// left out of it goes to `run` as warnings.
fn read(
    file: &Path,
    frame: Option<&Frame>,
    folder: &Path,
    run: &Run,
) -> Result<(Frame, Polygon), Error> {
    let path = open::locate(file, folder)?;
    if matches!(open::format_of(&path)?, Format::GeoJson | Format::GeoPackage) {
        let area = exurb_gis::read_target(&path, frame)
            .map_err(|e| Error::Target(open::named(&path, &e.to_string())))?;
        area.warnings.into_iter().for_each(|warning| run.warn(warning));
        return Ok((area.frame, area.polygon));
    }
    let city = open::open_city(&path, &ImportOptions::default())?.city;
    let Some(frame) = frame else { return Ok((city.frame, city.target)) };
    let moved = |p: Vec2| frame.project(city.frame.unproject(p)).unwrap_or(Vec2::NAN);
    if city.target.exterior().iter().any(|p| GridPoint::checked(moved(p.to_m())).is_none()) {
        let message = "its area lies too far from the city; draw it nearer";
        return Err(Error::Target(open::named(&path, message)));
    }
    let polygon = city.target.map(moved);
    let polygon = polygon.ok_or_else(|| Error::Target(open::named(&path, "its area is empty")))?;
    Ok((frame.clone(), polygon))
}

fn rectangle(size: Size, first: Option<&City>) -> City {
    let (frame, center) = match first {
        Some(city) => (city.frame.clone(), city.target.bounds().center()),
        None => (Frame::null_island(), Vec2::ZERO),
    };
    // On the grid, so that the rectangle has its size to the millimetre.
    let center = GridPoint::round(center).to_m();
    let half = Vec2::new(size.width_m(), size.height_m()) / 2.0;
    let corner = |p: Vec2| GridPoint::round(p);
    City::empty(frame, Polygon::rectangle(corner(center - half), corner(center + half)))
}
