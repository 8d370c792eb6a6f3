//! City → GeoPackage.

use std::path::Path;

use exurb_city::City;
use exurb_geom::{Bounds, Polygon};
use rusqlite::types::{ToSqlOutput, ValueRef};
use rusqlite::{Connection, ToSql, params};

use super::{schema, terrain};
use crate::Error;
use crate::beside::Beside;
use crate::layers::{self, GeometryType, Kind, Layer, Streets, TargetRow};
use crate::metadata;
use crate::numbered::numbered;
use crate::theme::Theme;
use crate::value::Value;
use crate::wkb::{self, Shape};

/// Writes a city as one GeoPackage 1.4 (contract, section 4).
///
/// Layers `streets`, `intersections`, `blocks`, `parcels`, `buildings`, `features`, `water`,
/// `land_use` and `target`, each with an R-tree, in the city's own transverse Mercator; the table
/// `exurb_metadata` holds what travels with the city; a terrain is the raster `terrain`. Equal cities give equal files, byte for byte.
/// An existing file is replaced when the new one is whole. O(n log n), for the R-trees.
pub fn write_geopackage(city: &City, path: &Path) -> Result<(), Error> {
    write_geopackage_streets(city, Streets::ALL, path)
}

/// [`write_geopackage`], of streets and intersections what `streets` says.
pub fn write_geopackage_streets(city: &City, streets: Streets, path: &Path) -> Result<(), Error> {
    let (beside, _) = Beside::create(path)?;
    let numbered = numbered(city);
    let write = |db: &Connection| {
        write_layers(db, &numbered, streets)?;
        numbered.terrain.as_ref().map_or(Ok(()), |ground| terrain::write(db, ground))
    };
    write_database(&numbered, beside.path(), write)
        .map_err(|source| Error::WriteDatabase { file: path.display().to_string(), source })?;
    forget_journals(path);
    beside.finish()
}

/// Removes the journals that another program left beside a file about to be replaced: they would be
/// played into the new one.
pub fn forget_journals(path: &Path) {
    for ending in ["-wal", "-shm", "-journal"] {
        let mut name = path.as_os_str().to_owned();
        name.push(ending);
        // Usually there is none.
        let _ = std::fs::remove_file(name);
    }
}

/// Writes layers of figures on a city as one GeoPackage in the city's own coordinates, with what
/// travels with the city. An existing file is replaced when the new one is whole.
pub fn write_themes(city: &City, themes: &[Theme], path: &Path) -> Result<(), Error> {
    let (beside, _) = Beside::create(path)?;
    let write = |db: &Connection| themes.iter().try_for_each(|theme| write_theme(db, theme));
    write_database(city, beside.path(), write)
        .map_err(|source| Error::WriteDatabase { file: path.display().to_string(), source })?;
    forget_journals(path);
    beside.finish()
}

fn write_database(
    city: &City,
    path: &Path,
    layers: impl Fn(&Connection) -> rusqlite::Result<()>,
) -> rusqlite::Result<()> {
    let mut db = Connection::open(path)?;
    schema::prepare(&db)?;
    let transaction = db.transaction()?;
    schema::create_tables(&transaction, &city.frame)?;
    let mut entries = metadata::entries(city).to_vec();
    if let Some(level) = city.terrain.as_ref().and_then(|terrain| terrain.water_level_m()) {
        entries.push((metadata::WATER_LEVEL, level.to_string()));
    }
    schema::write_metadata(&transaction, &entries)?;
    layers(&transaction)?;
    transaction.commit()?;
    db.close().map_err(|(_, error)| error)
}

fn write_theme(db: &Connection, theme: &Theme) -> rusqlite::Result<()> {
    let columns: Vec<(&str, Kind)> = theme.columns.iter().map(|name| (*name, Kind::Real)).collect();
    let rows = theme.rows.iter().map(|row| (&row.values, Shape::of(&row.shape)));
    write_rows(db, theme.name, theme.geometry, &columns, rows, figure)
}

fn figure<'a>(row: &'a &Vec<Option<f64>>, column: usize) -> Value<'a> {
    row.get(column).copied().flatten().map_or(Value::Null, Value::Real)
}

