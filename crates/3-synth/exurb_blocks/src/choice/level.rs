//! How much is built on in all: the example's coverage.
//!
//! Each block's own expectation is the mean of the example's blocks most like it. Where blocks are
//! smaller or larger than the example's, what they expect together is more or less than what the example
//! has; here all of them are raised or lowered by one factor until the sum is as it should be.

use exurb_geom::trig;

/// What is expected of a block that is to be filled.
#[derive(Clone, Copy, Debug)]
pub struct Expected {
    /// Its area in m².
    pub area_m2: f64,
    /// Share to be built on, by itself.
    pub coverage: f64,
    /// Is it neither park nor school nor the like? Others keep their coverage.
    pub is_ordinary: bool,
}

/// No block is wished to be built on by more than this share, unless it is so by itself.
const MOST_COVERED: f64 = 0.9;
/// Bisections of a factor: to a millionth.
const BISECTIONS: usize = 24;
/// Factors are sought up to this, either way.
const MOST_FACTOR: f64 = 20.0;

/// What blocks expect together is made up by a factor up to this; beyond it their sizes are not the
/// example's, and what its like blocks have tells little of them.
const MOST_UNLIKE: f64 = 3.0;

/// Draws the expectations of ordinary blocks towards the example's coverage where together they expect
/// less than a third of it: a quarter of large blocks is not empty because the few large ones of the
/// example are yards and parks. O(blocks).
pub fn likened(blocks: &mut [Expected], example: f64) {
    let sum = |of: &dyn Fn(&Expected) -> f64| blocks.iter().map(|b| b.area_m2 * of(b)).sum::<f64>();
    let (area_m2, own_m2) = (sum(&|_| 1.0), sum(&|b| b.coverage));
    let least_m2 = area_m2 * example / MOST_UNLIKE;
    // What each share of the way to the example's coverage adds.
    let whole_m2 = sum(&|b| if b.is_ordinary { example - b.coverage } else { 0.0 });
    if own_m2 >= least_m2 || whole_m2 <= 0.0 {
        return;
    }
    let share = ((least_m2 - own_m2) / whole_m2).min(1.0);
    for block in blocks.iter_mut().filter(|b| b.is_ordinary) {
        block.coverage += (example - block.coverage) * share;
    }
}

/// What all blocks together should build on, in m²: `share` of the way, in factors, from what they expect
/// to `example`, the example's coverage. One block alone stays nearer to itself than many do: an example
/// holds all sorts of single blocks.
pub fn total_m2(blocks: &[Expected], example: f64, share: f64) -> f64 {
    let area_m2: f64 = blocks.iter().map(|b| b.area_m2).sum();
    let own_m2: f64 = blocks.iter().map(|b| b.area_m2 * b.coverage).sum();
    let share = share * (1.0 - 1.0 / blocks.len().max(1) as f64);
    let wanted_m2 = area_m2 * example;
    if own_m2 <= 0.0 || wanted_m2 <= 0.0 {
        return own_m2;
    }
    own_m2 * trig::exp(share * trig::ln(wanted_m2 / own_m2))
}

/// The factor on the coverage of ordinary blocks with which all add up to `total_m2`, as nearly as can
/// be. O(blocks).
pub fn factor(blocks: &[Expected], total_m2: f64) -> f64 {
    solved(|factor| blocks.iter().map(|b| b.area_m2 * raised(b, factor)).sum(), total_m2)
}

/// The coverage of a block raised by a factor.
pub fn raised(block: &Expected, factor: f64) -> f64 {
    match block.is_ordinary {
        true => (block.coverage * factor).min(MOST_COVERED.max(block.coverage)),
        false => block.coverage,
    }
}

/// The factor with which a sum that grows with it is `wanted`.
pub fn solved(sum: impl Fn(f64) -> f64, wanted: f64) -> f64 {
    let (mut low, mut high) = (1.0 / MOST_FACTOR, MOST_FACTOR);
    for _ in 0..BISECTIONS {
        let middle = (low * high).sqrt();
        if sum(middle) < wanted { low = middle } else { high = middle }
    }
    (low * high).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blocks() -> Vec<Expected> {
        let block = |area_m2, coverage, is_ordinary| Expected { area_m2, coverage, is_ordinary };
        vec![block(1e4, 0.2, true), block(3e4, 0.3, true), block(2e4, 0.0, false)]
    }

    #[test]
    fn all_together_are_built_on_as_the_example_is() {
        let blocks = blocks();
        let many: Vec<Expected> = (0..100).flat_map(|_| blocks.clone()).collect();
        let total_m2 = total_m2(&many, 0.1, 1.0);
        assert!((total_m2 / (100.0 * 6e3) - 1.0).abs() < 0.01, "{total_m2}");
        let factor = factor(&many, total_m2);
        let sum: f64 = many.iter().map(|b| b.area_m2 * raised(b, factor)).sum();
        assert!((sum / total_m2 - 1.0).abs() < 1e-4);
        assert_eq!(raised(&blocks[2], factor), 0.0);
    }

    #[test]
    fn blocks_that_expect_next_to_nothing_are_likened_to_the_example() {
        let block = |coverage| Expected { area_m2: 2e4, coverage, is_ordinary: true };
        let mut blocks =
            vec![block(0.0), block(0.02), Expected { is_ordinary: false, ..block(0.1) }];
        likened(&mut blocks, 0.6);
        let sum: f64 = blocks.iter().map(|b| b.coverage).sum();
        assert!((sum - 3.0 * 0.6 / MOST_UNLIKE).abs() < 1e-9, "{sum}");
        assert!(blocks[0].coverage < blocks[1].coverage && blocks[2].coverage == 0.1);
        let before: Vec<f64> = blocks.iter().map(|b| b.coverage).collect();
        likened(&mut blocks, 0.5);
        assert!(blocks.iter().zip(before).all(|(b, before)| b.coverage == before));
    }

    #[test]
    fn without_a_share_or_alone_a_block_keeps_what_it_expects() {
        let blocks = blocks();
        assert!((total_m2(&blocks, 0.9, 0.0) - 11e3).abs() < 1e-6);
        assert!((total_m2(&blocks[..1], 0.9, 1.0) - 2e3).abs() < 1e-6);
        assert_eq!(total_m2(&[], 0.3, 1.0), 0.0);
        let most = raised(&blocks[0], 100.0);
        assert_eq!(most, MOST_COVERED);
    }
}
