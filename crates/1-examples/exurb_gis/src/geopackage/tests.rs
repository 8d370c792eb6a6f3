use std::path::{Path, PathBuf};
use std::sync::Arc;

use exurb_city::{City, ImportOptions, Role, Terrain};
use exurb_geom::GridPoint;
use proptest::prelude::*;
use rusqlite::Connection;

use super::{read_geopackage, write_geopackage};
use crate::Error;
use crate::sample::{self, any_city, assert_same};

fn written(city: &City, folder: &Path, name: &str) -> (PathBuf, Vec<u8>) {
    let path = folder.join(name);
    write_geopackage(city, &path).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    (path, bytes)
}

fn read(path: &Path) -> City {
    let imported = read_geopackage(path, &ImportOptions::default()).unwrap();
    assert_eq!(imported.warnings, [""; 0]);
    imported.city
}

#[test]
fn equal_cities_are_equal_files() {
    let folder = tempfile::tempdir().unwrap();
    let city = sample::grid_city(6);
    let bytes = ["a.gpkg", "b.gpkg"].map(|name| written(&city, folder.path(), name).1);
    assert_eq!(bytes[0], bytes[1]);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2, "nothing is left beside");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn what_is_written_is_read_back(
        mut city in any_city(), ground in prop::option::of(sample::terrain()),
    ) {
        city.terrain = ground.map(Arc::new);
        let folder = tempfile::tempdir().unwrap();
        let (path, bytes) = written(&city, folder.path(), "a.gpkg");
        let back = read(&path);
        assert_same(&back, &city);
        prop_assert_eq!(written(&back, folder.path(), "b.gpkg").1, bytes);
    }
}

#[test]
fn the_files_answer_to_the_standard() {
    let folder = tempfile::tempdir().unwrap();
    let mut city = sample::grid_city(3);
    city.lay(Terrain::over(city.target.bounds(), 10.0, |p| p.y as f32).unwrap());
    let (path, _) = written(&city, folder.path(), "a.gpkg");
    let db = Connection::open(path).unwrap();
    let number = |sql: &str| db.query_row(sql, [], |row| row.get::<_, i64>(0)).unwrap();
    assert_eq!(number("PRAGMA application_id"), 0x4750_4B47);
    assert_eq!(number("PRAGMA user_version"), 10_400);
    assert_eq!(number("SELECT count(*) FROM pragma_foreign_key_check"), 0);
    assert_eq!(
        number("SELECT count(*) FROM pragma_integrity_check WHERE integrity_check = 'ok'"),
        1
    );
    assert_eq!(number("SELECT count(*) FROM gpkg_contents WHERE data_type = 'features'"), 9);
    assert_eq!(
        number("SELECT count(*) FROM rtree_streets_geom"),
        number("SELECT count(*) FROM streets")
    );
    let dangling =
        "SELECT count(*) FROM streets WHERE \"from\" NOT IN (SELECT id FROM intersections)";
    assert_eq!(number(dangling), 0);
}

/// A city file to be changed by plain SQL: the triggers call functions that only programs for maps
/// bring along.
fn without_triggers(path: &Path) -> Connection {
    let db = Connection::open(path).unwrap();
    for name in ["insert", "update2", "update4", "update5", "update6", "update7", "delete"] {
        db.execute_batch(&format!("DROP TRIGGER rtree_streets_geom_{name}")).unwrap();
    }
    db
}

#[test]
fn a_street_drawn_elsewhere_becomes_part_of_the_graph() {
    let folder = tempfile::tempdir().unwrap();
    let city = sample::grid_city(2);
    let (path, _) = written(&city, folder.path(), "a.gpkg");
    let sql = "UPDATE streets SET \"from\" = NULL, \"to\" = NULL WHERE id = 1";
    without_triggers(&path).execute(sql, []).unwrap();
    let imported = read_geopackage(&path, &ImportOptions::default()).unwrap();
    assert_eq!(imported.city.streets.length_m(), city.streets.length_m());
    assert_eq!(imported.city.blocks.len(), 4);
    assert!(imported.warnings[0].contains("drawn, moved"), "{:?}", imported.warnings);
}

