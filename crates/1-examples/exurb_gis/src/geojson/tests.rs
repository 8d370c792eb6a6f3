use std::path::{Path, PathBuf};

use exurb_city::{City, ImportOptions, Imported, Role};
use exurb_geom::Frame;
use proptest::prelude::*;

use super::{read_geojson_many, read_stream, write_geojson};
use crate::Error;
use crate::sample::{self, any_city, assert_same};

fn written(city: &City) -> String {
    let mut out = Vec::new();
    write_geojson(city, &mut out).unwrap();
    String::from_utf8(out).unwrap()
}

fn read(text: &str, name: &str) -> Result<Imported, Error> {
    read_stream(text.as_bytes(), "test.geojson", name, &ImportOptions::default())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn what_is_written_is_read_back(city in any_city()) {
        let text = written(&city);
        let imported = read(&text, "x").unwrap();
        prop_assert_eq!(&imported.warnings, &Vec::<String>::new());
        assert_same(&imported.city, &city);
    }

    #[test]
    fn what_is_written_is_geojson_to_another_reader(city in any_city()) {
        let geojson::GeoJson::FeatureCollection(collection) = written(&city).parse().unwrap() else {
            panic!("a collection");
        };
        let rows = city.streets.edge_count() + city.streets.node_count() + city.other_ways.len()
            + city.blocks.len() + city.parcels.len() + city.buildings.len() + city.features.len()
            + city.water.len() + city.land_use.len() + 1;
        prop_assert_eq!(collection.features.len(), rows);
        for feature in &collection.features {
            prop_assert!(feature.property("element").is_some_and(|e| e.is_string()));
            if let Some(geojson::GeometryValue::Polygon { coordinates }) =
                feature.geometry.as_ref().map(|g| &g.value)
            {
                for (i, ring) in coordinates.iter().enumerate() {
                    prop_assert_eq!(ring.first(), ring.last());
                    let area: f64 = ring.windows(2)
                        .map(|w| (w[0][0] - ring[0][0]) * (w[1][1] - ring[0][1])
                            - (w[1][0] - ring[0][0]) * (w[0][1] - ring[0][1]))
                        .sum();
                    // Nothing wraps around the world in a city of 4 km.
                    let wraps = ring.iter().any(|p| (p[0] - ring[0][0]).abs() > 180.0);
                    prop_assert!(wraps || (area > 0.0) == (i == 0), "outer rings turn left, holes right");
                }
            }
        }
    }
}

#[test]
fn features_speak_as_osm_does() {
    let city = sample::grid_city(2);
    let doc: serde_json::Value = serde_json::from_str(&written(&city)).unwrap();
    let features = doc["features"].as_array().unwrap();
    let first = |element: &str| {
        features.iter().map(|f| &f["properties"]).find(|p| p["element"] == element).unwrap()
    };
    assert_eq!(first("street")["highway"], "residential");
    assert!(first("street").get("bridge").is_none());
    assert_eq!(
        (&first("building")["building"], &first("building")["height"]),
        (&"yes".into(), &7.3.into())
    );
    assert_eq!(features.iter().filter(|f| f["properties"]["element"] == "target").count(), 1);
    let bbox: Vec<f64> =
        doc["bbox"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
    let corner = |x: f64, y: f64| city.frame.unproject(exurb_geom::Vec2::new(x, y));
    let (sw, ne) = (corner(0.0, 0.0), corner(100.0, 100.0));
    for (found, side) in bbox.iter().zip([sw.lon, sw.lat, ne.lon, ne.lat]) {
        assert!((found - side).abs() < 1e-5, "{bbox:?}");
    }
}

const LINE: &str = r#""type":"LineString","coordinates":[[14.40,50.10],[14.41,50.10]]"#;
const CROSSING: &str =
    r#""type":"LineString","coordinates":[[14.405,50.095],[14.405,50.105,212.0]]"#;

#[test]
fn every_outermost_object_is_understood() {
    let files = [
        format!(r#"{{"type":"GeometryCollection","geometries":[{{{LINE}}},{{{CROSSING}}}]}}"#),
        format!(r#"{{"type":"Feature","geometry":{{"type":"GeometryCollection","geometries":[{{{LINE}}},{{{CROSSING}}}]}},"properties":null}}"#),
        format!("{{{LINE}}}\n{{{CROSSING}}}\n"),
        format!(r#"{{"geometry":{{{LINE}}},"type":"Feature"}}{{"type":"Feature","geometry":{{{CROSSING}}}}}"#),
        format!("\u{feff}{{\"features\":[{{\"type\":\"Feature\",\"properties\":{{}},\"geometry\":{{{LINE}}}}},\
            {{\"type\":\"Feature\",\"properties\":{{\"x\":[1,{{}}]}},\"geometry\":{{{CROSSING}}}}}],\"type\":\"FeatureCollection\"}}"),
        r#"{"coordinates":[[[14.40,50.10],[14.41,50.10]],[[14.405,50.095],[14.405,50.105]]],"type":"MultiLineString"}"#.to_owned(),
    ];
    for text in files {
        let city = read(&text, "map").unwrap_or_else(|e| panic!("{e}: {text}")).city;
        assert_eq!(city.streets.edge_count(), 4, "{text}");
        assert!(city.streets.edges().all(|(_, e)| e.data.role() == Role::Local));
    }
}

#[test]
fn coordinates_in_metres() {
    let metres = |crs: &str| {
        format!(
            r#"{{"type":"FeatureCollection",{crs}"features":[{{"type":"Feature","properties":{{"highway":"primary"}},
            "geometry":{{"type":"LineString","coordinates":[[459000,5550000],[459300,5550400]]}}}}]}}"#
        )
    };
    let placeless = read(&metres(""), "map").unwrap();
    assert_eq!(placeless.city.streets.length_m(), 500.0);
    assert_eq!(placeless.city.frame.origin(), Frame::null_island().origin());
    assert!(placeless.warnings[0].contains("null island"), "{:?}", placeless.warnings);

    let crs = r#""crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32633"}},"#;
    let placed = read(&metres(crs), "map").unwrap().city;
    assert!((placed.frame.origin().lat - 50.1).abs() < 0.1);
    assert!((placed.streets.length_m() - 500.0).abs() < 0.3);

    let crs = r#""crs":{"type":"name","properties":{"name":"town grid"}},"#;
    let error = read(&metres(crs), "map").unwrap_err().to_string();
    assert!(error.contains("town grid") && error.contains("reproject"), "{error}");
}

