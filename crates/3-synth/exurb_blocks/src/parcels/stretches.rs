//! Which stretch of its block's edge each parcel fronts on.
//!
//! Long sides own the parcels at their ends; a short side between two of them is a flank that nobody
//! fronts on, as the short ends of Aliaga's two rows. Where two long sides meet, one parcel turns
//! around the corner.

use crate::ring::{Ring, Side};

/// A side up to this many lot depths between longer neighbours is a flank: two rows back to back end
/// there.
const FLANK_DEPTHS: f64 = 2.4;
/// A flank is this much shorter than its longer neighbour.
const FLANK_RATIO: f64 = 0.8;
/// Corner parcels front on at least this share of the lot depth to either side.
const CORNER_DEPTH_SHARE: f64 = 0.55;

/// Part of a ring from `start_m` to `end_m`, which may run over the ring's start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Where it begins along the ring.
    pub start_m: f64,
    /// Where it ends.
    pub end_m: f64,
}

/// For each side whether it is a flank of its neighbours' rows. Shortest sides first; no two
/// neighbours are flanks.
pub fn flanks(sides: &[Side], depth_m: f64) -> Vec<bool> {
    let n = sides.len();
    let mut flank = vec![false; n];
    if n < 3 {
        return flank;
    }
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|i, j| sides[*i].length_m().total_cmp(&sides[*j].length_m()).then(i.cmp(j)));
    for i in order {
        let (before, after) = ((i + n - 1) % n, (i + 1) % n);
        let length = sides[i].length_m();
        let longer = sides[before].length_m().max(sides[after].length_m());
        flank[i] = length < FLANK_DEPTHS * depth_m
            && length < FLANK_RATIO * longer
            && sides[i].turn_before_rad > 0.0
            && sides[i].turn_after_rad > 0.0
            && !flank[before]
            && !flank[after];
    }
    flank
}

/// The stretches of `ring`, in order along it. `next_m` gives the wanted frontages one after the
/// other; rows are stretched to fill their sides. Flanks belong to no stretch.
pub fn stretches(
    ring: &Ring,
    depth_m: f64,
    min_m: f64,
    mut next_m: impl FnMut() -> f64,
) -> Vec<Stretch> {
    let sides = ring.sides();
    let n = sides.len();
    let flank = flanks(&sides, depth_m);
    let before = |i: usize| (i + n - 1) % n;
    let turns =
        |i: usize| n > 1 && sides[i].turn_before_rad > 0.0 && !flank[i] && !flank[before(i)];
    // Frontage of the corner parcel to either side of the corner where each side begins.
    let corner_m: Vec<f64> = (0..n)
        .map(|i| {
            let shorter = sides[i].length_m().min(sides[before(i)].length_m());
            let wanted = next_m().max(depth_m * CORNER_DEPTH_SHARE).min(shorter / 2.0);
            if turns(i) { wanted } else { 0.0 }
        })
        .collect();
    let mut out = Vec::new();
    let mut ends = vec![(0.0, 0.0); n];
    for i in (0..n).filter(|i| !flank[*i]) {
        let (mut from, mut to) = (corner_m[i], corner_m[(i + 1) % n]);
        let room = sides[i].length_m() - from - to;
        // Too little for one more parcel goes to the corners.
        if from + to > 0.0 && room < min_m.max(0.5 * next_m()) {
            let stretch = sides[i].length_m() / (from + to);
            (from, to) = (from * stretch, to * stretch);
        }
        ends[i] = (from, to);
        let (start, end) = (sides[i].start_m + from, sides[i].end_m - to);
        out.extend(row(start, end, min_m, &mut next_m));
    }
    for i in (0..n).filter(|i| turns(*i)) {
        let at = sides[i].start_m;
        out.push(Stretch { start_m: at - ends[before(i)].1, end_m: at + ends[i].0 });
    }
    out.sort_by(|a, b| a.start_m.total_cmp(&b.start_m));
    out
}

/// Frontages along one side from `start_m` to `end_m`.
fn row(start_m: f64, end_m: f64, min_m: f64, next_m: &mut impl FnMut() -> f64) -> Vec<Stretch> {
    let length = end_m - start_m;
    if length < 0.01 {
        return Vec::new();
    }
    let most = ((length / min_m) as usize).max(1);
    let mut widths = vec![next_m().max(min_m)];
    let mut sum = widths[0];
    while widths.len() < most {
        let width = next_m().max(min_m);
        // One more only if that comes nearer to the length.
        if sum + width / 2.0 > length {
            break;
        }
        sum += width;
        widths.push(width);
    }
    let mut at = start_m;
    let last = widths.len() - 1;
    let cut = widths.into_iter().enumerate().map(|(i, width)| {
        let from = at;
        at = if i == last { end_m } else { at + width * length / sum };
        Stretch { start_m: from, end_m: at }
    });
    cut.collect()
}
