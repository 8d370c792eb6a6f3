use std::sync::Arc;

use exurb_city::City;
use exurb_geom::{Frame, GridPoint, Polygon};
use exurb_operation::{Example, Run};

use super::*;
use crate::test_operation::registry;
use crate::{Made, Size, Within};

fn example(name: &str) -> Example {
    let target = Polygon::rectangle(GridPoint::m(100.0, 0.0), GridPoint::m(300.0, 100.0));
    let mut city = City::empty(Frame::null_island(), target);
    city.metadata.name = name.into();
    city.metadata.attribution = vec![format!("© {name}")];
    Example { city: Arc::new(city), weight: 1.0 }
}

/// Runs a recipe whose examples and city are in memory.
fn make(recipe: &Recipe, city: Option<City>) -> City {
    let examples: Vec<Example> = recipe.examples.iter().map(|s| example(&s.name())).collect();
    let city = city.unwrap_or_else(|| {
        let first = examples.first().map(|e| &*e.city);
        let target = recipe.target.clone().unwrap_or(Target::Size(Size::default()));
        crate::target::begin(&target, first, Path::new(""), &Run::new(1)).unwrap()
    });
    let inputs = Inputs { city, changed: vec![], examples, read_seconds: 0.0 };
    let run = Run::new(recipe.seed);
    let Made { city, .. } = recipe.make(inputs, Path::new(""), &registry(), &run).unwrap();
    city
}

fn draw() -> Recipe {
    let steps = vec![Step::new("streets draw").with("count", 3)];
    Recipe { seed: 5, examples: vec![Source::new("x/a.osm")], steps, ..Recipe::default() }
}

fn stack(examples: &[&str], seed: u64) -> Recipe {
    let examples = examples.iter().map(|file| Source::new(*file)).collect();
    let city = Some(Source::new("c.gpkg"));
    let steps = vec![Step::new("buildings stack")];
    Recipe { seed, city, examples, steps, ..Recipe::default() }
}

/// What tells two cities apart here.
fn content(city: &City) -> (String, Vec<exurb_city::Building>, String) {
    let streets = format!("{:?}", city.streets.edges().map(|(_, e)| e.line()).collect::<Vec<_>>());
    (streets, city.buildings.to_vec(), city.metadata.recipe.clone())
}

#[test]
fn the_recipe_of_several_commands_makes_the_same_city_in_one() {
    for (examples, seed) in [
        (vec!["x/a.osm"], 5),
        (vec!["a.osm"], 6),
        (vec!["a.osm", "b.osm"], 5),
        (vec!["b.osm"], 7),
        (vec![], 5),
    ] {
        let first = make(&draw(), None);
        let second = make(&stack(&examples, seed), Some(first));
        let third = make(&stack(&["y/b.osm"], seed + 1), Some(second));
        let whole = Recipe::parse_with(&third.metadata.recipe, "", &registry()).unwrap();
        assert_eq!(whole.city, None);
        assert_eq!(whole.steps.len(), 3);
        let again = make(&whole, None);
        let names = |city: &City| -> Vec<Option<Arc<str>>> {
            city.buildings.iter().map(|b| b.provenance.source.clone()).collect()
        };
        assert_eq!(names(&again), names(&third), "{}", third.metadata.recipe);
        assert_eq!(content(&again), content(&third), "{}", third.metadata.recipe);
    }
}

#[test]
fn the_same_file_taken_otherwise_is_another_example_of_the_same_name() {
    let mut second = stack(&["a.osm"], 5);
    second.examples[0].part = Some(crate::Half::West);
    second.examples[0].weight = 2.0;
    let city = make(&second, Some(make(&draw(), None)));
    let city = make(&stack(&["a.osm"], 5), Some(city));
    let whole = Recipe::parse_with(&city.metadata.recipe, "", &registry()).unwrap();
    let keys: Vec<String> = whole.examples.iter().map(Source::key).collect();
    assert_eq!(keys, ["a", "a-2"]);
    assert_eq!(whole.steps[1].examples, Some(vec!["a-2".to_owned()]));
    assert_eq!(content(&make(&whole, None)), content(&city));
}

#[test]
fn a_city_without_a_recipe_stays_the_beginning() {
    let import = (*example("import").city).clone();
    let city = make(&stack(&["a.osm"], 1), Some(import));
    let recipe = Recipe::parse_with(&city.metadata.recipe, "", &registry()).unwrap();
    assert_eq!(recipe.city, Some(Source::new("c.gpkg")));
}

#[test]
fn a_city_that_was_cut_stays_the_beginning() {
    let mut recipe = stack(&["a.osm"], 1);
    recipe.city = Some(Source { part: Some(crate::Half::West), ..Source::new("c.gpkg") });
    let city = make(&recipe, Some(make(&draw(), None)));
    let recipe = Recipe::parse_with(&city.metadata.recipe, "", &registry()).unwrap();
    assert_eq!(recipe.steps.len(), 1);
}

#[test]
fn folders_threads_and_exports_leave_no_trace() {
    let mut here = draw();
    here.examples.push(Source::new("builtin:helsinki"));
    here.target = Some(Target::File("somewhere/area.geojson".into()));
    here.steps[0].scope = Within::File("somewhere/scope.geojson".into());
    let mut there = here.clone();
    there.threads = Some(3);
    there.exports = vec![crate::Export { file: "out.png".into(), ..Default::default() }];
    there.examples[0].file = "/elsewhere/a.osm".into();
    there.target = Some(Target::File("area.geojson".into()));
    there.steps[0].scope = Within::File("/elsewhere/scope.geojson".into());
    let (here, there) = (here.portable(&registry()), there.portable(&registry()));
    assert_eq!(here, there);
    assert_eq!(here.examples[1].file, Path::new("builtin:helsinki"));
}

#[test]
fn a_rectangle_lies_around_the_first_examples_centre() {
    let city = make(&draw(), None);
    let expected = Polygon::rectangle(GridPoint::m(-800.0, -950.0), GridPoint::m(1200.0, 1050.0));
    assert_eq!(city.target, expected);
}

#[test]
fn a_cancelled_run_gives_no_city() {
    let run = Run::new(1);
    run.cancel();
    let inputs = Inputs {
        city: (*example("a").city).clone(),
        changed: vec![],
        examples: vec![],
        read_seconds: 0.0,
    };
    let result = draw().make(inputs, Path::new(""), &registry(), &run);
    assert!(result.is_err_and(|e| e.is_cancelled()));
}
