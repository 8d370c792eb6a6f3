//! Levels of streets: main ones first, then what branches off them.
//!
//! Sources: Aliaga, Vanegas, Beneš 2008, section 5 (a small percentage of the longest and widest
//! streets is level 0, streets that cross a street of level i and have no level yet are i + 1);
//! Hartmann 2018, section 4.1.2 (level 0 by the map's own classes where it has them; stream order
//! with loops). The papers leave open what one street is: here it is a stroke, edges that go on in
//! each other ([`strokes`]). The percentage is 8 of the length by default. Parts of the network that
//! no main street reaches begin with level 1 at their longest street. O(n log n).

use exurb_graph::{Dart, NodeId};

use crate::{Role, Street, StreetGraph};
use exurb_geom::trig;

/// Streets that turn more than this at a junction do not go on in each other.
const MOST_TURN_RAD: f64 = 40.0 * std::f64::consts::PI / 180.0;
/// Directions at junctions are taken over this much of a street, in metres.
const LEG_M: f64 = 15.0;
/// Another class counts as this much more of a turn, another name as this much.
const CLASS_TURN_RAD: f64 = 10.0 * std::f64::consts::PI / 180.0;
const NAME_TURN_RAD: f64 = 15.0 * std::f64::consts::PI / 180.0;

/// How levels are assigned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hierarchy {
    /// Take streets of role main as level 0 where the map has both main and local ones. Default
    /// true.
    pub by_class: bool,
    /// Otherwise the share of the length that level 0 holds, 0 to 1. Default 0.08.
    pub main_share: f64,
}

impl Default for Hierarchy {
    fn default() -> Self {
        Self { by_class: true, main_share: 0.08 }
    }
}

/// Edges that go on in each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// From one end to the other; a closed stroke begins anywhere.
    pub darts: Vec<Dart>,
    /// Length in metres.
    pub length_m: f64,
}

/// The natural streets of a graph: at every junction two streets go on in each other when each is
/// the other's best continuation and they turn by less than 40°; where only two meet, always. Every
/// edge lies in exactly one stroke. In order of their first edges.
pub fn strokes(graph: &StreetGraph) -> Vec<Stroke> {
    strokes_by(graph, |_, _| Some(0.0))
}

/// Assigns every street its level.
pub fn assign_levels(graph: &mut StreetGraph, options: &Hierarchy) {
    let has = |role: Role| graph.edges().any(|(_, e)| e.data.role() == role);
    let tagged = options.by_class && has(Role::Main) && has(Role::Local);
    let is_main = |street: &Street| tagged && street.role() == Role::Main;
    let strokes = strokes_by(graph, |a, b| {
        (is_main(a) == is_main(b)).then_some(
            if a.class == b.class { 0.0 } else { CLASS_TURN_RAD }
                + if a.name == b.name { 0.0 } else { NAME_TURN_RAD },
        )
    });
    let main: Vec<usize> = if tagged {
        let first = |s: &Stroke| &graph.edge(s.darts[0].edge()).data;
        (0..strokes.len()).filter(|i| is_main(first(&strokes[*i]))).collect()
    } else {
        longest(graph, &strokes, options.main_share)
    };
    for (stroke, level) in strokes.iter().zip(levels(graph, &strokes, &main)) {
        for dart in &stroke.darts {
            graph.edge_mut(dart.edge()).data.level = level;
        }
    }
}

/// Strokes; `penalty` tells how much of a turn a change between two streets counts for, and `None`
/// that they never go on in each other.
fn strokes_by(
    graph: &StreetGraph,
    penalty: impl Fn(&Street, &Street) -> Option<f64>,
) -> Vec<Stroke> {
    let mut mate: Vec<Option<Dart>> = vec![None; graph.edge_bound() * 2];
    for (node, _) in graph.nodes() {
        pair_up(graph, node, &penalty, &mut mate);
    }
    let mut seen = vec![false; graph.edge_bound()];
    let mut out = Vec::new();
    for (id, _) in graph.edges() {
        if seen[id.index()] {
            continue;
        }
        // Back to the beginning, or once around.
        let mut start = id.forward();
        while let Some(before) = mate[start.index()] {
            start = before.twin();
            if start == id.forward() {
                break;
            }
        }
        let mut darts = vec![start];
        let mut last = start;
        seen[start.edge().index()] = true;
        while let Some(next) = mate[last.twin().index()] {
            if std::mem::replace(&mut seen[next.edge().index()], true) {
                break;
            }
            darts.push(next);
            last = next;
        }
        let length_m = darts.iter().map(|d| graph.edge(d.edge()).length_m()).sum();
        out.push(Stroke { darts, length_m });
    }
    out
}

