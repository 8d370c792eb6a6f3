use std::path::Path;

use exurb_geom::{Frame, LonLat};
use rusqlite::Connection;

use super::{TargetArea, read_target, settle};
use crate::sample;
use crate::{geojson, write_geojson, write_geopackage};

fn target(text: &str, frame: Option<&Frame>) -> Result<TargetArea, String> {
    let outlines = geojson::outlines(text.as_bytes(), "t.geojson").map_err(|e| e.to_string())?;
    settle(outlines, "t.geojson", frame).map_err(|e| e.to_string())
}

fn polygon(ring: &str) -> String {
    format!(r#"{{"type":"Polygon","coordinates":[[{ring}]]}}"#)
}

fn square(lon: f64, lat: f64, width: f64) -> String {
    let (e, n) = (lon + width, lat + width);
    polygon(&format!("[{lon},{lat}],[{e},{lat}],[{e},{n}],[{lon},{n}],[{lon},{lat}]"))
}

fn feature(geometry: &str) -> String {
    format!(r#"{{"type":"Feature","properties":{{}},"geometry":{geometry}}}"#)
}

#[test]
fn a_target_lies_in_its_own_frame_or_the_one_given() {
    let own = target(&square(10.0, 50.0, 0.01), None).unwrap();
    assert!((own.frame.origin().lon - 10.005).abs() < 1e-9);
    let area_m2 = own.polygon.area_m2();
    assert!((area_m2 / (716.6 * 1112.4) - 1.0).abs() < 0.01, "{area_m2}");
    assert_eq!(own.warnings, [""; 0]);

    let elsewhere = Frame::new(LonLat { lon: 10.02, lat: 50.0 }).unwrap();
    let moved = target(&square(10.0, 50.0, 0.01), Some(&elsewhere)).unwrap();
    assert_eq!(moved.frame, elsewhere);
    assert!(moved.polygon.bounds().max.x < -700.0);
}

#[test]
fn of_separate_areas_the_largest_is_taken_and_neighbours_are_joined() {
    let two = r#"{"type":"MultiPolygon","coordinates":[[[[0,0],[0.01,0],[0.01,0.01],[0,0]]],[[[1,0],[1.02,0],[1.02,0.02],[1,0]]]]}"#;
    let larger = target(two, None).unwrap();
    assert!((larger.polygon.area_m2() / 2.47e6 - 1.0).abs() < 0.02);
    let warning = &larger.warnings[0];
    assert!(warning.contains("2 separate areas") && warning.contains("of 3.078"), "{warning}");

    let (west, east) = (feature(&square(0.0, 0.0, 0.01)), feature(&square(0.01, 0.0, 0.01)));
    let both = format!(r#"{{"type":"FeatureCollection","features":[{west},{east}]}}"#);
    let joined = target(&both, None).unwrap();
    let one = target(&square(0.0, 0.0, 0.01), None).unwrap();
    assert!((joined.polygon.area_m2() / (2.0 * one.polygon.area_m2()) - 1.0).abs() < 1e-4);
    assert_eq!(joined.warnings, [""; 0]);
}

#[test]
fn a_slip_of_the_pen_is_mended_and_a_bow_tie_refused() {
    // The last corner lies a little past the first side.
    let slip = "[0,0],[0.02,0],[0.02,0.02],[0.0001,0.02],[0.0001,-0.0001],[0,0]";
    let mended = target(&polygon(slip), None).unwrap();
    assert!(mended.polygon.is_valid());
    assert!(mended.warnings[0].contains("mended"), "{:?}", mended.warnings);
    for tie in ["[0,0],[0.1,0.1],[0.1,0],[0,0.09],[0,0]", "[0,0],[0.1,0.1],[0.1,0],[0,0.1],[0,0]"] {
        let error = target(&polygon(tie), None).unwrap_err();
        assert!(error.contains("crosses"), "{error}");
    }
}

#[test]
fn what_is_no_target_is_refused() {
    for (text, word) in [
        (square(10.0, 50.0, 3.0), "larger than 10,000"),
        (square(10.0, 50.0, 0.00001), "too little"),
        (r#"{"type":"LineString","coordinates":[[0,0],[1,1]]}"#.to_owned(), "holds no polygon"),
        (r#"{"type":"Polygon","coordinates":[]}"#.to_owned(), "area"),
        (polygon("[10,88],[10.1,88],[10.1,88.1],[10,88]"), "85"),
        (polygon("[-180,-80],[180,-80],[180,80],[-180,80],[-180,-80]"), "180 degrees"),
        (polygon("[179.99,10],[180.02,10],[180.02,10.02],[179.99,10.02],[179.99,10]"), "range"),
        // The metres of some grid, and nothing that names it.
        (polygon("[386000,6671000],[387000,6671000],[387000,6672000],[386000,6671000]"), "4326"),
    ] {
        let error = target(&text, None).unwrap_err();
        assert!(error.contains(word), "{word}: {error}");
    }
}

#[test]
fn the_target_of_a_city_file_is_its_target() {
    let city = sample::grid_city(3);
    let folder = tempfile::tempdir().unwrap();
    let (geojson, gpkg) = (folder.path().join("a.geojson"), folder.path().join("a.gpkg"));
    write_geojson(&city, &mut std::fs::File::create(&geojson).unwrap()).unwrap();
    write_geopackage(&city, &gpkg).unwrap();
    let read = |path: &Path, frame| read_target(path, frame).unwrap();
    assert_eq!(read(&gpkg, None).polygon, city.target);
    assert_eq!(read(&gpkg, None).frame, city.frame);
    let elsewhere = Frame::new(LonLat { lon: 24.95, ..city.frame.origin() }).unwrap();
    for path in [&geojson, &gpkg] {
        assert_eq!(read(path, Some(&city.frame)).polygon, city.target);
        assert!(read_target(path, Some(&elsewhere)).is_ok());
    }
}

#[test]
fn a_layer_of_polygons_is_a_target() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("district.gpkg");
    // A district of Prague in the Czech national grid.
    square_in_geopackage(&path, 5514, [-743_011.0, -1_043_011.0], 500.0);
    let district = read_target(&path, None).unwrap();
    assert!((district.polygon.area_m2() / 250_000.0 - 1.0).abs() < 1e-3);
    assert!((district.frame.origin().lon - 14.42).abs() < 0.01);
}

/// A GeoPackage of somebody else's with one square.
fn square_in_geopackage(path: &Path, srs_id: i32, at: [f64; 2], side_m: f64) {
    let db = Connection::open(path).unwrap();
    db.execute_batch(
        "CREATE TABLE gpkg_spatial_ref_sys (srs_id, organization, organization_coordsys_id, definition);
         CREATE TABLE gpkg_geometry_columns (table_name, column_name, srs_id);
         CREATE TABLE districts (fid INTEGER PRIMARY KEY, shape BLOB);
         INSERT INTO gpkg_geometry_columns VALUES ('districts', 'shape', 1);",
    )
    .unwrap();
    db.execute("INSERT INTO gpkg_spatial_ref_sys VALUES (1, 'EPSG', ?, '')", [srs_id]).unwrap();
    // No envelope; a polygon of one ring of five points.
    let mut blob = vec![b'G', b'P', 0, 1, 0, 0, 0, 0, 1, 3, 0, 0, 0, 1, 0, 0, 0, 5, 0, 0, 0];
    for [x, y] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]] {
        blob.extend((at[0] + x * side_m).to_le_bytes());
        blob.extend((at[1] + y * side_m).to_le_bytes());
    }
    db.execute("INSERT INTO districts (shape) VALUES (?)", [blob]).unwrap();
}
