//! GeoPackage → city.

use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

use exurb_city::{ImportOptions, Imported, Metadata};
use exurb_geom::{Crs, Frame, GridPoint, Vec2};
use rusqlite::types::ValueRef;
use rusqlite::{Connection, OpenFlags, OptionalExtension};

use super::{schema, terrain};
use crate::Error;
use crate::assembly::Assembly;
use crate::gathering::Gathering;
use crate::layers;
use crate::metadata;
use crate::recognise::Attributes;
use crate::value::Value;
use crate::wkb;

/// Reads a GeoPackage: a city file of our own as the very city it was written from, any other by
/// its lines and polygons (see the table in the crate's documentation).
///
/// A city file whose streets were drawn or moved by another program is noded and its blocks are
/// derived anew, with a warning. Layers of other files may be in any coordinate system with an EPSG
/// code or a common projection; a plane system beyond that is taken as metres of an unknown place.
/// Rows stream; the file is not held. O(n log n).
pub fn read_geopackage(path: &Path, options: &ImportOptions) -> Result<Imported, Error> {
    let db = open(path)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    read_database(&db, &path.display().to_string(), &name, options)
}

/// Opens a database to read.
pub(super) fn open(path: &Path) -> Result<Connection, Error> {
    let file = path.display().to_string();
    // SQLite would say only that it cannot open the file.
    std::fs::File::open(path).map_err(|source| Error::Read { file: file.clone(), source })?;
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let database = |source| Error::Database { file: file.clone(), source };
    let db = Connection::open_with_flags(path, flags).map_err(database)?;
    distrust(&db).map_err(database)?;
    Ok(db)
}

/// A file is data: nothing in it is run, and pages that lie about their size are errors.
fn distrust(db: &Connection) -> rusqlite::Result<()> {
    db.execute_batch("PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON;")
}

/// The frame and the metadata of a city of our own.
pub(super) fn metadata_of(db: &Connection) -> Option<(Frame, Metadata)> {
    metadata::read(|key: &str| entry_of(db, key))
}

/// What travels with a city of our own under a key.
fn entry_of(db: &Connection, key: &str) -> Option<String> {
    let sql = format!("SELECT value FROM {} WHERE key = ?", schema::METADATA_TABLE);
    db.query_row(&sql, [key], |row| row.get(0)).optional().ok().flatten()
}

/// Reads an open database.
pub(crate) fn read_database(
    db: &Connection,
    file: &str,
    name: &str,
    options: &ImportOptions,
) -> Result<Imported, Error> {
    let database = |source| Error::Database { file: file.to_owned(), source };
    distrust(db).map_err(database)?;
    match metadata_of(db) {
        Some((frame, metadata)) => {
            let mut assembly = Assembly::new(file.to_owned(), frame, metadata);
            let level = entry_of(db, metadata::WATER_LEVEL).and_then(|level| level.parse().ok());
            let ground = terrain::read(db, file)?;
            assembly.terrain = ground.map(|ground| Arc::new(ground.with_water_level(level)));
            read_own(db, file, &mut assembly)?;
            assembly.finish(options)
        }
        None => {
            let mut gathering = Gathering::new(file.to_owned(), name.to_owned());
            for layer in foreign_layers(db).map_err(database)? {
                read_layer(db, &layer, &mut gathering)?;
            }
            gathering.finish(options)
        }
    }
}

fn read_own(db: &Connection, file: &str, assembly: &mut Assembly) -> Result<(), Error> {
    for layer in layers::NAMES {
        read_own_layer(db, file, layer, &layers::column_names(layer), assembly)?;
    }
    Ok(())
}

