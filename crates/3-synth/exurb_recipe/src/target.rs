//! Where a new city lies: its frame and its outline.

use std::path::Path;

use exurb_city::City;
use exurb_geom::{Frame, GridPoint, Polygon, Vec2, overlay};
use exurb_operation::Run;

use crate::{Error, Size, Target, size};

/// The empty city of a target: a rectangle lies in the first example's frame around its centre, a
/// polygon of a file in a frame of its own, whose origin is the polygon's centre.
pub fn begin(
    target: &Target,
    first: Option<&City>,
    folder: &Path,
    run: &Run,
) -> Result<City, Error> {
    match target {
        Target::Size(size) => Ok(rectangle(*size, first)),
        Target::File(file) => {
            let path = crate::open::locate(file, folder)?;
            let (frame, polygon): (Frame, Polygon) = Err(Error::Input("LATER".to_owned()))?;
            let polygon = sound(polygon, &path, run)?;
            size::check_area_km2(polygon.area_m2() / 1e6)
                .map_err(|e| Error::Target(format!("{}: {e}", path.display())))?;
            Ok(City::empty(frame, polygon))
        }
    }
}

fn rectangle(size: Size, first: Option<&City>) -> City {
    let (frame, center) = match first {
        Some(city) => (city.frame.clone(), city.target.bounds().center()),
        None => (Frame::null_island(), Vec2::ZERO),
    };
    let half = Vec2::new(size.width_m(), size.height_m()) / 2.0;
    let corner = |p: Vec2| GridPoint::round(p);
    City::empty(frame, Polygon::rectangle(corner(center - half), corner(center + half)))
}

/// The polygon of a file in a given frame.
pub fn read_in_frame(file: &Path, frame: &Frame, folder: &Path) -> Result<Polygon, Error> {
    let _ = (file, frame, folder);
    Err(Error::Input("LATER".to_owned()))
}

/// The polygon itself, or the largest piece of one that crosses itself, with a warning.
fn sound(polygon: Polygon, path: &Path, run: &Run) -> Result<Polygon, Error> {
    let empty = || {
        Error::Target(format!(
            "{}: the target polygon has no area; draw a larger one",
            path.display()
        ))
    };
    let polygon = if polygon.is_valid() {
        polygon
    } else {
        let pieces = overlay::repair(&polygon);
        let count = pieces.len();
        let largest = pieces.into_iter().max_by(|a, b| a.area_m2().total_cmp(&b.area_m2()));
        let message = format!(
            "{}: the target crosses itself; its largest piece of {count} is taken",
            path.display()
        );
        run.warn(message);
        largest.ok_or_else(empty)?
    };
    let sides = polygon.bounds().size();
    if sides.min_element() < size::LEAST_SIDE_M { Err(empty()) } else { Ok(polygon) }
}
