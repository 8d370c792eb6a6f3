//! Files that parameters name: read before a step runs, since operations open none.
//!
//! A property whose schema says `x-file` takes a file's name. `polygon` stands for the outline in it, in
//! the city's frame; `domains` for areas with their uses and examples; `style-map` for areas with the
//! names of examples, or for an image; `lines` for the streets in it.

use std::path::{Path, PathBuf};

use exurb_city::ImportOptions;
use exurb_geom::{Frame, GridPoint, LonLat, Polygon, Vec2};
use exurb_operation::Run;
use serde_json::{Map, Value, json};

use crate::{Error, open, target};

/// Pixels of an image at most: what a map of styles needs many times over.
const MOST_PIXELS: u64 = 16_000_000;

/// The properties of a schema that name files, with what is to be read from them.
fn file_properties(schema: &Value) -> impl Iterator<Item = (&String, &str)> {
    let properties = schema.get("properties").and_then(Value::as_object);
    let kind = |property: &Value| property.get("x-file").and_then(Value::as_str).map(str::to_owned);
    properties.into_iter().flatten().filter_map(move |(name, property)| {
        kind(property).and_then(|_| Some((name, property.get("x-file")?.as_str()?)))
    })
}

/// The parameters with the contents of the files they name.
pub fn read(
    params: &Map<String, Value>,
    schema: &Value,
    frame: &Frame,
    folder: &Path,
    run: &Run,
) -> Result<Map<String, Value>, Error> {
    let mut out = params.clone();
    for (name, kind) in file_properties(schema) {
        let Some(file) = params.get(name).and_then(Value::as_str).filter(|f| !f.is_empty()) else {
            continue;
        };
        let file = Path::new(file);
        let content = match kind {
            "polygon" => {
                let polygon = target::read_in_frame(file, frame, folder, run)?;
                json!({ "polygon": rings(&polygon) })
            }
            "lines" => lines(&open::locate(file, folder)?)?,
            "domains" => domains(&open::locate(file, folder)?, frame)?,
            _ if is_png(file) => image(&open::locate(file, folder)?)?,
            _ => areas(&open::locate(file, folder)?, frame)?,
        };
        out.insert(name.clone(), content);
    }
    Ok(out)
}

/// The parameters with files by their names alone.
pub fn by_name(params: &mut Map<String, Value>, schema: &Value) {
    for (name, _) in file_properties(schema) {
        let Some(Value::String(file)) = params.get_mut(name) else { continue };
        if let Some(short) = PathBuf::from(&*file).file_name().and_then(|n| n.to_str()) {
            *file = short.to_owned();
        }
    }
}

fn is_png(file: &Path) -> bool {
    file.extension().is_some_and(|e| e.eq_ignore_ascii_case("png"))
}

fn rings(polygon: &Polygon) -> Vec<Vec<[f64; 2]>> {
    let ring = |r: &[GridPoint]| r.iter().map(|p| [p.to_m().x, p.to_m().y]).collect();
    polygon.rings().map(ring).collect()
}

/// The polygons of a GeoJSON file with their property `example`.
fn areas(path: &Path, frame: &Frame) -> Result<Value, Error> {
    let mut out = Vec::new();
    for (properties, polygon) in polygons(path, frame)? {
        let example = properties.get("example").and_then(Value::as_str);
        let example = example.ok_or_else(|| {
            let message =
                "a feature lacks the property `example`, the name of the example that serves there";
            Error::Input(open::named(path, message))
        })?;
        out.push(json!({ "example": example, "polygon": rings(&polygon) }));
    }
    Ok(json!({ "areas": out }))
}

/// The streets of a map, around its middle.
fn lines(path: &Path) -> Result<Value, Error> {
    let city = open::open_city(path, &ImportOptions::default())?.city;
    let point = |p: &Vec2| [p.x, p.y];
    let lines: Vec<Vec<[f64; 2]>> =
        city.streets.edges().map(|(_, e)| e.line_m().iter().map(point).collect()).collect();
    let origin = city.frame.unproject(Vec2::ZERO);
    Ok(json!({ "origin": [origin.lon, origin.lat], "lines": lines }))
}

/// The polygons of a GeoJSON file with what they say of growth: `use`, `example` or `examples` with
/// weights, `density`, and `start` or `starts`.
fn domains(path: &Path, frame: &Frame) -> Result<Value, Error> {
    let wrong = |message: &str| Error::Input(open::named(path, message));
    let mut out = Vec::new();
    for (properties, polygon) in polygons(path, frame)? {
        let kind = properties.get("use").and_then(Value::as_str).unwrap_or("flat");
        let examples = match (properties.get("example"), properties.get("examples")) {
            (Some(Value::String(name)), _) => json!({ name: 1.0 }),
            (_, Some(Value::Object(weights))) => Value::Object(weights.clone()),
            (_, Some(Value::Array(names))) => {
                names.iter().filter_map(Value::as_str).map(|n| (n.to_owned(), json!(1.0))).collect()
            }
            (None, None) => json!({}),
            _ => return Err(wrong("`examples` is neither a list of names nor names with weights")),
        };
        let density = properties.get("density").filter(|d| !d.is_null());
        if density.is_some_and(|d| d.as_f64().is_none_or(|d| d <= 0.0)) {
            return Err(wrong("`density` is no number of km/km² above 0"));
        }
        let starts = match (properties.get("start"), properties.get("starts")) {
            (Some(Value::String(start)), _) => json!([start]),
            (_, Some(Value::Array(list))) if list.iter().all(Value::is_string) => json!(list),
            (None | Some(Value::Null), None | Some(Value::Null)) => json!([]),
            _ => return Err(wrong("`starts` is no list of LON,LAT or LON,LAT=LON,LAT")),
        };
        out.push(json!({
            "use": kind, "examples": examples, "density": density, "starts": starts,
            "polygon": rings(&polygon),
        }));
    }
    Ok(json!({ "areas": out }))
}

