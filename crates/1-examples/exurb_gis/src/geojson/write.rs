//! City → GeoJSON.

use std::borrow::Borrow;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use exurb_city::{Area, Building, City, Feature};
use exurb_geom::{Frame, GridPoint, LonLat};

use crate::Error;
use crate::beside::Beside;
use crate::layers::{self, Kind, Layer, StreetRow, Streets, TargetRow};
use crate::metadata;
use crate::numbered::numbered;
use crate::value::Value;
use crate::wkb::Shape;

/// Writes a city as one GeoJSON feature collection (contract, section 4; RFC 7946): WGS 84 with 9
/// decimals, rings closed and right-handed.
///
/// Every feature has `element`, the columns of its layer that are known, and the properties OSM
/// would give it (`highway`, `building`, `building:levels`, `roof:shape`; `bridge`, `tunnel` and
/// `oneway` are `yes` or absent). The `id` among the properties is that of the layer, the feature's
/// own is its number in the file. `bbox` is the largest box of longitude and latitude inside the
/// target; what travels with the city stands in foreign members (`exurb_version`,
/// `exurb_attribution`, ...). Streams; O(n).
pub fn write_geojson(city: &City, out: &mut impl Write) -> io::Result<()> {
    write_geojson_streets(city, Streets::ALL, out)
}

/// [`write_geojson`], of streets and intersections what `streets` says.
pub fn write_geojson_streets(
    city: &City,
    streets: Streets,
    out: &mut impl Write,
) -> io::Result<()> {
    let city = numbered(city);
    out.write_all(b"{\"type\":\"FeatureCollection\"")?;
    if let Some([sw, ne]) = city.lonlat_bbox() {
        let sides = [sw.lon, sw.lat, ne.lon, ne.lat].map(|side| degrees(side, 7));
        write!(out, ",\n\"bbox\":[{}]", sides.join(","))?;
    }
    for (key, value) in metadata::entries(&city) {
        write!(out, ",\n\"{key}\":{}", quoted(&value))?;
    }
    out.write_all(b",\n\"features\":[")?;
    let mut writer = Features { frame: &city.frame, out, count: 0 };
    writer.city(&city, streets)?;
    out.write_all(b"\n]}\n")
}

/// [`write_geojson`] into a file, which is replaced when the new one is whole.
pub fn write_geojson_file(city: &City, path: &Path) -> Result<(), Error> {
    let (beside, file) = Beside::create(path)?;
    let mut out = BufWriter::new(file);
    write_geojson(city, &mut out)
        .and_then(|()| out.flush())
        .map_err(|source| Error::Write { file: path.display().to_string(), source })?;
    drop(out);
    beside.finish()
}

struct Features<'a, W> {
    frame: &'a Frame,
    out: &'a mut W,
    count: usize,
}

