//! What the blocks of the examples teach, in figures.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::{BuildingSample, ExampleBlock, Library, median};

impl Library {
    /// The blocks: how many, their lots, their open land. Medians in metres.
    pub fn describe_blocks(&self) -> Value {
        let with_lots = || self.blocks.iter().filter(|b| !b.frontages_m.is_empty());
        let mut open: BTreeMap<&str, usize> = BTreeMap::new();
        for class in self.blocks.iter().filter_map(|b| b.open.as_deref()) {
            *open.entry(class).or_default() += 1;
        }
        json!({
            "blocks": self.blocks.len(),
            "blocks_with_lots": with_lots().count(),
            "frontage_m": known(with_lots().flat_map(|b| b.frontages_m.iter().copied())),
            "depth_m": known(with_lots().map(|b| b.depth_m).filter(|depth| *depth > 0.0)),
            "fronted_share": known(with_lots().map(|b| b.fronted_share)),
            "open_blocks": open,
            "has_parcels": self.has_parcels,
            "has_land_use": self.has_land_use,
        })
    }

    /// The buildings along the streets: how many, their sizes and places. Medians in metres.
    pub fn describe_buildings(&self) -> Value {
        let of = |value: fn(&BuildingSample) -> f64| known(self.buildings().map(value));
        let shared = self.buildings().filter(|b| b.gap_after_m <= 0.0).count();
        let built = |b: &&ExampleBlock| !b.buildings.is_empty();
        json!({
            "buildings": self.buildings().count(),
            "area_m2": of(|b| b.area_m2),
            "width_m": of(|b| b.size_m.x),
            "depth_m": of(|b| b.size_m.y),
            "setback_m": of(|b| b.setback_m),
            "with_shared_wall": shared,
            "coverage": known(self.blocks.iter().filter(built).map(|b| b.coverage)),
            "empty_share": known(self.blocks.iter().filter_map(|b| b.empty_share)),
        })
    }
}

/// The median, if there are values.
fn known(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values = values.peekable();
    values.peek().is_some().then(|| median(values))
}