#[test]
fn blocks_are_joined_where_a_street_was_removed_elsewhere() {
    let folder = tempfile::tempdir().unwrap();
    let mut city = sample::grid_city(2);
    city.blocks = Arc::new(exurb_city::block::derive(&city.streets));
    let (path, _) = written(&city, folder.path(), "a.gpkg");
    // A side that two blocks share.
    let middle = GridPoint::m(50.0, 50.0);
    let inner = city.streets.edges().position(|(_, e)| e.line().contains(&middle)).unwrap();
    let sql = "DELETE FROM streets WHERE id = ?";
    without_triggers(&path).execute(sql, [inner as i64 + 1]).unwrap();
    let imported = read_geopackage(&path, &ImportOptions::default()).unwrap();
    assert_eq!(imported.city.streets.length_m(), city.streets.length_m() - 50.0);
    assert_eq!(imported.city.blocks.len(), city.blocks.len() - 1);
    assert!(imported.warnings[0].contains("removed"), "{:?}", imported.warnings);
}

#[test]
fn a_building_drawn_elsewhere_gets_a_number() {
    let folder = tempfile::tempdir().unwrap();
    let (path, _) = written(&sample::grid_city(2), folder.path(), "a.gpkg");
    let db = Connection::open(&path).unwrap();
    db.execute_batch(
        "DROP TRIGGER rtree_buildings_geom_insert;
         INSERT INTO buildings (geom, height) SELECT geom, 12 FROM buildings WHERE id = 1",
    )
    .unwrap();
    drop(db);
    let city = read(&path);
    let last = city.buildings.last().unwrap();
    assert_eq!((city.buildings.len(), last.id, last.height_m), (5, 5, Some(12.0)));
}

#[test]
fn a_part_of_a_city_file_can_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let city = sample::grid_city(8);
    let (path, _) = written(&city, folder.path(), "a.gpkg");
    let corner = |x: f64, y: f64| city.frame.unproject(exurb_geom::Vec2::new(x, y));
    let bbox = Some([corner(90.0, 90.0), corner(310.0, 310.0)]);
    let options = ImportOptions { bbox, ..ImportOptions::default() };
    let part = read_geopackage(&path, &options).unwrap().city;
    assert!(part.area_km2() < 0.05);
    assert!((16..40).contains(&part.buildings.len()), "{}", part.buildings.len());
}

#[test]
fn a_part_of_a_city_keeps_its_ground() {
    let folder = tempfile::tempdir().unwrap();
    let mut city = sample::grid_city(20);
    let bounds = city.target.bounds().grown(300.0);
    let ramp = Terrain::over(bounds, 20.0, |p| p.x as f32 / 10.0).unwrap();
    city.lay(ramp.with_water_level(Some(-3.0)));
    let (path, _) = written(&city, folder.path(), "a.gpkg");
    let corner = |x: f64, y: f64| city.frame.unproject(exurb_geom::Vec2::new(x, y));
    let bbox = Some([corner(100.0, 100.0), corner(400.0, 400.0)]);
    let options = ImportOptions { bbox, ..ImportOptions::default() };
    let part = read_geopackage(&path, &options).unwrap().city;
    let ground = part.terrain.expect("a terrain");
    assert!(ground.columns() < 40 && ground.water_level_m() == Some(-3.0));
    let place = exurb_geom::Vec2::new(217.0, 333.0);
    assert!((ground.height_m(place).unwrap() - 21.7).abs() < 1e-3);
    let off = |z: f64, p: GridPoint| (z - p.to_m().x / 10.0).abs();
    assert!(part.streets.nodes().all(|(_, n)| off(n.data.z_m, n.at) < 1e-3));
}

#[test]
fn a_broken_tile_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let mut city = sample::grid_city(2);
    city.lay(Terrain::over(city.target.bounds(), 20.0, |_| 7.0).unwrap());
    let (path, _) = written(&city, folder.path(), "a.gpkg");
    let sql = "UPDATE terrain SET tile_data = x'49492a00'";
    without_triggers(&path).execute(sql, []).unwrap();
    let error = read_geopackage(&path, &ImportOptions::default()).unwrap_err().to_string();
    assert!(error.contains("layer `terrain`, tile 0 0"), "{error}");
}

#[test]
fn errors_name_the_file_and_the_row() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gpkg");
    let read = |path: &Path| read_geopackage(path, &ImportOptions::default()).unwrap_err();
    assert!(matches!(read(&path), Error::Read { .. }));
    std::fs::write(&path, "not a database, but long enough to have been one".repeat(9)).unwrap();
    assert!(matches!(read(&path), Error::Database { .. }));

    write_geopackage(&sample::grid_city(2), &path).unwrap();
    let sql = "UPDATE streets SET class = 'cowpath' WHERE fid = 3";
    without_triggers(&path).execute(sql, []).unwrap();
    let error = read(&path).to_string();
    assert!(error.contains("row 3") && error.contains("`cowpath`"), "{error}");

    let nowhere = folder.path().join("no such folder").join("b.gpkg");
    assert!(matches!(write_geopackage(&sample::grid_city(1), &nowhere), Err(Error::Write { .. })));
}