impl<W: Write> Features<'_, W> {
    fn city(&mut self, city: &City, streets: Streets) -> io::Result<()> {
        self.layer(
            "target",
            &layers::TARGET,
            [(TargetRow { id: 1 }, Shape::Polygon(&city.target))],
        )?;
        for (row, shape) in layers::street_rows(city).filter(|_| streets.lines) {
            self.feature("street", &layers::STREETS, &row, shape, of_street)?;
        }
        let intersections = layers::intersection_rows(city).filter(|_| streets.intersections);
        self.layer("intersection", &layers::INTERSECTIONS, intersections)?;
        let blocks = city.blocks.iter().map(|b| (b, Shape::Polygon(&b.polygon)));
        self.layer("block", &layers::BLOCKS, blocks)?;
        let parcels = city.parcels.iter().map(|p| (p, Shape::Polygon(&p.polygon)));
        self.layer("parcel", &layers::PARCELS, parcels)?;
        for building in city.buildings.iter() {
            let shape = Shape::Polygon(&building.polygon);
            self.feature("building", &layers::BUILDINGS, building, shape, of_building)?;
        }
        for feature in city.features.iter() {
            let shape = Shape::of(&feature.shape);
            self.feature(element(feature), &layers::FEATURES, feature, shape, |_, _| {})?;
        }
        self.layer("water", &layers::WATER, areas(&city.water))?;
        self.layer("land_use", &layers::LAND_USE, areas(&city.land_use))
    }

    fn layer<'s, T: 'static, R: Borrow<T>>(
        &mut self,
        element: &str,
        layer: &Layer<T>,
        rows: impl IntoIterator<Item = (R, Shape<'s>)>,
    ) -> io::Result<()> {
        for (row, shape) in rows {
            self.feature(element, layer, row.borrow(), shape, |_, _| {})?;
        }
        Ok(())
    }

    fn feature<T>(
        &mut self,
        element: &str,
        layer: &Layer<T>,
        row: &T,
        shape: Shape<'_>,
        osm: fn(&T, &mut Properties),
    ) -> io::Result<()> {
        let mut properties = Properties(format!("\"element\":\"{element}\""));
        osm(row, &mut properties);
        for column in layer.columns() {
            match (column.kind, (column.get)(row)) {
                (Kind::Flag, Value::Bool(true)) => properties.put(column.name, &"yes".into()),
                (Kind::Flag, _) => {}
                (_, value) => properties.put(column.name, &value),
            }
        }
        let comma = if self.count == 0 { "" } else { "," };
        self.count += 1;
        let geometry = self.geometry(shape);
        let properties = properties.0;
        write!(
            self.out,
            "{comma}\n{{\"type\":\"Feature\",\"id\":{},\"properties\":{{{properties}}},\
             \"geometry\":{geometry}}}",
            self.count
        )
    }

    fn geometry(&self, shape: Shape<'_>) -> String {
        let (kind, coordinates) = match shape {
            Shape::Point(p) => ("Point", self.position(p)),
            Shape::Line(line) => ("LineString", self.positions(line)),
            Shape::Polygon(polygon) => {
                let rings: Vec<String> = polygon
                    .rings()
                    .map(|ring| self.positions(ring.iter().chain(&ring[..1])))
                    .collect();
                ("Polygon", format!("[{}]", rings.join(",")))
            }
        };
        format!("{{\"type\":\"{kind}\",\"coordinates\":{coordinates}}}")
    }

    fn positions<'p>(&self, points: impl IntoIterator<Item = &'p GridPoint>) -> String {
        let words: Vec<String> = points.into_iter().map(|p| self.position(*p)).collect();
        format!("[{}]", words.join(","))
    }

    fn position(&self, p: GridPoint) -> String {
        let LonLat { lon, lat } = self.frame.unproject(p.to_m());
        format!("[{},{}]", degrees(lon, DECIMALS), degrees(lat, DECIMALS))
    }
}

/// The members of `properties`, without braces.
struct Properties(String);

impl Properties {
    fn put(&mut self, name: &str, value: &Value<'_>) {
        let word = match value {
            Value::Null => return,
            Value::Bool(yes) => yes.to_string(),
            Value::Int(n) => n.to_string(),
            Value::Real(n) => {
                serde_json::Number::from_f64(*n).map_or("null".into(), |n| n.to_string())
            }
            Value::Text(text) => quoted(text),
        };
        self.0 += &format!(",{}:{word}", quoted(name));
    }
}

fn of_street(row: &StreetRow, properties: &mut Properties) {
    properties.put("highway", &row.street.class.as_str().into());
}

fn of_building(building: &Building, properties: &mut Properties) {
    let key = if building.is_part { "building:part" } else { "building" };
    properties.put(key, &building.usage.as_deref().unwrap_or("yes").into());
    properties.put("building:levels", &building.levels.into());
    if let Some(roof) = building.roof {
        properties.put("roof:shape", &roof.as_str().into());
    }
}

fn element(feature: &Feature) -> &'static str {
    match &*feature.kind {
        "tree" => "tree",
        "lamp" => "lamp",
        _ => "feature",
    }
}

fn areas(areas: &[Area]) -> impl Iterator<Item = (&Area, Shape<'_>)> {
    areas.iter().map(|area| (area, Shape::Polygon(&area.polygon)))
}

/// Decimals of positions: a tenth of a millimetre, so that the grid comes back exactly. With the 7
/// of OSM (a centimetre) walls that houses share would overlap where one has a corner more.
const DECIMALS: usize = 9;

/// So many decimals, without zeros at the end.
fn degrees(value: f64, decimals: usize) -> String {
    let word = format!("{value:.decimals$}");
    let word = word.trim_end_matches('0').trim_end_matches('.');
    if word == "-0" { "0".to_owned() } else { word.to_owned() }
}

fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}
