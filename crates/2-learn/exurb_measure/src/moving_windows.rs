//! Measures of neighbourhoods: square cells of 500 m and windows of 1 km, moved by 250 m over the
//! window of the network. A network smaller than such a square has none. O(n).

use exurb_geom::{Bounds, Vec2, trig};

use crate::{Network, Sample, bearings};

/// Squares move by this much, in metres.
const STEP_M: f64 = 250.0;
/// Side of a cell and of a window, in metres.
const CELL_M: f64 = 500.0;
const WINDOW_M: f64 = 1000.0;
/// A share of junctions or a meshedness needs more nodes than this, an order more street, in metres.
const FEW_NODES: f64 = 10.0;
const SHORT_M: f64 = 1000.0;

/// Junctions per km² of cells.
pub fn junction_density(network: &Network) -> Sample {
    density(network, network.junctions().map(|n| (network.at(n), 1.0)))
}

/// Dead ends per km² of cells.
pub fn dead_end_density(network: &Network) -> Sample {
    density(network, network.dead_ends().map(|n| (network.at(n), 1.0)))
}

/// Kilometres of street per km² of cells.
pub fn street_density(network: &Network) -> Sample {
    let pieces = network.straight_pieces(bearings::PIECE_M);
    density(network, pieces.into_iter().map(|(a, b)| ((a + b) / 2.0, a.distance(b) / 1000.0)))
}

fn density(network: &Network, amounts: impl Iterator<Item = (Vec2, f64)>) -> Sample {
    let squares = Squares::over(network.window, CELL_M);
    let mut sums = vec![0.0; squares.count()];
    for (at, amount) in amounts {
        squares.holding(at, at, |square| sums[square] += amount);
    }
    Sample::plain(sums.into_iter().map(|sum| sum / (CELL_M * CELL_M / 1e6)))
}

/// Share of junctions with at least four legs, in windows with over ten nodes.
pub fn four_way_share(network: &Network) -> Sample {
    let squares = Squares::over(network.window, WINDOW_M);
    let mut counts = vec![[0.0; 3]; squares.count()];
    for node in network.ends() {
        let (at, degree) = (network.at(node), network.graph.degree(node));
        squares.holding(at, at, |square| {
            counts[square][0] += 1.0;
            counts[square][1] += f64::from(u8::from(degree >= 3));
            counts[square][2] += f64::from(u8::from(degree >= 4));
        });
    }
    let enough =
        counts.into_iter().filter(|[nodes, junctions, _]| *nodes > FEW_NODES && *junctions > 0.0);
    Sample::plain(enough.map(|[_, junctions, four_way]| four_way / junctions))
}

/// Meshedness (E - N + 1) / (2N - 5) of what lies wholly in windows with over ten nodes.
pub fn meshedness(network: &Network) -> Sample {
    let squares = Squares::over(network.window, WINDOW_M);
    let mut counts = vec![[0.0; 2]; squares.count()];
    for node in network.ends() {
        let at = network.at(node);
        squares.holding(at, at, |square| counts[square][0] += 1.0);
    }
    for (_, segment) in network.segments() {
        let (a, b) = (network.at(segment.from), network.at(segment.to));
        squares.holding(a.min(b), a.max(b), |square| counts[square][1] += 1.0);
    }
    let enough = counts.into_iter().filter(|[nodes, _]| *nodes > FEW_NODES);
    Sample::plain(enough.map(|[nodes, edges]| (edges - nodes + 1.0) / (2.0 * nodes - 5.0)))
}

/// Order φ of bearings ([`bearings::order`]) in windows with over 1 km of street.
pub fn order(network: &Network) -> Sample {
    let squares = Squares::over(network.window, WINDOW_M);
    let mut rose = vec![[0.0; bearings::ROSE_BINS]; squares.count()];
    for (a, b) in network.straight_pieces(bearings::PIECE_M) {
        let (middle, length_m) = ((a + b) / 2.0, a.distance(b));
        let bins = bearings::rose_bins(trig::angle(b - a));
        squares.holding(middle, middle, |square| {
            bins.iter().for_each(|bin| rose[square][*bin] += length_m);
        });
    }
    // Both directions of every piece are counted.
    let enough = rose.iter().filter(|rose| rose.iter().sum::<f64>() / 2.0 > SHORT_M);
    Sample::plain(enough.map(bearings::order))
}

/// Squares of one size at steps of 250 m that lie wholly inside a window.
struct Squares {
    window: Bounds,
    side_m: f64,
    columns: usize,
    rows: usize,
}

impl Squares {
    fn over(window: Bounds, side_m: f64) -> Self {
        let size = window.size();
        // A millimetre less than a whole number of steps is that number.
        let steps = |length_m: f64| (length_m - side_m + 1e-3) / STEP_M;
        let places = |length_m: f64| match steps(length_m) {
            few if few < 0.0 => 0,
            steps => steps as usize + 1,
        };
        Self { window, side_m, columns: places(size.x), rows: places(size.y) }
    }

    fn count(&self) -> usize {
        self.columns * self.rows
    }

    /// Calls `found` with every square that holds the box from `lo` to `hi`; squares are half open.
    fn holding(&self, lo: Vec2, hi: Vec2, mut found: impl FnMut(usize)) {
        let (lo, hi) = ((lo - self.window.min) / STEP_M, (hi - self.window.min) / STEP_M);
        let range = |lo: f64, hi: f64, places: usize| {
            let first = ((hi - self.side_m / STEP_M).floor() + 1.0).max(0.0) as usize;
            let end = if lo < 0.0 { 0 } else { (lo as usize + 1).min(places) };
            first..end.max(first)
        };
        let columns = range(lo.x, hi.x, self.columns);
        for row in range(lo.y, hi.y, self.rows) {
            columns.clone().for_each(|column| found(row * self.columns + column));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_hold_what_lies_inside_and_nothing_else() {
        let window = Bounds { min: Vec2::new(100.0, -50.0), max: Vec2::new(1850.0, 1200.0) };
        let squares = Squares::over(window, 500.0);
        assert_eq!((squares.columns, squares.rows), (6, 4));
        for (lo, hi) in [
            (Vec2::new(100.0, -50.0), Vec2::new(100.0, -50.0)),
            (Vec2::new(620.0, 300.0), Vec2::new(640.0, 410.0)),
            (Vec2::new(700.0, 300.0), Vec2::new(1190.0, 310.0)),
            (Vec2::new(700.0, 300.0), Vec2::new(1300.0, 310.0)),
            (Vec2::new(1849.0, 1199.0), Vec2::new(1849.0, 1199.0)),
        ] {
            let mut found = Vec::new();
            squares.holding(lo, hi, |square| found.push(square));
            let inside = |square: &usize| {
                let (column, row) = (square % squares.columns, square / squares.columns);
                let sw = window.min + Vec2::new(column as f64, row as f64) * STEP_M;
                sw.cmple(lo).all() && hi.cmplt(sw + squares.side_m).all()
            };
            let wanted: Vec<usize> = (0..squares.count()).filter(inside).collect();
            assert_eq!(found, wanted, "{lo} {hi}");
        }
    }

    #[test]
    fn a_small_window_has_no_squares() {
        let window = Bounds { min: Vec2::ZERO, max: Vec2::new(499.0, 5000.0) };
        assert_eq!(Squares::over(window, 500.0).count(), 0);
    }
}
