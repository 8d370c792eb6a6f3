//! The measures in plain words.

use crate::measures::Measure;

/// A measure in plain words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Words {
    /// What is measured; the title of a chart.
    pub title: &'static str,
    /// What the ends of its scale mean, where its unit does not tell.
    pub scale: &'static str,
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

type Text = &'static str;
type Row = (Text, Text, Text, Text, Text, Text, Text, bool);

const STREETS: &str = "Streets between junctions";
const TURNED: &str = "are turned more against each other";
const PARALLEL: &str = "are more parallel or square to each other";
const ROUNDABOUT: &str = "are more roundabout";
const DIRECT: &str = "are more direct";
const DENSER: &str = "stand denser";
const THINNER: &str = "stand less dense";
const STRAIGHT_LINE: &str = "times the straight line";
const PATCHES: &str = "Squares of 512 m of the map";

/// Name, title, scale, subject, more, less, unit, logarithms.
#[rustfmt::skip]
const TABLE: [Row; 49] = [
    ("seg_length", "Length of streets between junctions", "", STREETS, "are longer", "are shorter", "m", true),
    ("seg_sinuosity", "Winding of streets between junctions", "length over straight line, less 1", STREETS, "wind more", "wind less", "", false),
    ("seg_curvature", "Bends of streets between junctions", "", STREETS, "bend more", "bend less", "° per 100 m", false),
    ("node_degree", "Streets that meet at a junction", "", "At junctions and dead ends", "more streets meet", "fewer streets meet", "", false),
    ("junction_angle", "Angles between neighbouring streets", "", "Angles between neighbouring streets", "are wider", "are narrower", "°", false),
    ("tee_angle", "Widest angles of junctions of three streets", "180 of a T, 120 of a Y", "Widest angles of junctions of three streets", "are more like a T", "are more like a Y", "°", false),
    ("deadend_length", "Length of dead ends", "", "Dead ends", "are longer", "are shorter", "m", true),
    ("fourway_share_1km", "Share of junctions where four streets or more meet, within 1 km", "", "Crossings of four streets", "are more frequent", "are rarer", "", false),
    ("block_area", "Area of blocks", "", "Blocks", "are larger", "are smaller", "m²", true),
    ("block_shape_phi", "Roundness of blocks", "1 is a circle", "Blocks", "fill more of the circle around them", "fill less of the circle around them", "", false),
    ("block_compactness", "Compactness of blocks", "1 is a circle, less the longer the outline", "Blocks", "are more compact", "are less compact", "", false),
    ("block_aspect", "Shorter by longer side of blocks", "1 is a square", "Blocks", "are less elongated", "are more elongated", "", false),
    ("block_rectangularity", "Share of its rectangle that a block fills", "1 is a rectangle", "Blocks", "are more like rectangles", "are less like rectangles", "", false),
    ("block_fingerprint", "Area of blocks across (m², logarithmic), their roundness upwards", "", "Sizes and shapes of blocks", "go together differently", "go together differently", "", false),
    ("bearing_hist", "Length of streets by direction", "", "Street directions", "are spread differently over the compass", "are spread differently over the compass", "", false),
    ("order_phi_1km", "Order of directions within 1 km", "1 is a grid, 0 every direction alike", "Street directions within a kilometre", "are more orderly", "are less orderly", "", false),
    ("align_20_150m", "Turn between streets 20 to 150 m apart", "0 is parallel or square", "Streets 20 to 150 m apart", TURNED, PARALLEL, "°", false),
    ("align_150_400m", "Turn between streets 150 to 400 m apart", "0 is parallel or square", "Streets 150 to 400 m apart", TURNED, PARALLEL, "°", false),
    ("align_400_900m", "Turn between streets 400 to 900 m apart", "0 is parallel or square", "Streets 400 to 900 m apart", TURNED, PARALLEL, "°", false),
    ("density_junction", "Junctions by area", "", "Junctions", DENSER, THINNER, "per km²", false),
    ("density_deadend", "Dead ends by area", "", "Dead ends", DENSER, THINNER, "per km²", false),
    ("density_length", "Length of streets by area", "", "Streets", "lie denser", "lie less dense", "km per km²", false),
    ("reach_500m", "Length of streets within a walk of 500 m", "", "Walks of 500 m", "reach more street", "reach less street", "km", false),
    ("detour_150_500m", "Way to places 150 to 500 m away", "", "Ways to places 150 to 500 m away", ROUNDABOUT, DIRECT, STRAIGHT_LINE, false),
    ("detour_500_1200m", "Way to places 500 to 1200 m away", "", "Ways to places 500 to 1200 m away", ROUNDABOUT, DIRECT, STRAIGHT_LINE, false),
    ("meshedness_1km", "Loops in the network within 1 km", "0 is a tree", "The networks of neighbourhoods", "have more loops", "have fewer loops", "", false),
    ("betweenness_local", "Through traffic at junctions", "0.69 is the mean, in logarithms", "Amounts of through traffic at junctions", "are spread more evenly", "are gathered at fewer of them", "", false),
    ("natural_street_length", "Length of streets that go on straight", "", "Streets that go on straight through junctions", "are longer", "are shorter", "m", true),
    ("patch_c2st_auc", "Squares of 512 m told apart", "", PATCHES, "are told apart", "are told apart", "", false),
    ("patch_kid", "Difference of squares of 512 m", "", PATCHES, "look different", "look different", "", false),
    ("b_area", "Area of footprints", "", "Footprints", "are larger", "are smaller", "m²", true),
    ("b_elongation", "Shorter by longer side of footprints", "1 is a square", "Footprints", "are less elongated", "are more elongated", "", false),
    ("b_rectangularity", "Share of its rectangle that a footprint fills", "1 is a rectangle", "Footprints", "are more like rectangles", "are less like rectangles", "", false),
    ("b_corners", "Corners of footprints", "", "Footprints", "have more corners", "have fewer corners", "", false),
    ("b_setback", "Distance of buildings from the street", "", "Buildings", "stand farther from the street", "stand nearer to the street", "m from its middle", false),
    ("b_street_alignment", "Turn of buildings against the street", "0 is parallel or square", "Buildings", "are turned more against the street", "are more parallel or square to the street", "°", false),
    ("b_nearest_building", "Gap to the nearest building", "0 is a shared wall", "Buildings", "stand farther apart", "stand closer together", "m", false),
    ("b_height", "Height of buildings", "", "Buildings", "are higher", "are lower", "m", false),
    ("blk_coverage_gsi", "Share of blocks covered by buildings", "", "Blocks", "are covered more by buildings", "are covered less by buildings", "", false),
    ("blk_buildings_per_ha", "Buildings by area of block", "", "Blocks", "hold more buildings", "hold fewer buildings", "per ha", false),
    ("blk_far_fsi", "Floor space by area of block", "", "Blocks", "hold more floor space", "hold less floor space", "m² per m²", false),
    ("blk_corners_built", "Share of a block's corners with a building", "", "Corners of blocks", "are built on more often", "are built on less often", "", false),
    ("blk_setback_variation", "Spread of fronts along one side of a block", "", "Fronts along one side of a block", "jump more", "keep more to one line", "m", false),
    ("parcel_area", "Area of parcels", "", "Parcels", "are larger", "are smaller", "m²", true),
    ("parcel_frontage", "Width of parcels at the street", "", "Parcels", "are wider at the street", "are narrower at the street", "m", false),
    ("parcel_depth_ratio", "Depth of parcels by their width", "", "Parcels", "are deeper for their width", "are shallower for their width", "", false),
    ("parcel_rectangularity", "Share of its rectangle that a parcel fills", "1 is a rectangle", "Parcels", "are more like rectangles", "are less like rectangles", "", false),
    ("parcel_buildings", "Buildings on a parcel", "", "Parcels", "hold more buildings", "hold fewer buildings", "", false),
    ("parcel_front_setback", "Distance of buildings from the front of their parcel", "", "Buildings", "stand farther behind the front of their parcel", "stand nearer to the front of their parcel", "m", false),
];

/// The words of a measure; its name where there are none.
pub fn words(measure: &Measure) -> Words {
    match TABLE.iter().find(|row| row.0 == measure.name) {
        Some((_, title, scale, subject, more, less, unit, is_log)) => {
            Words { title, scale, subject, more, less, unit, is_log: *is_log }
        }
        None => {
            let (name, more, less) = (measure.name, "is more", "is less");
            Words { title: name, scale: "", subject: name, more, less, unit: "", is_log: false }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_measure_has_words() {
        for measure in crate::STREETS.iter().chain(&crate::measures::BUILT) {
            let Words { title, subject, .. } = words(measure);
            assert!(title != measure.name && subject != measure.name);
        }
    }
}