/// Finds mutual best continuations among the darts that leave `node`.
fn pair_up(
    graph: &StreetGraph,
    node: NodeId,
    penalty: &impl Fn(&Street, &Street) -> Option<f64>,
    mate: &mut [Option<Dart>],
) {
    let darts = graph.darts(node);
    let directions: Vec<_> = darts.iter().map(|d| graph.direction(*d, LEG_M)).collect();
    let cost = |i: usize, j: usize| -> Option<f64> {
        let (a, b) = (graph.edge(darts[i].edge()), graph.edge(darts[j].edge()));
        if i == j || darts[i].edge() == darts[j].edge() {
            return None;
        }
        let extra = penalty(&a.data, &b.data)?;
        let turn = trig::angle_between(directions[i], -directions[j]);
        (turn < MOST_TURN_RAD || darts.len() == 2).then_some(turn + extra)
    };
    let best = |i: usize| {
        (0..darts.len())
            .filter_map(|j| Some((cost(i, j)?, j)))
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
            .map(|(_, j)| j)
    };
    let best: Vec<Option<usize>> = (0..darts.len()).map(best).collect();
    for (i, j) in best.iter().enumerate() {
        if let Some(j) = *j
            && best[j] == Some(i)
        {
            mate[darts[i].index()] = Some(darts[j]);
        }
    }
}

/// The longest, straightest, widest strokes that together hold `share` of the length; at least one.
fn longest(graph: &StreetGraph, strokes: &[Stroke], share: f64) -> Vec<usize> {
    let score = |stroke: &Stroke| -> f64 {
        let (first, last) = (stroke.darts[0], stroke.darts[stroke.darts.len() - 1]);
        let ends = [graph.tail(first), graph.head(last)].map(|n| graph.node(n).at);
        let straightness = ends[0].distance_m(ends[1]) / stroke.length_m;
        let width_m = stroke
            .darts
            .iter()
            .map(|d| graph.edge(d.edge()))
            .map(|e| e.data.width_m() * e.length_m())
            .sum::<f64>()
            / stroke.length_m;
        stroke.length_m * straightness * width_m
    };
    let mut order: Vec<(f64, usize)> =
        strokes.iter().enumerate().map(|(i, stroke)| (score(stroke), i)).collect();
    order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let total: f64 = strokes.iter().map(|s| s.length_m).sum();
    let mut held_m = 0.0;
    let mut main = Vec::new();
    for (_, i) in order {
        if !main.is_empty() && held_m + strokes[i].length_m > share * total {
            break;
        }
        held_m += strokes[i].length_m;
        main.push(i);
    }
    main
}

/// Breadth first from the main strokes over shared nodes.
fn levels(graph: &StreetGraph, strokes: &[Stroke], main: &[usize]) -> Vec<u8> {
    let mut through: Vec<Vec<u32>> = vec![Vec::new(); graph.node_bound()];
    for (i, stroke) in strokes.iter().enumerate() {
        for dart in &stroke.darts {
            for node in [graph.tail(*dart), graph.head(*dart)] {
                if through[node.index()].last() != Some(&(i as u32)) {
                    through[node.index()].push(i as u32);
                }
            }
        }
    }
    let mut level: Vec<Option<u8>> = vec![None; strokes.len()];
    let mut spread = |from: &[usize], first: u8, level: &mut Vec<Option<u8>>| {
        let mut open = from.to_vec();
        for i in from {
            level[*i] = Some(first);
        }
        let mut next = 0;
        while let Some(i) = open.get(next).copied() {
            next += 1;
            let branch = level[i].unwrap_or(first).saturating_add(1);
            for dart in &strokes[i].darts {
                for node in [graph.tail(*dart), graph.head(*dart)] {
                    // Every stroke at a node is seen from the first that comes by.
                    for j in std::mem::take(&mut through[node.index()]) {
                        if level[j as usize].is_none() {
                            level[j as usize] = Some(branch);
                            open.push(j as usize);
                        }
                    }
                }
            }
        }
    };
    spread(main, 0, &mut level);
    let mut by_length: Vec<usize> = (0..strokes.len()).collect();
    by_length.sort_by(|a, b| strokes[*b].length_m.total_cmp(&strokes[*a].length_m).then(a.cmp(b)));
    for i in by_length {
        if level[i].is_none() {
            spread(&[i], 1, &mut level);
        }
    }
    level.into_iter().map(|l| l.unwrap_or(0)).collect()
}

#[cfg(test)]
mod tests;