#[test]
fn errors_say_what_is_wrong_and_where() {
    for (text, word) in [
        ("", "EOF"),
        ("[1, 2]", "GeoJSON object"),
        (r#"{"type":"FeatureCollection","features":[{"type":"Feat"#, "EOF"),
        (r#"{"type":"FeatureCollection","features":[]}"#, "holds no streets"),
        (r#"{"type":"LineString","coordinates":[[null,50],[14,51]]}"#, "holds no streets"),
    ] {
        let error = read(text, "map").unwrap_err().to_string();
        assert!(error.contains(word) && error.contains("test.geojson"), "{text}: {error}");
    }
    let broken = written(&sample::grid_city(1))
        .replace("\"class\":\"residential\"", "\"class\":\"cowpath\"");
    let error = read(&broken, "map").unwrap_err().to_string();
    assert!(error.contains("feature 2 (a streets)") || error.contains("cowpath"), "{error}");
}

fn shared(names: &[&str]) -> Option<Vec<PathBuf>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data/parcels");
    if !folder.is_dir() {
        println!("skipped: no shared data");
        return None;
    }
    Some(names.iter().map(|name| folder.join(format!("{name}.geojson"))).collect())
}

#[test]
fn a_french_suburb_in_four_files() {
    let names =
        ["parcels", "buildings", "roads", "zoning"].map(|n| format!("fr_besancon_thise_{n}"));
    let Some(paths) = shared(&names.each_ref().map(String::as_str)) else { return };
    let imported = read_geojson_many(&paths, &ImportOptions::default()).unwrap();
    let city = imported.city;
    assert!(city.parcels.len() >= 840, "{}", city.parcels.len());
    assert!(city.buildings.len() >= 320, "{}", city.buildings.len());
    let km = city.streets.length_m() / 1000.0;
    assert!((10.0..23.0).contains(&km), "{km}");
    assert!(city.streets.edges().any(|(_, e)| e.data.width_m > 0.0));
    assert!(city.land_use.len() >= 25);
}

#[test]
fn each_cadastral_file_alone() {
    let counts = [
        ("cz_prague_bubenec_plots", 407, 0, 0),
        ("cz_prague_bubenec_buildings", 0, 144, 0),
        ("cz_prague_bubenec_streets", 0, 0, 30),
        ("fr_25354_village_parcels", 511, 0, 0),
        ("fr_25354_village_buildings", 0, 252, 0),
        ("fr_13029_village_parcels", 389, 0, 0),
        ("fr_13029_village_buildings", 0, 239, 0),
    ];
    for (name, parcels, buildings, streets) in counts {
        let Some(paths) = shared(&[name]) else { return };
        let city = read_geojson_many(&paths, &ImportOptions::default()).unwrap().city;
        assert!(city.parcels.len() >= parcels, "{name}: {}", city.parcels.len());
        assert!(city.buildings.len() >= buildings, "{name}: {}", city.buildings.len());
        assert!(city.streets.edge_count() >= streets, "{name}: {}", city.streets.edge_count());
    }
}

/// Streets of another program that a rectangle clipped, turned against the city's plane: their ends are
/// cut, said in a warning, and stay so when the city is written and read.
#[test]
fn ends_that_a_turned_clip_left_are_no_dead_ends() {
    let east = exurb_geom::trig::unit(0.3);
    let at = |x: f64, y: f64| {
        let p = (east * x + east.perp() * y) * 0.001;
        format!("[{},{}]", 9.0 + p.x, 50.0 + p.y)
    };
    let street = |from: String, to: String| {
        format!(
            r#"{{"type":"Feature","properties":{{"highway":"residential"}},
            "geometry":{{"type":"LineString","coordinates":[{from},{to}]}}}}"#
        )
    };
    let mut streets = vec![street(at(0.5, 0.5), at(0.5, 0.9))];
    for i in -3..=3 {
        let i = f64::from(i);
        streets.push(street(at(i, -4.0), at(i, 4.0)));
        streets.push(street(at(-4.0, i), at(4.0, i)));
    }
    let text = format!(r#"{{"type":"FeatureCollection","features":[{}]}}"#, streets.join(","));
    let imported = read(&text, "clip").unwrap();
    assert!(imported.warnings.iter().any(|w| w.contains("28 ends")), "{:?}", imported.warnings);
    let cut = |city: &City| city.streets.nodes().filter(|(_, n)| n.data.cut).count();
    assert_eq!(cut(&imported.city), 28);
    assert_eq!(cut(&read(&written(&imported.city), "clip").unwrap().city), 28);
}
