//! Cells: what the main streets enclose. Local streets grow in each cell alone.
//!
//! A cell knows its border and nothing next door, so cells run on all cores and come out the same.
//! Streets of two cells meet at nodes of the main street between them only, and those nodes are made
//! before any cell begins: where the example has a side street, and every few metres besides.

use std::collections::BTreeMap;

use exurb_city::Origin;
use exurb_geom::{GridPoint, RowPolygon, Vec2, polyline};
use exurb_graph::{Dart, EdgeId, Face, Faces, Graph, NodeId, noding};
use exurb_operation::{Rng, Run, rng};
use rayon::prelude::*;

use super::claims::Claims;
use super::error::Error;
use super::fill;
use super::ground::Ground;
use super::growth::{Growth, Open, Place};
use super::layer::NodeKind;
use super::network::{Network, Piece, Standing, Vertex};
use super::plan::Plan;
use super::{synthesize, unreached};

/// Distance between the nodes of a main street where local streets may end.
const BERTH_M: f64 = 18.0;
/// Cells smaller than this stay empty.
const LEAST_AREA_M2: f64 = 2_000.0;

/// A local street grown in a cell.
pub struct Grown {
    /// Its line.
    pub line: Vec<GridPoint>,
    /// What it is.
    pub piece: Piece,
    /// Its ends.
    pub ends: [Vertex; 2],
}

/// Splits main streets where local ones may end later.
pub fn make_berths(net: &mut Network) {
    let edges = net.graph.edges().filter(|(_, e)| e.data.standing != Standing::Bridge);
    let edges: Vec<EdgeId> = edges.map(|(id, _)| id).collect();
    for id in edges {
        let line = net.graph.edge(id).line_m();
        let total = polyline::length(&line);
        let count = (total / BERTH_M).floor() as usize;
        let mut rest = id;
        for i in 1..count {
            let at = polyline::point_at(&line, total * i as f64 / count as f64);
            if net.split(rest, GridPoint::round(at)).is_some() {
                rest = EdgeId(net.graph.edge_bound() as u32 - 1);
            }
        }
    }
}

/// Grows local streets in every cell of `area` between the main streets of `main`.
pub fn grow(
    main: &Network,
    claims: &Claims,
    ground: &Ground,
    plan: &Plan,
    run: &Run,
) -> Result<Vec<Grown>, Error> {
    let area = &ground.area;
    let (graph, kinds) = border_graph(main, ground);
    let faces = Faces::of(&graph, |_| true);
    let at: BTreeMap<GridPoint, NodeId> = main.graph.nodes().map(|(id, n)| (n.at, id)).collect();
    let cells: Vec<&Face> = faces
        .list
        .iter()
        .filter(|f| f.polygon.area_m2() >= LEAST_AREA_M2)
        .filter(|f| area.contains(GridPoint::round(f.polygon.interior_point())))
        .collect();
    let has_main = main.graph.edges().next().is_some();
    let grown: Vec<Result<Vec<Grown>, Error>> = cells
        .par_iter()
        .map(|face| {
            let rng = cell_stream(face, run);
            let (net, seeds) = open_cell(main, &graph, &kinds, &at, face, plan, rng.clone());
            let claims = claims.window(&face.polygon);
            let mut growth =
                Growth::new(net, plan, false, &face.polygon, &ground.relief, claims, rng);
            growth.queue.extend(seeds);
            enter(&mut growth, ground);
            if !has_main {
                for start in &plan.starts {
                    synthesize::begin(&mut growth, start);
                }
            }
            growth.run(run)?;
            unreached::lay(&mut growth, run)?;
            let example = plan.example_at(face.polygon.interior_point());
            fill::fill(&mut growth, plan.examples[example].local.empty_m, run)?;
            Ok(harvest(&growth.net))
        })
        .collect();
    let mut out = Vec::new();
    for cell in grown {
        out.extend(cell?);
    }
    Ok(out)
}

/// Lets local streets of the city around a cell go on into it.
fn enter(growth: &mut Growth, ground: &Ground) {
    for (gate, line, street) in ground.local_gates(growth.area) {
        let Some(node) = growth.net.node_near(gate.to_m(), 0.001, None) else { continue };
        let far = growth
            .net
            .add_node(line[line.len() - 1], Vertex { outside: true, ..Vertex::default() });
        let piece = Piece { standing: Standing::Beyond, ..Piece::of(street) };
        growth.net.add_edge(node, far, line, piece);
        growth.frontier.push_back(Open::Node(node));
    }
}

fn cell_stream(face: &Face, run: &Run) -> Rng {
    let place = face.polygon.exterior().iter().min().copied().unwrap_or_default();
    run.stream(rng::place_key(place))
}

