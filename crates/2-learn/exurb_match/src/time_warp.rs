//! Cyclic dynamic time warping: the cheapest monotone path around two closed outlines.
//!
//! Source: Sakoe, Chiba 1978, *Dynamic Programming Algorithm Optimization for Spoken Word
//! Recognition*, run for every rotation of the second outline (Hartmann 2018, section 5.1.3).
//! Departure: rotations are not tried one by one. Two cheapest paths need not cross, so the path of a
//! rotation lies between those of a smaller and a larger one (Maes 1990, *On a Cyclic String-to-String
//! Correction Problem*): halving the rotations again and again gives the same minimum in
//! O(n² log n) instead of O(n³). Rotations are left out whose paths cannot be as cheap as one near the
//! cheapest straight path: a path costs at least the least cost of each row inside its band.

use crate::shape_context::Costs;

/// The cheapest path around both outlines.
#[derive(Clone, Debug, PartialEq)]
pub struct Warp {
    /// Mean cost of the pairs along the path.
    pub cost: f64,
    /// Pairs of samples (first outline, second outline) in order: each step goes one on in either or
    /// in both; the second one's are counted on over its start.
    pub path: Vec<(u32, u32)>,
}

/// The cheapest path over all rotations of the second outline. Paths are compared by the sum of their
/// costs. Both outlines have at least one sample.
pub fn cyclic(costs: &Costs) -> Warp {
    let columns = costs.columns();
    let mut search = Search { costs, best: None, bound: f32::INFINITY, table: Vec::new() };
    search.bound = search.likely();
    let whole = Band { low: vec![0; costs.rows()], high: vec![2 * columns as u32; costs.rows()] };
    let first = search.path_from(0, &whole);
    let last = first.iter().map(|(i, j)| (*i, j + columns as u32)).collect::<Vec<_>>();
    search.between(0, columns as u32, &first, &last);
    let (sum, path) = search.best.unwrap_or_default();
    Warp { cost: f64::from(sum) / path.len().max(1) as f64, path }
}

/// Sums of the same costs in another order differ by less than this factor.
const ROUNDING: f32 = 1.0001;

/// The rotation of the cheapest of the paths that go on in both outlines, which have as many samples, at
/// every step.
fn straight(costs: &Costs) -> usize {
    let n = costs.columns();
    let mut sums = vec![0.0f32; n];
    for i in 0..n {
        // Rotation k pairs row i with column i + k.
        let (tail, head) = costs.row(i).split_at(i);
        for (sum, cost) in sums.iter_mut().zip(head.iter().chain(tail)) {
            *sum += cost;
        }
    }
    (0..n).min_by(|a, b| sums[*a].total_cmp(&sums[*b])).unwrap_or(0)
}

/// Paths near a straight one stray by so many samples.
const STRAY: usize = 12;

/// The lesser of two numbers, neither of them not a number: one instruction, other than [`f32::min`].
fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The least of some numbers, none of them not a number; infinite where there are none.
fn least_of(values: &[f32]) -> f32 {
    let mut lanes = [f32::INFINITY; 8];
    let chunks = values.chunks_exact(8);
    let rest = chunks.remainder().iter().copied().fold(f32::INFINITY, f32::min);
    for chunk in chunks {
        for (lane, value) in lanes.iter_mut().zip(chunk) {
            *lane = lesser(*value, *lane);
        }
    }
    lanes.into_iter().fold(rest, f32::min)
}

/// Writes to each place of `row` the lesser of the sums above it and above the place before; what lies
/// outside the row above is infinite, as `row` is to begin with. The first places are columns `low_above`
/// and `low`.
fn from_above(above: &[f32], low_above: usize, row: &mut [f32], low: usize) {
    for shift in [0, 1] {
        // Place k of the row lies below place k + low - shift - low_above.
        let ahead = (low_above + shift).saturating_sub(low).min(row.len());
        let behind = low.saturating_sub(low_above + shift).min(above.len());
        for (sum, above) in row[ahead..].iter_mut().zip(&above[behind..]) {
            *sum = lesser(*above, *sum);
        }
    }
}

