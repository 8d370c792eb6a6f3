use exurb_operation::Params as _;

/// How blocks are cut.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    serde::Serialize,
    serde::Deserialize,
    schemars::JsonSchema,
)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Voronoi cells of points along the main axis, or along the kerb where there is none.
    #[default]
    Voronoi,
    /// Split along oriented boxes again and again.
    Box,
    /// Strips along the streets by the straight skeleton, cut square to them.
    Skeleton,
    /// Around the buildings that stand there: the Voronoi diagram of their footprints.
    Footprints,
}

/// What a user may turn.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Params {
    /// How blocks are cut.
    pub method: Method,
    /// How far the cuts of `box` lie beside the middle, as a share of the side cut.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub irregularity: f64,
    /// How often `box` turns a cut that takes street access away from a piece.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub access: f64,
    /// How many times as deep as in the example parcels are; wide ones give fewer, deeper rows.
    #[schemars(range(min = 0.2, max = 5.0))]
    pub depth_factor: f64,
    /// How many times as wide along the street as in the example parcels are.
    #[schemars(range(min = 0.2, max = 5.0))]
    pub frontage_factor: f64,
    /// Parcels with less street frontage than this are joined to a neighbour.
    #[schemars(range(min = 3.0, max = 50.0), extend("x-unit" = "m"))]
    pub min_frontage: f64,
    /// Parcels smaller than this are joined to a neighbour.
    #[schemars(range(min = 1.0, max = 10000.0), extend("x-unit" = "m²"))]
    pub min_area: f64,
    /// Let blocks become parks, fields and the like as often as in the example.
    pub open_land: bool,
    /// Width of the pavement between kerb and parcels; narrower where the example's buildings stand
    /// nearer to the kerb.
    #[schemars(range(min = 0.0, max = 20.0), extend("x-unit" = "m"))]
    pub pavement: f64,
}

impl Default for Params {
    fn default() -> Self {
        Self {
            method: Method::Voronoi,
            irregularity: 0.2,
            access: 1.0,
            depth_factor: 1.0,
            frontage_factor: 1.0,
            min_frontage: 4.0,
            min_area: 50.0,
            open_land: true,
            pavement: exurb_city::block::PAVEMENT_M,
        }
    }
}

impl exurb_operation::Params for Params {}

impl Params {
    /// The same parameters, or which one is out of range.
    pub fn validate(&self) -> Result<&Self, super::Error> {
        self.check().map_err(super::Error::Params)?;
        Ok(self)
    }
}
