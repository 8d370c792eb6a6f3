//! The terrain: a raster in the same file, by the OGC extension for tiled gridded coverage
//! (17-066r1), which GDAL and QGIS read.
//!
//! One zoom level of square tiles of at most 256 heights a side, each a TIFF of 32-bit floats; the
//! table is called `terrain`. Heights stand in the middles of cells. What is missing, and what tiles have beyond the
//! terrain, is [`MISSING`]; the extent in `gpkg_contents` says how far the terrain goes.

use exurb_city::Terrain;
use exurb_geom::GridPoint;
use exurb_terrain::tile;
use rusqlite::{Connection, OptionalExtension, params};

use super::schema::{LAST_CHANGE, LOCAL_SRS};
use crate::Error;

/// Name of the table.
const TABLE: &str = "terrain";
/// Most posts along the side of a tile.
const MOST_SIDE: usize = 256;
/// What stands for no height.
const MISSING: f32 = -32_768.0;

const TABLES: &str = "
CREATE TABLE gpkg_tile_matrix_set (
  table_name TEXT NOT NULL PRIMARY KEY, srs_id INTEGER NOT NULL, min_x DOUBLE NOT NULL,
  min_y DOUBLE NOT NULL, max_x DOUBLE NOT NULL, max_y DOUBLE NOT NULL,
  CONSTRAINT fk_gtms_table_name FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name),
  CONSTRAINT fk_gtms_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys (srs_id));
CREATE TABLE gpkg_tile_matrix (
  table_name TEXT NOT NULL, zoom_level INTEGER NOT NULL, matrix_width INTEGER NOT NULL,
  matrix_height INTEGER NOT NULL, tile_width INTEGER NOT NULL, tile_height INTEGER NOT NULL,
  pixel_x_size DOUBLE NOT NULL, pixel_y_size DOUBLE NOT NULL,
  CONSTRAINT pk_ttm PRIMARY KEY (table_name, zoom_level),
  CONSTRAINT fk_tmm_table_name FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name));
CREATE TABLE gpkg_2d_gridded_coverage_ancillary (
  id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, tile_matrix_set_name TEXT NOT NULL UNIQUE,
  datatype TEXT NOT NULL DEFAULT 'integer', scale REAL NOT NULL DEFAULT 1.0,
  offset REAL NOT NULL DEFAULT 0.0, precision REAL DEFAULT 1.0, data_null REAL,
  grid_cell_encoding TEXT DEFAULT 'grid-value-is-center', uom TEXT,
  field_name TEXT DEFAULT 'Height', quantity_definition TEXT DEFAULT 'Height',
  CONSTRAINT fk_g2dgtct_name FOREIGN KEY (tile_matrix_set_name)
    REFERENCES gpkg_tile_matrix_set ( table_name )
  CHECK (datatype in ('integer','float')));
CREATE TABLE gpkg_2d_gridded_tile_ancillary (
  id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, tpudt_name TEXT NOT NULL,
  tpudt_id INTEGER NOT NULL, scale REAL NOT NULL DEFAULT 1.0, offset REAL NOT NULL DEFAULT 0.0,
  min REAL DEFAULT NULL, max REAL DEFAULT NULL, mean REAL DEFAULT NULL,
  std_dev REAL DEFAULT NULL,
  CONSTRAINT fk_g2dgtat_name FOREIGN KEY (tpudt_name) REFERENCES gpkg_contents(table_name),
  UNIQUE (tpudt_name, tpudt_id));
CREATE TABLE terrain (
  id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, zoom_level INTEGER NOT NULL,
  tile_column INTEGER NOT NULL, tile_row INTEGER NOT NULL, tile_data BLOB NOT NULL,
  UNIQUE (zoom_level, tile_column, tile_row));
INSERT INTO gpkg_extensions VALUES
  ('gpkg_2d_gridded_coverage_ancillary', NULL, 'gpkg_2d_gridded_coverage',
   'http://docs.opengeospatial.org/is/17-066r1/17-066r1.html', 'read-write'),
  ('gpkg_2d_gridded_tile_ancillary', NULL, 'gpkg_2d_gridded_coverage',
   'http://docs.opengeospatial.org/is/17-066r1/17-066r1.html', 'read-write'),
  ('terrain', 'tile_data', 'gpkg_2d_gridded_coverage',
   'http://docs.opengeospatial.org/is/17-066r1/17-066r1.html', 'read-write');
