//! The cheapest sequence of elements along a line: exact labelling by dynamic programming.
//!
//! Source: Hartmann, Krüger, Klein 2015, equations (1) to (3). Departures: a state is an element and
//! where it ends, tables take the place of the priority queue, since all of them are small and are
//! filled in any case; the sequence has exactly the length of the line, which empty elements of one
//! step always allow, where the paper stops at that length or more; elements that cannot stand
//! somewhere cost infinity there. O(elements · steps).

/// What a line is filled with.
#[derive(Clone, Debug)]
pub struct Problem {
    /// Steps along the line.
    pub steps: usize,
    /// Steps that each element takes, at least one.
    pub lengths: Vec<usize>,
    /// Cost of each element by the step it begins at; may be infinite.
    pub costs: Vec<Vec<f64>>,
    /// Cost of leaving each step empty; finite.
    pub empty: Vec<f64>,
    /// Cost of two empty steps in a row (the paper's α).
    pub empty_pair: f64,
    /// Cost of an element after itself (the paper's 1 - α); infinite forbids it.
    pub same_pair: Vec<f64>,
}

/// An element and the step it begins at, or an empty step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Label {
    /// The element; `None` is empty.
    pub element: Option<usize>,
    /// Where it begins.
    pub start: usize,
}

/// The cheapest sequence and its cost. Among equals the one with lower elements, empty last, wins.
pub fn solve(problem: &Problem) -> (f64, Vec<Label>) {
    let (n, steps) = (problem.lengths.len(), problem.steps);
    // By step where it ends: cost with each last element; index n is empty.
    let mut best = vec![vec![f64::INFINITY; n + 1]; steps + 1];
    let mut before = vec![vec![usize::MAX; n + 1]; steps + 1];
    // The two cheapest last elements by step: what comes next differs from one of them.
    let mut least = vec![[(f64::INFINITY, usize::MAX); 2]; steps + 1];
    least[0] = [(0.0, n + 1); 2];
    for end in 1..=steps {
        for e in 0..=n {
            let length = if e < n { problem.lengths[e] } else { 1 };
            let Some(start) = end.checked_sub(length) else { continue };
            let own = if e < n { problem.costs[e][start] } else { problem.empty[start] };
            let same = if e < n { problem.same_pair[e] } else { problem.empty_pair };
            let after = |last: usize, cost: f64| cost + if last == e { same } else { 0.0 };
            let from_self = (after(e, best[start][e]), e);
            let other = if least[start][0].1 == e { least[start][1] } else { least[start][0] };
            let (cost, last) = if from_self.0 < other.0 { from_self } else { other };
            let total = cost + own;
            if total < f64::INFINITY {
                best[end][e] = total;
                before[end][e] = last;
                let [first, second] = &mut least[end];
                if total < first.0 {
                    (*second, *first) = (*first, (total, e));
                } else if total < second.0 {
                    *second = (total, e);
                }
            }
        }
    }
    let (cost, mut last) = if steps == 0 { (0.0, n + 1) } else { least[steps][0] };
    let mut end = steps;
    let mut labels = Vec::new();
    while end > 0 && last <= n {
        let length = if last < n { problem.lengths[last] } else { 1 };
        labels.push(Label { element: (last < n).then_some(last), start: end - length });
        let next = before[end][last];
        end -= length;
        last = next;
    }
    labels.reverse();
    (cost, labels)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The cost of a sequence by the definition.
    fn cost(problem: &Problem, labels: &[Label]) -> f64 {
        let own = |l: &Label| match l.element {
            Some(e) => problem.costs[e][l.start],
            None => problem.empty[l.start],
        };
        let pair = |w: &[Label]| match (w[0].element, w[1].element) {
            (None, None) => problem.empty_pair,
            (Some(a), Some(b)) if a == b => problem.same_pair[a],
            _ => 0.0,
        };
        labels.iter().map(own).sum::<f64>() + labels.windows(2).map(pair).sum::<f64>()
    }

    /// All sequences, one after the other.
    fn by_trying(problem: &Problem, start: usize, so_far: &mut Vec<Label>, best: &mut f64) {
        if start == problem.steps {
            *best = best.min(cost(problem, so_far));
            return;
        }
        let choices = (0..problem.lengths.len()).map(Some).chain([None]);
        for element in choices {
            let length = element.map_or(1, |e| problem.lengths[e]);
            if start + length <= problem.steps {
                so_far.push(Label { element, start });
                by_trying(problem, start + length, so_far, best);
                so_far.pop();
            }
        }
    }

    proptest! {
        #[test]
        fn no_sequence_is_cheaper(
            steps in 0usize..9,
            lengths in prop::collection::vec(1usize..4, 0..4),
            costs in prop::collection::vec(0u8..9, 4 * 9),
            empty in prop::collection::vec(0u8..4, 9),
            same in prop::collection::vec(0u8..3, 4),
        ) {
            let n = lengths.len();
            // A cost of 8 stands for infinity.
            let real = |c: u8| if c == 8 { f64::INFINITY } else { f64::from(c) };
            let problem = Problem {
                steps,
                costs: (0..n).map(|e| (0..9).map(|m| real(costs[e * 9 + m])).collect()).collect(),
                lengths,
                empty: empty.iter().map(|c| f64::from(*c)).collect(),
                empty_pair: 0.05,
                same_pair: same.iter().map(|c| f64::from(*c)).collect(),
            };
            let (found, labels) = solve(&problem);
            let mut best = f64::INFINITY;
            by_trying(&problem, 0, &mut Vec::new(), &mut best);
            prop_assert!((found - best).abs() < 1e-9, "{found} {best}");
            prop_assert!((cost(&problem, &labels) - found).abs() < 1e-9);
            let length = |l: &Label| l.element.map_or(1, |e| problem.lengths[e]);
            prop_assert_eq!(labels.iter().map(length).sum::<usize>(), steps);
        }
    }
}
