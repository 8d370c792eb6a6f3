//! GeoJSON as a stream: whatever its outermost object is, features come one by one.
//!
//! Collections, single features, bare geometries, and several of them one after the other
//! (newline-delimited GeoJSON). Only one feature is held at a time.

use std::fmt;
use std::io::{BufRead, BufReader, Read};

use serde::Deserialize;
use serde::de::{
    DeserializeSeed, Deserializer, Error as _, IgnoredAny, MapAccess, SeqAccess, Visitor,
};

use crate::geometry::{Geometry, Position};

/// Any JSON value.
pub type Json = serde_json::Value;
/// A JSON object, such as the properties of a feature.
pub type Properties = serde_json::Map<String, Json>;

/// Who takes what the stream finds.
pub trait Sink {
    /// A member of the outermost object that may say something: `crs`, `attribution`, `exurb_...`.
    fn member(&mut self, key: &str, value: Json);
    /// A feature; no geometry when it has none that can be read. `Err` ends the reading.
    fn feature(&mut self, geometry: Option<Geometry>, properties: &Properties) -> Result<(), Stop>;
}

/// The sink has a reason to read no further, and keeps it.
pub struct Stop;

/// Reads all objects of `input` into `sink`.
pub fn read(input: impl Read, sink: &mut impl Sink) -> serde_json::Result<()> {
    let mut input = BufReader::with_capacity(1 << 16, input);
    // Some programs begin with a byte-order mark.
    if input.fill_buf().is_ok_and(|start| start.starts_with("\u{feff}".as_bytes())) {
        input.consume(3);
    }
    let mut json = serde_json::Deserializer::from_reader(input);
    loop {
        Outermost(sink).deserialize(&mut json)?;
        if json.end().is_ok() {
            return Ok(());
        }
    }
}

struct Outermost<'a, S>(&'a mut S);

impl<'de, S: Sink> DeserializeSeed<'de> for Outermost<'_, S> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, json: D) -> Result<(), D::Error> {
        json.deserialize_map(self)
    }
}

impl<'de, S: Sink> Visitor<'de> for Outermost<'_, S> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a GeoJSON object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        let mut own = Object::default();
        let mut is_collection = false;
        while let Some(key) = map.next_key::<String>()? {
            match key.as_str() {
                "features" => {
                    is_collection = true;
                    map.next_value_seed(Features(self.0))?;
                }
                "type" => own.kind = map.next_value()?,
                "geometry" => own.geometry = map.next_value()?,
                "coordinates" => own.coordinates = map.next_value()?,
                "geometries" => own.geometries = map.next_value()?,
                "properties" => own.properties = map.next_value()?,
                "crs" | "attribution" | "copyright" => self.0.member(&key, map.next_value()?),
                own if own.starts_with("exurb_") => self.0.member(&key, map.next_value()?),
                _ => drop(map.next_value::<IgnoredAny>()?),
            }
        }
        if is_collection || own.kind.as_deref() == Some("FeatureCollection") {
            return Ok(());
        }
        own.give(self.0).map_err(|Stop| A::Error::custom("stopped"))
    }
}

struct Features<'a, S>(&'a mut S);

impl<'de, S: Sink> DeserializeSeed<'de> for Features<'_, S> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, json: D) -> Result<(), D::Error> {
        json.deserialize_seq(self)
    }
}

impl<'de, S: Sink> Visitor<'de> for Features<'_, S> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of features")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        while let Some(feature) = list.next_element::<Object>()? {
            feature.give(self.0).map_err(|Stop| A::Error::custom("stopped"))?;
        }
        Ok(())
    }
}

/// A feature or a geometry.
#[derive(Default, Deserialize)]
struct Object {
    #[serde(default, rename = "type")]
    kind: Option<String>,
    #[serde(default)]
    geometry: Option<Box<Object>>,
    #[serde(default)]
    coordinates: Option<Nested>,
    #[serde(default)]
    geometries: Option<Vec<Object>>,
    #[serde(default)]
    properties: Option<Properties>,
}

impl Object {
    fn give(self, sink: &mut impl Sink) -> Result<(), Stop> {
        let is_feature = self.kind.as_deref() == Some("Feature");
        let properties = self.properties.unwrap_or_default();
        let geometry = match is_feature {
            true => self.geometry.and_then(|g| g.geometry()),
            false => Self { properties: None, ..self }.geometry(),
        };
        sink.feature(geometry, &properties)
    }

    fn geometry(self) -> Option<Geometry> {
        let many =
            |parts: Option<Vec<Geometry>>| parts.filter(|p| !p.is_empty()).map(Geometry::Many);
        let each = |read: fn(Nested) -> Option<Geometry>, list: Nested| {
            many(list.list()?.into_iter().map(read).collect())
        };
        if self.kind.as_deref() == Some("GeometryCollection") {
            return many(self.geometries?.into_iter().map(Self::geometry).collect());
        }
        let coordinates = self.coordinates?;
        match self.kind.as_deref()? {
            "Point" => coordinates.point(),
            "LineString" => coordinates.line(),
            "Polygon" => coordinates.polygon(),
            "MultiPoint" => each(Nested::point, coordinates),
            "MultiLineString" => each(Nested::line, coordinates),
            "MultiPolygon" => each(Nested::polygon, coordinates),
            _ => None,
        }
    }
}

/// Coordinates, whatever the type of their geometry.
enum Nested {
    Number(f64),
    Position(Position),
    List(Vec<Nested>),
}

impl Nested {
    fn list(self) -> Option<Vec<Self>> {
        if let Self::List(list) = self { Some(list) } else { None }
    }

    fn position(self) -> Option<Position> {
        if let Self::Position(p) = self { Some(p) } else { None }
    }

    fn positions(self) -> Option<Vec<Position>> {
        self.list()?.into_iter().map(Self::position).collect()
    }

    fn point(self) -> Option<Geometry> {
        self.position().map(Geometry::Point)
    }

    fn line(self) -> Option<Geometry> {
        self.positions().map(Geometry::Line)
    }

    fn polygon(self) -> Option<Geometry> {
        self.list()?.into_iter().map(Self::positions).collect::<Option<_>>().map(Geometry::Polygon)
    }
}

impl<'de> Deserialize<'de> for Nested {
    fn deserialize<D: Deserializer<'de>>(json: D) -> Result<Self, D::Error> {
        json.deserialize_any(NestedVisitor)
    }
}

struct NestedVisitor;

impl<'de> Visitor<'de> for NestedVisitor {
    type Value = Nested;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("coordinates")
    }

    fn visit_f64<E>(self, number: f64) -> Result<Nested, E> {
        Ok(Nested::Number(number))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Nested, E> {
        Ok(Nested::Number(number as f64))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Nested, E> {
        Ok(Nested::Number(number as f64))
    }

    /// `null` for a number that is none.
    fn visit_unit<E>(self) -> Result<Nested, E> {
        Ok(Nested::Number(f64::NAN))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Nested, A::Error> {
        let mut list = match seq.next_element()? {
            Some(Nested::Number(x)) => {
                let y = match seq.next_element()? {
                    Some(Nested::Number(y)) => y,
                    _ => f64::NAN,
                };
                while seq.next_element::<IgnoredAny>()?.is_some() {}
                return Ok(Nested::Position([x, y]));
            }
            Some(first) => vec![first],
            None => Vec::new(),
        };
        while let Some(next) = seq.next_element()? {
            list.push(next);
        }
        Ok(Nested::List(list))
    }
}