";

/// The extension wants a system with heights to be there, whether used or not.
const WGS84_3D: &str = "GEODCRS[\"WGS 84\",DATUM[\"World Geodetic System 1984\",\
     ELLIPSOID[\"WGS 84\",6378137,298.257223563,LENGTHUNIT[\"metre\",1.0]]],CS[ellipsoidal,3],\
     AXIS[\"latitude\",north,ORDER[1],ANGLEUNIT[\"degree\",0.0174532925199433]],\
     AXIS[\"longitude\",east,ORDER[2],ANGLEUNIT[\"degree\",0.0174532925199433]],\
     AXIS[\"ellipsoidal height\",up,ORDER[3],LENGTHUNIT[\"metre\",1.0]],ID[\"EPSG\",4979]]";

/// Makes the tables and writes the tiles.
pub fn write(db: &Connection, terrain: &Terrain) -> rusqlite::Result<()> {
    db.execute_batch(TABLES)?;
    db.execute(
        "INSERT INTO gpkg_spatial_ref_sys VALUES
         ('WGS 84 3D', 4979, 'EPSG', 4979, ?, 'longitude, latitude and ellipsoidal height')",
        [WGS84_3D],
    )?;
    let cell = terrain.cell_m();
    let half = cell / 2.0;
    let (low, high) = (terrain.bounds().min - half, terrain.bounds().max + half);
    let side = terrain.columns().max(terrain.rows()).min(MOST_SIDE);
    let (across, down) = (terrain.columns().div_ceil(side), terrain.rows().div_ceil(side));
    db.execute(
        "INSERT INTO gpkg_contents (table_name, data_type, identifier, description, last_change,
           min_x, min_y, max_x, max_y, srs_id)
         VALUES (?, '2d-gridded-coverage', 'terrain', 'heights in metres', ?, ?, ?, ?, ?, ?)",
        params![TABLE, LAST_CHANGE, low.x, low.y, high.x, high.y, LOCAL_SRS],
    )?;
    let (east, south) =
        (low.x + (across * side) as f64 * cell, high.y - (down * side) as f64 * cell);
    db.execute(
        "INSERT INTO gpkg_tile_matrix_set VALUES (?, ?, ?, ?, ?, ?)",
        params![TABLE, LOCAL_SRS, low.x, south, east, high.y],
    )?;
    db.execute(
        "INSERT INTO gpkg_tile_matrix VALUES (?, 0, ?, ?, ?, ?, ?, ?)",
        params![TABLE, across as i64, down as i64, side as i64, side as i64, cell, cell],
    )?;
    db.execute(
        "INSERT INTO gpkg_2d_gridded_coverage_ancillary
           (tile_matrix_set_name, datatype, data_null, uom) VALUES (?, 'float', ?, 'm')",
        params![TABLE, f64::from(MISSING)],
    )?;
    write_tiles(db, terrain, side)
}

fn write_tiles(db: &Connection, terrain: &Terrain, side: usize) -> rusqlite::Result<()> {
    let mut insert = db.prepare(
        "INSERT INTO terrain (zoom_level, tile_column, tile_row, tile_data) VALUES (0, ?, ?, ?)",
    )?;
    let mut describe = db.prepare(
        "INSERT INTO gpkg_2d_gridded_tile_ancillary (tpudt_name, tpudt_id, min, max)
         VALUES (?, ?, ?, ?)",
    )?;
    for row in 0..terrain.rows().div_ceil(side) {
        for column in 0..terrain.columns().div_ceil(side) {
            let heights = tile_of(terrain, side, column, row);
            let known = heights.iter().copied().filter(|h| *h != MISSING);
            let (low, high) = known.fold((f32::MAX, f32::MIN), |(a, b), h| (a.min(h), b.max(h)));
            let range = (low <= high).then_some((f64::from(low), f64::from(high)));
            let blob = tile::encode(&heights, side as u32)
                .map_err(|e| rusqlite::Error::ToSqlConversionFailure(Box::new(e)))?;
            insert.execute(params![column as i64, row as i64, blob])?;
            let id = db.last_insert_rowid();
            describe.execute(params![TABLE, id, range.map(|r| r.0), range.map(|r| r.1)])?;
        }
    }
    Ok(())
}

