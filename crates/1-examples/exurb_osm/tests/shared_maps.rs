//! All real maps beside the repository: laws, lengths and counts against the table of their README.

mod shared;

use std::collections::BTreeMap;

use exurb_city::{City, Class, ImportOptions, Part};
use exurb_geom::LonLat;

/// One row of the README's table.
struct Row {
    file: String,
    bbox: [f64; 4],
    road_km: f64,
    buildings: f64,
    complete: bool,
    missing_nodes: bool,
}

fn rows(readme: &str) -> Vec<Row> {
    let cells = |line: &str| line.split('|').map(|c| c.trim().to_owned()).collect::<Vec<_>>();
    readme
        .lines()
        .filter(|line| line.starts_with("| osm/"))
        .map(cells)
        .map(|cell| {
            let number = |text: &str| text.parse::<f64>().expect("a number");
            let bbox: Vec<f64> = cell[3].split(", ").map(number).collect();
            Row {
                file: cell[1].clone(),
                bbox: [bbox[0], bbox[1], bbox[2], bbox[3]],
                road_km: number(&cell[6]),
                buildings: cell[8].split('+').map(number).sum(),
                complete: cell[10].starts_with("complete"),
                missing_nodes: cell[13].contains("missing node"),
            }
        })
        .collect()
}

/// Kilometres of the classes that the table counts.
fn road_km(city: &City) -> f64 {
    let counted = city.streets.edges().filter(|(_, e)| e.data.class != Class::Pedestrian);
    counted.map(|(_, e)| e.length_m()).sum::<f64>() / 1000.0
}

#[test]
fn every_map_keeps_the_laws_and_has_the_lengths_and_buildings_of_the_table() {
    let Some(data) = shared::data() else { return };
    let readme = std::fs::read_to_string(data.join("README.md")).expect("a README");
    let rows = rows(&readme);
    assert_eq!(rows.len(), 48);
    for row in rows {
        let file = &row.file;
        let city = exurb_osm::read(&data.join(file), &ImportOptions::default()).expect(file).city;
        assert_eq!(exurb_graph::laws::breaches(&city.streets), [], "{file}");

        let km = road_km(&city);
        // The table counts squares drawn as streets, too: 12 km in Malta, hardly any elsewhere.
        let slack = if file.contains("malta") { 0.03 } else { 0.02 };
        assert!(
            (km / row.road_km - 1.0).abs() < slack,
            "{file}: {km} km, expected {}",
            row.road_km
        );
        assert_eq!(city.metadata.buildings_complete, row.complete, "{file}");
        let whole = city.buildings.iter().filter(|b| !b.is_part).count() as f64;
        // Files cut upstream have lost corners of buildings at their edge; those go.
        let slack = if row.missing_nodes { 0.10 } else { 0.01 };
        if row.complete {
            let expected = row.buildings;
            assert!((whole / expected - 1.0).abs() < slack, "{file}: {whole}, expected {expected}");
        }
        let [sw, ne] = city.lonlat_bbox().expect("an extent");
        for (found, given) in [sw.lon, sw.lat, ne.lon, ne.lat].into_iter().zip(row.bbox) {
            assert!((found - given).abs() < 2e-4, "{file}: {found}, declared {given}");
        }
        assert_eq!(city.metadata.attribution, [exurb_osm::ATTRIBUTION], "{file}");
        check_numbers(&city, file);
    }
}

/// Ids count from 1 and what names a block lies in it.
fn check_numbers(city: &City, file: &str) {
    for (i, building) in city.buildings.iter().enumerate() {
        assert_eq!(building.id as usize, i + 1, "{file}");
        let at = exurb_geom::GridPoint::round(building.polygon.interior_point());
        let home = city.blocks.iter().find(|b| b.id == building.block);
        if let Some(home) = home {
            assert!(home.polygon.contains(at), "{file}: building {}", building.id);
        }
    }
}

fn read(stem: &str, options: &ImportOptions) -> Option<City> {
    let path = shared::map(stem)?;
    Some(exurb_osm::read(&path, options).expect(stem).city)
}

