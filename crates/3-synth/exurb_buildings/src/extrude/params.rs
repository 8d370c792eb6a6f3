/// What a user may turn.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Params {
    /// How many times as high as in the example buildings are.
    #[schemars(range(min = 0.1, max = 10.0))]
    pub height_factor: f64,
    /// Height of a storey where the example tells storeys or height alone.
    #[schemars(range(min = 2.0, max = 10.0), extend("x-unit" = "m"))]
    pub storey_height: f64,
    /// How many of the example's buildings most like it a building draws from: few give a close
    /// likeness, many more variety.
    #[schemars(range(min = 1, max = 1000))]
    pub neighbours: usize,
    /// Share of the spread of heights that a block has in common; negative: as in the example.
    #[schemars(range(min = -1.0, max = 1.0))]
    pub block_share: f64,
    /// Also replace heights, storeys, roofs and uses that are known.
    pub replace: bool,
}

impl Default for Params {
    fn default() -> Self {
        Self {
            height_factor: 1.0,
            storey_height: 3.0,
            neighbours: 24,
            block_share: -1.0,
            replace: false,
        }
    }
}

impl exurb_operation::Params for Params {}