/// The main streets inside the area and the area's own edge as one planar graph, with a node at each
/// gate; for every edge the main street it is, or `None` on the edge of the area.
fn border_graph(
    main: &Network,
    ground: &Ground,
) -> (Graph<(), Option<EdgeId>>, Vec<Option<EdgeId>>) {
    let mut lines: Vec<noding::Line<Option<EdgeId>>> = main
        .graph
        .edges()
        .filter(|(_, e)| !matches!(e.data.standing, Standing::Rim | Standing::Beyond))
        .map(|(id, e)| noding::Line { points: e.line().to_vec(), level: 0, data: Some(id) })
        .collect();
    let rim = ground.border().into_iter();
    lines.extend(rim.map(|points| noding::Line { points, level: 0, data: None }));
    let mut graph = Graph::new();
    let mut at = BTreeMap::new();
    for line in noding::node(lines, noding::Options::default()) {
        let mut node = |p: GridPoint, g: &mut Graph<(), Option<EdgeId>>| {
            *at.entry(p).or_insert_with(|| g.add_node(p, ()))
        };
        let (first, last) = (line.points[0], line.points[line.points.len() - 1]);
        let (a, b) = (node(first, &mut graph), node(last, &mut graph));
        graph.add_edge(a, b, line.points, line.data);
    }
    let kinds = (0..graph.edge_bound()).map(|i| graph.edge(EdgeId(i as u32)).data).collect();
    (graph, kinds)
}

/// The cell's border as a network, and the places where its local streets begin.
fn open_cell(
    main: &Network,
    graph: &Graph<(), Option<EdgeId>>,
    kinds: &[Option<EdgeId>],
    at: &BTreeMap<GridPoint, NodeId>,
    face: &Face,
    plan: &Plan,
    mut rng: Rng,
) -> (Network, Vec<Place>) {
    let example = plan.example_at(face.polygon.interior_point());
    let street_m = plan.statistics(example, false).length_mean_m;
    let mut net = Network::new(street_m);
    let mut local: BTreeMap<NodeId, NodeId> = BTreeMap::new();
    let mut border: Vec<NodeId> = Vec::new();
    let outline = face.outline.iter().chain(face.islands.iter().flatten());
    let darts: Vec<Dart> = outline.copied().chain(face.inner.iter().map(|e| e.forward())).collect();
    for dart in &darts {
        let mut node = |n: NodeId, net: &mut Network, border: &mut Vec<NodeId>| {
            *local.entry(n).or_insert_with(|| {
                let place = graph.node(n).at;
                let vertex = match at.get(&place) {
                    Some(original) => main.graph.node(*original).data.clone(),
                    None => Vertex { outside: true, ..Vertex::default() },
                };
                let id = net.add_node(place, vertex);
                border.push(id);
                id
            })
        };
        let edge = graph.edge(dart.edge());
        let (from, to) = (edge.from, edge.to);
        let ends = [node(from, &mut net, &mut border), node(to, &mut net, &mut border)];
        let piece = match kinds[dart.edge().index()] {
            Some(id) => Piece { standing: Standing::Main, ..main.graph.edge(id).data.clone() },
            None => Piece::standing(Standing::Rim),
        };
        net.add_edge(ends[0], ends[1], edge.line().to_vec(), Piece { batch: 0, ..piece });
    }

    let mut places = Vec::new();
    let inside = RowPolygon::new(&face.polygon);
    for &node in &border {
        branches(&net, node, &inside, plan, &mut places);
    }
    spaced(&net, face, graph, &local, street_m.max(30.0), &mut rng, &mut places);
    (net, places)
}

/// The example's own side streets at `node` that lead into the cell (Nishida et al. 2015, 4.4).
fn branches(
    net: &Network,
    node: NodeId,
    inside: &RowPolygon,
    plan: &Plan,
    places: &mut Vec<Place>,
) {
    let n = net.graph.node(node);
    let (Some(link), Some(piece)) = (n.data.link, n.data.piece) else { return };
    let layer = &plan.examples[piece.example].local.layer;
    let Some(own) = layer.of_example[link.index()] else { return };
    if layer.nodes[own].kind != NodeKind::OnMain {
        return;
    }
    for &end in &layer.nodes[own].ends {
        let ahead = n.at.to_m() + piece.motion.apply(layer.direction(end)) * 5.0;
        if inside.contains(GridPoint::round(ahead)) {
            places.push(Place::Branch(node, end));
        }
    }
}

/// Side streets along what grew without a patch, spaced by the statistics (4.4).
fn spaced(
    net: &Network,
    face: &Face,
    graph: &Graph<(), Option<EdgeId>>,
    local: &BTreeMap<NodeId, NodeId>,
    mean_m: f64,
    rng: &mut Rng,
    places: &mut Vec<Place>,
) {
    use rand::RngExt;
    let mut wait_m = mean_m * 0.5;
    for dart in &face.outline {
        let tail = local[&graph.tail(*dart)];
        let head = local[&graph.head(*dart)];
        let edge = net.graph.darts(tail).iter().find(|d| net.graph.head(**d) == head);
        let Some(piece) = edge.map(|d| &net.graph.edge(d.edge()).data) else { continue };
        if piece.is_rim() || piece.street.provenance.origin == Origin::Example {
            continue;
        }
        wait_m -= graph.edge(dart.edge()).length_m();
        if wait_m <= 0.0 {
            let line = graph.dart_line_m(*dart);
            let direction = (line[line.len() - 1] - line[line.len() - 2]).normalize_or(Vec2::X);
            places.push(Place::Away(head, direction.perp()));
            wait_m = mean_m * rng.random_range(0.6..1.4);
        }
    }
}

/// What grew in a cell.
fn harvest(net: &Network) -> Vec<Grown> {
    net.graph
        .edges()
        .filter(|(_, e)| e.data.standing == Standing::Grown)
        .map(|(_, e)| Grown {
            line: e.line().to_vec(),
            piece: e.data.clone(),
            ends: [e.from, e.to].map(|n| net.graph.node(n).data.clone()),
        })
        .collect()
}
