//! One choice a block, all together: cheap ones that go with their neighbours'.

/// Blocks with choices, and neighbours among them.
#[derive(Clone, Debug, Default)]
pub struct Problem {
    /// Cost of each choice of each block.
    pub costs: Vec<Vec<f64>>,
    /// Neighbours of each block.
    pub neighbours: Vec<Vec<usize>>,
}

/// Rounds at most.
const ROUNDS: usize = 30;

/// For each block the index of its choice (0 where it has none): blocks take turns in choosing what is
/// cheapest next to what their neighbours have chosen (iterated conditional modes, Besag 1986), until
/// none changes. `pair` is the cost of two neighbours' choices, block and choice each, and is the same
/// both ways. Never dearer than everyone's own cheapest choice. O(rounds · pairs · choices²).
pub fn choose(
    problem: &Problem,
    pair: impl Fn((usize, usize), (usize, usize)) -> f64,
) -> Vec<usize> {
    let cheapest = |costs: &[f64]| {
        (0..costs.len()).min_by(|i, j| costs[*i].total_cmp(&costs[*j]).then(i.cmp(j))).unwrap_or(0)
    };
    let mut chosen: Vec<usize> = problem.costs.iter().map(|costs| cheapest(costs)).collect();
    for _ in 0..ROUNDS {
        let mut changed = false;
        for i in 0..chosen.len() {
            let own = &problem.costs[i];
            let total = |c: usize| {
                let others =
                    problem.neighbours[i].iter().filter(|j| !problem.costs[**j].is_empty());
                own[c] + others.map(|j| pair((i, c), (*j, chosen[*j]))).sum::<f64>()
            };
            let totals: Vec<f64> = (0..own.len()).map(total).collect();
            let best = cheapest(&totals);
            if !own.is_empty() && totals[best] < totals[chosen[i]] {
                chosen[i] = best;
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
    chosen
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn total(
        problem: &Problem,
        chosen: &[usize],
        pair: impl Fn((usize, usize), (usize, usize)) -> f64,
    ) -> f64 {
        let own: f64 =
            problem.costs.iter().zip(chosen).map(|(c, k)| c.get(*k).unwrap_or(&0.0)).sum();
        let with =
            |i: usize| problem.neighbours[i].iter().filter(move |j| **j > i).map(move |j| (i, *j));
        let pairs = (0..chosen.len()).flat_map(with);
        own + pairs.map(|(i, j)| pair((i, chosen[i]), (j, chosen[j]))).sum::<f64>()
    }

    proptest! {
        #[test]
        fn no_block_alone_can_do_better(
            costs in prop::collection::vec(prop::collection::vec(0.0..1.0, 1..4), 2..9),
            looks in prop::collection::vec(0.0..1.0, 36),
        ) {
            let n = costs.len();
            let ring = (0..n).map(|i| vec![(i + 1) % n, (i + n - 1) % n]);
            let ring: Vec<Vec<usize>> = ring.map(|mut l: Vec<usize>| { l.sort_unstable(); l.dedup(); l }).collect();
            let problem = Problem { costs, neighbours: ring };
            let look = |(i, c): (usize, usize)| -> f64 { looks[(i * 4 + c) % 36] };
            let pair = |a: (usize, usize), b: (usize, usize)| (look(a) - look(b)).abs();
            let chosen = choose(&problem, pair);
            let best = total(&problem, &chosen, pair);
            for i in 0..n {
                for c in 0..problem.costs[i].len() {
                    let mut other = chosen.clone();
                    other[i] = c;
                    prop_assert!(total(&problem, &other, pair) >= best - 1e-9);
                }
            }
        }
    }

    #[test]
    fn a_block_gives_in_to_its_neighbours() {
        // The middle one likes 0 a little better, both others are 1.
        let costs = vec![vec![9.0, 0.0], vec![0.0, 0.1], vec![9.0, 0.0]];
        let problem = Problem { costs, neighbours: vec![vec![1], vec![0, 2], vec![1]] };
        let differs = |a: (usize, usize), b: (usize, usize)| if a.1 == b.1 { 0.0 } else { 0.2 };
        assert_eq!(choose(&problem, differs), [1, 1, 1]);
        assert_eq!(choose(&problem, |_, _| 0.0), [1, 0, 1]);
        assert_eq!(choose(&Problem::default(), |_, _| 0.0), [0usize; 0]);
    }
}
