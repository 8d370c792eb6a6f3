//! The pure core: starts, main streets, cells, local streets, finish.

use std::collections::BTreeMap;

use exurb_city::street_graph::StreetGraph;
use exurb_geom::{GridPoint, Polygon, Vec2, offset};
use exurb_graph::{Graph, NodeId};
use exurb_operation::Run;

use super::cells::{self, Grown};
use super::error::Error;
use super::growth::{Growth, Place};
use super::learn::Vocabulary;
use super::network::{Network, Piece, Vertex};
use super::params::Params;
use super::placing;
use super::{fill, finish};

/// Growth goes on beyond the target by a large block of the example, so that blocks at its edge close
/// and its edge looks like its middle; by no more and no less than this.
const MARGIN_M: std::ops::RangeInclusive<f64> = 90.0..=350.0;

/// What growth works on.
#[derive(Debug)]
pub struct Input<'a> {
    /// The area to fill.
    pub target: &'a Polygon,
    /// The examples.
    pub examples: &'a [Vocabulary],
    /// Where growth begins.
    pub starts: Vec<Start>,
}

/// A place where growth begins.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// The place in the target.
    pub at: Vec2,
    /// Number of the example.
    pub example: usize,
    /// The place in the example that it begins with.
    pub source: Vec2,
}

/// Grows streets in the target.
pub fn synthesize(input: &Input, params: &Params, run: &Run) -> Result<StreetGraph, Error> {
    let margin_m = input.examples.iter().map(|e| e.large_block_m).fold(0.0, f64::max);
    let grown = offset::inset(input.target, -margin_m.clamp(*MARGIN_M.start(), *MARGIN_M.end()));
    let area = grown.first().unwrap_or(input.target);
    let examples: Vec<&Vocabulary> =
        input.starts.iter().map(|s| &input.examples[s.example]).collect();

    run.phase("main streets");
    let mut main = grow_main(input, &examples, area, params, run)?;
    if params.remove_dangling {
        remove_open_ends(&mut main, &examples);
    }
    cells::make_berths(&mut main);

    run.phase("local streets");
    let local = cells::grow(&main, area, &examples, &input.starts, params, run)?;

    run.phase("finish");
    let graph = join(main, local);
    let share = examples.first().and_then(|e| e.gates.get("dead_end_share")).copied();
    let streets = finish::finish(graph, input.target, share, params.remove_dangling);
    if streets.edge_count() == 0 {
        let area_km2 = input.target.area_m2() / 1e6;
        return Err(Error::Nothing { starts: input.starts.len(), area_km2 });
    }
    Ok(streets)
}

fn grow_main(
    input: &Input,
    examples: &[&Vocabulary],
    area: &Polygon,
    params: &Params,
    run: &Run,
) -> Result<Network, Error> {
    let street_m = examples.first().map_or(100.0, |e| e.main.statistics.length_mean_m);
    let mut growth =
        Growth::new(Network::new(street_m), examples, true, area, params, run.stream(0));
    for (i, start) in input.starts.iter().enumerate() {
        begin(&mut growth, i, start);
    }
    growth.run(run)?;
    if growth.net.graph.edge_count() > 0 {
        fill::fill(&mut growth, examples[0].main.empty_m, run)?;
    }
    Ok(growth.net)
}

/// Begins growth at a start: the first of the nearest junctions of the example whose patch can lie
/// there. The start's place in the target belongs to its place in the example, not to the junction
/// nearest to that.
pub fn begin(growth: &mut Growth, number: usize, start: &Start) {
    const TRIES: usize = 24;
    let style = growth.style(number);
    let shift = start.at - start.source;
    for own in style.starts_near(start.source).into_iter().take(TRIES) {
        let mut at = style.layer.nodes[own].at + shift;
        if !growth.area.contains(GridPoint::round(at)) {
            at = start.at;
        }
        let link = Some(style.layer.nodes[own].example);
        let piece = Some(growth.begin_piece(at));
        let vertex = Vertex { link, start: number, piece, ..Vertex::default() };
        let node = growth.net.add_node(GridPoint::round(at), vertex);
        if placing::continuation(growth, node, own) {
            growth.queue.push_back(Place::Node(node));
            return;
        }
        growth.net.remove_lonely(node);
    }
}

/// Removes main streets that end where nothing goes on, in the example or here. A main street that
/// becomes a local one there keeps its end: the local street will grow from it.
fn remove_open_ends(net: &mut Network, examples: &[&Vocabulary]) {
    let mut open: Vec<NodeId> = net.graph.nodes().map(|(id, _)| id).collect();
    while let Some(node) = open.pop() {
        let Some(n) = net.graph.get_node(node) else { continue };
        if n.data.dead_end || n.data.outside || net.graph.degree(node) != 1 {
            continue;
        }
        let example = examples[n.data.start % examples.len()];
        let goes_on = n.data.link.is_some_and(|link| {
            let main = example.main.layer.of_example[link.index()];
            let ends_here = main.is_some_and(|m| example.main.layer.nodes[m].ends.len() == 1);
            ends_here && example.local.layer.of_example[link.index()].is_some()
        });
        if goes_on {
            continue;
        }
        let dart = net.graph.darts(node)[0];
        let head = net.graph.head(dart);
        net.remove_edge(dart.edge());
        if net.graph.get_node(head).is_some() {
            open.push(head);
        }
    }
}

/// Main streets and what grew in the cells as one graph. Cells share nodes of main streets only,
/// which they know by their place.
fn join(main: Network, local: Vec<Grown>) -> Graph<Vertex, Piece> {
    let mut graph = main.graph;
    let mut at: BTreeMap<GridPoint, NodeId> = graph.nodes().map(|(id, n)| (n.at, id)).collect();
    for street in local {
        let (Some(first), Some(last)) = (street.line.first(), street.line.last()) else { continue };
        let [a, b] = street.ends;
        let mut node = |p: GridPoint, vertex: Vertex, graph: &mut Graph<Vertex, Piece>| {
            *at.entry(p).or_insert_with(|| graph.add_node(p, vertex))
        };
        let (from, to) = (node(*first, a, &mut graph), node(*last, b, &mut graph));
        graph.add_edge(from, to, street.line, street.piece);
    }
    graph
}