fn write_layers(db: &Connection, city: &City, streets: Streets) -> rusqlite::Result<()> {
    let lines = layers::street_rows(city).filter(|_| streets.lines);
    write_layer(db, &layers::STREETS, lines)?;
    let intersections = layers::intersection_rows(city).filter(|_| streets.intersections);
    write_layer(db, &layers::INTERSECTIONS, intersections)?;
    write_layer(db, &layers::BLOCKS, polygons(&city.blocks, |b| &b.polygon))?;
    write_layer(db, &layers::PARCELS, polygons(&city.parcels, |p| &p.polygon))?;
    write_layer(db, &layers::BUILDINGS, polygons(&city.buildings, |b| &b.polygon))?;
    let features = city.features.iter().map(|f| (f, Shape::of(&f.shape)));
    write_layer(db, &layers::FEATURES, features)?;
    write_layer(db, &layers::WATER, polygons(&city.water, |a| &a.polygon))?;
    write_layer(db, &layers::LAND_USE, polygons(&city.land_use, |a| &a.polygon))?;
    let target = (TargetRow { id: 1 }, Shape::Polygon(&city.target));
    write_layer(db, &layers::TARGET, [target])
}

fn polygons<T>(rows: &[T], polygon: fn(&T) -> &Polygon) -> impl Iterator<Item = (&T, Shape<'_>)> {
    rows.iter().map(move |row| (row, Shape::Polygon(polygon(row))))
}

fn write_layer<'a, T: 'static, R: std::borrow::Borrow<T>>(
    db: &Connection,
    layer: &Layer<T>,
    rows: impl IntoIterator<Item = (R, Shape<'a>)>,
) -> rusqlite::Result<()> {
    let columns: Vec<_> = layer.columns().collect();
    let named: Vec<(&str, Kind)> = columns.iter().map(|c| (c.name, c.kind)).collect();
    write_rows(db, layer.name, layer.geometry, &named, rows, |row, column| {
        (columns[column].get)(row.borrow())
    })
}

/// Writes rows of a layer, whose values `value` gives by row and column.
fn write_rows<'a, R>(
    db: &Connection,
    name: &str,
    geometry: GeometryType,
    columns: &[(&str, Kind)],
    rows: impl IntoIterator<Item = (R, Shape<'a>)>,
    value: impl Fn(&R, usize) -> Value<'_>,
) -> rusqlite::Result<()> {
    schema::create_layer(db, name, geometry, columns)?;
    let holes: String = columns.iter().map(|_| ", ?").collect();
    let mut insert = db.prepare(&format!("INSERT INTO {name} VALUES (?, ?{holes})"))?;
    let mut index = db.prepare(&format!("INSERT INTO rtree_{name}_geom VALUES (?, ?, ?, ?, ?)"))?;
    let mut blob = Vec::new();
    let mut extent: Option<Bounds> = None;
    for ((row, shape), fid) in rows.into_iter().zip(1_i64..) {
        wkb::encode(shape, schema::LOCAL_SRS, &mut blob);
        insert.raw_bind_parameter(1, fid)?;
        insert.raw_bind_parameter(2, &blob)?;
        for column in 0..columns.len() {
            insert.raw_bind_parameter(column + 3, value(&row, column))?;
        }
        insert.raw_execute()?;
        let bounds = shape.bounds();
        let Bounds { min, max } = bounds;
        index.execute(params![fid, min.x, max.x, min.y, max.y])?;
        extent = Some(extent.map_or(bounds, |e| e.union(bounds)));
    }
    if let Some(Bounds { min, max }) = extent {
        db.execute(
            "UPDATE gpkg_contents SET min_x = ?, min_y = ?, max_x = ?, max_y = ? \
             WHERE table_name = ?",
            params![min.x, min.y, max.x, max.y, name],
        )?;
    }
    schema::create_triggers(db, name)
}

impl ToSql for Value<'_> {
    fn to_sql(&self) -> rusqlite::Result<ToSqlOutput<'_>> {
        Ok(ToSqlOutput::Borrowed(match self {
            Self::Null => ValueRef::Null,
            Self::Bool(yes) => ValueRef::Integer(i64::from(*yes)),
            Self::Int(n) => ValueRef::Integer(*n),
            Self::Real(n) => ValueRef::Real(*n),
            Self::Text(text) => ValueRef::Text(text.as_bytes()),
        }))
    }
}
