//! The coordinate system of a GeoTIFF: its geo keys both ways.
//!
//! Numbers and names of keys are those of OGC GeoTIFF 1.1. Systems with an EPSG code are looked up;
//! user-defined ones are read where their projection is one of the common ones.

use std::collections::BTreeMap;

use exurb_geom::{Crs, Frame};

pub const MODEL_TYPE: u16 = 1024;
pub const RASTER_TYPE: u16 = 1025;
const GEOGRAPHIC: u16 = 2048;
const GEOGRAPHIC_CITATION: u16 = 2049;
const ANGULAR_UNITS: u16 = 2054;
const SEMI_MAJOR: u16 = 2057;
const SEMI_MINOR: u16 = 2058;
const INVERSE_FLATTENING: u16 = 2059;
const PROJECTED: u16 = 3072;
const CITATION: u16 = 1026;
const PROJECTION: u16 = 3074;
const TRANSFORM: u16 = 3075;
const LINEAR_UNITS: u16 = 3076;
const LINEAR_UNIT_SIZE: u16 = 3077;
const NATURAL_LON: u16 = 3080;
const NATURAL_LAT: u16 = 3081;
const FALSE_EASTING: u16 = 3082;
const FALSE_NORTHING: u16 = 3083;
const SCALE: u16 = 3092;
const VERTICAL_UNITS: u16 = 4099;

const USER_DEFINED: u16 = 32_767;
const METRE: u16 = 9001;
const DEGREE: u16 = 9102;
const TRANSVERSE_MERCATOR: u16 = 1;
const WGS84: u16 = 4326;

/// The value of a key.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    Short(u16),
    Doubles(Vec<f64>),
    Text(String),
}

/// The keys of a file.
#[derive(Clone, Debug, Default)]
pub struct GeoKeys(BTreeMap<u16, Value>);

impl GeoKeys {
    /// From the three tags: the directory, doubles and texts it points into.
    pub fn parse(directory: &[u16], doubles: &[f64], text: &str) -> Self {
        let mut keys = BTreeMap::new();
        for entry in directory.get(4..).unwrap_or_default().chunks_exact(4) {
            let (id, location, count, at) = (entry[0], entry[1], entry[2] as usize, entry[3]);
            let range = usize::from(at)..usize::from(at) + count;
            let value = match location {
                0 => Some(Value::Short(at)),
                34_736 => doubles.get(range).map(|d| Value::Doubles(d.to_vec())),
                34_737 => text.get(range).map(|t| Value::Text(t.trim_end_matches('|').to_owned())),
                _ => None,
            };
            keys.extend(value.map(|value| (id, value)));
        }
        Self(keys)
    }

    /// A short value; `None` when it is absent.
    pub fn short(&self, key: u16) -> Option<u16> {
        match self.0.get(&key)? {
            Value::Short(value) => Some(*value),
            _ => None,
        }
    }

    fn double(&self, key: u16) -> Option<f64> {
        match self.0.get(&key)? {
            Value::Doubles(values) => values.first().copied(),
            _ => None,
        }
    }

