//! `panel FILE CITY... -- TOWN...`: measures the built-in panel from maps. `cargo xtask panel` runs it.

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
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let (out, maps) = arguments.split_first().ok_or("name the file to write, then the maps")?;
    let at = maps.iter().position(|map| map.as_os_str() == "--").unwrap_or(maps.len());
    let read = |maps: &[PathBuf]| maps.iter().cloned().map(city).collect::<Result<Vec<_>, _>>();
    let (cities, towns) = (read(&maps[..at])?, read(maps.get(at + 1..).unwrap_or_default())?);
    std::fs::write(out, Panel::measure(&cities, &towns, 1)?.write()?)?;
    Ok(())
}
