/// What a user may turn.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Params {
    /// How many times as many trees along streets as in the example.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub street_trees: f64,
    /// How many times as many lamps along streets as in the example.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub lamps: f64,
    /// How many times as many trees in parks and woods as in the example.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub park_trees: f64,
    /// Least distance between two trees or lamps.
    #[schemars(range(min = 0.5, max = 50.0), extend("x-unit" = "m"))]
    pub min_distance: f64,
    /// Least distance of a tree or lamp from a building.
    #[schemars(range(min = 0.0, max = 50.0), extend("x-unit" = "m"))]
    pub building_distance: f64,
}

impl Default for Params {
    fn default() -> Self {
        Self {
            street_trees: 1.0,
            lamps: 1.0,
            park_trees: 1.0,
            min_distance: 3.0,
            building_distance: 1.0,
        }
    }
}

impl exurb_operation::Params for Params {}
