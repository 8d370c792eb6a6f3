/// What a user may turn.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Params {
    /// No building is smaller than this; where only a smaller one fits, the parcel stays empty.
    #[schemars(range(min = 1.0, max = 10000.0), extend("x-unit" = "m²"))]
    pub min_area: f64,
    /// How many times as far from the kerb as in the example buildings stand.
    #[schemars(range(min = 0.0, max = 5.0))]
    pub setback_factor: f64,
    /// How many times as deep as in the example buildings are, as far as their parcel lets them.
    #[schemars(range(min = 0.2, max = 5.0))]
    pub depth_factor: f64,
    /// Share of parcels without a building; negative: as in the example.
    #[schemars(range(min = -1.0, max = 1.0))]
    pub empty_share: f64,
    /// Least distance of a detached building from its parcel's borders.
    #[schemars(range(min = 0.0, max = 20.0), extend("x-unit" = "m"))]
    pub min_gap: f64,
}

impl Default for Params {
    fn default() -> Self {
        Self {
            min_area: 20.0,
            setback_factor: 1.0,
            depth_factor: 1.0,
            empty_share: -1.0,
            min_gap: 0.5,
        }
    }
}

impl exurb_operation::Params for Params {}
