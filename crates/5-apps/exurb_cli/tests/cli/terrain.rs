//! Terrain on the command line: read, laid, written, read again.

use std::fs;
use std::path::Path;

use tempfile::tempdir;

use crate::{exurb, listing};

/// An ASCII grid of `columns` x 60 cells of 0.0002 degrees from the south-west of Helsinki's
/// centre: a ramp of 1 m a cell eastwards.
fn ramp(folder: &Path, columns: usize) {
    let row: Vec<String> = (0..columns).map(|c| c.to_string()).collect();
    let head =
        format!("ncols {columns}\nnrows 60\nxllcorner 24.935\nyllcorner 60.165\ncellsize 0.0002\n");
    let rows = vec![row.join(" "); 60].join("\n");
    fs::write(folder.join("dem.asc"), head + &rows).unwrap();
}

const IMPORT: [&str; 4] = ["import", "builtin:helsinki", "--bbox", "24.938,60.167,24.944,60.171"];

fn import<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&IMPORT[..], more].concat()
}

#[test]
fn a_height_map_is_laid_under_a_map_and_written_again() {
    let folder = tempdir().unwrap();
    let here = folder.path();
    ramp(here, 60);
    exurb(here, &import(&["--terrain", "dem.asc", "--water-level", "18", "-o", "c.gpkg"])).ends(0);
    for (file, beside) in [("t.tif", 0), ("t.png", 3)] {
        let before = listing(here).len();
        exurb(here, &["export", "c.gpkg", "--layer", "terrain", "-o", file]).ends(0);
        assert_eq!(listing(here).len(), before + 1 + beside, "{file}");
        let city = format!("{file}.gpkg");
        exurb(here, &import(&["--terrain", file, "-o", &city])).ends(0);
        exurb(here, &["export", &city, "-o", "again.tif"]).ends(0);
        exurb(here, &import(&["--terrain", "c.gpkg", "-o", "from_city.gpkg"])).ends(0);
    }
    exurb(here, &["export", "c.gpkg", "-o", "c.tif"]).ends(0);
    exurb(here, &["export", "from_city.gpkg", "-o", "again.tif"]).ends(0);
    let bytes = |name: &str| fs::read(here.join(name)).unwrap();
    assert!(bytes("c.tif") == bytes("again.tif"), "the terrain of a city file is taken as it is");
    exurb(here, &["render", "c.gpkg", "-o", "map.svg"]).ends(0);
    let svg = fs::read_to_string(here.join("map.svg")).unwrap();
    assert!(svg.contains("<g id=\"terrain\">") && svg.contains("<g id=\"water\">\n<g"));
    exurb(here, &["render", "c.gpkg", "-o", "map.tif"]).ends(2).says("no picture");
    exurb(here, &["export", "c.gpkg", "--layer", "streets", "-o", "s.tif"]).ends(2).says("terrain");
}

#[test]
fn what_a_height_map_lacks_is_told_extended_or_refused() {
    let folder = tempdir().unwrap();
    let here = folder.path();
    ramp(here, 30);
    let lay = |more: &[&str]| {
        let args = import(&[&["--terrain", "dem.asc", "-o", "c.gpkg"], more].concat());
        exurb(here, &args)
    };
    lay(&[]).ends(0).says("% of the target").says("go on there");
    let before = listing(here);
    lay(&["--terrain-gaps", "refuse"]).ends(2).says("dem.asc knows no height for");
    fs::remove_file(here.join("c.gpkg")).unwrap();
    lay(&["--terrain-gaps", "refuse"]).ends(2);
    assert_eq!(listing(here).len(), before.len() - 1, "nothing is left");
    let elsewhere = ["--terrain-bounds", "7,43,8,44"];
    lay(&elsewhere).ends(2).says("knows no height where the city lies");
    lay(&["--terrain-crs", "EPSG:99"]).ends(2).says("EPSG:99");
    exurb(here, &import(&["--terrain", "no.tif", "-o", "c.gpkg"])).ends(2).says("no.tif");
    exurb(here, &import(&["--water-level", "3", "-o", "c.gpkg"])).ends(2).says("--terrain");
    exurb(here, &["export", "builtin:helsinki", "-o", "t.tif"]).ends(1).says("no terrain");
}

#[test]
fn a_target_gets_its_ground_and_the_recipe_names_it() {
    let folder = tempdir().unwrap();
    let here = folder.path();
    ramp(here, 60);
    let line = "streets grow -e builtin:helsinki --size 300x300 --terrain dem.asc -o c.gpkg";
    exurb(here, &line.split(' ').collect::<Vec<_>>()).ends(0);
    let recipe = exurb(here, &["info", "c.gpkg", "--recipe"]).ends(0).out;
    assert!(recipe.contains("[terrain]\nfile = \"dem.asc\""), "{recipe}");
    fs::write(here.join("recipe.toml"), recipe + "\n[[exports]]\nfile = \"again.gpkg\"\n").unwrap();
    exurb(here, &["run", "recipe.toml", "-o", "."]).ends(0);
    let bytes = |name: &str| fs::read(here.join(name)).unwrap();
    assert!(bytes("c.gpkg") == bytes("again.gpkg"));
    // As the target of another city it brings its ground.
    let line = "streets grow -e builtin:helsinki --target c.gpkg --seed 2 -o d.gpkg";
    exurb(here, &line.split(' ').collect::<Vec<_>>()).ends(0);
    exurb(here, &["export", "c.gpkg", "-o", "c.tif"]).ends(0);
    exurb(here, &["export", "d.gpkg", "-o", "d.tif"]).ends(0);
    assert!(bytes("c.tif") == bytes("d.tif"));
}
