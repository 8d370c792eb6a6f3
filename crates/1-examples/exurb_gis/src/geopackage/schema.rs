//! The tables of a GeoPackage 1.4 beside the layers, and the statements that make them.

use exurb_geom::Frame;
use rusqlite::{Connection, params};

use crate::layers::{GeometryType, Kind};

/// `GPKG` in ASCII.
pub const APPLICATION_ID: i32 = 0x4750_4B47;
/// GeoPackage 1.4.
const USER_VERSION: i32 = 10_400;
/// Number of the city's own coordinate system; numbers below are taken by EPSG.
pub const LOCAL_SRS: i32 = 100_000;
/// Equal cities are equal files: the standard wants a time, this is always the same one.
pub const LAST_CHANGE: &str = "2000-01-01T00:00:00.000Z";
/// The table of what travels with the city: keys and values.
pub const METADATA_TABLE: &str = "exurb_metadata";

const WGS84_WKT: &str = "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,\
     298.257223563,AUTHORITY[\"EPSG\",\"7030\"]],AUTHORITY[\"EPSG\",\"6326\"]],\
     PRIMEM[\"Greenwich\",0,AUTHORITY[\"EPSG\",\"8901\"]],UNIT[\"degree\",0.0174532925199433,\
     AUTHORITY[\"EPSG\",\"9122\"]],AXIS[\"Latitude\",NORTH],AXIS[\"Longitude\",EAST],\
     AUTHORITY[\"EPSG\",\"4326\"]]";

const TABLES: &str = "
CREATE TABLE gpkg_spatial_ref_sys (
  srs_name TEXT NOT NULL, srs_id INTEGER NOT NULL PRIMARY KEY, organization TEXT NOT NULL,
  organization_coordsys_id INTEGER NOT NULL, definition TEXT NOT NULL, description TEXT);
CREATE TABLE gpkg_contents (
  table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL, identifier TEXT UNIQUE,
  description TEXT DEFAULT '',
  last_change DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')),
  min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE, srs_id INTEGER,
  CONSTRAINT fk_gc_r_srs_id FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));
CREATE TABLE gpkg_geometry_columns (
  table_name TEXT NOT NULL, column_name TEXT NOT NULL, geometry_type_name TEXT NOT NULL,
  srs_id INTEGER NOT NULL, z TINYINT NOT NULL, m TINYINT NOT NULL,
  CONSTRAINT pk_geom_cols PRIMARY KEY (table_name, column_name),
  CONSTRAINT uk_gc_table_name UNIQUE (table_name),
  CONSTRAINT fk_gc_tn FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name),
  CONSTRAINT fk_gc_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys (srs_id));
CREATE TABLE gpkg_extensions (
  table_name TEXT, column_name TEXT, extension_name TEXT NOT NULL, definition TEXT NOT NULL,
  scope TEXT NOT NULL, CONSTRAINT ge_tce UNIQUE (table_name, column_name, extension_name));
CREATE TABLE gpkg_metadata (
  id INTEGER CONSTRAINT m_pk PRIMARY KEY ASC NOT NULL, md_scope TEXT NOT NULL DEFAULT 'dataset',
  md_standard_uri TEXT NOT NULL, mime_type TEXT NOT NULL DEFAULT 'text/xml',
  metadata TEXT NOT NULL DEFAULT '');
CREATE TABLE gpkg_metadata_reference (
  reference_scope TEXT NOT NULL, table_name TEXT, column_name TEXT, row_id_value INTEGER,
  timestamp DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')),
  md_file_id INTEGER NOT NULL, md_parent_id INTEGER,
  CONSTRAINT crmr_mfi_fk FOREIGN KEY (md_file_id) REFERENCES gpkg_metadata(id),
  CONSTRAINT crmr_mpi_fk FOREIGN KEY (md_parent_id) REFERENCES gpkg_metadata(id));