#[test]
fn halves_make_the_whole_and_cutting_loses_nothing_inside() {
    for stem in ["reno_east", "copenhagen_east", "milan_east"] {
        let half = |part| read(stem, &ImportOptions { part: Some(part), ..Default::default() });
        let Some(west) = half(Part::West) else { return };
        let east = half(Part::East).expect("as the west");
        let south = half(Part::South).expect("as the west");
        let north = half(Part::North).expect("as the west");
        let sum = |a: &City, b: &City| road_km(a) + road_km(b);
        let (by_x, by_y) = (sum(&west, &east), sum(&south, &north));
        assert!((by_x - by_y).abs() < 0.1, "{stem}: {by_x} and {by_y} km");
        assert!(west.area_km2() <= 12.5 + 1e-6 && (west.area_km2() - east.area_km2()).abs() < 0.01);
        assert_eq!(west.target.bounds().max.x, east.target.bounds().min.x);

        // Every street of the part is one of the whole, with the same vertices.
        let whole = read(stem, &ImportOptions::default()).expect("as the west");
        let vertices = |city: &City| -> BTreeMap<_, usize> {
            let mut out = BTreeMap::new();
            for (_, edge) in city.streets.edges() {
                for p in edge.line() {
                    *out.entry(*p).or_default() += 1;
                }
            }
            out
        };
        let known = vertices(&whole);
        let edge = west.target.clone();
        let strange = vertices(&west)
            .into_keys()
            .filter(|p| edge.boundary_distance_m(p.to_m()) > 0.01 && !known.contains_key(p));
        assert_eq!(strange.count(), 0, "{stem}");
    }
}

#[test]
fn a_box_cuts_what_it_says() {
    let sw = LonLat { lon: 24.935, lat: 60.165 };
    let ne = LonLat { lon: 24.95, lat: 60.175 };
    let options = ImportOptions { bbox: Some([sw, ne]), ..Default::default() };
    let Some(city) = read("helsinki_center", &options) else { return };
    let [a, b] = city.lonlat_bbox().expect("an extent");
    assert!((a.lon - sw.lon).abs() < 1e-5 && (b.lat - ne.lat).abs() < 1e-5, "{a:?} {b:?}");
    let inside = |p| city.target.contains(exurb_geom::GridPoint::round(p));
    assert!(city.buildings.iter().all(|b| inside(b.polygon.centroid())));
    let whole = read("helsinki_center", &ImportOptions::default()).expect("read before");
    let there = whole.buildings.iter().filter(|b| {
        let place = whole.frame.unproject(b.polygon.centroid());
        (sw.lon..ne.lon).contains(&place.lon) && (sw.lat..ne.lat).contains(&place.lat)
    });
    assert!(there.count().abs_diff(city.buildings.len()) <= 2);

    let nowhere = [LonLat { lon: 1.0, lat: 1.0 }, LonLat { lon: 1.1, lat: 1.1 }];
    let options = ImportOptions { bbox: Some(nowhere), ..Default::default() };
    let path = shared::map("helsinki_center").expect("read before");
    let message = exurb_osm::read(&path, &options).expect_err("nothing is there").to_string();
    assert!(message.contains("nothing lies inside the box 1,1,1.1,1.1"), "{message}");
}

#[test]
fn service_roads_count_when_asked_for() {
    let Some(without) = read("nyc_greenwich_village", &ImportOptions::default()) else { return };
    let options = ImportOptions { with_other: true, ..Default::default() };
    let with = read("nyc_greenwich_village", &options).expect("read before");
    assert!(!without.other_ways.is_empty() && with.other_ways.is_empty());
    assert!(with.streets.length_m() > without.streets.length_m());
}

#[test]
fn the_sea_lies_off_the_coast() {
    // Share of the extent that is sea, by eye on the map.
    for (stem, low, high) in [("monaco_menton_east", 0.35, 0.65), ("malta_valletta", 0.1, 0.5)] {
        let Some(city) = read(stem, &ImportOptions::default()) else { return };
        let sea = city.water.iter().filter(|a| &*a.class == "sea");
        let share = sea.map(|a| a.polygon.area_m2()).sum::<f64>() / city.target.area_m2();
        assert!((low..high).contains(&share), "{stem}: {share}");
        let drowned = city.streets.nodes().filter(|(_, n)| {
            city.water.iter().any(|a| &*a.class == "sea" && a.polygon.contains(n.at))
        });
        let (drowned, all) = (drowned.count(), city.streets.node_count());
        assert!(drowned * 50 < all, "{stem}: {drowned} of {all} junctions lie in the sea");
    }
}