/// A GeoPackage of somebody else's: streets and plots in a national grid.
fn foreign(path: &Path, srs_id: i32, definition: &str, at: [f64; 2]) {
    let db = Connection::open(path).unwrap();
    db.execute_batch(
        "CREATE TABLE gpkg_spatial_ref_sys (srs_name, srs_id, organization, organization_coordsys_id, definition, description);
         CREATE TABLE gpkg_geometry_columns (table_name, column_name, geometry_type_name, srs_id, z, m);
         CREATE TABLE roads (fid INTEGER PRIMARY KEY, shape BLOB, fclass TEXT);
         CREATE TABLE plots (fid INTEGER PRIMARY KEY, shape BLOB, zoning TEXT);",
    )
    .unwrap();
    db.execute(
        "INSERT INTO gpkg_spatial_ref_sys VALUES ('x', ?1, 'EPSG', ?1, ?2, '')",
        rusqlite::params![srs_id, definition],
    )
    .unwrap();
    let line = |from: [f64; 2], to: [f64; 2]| {
        let mut blob = vec![b'G', b'P', 0, 1, 0, 0, 0, 0, 1, 2, 0, 0, 0, 2, 0, 0, 0];
        for p in [from, to] {
            blob.extend((at[0] + p[0]).to_le_bytes());
            blob.extend((at[1] + p[1]).to_le_bytes());
        }
        blob
    };
    for table in ["roads", "plots"] {
        db.execute(
            "INSERT INTO gpkg_geometry_columns VALUES (?, 'shape', 'x', ?, 0, 0)",
            (table, srs_id),
        )
        .unwrap();
    }
    let mut insert =
        db.prepare("INSERT INTO roads (shape, fclass) VALUES (?, 'tertiary')").unwrap();
    insert.execute([line([-100.0, 0.0], [100.0, 0.0])]).unwrap();
    insert.execute([line([0.0, -100.0], [0.0, 100.0])]).unwrap();
}

#[test]
fn a_column_whose_name_is_no_text_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gpkg");
    foreign(&path, 5514, "", [-743_011.0, -1_043_011.0]);
    let mut bytes = std::fs::read(&path).unwrap();
    let schema = b"shape BLOB, fclass TEXT";
    let at = bytes.windows(schema.len()).position(|w| w == schema).unwrap() + 12;
    bytes[at] = 0xE9;
    std::fs::write(&path, bytes).unwrap();
    let error = read_geopackage(&path, &Default::default()).unwrap_err().to_string();
    assert!(error.contains("the name of a column is no text"), "{error}");
}

#[test]
fn lines_of_other_files_become_streets_where_they_lie() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gpkg");
    // Prague in the Czech national grid.
    foreign(&path, 5514, "", [-743_011.0, -1_043_011.0]);
    let city = read(&path);
    let origin = city.frame.origin();
    assert!(
        (origin.lon - 14.4185).abs() < 1e-3 && (origin.lat - 50.0872).abs() < 1e-3,
        "{origin:?}"
    );
    assert_eq!(city.streets.edge_count(), 4);
    assert!((city.streets.length_m() - 400.0).abs() < 0.2, "{}", city.streets.length_m());
    assert!(city.streets.edges().all(|(_, e)| e.data.role() == Role::Main));
}

#[test]
fn unknown_grids_keep_their_shape_or_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("metres.gpkg");
    foreign(&path, 60_000, "LOCAL_CS[\"town grid\",UNIT[\"metre\",1]]", [5e6, 5e6]);
    let imported = read_geopackage(&path, &ImportOptions::default()).unwrap();
    assert_eq!(imported.city.streets.length_m(), 400.0);
    assert!(imported.warnings.iter().any(|w| w.contains("null island")), "{:?}", imported.warnings);

    let path = folder.path().join("feet.gpkg");
    foreign(&path, 60_000, "LOCAL_CS[\"town grid\",UNIT[\"foot\",0.3048]]", [5e6, 5e6]);
    let error = read_geopackage(&path, &ImportOptions::default()).unwrap_err().to_string();
    assert!(error.contains("EPSG:60000") && error.contains("reproject"), "{error}");

    let undefined = "LOCAL_CS[\"Undefined SRS\",UNIT[\"unknown\",0]]";
    let path = folder.path().join("undefined.gpkg");
    foreign(&path, 99_999, undefined, [5e6, 5e6]);
    let imported = read_geopackage(&path, &ImportOptions::default()).unwrap();
    assert_eq!(imported.city.streets.length_m(), 400.0);
    assert!(imported.warnings.iter().any(|w| w.contains("null island")), "{:?}", imported.warnings);
}
