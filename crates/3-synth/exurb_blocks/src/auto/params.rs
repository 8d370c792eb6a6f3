use crate::choice::Choosing;

/// What a user may turn.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(default)]
pub struct Params {
    /// Outlines that differ by less than this, root mean square, get a layout as it is; others get it
    /// re-targeted.
    #[schemars(range(min = 0.0, max = 100.0), extend("x-unit" = "m"))]
    pub alike: f64,
    /// Blocks less alike than this (0 = the same, 1 = not at all) get parcels with a footprint each.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub most_cost: f64,
    /// So do blocks in which less than this share of the layout finds room.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub least_kept: f64,
    /// How example blocks are chosen.
    #[serde(flatten)]
    pub choosing: Choosing,
}

impl Default for Params {
    fn default() -> Self {
        Self { alike: 1.0, most_cost: 0.4, least_kept: 0.6, choosing: Choosing::default() }
    }
}

impl exurb_operation::Params for Params {}
