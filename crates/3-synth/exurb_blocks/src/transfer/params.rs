/// What a user may turn.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Params {
    /// Distance between kerb and footprints; less where the footprint stands nearer to the kerb in the
    /// example.
    #[schemars(range(min = 0.0, max = 20.0), extend("x-unit" = "m"))]
    pub pavement: f64,
    /// Share by which a footprint's area and sides may change when it is moved off the street or out of
    /// another; what needs more is dropped.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub tolerance: f64,
    /// Like example blocks that are compared in full.
    #[schemars(range(min = 1, max = 1000))]
    pub candidates: u32,
    /// Let blocks match in the mirror.
    pub mirrored: bool,
}

impl Default for Params {
    fn default() -> Self {
        Self {
            pavement: exurb_city::block::PAVEMENT_M,
            tolerance: 0.1,
            candidates: 10,
            mirrored: false,
        }
    }
}

impl exurb_operation::Params for Params {}
