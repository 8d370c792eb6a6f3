#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::sync::Arc;

use exurb_city::{
    Area, Building, City, Class, Feature, FeatureShape, Origin, Provenance, Roof, Street, block,
    street_graph,
};
use exurb_geom::{Frame, GridPoint, Polygon, trig};
use glam::DVec3;

use crate::{Options, Scene, View, render_png, to_glb, to_obj};

pub fn rectangle(x: f64, y: f64, w: f64, h: f64) -> Polygon {
    Polygon::rectangle(GridPoint::m(x, y), GridPoint::m(x + w, y + h))
}

fn polygon(ring: &[(f64, f64)]) -> Polygon {
    Polygon::new(ring.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect(), vec![]).unwrap()
}

pub fn building(id: u32, polygon: Polygon, height_m: f64, roof: Roof) -> Building {
    let mut building = Building::new(id, polygon, Provenance::of(Origin::Procedural));
    building.height_m = Some(height_m);
    building.roof = Some(roof);
    building
}

pub fn city_of(buildings: Vec<Building>) -> City {
    let mut city = City::empty(Frame::null_island(), rectangle(-200.0, -200.0, 400.0, 400.0));
    city.buildings = Arc::new(buildings);
    city
}

/// Streets, a bridge over water, blocks, a park, houses of all roofs, trees and a lamp.
pub fn town() -> City {
    let footprint = |i: usize| {
        let (x, y) = (i as f64 % 4.0 * 100.0 - 180.0, (i / 4) as f64 * 100.0 - 180.0);
        rectangle(x, y, 30.0, 12.0)
    };
    let houses = Roof::ALL.iter().enumerate();
    let houses = houses.map(|(i, roof)| building(i as u32 + 1, footprint(i), 9.0, *roof));
    let mut city = city_of(houses.collect());
    let mut lines = Vec::new();
    for i in 0..5 {
        let at = f64::from(i) * 100.0 - 200.0;
        for k in 0..4 {
            let from = f64::from(k) * 100.0 - 200.0;
            let class = if i == 2 { Class::Primary } else { Class::Residential };
            let street = Street { class, bridge: i == 2 && k == 1, ..Street::default() };
            let down = vec![GridPoint::m(at, from), GridPoint::m(at, from + 100.0)];
            let across = vec![GridPoint::m(from, at), GridPoint::m(from + 100.0, at)];
            lines.extend([(down, street.clone()), (across, street)]);
        }
    }
    let streets = street_graph::from_lines(lines);
    city.blocks = Arc::new(block::derive(&streets));
    city.streets = Arc::new(streets);
    let area = |id, polygon, class: &str| Area { id, polygon, class: class.into() };
    city.water = Arc::new(vec![area(1, rectangle(-30.0, -90.0, 60.0, 80.0), "river")]);
    city.land_use = Arc::new(vec![area(1, rectangle(110.0, 110.0, 60.0, 60.0), "park")]);
    let feature = |id, kind: &str, x: f64, y: f64| Feature {
        id,
        kind: kind.into(),
        shape: FeatureShape::Point(GridPoint::m(x, y)),
        block: 0,
        provenance: Provenance::default(),
    };
    city.features =
        Arc::new(vec![feature(1, "tree", 120.0, 130.0), feature(2, "lamp", 90.0, 130.0)]);
    city.metadata.name = "town".into();
    city.metadata.attribution = vec!["© OpenStreetMap contributors, ODbL 1.0".to_owned()];
    city
}

/// Corners of all triangles of the buildings.
fn triangles(city: &City) -> Vec<[[f32; 3]; 3]> {
    let scene = Scene::of(city, &Options::default());
    let layer = scene.layers.iter().find(|l| l.name == "buildings").expect("there are buildings");
    let parts = layer.parts.iter();
    parts
        .flat_map(|p| {
            p.mesh
                .indices
                .chunks_exact(3)
                .map(|t| [t[0], t[1], t[2]].map(|i| p.mesh.positions[i as usize]))
        })
        .collect()
}

/// Every side of a triangle is a side of one other, the other way round.
fn assert_closed(triangles: &[[[f32; 3]; 3]], what: &str) {
    let mut sides: BTreeMap<[[u32; 3]; 2], i32> = BTreeMap::new();
    for t in triangles {
        let bits = t.map(|p| p.map(|v| (v + 0.0).to_bits()));
        for k in 0..3 {
            let (a, b) = (bits[k], bits[(k + 1) % 3]);
            *sides.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
        }
    }
    let open = sides.values().filter(|n| **n != 0).count();
    assert_eq!(open, 0, "{what}: {open} of {} sides are open", sides.len());
}