fn read_own_layer(
    db: &Connection,
    file: &str,
    layer: &str,
    names: &[&str],
    assembly: &mut Assembly,
) -> Result<(), Error> {
    let database = |source| Error::Database { file: file.to_owned(), source };
    let present = columns(db, layer).map_err(database)?;
    if present.is_empty() {
        return Ok(());
    }
    let list: String = names
        .iter()
        .map(|name| {
            let there = present.iter().any(|c| c.eq_ignore_ascii_case(name));
            if there { format!(", {}", quoted(name)) } else { ", NULL".to_owned() }
        })
        .collect();
    let sql = format!("SELECT fid, geom{list} FROM {} ORDER BY fid", quoted(layer));
    let mut select = db.prepare(&sql).map_err(database)?;
    let mut rows = select.query([]).map_err(database)?;
    while let Some(row) = rows.next().map_err(database)? {
        let content = |what: String| {
            let fid = row.get::<_, i64>(0).unwrap_or_default();
            let place = format!("layer `{layer}`, row {fid}");
            Error::Content { file: file.to_owned(), place, what }
        };
        let geometry = match row.get_ref(1).map_err(database)? {
            ValueRef::Null => None,
            ValueRef::Blob(blob) => {
                wkb::decode(blob).map_err(|what| content(format!("the geometry {what}")))?
            }
            _ => return Err(content("the geometry is no blob".to_owned())),
        };
        let place = |p| GridPoint::checked(Vec2::from_array(p));
        let Some(shape) = geometry.and_then(|g| g.to_grid(place)) else {
            return Err(content(
                "the geometry is empty or not of this layer; delete the row".to_owned(),
            ));
        };
        let value = |number: usize, _| row.get_ref(number + 2).map_or(Value::Null, value_of);
        assembly.add(layer, shape, value).map_err(content)?;
    }
    Ok(())
}

/// A layer of somebody else's file.
pub(super) struct ForeignLayer {
    pub table: String,
    pub geometry: String,
    crs: String,
    definition: String,
    srs_id: i64,
}

/// The layers that the file says hold geometries, by name.
pub(super) fn foreign_layers(db: &Connection) -> rusqlite::Result<Vec<ForeignLayer>> {
    let mut select = db.prepare(
        "SELECT g.table_name, g.column_name, g.srs_id,
           coalesce(s.organization || ':' || s.organization_coordsys_id, 'number ' || g.srs_id),
           coalesce(s.definition, '')
         FROM gpkg_geometry_columns g LEFT JOIN gpkg_spatial_ref_sys s ON s.srs_id = g.srs_id
         ORDER BY g.table_name",
    )?;
    let layers = select.query_map([], |row| {
        Ok(ForeignLayer {
            table: row.get(0)?,
            geometry: row.get(1)?,
            srs_id: row.get(2)?,
            crs: row.get(3)?,
            definition: row.get(4)?,
        })
    })?;
    layers.collect()
}

/// Are all column names UTF-8? The library panics where they are not.
fn has_readable_names(db: &Connection, table: &str) -> rusqlite::Result<bool> {
    let mut select = db.prepare("SELECT name FROM pragma_table_xinfo(?)")?;
    let mut rows = select.query([table])?;
    while let Some(row) = rows.next()? {
        let is_text = match row.get_ref(0)? {
            ValueRef::Text(name) => std::str::from_utf8(name).is_ok(),
            _ => false,
        };
        if !is_text {
            return Ok(false);
        }
    }
    Ok(true)
}

fn read_layer(db: &Connection, layer: &ForeignLayer, into: &mut Gathering) -> Result<(), Error> {
    let file = into.file.clone();
    let database = |source| Error::Database { file: file.clone(), source };
    let sql = format!("SELECT * FROM {}", quoted(&layer.table));
    let mut select = db.prepare(&sql).map_err(database)?;
    if !has_readable_names(db, &layer.table).map_err(database)? {
        return Err(Error::Content {
            file: file.clone(),
            place: format!("layer `{}`", layer.table),
            what: "the name of a column is no text; export it anew".to_owned(),
        });
    }
    let names: Vec<String> = select.column_names().map(str::to_owned).collect();
    let Some(at) = names.iter().position(|n| n.eq_ignore_ascii_case(&layer.geometry)) else {
        return Err(Error::Content {
            file: file.clone(),
            place: format!("layer `{}`", layer.table),
            what: format!("the geometry column `{}` is missing; export it anew", layer.geometry),
        });
    };
    let mut rows = select.query([]).map_err(database)?;
    while let Some(row) = rows.next().map_err(database)? {
        let geometry = match row.get_ref(at).map_err(database)? {
            ValueRef::Blob(blob) => wkb::decode(blob).ok().flatten(),
            _ => None,
        };
        let Some(geometry) = geometry else {
            into.skip();
            continue;
        };
        let columns = names.iter().enumerate().filter(|(i, _)| *i != at).map(|(i, name)| {
            (Cow::Borrowed(name.as_str()), row.get_ref(i).map_or(Value::Null, value_of))
        });
        into.add(geometry, &Attributes::new(columns), &layer.table);
    }
    place(layer, into)
}

