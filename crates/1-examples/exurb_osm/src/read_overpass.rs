//! Overpass JSON, as a stream: element by element, with positions inside ways and relations
//! (`out geom`) or in nodes of their own.

use std::fmt;
use std::io::BufRead;

use serde::Deserialize;
use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};

use crate::Error;
use crate::elements::{Elements, Member};
use crate::tags::Tags;

/// Reads a whole file.
pub fn read(input: impl BufRead, file: &str) -> Result<Elements, Error> {
    let mut out = Elements::default();
    let mut json = serde_json::Deserializer::from_reader(input);
    let found = Document { out: &mut out }
        .deserialize(&mut json)
        .and_then(|found| json.end().map(|()| found))
        .map_err(|e| match e.io_error_kind() {
            Some(kind) => Error::reading(file, std::io::Error::new(kind, e.to_string())),
            None => Error::corrupt(file, e),
        })?;
    if found {
        Ok(out)
    } else {
        Err(Error::corrupt(
            file,
            "it has no `elements`; Overpass JSON does (GeoJSON has `features`)",
        ))
    }
}

/// The outer object; says whether there were elements.
struct Document<'a> {
    out: &'a mut Elements,
}

impl<'de> DeserializeSeed<'de> for Document<'_> {
    type Value = bool;

    fn deserialize<D: Deserializer<'de>>(self, json: D) -> Result<bool, D::Error> {
        json.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Document<'_> {
    type Value = bool;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("an object with `elements`")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<bool, A::Error> {
        let mut found = false;
        while let Some(key) = map.next_key::<String>()? {
            match key.as_str() {
                "elements" => {
                    map.next_value_seed(List { out: self.out })?;
                    found = true;
                }
                "osm3s" => {
                    let head: Head = map.next_value()?;
                    self.out.attribution.extend(head.copyright);
                }
                "remark" => self.out.remarks.push(map.next_value()?),
                _ => {
                    map.next_value::<IgnoredAny>()?;
                }
            }
        }
        Ok(found)
    }
}

struct List<'a> {
    out: &'a mut Elements,
}

impl<'de> DeserializeSeed<'de> for List<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, json: D) -> Result<(), D::Error> {
        json.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for List<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a list of elements")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        while let Some(element) = list.next_element::<Element>()? {
            element.put(self.out);
        }
        Ok(())
    }
}

#[derive(Deserialize)]
struct Head {
    copyright: Option<String>,
}

#[derive(Deserialize)]
struct Element {
    #[serde(rename = "type")]
    kind: String,
    #[serde(default)]
    id: i64,
    lat: Option<f64>,
    lon: Option<f64>,
    #[serde(default)]
    tags: Tags,
    #[serde(default)]
    nodes: Vec<i64>,
    #[serde(default)]
    geometry: Vec<Option<Place>>,
    #[serde(default)]
    members: Vec<JsonMember>,
}

#[derive(Clone, Copy, Deserialize)]
struct Place {
    lat: f64,
    lon: f64,
}

#[derive(Deserialize)]
struct JsonMember {
    #[serde(rename = "type")]
    kind: String,
    #[serde(rename = "ref", default)]
    id: i64,
    #[serde(default)]
    role: String,
    #[serde(default)]
    geometry: Vec<Option<Place>>,
}

impl Element {
    fn put(self, out: &mut Elements) {
        match self.kind.as_str() {
            "node" => {
                let degrees = |v: Option<f64>| v.unwrap_or(f64::NAN);
                out.push_node(self.id, degrees(self.lon), degrees(self.lat));
                out.push_node_tags(self.id, self.tags);
            }
            "way" => put_way(self.id, self.tags, self.nodes, &self.geometry, out),
            "relation" => {
                let mut members = Vec::new();
                for member in self.members.into_iter().filter(|m| m.kind == "way") {
                    members.push(Member { way: member.id, is_inner: member.role == "inner" });
                    if !member.geometry.is_empty() {
                        put_way(member.id, Tags::default(), Vec::new(), &member.geometry, out);
                    }
                }
                out.push_relation(self.id, self.tags, members);
            }
            _ => {}
        }
    }
}

/// A way whose positions may stand beside its node ids or in place of them.
fn put_way(id: i64, tags: Tags, nodes: Vec<i64>, geometry: &[Option<Place>], out: &mut Elements) {
    if nodes.is_empty() {
        // A position that is null is a node that is missing: no node has the id 0.
        let ids: Vec<i64> = geometry.iter().map(|p| p.map_or(0, id_of_place)).collect();
        put_nodes(&ids, geometry, out);
        out.push_way(id, tags, ids);
    } else {
        put_nodes(&nodes, geometry, out);
        out.push_way(id, tags, nodes);
    }
}

fn put_nodes(ids: &[i64], geometry: &[Option<Place>], out: &mut Elements) {
    for (id, place) in ids.iter().zip(geometry) {
        if let Some(place) = place {
            out.push_node(*id, place.lon, place.lat);
        }
    }
}

/// A negative id that equal positions share, so that ways without node ids meet where they touch.
fn id_of_place(place: Place) -> i64 {
    let fixed = |degrees: f64| (degrees.clamp(-180.0, 180.0) * 1e7).round() as i64 + 1_800_000_000;
    -1 - fixed(place.lon) * 3_600_000_001 - fixed(place.lat)
}

impl<'de> Deserialize<'de> for Tags {
    fn deserialize<D: Deserializer<'de>>(json: D) -> Result<Self, D::Error> {
        struct Pairs;
        impl<'de> Visitor<'de> for Pairs {
            type Value = Tags;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("tags")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Tags, A::Error> {
                let mut tags = Tags::default();
                while let Some((key, value)) = map.next_entry::<String, String>()? {
                    if let Some(key) = crate::tags::key(&key) {
                        tags.push(key, value);
                    }
                }
                Ok(tags)
            }
        }
        json.deserialize_map(Pairs)
    }
}