fn volume_m3(triangles: &[[[f32; 3]; 3]]) -> f64 {
    let point = |p: [f32; 3]| DVec3::from(p.map(f64::from));
    let cone = |t: &[[f32; 3]; 3]| point(t[0]).dot(point(t[1]).cross(point(t[2]))) / 6.0;
    triangles.iter().map(cone).sum()
}

fn footprints() -> Vec<(&'static str, Polygon)> {
    let courtyard = Polygon::new(
        rectangle(-20.0, -15.0, 40.0, 30.0).exterior().to_vec(),
        vec![rectangle(-8.0, -5.0, 16.0, 10.0).exterior().to_vec()],
    );
    let l = [(0.0, 0.0), (30.0, 0.0), (30.0, 10.0), (12.0, 10.0), (12.0, 25.0), (0.0, 25.0)];
    let t = [
        (0.0, 0.0),
        (36.0, 0.0),
        (36.0, 10.0),
        (23.0, 10.0),
        (23.0, 30.0),
        (13.0, 30.0),
        (13.0, 10.0),
        (0.0, 10.0),
    ];
    let circle: Vec<(f64, f64)> = (0..16)
        .map(|k| trig::unit(f64::from(k) * std::f64::consts::TAU / 16.0) * 7.0)
        .map(|p| (p.x, p.y))
        .collect();
    let shapes = [
        ("rectangle", rectangle(-10.0, -5.0, 20.0, 10.0)),
        ("square", rectangle(-5.0, -5.0, 10.0, 10.0)),
        ("courtyard", courtyard.unwrap()),
        ("l", polygon(&l)),
        ("t", polygon(&t)),
        ("circle", polygon(&circle)),
        ("kite", polygon(&[(0.0, 0.0), (9.0, 2.0), (14.0, 11.0), (1.0, 8.0)])),
    ];
    let turned = shapes.iter().map(|(name, p)| (*name, p.map(|q| trig::rotate(q, 0.4)).unwrap()));
    shapes.iter().cloned().chain(turned).collect()
}

#[test]
fn shells_of_every_roof_close() {
    for (name, footprint) in footprints() {
        for roof in Roof::ALL {
            let city = city_of(vec![building(1, footprint.clone(), 12.0, roof)]);
            assert_closed(&triangles(&city), &format!("{name}, {roof:?}"));
        }
    }
}

#[test]
fn a_flat_building_is_its_area_times_its_height() {
    for (name, footprint) in footprints() {
        let city = city_of(vec![building(1, footprint.clone(), 12.0, Roof::Flat)]);
        let expected = footprint.area_m2() * (12.0 - crate::ground::GROUND_M);
        let found = volume_m3(&triangles(&city));
        assert!((found - expected).abs() < 1e-3 * expected, "{name}: {found}, not {expected}");
    }
}

#[test]
fn a_gable_holds_half_of_its_box_and_stands_over_the_short_sides() {
    let city = city_of(vec![building(1, rectangle(-10.0, -4.0, 20.0, 8.0), 9.0, Roof::Gabled)]);
    let triangles = triangles(&city);
    let heights = triangles.iter().flatten().map(|p| p[1]);
    let eaves = heights.filter(|h| *h > 1.0 && *h < 8.9).fold(f32::MAX, f32::min);
    let (eaves, rise) = (f64::from(eaves), 9.0 - f64::from(eaves));
    let expected = 160.0 * (eaves - crate::ground::GROUND_M + rise / 2.0);
    assert!((volume_m3(&triangles) - expected).abs() < 1e-3 * expected);
    let ends = triangles.iter().flatten().filter(|p| p[1] > 8.999).map(|p| p[0].abs());
    assert!(ends.clone().count() > 0 && ends.clone().all(|x| (x - 10.0).abs() < 1e-3));
}

#[test]
fn parts_stand_for_the_building_around_them() {
    let whole = building(1, rectangle(0.0, 0.0, 20.0, 10.0), 10.0, Roof::Flat);
    let mut part = building(2, rectangle(0.0, 0.0, 20.0, 9.0), 30.0, Roof::Flat);
    part.is_part = true;
    part.min_height_m = 6.0;
    let triangles = triangles(&city_of(vec![whole, part]));
    let heights = || triangles.iter().flatten().map(|p| p[1]);
    assert_eq!(heights().fold(f32::MIN, f32::max), 30.0);
    assert_eq!(heights().fold(f32::MAX, f32::min), 6.0);
}