/// The heights of a tile; rows count from the north.
fn tile_of(terrain: &Terrain, side: usize, tile_column: usize, tile_row: usize) -> Vec<f32> {
    let mut heights = vec![MISSING; side * side];
    let (columns, rows) = (terrain.columns(), terrain.rows());
    let (left, top) = (tile_column * side, tile_row * side);
    for y in 0..side.min(rows - top) {
        let row = rows - 1 - (top + y);
        for x in 0..side.min(columns - left) {
            let height = terrain.heights()[row * columns + left + x];
            if !height.is_nan() {
                heights[y * side + x] = height;
            }
        }
    }
    heights
}

/// The terrain of a city file; `None` when it has none.
pub fn read(db: &Connection, file: &str) -> Result<Option<Terrain>, Error> {
    let content = |what: String| Error::Content {
        file: file.to_owned(),
        place: format!("layer `{TABLE}`"),
        what,
    };
    let grid = grid(db).map_err(|source| Error::Database { file: file.to_owned(), source })?;
    let Some((extent, cell, side)) = grid else { return Ok(None) };
    let wrong = || content("its extent is no grid of heights; import the DEM again".to_owned());
    let cell_mm = (cell * 1000.0).round();
    if !(1.0..=1e9).contains(&cell_mm) || !(1..=4096).contains(&side) {
        return Err(wrong());
    }
    let cell = cell_mm / 1000.0;
    let count = |size: f64| Some((size / cell).round()).filter(|n| (2.0..=65_536.0).contains(n));
    let [west, south, east, north] = extent;
    let (Some(columns), Some(rows)) = (count(east - west), count(north - south)) else {
        return Err(wrong());
    };
    let (columns, rows) = (columns as usize, rows as usize);
    let first = GridPoint::m(west + cell / 2.0, south + cell / 2.0);
    let mut heights = vec![f32::NAN; columns * rows];
    read_tiles(db, file, side, columns, &mut heights)?;
    let terrain = Terrain::new(first, cell_mm as u32, columns, heights);
    terrain.map(Some).map_err(|e| content(e.to_string()))
}

/// West, south, east and north; the cell; posts along the side of a tile.
fn grid(db: &Connection) -> rusqlite::Result<Option<([f64; 4], f64, u32)>> {
    let there: Option<i64> = db
        .query_row(
            "SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = 'gpkg_tile_matrix'",
            [],
            |row| row.get(0),
        )
        .optional()?;
    if there.is_none() {
        return Ok(None);
    }
    db.query_row(
        "SELECT c.min_x, c.min_y, c.max_x, c.max_y, m.pixel_x_size, m.tile_width
         FROM gpkg_contents c JOIN gpkg_tile_matrix m ON m.table_name = c.table_name
         WHERE c.table_name = ? AND c.data_type = '2d-gridded-coverage' AND m.zoom_level = 0",
        [TABLE],
        |row| {
            let extent = [row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?];
            Ok((extent, row.get(4)?, row.get(5)?))
        },
    )
    .optional()
}

/// Puts the heights of all tiles into the rows of the terrain, which run from the south.
fn read_tiles(
    db: &Connection,
    file: &str,
    side: u32,
    columns: usize,
    heights: &mut [f32],
) -> Result<(), Error> {
    let database = |source| Error::Database { file: file.to_owned(), source };
    let rows = heights.len() / columns;
    let mut select = db
        .prepare("SELECT tile_column, tile_row, tile_data FROM terrain WHERE zoom_level = 0")
        .map_err(database)?;
    let mut tiles = select.query([]).map_err(database)?;
    while let Some(row) = tiles.next().map_err(database)? {
        let number = |k| row.get::<_, u32>(k).map(|n| n as usize).map_err(database);
        let (across, down) = (number(0)?, number(1)?);
        let bytes = row.get_ref(2).and_then(|v| Ok(v.as_blob()?)).map_err(database)?;
        let tile = tile::decode(bytes, side).map_err(|what| Error::Content {
            file: file.to_owned(),
            place: format!("layer `{TABLE}`, tile {across} {down}"),
            what: format!("cannot be read: {what}"),
        })?;
        let side = side as usize;
        for (i, height) in tile.into_iter().enumerate().filter(|(_, h)| *h != MISSING) {
            let (column, from_north) = (across * side + i % side, down * side + i / side);
            if column < columns && from_north < rows {
                heights[(rows - 1 - from_north) * columns + column] = height;
            }
        }
    }
    Ok(())
}