INSERT INTO gpkg_extensions VALUES
  ('gpkg_metadata', NULL, 'gpkg_metadata',
   'http://www.geopackage.org/spec140/#extension_metadata', 'read-write'),
  ('gpkg_metadata_reference', NULL, 'gpkg_metadata',
   'http://www.geopackage.org/spec140/#extension_metadata', 'read-write');
CREATE TABLE exurb_metadata (
  fid INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, key TEXT NOT NULL UNIQUE, value TEXT NOT NULL);
";

/// Settings of a file that is written once, by one connection: no journal, no locks to share.
pub fn prepare(db: &Connection) -> rusqlite::Result<()> {
    db.pragma_update(None, "page_size", 4096)?;
    db.pragma_update(None, "journal_mode", "OFF")?;
    db.pragma_update(None, "synchronous", "OFF")?;
    db.pragma_update(None, "locking_mode", "EXCLUSIVE")?;
    db.pragma_update(None, "cache_size", -65_536)?;
    db.pragma_update(None, "application_id", APPLICATION_ID)?;
    db.pragma_update(None, "user_version", USER_VERSION)
}

/// Makes the tables every GeoPackage has and names the coordinate systems.
pub fn create_tables(db: &Connection, frame: &Frame) -> rusqlite::Result<()> {
    db.execute_batch(TABLES)?;
    let place = frame.origin();
    let name = format!("exurb local ({:.7}, {:.7})", place.lon, place.lat);
    let local_wkt = frame.to_wkt();
    let rows = [
        ("Undefined Cartesian SRS", -1, "NONE", -1, "undefined", "undefined Cartesian coordinates"),
        ("Undefined geographic SRS", 0, "NONE", 0, "undefined", "undefined geographic coordinates"),
        ("WGS 84 geodetic", 4326, "EPSG", 4326, WGS84_WKT, "longitude and latitude in degrees"),
        (&name, LOCAL_SRS, "NONE", LOCAL_SRS, &local_wkt, "metres around the city's centre"),
    ];
    for row in rows {
        db.execute("INSERT INTO gpkg_spatial_ref_sys VALUES (?, ?, ?, ?, ?, ?)", row)?;
    }
    db.execute(
        "INSERT INTO gpkg_contents (table_name, data_type, identifier, description, last_change)
         VALUES (?1, 'attributes', ?1, 'what travels with the city', ?2)",
        params![METADATA_TABLE, LAST_CHANGE],
    )?;
    Ok(())
}

/// Writes what travels with the city: as rows of its own table, which exurb reads back, and in the
/// standard's metadata tables in the form in which GDAL and QGIS show it.
pub fn write_metadata(db: &Connection, entries: &[(&str, String)]) -> rusqlite::Result<()> {
    let mut shown = String::new();
    for (key, value) in entries {
        db.execute("INSERT INTO exurb_metadata (key, value) VALUES (?, ?)", params![key, value])?;
        shown += &format!("<MDI key=\"{key}\">{}</MDI>", escape_xml(value));
    }
    let xml =
        format!("<GDALMultiDomainMetadata><Metadata>{shown}</Metadata></GDALMultiDomainMetadata>");
    db.execute(
        "INSERT INTO gpkg_metadata VALUES (1, 'dataset', 'http://gdal.org', 'text/xml', ?)",
        [xml],
    )?;
    db.execute(
        "INSERT INTO gpkg_metadata_reference VALUES ('geopackage', NULL, NULL, NULL, ?, 1, NULL)",
        [LAST_CHANGE],
    )?;
    Ok(())
}