#[test]
fn a_glb_reads_back_with_its_layers_and_numbers() {
    let city = town();
    let scene = Scene::of(&city, &Options::default());
    let glb = to_glb(&city, &Options::default()).unwrap();
    let gltf = gltf::Gltf::from_slice(&glb).unwrap();
    let blob = gltf.blob.clone().unwrap();
    let names: Vec<&str> = gltf.nodes().filter_map(|n| n.name()).collect();
    for layer in ["city", "ground", "water", "land_use", "blocks", "streets", "buildings", "trees"]
    {
        assert!(names.contains(&layer), "{layer} is missing among {names:?}");
    }
    assert_eq!(gltf.nodes().filter(|n| n.mesh().is_none()).count(), 1, "the root");
    let mut count = 0;
    for primitive in gltf.meshes().flat_map(|m| m.primitives().collect::<Vec<_>>()) {
        let reader = primitive.reader(|_| Some(&blob));
        let n = reader.read_positions().unwrap().len() as u32;
        let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
        count += indices.len() / 3;
        assert!(indices.iter().all(|i| *i < n));
        for normal in reader.read_normals().unwrap() {
            let length = normal.iter().map(|v| v * v).sum::<f32>();
            assert!((length - 1.0).abs() < 1e-4, "{normal:?}");
        }
    }
    assert_eq!(count, scene.triangle_count());
    let buildings = gltf.nodes().find(|n| n.name() == Some("buildings")).unwrap();
    let extras: serde_json::Value =
        serde_json::from_str(buildings.extras().as_ref().unwrap().get()).unwrap();
    assert_eq!(extras["ids"], serde_json::json!((1..=10).collect::<Vec<u32>>()));
    let asset = &gltf.document.as_json().asset;
    assert!(asset.copyright.as_ref().unwrap().contains("OpenStreetMap"));
    assert!(asset.extras.as_ref().unwrap().get().contains("Transverse_Mercator"));
}

#[test]
fn what_stands_past_the_target_is_shown_and_the_origin_stays() {
    let inside = building(1, rectangle(0.0, 0.0, 10.0, 10.0), 9.0, Roof::Flat);
    let outside = building(2, rectangle(900.0, 0.0, 10.0, 10.0), 9.0, Roof::Flat);
    let city = city_of(vec![inside, outside]);
    let scene = Scene::of(&city, &Options::default());
    let buildings = scene.layers.iter().find(|layer| layer.name == "buildings").expect("a layer");
    let ids: Vec<u32> =
        buildings.parts.iter().flat_map(|p| p.elements.iter().map(|(id, _)| *id)).collect();
    assert!(ids.contains(&1) && ids.contains(&2), "{ids:?}");
    let middle = city.target.bounds().center();
    assert!(scene.center.distance(middle) < 1.0, "the origin is the target's middle");
}

#[test]
fn element_stretches_cover_all_triangles_in_order() {
    for layer in Scene::of(&town(), &Options::default()).layers {
        for part in layer.parts {
            assert_eq!(part.elements[0].1, 0, "{}", layer.name);
            let ends = part.elements.iter().skip(1).map(|e| e.1);
            let ends = ends.chain([part.mesh.indices.len() as u32]);
            assert!(part.elements.iter().zip(ends).all(|((_, from), to)| *from < to));
            assert!(part.mesh.uvs.is_empty() != part.material.is_textured());
        }
    }
}

#[test]
fn threads_do_not_matter() {
    let pool = |n| rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap();
    let view = View { width_px: 160, height_px: 100, ..View::default() };
    let make = || {
        let city = town();
        let options = Options::default();
        (to_glb(&city, &options).unwrap(), render_png(&city, &options, &view).unwrap())
    };
    assert!(pool(1).install(make) == pool(3).install(make));
}

#[test]
fn an_obj_names_every_building_and_stays_within_its_vertices() {
    let city = town();
    let files = to_obj(&city, &Options::default(), "town").unwrap();
    let lines = || files.obj.lines();
    let count = |start: &str| lines().filter(|l| l.starts_with(start)).count();
    assert_eq!(count("f "), Scene::of(&city, &Options::default()).triangle_count());
    for id in 1..=10 {
        assert!(lines().any(|l| l == format!("g buildings_{id}")), "{id}");
    }
    let (vertices, uvs) = (count("v "), count("vt "));
    for corner in lines().filter(|l| l.starts_with("f ")).flat_map(|l| l[2..].split(' ')) {
        let mut numbers = corner.split('/');
        assert!((1..=vertices).contains(&numbers.next().unwrap().parse().unwrap()));
        let uv = numbers.next().unwrap();
        assert!(uv.is_empty() || (1..=uvs).contains(&uv.parse().unwrap()));
    }
    for name in lines().filter_map(|l| l.strip_prefix("usemtl ")) {
        assert!(files.mtl.contains(&format!("newmtl {name}\n")));
    }
    assert!(files.obj.contains("OpenStreetMap") && files.textures.len() == 1);
}

