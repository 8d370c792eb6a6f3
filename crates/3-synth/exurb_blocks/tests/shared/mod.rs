//! The real maps beside the repository.

#![allow(clippy::print_stdout, reason = "a skip says why")]
use std::path::{Path, PathBuf};

use exurb_city::{City, ImportOptions};

/// The maps whose buildings are complete, as the data's own table says.
pub const COMPLETE: [&str; 17] = [
    "baltimore_county_suburb_east",
    "berlin_borsigwalde",
    "copenhagen_east",
    "duesseldorf_bilk",
    "garmisch",
    "heidelberg_altstadt",
    "helsinki_center",
    "karlsruhe_kirchfeld",
    "lauf_pegnitz",
    "london_holborn",
    "monaco_menton_east",
    "munich_center",
    "nyc_greenwich_village",
    "porto_east",
    "skopje_center",
    "tokyo_ichigaya",
    "tokyo_kanda",
];

/// The folder of the maps; prints `skipped` where it is not there.
pub fn folder() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data/osm");
    if !folder.exists() {
        println!("skipped: no shared data");
        return None;
    }
    Some(folder)
}

/// A map as a city under its own name.
pub fn city(folder: &Path, name: &str) -> City {
    let path = folder.join(format!("{name}.osm.pbf"));
    let mut city = exurb_osm::read(&path, &ImportOptions::default()).expect("a map").city;
    city.metadata.name = name.into();
    city
}