/// First and last column to be looked at in each row.
struct Band {
    low: Vec<u32>,
    high: Vec<u32>,
}

impl Band {
    /// What lies between two paths, with both.
    fn between(left: &[(u32, u32)], right: &[(u32, u32)], rows: usize) -> Self {
        let (mut low, mut high) = (vec![u32::MAX; rows], vec![0; rows]);
        for (i, j) in left {
            low[*i as usize] = low[*i as usize].min(*j);
        }
        for (i, j) in right {
            high[*i as usize] = high[*i as usize].max(*j);
        }
        Self { low, high }
    }
}

struct Search<'a> {
    costs: &'a Costs,
    best: Option<(f32, Vec<(u32, u32)>)>,
    /// No path that costs more is the cheapest one.
    bound: f32,
    /// Sums of the last table, to be used again.
    table: Vec<f32>,
}

impl Search<'_> {
    /// The paths of all rotations between two whose paths are known.
    fn between(&mut self, from: u32, to: u32, left: &[(u32, u32)], right: &[(u32, u32)]) {
        if to - from < 2 {
            return;
        }
        let band = Band::between(left, right, self.costs.rows());
        if self.least(&band) > self.bound * ROUNDING {
            return;
        }
        let middle = (from + to) / 2;
        let path = self.path_from(middle, &band);
        self.between(from, middle, left, &path);
        self.between(middle, to, &path, right);
    }

    /// The cost of a cheap path: the cheapest near the cheapest straight one. Infinite where the outlines
    /// differ in their numbers of samples.
    fn likely(&mut self) -> f32 {
        let n = self.costs.columns();
        if self.costs.rows() != n {
            return f32::INFINITY;
        }
        let start = straight(self.costs);
        let low = |i: usize| (start + i.saturating_sub(STRAY)) as u32;
        let high = |i: usize| (start + i + STRAY) as u32;
        let band = Band { low: (0..n).map(low).collect(), high: (0..n).map(high).collect() };
        self.path_from(start as u32, &band);
        // The search itself begins with nothing found.
        self.best.take().map_or(f32::INFINITY, |(sum, _)| sum)
    }

    /// What every path inside a band costs at least.
    fn least(&self, band: &Band) -> f32 {
        let columns = self.costs.columns();
        let of_row = |i: usize| {
            let (row, low, high) = (self.costs.row(i), band.low[i] as usize, band.high[i] as usize);
            let (before, after) = (low.min(columns)..(high + 1).min(columns), high + 1);
            let behind = low.max(columns) - columns..after.max(columns) - columns;
            least_of(&row[before]).min(least_of(&row[behind.start.min(behind.end)..behind.end]))
        };
        (0..self.costs.rows()).map(of_row).sum()
    }

    /// The cheapest path of one rotation inside a band.
    fn path_from(&mut self, start: u32, band: &Band) -> Vec<(u32, u32)> {
        let (rows, columns) = (self.costs.rows(), self.costs.columns());
        let end = start + columns as u32 - 1;
        let span = |i: usize| (band.low[i].max(start) as usize, band.high[i].min(end) as usize);
        // Sums by row; columns outside a row's span count as infinite.
        let mut offsets = Vec::with_capacity(rows);
        self.table.clear();
        let (mut above, mut above_low) = (0..0, 0);
        for i in 0..rows {
            let (low, high) = span(i);
            let offset = self.table.len();
            offsets.push(offset);
            self.table.resize(offset + high + 1 - low, f32::INFINITY);
            let (before_rows, row) = self.table.split_at_mut(offset);
            from_above(&before_rows[above], above_low, row, low);
            if i == 0 {
                row[0] = 0.0;
            }
            // Columns run on over the start of the outline.
            let (first, second) = row.split_at_mut((columns.max(low) - low).min(high + 1 - low));
            let mut before = f32::INFINITY;
            let costs = self.costs.row(i);
            for (part, at) in [(first, low), (second, low.max(columns) - columns)] {
                for (sum, cost) in part.iter_mut().zip(&costs[at.min(columns)..]) {
                    before = lesser(*sum, before) + cost;
                    *sum = before;
                }
            }
            (above, above_low) = (offset..self.table.len(), low);
        }
        let sum = self.table[self.table.len() - 1];
        let path = self.traced(&offsets, &span, start, end);
        if self.best.as_ref().is_none_or(|(least, _)| sum < *least) {
            self.best = Some((sum, path.clone()));
            self.bound = self.bound.min(sum);
        }
        path
    }

    /// The path from the last cell back to the first, diagonal steps before others.
    fn traced(
        &self,
        offsets: &[usize],
        span: &impl Fn(usize) -> (usize, usize),
        start: u32,
        end: u32,
    ) -> Vec<(u32, u32)> {
        let sum = |i: usize, j: usize| {
            let (low, high) = span(i);
            let inside = (low..=high).contains(&j);
            if inside { self.table[offsets[i] + j - low] } else { f32::INFINITY }
        };
        let (mut i, mut j) = (offsets.len() - 1, end as usize);
        let mut path = vec![(i as u32, j as u32)];
        while i > 0 || j > start as usize {
            let back = |can: bool, i: usize, j: usize| if can { sum(i, j) } else { f32::INFINITY };
            let can_left = j > start as usize;
            let diagonal = back(i > 0 && can_left, i.wrapping_sub(1), j.wrapping_sub(1));
            let up = back(i > 0, i.wrapping_sub(1), j);
            let left = back(can_left, i, j.wrapping_sub(1));
            if diagonal <= up && diagonal <= left {
                (i, j) = (i - 1, j - 1);
            } else if up <= left {
                i -= 1;
            } else {
                j -= 1;
            }
            path.push((i as u32, j as u32));
        }
        path.reverse();
        path
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The least sum over all rotations, one after the other.
    fn rotation_by_rotation(costs: &Costs) -> f32 {
        let (rows, columns) = (costs.rows(), costs.columns());
        let mut best = f32::INFINITY;
        for start in 0..columns {
            let mut sums = vec![vec![f32::INFINITY; columns]; rows];
            for i in 0..rows {
                for j in 0..columns {
                    let at = |i: Option<usize>, j: Option<usize>| match (i, j) {
                        (Some(i), Some(j)) => sums[i][j],
                        _ => f32::INFINITY,
                    };
                    let (up, left) = (i.checked_sub(1), j.checked_sub(1));
                    let least = at(up, Some(j)).min(at(Some(i), left)).min(at(up, left));
                    let least = if i == 0 && j == 0 { 0.0 } else { least };
                    sums[i][j] = least + costs.row(i)[(j + start) % columns];
                }
            }
            best = best.min(sums[rows - 1][columns - 1]);
        }
        best
    }

    proptest! {
        #[test]
        fn halving_finds_what_trying_all_rotations_does(
            columns in 1usize..14,
            // Small whole costs: sums are exact and ties are many.
            values in prop::collection::vec(0u8..6, 14 * 12),
            rows in 1usize..12,
        ) {
            let values = values[..rows * columns].iter().map(|v| f32::from(*v)).collect();
            let costs = Costs::new(columns, values);
            let warp = cyclic(&costs);
            let along = |(i, j): &(u32, u32)| costs.row(*i as usize)[*j as usize % columns];
            let sum: f32 = warp.path.iter().map(along).sum();
            prop_assert_eq!(sum, rotation_by_rotation(&costs));
            prop_assert!((warp.cost * warp.path.len() as f64 - f64::from(sum)).abs() < 1e-6);
            let (first, last) = (warp.path[0], warp.path[warp.path.len() - 1]);
            prop_assert_eq!((first.0, last.0 as usize), (0, rows - 1));
            prop_assert_eq!((last.1 - first.1) as usize, columns - 1);
            let steps = warp.path.windows(2).map(|w| (w[1].0 - w[0].0, w[1].1 - w[0].1));
            let allowed = steps.into_iter().all(|step| [(1, 0), (0, 1), (1, 1)].contains(&step));
            prop_assert!(allowed);
        }
    }
}
