//! One or two rows of parcels along the main axis of a block.
//!
//! Source: Aliaga, Vanegas, Beneš 2008, section 3.1.2: sites on the longer axis of the smallest
//! enclosing rectangle, or two copies of them ±δ beside it; their Voronoi cells are the parcels.
//! Departures: each row is cut by frontages of its own, where the paper mirrors one set of sites (the
//! sites are doubled beside every cut, so that backs still meet on the axis); frontages are drawn
//! from the example instead of from a normal distribution around its mean.

use exurb_geom::{OrientedBox, Polygon, voronoi::Site};

/// Two rows when the short side is at least this many lot depths (the paper gives no rule).
const TWO_ROWS_DEPTHS: f64 = 1.5;
/// Blocks with a short side over this many lot depths have land behind two rows.
const MOST_DEPTHS: f64 = 2.7;
/// Blocks that fill less of their rectangle have no one axis.
const LEAST_FILL: f64 = 0.84;
/// Sites stand this far beside a cut and beside the axis, in metres.
const BESIDE_M: f64 = 0.5;

/// The rectangle of a block that rows along its axis suit.
pub fn suits(ground: &Polygon, depth_m: f64) -> Option<OrientedBox> {
    let frame = OrientedBox::of(ground.exterior())?;
    let fill = ground.area_m2() / frame.area_m2();
    (ground.interiors().is_empty()
        && fill >= LEAST_FILL
        && frame.short_m() <= MOST_DEPTHS * depth_m
        && frame.long_m() > 1.05 * frame.short_m())
    .then_some(frame)
}

/// One row or two.
pub fn rows(frame: &OrientedBox, depth_m: f64) -> usize {
    if frame.short_m() >= TWO_ROWS_DEPTHS * depth_m { 2 } else { 1 }
}

/// Sites of one or two rows in `frame`, labelled by parcel. `count` parcels are made; `next_m` gives
/// wanted frontages, which are stretched to the axis.
pub fn sites(
    frame: &OrientedBox,
    rows: usize,
    count: usize,
    mut next_m: impl FnMut() -> f64,
) -> Vec<Site> {
    let (rows, count) = (rows.max(1), count.max(1));
    let length = frame.long_m();
    let cuts: Vec<Vec<f64>> = (0..rows)
        .map(|row| {
            let in_row = (count + rows - 1 - row) / rows;
            cuts(length, in_row.max(1), &mut next_m)
        })
        .collect();
    let mut stations: Vec<f64> = cuts
        .iter()
        .flatten()
        .flat_map(|cut| [cut - BESIDE_M, cut + BESIDE_M])
        .chain([BESIDE_M, length - BESIDE_M])
        .collect();
    stations.sort_by(f64::total_cmp);
    let start = frame.center - frame.axis * (length / 2.0);
    let mut out = Vec::new();
    let mut first_label = 0;
    for (row, cuts) in cuts.iter().enumerate() {
        let beside = match (rows, row) {
            (1, _) => 0.0,
            (_, 0) => -BESIDE_M,
            _ => BESIDE_M,
        };
        for at in &stations {
            let label = first_label + cuts.partition_point(|cut| cut < at) as u32;
            let at = start + frame.axis * *at + frame.axis.perp() * beside;
            out.push(Site { at, label });
        }
        first_label += cuts.len() as u32 + 1;
    }
    out
}

/// Cuts of a row into `count` parcels.
fn cuts(length_m: f64, count: usize, next_m: &mut impl FnMut() -> f64) -> Vec<f64> {
    let widths: Vec<f64> = (0..count).map(|_| next_m()).collect();
    let sum: f64 = widths.iter().sum();
    let mut at = 0.0;
    widths[..count - 1]
        .iter()
        .map(|width| {
            at += width * length_m / sum;
            at
        })
        .collect()
}

/// How many parcels of `area_m2` a ground of `ground_m2` holds, at least one.
pub fn count(ground_m2: f64, area_m2: f64) -> usize {
    (ground_m2 / area_m2.max(1.0)).round().clamp(1.0, 10_000.0) as usize
}
