//! Coordinate systems of other people's files, to longitude and latitude.
//!
//! By EPSG code (through the definitions that `proj4rs` brings along) or by well-known text, where
//! the projection is one of the common ones. Datum shifts are those of the definition (three or
//! seven parameters: some metres); systems that need a grid of shifts are refused.

use proj4rs::Proj;

use crate::LonLat;

mod wkt;

/// A coordinate system in the plane or on the ellipsoid.
#[derive(Clone, Debug)]
pub struct Crs {
    system: Proj,
    wgs84: Proj,
}

impl Crs {
    /// Longitude and latitude on WGS 84, in degrees.
    pub fn wgs84() -> Self {
        Self::from_proj("+proj=longlat +datum=WGS84").expect("WGS 84 is known")
    }

    /// The system of that EPSG code; `None` when it is unknown or beyond what we can convert.
    pub fn from_epsg(code: u32) -> Option<Self> {
        let system = Proj::from_epsg_code(u16::try_from(code).ok()?).ok()?;
        Self::of(system)
    }

    /// The system of a well-known text, version 1 or 2: by its EPSG code if that is known, else by
    /// its projection and parameters.
    pub fn from_wkt(text: &str) -> Option<Self> {
        let root = wkt::parse(text)?;
        let by_code = root.epsg().and_then(Self::from_epsg);
        by_code.or_else(|| Self::from_proj(&wkt::to_proj(&root)?))
    }

    /// The system of a name: `EPSG:32633`, `urn:ogc:def:crs:EPSG::32633`, `OGC:CRS84`, an
    /// `opengis.net` address or a `+proj=` text.
    pub fn from_name(name: &str) -> Option<Self> {
        let name = name.trim();
        if name.starts_with("+proj") {
            return Self::from_proj(name);
        }
        let upper = name.to_ascii_uppercase();
        if upper.ends_with("CRS84") || upper.ends_with("CRS84H") {
            return Some(Self::wgs84());
        }
        if !upper.contains("EPSG") {
            return None;
        }
        let digits = upper.rsplit([':', '/']).next()?;
        Self::from_epsg(digits.trim().parse().ok()?)
    }

    /// Is it of longitudes and latitudes, rather than of lengths in a plane?
    pub fn is_geographic(&self) -> bool {
        self.system.is_latlong()
    }

    /// The place of a point (x before y, east before north, as files keep it); `None` for what is
    /// no place.
    pub fn to_lonlat(&self, x: f64, y: f64) -> Option<LonLat> {
        if !(x.is_finite() && y.is_finite()) {
            return None;
        }
        let mut p = if self.is_geographic() {
            (LonLat { lon: x, lat: y }.is_valid()).then(|| (x.to_radians(), y.to_radians(), 0.0))?
        } else {
            (x, y, 0.0)
        };
        proj4rs::transform::transform(&self.system, &self.wgs84, &mut p).ok()?;
        let place = LonLat { lon: p.0.to_degrees(), lat: p.1.to_degrees() };
        place.is_valid().then_some(place)
    }

    /// The coordinates of a place, as [`Crs::to_lonlat`] takes them; `None` out of reach.
    pub fn from_lonlat(&self, place: LonLat) -> Option<(f64, f64)> {
        if !place.is_valid() {
            return None;
        }
        let mut p = (place.lon.to_radians(), place.lat.to_radians(), 0.0);
        proj4rs::transform::transform(&self.wgs84, &self.system, &mut p).ok()?;
        let (x, y, _) = p;
        let at = if self.is_geographic() { (x.to_degrees(), y.to_degrees()) } else { (x, y) };
        (at.0.is_finite() && at.1.is_finite()).then_some(at)
    }

    fn from_proj(text: &str) -> Option<Self> {
        Self::of(Proj::from_proj_string(text).ok()?)
    }

    fn of(system: Proj) -> Option<Self> {
        let wgs84 = Proj::from_proj_string("+proj=longlat +datum=WGS84").ok()?;
        Some(Self { system, wgs84 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Code, point, and its place by PROJ 9; tolerance in degrees: shifts by grid are up to 10 m
    /// better than the three or seven parameters.
    const KNOWN: [(u32, [f64; 2], [f64; 2], f64); 5] = [
        (3857, [1_605_598.0, 6_461_631.0], [14.423_332_235_5, 50.088_582_926_2], 1e-9),
        (5514, [-743_011.0, -1_043_011.0], [14.418_462_568_8, 50.087_235_149_3], 1e-4),
        (2154, [935_000.0, 6_688_000.0], [6.107_875_774_5, 47.250_678_372_2], 1e-9),
        (27700, [530_000.0, 180_000.0], [-0.128_353_940_5, 51.503_990_827_6], 1e-4),
        (2263, [983_000.0, 206_000.0], [-74.004_510_236_6, 40.732_098_955_8], 1e-7),
    ];

    #[test]
    fn known_points_come_out_where_they_lie() {
        for (code, [x, y], [lon, lat], tolerance) in KNOWN {
            let crs = Crs::from_epsg(code).unwrap_or_else(|| panic!("EPSG:{code} is known"));
            let place = crs.to_lonlat(x, y).expect("in reach");
            let off = (place.lon - lon).abs().max((place.lat - lat).abs());
            assert!(off < tolerance, "EPSG:{code}: {place:?}");
            let back = crs.from_lonlat(place).expect("in reach");
            assert!((back.0 - x).abs().max((back.1 - y).abs()) < 1e-3, "EPSG:{code}: {back:?}");
        }
    }

    #[test]
    fn names_in_all_their_forms() {
        for name in [
            "EPSG:32633",
            "urn:ogc:def:crs:EPSG::32633",
            "http://www.opengis.net/def/crs/EPSG/0/32633",
        ] {
            let place = Crs::from_name(name).and_then(|crs| crs.to_lonlat(500_000.0, 5_500_000.0));
            assert!((place.expect("known").lon - 15.0).abs() < 1e-9, "{name}");
        }
        assert!(Crs::from_name("urn:ogc:def:crs:OGC:1.3:CRS84").is_some_and(|c| c.is_geographic()));
        assert!(Crs::from_name("EPSG:999999").is_none());
        assert!(Crs::from_name("local engineering grid").is_none());
    }

    #[test]
    fn what_is_no_place_is_refused() {
        assert_eq!(Crs::wgs84().to_lonlat(f64::NAN, 0.0), None);
        assert_eq!(Crs::wgs84().to_lonlat(500_000.0, 5e6), None);
    }
}
