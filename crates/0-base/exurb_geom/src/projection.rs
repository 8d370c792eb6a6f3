//! Longitude and latitude to local metres and back.

use proj4rs::Proj;

use crate::{GridPoint, Polygon, Vec2};

/// A place on the WGS 84 ellipsoid, in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LonLat {
    /// Degrees east.
    pub lon: f64,
    /// Degrees north.
    pub lat: f64,
}

impl LonLat {
    /// Finite, longitude within ±180 and latitude within ±90.
    pub fn is_valid(self) -> bool {
        self.lon.abs() <= 180.0 && self.lat.abs() <= 90.0
    }
}

/// A city's local frame: the transverse Mercator projection of WGS 84 with scale 1 at `origin`.
/// Within 50 km of the origin lengths are true to 0.003 %.
#[derive(Clone, Debug)]
pub struct Frame {
    origin: LonLat,
    local: Proj,
    geographic: Proj,
}

/// Why a frame could not be made.
#[derive(Debug, PartialEq, thiserror::Error)]
#[error("no local frame at longitude {lon}, latitude {lat}: expected ±180 and ±85 degrees")]
pub struct FrameError {
    lon: f64,
    lat: f64,
}

impl Frame {
    /// The frame centred at `origin`, whose latitude lies within ±85 degrees. The origin is rounded
    /// to 1e-7 degrees so that it survives every file format.
    pub fn new(origin: LonLat) -> Result<Self, FrameError> {
        let LonLat { lon, lat } = origin;
        let error = FrameError { lon, lat };
        if !(lon.abs() <= 180.0 && lat.abs() <= 85.0) {
            return Err(error);
        }
        let round = |v: f64| (v * 1e7).round() / 1e7;
        let origin = LonLat { lon: round(lon), lat: round(lat) };
        match (
            Proj::from_proj_string(&proj_text(origin)),
            Proj::from_proj_string("+proj=longlat +datum=WGS84"),
        ) {
            (Ok(local), Ok(geographic)) => Ok(Self { origin, local, geographic }),
            _ => Err(error),
        }
    }

    /// The frame at the null island, for cities without a place.
    pub fn null_island() -> Self {
        Self::new(LonLat { lon: 0.0, lat: 0.0 }).expect("the null island is a valid origin")
    }

    /// Where (0, 0) lies.
    pub fn origin(&self) -> LonLat {
        self.origin
    }

    /// Metres east and north of the origin; `None` for what is no valid place or out of reach.
    pub fn project(&self, place: LonLat) -> Option<Vec2> {
        if !place.is_valid() {
            return None;
        }
        let mut p = (place.lon.to_radians(), place.lat.to_radians(), 0.0);
        proj4rs::transform::transform(&self.geographic, &self.local, &mut p).ok()?;
        let local = Vec2::new(p.0, p.1);
        local.is_finite().then_some(local)
    }

    /// [`Frame::project`], on the grid and within its limit.
    pub fn project_to_grid(&self, place: LonLat) -> Option<GridPoint> {
        self.project(place).and_then(GridPoint::checked)
    }

    /// The place of a local point in metres. Points beyond the projection's reach give NaN.
    pub fn unproject(&self, local: Vec2) -> LonLat {
        let mut p = (local.x, local.y, 0.0);
        match proj4rs::transform::transform(&self.local, &self.geographic, &mut p) {
            Ok(()) => LonLat { lon: p.0.to_degrees(), lat: p.1.to_degrees() },
            Err(_) => LonLat { lon: f64::NAN, lat: f64::NAN },
        }
    }

    /// The largest axis-parallel rectangle of the plane inside the box of longitude and latitude
    /// between two corners; the box's own sides are a little bent and turned in the plane. `None`
    /// when the corners are no box, out of reach or too near each other.
    pub fn rectangle_inside(&self, south_west: LonLat, north_east: LonLat) -> Option<Polygon> {
        let (w, e, s, n) = (south_west.lon, north_east.lon, south_west.lat, north_east.lat);
        let at = |lon: f64, lat: f64| self.project_to_grid(LonLat { lon, lat });
        let middle = (w + e) / 2.0;
        let (sw, se, nw, ne) = (at(w, s)?, at(e, s)?, at(w, n)?, at(e, n)?);
        let (south, north) = (at(middle, s)?, at(middle, n)?);
        let lo = GridPoint { x: sw.x.max(nw.x), y: sw.y.max(se.y).max(south.y) };
        let hi = GridPoint { x: se.x.min(ne.x), y: nw.y.min(ne.y).min(north.y) };
        (lo.x < hi.x && lo.y < hi.y).then(|| Polygon::rectangle(lo, hi))
    }

