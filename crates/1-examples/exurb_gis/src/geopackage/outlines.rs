//! The polygons of a GeoPackage, as outlines of a target.

use std::io::Read;
use std::path::Path;

use rusqlite::Connection;
use rusqlite::types::ValueRef;

use super::read::{ForeignLayer, Placing, foreign_layers, metadata_of, open, quoted};
use crate::Error;
use crate::geometry::Geometry;
use crate::target::{Outlines, System};
use crate::wkb;

/// Does the file begin as a database does?
pub fn is_geopackage(path: &Path) -> bool {
    const MAGIC: &[u8; 16] = b"SQLite format 3\0";
    let mut head = [0; MAGIC.len()];
    let read = std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut head));
    read.is_ok() && head == *MAGIC
}

/// The target of a city of our own, else the polygons of all layers, which share their coordinate
/// system.
pub fn outlines(path: &Path) -> Result<Outlines, Error> {
    let db = open(path)?;
    let file = path.display().to_string();
    let database = |source| Error::Database { file: file.clone(), source };
    let own = metadata_of(&db);
    let mut found = Outlines::default();
    for layer in foreign_layers(&db).map_err(database)? {
        if own.is_some() && layer.table != "target" {
            continue;
        }
        let polygons = polygons(&db, &layer).map_err(database)?;
        if polygons.is_empty() {
            continue;
        }
        let system = match &own {
            Some((frame, _)) => System::Own(frame.clone()),
            None => match layer.placing(&file)? {
                Placing::At(crs) => System::Known(*crs),
                Placing::Nowhere | Placing::Unsaid => System::Unsaid,
            },
        };
        if !found.polygons.is_empty() && own.is_none() {
            return Err(Error::Target {
                file,
                what: "has polygons in several layers; keep the target alone in a file".to_owned(),
            });
        }
        found = Outlines { polygons, system };
    }
    Ok(found)
}

fn polygons(db: &Connection, layer: &ForeignLayer) -> rusqlite::Result<Vec<Geometry>> {
    let sql = format!("SELECT {} FROM {}", quoted(&layer.geometry), quoted(&layer.table));
    let mut select = db.prepare(&sql)?;
    let mut rows = select.query([])?;
    let mut out = Vec::new();
    while let Some(row) = rows.next()? {
        if let ValueRef::Blob(blob) = row.get_ref(0)? {
            out.extend(
                wkb::decode(blob).ok().flatten().into_iter().flat_map(Geometry::into_polygons),
            );
        }
    }
    Ok(out)
}
