//! The pure core: starts, main streets, cells, local streets, finish.

use std::collections::BTreeMap;

use exurb_city::street_graph::StreetGraph;
use exurb_geom::GridPoint;
use exurb_graph::{EdgeId, Graph, NodeId};
use exurb_operation::Run;

use super::cells::{self, Grown};
use super::claims::Claims;
use super::error::Error;
use super::ground::Ground;
use super::growth::{Growth, Place};
use super::learn::Vocabulary;
use super::network::{Coherent, Network, Piece, Standing, Vertex};
use super::placing;
use super::plan::{Plan, Start};
use super::polish::{Profile, Weights};
use super::{bridges, fill, finish, oneways, polish, unreached};

/// Growth goes on beyond the target by a large block of the example, so that blocks at its edge close
/// and its edge looks like its middle; by no more and no less than this.
const MARGIN_M: std::ops::RangeInclusive<f64> = 90.0..=450.0;

/// The margin that growth needs around a target in the open.
pub fn margin_m(examples: &[Vocabulary]) -> f64 {
    let large_m = examples.iter().map(|e| e.large_block_m).fold(0.0, f64::max);
    large_m.clamp(*MARGIN_M.start(), *MARGIN_M.end())
}

/// Grows streets on that ground; the result holds those of the city around, too.
pub fn synthesize(ground: &Ground, plan: &Plan, run: &Run) -> Result<StreetGraph, Error> {
    run.phase("main streets");
    let (mut main, claims) = grow_main(ground, plan, run)?;
    if plan.params.remove_dangling {
        remove_open_ends(&mut main, plan);
    }
    cells::make_berths(&mut main);

    run.phase("local streets");
    let local = cells::grow(&main, &claims, ground, plan, run)?;

    run.phase("finish");
    let graph = join(main, local);
    let mut streets =
        finish::finish(graph, ground, dead_end_share(plan), plan.params.remove_dangling);
    if plan.params.polish {
        polish(&mut streets, ground, plan);
    }
    if streets.edge_count() == 0 {
        let area_km2 = ground.target.area_m2() / 1e6;
        return Err(Error::Nothing { starts: plan.starts.len(), area_km2 });
    }
    let mut streets = ground.whole(streets);
    let runs_on = |streets: &StreetGraph, node: NodeId| ground.runs_on(streets, node);
    oneways::open_traps(&mut streets, runs_on, |streets, id| ground.may_remove(streets, id.0));
    Ok(streets)
}

/// Local edits that bring the network nearer to the examples.
fn polish(streets: &mut StreetGraph, ground: &Ground, plan: &Plan) {
    let params = plan.params;
    let wanted = Profile::mixed(plan.shares().map(|(e, share)| (&e.profile, share)));
    let weights = Weights {
        lengths: params.lengths_weight,
        bends: params.bends_weight,
        junctions: params.junctions_weight,
        density: params.density_weight,
    };
    polish::polish(streets, &wanted, &weights, ground, |streets, id| {
        ground.may_remove(streets, id.0) && !streets.edge(id).data.bridge
    });
    ground.dissolve(streets);
    *streets = streets.compacted();
}

/// The share of dead ends to aim at: the mean of the examples' shares by their weights.
fn dead_end_share(plan: &Plan) -> Option<f64> {
    let (mut sum, mut total) = (0.0, 0.0);
    for example in plan.examples {
        sum += example.character.weight * example.gates.get("dead_end_share")?;
        total += example.character.weight;
    }
    (total > 0.0).then(|| sum / total)
}

fn grow_main(ground: &Ground, plan: &Plan, run: &Run) -> Result<(Network, Claims), Error> {
    let area = &ground.area;
    let first = plan.example_at(area.interior_point());
    let mut net = Network::new(plan.statistics(first, true).length_mean_m);
    ground.furnish(&mut net);
    let relief = &ground.relief;
    let claims = Claims::new(area, |p| relief.is_closed(p));
    let mut growth = Growth::new(net, plan, true, area, relief, claims, run.stream(0));
    ground.begin_main(&mut growth);
    for start in &plan.starts {
        begin(&mut growth, start);
    }
    growth.run(run)?;
    bridges::lay(&mut growth, run)?;
    unreached::lay(&mut growth, run)?;
    if growth.net.graph.edge_count() > 0 {
        fill::fill(&mut growth, plan.examples[first].main.empty_m, run)?;
    }
    growth.claims.share();
    Ok((growth.net, growth.claims))
}

/// Begins growth at a start: the first of the nearest junctions of the example whose patch can lie
/// there. The start's place in the target belongs to its place in the example, not to the junction
/// nearest to that.
pub fn begin(growth: &mut Growth, start: &Start) {
    const TRIES: usize = 24;
    let style = growth.style(start.example);
    let motion = growth.plan.motion_at(start.at, start.example);
    for own in style.starts_near(start.source).into_iter().take(TRIES) {
        let mut at = start.at + motion.apply(style.layer.nodes[own].at - start.source);
        if !growth.inside.contains(GridPoint::round(at)) {
            at = start.at;
        }
        let link = Some(style.layer.nodes[own].example);
        let source = style.layer.nodes[own].at;
        let piece = Coherent { source, ..growth.piece(start.example, at) };
        let vertex = Vertex { link, piece: Some(piece), ..Vertex::default() };
        let node = growth.net.add_node(GridPoint::round(at), vertex);
        if placing::continuation(growth, node, piece, own) {
            growth.begin(&piece);
            growth.queue.push_back(Place::Node(node));
            return;
        }
        growth.net.remove_lonely(node);
    }
}

/// Removes main streets that end where nothing goes on, in the example or here. A main street that
/// becomes a local one there keeps its end: the local street will grow from it.
fn remove_open_ends(net: &mut Network, plan: &Plan) {
    let mut open: Vec<NodeId> = net.graph.nodes().map(|(id, _)| id).collect();
    while let Some(node) = open.pop() {
        let Some(n) = net.graph.get_node(node) else { continue };
        let is_open = net.graph.degree(node) == 1
            && matches!(
                net.graph.edge(net.graph.darts(node)[0].edge()).data.standing,
                Standing::Grown | Standing::Bridge
            );
        if n.data.dead_end || n.data.outside || !is_open {
            continue;
        }
        let goes_on = n.data.link.zip(n.data.piece).is_some_and(|(link, piece)| {
            let example = &plan.examples[piece.example];
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
    let ids: Vec<EdgeId> = graph.edges().map(|(id, _)| id).collect();
    for id in ids {
        if matches!(graph.edge(id).data.standing, Standing::Rim | Standing::Beyond) {
            graph.remove_edge(id);
        }
    }
    graph.remove_isolated_nodes();
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
