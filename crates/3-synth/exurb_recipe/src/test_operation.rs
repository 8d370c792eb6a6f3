//! Operations for the tests of this crate: one draws streets, one sets heights.

use exurb_city::{Building, City, Edit, Origin, Provenance, Street, street_graph};
use exurb_geom::{GridPoint, Polygon};
use exurb_operation::{Card, Example, Failure, Operation, Params, Run, Scope, erase};
use rand::RngExt;

use crate::Registry;

/// `streets draw` and `buildings stack`.
pub fn registry() -> Registry {
    Registry::new(vec![erase::<Draw>(), erase::<Stack>()])
}

/// What the test operations take.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Length of the street.
    #[schemars(range(min = 1.0, max = 100.0), extend("x-unit" = "m"))]
    length_m: f64,
    /// How many.
    #[schemars(range(min = 1, max = 9))]
    count: u32,
    /// Places.
    at: Vec<String>,
}

impl Default for Settings {
    fn default() -> Self {
        Self { length_m: 10.0, count: 1, at: Vec::new() }
    }
}

impl Params for Settings {}

struct Draw;

impl Operation for Draw {
    const CARD: Card = Card {
        stage: "streets",
        method: "draw",
        summary: "Draws streets",
        source: "tests",
        needs_example: false,
    };
    type Params = Settings;
    type Learned = ();

    fn learn(_: &[Example], _: &Settings, _: &Run) -> Result<(), Failure> {
        Ok(())
    }

    fn edit(_: &City, _: &Scope, _: &(), params: &Settings, run: &Run) -> Result<Edit, Failure> {
        let mut rng = run.stream(0);
        let lines = (0..params.count).map(|i| {
            let y = f64::from(i) * 20.0 + rng.random::<f64>();
            let line = vec![GridPoint::m(0.0, y), GridPoint::m(params.length_m, y)];
            let provenance = Provenance::of(Origin::Procedural);
            (line, Street { provenance, ..Street::default() })
        });
        Ok(Edit { streets: Some(street_graph::from_lines(lines)), ..Edit::default() })
    }
}

struct Stack;

impl Operation for Stack {
    const CARD: Card = Card {
        stage: "buildings",
        method: "stack",
        summary: "A house for each example",
        source: "tests",
        needs_example: true,
    };
    type Params = Settings;
    type Learned = Vec<std::sync::Arc<str>>;

    fn learn(examples: &[Example], _: &Settings, _: &Run) -> Result<Self::Learned, Failure> {
        Ok(examples.iter().map(|example| example.city.metadata.name.clone()).collect())
    }

    fn edit(
        city: &City,
        _: &Scope,
        names: &Self::Learned,
        _: &Settings,
        run: &Run,
    ) -> Result<Edit, Failure> {
        let mut rng = run.stream(1);
        let mut buildings = city.buildings.to_vec();
        for name in names {
            let east = rng.random_range(1..1000);
            let corner = GridPoint { x: east, y: 9000 };
            let polygon = Polygon::rectangle(GridPoint::m(0.0, 0.0), corner);
            let source = Some(name.clone());
            let provenance = Provenance { origin: Origin::Example, source, part: None };
            buildings.push(Building::new(buildings.len() as u32 + 1, polygon, provenance));
        }
        Ok(Edit { buildings: Some(buildings), ..Edit::default() })
    }
}
