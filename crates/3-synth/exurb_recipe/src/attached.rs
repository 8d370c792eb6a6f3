//! Files that parameters name: read before a step runs, since operations open none.
//!
//! A property whose schema says `x-file` takes a file's name. `polygon` stands for the outline in it, in
//! the city's frame; `style-map` for areas with the names of examples, or for an image.

use std::path::{Path, PathBuf};

use exurb_geom::{Frame, GridPoint, LonLat, Polygon};
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
    let wrong = |message: &str| Error::Input(open::named(path, message));
    let text = std::fs::read_to_string(path).map_err(|e| wrong(&format!("cannot be read: {e}")))?;
    let document: Value =
        serde_json::from_str(&text).map_err(|e| wrong(&format!("is no GeoJSON: {e}")))?;
    let features = document.get("features").and_then(Value::as_array);
    let features = features.ok_or_else(|| wrong("is no GeoJSON FeatureCollection"))?;
    let mut out = Vec::new();
    for feature in features {
        let example = feature.pointer("/properties/example").and_then(Value::as_str);
        let example = example.ok_or_else(|| {
            wrong(
                "a feature lacks the property `example`, the name of the example that serves there",
            )
        })?;
        let coordinates = feature.pointer("/geometry/coordinates").and_then(Value::as_array);
        let polygons = match feature.pointer("/geometry/type").and_then(Value::as_str) {
            Some("Polygon") => coordinates.map(|c| vec![Value::from(c.clone())]),
            Some("MultiPolygon") => coordinates.cloned(),
            _ => None,
        };
        let polygons = polygons.ok_or_else(|| wrong("a feature is no Polygon"))?;
        for polygon in &polygons {
            let outer = polygon.get(0).and_then(Value::as_array).into_iter().flatten();
            let ring: Option<Vec<[f64; 2]>> = outer.map(|p| local(p, frame)).collect();
            let ring = ring.ok_or_else(|| wrong("a coordinate is no place near the city"))?;
            out.push(json!({ "example": example, "polygon": [ring] }));
        }
    }
    Ok(json!({ "areas": out }))
}

fn local(position: &Value, frame: &Frame) -> Option<[f64; 2]> {
    let place = LonLat { lon: position.get(0)?.as_f64()?, lat: position.get(1)?.as_f64()? };
    let p = frame.project_to_grid(place)?.to_m();
    Some([p.x, p.y])
}

/// Width, height and the colours `0xrrggbb` of an image, row by row from the north-west.
fn image(path: &Path) -> Result<Value, Error> {
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
    Ok(json!({ "width": frame.width, "height": frame.height, "pixels": pixels }))
}
