//! GeoJSON → city.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use exurb_city::{ImportOptions, Imported};
use exurb_geom::{Crs, LonLat};

use super::stream::{self, Json, Properties, Sink, Stop};
use crate::Error;
use crate::assembly::Assembly;
use crate::gathering::Gathering;
use crate::geometry::Geometry;
use crate::metadata;
use crate::recognise::Attributes;
use crate::value::Value;

/// Reads GeoJSON: a city file of our own as the very city it was written from, any other by its
/// lines and polygons (see the table in the crate's documentation); rows that do not tell what they
/// are go by the file's name.
///
/// A legacy `crs` member is understood. Coordinates beyond ±180 without one are taken as metres of
/// an unknown place, with a warning. Streams; O(n log n).
pub fn read_geojson(path: &Path, options: &ImportOptions) -> Result<Imported, Error> {
    let (file, input) = open(path)?;
    read_stream(input, &file, &stem(path), options)
}

/// Reads several files, such as the streets, parcels and buildings of one place, into one city.
pub fn read_geojson_many(paths: &[PathBuf], options: &ImportOptions) -> Result<Imported, Error> {
    if let [only] = paths {
        return read_geojson(only, options);
    }
    let names: Vec<String> = paths.iter().map(|p| p.display().to_string()).collect();
    let name = paths.first().map(|p| stem(p)).unwrap_or_default();
    let mut gathering = Gathering::new(names.join("`, `"), name);
    for path in paths {
        let (file, input) = open(path)?;
        let mut reader = Reader::new(&file, stem(path), gathering);
        reader.own = Own::Never;
        gathering = reader.read(input)?.placed()?;
    }
    gathering.finish(options)
}

/// Reads GeoJSON from anywhere; `name` is what its file would be called.
pub(crate) fn read_stream(
    input: impl Read,
    file: &str,
    name: &str,
    options: &ImportOptions,
) -> Result<Imported, Error> {
    let gathering = Gathering::new(file.to_owned(), name.to_owned());
    let mut reader = Reader::new(file, name.to_owned(), gathering).read(input)?;
    reader.decide();
    match reader.own {
        Own::City(assembly) => {
            let mut imported = assembly.finish(options)?;
            if reader.skipped > 0 {
                imported.warnings.push(format!(
                    "`{file}`: {} features have no usable geometry: left out",
                    reader.skipped
                ));
            }
            Ok(imported)
        }
        _ => reader.placed()?.finish(options),
    }
}

