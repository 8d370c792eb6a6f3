use std::path::{Path, PathBuf};

use exurb_city::{City, Terrain};
use exurb_geom::{Bounds, Crs, Frame, GridPoint, LonLat, Polygon, Vec2};
use proptest::prelude::*;

use crate::options::Said;
use crate::read::read_bytes;
use crate::{Dem, Edges, Error, Options, Place, read, to_geotiff, to_png};

fn fixture(name: &str) -> Dem {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures").join(name);
    read(&path, &Options::default()).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn plane(column: usize, row: usize) -> f32 {
    100.0 + 2.0 * column as f32 - 3.0 * row as f32
}

/// Every way GDAL stores heights gives the same heights; see `tests/fixtures/make.py`.
#[test]
fn geotiffs_of_every_kind_hold_the_same_plane() {
    for name in [
        "int16_tiled_lzw_predictor2.tif",
        "float32_tiled_lzw_predictor3.tif",
        "int32_strips_lzw_predictor2_big_endian.tif",
        "float32_strips_deflate_predictor3.tif",
        "float32_tiled_deflate_predictor3.tif",
        "float64_big_endian.tif",
        "uint16_bigtiff.tif",
        "int32_two_bands.tif",
        "int16_two_planes.tif",
        "float32_degrees.tif",
        "float32_point.tif",
        "int16_scaled.tif",
    ] {
        let dem = fixture(name);
        assert_eq!((dem.columns, dem.rows()), (40, 30), "{name}");
        for (i, height) in dem.heights.iter().enumerate() {
            let (column, row) = (i % 40, i / 40);
            let expected = match name {
                _ if (row, column) == (5, 4) => f32::NAN,
                "int16_scaled.tif" => plane(column, row) * 0.5 + 1000.0,
                _ => plane(column, row),
            };
            let same = *height == expected || (height.is_nan() && expected.is_nan());
            assert!(same, "{name}, row {row}, column {column}: {height}");
        }
        let Place::Georeferenced { affine, .. } = dem.place else { panic!("{name} has a place") };
        let expected = match name {
            "float32_degrees.tif" => (13.600_05, 49.649_95),
            _ => (400_005.0, 5_499_995.0),
        };
        let (x, y) = affine.at(0.0, 0.0);
        assert!((x - expected.0).abs() < 1e-6 && (y - expected.1).abs() < 1e-6, "{name}: {x} {y}");
    }
}

/// A plane stays a plane in whatever frame it is laid: at every post the height is that of the
/// raster's own coordinates there.
#[test]
fn a_plane_keeps_its_heights_in_another_frame() {
    let frame = Frame::new(LonLat { lon: 13.603, lat: 49.648 }).unwrap();
    for (name, code, first, size) in [
        ("float32_degrees.tif", 4326, (13.600_05, 49.649_95), 1e-4),
        ("int16_tiled_lzw_predictor2.tif", 32_633, (400_005.0, 5_499_995.0), 10.0),
    ] {
        let crs = Crs::from_epsg(code).unwrap();
        let dem = fixture(name);
        let [a, b] = dem.extent().unwrap();
        let frame = if code == 4326 { frame.clone() } else { Frame::new(a).unwrap() };
        let corners = [a, b].map(|place| frame.project(place).unwrap());
        let terrain = dem.onto(&frame, Bounds { min: corners[0], max: corners[1] }, None).unwrap();
        let mut known = 0;
        for row in 0..terrain.rows() {
            for column in 0..terrain.columns() {
                let p = terrain.post(column, row);
                let (x, y) = crs.from_lonlat(frame.unproject(p)).unwrap();
                let (at_column, at_row) = ((x - first.0) / size, (first.1 - y) / size);
                let inside = (0.0..=39.0).contains(&at_column) && (0.0..=29.0).contains(&at_row);
                // Around the missing pixel the nearest one stands in.
                let near_gap = (at_column - 4.0).abs() < 2.0 && (at_row - 5.0).abs() < 2.0;
                if let Some(height) = terrain.height_m(p).filter(|_| inside && !near_gap) {
                    let expected = 100.0 + 2.0 * at_column - 3.0 * at_row;
                    assert!(
                        (height - expected).abs() < 1e-3,
                        "{name} at {p}: {height}, {expected}"
                    );
                    known += 1;
                }
            }
        }
        assert!(known > 700, "{name}: {known}");
        assert!(terrain.missing() > 0);
    }
}

#[test]
fn an_ascii_grid_is_read_with_its_corner_or_its_middle() {
    let body = "1 2 3\n4 -9 6\n";
    for head in [
        "ncols 3\nnrows 2\nxllcorner 7\nyllcorner 43\ncellsize 0.01\nNODATA_value -9\n",
        "NCOLS 3 NROWS 2 XLLCENTER 7.005 YLLCENTER 43.005 DX 0.01 DY 0.01 NODATA_VALUE -9\n",
    ] {
        let text = format!("{head}{body}");
        let dem =
            read_bytes(text.as_bytes(), "a.asc", Said::default(), &Options::default()).unwrap();
        assert_eq!((dem.columns, dem.heights[0], dem.heights[5]), (3, 1.0, 6.0));
        assert!(dem.heights[4].is_nan());
        let [a, b] = dem.extent().unwrap();
        assert!((a.lon - 7.005).abs() < 1e-9 && (b.lat - 43.015).abs() < 1e-9, "{a:?} {b:?}");
    }
}

#[test]
fn what_is_wrong_with_a_file_is_said() {
    let said = |bytes: &[u8], name: &str, options: &Options| {
        read_bytes(bytes, name, Said::default(), options).unwrap_err().to_string()
    };
    let none = Options::default();
    let head = "ncols 3\nnrows 2\nxllcorner 7\nyllcorner 43\ncellsize 0.01\n";
    for (bytes, name, words) in [
        (format!("{head}1 2 3 4 5"), "a.asc", "holds 5 heights, but its head says 3 x 2"),
        (format!("{head}1 2 3 4 five 6"), "a.asc", "`five` for a height in row 2, column 2"),
        ("ncols\n".to_owned(), "a.asc", "no number after `ncols`"),
        ("ncols 0 nrows 5 1".to_owned(), "a.asc", "is 0 x 5 by its head"),
        (format!("{head}-9999 -9999 -9999 -9999 -9999 -9999"), "a.asc", "no height at all"),
        (
            "ncols 1\nnrows 1\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\n7".to_owned(),
            "a.asc",
            "--terrain-crs",
        ),
        ("GIF89a".to_owned(), "a.gif", "GeoTIFF, SRTM .hgt, ESRI ASCII grid and 16-bit PNG"),
        ("too short".to_owned(), "N43E007.hgt", "has 9 bytes"),
        ("II*\0 broken".to_owned(), "a.tif", "is no readable TIFF"),
    ] {
        let message = said(bytes.as_bytes(), name, &none);
        assert!(message.contains(words) && message.contains(name), "{message}");
    }
    let png = to_png(&city(|p| p.x as f32)).unwrap().png;
    let plain = without_texts(&png);
    assert!(said(&plain, "a.png", &none).contains("--terrain-range"));
    let range = Options { range_m: Some([0.0, 10.0]), ..Options::default() };
    assert!(said(&plain, "a.png", &range).contains("--terrain-bounds"));
}

/// The same picture without its text chunks.
fn without_texts(png: &[u8]) -> Vec<u8> {
    let mut out = png[..8].to_vec();
    let mut at = 8;
    while at < png.len() {
        let length = u32::from_be_bytes(png[at..at + 4].try_into().unwrap()) as usize;
        let whole = &png[at..at + 12 + length];
        if &whole[4..8] != b"iTXt" {
            out.extend(whole);
        }
        at += whole.len();
    }
    out
}

#[test]
fn a_plain_png_is_placed_by_options_or_a_world_file() {
    let city = city(|p| p.x as f32 / 10.0);
    let map = to_png(&city).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.png");
    std::fs::write(&path, without_texts(&map.png)).unwrap();
    let bounds = city.target.bounds();
    let (low, high) = city.terrain.as_ref().unwrap().range_m();
    let range_m = Some([f64::from(low), f64::from(high)]);

    let stretched = Options { edges: Some(Edges::Target), range_m, ..Options::default() };
    let terrain = read(&path, &stretched).unwrap().onto(&city.frame, bounds, None).unwrap();
    let middle = terrain.height_m(Vec2::ZERO).unwrap();
    assert!(middle.abs() < 0.02, "{middle}");

    std::fs::write(folder.path().join("map.pgw"), &map.world).unwrap();
    std::fs::write(folder.path().join("map.prj"), &map.projection).unwrap();
    let by_world = Options { range_m, ..Options::default() };
    let terrain = read(&path, &by_world).unwrap().onto(&city.frame, bounds, None).unwrap();
    let p = Vec2::new(123.0, -45.0);
    assert!((terrain.height_m(p).unwrap() - 12.3).abs() < 0.01);
}

fn city(height: impl Fn(Vec2) -> f32) -> City {
    let target = Polygon::rectangle(GridPoint::m(-250.0, -200.0), GridPoint::m(250.0, 200.0));
    let frame = Frame::new(LonLat { lon: 7.42, lat: 43.74 }).unwrap();
    let mut city = City::empty(frame, target);
    city.lay(Terrain::over(city.target.bounds(), 10.0, height).unwrap());
    city.metadata.attribution = vec!["© heights of test".to_owned()];
    city
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// What is written is read back: GeoTIFF exactly, PNG within half a step.
    #[test]
    fn height_maps_are_read_back(
        heights in prop::collection::vec(
            prop_oneof![9 => -400.0..9000.0f32, 1 => Just(f32::NAN)], 12 * 9..12 * 9 + 1,
        ),
        cell_mm in 2_500u32..90_000, x in -30_000i32..30_000,
    ) {
        let first = GridPoint { x, y: -x / 3 };
        let Ok(terrain) = Terrain::new(first, cell_mm, 12, heights) else {
            return Err(TestCaseError::reject("no height is known"));
        };
        let mut city = city(|_| 0.0);
        let bounds = terrain.bounds();
        city.lay(terrain.clone());
        let again = |bytes: &[u8], name: &str| {
            let dem = read_bytes(bytes, name, Said::default(), &Options::default()).unwrap();
            dem.onto(&city.frame, bounds, None).unwrap()
        };
        prop_assert_eq!(&again(&to_geotiff(&city).unwrap(), "a.tif"), &terrain);
        let same = Dem::of(&terrain, &city.frame, "city").onto(&city.frame, bounds, None);
        prop_assert_eq!(&same.unwrap(), &terrain);
        let map = to_png(&city).unwrap();
        let back = again(&map.png, "a.png");
        prop_assert_eq!((back.first(), back.columns()), (terrain.first(), terrain.columns()));
        let (low, high) = terrain.range_m();
        let half_step = f64::from(high - low) / 65_534.0 / 2.0 + 1e-3;
        for (a, b) in back.heights().iter().zip(terrain.heights()) {
            let same = a.is_nan() && b.is_nan() || f64::from((a - b).abs()) <= half_step;
            prop_assert!(same, "{} {}", a, b);
        }
    }

    #[test]
    fn broken_files_are_errors(at in 0usize..3000, byte in any::<u8>(), cut in 0usize..3000) {
        let city = city(|p| p.y as f32);
        let broken = |mut bytes: Vec<u8>| {
            let n = bytes.len();
            bytes[at % n] = byte;
            bytes.truncate(n - cut % n);
            bytes
        };
        crate::fuzz::geotiff(&broken(to_geotiff(&city).unwrap()));
        crate::fuzz::height_png(&broken(to_png(&city).unwrap().png));
        let text = "ncols 3\nnrows 2\nxllcorner 7\nyllcorner 43\ncellsize 0.01\n1 2 3 4 5 6\n";
        crate::fuzz::ascii_grid(&broken(text.into()));
    }
}

#[test]
fn a_city_elsewhere_is_told_where_the_heights_are() {
    let frame = Frame::new(LonLat { lon: 24.9, lat: 60.2 }).unwrap();
    let bounds = Bounds { min: Vec2::splat(-500.0), max: Vec2::splat(500.0) };
    let error = fixture("float32_degrees.tif").onto(&frame, bounds, None).unwrap_err();
    let Error::Elsewhere { what, .. } = error else { panic!("{error}") };
    assert!(what.contains("13.6000,49.6471") && what.contains("24.89"), "{what}");
}

#[test]
fn pixels_without_size_are_an_error_and_no_endless_work() {
    let text = "ncols 3\nnrows 2\nxllcorner 7\nyllcorner 43\ncellsize 1e-12\n1 2 3\n4 5 6\n";
    let dem = read_bytes(text.as_bytes(), "a.asc", Said::default(), &Options::default()).unwrap();
    let frame = Frame::new(LonLat { lon: 7.0, lat: 43.0 }).unwrap();
    let bounds = Bounds { min: Vec2::splat(-2000.0), max: Vec2::splat(2000.0) };
    let error = dem.onto(&frame, bounds, None).unwrap_err().to_string();
    assert!(error.contains("`a.asc` has pixels of"), "{error}");
}

#[test]
fn pixels_finer_than_the_cells_are_averaged() {
    // Chequered square metres: the mean of black and white is all that a cell can say.
    let columns = 500;
    let heights = (0..columns * columns).map(|i| ((i % columns + i / columns) % 2) as f32 * 10.0);
    let dem = Dem {
        file: "chess".into(),
        columns,
        heights: heights.collect(),
        place: Place::Stretched,
        attribution: None,
    };
    let bounds = Bounds { min: Vec2::splat(-250.0), max: Vec2::splat(250.0) };
    let terrain = dem.onto(&Frame::null_island(), bounds, Some(25.0)).unwrap();
    assert_eq!((terrain.columns(), terrain.cell_mm()), (21, 25_000));
    let middle = terrain.height_m(Vec2::new(0.0, 50.0)).unwrap();
    assert!((middle - 5.0).abs() < 0.6, "{middle}");
}

fn shared(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data/dem").join(name);
    if !path.exists() {
        println!("skipped: no shared data ({name})");
    }
    path.exists().then_some(path)
}

#[test]
fn one_raster_in_two_formats_is_the_same() {
    let Some(tif) = shared("monaco_nice_srtm3_90m.tif") else { return };
    let read = |path: &Path| read(path, &Options::default()).unwrap();
    let (a, b) = (read(&tif), read(&tif.with_extension("asc")));
    assert_eq!((a.columns, a.rows()), (216, 144));
    let bits = |dem: &Dem| dem.heights.iter().map(|h| h.to_bits()).collect::<Vec<_>>();
    assert!(bits(&a) == bits(&b));
    let [p, q] = [a.extent().unwrap(), b.extent().unwrap()].map(|[sw, _]| sw);
    assert!((p.lon - q.lon).abs() < 1e-6 && (p.lat - q.lat).abs() < 1e-6, "{p:?} {q:?}");
    // Mont Agel, 1,148 m, east-north-east of Monaco.
    let frame = Frame::new(LonLat { lon: 7.42, lat: 43.74 }).unwrap();
    let bounds = Bounds { min: Vec2::splat(-5000.0), max: Vec2::splat(5000.0) };
    let terrain = a.onto(&frame, bounds, None).unwrap();
    let (_, highest) = terrain.range_m();
    assert!((1050.0..=1138.0).contains(&highest), "{highest}");
}

#[test]
fn real_rasters_lie_where_their_maps_do() {
    for (name, lon, lat, lowest, highest) in [
        ("portland_ned_10m.tif", -122.67, 45.52, 0.0, 330.0),
        ("porto_alegre_30m.tif", -51.2, -30.05, 0.0, 255.0),
        ("lauf_srtm3_90m.tif", 11.28, 49.51, 300.0, 541.0),
        ("prague_bubenec_dtm_2m.tif", 14.403, 50.103, 188.0, 223.0),
    ] {
        let Some(path) = shared(name) else { continue };
        let dem = read(&path, &Options::default()).unwrap();
        let frame = Frame::new(LonLat { lon, lat }).unwrap();
        let bounds = Bounds { min: Vec2::splat(-150.0), max: Vec2::splat(150.0) };
        let terrain = dem.onto(&frame, bounds, None).unwrap();
        let (low, high) = terrain.range_m();
        assert!(terrain.missing() == 0 && low >= lowest && high <= highest, "{name}: {low} {high}");
    }
}
