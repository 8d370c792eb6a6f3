//! Directions of streets: the rose of bearings, its order, and how alike directions are at a distance.

use exurb_geom::{Vec2, polyline, trig};
use exurb_operation::Rng;
use rand::RngExt;
use rand::seq::index;

use crate::{Network, Sample};

/// Streets are looked at in pieces of this length, in metres.
pub const PIECE_M: f64 = 25.0;
/// Bins of the rose over the full circle, 10° each, the first one around east.
pub const ROSE_BINS: usize = 36;
/// Bins of the histogram of bearings over half a circle, 5° each.
pub const HALF_BINS: usize = 36;
/// Points that are compared, and pairs of them in one band of distances.
const POINTS: usize = 2500;
const PAIRS: usize = 8000;

/// Street length by bearing over half a circle, in 36 bins of 5° that add up to 1, each smoothed
/// with its neighbours as 1/4, 1/2, 1/4. `None` without streets.
pub fn histogram(network: &Network) -> Option<[f64; HALF_BINS]> {
    let mut bins = [0.0; HALF_BINS];
    for (_, edge) in network.graph.edges() {
        for w in edge.line_m().windows(2) {
            let turned = trig::angle(w[1] - w[0]).to_degrees().rem_euclid(180.0);
            bins[((turned / 5.0) as usize).min(HALF_BINS - 1)] += w[0].distance(w[1]);
        }
    }
    let total: f64 = bins.iter().sum();
    let bin = |i: usize| bins[i % HALF_BINS] / total;
    let smooth = |i| bin(i + HALF_BINS - 1) / 4.0 + bin(i) / 2.0 + bin(i + 1) / 4.0;
    (total > 0.0).then(|| std::array::from_fn(smooth))
}

/// The bins of a bearing and of its opposite, in a rose of 36.
pub fn rose_bins(angle_rad: f64) -> [usize; 2] {
    let tenths = angle_rad.to_degrees() / 10.0 + 0.5;
    let bin = |turns: f64| (turns.rem_euclid(ROSE_BINS as f64) as usize).min(ROSE_BINS - 1);
    [bin(tenths), bin(tenths + 18.0)]
}

/// Order φ of a rose of bearings: 1 - ((H - ln 4) / (ln 36 - ln 4))², 1 for a perfect grid, 0 for all
/// directions alike.
///
/// Source: Boeing 2019, *Urban spatial order: street network orientation, configuration, and
/// entropy*, eq. (2).
pub fn order(rose: &[f64; ROSE_BINS]) -> f64 {
    let total: f64 = rose.iter().sum();
    let term = |length: &f64| match length / total {
        p if p > 0.0 => -p * trig::ln(p),
        _ => 0.0,
    };
    let entropy: f64 = rose.iter().map(term).sum();
    let (grid, most) = (trig::ln(4.0), trig::ln(ROSE_BINS as f64));
    let relative = (entropy - grid) / (most - grid);
    1.0 - relative * relative
}

/// A piece of street: its middle, and its direction from east in degrees.
#[derive(Clone, Copy, Debug)]
struct Piece {
    at: Vec2,
    degrees: f64,
}

/// Difference in bearing, folded to 0..45 degrees, of street pieces that lie `bands` metres apart:
/// 2,500 pieces of 25 m drawn at random, up to 8,000 random pairs a band. O(pieces²).
pub fn alignment(network: &Network, bands_m: &[(f64, f64)], rng: &mut Rng) -> Vec<Sample> {
    let pieces = drawn_pieces(network, rng);
    pairs(&pieces, bands_m).iter().map(|pairs| aligned(&pieces, pairs, rng)).collect()
}

fn drawn_pieces(network: &Network, rng: &mut Rng) -> Vec<Piece> {
    let mut pieces = Vec::new();
    for (_, edge) in network.graph.edges() {
        for w in polyline::resample(&edge.line_m(), PIECE_M).windows(2).filter(|w| w[0] != w[1]) {
            let degrees = trig::angle(w[1] - w[0]).to_degrees();
            pieces.push(Piece { at: (w[0] + w[1]) / 2.0, degrees });
        }
    }
    let drawn = index::sample(rng, pieces.len(), POINTS.min(pieces.len()));
    let mut drawn: Vec<Piece> = drawn.into_iter().map(|i| pieces[i]).collect();
    drawn.sort_by(|a, b| a.at.y.total_cmp(&b.at.y).then(a.at.x.total_cmp(&b.at.x)));
    drawn
}

/// The pairs of pieces, sorted by y, within each band.
fn pairs(pieces: &[Piece], bands_m: &[(f64, f64)]) -> Vec<Vec<(u16, u16)>> {
    let squares: Vec<(f64, f64)> = bands_m.iter().map(|(lo, hi)| (lo * lo, hi * hi)).collect();
    let reach_m = bands_m.iter().map(|(_, hi)| *hi).fold(0.0, f64::max);
    let mut out = vec![Vec::new(); bands_m.len()];
    for (i, a) in pieces.iter().enumerate() {
        let near = pieces.iter().enumerate().skip(i + 1);
        for (j, b) in near.take_while(|(_, b)| b.at.y - a.at.y < reach_m) {
            let square = a.at.distance_squared(b.at);
            if let Some(band) = squares.iter().position(|(lo, hi)| *lo <= square && square < *hi) {
                out[band].push((i as u16, j as u16));
            }
        }
    }
    out
}

/// Folded differences of up to 8,000 random pairs, each as likely as any other.
fn aligned(pieces: &[Piece], pairs: &[(u16, u16)], rng: &mut Rng) -> Sample {
    let folded = |(i, j): (u16, u16)| {
        let turned = pieces[i as usize].degrees - pieces[j as usize].degrees;
        let quarter = turned.rem_euclid(90.0);
        quarter.min(90.0 - quarter)
    };
    if pairs.len() <= PAIRS {
        return Sample::plain(pairs.iter().copied().map(folded));
    }
    Sample::plain((0..PAIRS).map(|_| folded(pairs[rng.random_range(0..pairs.len())])))
}
