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
const TABLE: [Row; 49] = [
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
    ("betweenness_local", "Amounts of through traffic at junctions", "are spread more evenly", "are gathered at fewer of them", "", false),
    ("natural_street_length", "Streets that go on straight through junctions", "are longer", "are shorter", "m", true),
    ("patch_c2st_auc", PATCHES, "are told apart", "are told apart", "", false),
    ("patch_kid", PATCHES, "look different", "look different", "", false),
    ("b_area", "Footprints", "are larger", "are smaller", "m²", true),
    ("b_elongation", "Footprints", "are less elongated", "are more elongated", "", false),
    ("b_rectangularity", "Footprints", "are more like rectangles", "are less like rectangles", "", false),
    ("b_corners", "Footprints", "have more corners", "have fewer corners", "", false),
    ("b_setback", "Buildings", "stand farther from the street", "stand nearer to the street", "m from its middle", false),
    ("b_street_alignment", "Buildings", "are turned more against the street", "are more parallel or square to the street", "°", false),
    ("b_nearest_building", "Buildings", "stand farther apart", "stand closer together", "m", false),
    ("b_height", "Buildings", "are higher", "are lower", "m", false),
    ("blk_coverage_gsi", "Blocks", "are covered more by buildings", "are covered less by buildings", "", false),
    ("blk_buildings_per_ha", "Blocks", "hold more buildings", "hold fewer buildings", "per ha", false),
    ("blk_far_fsi", "Blocks", "hold more floor space", "hold less floor space", "m² per m²", false),
    ("blk_corners_built", "Corners of blocks", "are built on more often", "are built on less often", "", false),
    ("blk_setback_variation", "Fronts along one side of a block", "jump more", "keep more to one line", "m", false),
    ("parcel_area", "Parcels", "are larger", "are smaller", "m²", true),
    ("parcel_frontage", "Parcels", "are wider at the street", "are narrower at the street", "m", false),
    ("parcel_depth_ratio", "Parcels", "are deeper for their width", "are shallower for their width", "", false),
    ("parcel_rectangularity", "Parcels", "are more like rectangles", "are less like rectangles", "", false),
    ("parcel_buildings", "Parcels", "hold more buildings", "hold fewer buildings", "", false),
    ("parcel_front_setback", "Buildings", "stand farther behind the front of their parcel", "stand nearer to the front of their parcel", "m", false),
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
        for measure in crate::STREETS.iter().chain(&crate::measures::BUILT) {
            assert_ne!(words(measure).subject, measure.name);
        }
    }
}