/// A polygon and the properties that somebody gave it.
pub type Drawn = (Map<String, Value>, Polygon);

/// The polygons of a GeoJSON file, in the city's frame, with their properties.
pub fn polygons(path: &Path, frame: &Frame) -> Result<Vec<Drawn>, Error> {
    let wrong = |message: &str| Error::Input(open::named(path, message));
    let text = std::fs::read_to_string(path).map_err(|e| wrong(&format!("cannot be read: {e}")))?;
    let document: Value =
        serde_json::from_str(&text).map_err(|e| wrong(&format!("is no GeoJSON: {e}")))?;
    let features = document.get("features").and_then(Value::as_array);
    let features = features.ok_or_else(|| wrong("is no GeoJSON FeatureCollection"))?;
    let mut out = Vec::new();
    for feature in features {
        let properties = feature.get("properties").and_then(Value::as_object);
        let properties = properties.cloned().unwrap_or_default();
        let coordinates = feature.pointer("/geometry/coordinates").and_then(Value::as_array);
        let found = match feature.pointer("/geometry/type").and_then(Value::as_str) {
            Some("Polygon") => coordinates.map(|c| vec![c.clone()]),
            Some("MultiPolygon") => {
                coordinates.map(|c| c.iter().filter_map(Value::as_array).cloned().collect())
            }
            _ => None,
        };
        for polygon in found.ok_or_else(|| wrong("a feature is no Polygon"))? {
            let ring = |r: &Value| -> Option<Vec<GridPoint>> {
                r.as_array()?.iter().map(|p| local(p, frame)).collect()
            };
            let rings: Option<Vec<Vec<GridPoint>>> = polygon.iter().map(ring).collect();
            let mut rings = rings.ok_or_else(|| wrong("a coordinate is no place near the city"))?;
            let outer = if rings.is_empty() { Vec::new() } else { rings.remove(0) };
            let polygon = Polygon::new(outer, rings);
            let polygon = polygon.filter(Polygon::is_valid);
            let message = "a polygon has no area or crosses itself";
            out.push((properties.clone(), polygon.ok_or_else(|| wrong(message))?));
        }
    }
    Ok(out)
}

fn local(position: &Value, frame: &Frame) -> Option<GridPoint> {
    let place = LonLat { lon: position.get(0)?.as_f64()?, lat: position.get(1)?.as_f64()? };
    frame.project_to_grid(place)
}

/// Colours of an image, row by row from the north-west.
#[derive(Clone, Debug)]
pub struct Image {
    width: u32,
    height: u32,
    /// `0xrrggbb`.
    pixels: Vec<u32>,
}

impl Image {
    /// The colour at shares of width and height, from the north-west.
    pub fn color(&self, x: f64, y: f64) -> u32 {
        let at = |share: f64, size: u32| ((share * f64::from(size)).max(0.0) as u32).min(size - 1);
        self.pixels[(at(y, self.height) * self.width + at(x, self.width)) as usize]
    }
}

/// Is that a PNG image of colours, not of heights?
pub fn has_colors(path: &Path) -> bool {
    let decoder =
        std::fs::File::open(path).ok().map(|f| png::Decoder::new(std::io::BufReader::new(f)));
    let reader = decoder.and_then(|d| d.read_info().ok());
    reader.is_some_and(|r| {
        let info = r.info();
        info.bit_depth != png::BitDepth::Sixteen
            && !matches!(
                info.color_type,
                png::ColorType::Grayscale | png::ColorType::GrayscaleAlpha
            )
    })
}

fn image(path: &Path) -> Result<Value, Error> {
    let Image { width, height, pixels } = read_image(path)?;
    Ok(json!({ "width": width, "height": height, "pixels": pixels }))
}

/// Reads an image of colours.
pub fn read_image(path: &Path) -> Result<Image, Error> {
    let wrong = |message: &str| Error::Input(open::named(path, message));
    let file = std::fs::File::open(path).map_err(|e| wrong(&format!("cannot be read: {e}")))?;
    let mut decoder = png::Decoder::new(std::io::BufReader::new(file));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(|e| wrong(&format!("is no PNG image: {e}")))?;
    let info = reader.info();
    if u64::from(info.width) * u64::from(info.height) > MOST_PIXELS {
        return Err(wrong("has over 16 million pixels; draw the map of styles smaller"));
    }
    let size = reader.output_buffer_size().ok_or_else(|| wrong("is too large an image"))?;
    let mut bytes = vec![0; size];
    let frame =
        reader.next_frame(&mut bytes).map_err(|e| wrong(&format!("is a broken image: {e}")))?;
    let samples = frame.color_type.samples();
    let color = |pixel: &[u8]| {
        let (r, g, b) = if samples < 3 { (0, 0, 0) } else { (0, 1, 2) };
        u32::from(pixel[r]) << 16 | u32::from(pixel[g]) << 8 | u32::from(pixel[b])
    };
    let pixels: Vec<u32> = bytes[..frame.buffer_size()].chunks_exact(samples).map(color).collect();
    if pixels.is_empty() {
        return Err(wrong("is an empty image"));
    }
    Ok(Image { width: frame.width, height: frame.height, pixels })
}
