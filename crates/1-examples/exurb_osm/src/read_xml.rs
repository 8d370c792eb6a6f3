//! OSM XML, as a stream: nothing but the element at hand is held.

use std::borrow::Cow;
use std::io::BufRead;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use crate::Error;
use crate::elements::{Elements, Member, is_ours};
use crate::tags::{self, Tags};

/// The element being read.
#[derive(Default)]
struct Open {
    /// `node`, `way` or `relation`.
    name: &'static str,
    id: i64,
    tags: Tags,
    refs: Vec<i64>,
    members: Vec<Member>,
    /// Deleted by an editor, or in a history.
    is_gone: bool,
}

/// Reads a whole file.
pub fn read(input: impl BufRead, file: &str) -> Result<Elements, Error> {
    let mut reader = Reader::from_reader(input);
    let config = reader.config_mut();
    config.check_comments = false;
    config.check_end_names = true;
    let mut out = Elements::default();
    let mut buffer = Vec::new();
    let mut open: Option<Open> = None;
    let mut depth = 0usize;
    let mut complete = false;
    let mut in_remark = false;
    loop {
        buffer.clear();
        let at = reader.buffer_position();
        let event = reader.read_event_into(&mut buffer).map_err(|e| failed(file, at, e))?;
        match event {
            Event::Start(tag) => {
                if depth == 0 {
                    root(&tag, file, &mut out)?;
                } else {
                    begin(&tag, &mut open, &mut out);
                }
                in_remark = depth == 1 && tag.name().as_ref() == "remark";
                depth += 1;
            }
            // What Overpass says when a query failed half way.
            Event::Text(text) if in_remark => {
                out.remarks.push(text.xml10_content().trim().to_owned());
                in_remark = false;
            }
            Event::Empty(tag) if depth == 0 => {
                root(&tag, file, &mut out)?;
                complete = true;
            }
            Event::Empty(tag) => {
                begin(&tag, &mut open, &mut out);
                if depth == 1 {
                    finish(&mut open, &mut out);
                }
            }
            Event::End(_) => {
                depth = depth.saturating_sub(1);
                complete |= depth == 0;
                if depth == 1 {
                    finish(&mut open, &mut out);
                }
            }
            Event::Eof => break,
            _ => {}
        }
    }
    if complete { Ok(out) } else { Err(Error::corrupt(file, "it ends before `</osm>`")) }
}

fn failed(file: &str, at: u64, error: quick_xml::Error) -> Error {
    match error {
        quick_xml::Error::Io(e) => {
            Error::reading(file, std::io::Error::new(e.kind(), e.to_string()))
        }
        other => Error::corrupt(file, format!("{other}, at byte {at}")),
    }
}

/// The root element: whose data these are.
fn root(tag: &BytesStart, file: &str, out: &mut Elements) -> Result<(), Error> {
    if tag.name().as_ref() != "osm" {
        let name = tag.name().as_ref().to_owned();
        return Err(Error::corrupt(file, format!("it begins with `<{name}>` instead of `<osm>`")));
    }
    let mut given = Vec::new();
    for (key, value) in attributes(tag) {
        match key {
            "generator" => out.is_ours = is_ours(&value),
            "attribution" | "copyright" => {
                given.extend(value.split("; ").map(str::to_owned));
            }
            _ => {}
        }
    }
    out.attribution = given;
    Ok(())
}

