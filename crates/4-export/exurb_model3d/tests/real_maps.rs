//! Models of real maps, where the shared data are at hand.

#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "this is a test")]

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use exurb_city::{Building, City, ImportOptions};
use exurb_model3d::{Options, Scene, View, render_png, to_glb};

/// A map of the shared data beside the repository; nothing, with a word, where there is none.
fn map(name: &str) -> Option<City> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data/osm");
    let path = root.join(format!("{name}.osm.pbf"));
    if !path.exists() {
        println!("skipped: no shared data");
        return None;
    }
    Some(exurb_osm::read(&path, &ImportOptions::default()).unwrap().city)
}

/// Do all sides of the triangles of one building pair up?
fn is_closed(city: &City, building: &Building) -> bool {
    let mut alone = City::empty(city.frame.clone(), city.target.clone());
    alone.buildings = Arc::new(vec![building.clone()]);
    let scene = Scene::of(&alone, &Options::default());
    let Some(layer) = scene.layers.iter().find(|l| l.name == "buildings") else { return true };
    let mut sides: BTreeMap<[[u32; 3]; 2], i32> = BTreeMap::new();
    for part in &layer.parts {
        for t in part.mesh.indices.chunks_exact(3) {
            let corner =
                |k: usize| part.mesh.positions[t[k % 3] as usize].map(|v| (v + 0.0).to_bits());
            for k in 0..3 {
                let (a, b) = (corner(k), corner(k + 1));
                *sides.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
            }
        }
    }
    sides.values().all(|n| *n == 0)
}

#[test]
fn shells_of_real_buildings_close() {
    for name in ["munich_center", "karlsruhe_kirchfeld"] {
        let Some(city) = map(name) else { return };
        let buildings = || city.buildings.iter().step_by(6);
        let count = buildings().count();
        let open: Vec<u32> = buildings().filter(|b| !is_closed(&city, b)).map(|b| b.id).collect();
        // Rings that touch themselves cannot close.
        assert!(open.len() * 100 <= count, "{name}: {} of {count} are open: {open:?}", open.len());
    }
}

#[test]
fn real_maps_become_models_and_pictures() {
    let view = View { width_px: 400, height_px: 250, ..View::default() };
    for name in ["copenhagen_east", "cairo"] {
        let Some(city) = map(name) else { return };
        let glb = to_glb(&city, &Options::default()).unwrap();
        let gltf = gltf::Gltf::from_slice(&glb).unwrap();
        assert!(gltf.nodes().any(|n| n.name() == Some("streets")), "{name}");
        assert!(!render_png(&city, &Options::default(), &view).unwrap().is_empty());
    }
}
