//! `panel FILE MAP...`: measures the built-in panel from maps. `cargo xtask panel` runs it.

use std::error::Error;
use std::path::PathBuf;

use exurb_city::{City, ImportOptions};
use exurb_likeness::Panel;

fn main() -> Result<(), Box<dyn Error>> {
    let city = |file: PathBuf| -> Result<City, Box<dyn Error>> {
        let mut city = exurb_osm::read(&file, &ImportOptions::default())?.city;
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        city.metadata.name = name.split('.').next().unwrap_or_default().into();
        Ok(city)
    };
    let mut files = std::env::args_os().skip(1).map(PathBuf::from);
    let out = files.next().ok_or("name the file to write, then the maps")?;
    let cities: Vec<City> = files.map(city).collect::<Result<_, _>>()?;
    std::fs::write(out, Panel::measure(&cities, 1)?.write()?)?;
    Ok(())
}