    /// The frame as a `proj` text, which [`crate::Crs::from_name`] reads.
    pub fn to_proj(&self) -> String {
        proj_text(self.origin)
    }

    /// The frame as OGC well-known text (version 1), for GeoPackage and `.prj` files.
    pub fn to_wkt(&self) -> String {
        let LonLat { lon, lat } = self.origin;
        format!(
            "PROJCS[\"exurb local ({lon:.7}, {lat:.7})\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",\
             SPHEROID[\"WGS 84\",6378137,298.257223563,AUTHORITY[\"EPSG\",\"7030\"]],\
             AUTHORITY[\"EPSG\",\"6326\"]],PRIMEM[\"Greenwich\",0,AUTHORITY[\"EPSG\",\"8901\"]],\
             UNIT[\"degree\",0.0174532925199433,AUTHORITY[\"EPSG\",\"9122\"]],\
             AUTHORITY[\"EPSG\",\"4326\"]],PROJECTION[\"Transverse_Mercator\"],\
             PARAMETER[\"latitude_of_origin\",{lat:.7}],PARAMETER[\"central_meridian\",{lon:.7}],\
             PARAMETER[\"scale_factor\",1],PARAMETER[\"false_easting\",0],\
             PARAMETER[\"false_northing\",0],UNIT[\"metre\",1,AUTHORITY[\"EPSG\",\"9001\"]],\
             AXIS[\"Easting\",EAST],AXIS[\"Northing\",NORTH]]"
        )
    }
}

fn proj_text(origin: LonLat) -> String {
    let LonLat { lon, lat } = origin;
    format!("+proj=tmerc +lat_0={lat:.7} +lon_0={lon:.7} +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m")
}

impl PartialEq for Frame {
    fn eq(&self, other: &Self) -> bool {
        self.origin == other.origin
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_round_trip_is_exact_to_a_millimetre() {
        let frame = Frame::new(LonLat { lon: 24.9443, lat: 60.1716 }).expect("valid");
        for (x, y) in [(0.0, 0.0), (51_000.0, -38_000.0), (-7.25, 14_321.125)] {
            let p = Vec2::new(x, y);
            let back = frame.project(frame.unproject(p)).expect("in reach");
            assert!(back.distance(p) < 1e-6, "{p} came back as {back}");
        }
    }

    #[test]
    fn a_degree_of_longitude_at_the_equator_is_known() {
        // a·π/180 on WGS 84, less the cubic term of the transverse projection along the equator.
        let x = Frame::null_island().project(LonLat { lon: 0.1, lat: 0.0 }).expect("valid").x;
        assert!((x - 11_131.95).abs() < 0.02, "{x}");
    }

    #[test]
    fn a_rectangle_inside_a_box_stays_inside_it() {
        let frame = Frame::new(LonLat { lon: 24.94, lat: 60.17 }).expect("valid");
        let corners = [LonLat { lon: 24.9, lat: 60.1 }, LonLat { lon: 25.1, lat: 60.2 }];
        let inside = frame.rectangle_inside(corners[0], corners[1]).expect("a box");
        for p in inside.exterior() {
            let LonLat { lon, lat } = frame.unproject(p.to_m());
            assert!((24.9 - 1e-8..=25.1 + 1e-8).contains(&lon), "{lon}");
            assert!((60.1 - 1e-8..=60.2 + 1e-8).contains(&lat), "{lat}");
        }
        assert!(inside.area_m2() > 0.98 * 11_090.0 * 11_140.0);
        assert_eq!(frame.rectangle_inside(corners[1], corners[0]), None);
    }

    #[test]
    fn places_out_of_range_are_refused() {
        assert!(Frame::new(LonLat { lon: 181.0, lat: 0.0 }).is_err());
        assert!(Frame::new(LonLat { lon: f64::NAN, lat: 0.0 }).is_err());
        assert_eq!(Frame::null_island().project(LonLat { lon: 0.0, lat: f64::NAN }), None);
    }
}
