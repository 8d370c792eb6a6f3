use crate::choice::Choosing;

/// What a user may turn.
#[derive(
    Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema,
)]
#[serde(default)]
pub struct Params {
    /// How example blocks are chosen.
    #[serde(flatten)]
    pub choosing: Choosing,
}

impl exurb_operation::Params for Params {}