    fn text(&self, key: u16) -> Option<&str> {
        match self.0.get(&key)? {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// Metres of a unit of height.
    pub fn height_unit_m(&self) -> f64 {
        self.short(VERTICAL_UNITS).and_then(unit_m).unwrap_or(1.0)
    }

    /// The coordinate system; `None` when the keys name none, the words for it when exurb does not
    /// know it.
    pub fn crs(&self) -> Option<Result<Crs, String>> {
        let code = |key| self.short(key).filter(|code| *code > 0 && *code != USER_DEFINED);
        let name = || match self.text(CITATION).or(self.text(GEOGRAPHIC_CITATION)) {
            Some(words) => words.to_owned(),
            None => "a system of its own".to_owned(),
        };
        let by_code = |code: u16| Crs::from_epsg(code.into()).ok_or(format!("EPSG:{code}"));
        match self.short(MODEL_TYPE) {
            Some(1) => Some(match code(PROJECTED) {
                Some(code) => by_code(code),
                None => self.projection().and_then(|p| Crs::from_name(&p)).ok_or_else(name),
            }),
            Some(2) => Some(match code(GEOGRAPHIC) {
                Some(code) => by_code(code),
                None => self
                    .datum()
                    .and_then(|datum| Crs::from_name(&format!("+proj=longlat {datum}")))
                    .ok_or_else(name),
            }),
            Some(_) => Some(Err(name())),
            None => code(PROJECTED).or(code(GEOGRAPHIC)).map(by_code),
        }
    }

    /// A user-defined projection as a `proj` text.
    fn projection(&self) -> Option<String> {
        // A zone of UTM is a projection that stands for its parameters.
        if let Some(zone @ (16_001..=16_060 | 16_101..=16_160)) = self.short(PROJECTION) {
            let south = if zone > 16_100 { " +south" } else { "" };
            return Some(format!("+proj=utm +zone={}{south} {}", zone % 100, self.datum()?));
        }
        let name = match self.short(TRANSFORM)? {
            TRANSVERSE_MERCATOR => "tmerc",
            7 => "merc",
            8 | 9 => "lcc",
            10 => "laea",
            11 => "aea",
            14 | 15 => "stere",
            16 => "sterea",
            18 => "cass",
            _ => return None,
        };
        let unit_m = match self.short(LINEAR_UNITS) {
            None => 1.0,
            Some(USER_DEFINED) => self.double(LINEAR_UNIT_SIZE)?,
            Some(code) => unit_m(code)?,
        };
        let mut text = format!("+proj={name} ");
        for (keys, word, scale) in PARAMETERS {
            if let Some(value) = keys.iter().find_map(|key| self.double(*key)) {
                let scale = if *scale { unit_m } else { 1.0 };
                text += &format!("+{word}={} ", value * scale);
            }
        }
        // With one parallel, the natural origin stands on it.
        if name == "lcc" && self.double(PARALLEL_1).is_none() {
            text += &format!("+lat_1={} ", self.double(NATURAL_LAT)?);
        }
        Some(format!("{text}{} +to_meter={unit_m}", self.datum()?))
    }

    fn datum(&self) -> Option<String> {
        match self.short(GEOGRAPHIC) {
            Some(WGS84) => return Some("+datum=WGS84".to_owned()),
            Some(4269) => return Some("+datum=NAD83".to_owned()),
            Some(4267) => return Some("+datum=NAD27".to_owned()),
            Some(4258) => return Some("+ellps=GRS80 +towgs84=0,0,0".to_owned()),
            _ => {}
        }
        let a = self.double(SEMI_MAJOR)?;
        let shape = match (self.double(INVERSE_FLATTENING), self.double(SEMI_MINOR)) {
            (Some(inverse), _) if inverse > 0.0 => format!("+rf={inverse}"),
            (_, Some(b)) => format!("+b={b}"),
            _ => format!("+b={a}"),
        };
        Some(format!("+a={a} {shape} +towgs84=0,0,0"))
    }
}

const PARALLEL_1: u16 = 3078;

/// Keys of a parameter by preference, its word in `proj`, and whether it is a length.
const PARAMETERS: &[(&[u16], &str, bool)] = &[
    (&[PARALLEL_1], "lat_1", false),
    (&[3079], "lat_2", false),
    (&[NATURAL_LAT, 3085, 3089], "lat_0", false),
    (&[NATURAL_LON, 3084, 3088, 3095], "lon_0", false),
    (&[SCALE, 3093], "k_0", false),
    (&[FALSE_EASTING, 3086, 3090], "x_0", true),
    (&[FALSE_NORTHING, 3087, 3091], "y_0", true),
];

fn unit_m(code: u16) -> Option<f64> {
    Some(match code {
        METRE => 1.0,
        9002 => 0.3048,
        9003 => 1200.0 / 3937.0,
        9036 => 1000.0,
        _ => return None,
    })
}

/// The three tags for a raster in the plane of a city, pixels counted as areas.
pub fn of_frame(frame: &Frame) -> (Vec<u16>, Vec<f64>, String) {
    let origin = frame.origin();
    let text = format!("exurb local ({:.7}, {:.7})|WGS 84|", origin.lon, origin.lat);
    let citation = text.find('|').map_or(0, |at| at as u16 + 1);
    let doubles = vec![origin.lat, origin.lon, 1.0, 0.0, 0.0];
    let shorts = |key: u16, value: u16| [key, 0, 1, value];
    let double = |key: u16, at: u16| [key, 34_736, 1, at];
    let keys = [
        shorts(MODEL_TYPE, 1),
        shorts(RASTER_TYPE, 1),
        [CITATION, 34_737, citation, 0],
        shorts(GEOGRAPHIC, WGS84),
        [GEOGRAPHIC_CITATION, 34_737, text.len() as u16 - citation, citation],
        shorts(ANGULAR_UNITS, DEGREE),
        shorts(PROJECTED, USER_DEFINED),
        shorts(PROJECTION, USER_DEFINED),
        shorts(TRANSFORM, TRANSVERSE_MERCATOR),
        shorts(LINEAR_UNITS, METRE),
        double(NATURAL_LON, 1),
        double(NATURAL_LAT, 0),
        double(FALSE_EASTING, 3),
        double(FALSE_NORTHING, 4),
        double(SCALE, 2),
        shorts(VERTICAL_UNITS, METRE),
    ];
    let head = [1, 1, 0, keys.len() as u16];
    (head.into_iter().chain(keys.into_iter().flatten()).collect(), doubles, text)
}

#[cfg(test)]
mod tests {
    use exurb_geom::{LonLat, Vec2};

    use super::*;

    #[test]
    fn a_city_s_frame_is_read_back() {
        let frame = Frame::new(LonLat { lon: -122.66, lat: 45.52 }).unwrap();
        let (directory, doubles, text) = of_frame(&frame);
        assert!(directory.chunks_exact(4).skip(1).is_sorted_by_key(|entry| entry[0]));
        let keys = GeoKeys::parse(&directory, &doubles, &text);
        let crs = keys.crs().expect("named").expect("known");
        let (place, there) =
            (crs.to_lonlat(3000.0, -2000.0), frame.unproject(Vec2::new(3000.0, -2000.0)));
        assert!((place.unwrap().lon - there.lon).abs() < 1e-9);
        assert!((place.unwrap().lat - there.lat).abs() < 1e-9);
    }

    #[test]
    fn user_defined_systems_match_their_codes() {
        let keys = |shorts: &[(u16, u16)], doubles: &[(u16, f64)]| {
            let shorts = shorts.iter().map(|(k, v)| (*k, Value::Short(*v)));
            let doubles = doubles.iter().map(|(k, v)| (*k, Value::Doubles(vec![*v])));
            GeoKeys(shorts.chain(doubles).collect()).crs().expect("named").expect("known")
        };
        let agree = |a: Crs, code: u32, x: f64, y: f64| {
            let b = Crs::from_epsg(code).expect("known");
            let (a, b) = (a.to_lonlat(x, y).unwrap(), b.to_lonlat(x, y).unwrap());
            assert!(
                (a.lon - b.lon).abs() < 1e-8 && (a.lat - b.lat).abs() < 1e-8,
                "{code}: {a:?} {b:?}"
            );
        };
        let utm = keys(&[(MODEL_TYPE, 1), (GEOGRAPHIC, 4326), (PROJECTION, 16_033)], &[]);
        agree(utm, 32_633, 400_000.0, 5_500_000.0);
        // Lambert 93 in its own words.
        let lambert = keys(
            &[(MODEL_TYPE, 1), (GEOGRAPHIC, 4258), (PROJECTED, USER_DEFINED), (TRANSFORM, 8)],
            &[
                (PARALLEL_1, 49.0),
                (3079, 44.0),
                (3085, 46.5),
                (3084, 3.0),
                (3086, 700_000.0),
                (3087, 6_600_000.0),
            ],
        );
        agree(lambert, 2154, 935_000.0, 6_688_000.0);
    }

    #[test]
    fn what_is_not_known_is_named() {
        let none = GeoKeys::default();
        assert!(none.crs().is_none());
        let own = GeoKeys(BTreeMap::from([
            (MODEL_TYPE, Value::Short(1)),
            (PROJECTED, Value::Short(USER_DEFINED)),
            (CITATION, Value::Text("town grid".into())),
        ]));
        assert_eq!(own.crs().map(|c| c.err()), Some(Some("town grid".into())));
        // A directory that points beyond its doubles has no such key.
        let broken = GeoKeys::parse(&[1, 1, 0, 1, NATURAL_LAT, 34_736, 1, 9], &[1.0], "");
        assert_eq!(broken.double(NATURAL_LAT), None);
    }
}
