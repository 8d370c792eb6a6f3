/// How example blocks are chosen.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(default)]
pub struct Choosing {
    /// Like example blocks that are compared in full, for each block.
    #[schemars(range(min = 1, max = 1000))]
    pub candidates: u32,
    /// Of these, so many are laid out before one is chosen.
    #[schemars(range(min = 1, max = 100))]
    pub tries: u32,
    /// Draw among this many of the best against repetition; 1 always takes the best.
    #[schemars(range(min = 1, max = 100))]
    pub pick: u32,
    /// Take the filling that comes out so many places down, 1 being the chosen one.
    #[schemars(range(min = 1, max = 100))]
    pub alternative: u32,
    /// Write so many fillings of each block: the chosen one, and others as features `alternative_2` and
    /// on.
    #[schemars(range(min = 1, max = 100))]
    pub alternatives: u32,
    /// How much neighbouring blocks are made to look alike: 1 as in the example, 0 not at all.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub coherence: f64,
    /// How far the coverage of all filled blocks together is brought to the example's, where the blocks
    /// are of other sizes and shapes: 1 = to it, 0 = each block is built on as the example's like blocks
    /// are, whatever that adds up to.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub coverage: f64,
    /// Draw parks, schools and shops as often and as far apart as in the example.
    pub kinds: bool,
    /// Which example serves where: polygons with the property `example`, or a PNG image over the
    /// target's box (see `style_legend`). Elsewhere all examples serve.
    #[schemars(extend("x-value-name" = "MAP.geojson|.png"))]
    pub style_map: exurb_operation::StyleMap,
    /// What the colours of an image mean, as in `ff0000=munich,00ff00=helsinki`; a pixel counts as the
    /// nearest of these colours.
    pub style_legend: String,
    /// Let example blocks be mirrored.
    pub mirrored: bool,
    /// Weight of the outline's shape when blocks are compared; all weights are brought to a sum of 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub shape_weight: f64,
    /// Weight of the ground's slopes, where both sides know them.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub relief_weight: f64,
    /// Weight of the land use.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub land_use_weight: f64,
    /// Weight of how densely blocks are built.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub density_weight: f64,
    /// Weight of how high blocks are built.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub height_weight: f64,
    /// Cut the ground into parcels around the buildings.
    pub parcels: bool,
    /// Distance between kerb and footprints; less where the footprint stands nearer to the kerb in the
    /// example.
    #[schemars(range(min = 0.0, max = 20.0), extend("x-unit" = "m"))]
    pub pavement: f64,
    /// Share by which a footprint's area and sides may change when it is moved off the street or out of
    /// another; what needs more is dropped.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub tolerance: f64,
}

impl Default for Choosing {
    fn default() -> Self {
        Self {
            candidates: 10,
            tries: 4,
            pick: 1,
            alternative: 1,
            alternatives: 1,
            coherence: 1.0,
            coverage: 1.0,
            kinds: true,
            style_map: exurb_operation::StyleMap::default(),
            style_legend: String::new(),
            mirrored: false,
            shape_weight: 0.7,
            relief_weight: 0.1,
            land_use_weight: 0.1,
            density_weight: 0.2,
            height_weight: 0.1,
            parcels: true,
            pavement: exurb_city::block::PAVEMENT_M,
            tolerance: 0.1,
        }
    }
}

impl Choosing {
    /// How close things may come.
    pub(crate) fn spacing(&self) -> crate::lay::Spacing {
        crate::lay::Spacing { pavement_m: self.pavement, tolerance: self.tolerance, cut: 0.0 }
    }

    /// The weights for a query.
    pub fn weights(&self) -> exurb_match::Weights {
        exurb_match::Weights {
            shape: self.shape_weight.max(1e-6),
            relief: self.relief_weight,
            land_use: self.land_use_weight,
            density: self.density_weight,
            height: self.height_weight,
        }
    }
}