/// Width, height and RGB of a PNG.
fn decode(png: &[u8]) -> (usize, usize, Vec<[u8; 3]>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    let pixels = bytes.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
    (info.width as usize, info.height as usize, pixels)
}

fn brightness(p: [u8; 3]) -> u32 {
    p.map(u32::from).iter().sum()
}

#[test]
fn a_tower_throws_its_shadow_away_from_the_sun() {
    let tower = building(1, rectangle(-15.0, -15.0, 30.0, 30.0), 60.0, Roof::Flat);
    let view = View {
        width_px: 300,
        height_px: 300,
        azimuth_deg: 180.0,
        elevation_deg: 89.0,
        sun_azimuth_deg: 90.0,
        sun_elevation_deg: 45.0,
        caption: false,
        ..View::default()
    };
    let png = render_png(&city_of(vec![tower]), &Options::default(), &view).unwrap();
    let (w, h, pixels) = decode(&png);
    assert_eq!((w, h), (300, 300));
    // The frame is some 280 m wide, its middle 11 m south of the tower's; north is up.
    let at = |x: usize| brightness(pixels[(h / 2 - 12) * w + x]);
    let (west, east) = (at(w / 2 - 42), at(w / 2 + 42));
    assert!(west * 10 < east * 7, "the ground in the west has {west}, in the east {east}");
}

#[test]
fn a_picture_shows_the_city_and_the_sky() {
    let view = View { width_px: 320, height_px: 200, elevation_deg: 8.0, ..View::default() };
    let (w, h, pixels) = decode(&render_png(&town(), &Options::default(), &view).unwrap());
    let [r, _, b] = pixels[w / 2];
    assert!(b > r, "the sky is blue");
    let below = &pixels[w * h / 2..];
    let mean = below.iter().map(|p| brightness(*p)).sum::<u32>() / below.len() as u32;
    let spread = below.iter().map(|p| brightness(*p).abs_diff(mean)).sum::<u32>();
    assert!(spread / below.len() as u32 > 15, "the city is not one grey");
}

#[test]
fn an_empty_city_gives_empty_files() {
    let city = City::empty(Frame::null_island(), rectangle(0.0, 0.0, 0.001, 0.001));
    let glb = to_glb(&city, &Options::default()).unwrap();
    assert!(gltf::Gltf::from_slice(&glb).is_ok());
    assert!(to_obj(&city, &Options::default(), "x").unwrap().obj.contains("o ground"));
    let view = View { width_px: 16, height_px: 16, ..View::default() };
    assert!(render_png(&city, &Options::default(), &view).is_ok());
    let none = View { width_px: 0, ..view };
    assert!(render_png(&city, &Options::default(), &none).is_err());
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(200))]

    #[test]
    fn whatever_a_building_is_it_does_no_harm(
        points in proptest::collection::vec((-60..60i32, -60..60i32), 3..20),
        hole in proptest::collection::vec((-60..60i32, -60..60i32), 3..6),
        height_m in proptest::prelude::prop_oneof![
            -5.0..60.0f64,
            proptest::prelude::Just(f64::NAN),
            proptest::prelude::Just(f64::INFINITY),
        ],
        min_height_m in -5.0..80.0f64,
        roof in 0..10usize,
    ) {
        let ring = |r: &[(i32, i32)]| r.iter().map(|(x, y)| GridPoint { x: x * 500, y: y * 500 }).collect();
        if let Some(polygon) = Polygon::new(ring(&points), vec![ring(&hole)]) {
            let mut house = building(1, polygon, height_m, Roof::ALL[roof]);
            house.min_height_m = min_height_m;
            let scene = Scene::of(&city_of(vec![house]), &Options::default());
            let corners = scene.layers.iter().flat_map(|l| &l.parts).flat_map(|p| &p.mesh.positions);
            proptest::prop_assert!(corners.flatten().all(|v| v.is_finite()));
        }
    }
}
