//! The measures in plain words.

use crate::measures::Measure;

/// A measure in plain words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Words {
    /// What is looked at; the subject of a sentence.
    pub subject: &'static str,
    /// What it does where values are larger than in the example.
    pub more: &'static str,
    /// What it does where they are smaller.
    pub less: &'static str,
    /// Unit of typical values; empty for shares and ratios.
    pub unit: &'static str,
    /// Are the values logarithms to base 10?
    pub is_log: bool,
}

type Row = (&'static str, &'static str, &'static str, &'static str, &'static str, bool);

const STREETS: &str = "Streets between junctions";
const TURNED: &str = "are turned more against each other";
const PARALLEL: &str = "are more parallel or square to each other";
const ROUNDABOUT: &str = "are more roundabout";
const DIRECT: &str = "are more direct";
const DENSER: &str = "stand denser";
const THINNER: &str = "stand less dense";
const STRAIGHT_LINE: &str = "times the straight line";
const PATCHES: &str = "Pieces of the map of 512 m";

/// Name, subject, more, less, unit, logarithms.
#[rustfmt::skip]
const TABLE: [Row; 30] = [
    ("seg_length", STREETS, "are longer", "are shorter", "m", true),
    ("seg_sinuosity", STREETS, "wind more", "wind less", "", false),
    ("seg_curvature", STREETS, "bend more", "bend less", "° per 100 m", false),
    ("node_degree", "At junctions and dead ends", "more streets meet", "fewer streets meet", "", false),
    ("junction_angle", "Angles between neighbouring streets", "are wider", "are narrower", "°", false),
    ("tee_angle", "Widest angles of junctions of three streets", "are more like a T", "are more like a Y", "°", false),
    ("deadend_length", "Dead ends", "are longer", "are shorter", "m", true),
    ("fourway_share_1km", "Crossings of four streets", "are more frequent", "are rarer", "of junctions", false),
    ("block_area", "Blocks", "are larger", "are smaller", "m²", true),
    ("block_shape_phi", "Blocks", "fill more of the circle around them", "fill less of the circle around them", "", false),
    ("block_compactness", "Blocks", "are more compact", "are less compact", "", false),
    ("block_aspect", "Blocks", "are less elongated", "are more elongated", "", false),
    ("block_rectangularity", "Blocks", "are more like rectangles", "are less like rectangles", "", false),
    ("block_fingerprint", "Sizes and shapes of blocks", "go together differently", "go together differently", "", false),
    ("bearing_hist", "Street directions", "are spread differently over the compass", "are spread differently over the compass", "", false),
    ("order_phi_1km", "Street directions within a kilometre", "are more orderly", "are less orderly", "", false),
    ("align_20_150m", "Streets 20 to 150 m apart", TURNED, PARALLEL, "°", false),
    ("align_150_400m", "Streets 150 to 400 m apart", TURNED, PARALLEL, "°", false),
    ("align_400_900m", "Streets 400 to 900 m apart", TURNED, PARALLEL, "°", false),
    ("density_junction", "Junctions", DENSER, THINNER, "per km²", false),
    ("density_deadend", "Dead ends", DENSER, THINNER, "per km²", false),
    ("density_length", "Streets", "lie denser", "lie less dense", "km per km²", false),
    ("reach_500m", "Walks of 500 m", "reach more street", "reach less street", "km", false),
    ("detour_150_500m", "Ways to places 150 to 500 m away", ROUNDABOUT, DIRECT, STRAIGHT_LINE, false),
    ("detour_500_1200m", "Ways to places 500 to 1200 m away", ROUNDABOUT, DIRECT, STRAIGHT_LINE, false),
    ("meshedness_1km", "The networks of neighbourhoods", "have more loops", "have fewer loops, more like a tree", "", false),
    ("betweenness_local", "Through traffic of junctions", "is spread more evenly", "gathers at fewer of them", "", false),
    ("natural_street_length", "Streets that go on straight through junctions", "are longer", "are shorter", "m", true),
    ("patch_c2st_auc", PATCHES, "are told apart", "are told apart", "", false),
    ("patch_kid", PATCHES, "look different", "look different", "", false),
];

/// The words of a measure; its name where there are none.
pub fn words(measure: &Measure) -> Words {
    match TABLE.iter().find(|row| row.0 == measure.name) {
        Some((_, subject, more, less, unit, is_log)) => {
            Words { subject, more, less, unit, is_log: *is_log }
        }
        None => {
            let (more, less) = ("is more", "is less");
            Words { subject: measure.name, more, less, unit: "", is_log: false }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_measure_has_words() {
        for measure in crate::STREETS {
            assert_ne!(words(&measure).subject, measure.name);
        }
    }
}