pub(super) fn open(path: &Path) -> Result<(String, File), Error> {
    let file = path.display().to_string();
    match File::open(path) {
        Ok(input) => Ok((file, input)),
        Err(source) => Err(Error::Read { file, source }),
    }
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// Is it a city file of our own?
enum Own {
    Undecided,
    City(Box<Assembly>),
    Never,
}

struct Reader {
    file: String,
    hint: String,
    header: BTreeMap<String, String>,
    crs: Option<Json>,
    own: Own,
    gathering: Gathering,
    count: usize,
    skipped: usize,
    failure: Option<Error>,
}

impl Reader {
    fn new(file: &str, hint: String, gathering: Gathering) -> Self {
        Self {
            file: file.to_owned(),
            hint,
            header: BTreeMap::new(),
            crs: None,
            own: Own::Undecided,
            gathering,
            count: 0,
            skipped: 0,
            failure: None,
        }
    }

    fn read(mut self, input: impl Read) -> Result<Self, Error> {
        let result = stream::read(input, &mut self);
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        match result {
            Ok(()) => Ok(self),
            Err(error) if error.is_io() => {
                Err(Error::Read { file: self.file, source: error.into() })
            }
            Err(source) => Err(Error::Json { file: self.file, source }),
        }
    }

    /// What came before the first feature tells.
    fn decide(&mut self) {
        if let Own::Undecided = self.own {
            self.own = match metadata::read(|key| self.header.get(key).cloned()) {
                Some((frame, metadata)) => {
                    Own::City(Box::new(Assembly::new(self.file.clone(), frame, metadata)))
                }
                None => Own::Never,
            };
        }
    }

    /// What was gathered, in longitude and latitude (or metres without a place).
    fn placed(mut self) -> Result<Gathering, Error> {
        match system(self.crs.as_ref()) {
            Ok(Some(crs)) => self.gathering.place(&crs)?,
            Ok(None) if self.gathering.looks_like_metres() => self.gathering.leave_placeless()?,
            Ok(None) => self.gathering.place(&Crs::wgs84())?,
            Err(crs) => return Err(Error::CoordinateSystem { file: self.file, crs }),
        }
        Ok(self.gathering)
    }
}

impl Sink for Reader {
    fn member(&mut self, key: &str, value: Json) {
        match (key, value) {
            ("crs", crs) => self.crs = Some(crs),
            ("attribution" | "copyright" | "exurb_attribution", Json::String(text)) => {
                self.gathering.credit(&text);
                self.header.insert(key.to_owned(), text);
            }
            (_, Json::String(text)) => drop(self.header.insert(key.to_owned(), text)),
            _ => {}
        }
    }

    fn feature(&mut self, geometry: Option<Geometry>, properties: &Properties) -> Result<(), Stop> {
        self.decide();
        self.count += 1;
        let Some(geometry) = geometry else {
            self.skipped += 1;
            self.gathering.skip();
            return Ok(());
        };
        let Own::City(assembly) = &mut self.own else {
            let columns = properties.iter().map(|(k, v)| (Cow::Borrowed(k.as_str()), value_of(v)));
            self.gathering.add(geometry, &Attributes::new(columns), &self.hint);
            return Ok(());
        };
        let layer = properties.get("element").and_then(Json::as_str).and_then(layer_of);
        let frame = assembly.frame();
        let shape = geometry.to_grid(|[lon, lat]| frame.project_to_grid(LonLat { lon, lat }));
        let (Some(layer), Some(shape)) = (layer, shape) else {
            self.skipped += 1;
            return Ok(());
        };
        let value = |_, name: &'static str| properties.get(name).map_or(Value::Null, value_of);
        assembly.add(layer, shape, value).map_err(|what| {
            let place = format!("feature {} (a {layer})", self.count);
            self.failure = Some(Error::Content { file: self.file.clone(), place, what });
            Stop
        })
    }
}

fn layer_of(element: &str) -> Option<&'static str> {
    Some(match element {
        "street" => "streets",
        "intersection" => "intersections",
        "block" => "blocks",
        "parcel" => "parcels",
        "building" => "buildings",
        "tree" | "lamp" | "feature" => "features",
        "water" => "water",
        "land_use" => "land_use",
        "target" => "target",
        _ => return None,
    })
}

/// The system that a legacy `crs` member names; `Ok(None)` when there is none, its name when exurb
/// cannot convert it.
pub(super) fn system(crs: Option<&Json>) -> Result<Option<Crs>, String> {
    let Some(crs) = crs.filter(|crs| !crs.is_null()) else { return Ok(None) };
    let properties = crs.get("properties");
    let name = properties.and_then(|p| p.get("name")).and_then(Json::as_str).map(str::to_owned);
    let code = || properties.and_then(|p| p.get("code")).map(|code| format!("EPSG:{code}"));
    let name = name.or_else(code).unwrap_or_else(|| crs.to_string());
    Crs::from_name(&name).map(Some).ok_or(name)
}

fn value_of(value: &Json) -> Value<'_> {
    match value {
        Json::Null | Json::Object(_) => Value::Null,
        // OSMnx has lists of classes and names.
        Json::Array(_) => Value::from(value.to_string()),
        Json::Bool(yes) => Value::Bool(*yes),
        Json::Number(n) => match n.as_i64() {
            Some(n) => Value::Int(n),
            None => n.as_f64().map_or(Value::Null, Value::from),
        },
        Json::String(text) => Value::from(text.as_str()),
    }
}
