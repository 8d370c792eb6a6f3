//! Elements in a row brought to where they are wished for without touching more than they should.

/// An element of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wish {
    /// Where it should stand.
    pub at_m: f64,
    /// How much that counts; positive.
    pub weight: f64,
    /// How far it must stay behind the element before, at least; of the first one, behind the row's
    /// start.
    pub after_m: f64,
}

/// Positions nearest to the wishes, by weighted least squares, that keep their distances and leave
/// `last_m` free before `end_m`. Where the row is too short for all, it runs over its end.
///
/// The distances are taken off, and what is left is an isotonic regression, solved by pooling
/// neighbours that would come in the wrong order. O(n).
pub fn spaced(wishes: &[Wish], end_m: f64, last_m: f64) -> Vec<f64> {
    let mut offset = 0.0;
    let offsets: Vec<f64> = wishes
        .iter()
        .map(|w| {
            offset += w.after_m;
            offset
        })
        .collect();
    // Pools of neighbours that stand as near as they may: mean, weight, count.
    let mut pools: Vec<(f64, f64, usize)> = Vec::new();
    for (wish, offset) in wishes.iter().zip(&offsets) {
        pools.push((wish.at_m - offset, wish.weight, 1));
        while let [.., a, b] = &pools[..] {
            if a.0 <= b.0 {
                break;
            }
            let weight = a.1 + b.1;
            let joined = ((a.0 * a.1 + b.0 * b.1) / weight, weight, a.2 + b.2);
            pools.truncate(pools.len() - 2);
            pools.push(joined);
        }
    }
    let most = end_m - last_m - offset;
    let base = pools.iter().flat_map(|p| std::iter::repeat_n(p.0, p.2));
    // A row that fits is kept between its ends.
    base.zip(offsets).map(|(b, o)| b.min(most).max(0.0) + o).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn wish(at_m: f64, after_m: f64) -> Wish {
        Wish { at_m, weight: 1.0, after_m }
    }

    #[test]
    fn what_fits_stands_where_it_is_wished_for() {
        let row = [wish(5.0, 5.0), wish(15.0, 10.0), wish(40.0, 10.0)];
        assert_eq!(spaced(&row, 50.0, 5.0), [5.0, 15.0, 40.0]);
    }

    #[test]
    fn what_is_too_near_moves_apart_evenly_and_stays_between_the_ends() {
        let row = [wish(20.0, 5.0), wish(22.0, 10.0)];
        assert_eq!(spaced(&row, 50.0, 5.0), [16.0, 26.0]);
        assert_eq!(spaced(&row, 28.0, 5.0), [13.0, 23.0]);
        assert_eq!(spaced(&[wish(-3.0, 5.0)], 28.0, 5.0), [5.0]);
    }

    proptest! {
        #[test]
        fn distances_hold_and_no_small_change_is_better(
            wishes in prop::collection::vec((0.0..100.0, 1.0..12.0), 1..8),
        ) {
            let row: Vec<Wish> = wishes.iter().map(|(at, after)| wish(*at, *after)).collect();
            let at = spaced(&row, 200.0, 5.0);
            let fits = |at: &[f64]| {
                let ok = |i: usize| at[i] - if i == 0 { 0.0 } else { at[i - 1] } >= row[i].after_m - 1e-9;
                (0..at.len()).all(ok)
            };
            prop_assert!(fits(&at));
            let off = |at: &[f64]| -> f64 { at.iter().zip(&row).map(|(a, w)| (a - w.at_m).powi(2)).sum() };
            for i in 0..at.len() {
                for j in i..at.len() {
                    for step in [-0.01, 0.01] {
                        let mut other = at.clone();
                        other[i..=j].iter_mut().for_each(|a| *a += step);
                        prop_assert!(!fits(&other) || off(&other) >= off(&at) - 1e-6);
                    }
                }
            }
        }
    }
}
