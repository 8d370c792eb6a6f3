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
}

impl Family {
    /// All families, in the order of the table.
    pub const ALL: [Self; 7] = [
        Self::Segments,
        Self::Junctions,
        Self::Blocks,
        Self::Orientation,
        Self::Density,
        Self::Network,
        Self::Patches,
    ];

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fourteen_measures_are_core_and_names_differ() {
        assert_eq!(STREETS.iter().filter(|m| m.core).count(), 14);
        let mut names: Vec<&str> = STREETS.iter().map(|m| m.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), STREETS.len());
    }
}
