use proptest::prelude::*;

use super::*;
use crate::test_operation::registry;
use crate::{Export, Half, Size, Source, Target, Within};

const WHOLE: &str = r#"exurb = 1
seed = 7
threads = 2

[target]
size = "800x600.5"

[[examples]]
file = "maps/helsinki.osm.pbf"

[[examples]]
file = "b.gpkg"
id = "o"
name = "other"
weight = 2.5
bbox = [-1.0, 2.0, 3.0, 4.0]
part = "west"
with_service = true

[[steps]]
op = "streets draw"
at = ["1,2"]
length_m = 20.0

[[steps]]
op = "buildings stack"
seed = 9
examples = ["o"]

[steps.scope]
blocks = [1, 4]

[[exports]]
file = "city.gpkg"

[[exports]]
file = "view.png"
view = "3d"
"#;

fn parse(text: &str) -> Result<Recipe, String> {
    Recipe::parse_with(text, "r.toml", &registry()).map_err(|e| e.to_string())
}

#[test]
fn a_printed_recipe_reads_back_as_itself() {
    let recipe = parse(WHOLE).unwrap();
    assert_eq!(recipe.print().unwrap(), WHOLE);
    assert_eq!(recipe.steps[1].scope, Within::Blocks(vec![1, 4]));
    assert_eq!(recipe.examples[1].part, Some(Half::West));
}

#[test]
fn mistakes_are_named_with_their_line() {
    for (from, to, expected) in [
        ("seed = 7", "sead = 7", "r.toml, line 2: unknown field `sead`"),
        ("exurb = 1", "exurb = 2", "r.toml, line 1: `exurb` is 2"),
        (
            "streets draw",
            "streets drow",
            "r.toml, line 21: there is no operation `streets drow`; there are `streets draw`, `buildings stack`",
        ),
        (
            "length_m",
            "lenth_m",
            "r.toml, line 23: streets draw: there is no parameter `lenth_m`; there are ",
        ),
        (
            "length_m = 20.0",
            "length_m = 200",
            "r.toml, line 23: streets draw: `length_m` is 200, expected 1 to 100 m",
        ),
        ("800x600.5", "0x0", "r.toml, line 5: a target of 0 m x 0 m is too small"),
        (
            "[\"o\"]",
            "[\"nobody\"]",
            "r.toml: there is no example named `nobody`; there are: helsinki, o",
        ),
        ("weight = 2.5", "weight = -1", "r.toml: `weight` of other is -1"),
        ("id = \"o\"\n", "id = \"helsinki\"\n", "r.toml: two examples are named `helsinki`"),
        ("view.png", "city.gpkg", "r.toml: city.gpkg is exported twice"),
        ("threads = 2", "threads = 0", "r.toml: `threads` is out of range"),
        ("part = \"west\"", "part = \"top\"", "r.toml, line 17: unknown variant `top`"),
        ("view = ", "wiev = ", "r.toml, line 38: unknown field `wiev`"),
        ("[target]", "[target", "r.toml, line 5: "),
        ("file = \"b.gpkg\"\n", "", "r.toml, line 11: missing field `file`"),
    ] {
        assert!(WHOLE.contains(from));
        let message = parse(&WHOLE.replacen(from, to, 1)).unwrap_err();
        assert!(message.starts_with(expected), "{message}\nexpected {expected}");
    }
}

#[test]
fn recipes_that_do_the_same_print_the_same() {
    let plain = parse("exurb = 1\n[[steps]]\nop = \"streets draw\"\nlength_m = 20.0\n").unwrap();
    let wordy = parse(
        "exurb = 1\nseed = 1\n[[steps]]\nop = \"streets draw\"\nseed = 1\ncount = 1\nat = []\nlength_m = 20\n",
    )
    .unwrap();
    assert_eq!(plain.print().unwrap(), wordy.print().unwrap());
}

proptest! {
    #[test]
    fn every_recipe_survives_printing(
        seed in 0..=i64::MAX as u64,
        step_seed in proptest::option::of(0..1000_u64),
        length_m in 1.0..100.0_f64,
        count in 1..9_u32,
        at in proptest::collection::vec(".*", 0..3),
        weight in 0.001..1e6_f64,
        name in proptest::option::of("\\PC{1,8}"),
        width_m in 10.0..1e4_f64,
    ) {
        let mut recipe = Recipe { seed, ..Recipe::default() };
        recipe.target = Some(Target::Size(Size::new(width_m, 10.0).unwrap()));
        recipe.examples = vec![Source { weight, name, ..Source::new("a b/ü.osm") }];
        let step = Step::new("streets draw");
        let step = step.with("length_m", length_m).with("count", count).with("at", at);
        recipe.steps = vec![Step { seed: step_seed, ..step }];
        recipe.exports = vec![Export { file: "city.gpkg".into(), ..Export::default() }];
        recipe.normalise(&registry());
        let text = recipe.print().unwrap();
        let back = parse(&text).unwrap();
        prop_assert_eq!(&back, &recipe);
        prop_assert_eq!(back.print().unwrap(), text);
    }

    #[test]
    fn no_text_makes_the_reader_panic(text in "(exurb|seed|steps|=|\\[|\\]|\"|\n|1|[a-z. {}])*") {
        let _ = parse(&text);
    }
}
