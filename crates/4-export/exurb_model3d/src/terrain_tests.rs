//! Models on a terrain.

#![allow(clippy::unwrap_used)]

use exurb_city::{City, Roof, Terrain};
use exurb_geom::{GridPoint, Vec2, trig};

use crate::drape::Drape;
use crate::scene::{Layer, Scene};
use crate::tests::{building, city_of, rectangle, town};
use crate::{Options, View, render_png, to_glb};

/// Hills of 40 m, 150 m apart, on a slope.
fn hills(p: Vec2) -> f32 {
    (300.0 + 0.1 * p.x + 20.0 * trig::sin(p.x / 24.0) * trig::cos(p.y / 31.0)) as f32
}

fn on_hills(mut city: City) -> City {
    let bounds = city.target.bounds().grown(100.0);
    city.lay(Terrain::over(bounds, 12.5, hills).unwrap());
    city
}

fn layer<'a>(scene: &'a Scene, name: &str) -> &'a Layer {
    scene.layers.iter().find(|l| l.name == name).unwrap_or_else(|| panic!("{name} is there"))
}

/// Middles of the upward triangles of a layer's first part.
fn middles(layer: &Layer) -> Vec<[f64; 3]> {
    let mesh = &layer.parts[0].mesh;
    let faces = mesh.indices.chunks_exact(3).filter(|t| mesh.normals[t[0] as usize][1] > 0.3);
    let middle = |t: &[u32]| {
        let corner = |k: usize| t.iter().map(|i| f64::from(mesh.positions[*i as usize][k])).sum();
        let sum: [f64; 3] = [corner(0), corner(1), corner(2)];
        sum.map(|v| v / 3.0)
    };
    faces.map(middle).collect()
}

#[test]
fn everything_lies_parallel_to_the_ground() {
    let city = on_hills(town());
    let scene = Scene::of(&city, &Options::default());
    let drape = Drape::of(&city, scene.bounds, scene.center);
    let over = |[x, y, z]: &[f64; 3]| y - drape.height_m(scene.center + Vec2::new(*x, -z));
    // Water is flat where it stands and raises the ground around; look away from it.
    let dry = |[x, _, z]: &&[f64; 3]| x.abs() > 70.0 || *z < -20.0 || *z > 120.0;
    for (name, offsets) in [
        ("ground", &[-0.25][..]),
        ("land_use", &[-0.12]),
        ("blocks", &[0.12]),
        ("streets", &[0.0, -0.04, 0.06]),
    ] {
        let places = middles(layer(&scene, name));
        assert!(places.len() > 20, "{name}: {}", places.len());
        let bridge = |along: f64, off: f64| off.abs() < 8.0 && (-8.0..108.0).contains(&along);
        let on_bridge = |[x, _, z]: &&[f64; 3]| bridge(-x, *z) || bridge(*z, *x);
        for p in places.iter().filter(dry).filter(|p| !on_bridge(p)) {
            let off = offsets.iter().map(|o| (over(p) - o).abs()).fold(f64::MAX, f64::min);
            assert!(off < 0.02, "{name} at {p:?}: {} over the ground", over(p));
        }
    }
}

#[test]
fn the_ground_covers_the_page_but_for_the_water() {
    let city = on_hills(town());
    let scene = Scene::of(&city, &Options::default());
    let mesh = &layer(&scene, "ground").parts[0].mesh;
    let plan_m2 = |t: &[u32]| {
        let p = |k: usize| mesh.positions[t[k] as usize].map(f64::from);
        let ([ax, _, az], [bx, _, bz], [cx, _, cz]) = (p(0), p(1), p(2));
        // z points south.
        -((bx - ax) * (cz - az) - (bz - az) * (cx - ax)) / 2.0
    };
    let upward: Vec<f64> = mesh.indices.chunks_exact(3).map(plan_m2).collect();
    assert!(upward.iter().all(|a| *a > -1e-3), "nothing looks down");
    let covered: f64 = upward.iter().sum();
    let expected = 460.0 * 460.0 - 60.0 * 80.0;
    assert!((covered / expected - 1.0).abs() < 1e-4, "{covered} of {expected}");
}

#[test]
fn buildings_stand_on_the_lowest_ground_of_their_footprint() {
    let footprint = rectangle(30.0, -20.0, 40.0, 25.0);
    let city = on_hills(city_of(vec![building(1, footprint.clone(), 9.0, Roof::Flat)]));
    let scene = Scene::of(&city, &Options::default());
    let lowest = footprint.lattice(0.5).iter().map(|p| hills(p.to_m())).fold(f32::MAX, f32::min);
    let heights = layer(&scene, "buildings").parts.iter().flat_map(|p| &p.mesh.positions);
    let heights: Vec<f32> = heights.map(|p| p[1] + scene.datum_m as f32).collect();
    let foot = heights.iter().copied().fold(f32::MAX, f32::min);
    let top = heights.iter().copied().fold(f32::MIN, f32::max);
    // The ground between posts is a little flatter than the hills.
    assert!((foot - (lowest - 0.25)).abs() < 0.8, "{foot}, {lowest}");
    assert!((top - foot - 9.25).abs() < 1e-3, "{top} {foot}");
}

#[test]
fn flat_ground_at_any_height_gives_the_same_model() {
    let mut high = town();
    high.lay(Terrain::over(high.target.bounds().grown(90.0), 50.0, |_| 250.0).unwrap());
    let (flat, high) = [town(), high].map(|c| Scene::of(&c, &Options::default())).into();
    assert_eq!(high.datum_m, 250.0);
    for (a, b) in flat.layers.iter().zip(&high.layers).filter(|(a, _)| a.name != "ground") {
        assert_eq!(a.name, b.name);
        let area = |l: &Layer| -> f64 {
            let of = |p: &crate::Part| -> f64 {
                let corner = |i: &u32| glam::Vec3::from(p.mesh.positions[*i as usize]);
                let area = |t: &[u32]| {
                    let [a, b, c] = [&t[0], &t[1], &t[2]].map(corner);
                    f64::from((b - a).cross(c - a).length()) / 2.0
                };
                p.mesh.indices.chunks_exact(3).map(area).sum()
            };
            l.parts.iter().map(of).sum()
        };
        let (a_m2, b_m2) = (area(a), area(b));
        assert!((a_m2 / b_m2 - 1.0).abs() < 2e-3, "{}: {a_m2} {b_m2}", a.name);
    }
}

#[test]
fn files_and_pictures_know_the_height_of_the_origin() {
    let city = on_hills(town());
    let glb = to_glb(&city, &Options::default()).unwrap();
    assert_eq!(glb, to_glb(&city, &Options::default()).unwrap());
    let gltf = gltf::Gltf::from_slice(&glb).unwrap();
    let extras = gltf.document.as_json().asset.extras.as_ref().unwrap().get().to_owned();
    let extras: serde_json::Value = serde_json::from_str(&extras).unwrap();
    let origin = &extras["georeference"]["model_origin_height_m"];
    assert_eq!(origin.as_f64(), Some(f64::from(hills(Vec2::ZERO)).round()));
    let view = View { width_px: 200, height_px: 120, ..View::default() };
    assert!(!render_png(&city, &Options::default(), &view).unwrap().is_empty());
    let p = GridPoint::m(0.0, 0.0);
    assert!(city.streets.nodes().any(|(_, n)| n.at == p && n.data.z_m > 250.0));
}
