//! The measures of the scorecard: name, family, distance, constants.

/// What a measure tells about; scores are averaged within families first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Family {
    Segments,
    Junctions,
    Blocks,
    Orientation,
    Density,
    Network,
    Patches,
    Buildings,
    BuiltBlocks,
    Parcels,
}

impl Family {
    /// Families of streets and blocks, in the order of the table: TOTAL is their mean.
    pub const STREETS: [Self; 7] = [
        Self::Segments,
        Self::Junctions,
        Self::Blocks,
        Self::Orientation,
        Self::Density,
        Self::Network,
        Self::Patches,
    ];
    /// Families of what stands in the blocks: BUILT is their mean.
    pub const BUILT: [Self; 3] = [Self::Buildings, Self::BuiltBlocks, Self::Parcels];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Segments => "segments",
            Self::Junctions => "junctions",
            Self::Blocks => "blocks",
            Self::Orientation => "orientation",
            Self::Density => "density",
            Self::Network => "network",
            Self::Patches => "patches",
            Self::Buildings => "buildings",
            Self::BuiltBlocks => "built_blocks",
            Self::Parcels => "parcels",
        }
    }
}

/// How far apart two cities are in one measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Distance {
    /// 1-Wasserstein distance over the robust standard deviation (p90 - p10) / 2.56 of the held-out
    /// part, which counts as at least this.
    Wasserstein(f64),
    /// Total variation of shares.
    Variation,
    /// Total variation of histograms on a circle, in the best rotation.
    Rotation,
    /// Root of the unbiased squared maximum mean discrepancy of log area and Φ.
    Discrepancy,
    /// How well a classifier tells patches apart: area under the curve, 0.5 to 1.
    Classifier,
    /// Unbiased squared maximum mean discrepancy of patch features under a cubic kernel.
    Kernel,
}

/// One measure of the scorecard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measure {
    /// Its name, a key of reports.
    pub name: &'static str,
    /// Its family.
    pub family: Family,
    /// Is it one of the 14 that separate cities best?
    pub core: bool,
    /// How two cities are compared.
    pub distance: Distance,
}

const fn plain(name: &'static str, family: Family, least_sigma: f64) -> Measure {
    Measure { name, family, core: false, distance: Distance::Wasserstein(least_sigma) }
}

const fn core(name: &'static str, family: Family, least_sigma: f64) -> Measure {
    Measure { name, family, core: true, distance: Distance::Wasserstein(least_sigma) }
}

const fn by(name: &'static str, family: Family, core: bool, distance: Distance) -> Measure {
    Measure { name, family, core, distance }
}

/// The thirty measures of streets and blocks, in the order of the table.
pub const STREETS: [Measure; 30] = [
    core("seg_length", Family::Segments, 0.1),
    plain("seg_sinuosity", Family::Segments, 0.05),
    core("seg_curvature", Family::Segments, 30.0),
    by("node_degree", Family::Junctions, false, Distance::Variation),
    core("junction_angle", Family::Junctions, 10.0),
    core("tee_angle", Family::Junctions, 10.0),
    plain("deadend_length", Family::Junctions, 0.1),
    plain("fourway_share_1km", Family::Junctions, 0.1),
    core("block_area", Family::Blocks, 0.15),
    plain("block_shape_phi", Family::Blocks, 0.05),
    plain("block_compactness", Family::Blocks, 0.05),
    plain("block_aspect", Family::Blocks, 0.1),
    plain("block_rectangularity", Family::Blocks, 0.05),
    by("block_fingerprint", Family::Blocks, true, Distance::Discrepancy),
    by("bearing_hist", Family::Orientation, false, Distance::Rotation),
    core("order_phi_1km", Family::Orientation, 0.1),
    core("align_20_150m", Family::Orientation, 4.0),
    core("align_150_400m", Family::Orientation, 4.0),
    plain("align_400_900m", Family::Orientation, 4.0),
    core("density_junction", Family::Density, 15.0),
    core("density_deadend", Family::Density, 5.0),
    plain("density_length", Family::Density, 2.0),
    plain("reach_500m", Family::Network, 1.0),
    plain("detour_150_500m", Family::Network, 0.1),
    plain("detour_500_1200m", Family::Network, 0.05),
    plain("meshedness_1km", Family::Network, 0.03),
    plain("betweenness_local", Family::Network, 0.2),
    core("natural_street_length", Family::Network, 0.1),
    by("patch_c2st_auc", Family::Patches, true, Distance::Classifier),
    by("patch_kid", Family::Patches, true, Distance::Kernel),
];

/// Measures of buildings, blocks as they are built up, and parcels, where a city has them.
pub const BUILT: [Measure; 19] = [
    plain("b_area", Family::Buildings, 0.1),
    plain("b_elongation", Family::Buildings, 0.1),
    plain("b_rectangularity", Family::Buildings, 0.05),
    plain("b_corners", Family::Buildings, 1.0),
    plain("b_setback", Family::Buildings, 2.0),
    plain("b_street_alignment", Family::Buildings, 4.0),
    plain("b_nearest_building", Family::Buildings, 2.0),
    plain("b_height", Family::Buildings, 2.0),
    plain("blk_coverage_gsi", Family::BuiltBlocks, 0.05),
    plain("blk_buildings_per_ha", Family::BuiltBlocks, 3.0),
    plain("blk_far_fsi", Family::BuiltBlocks, 0.1),
    plain("blk_corners_built", Family::BuiltBlocks, 0.1),
    plain("blk_setback_variation", Family::BuiltBlocks, 0.5),
    plain("parcel_area", Family::Parcels, 0.1),
    plain("parcel_frontage", Family::Parcels, 2.0),
    plain("parcel_depth_ratio", Family::Parcels, 0.1),
    plain("parcel_rectangularity", Family::Parcels, 0.05),
    plain("parcel_buildings", Family::Parcels, 0.2),
    plain("parcel_front_setback", Family::Parcels, 1.0),
];

/// The measure of that name.
pub fn find(name: &str) -> Option<&'static Measure> {
    STREETS.iter().chain(&BUILT).find(|m| m.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fourteen_measures_are_core_and_names_differ() {
        assert_eq!(STREETS.iter().filter(|m| m.core).count(), 14);
        let mut names: Vec<&str> = STREETS.iter().chain(&BUILT).map(|m| m.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), STREETS.len() + BUILT.len());
    }
}
