/// How layouts are laid out anew.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(default)]
pub struct Settings {
    /// Elements within this distance of a side stand along it (the paper's τ).
    #[schemars(range(min = 1.0, max = 200.0), extend("x-unit" = "m"))]
    pub reach: f64,
    /// Elements are placed in steps of this length.
    #[schemars(range(min = 0.1, max = 10.0), extend("x-unit" = "m"))]
    pub step: f64,
    /// Cost of two empty steps in a row; an element after itself costs 1 less this.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub alpha: f64,
    /// How much longer along its side an element counts in the guidance map than it is.
    #[schemars(range(min = 1.0, max = 4.0))]
    pub map_scale: f64,
    /// Depth of the empty element.
    #[schemars(range(min = 1.0, max = 100.0), extend("x-unit" = "m"))]
    pub empty_depth: f64,
    /// Cost of every further use of an element, as a share of its length.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub repetition: f64,
    /// What standing on ground that the map shows empty costs, as a share of the length there.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub gap_cost: f64,
    /// Cost of a turn against the guidance map in rows inside the block, as a share of the length.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub turn_cost: f64,
    /// Share by which elements of closed rows may be lengthened along their side to keep the row closed.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub stretch: f64,
    /// Share of an element that may be cut off where it meets what stands already.
    #[schemars(range(min = 0.0, max = 0.9))]
    pub cut: f64,
    /// Measure costs in square metres missed, as printed in the paper, instead of metres of length.
    pub printed_cost: bool,
    /// Fit layouts of few large buildings as a whole, stretched a little, instead of element by element.
    pub fit_whole: bool,
    /// Sides whose ends did not move keep their layout.
    pub local: bool,
    /// How far each side of the new outline follows the guidance map, from 0 (keeps its layout) to 1, in
    /// order from its first corner; sides beyond the list follow it in full.
    pub side_weights: Vec<f64>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            reach: 25.0,
            step: 1.0,
            alpha: 0.05,
            map_scale: 1.5,
            empty_depth: 10.0,
            repetition: 0.25,
            gap_cost: 0.5,
            turn_cost: 0.5,
            stretch: 0.15,
            cut: 0.25,
            printed_cost: false,
            fit_whole: true,
            local: false,
            side_weights: Vec::new(),
        }
    }
}

/// What a user may turn.
#[derive(
    Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema,
)]
#[serde(default)]
pub struct Params {
    /// Re-target the layout of the block of this number, from itself; 0 re-targets layouts of like
    /// example blocks into all blocks.
    pub block: u32,
    /// The new kerb line of that block, the polygon of a GeoJSON or GeoPackage file.
    #[schemars(extend("x-value-name" = "NEW.geojson"))]
    pub outline: exurb_operation::PolygonFile,
    /// Write the deformed layout that guides the result as features `guidance`.
    pub guidance: bool,
    /// How layouts are laid out anew.
    #[serde(flatten)]
    pub settings: Settings,
    /// How example blocks are chosen.
    #[serde(flatten)]
    pub choosing: crate::choice::Choosing,
}

impl exurb_operation::Params for Params {
    fn check(&self) -> Result<(), String> {
        if self.block == 0 && !self.outline.is_none() {
            return Err("`outline` is given without `block`; name the block to change".to_owned());
        }
        if self.side_weights_out_of_range() {
            return Err("`side_weights` holds a value outside 0 to 1".to_owned());
        }
        Ok(())
    }
}

impl Params {
    fn side_weights_out_of_range(&self) -> bool {
        self.settings.side_weights.iter().any(|w| !(0.0..=1.0).contains(w))
    }
}