fn escape_xml(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Makes the table of a layer and its R-tree, and registers both.
pub fn create_layer(
    db: &Connection,
    name: &str,
    geometry: GeometryType,
    columns: &[(&str, Kind)],
) -> rusqlite::Result<()> {
    let geometry = match geometry {
        GeometryType::Point => "POINT",
        GeometryType::LineString => "LINESTRING",
        GeometryType::Polygon => "POLYGON",
        GeometryType::Any => "GEOMETRY",
    };
    let columns: String = columns.iter().map(|c| format!(", {}", definition(*c))).collect();
    db.execute_batch(&format!(
        "CREATE TABLE {name} (fid INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, geom {geometry}\
         {columns});
         CREATE VIRTUAL TABLE rtree_{name}_geom USING rtree(id, minx, maxx, miny, maxy);
         INSERT INTO gpkg_extensions VALUES ('{name}', 'geom', 'gpkg_rtree_index',
           'http://www.geopackage.org/spec140/#extension_rtree', 'write-only');
         INSERT INTO gpkg_contents (table_name, data_type, identifier, last_change, srs_id)
           VALUES ('{name}', 'features', '{name}', '{LAST_CHANGE}', {LOCAL_SRS});
         INSERT INTO gpkg_geometry_columns
           VALUES ('{name}', 'geom', '{geometry}', {LOCAL_SRS}, 0, 0);"
    ))
}

fn definition((name, kind): (&str, Kind)) -> String {
    let kind = match kind {
        Kind::Boolean | Kind::Flag => "BOOLEAN",
        Kind::Integer => "INTEGER",
        Kind::Real => "REAL",
        Kind::Text => "TEXT",
    };
    format!("\"{name}\" {kind}")
}

/// The triggers that keep a layer's R-tree up to date when another program edits the file
/// (GeoPackage 1.4, F.3). Made after the rows: this file's own rows fill the tree themselves.
pub fn create_triggers(db: &Connection, layer: &str) -> rusqlite::Result<()> {
    let tree = format!("rtree_{layer}_geom");
    let bounds = "ST_MinX(NEW.geom), ST_MaxX(NEW.geom), ST_MinY(NEW.geom), ST_MaxY(NEW.geom)";
    let some = |row: &str| format!("({row}.geom NOTNULL AND NOT ST_IsEmpty({row}.geom))");
    let none = |row: &str| format!("({row}.geom ISNULL OR ST_IsEmpty({row}.geom))");
    let (new, no_new, old, no_old) = (some("NEW"), none("NEW"), some("OLD"), none("OLD"));
    let put = format!("INSERT OR REPLACE INTO {tree} VALUES (NEW.fid, {bounds});");
    let update = format!(
        "UPDATE {tree} SET minx = ST_MinX(NEW.geom), maxx = ST_MaxX(NEW.geom), \
         miny = ST_MinY(NEW.geom), maxy = ST_MaxY(NEW.geom) WHERE id = NEW.fid;"
    );
    let drop_old = format!("DELETE FROM {tree} WHERE id = OLD.fid;");
    let drop_both = format!("DELETE FROM {tree} WHERE id IN (OLD.fid, NEW.fid);");
    let same = "OLD.fid = NEW.fid";
    let moved = "OLD.fid != NEW.fid";
    let triggers = [
        ("insert", "INSERT", new.clone(), put.clone()),
        ("update2", "UPDATE", format!("{same} AND {no_new}"), drop_old.clone()),
        ("update4", "UPDATE", format!("{moved} AND {no_new}"), drop_both),
        ("update5", "UPDATE", format!("{moved} AND {new}"), format!("{drop_old} {put}")),
        ("update6", "UPDATE OF geom", format!("{same} AND {new} AND {old}"), update),
        ("update7", "UPDATE OF geom", format!("{same} AND {new} AND {no_old}"), put),
        ("delete", "DELETE", "OLD.geom NOTNULL".to_owned(), drop_old),
    ];
    for (name, event, condition, action) in triggers {
        db.execute_batch(&format!(
            "CREATE TRIGGER {tree}_{name} AFTER {event} ON {layer} WHEN {condition} \
             BEGIN {action} END;"
        ))?;
    }
    Ok(())
}
