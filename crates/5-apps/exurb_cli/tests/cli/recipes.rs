//! Recipes: every city holds the one that made it, and it makes the same city again.

use std::fs;

use tempfile::tempdir;

use crate::{exurb, listing};

#[test]
fn the_printed_recipe_makes_the_same_file() {
    let folder = tempdir().unwrap();
    let args =
        "streets grow -e builtin:helsinki --size 600x500 --seed 3 --continuation 0.75 -o c.gpkg";
    let args: Vec<&str> = args.split(' ').collect();
    exurb(folder.path(), &args).ends(0);
    let dry: Vec<&str> = args.iter().copied().chain(["--dry-run"]).collect();
    let recipe = exurb(folder.path(), &dry).ends(0).out;
    assert!(recipe.contains("continuation = 0.75"), "{recipe}");
    fs::write(folder.path().join("r.toml"), recipe).unwrap();
    exurb(folder.path(), &["run", "r.toml", "-o", "again"]).ends(0);
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(read("c.gpkg") == read("again/c.gpkg"), "the files differ");
}

#[test]
fn the_recipe_of_several_commands_makes_the_same_city_in_one() {
    let folder = tempdir().unwrap();
    let run = |args: &str| exurb(folder.path(), &args.split(' ').collect::<Vec<_>>()).ends(0);
    run("streets grow -e builtin:helsinki --size 500 -o c.gpkg");
    run("streets furnish c.gpkg -o c.gpkg");
    run("blocks parcels c.gpkg -o c.gpkg");
    run("blocks footprints c.gpkg --seed 2 -o c.gpkg");
    run("buildings extrude c.gpkg -e builtin:helsinki -e builtin:prague -o c.gpkg");
    let recipe = run("info c.gpkg --recipe").out;
    fs::write(folder.path().join("r.toml"), &recipe).unwrap();
    run("run r.toml -o again");
    assert_eq!(run("info again/city.gpkg --recipe").out, recipe);
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(read("c.gpkg") == read("again/city.gpkg"), "the files differ for {recipe}");
}

#[test]
fn mistakes_in_recipes_are_named_with_their_line() {
    let folder = tempdir().unwrap();
    let recipe =
        "exurb = 1\n\n[[examples]]\nfile = \"builtin:grid\"\n\n[[steps]]\nop = \"streets grow\"\n";
    for (text, words) in [
        (
            recipe.replace("exurb = 1", "exurb = 1\nsead = 1"),
            "r.toml, line 2: unknown field `sead`",
        ),
        (
            recipe.replace("grow", "glow"),
            "line 7: there is no operation `streets glow`; there are `streets grow`",
        ),
        (
            format!("{recipe}contination = 0.3\n"),
            "line 8: streets grow: there is no parameter `contination`",
        ),
        ("exurb = 1\n".to_owned(), "nothing to make"),
        (recipe.replace("streets grow", "blocks parcels"), "`blocks parcels` works on a city"),
        (recipe.replace("builtin:grid", "missing.osm"), "missing.osm: there is no such file"),
    ] {
        fs::write(folder.path().join("r.toml"), text).unwrap();
        exurb(folder.path(), &["run", "r.toml", "-o", "out"]).ends(2).says(words);
    }
    exurb(folder.path(), &["run", "none.toml"]).ends(2).says("none.toml");
    assert!(listing(folder.path()).iter().all(|name| name == "r.toml" || name == "out"));
}

#[test]
fn files_of_a_recipe_lie_beside_it() {
    let folder = tempdir().unwrap();
    fs::create_dir(folder.path().join("sub")).unwrap();
    let run = |args: &str| exurb(folder.path(), &args.split(' ').collect::<Vec<_>>()).ends(0);
    run("export builtin:helsinki -o sub/map.osm.pbf");
    let text = "exurb = 1\n[target]\nsize = \"400\"\n[[examples]]\nfile = \"map.osm.pbf\"\n\
                [[steps]]\nop = \"streets grow\"\n[[exports]]\nfile = \"map.svg\"\n";
    fs::write(folder.path().join("sub/r.toml"), text).unwrap();
    run("run sub/r.toml -o out");
    assert_eq!(listing(&folder.path().join("out")), ["map.svg"]);
}