fn begin(tag: &BytesStart, open: &mut Option<Open>, out: &mut Elements) {
    match (tag.name().as_ref(), open.as_mut()) {
        ("tag", Some(open)) => tag_of(tag, open),
        ("nd", Some(open)) if open.name == "way" => {
            let place = place(tag);
            if let Some(id) = place.id {
                open.refs.push(id);
                // Overpass writes positions here when asked for geometry.
                if let (Some(lon), Some(lat)) = (place.lon, place.lat) {
                    out.push_node(id, lon, lat);
                }
            }
        }
        ("member", Some(open)) => open.members.extend(member(tag)),
        ("node", None) => {
            let place = place(tag);
            let Some(id) = place.id.filter(|_| !place.is_gone) else { return };
            out.push_node(id, place.lon.unwrap_or(f64::NAN), place.lat.unwrap_or(f64::NAN));
            *open = Some(Open { name: "node", id, ..Open::default() });
        }
        (name @ ("way" | "relation"), None) => {
            let place = place(tag);
            let name = if name == "way" { "way" } else { "relation" };
            let id = place.id.unwrap_or(0);
            *open = Some(Open {
                name,
                id,
                is_gone: place.is_gone || place.id.is_none(),
                ..Open::default()
            });
        }
        ("bounds" | "bound", None) => bounds(tag, out),
        _ => {}
    }
}

fn finish(open: &mut Option<Open>, out: &mut Elements) {
    match open.take() {
        Some(Open { is_gone: true, .. }) | None => {}
        Some(e) if e.name == "node" => out.push_node_tags(e.id, e.tags),
        Some(e) if e.name == "way" => out.push_way(e.id, e.tags, e.refs),
        Some(e) => out.push_relation(e.id, e.tags, e.members),
    }
}

/// Attributes with their values unescaped; what is no attribute is passed over.
fn attributes<'a>(tag: &'a BytesStart) -> impl Iterator<Item = (&'a str, Cow<'a, str>)> {
    let mut list = tag.attributes();
    list.with_checks(false);
    list.flatten().map(|a| {
        let raw: Cow<'a, str> = a.value;
        let value = match quick_xml::escape::unescape(&raw) {
            Ok(Cow::Owned(text)) => Cow::Owned(text),
            // Nothing to unescape, or an unknown entity: as it stands.
            _ => raw,
        };
        (a.key.into_inner(), value)
    })
}

#[derive(Default)]
struct Place {
    id: Option<i64>,
    lon: Option<f64>,
    lat: Option<f64>,
    is_gone: bool,
}

fn place(tag: &BytesStart) -> Place {
    let mut out = Place::default();
    for (key, value) in attributes(tag) {
        match key {
            "id" | "ref" => out.id = value.parse().ok(),
            "lon" => out.lon = value.parse().ok(),
            "lat" => out.lat = value.parse().ok(),
            "visible" => out.is_gone |= value == "false",
            "action" => out.is_gone |= value == "delete",
            _ => {}
        }
    }
    out
}

fn tag_of(tag: &BytesStart, open: &mut Open) {
    let (mut key, mut text) = (None, None);
    for (name, value) in attributes(tag) {
        match name {
            "k" => key = tags::key(&value),
            "v" => text = Some(value),
            _ => {}
        }
    }
    if let (Some(key), Some(text)) = (key, text) {
        open.tags.push(key, &*text);
    }
}

fn member(tag: &BytesStart) -> Option<Member> {
    let (mut is_way, mut way, mut is_inner) = (false, None, false);
    for (key, value) in attributes(tag) {
        match key {
            "type" => is_way = value == "way",
            "ref" => way = value.parse().ok(),
            "role" => is_inner = value == "inner",
            _ => {}
        }
    }
    way.filter(|_| is_way).map(|way| Member { way, is_inner })
}

/// `<bounds minlat minlon maxlat maxlon>`, or Osmosis' `<bound box="s,w,n,e">`.
fn bounds(tag: &BytesStart, out: &mut Elements) {
    let mut found = [f64::NAN; 4];
    for (key, value) in attributes(tag) {
        let number = |text: &str| text.trim().parse().unwrap_or(f64::NAN);
        match key {
            "minlon" => found[0] = number(&value),
            "minlat" => found[1] = number(&value),
            "maxlon" => found[2] = number(&value),
            "maxlat" => found[3] = number(&value),
            "box" => {
                let sides: Vec<f64> = value.split(',').map(number).collect();
                if let [s, w, n, e] = sides[..] {
                    found = [w, s, e, n];
                }
            }
            _ => {}
        }
    }
    out.bounds = Some(found);
}