fn place(layer: &ForeignLayer, into: &mut Gathering) -> Result<(), Error> {
    match layer.placing(&into.file)? {
        Placing::At(crs) => into.place(&crs),
        Placing::Nowhere => {
            if layer.srs_id != -1 {
                into.warn(format!(
                    "layer `{}` is in {}, which exurb cannot convert; reproject it to EPSG:4326 \
                     to give the city its place",
                    layer.table, layer.crs
                ));
            }
            into.leave_placeless()
        }
        Placing::Unsaid if into.looks_like_metres() => into.leave_placeless(),
        Placing::Unsaid => {
            into.warn(format!(
                "layer `{}` names no coordinate system: its coordinates are taken as degrees",
                layer.table
            ));
            into.place(&Crs::wgs84())
        }
    }
}

/// What the coordinates of a layer mean.
pub(super) enum Placing {
    /// Places in a system that can be converted.
    At(Box<Crs>),
    /// Metres of an unknown place.
    Nowhere,
    /// Written by a program that knew no system: the numbers tell.
    Unsaid,
}

impl ForeignLayer {
    /// What its coordinates mean; an error when exurb cannot make metres or places of them.
    pub fn placing(&self, file: &str) -> Result<Placing, Error> {
        let crs = match self.srs_id {
            // 0 and -1 are the standard's words for an unknown place: in degrees, and in the plane.
            0 => Some(Crs::wgs84()),
            -1 => return Ok(Placing::Nowhere),
            _ => Crs::from_name(&self.crs).or_else(|| Crs::from_wkt(&self.definition)),
        };
        match crs {
            Some(crs) => Ok(Placing::At(Box::new(crs))),
            None if is_undefined(&self.definition) => Ok(Placing::Unsaid),
            None if is_in_metres(&self.definition) => Ok(Placing::Nowhere),
            None => Err(Error::CoordinateSystem { file: file.to_owned(), crs: self.crs.clone() }),
        }
    }
}

/// Does the system say that it is unknown, as GDAL's does (`LOCAL_CS["Undefined SRS", ...]`)?
fn is_undefined(definition: &str) -> bool {
    let upper = definition.to_ascii_uppercase();
    let local = ["LOCAL_CS[", "ENGCRS[", "ENGINEERINGCRS["];
    local.iter().any(|word| upper.starts_with(word)) && upper.contains("\"UNDEFINED")
}

/// Is the system one of a plane, in metres? Then shapes and sizes are right without a place.
fn is_in_metres(definition: &str) -> bool {
    let upper = definition.to_ascii_uppercase();
    let plane = ["PROJCS[", "PROJCRS[", "PROJECTEDCRS[", "LOCAL_CS[", "ENGCRS[", "ENGINEERINGCRS["];
    plane.iter().any(|word| upper.starts_with(word))
        && (upper.contains("\"METRE\",1") || upper.contains("\"METER\",1"))
}

/// Names of a table's columns; none when there is no such table.
fn columns(db: &Connection, table: &str) -> rusqlite::Result<Vec<String>> {
    let mut select = db.prepare("SELECT name FROM pragma_table_info(?)")?;
    select.query_map([table], |row| row.get(0))?.collect()
}

pub(super) fn quoted(name: &str) -> String {
    format!("\"{}\"", name.replace('"', "\"\""))
}

fn value_of(value: ValueRef<'_>) -> Value<'_> {
    match value {
        ValueRef::Null | ValueRef::Blob(_) => Value::Null,
        ValueRef::Integer(n) => Value::Int(n),
        ValueRef::Real(n) => Value::from(n),
        ValueRef::Text(text) => match std::str::from_utf8(text) {
            Ok(text) => Value::from(text),
            Err(_) => Value::Null,
        },
    }
}
