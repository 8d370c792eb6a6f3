//! What an example teaches: its patches, its statistics, where growth may begin.

use std::collections::{BTreeMap, VecDeque};

use exurb_city::street_graph::StreetGraph;
use exurb_city::{City, Role, block};
use exurb_geom::{GridPoint, LonLat, PointGrid, Polygon, SegmentIndex, Vec2, polyline};
use exurb_graph::{EdgeId, Faces, NodeId};
use exurb_measure::statistics::{StreetStatistics, street_statistics};

use super::character::Character;
use super::error::Error;
use super::extent::Extent;
use super::fit::Samples;
use super::layer::{ChainEnd, Layer};
use super::params::{self, Params};
use super::patch::{self, Patch};
use super::polish::Profile;
use super::{detect, fill, prepare};

/// Ground of an example farther than this from every street is sea or country that no piece brings
/// along, in metres.
const BROUGHT_M: f64 = 200.0;

/// What one example teaches.
#[derive(Debug)]
pub struct Vocabulary {
    /// What it is like as a whole.
    pub character: Character,
    /// Main streets.
    pub main: Style,
    /// Local streets.
    pub local: Style,
    /// Points along all its streets.
    pub samples: Samples,
    /// The ground it covers.
    pub extent: Extent,
    /// Where growth begins in the example unless told otherwise.
    pub center: Vec2,
    /// Side of a square as large as a large block, metres: half of the ground lies in smaller ones.
    pub large_block_m: f64,
    /// Values of the example's likeness gates.
    pub gates: BTreeMap<String, f64>,
    /// What its streets and junctions are like, for the finish.
    pub profile: Profile,
}

/// One layer of an example with its patches and statistics.
#[derive(Debug)]
pub struct Style {
    /// Nodes and chains.
    pub layer: Layer,
    /// The patches.
    pub patches: Vec<Patch>,
    /// The layer's nodes by place.
    pub places: PointGrid,
    /// Every connector, for drawing the next patch.
    pub connectors: Connectors,
    /// Mean and variance of length and curvature.
    pub statistics: StreetStatistics,
    /// Half of what most blocks between these streets (for local ones: all streets) are wide, metres.
    pub spacing_m: f64,
    /// A place farther from these streets (for local ones: from all streets) is empty. Metres.
    pub empty_m: f64,
}

/// Connectors by the displacement from their tip to their root, so that those that could continue a
/// given street are found without looking at all.
#[derive(Debug, Default)]
pub struct Connectors {
    /// The connectors.
    pub list: Vec<Connector>,
    cells: BTreeMap<(i32, i32), Vec<u32>>,
}

/// A connector: how it arrives at its root, sampled.
#[derive(Debug)]
pub struct Connector {
    /// The patch it belongs to.
    pub patch: usize,
    /// The connector as seen from its root.
    pub end: ChainEnd,
    /// Points from the tip, relative to it, [`SAMPLES`] of them; the last is the root.
    pub shape: Vec<Vec2>,
}

/// Points that describe the shape of a connector.
pub const SAMPLES: usize = 9;
/// Connectors longer than this are compared by their last part only.
const COMPARED_M: f64 = 400.0;
const CELL_M: f64 = 40.0;

/// The last [`COMPARED_M`] of a line that arrives somewhere, as [`SAMPLES`] points relative to the
/// first.
pub fn arriving_shape(line: &[Vec2]) -> Vec<Vec2> {
    let total = polyline::length(line);
    let start = (total - COMPARED_M).max(0.0);
    let origin = polyline::point_at(line, start);
    (0..SAMPLES)
        .map(|i| {
            let along = start + (total - start) * i as f64 / (SAMPLES - 1) as f64;
            polyline::point_at(line, along) - origin
        })
        .collect()
}

impl Connectors {
    fn of(layer: &Layer, patches: &[Patch]) -> Self {
        let mut out = Self::default();
        for (number, patch) in patches.iter().enumerate() {
            for &end in &patch.outer {
                if patch::is_dead_end(layer, end) {
                    continue;
                }
                let shape = arriving_shape(&layer.line(end.reversed()));
                let cell = Self::cell(shape[SAMPLES - 1]);
                out.cells.entry(cell).or_default().push(out.list.len() as u32);
                out.list.push(Connector { patch: number, end, shape });
            }
        }
        out
    }

    fn cell(chord: Vec2) -> (i32, i32) {
        ((chord.x / CELL_M).floor() as i32, (chord.y / CELL_M).floor() as i32)
    }

    /// At least `wanted` connectors (all, if there are fewer) with chords near `chord`: rings of
    /// cells around it until enough are found.
    pub fn near(&self, chord: Vec2, wanted: usize) -> Vec<u32> {
        let (x, y) = Self::cell(chord);
        let mut out = Vec::new();
        for ring in 0..=(COMPARED_M / CELL_M) as i32 * 2 {
            for dy in -ring..=ring {
                for dx in -ring..=ring {
                    if dx.abs().max(dy.abs()) == ring
                        && let Some(list) = self.cells.get(&(x + dx, y + dy))
                    {
                        out.extend(list);
                    }
                }
            }
            if out.len() >= wanted {
                break;
            }
        }
        out
    }
}

/// Learns from one example city.
pub fn learn(city: &City, params: &Params) -> Result<Vocabulary, Error> {
    let name = city.metadata.name.clone();
    if city.streets.edge_count() == 0 {
        return Err(Error::NoStreets(name.to_string()));
    }
    let graph = prepare::learnable(&city.streets, &city.buildings);
    if graph.edge_count() < 3 {
        return Err(Error::NoStreets(name.to_string()));
    }
    let is_main = main_edges(&graph);
    let polygons = kept_polygons(city, params)?;
    let built_up = fill::built_up(&city.target, &street_index(&graph, |_| true));
    let style = |role: Role| {
        let mut layer = Layer::of(&graph, role, &is_main);
        let (circle_m, reach_m, word) = match role {
            Role::Main => (params.main_circle, params.main_reach, "main"),
            _ => (params.local_circle, params.local_reach, "local"),
        };
        let kept = |layer: &Layer| detect::kept(layer, &polygons);
        let circles = |layer: &Layer| detect::circles(layer, circle_m);
        let patches = patch::extract(&mut layer, &[&kept, &circles], reach_m, word);
        let connectors = Connectors::of(&layer, &patches);
        let statistics = street_statistics(&graph, role);
        let empty_m = match role {
            Role::Main => {
                let streets = street_index(&graph, |id| is_main[id.index()]);
                let off = |p: Vec2| streets.nearest_m(p, fill::FARTHEST_M / 2.0);
                let distances = built_up.iter().map(|(p, _)| off(*p).unwrap_or(fill::FARTHEST_M));
                fill::empty_distance_m(distances)
            }
            _ => fill::empty_distance_m(built_up.iter().map(|(_, distance)| *distance)),
        };
        let places: Vec<Vec2> = layer.nodes.iter().map(|node| node.at).collect();
        let places = PointGrid::new(&places, 100.0);
        let spacing_m = match role {
            Role::Main => spacing_m(&graph, |id| is_main[id.index()]),
            _ => spacing_m(&graph, |_| true),
        };
        Style { layer, patches, places, connectors, statistics, spacing_m, empty_m }
    };
    let (main, local) = (style(Role::Main), style(Role::Local));
    if main.patches.is_empty() && local.patches.is_empty() {
        return Err(Error::NoPatch(name.to_string()));
    }
    let gates = exurb_city::laws::gates(city);
    let (center, large_block_m) = (center_of(&graph), large_block_m(&graph));
    let samples = Samples::of(graph.edges().map(|(id, e)| (e.line_m(), is_main[id.index()])));
    let lines = graph.edges().map(|(_, edge)| edge.line_m());
    let extent = Extent::of(&city.target, lines, BROUGHT_M);
    Ok(Vocabulary {
        extent,
        character: Character::of(city, 1.0),
        main,
        local,
        samples,
        center,
        large_block_m,
        gates,
        profile: Profile::of(&graph),
    })
}

/// Half of the mean width that three quarters of the blocks between these streets have at least.
fn spacing_m(graph: &StreetGraph, keep: impl Fn(EdgeId) -> bool) -> f64 {
    let faces = Faces::of(graph, keep).list;
    let mut widths: Vec<f64> = faces.iter().map(|f| f.polygon.mean_width_m()).collect();
    widths.retain(|width| *width >= block::ISLAND_WIDTH_M);
    widths.sort_by(f64::total_cmp);
    widths.get(widths.len() / 4).map_or(0.0, |width| width / 2.0)
}

/// Side of a square as large as a large block: half of the ground of blocks that are no islands lies in
/// smaller ones.
fn large_block_m(graph: &StreetGraph) -> f64 {
    let faces = Faces::of(graph, |_| true).list;
    let blocks = faces.iter().filter(|f| f.polygon.mean_width_m() >= block::ISLAND_WIDTH_M);
    let mut areas: Vec<f64> = blocks.map(|f| f.polygon.area_m2()).collect();
    areas.sort_by(f64::total_cmp);
    let total: f64 = areas.iter().sum();
    let mut sum = 0.0;
    let large = areas.into_iter().find(|area| {
        sum += area;
        sum >= total / 2.0
    });
    large.map_or(0.0, f64::sqrt)
}

fn street_index(graph: &StreetGraph, keep: impl Fn(EdgeId) -> bool) -> SegmentIndex {
    let mut index = SegmentIndex::new(60.0);
    for (id, edge) in graph.edges().filter(|(id, _)| keep(*id)) {
        index.insert_line(id.0, &edge.line_m());
    }
    index
}

/// Which edges are grown in the main pass: streets of role main, and the local streets that tie
/// their pieces together, without which growth from one place could not reach them all.
fn main_edges(graph: &StreetGraph) -> Vec<bool> {
    let mut main = vec![false; graph.edge_bound()];
    for (id, edge) in graph.edges() {
        main[id.index()] = edge.data.role() == Role::Main;
    }
    let mut piece = pieces(graph, &main);
    let count = piece.iter().flatten().copied().max().map_or(0, |m| m + 1);
    if count < 2 {
        return main;
    }
    // Grow shortest paths out of the largest piece; where they reach another piece, the path joins.
    let mut size = vec![0.0; count];
    for (id, edge) in graph.edges().filter(|(id, _)| main[id.index()]) {
        if let Some(p) = piece[graph.tail(id.forward()).index()] {
            size[p] += edge.length_m();
        }
    }
    let largest = (0..count).max_by(|a, b| size[*a].total_cmp(&size[*b]).then(b.cmp(a)));
    let Some(home) = largest else { return main };
    let mut heap = std::collections::BTreeSet::new();
    let mut best = vec![u64::MAX; graph.node_bound()];
    let mut back: Vec<Option<exurb_graph::Dart>> = vec![None; graph.node_bound()];
    for (node, _) in graph.nodes().filter(|(n, _)| piece[n.index()] == Some(home)) {
        best[node.index()] = 0;
        heap.insert((0, node));
    }
    while let Some((cost, node)) = heap.pop_first() {
        if cost > best[node.index()] {
            continue;
        }
        if let Some(other) = piece[node.index()].filter(|p| *p != home) {
            let mut at = node;
            while let Some(dart) = back[at.index()] {
                main[dart.edge().index()] = true;
                at = graph.tail(dart);
                piece[at.index()] = Some(home);
                best[at.index()] = 0;
            }
            let joined: Vec<NodeId> =
                graph.nodes().map(|(n, _)| n).filter(|n| piece[n.index()] == Some(other)).collect();
            for reached in joined {
                piece[reached.index()] = Some(home);
                best[reached.index()] = 0;
                back[reached.index()] = None;
                heap.insert((0, reached));
            }
            continue;
        }
        for &dart in graph.darts(node) {
            let head = graph.head(dart);
            let next = cost + (graph.edge(dart.edge()).length_m() * 1000.0) as u64;
            if next < best[head.index()] {
                best[head.index()] = next;
                back[head.index()] = Some(dart);
                heap.insert((next, head));
            }
        }
    }
    main
}

/// Connected pieces of the marked edges: a number per node that one of them touches.
fn pieces(graph: &StreetGraph, main: &[bool]) -> Vec<Option<usize>> {
    let mut piece = vec![None; graph.node_bound()];
    let mut count = 0;
    let touches = |n: NodeId| graph.darts(n).iter().any(|d| main[d.edge().index()]);
    for (start, _) in graph.nodes() {
        if piece[start.index()].is_some() || !touches(start) {
            continue;
        }
        let mut queue = VecDeque::from([start]);
        piece[start.index()] = Some(count);
        while let Some(node) = queue.pop_front() {
            for dart in graph.darts(node).iter().filter(|d| main[d.edge().index()]) {
                let head = graph.head(*dart);
                if piece[head.index()].is_none() {
                    piece[head.index()] = Some(count);
                    queue.push_back(head);
                }
            }
        }
        count += 1;
    }
    piece
}

/// Centre of gravity of the streets.
fn center_of(graph: &StreetGraph) -> Vec2 {
    let (mut sum, mut total) = (Vec2::ZERO, 0.0);
    for (_, edge) in graph.edges() {
        let line = edge.line_m();
        let length = edge.length_m();
        sum += polyline::point_at(&line, length / 2.0) * length;
        total += length;
    }
    sum / total
}

fn kept_polygons(city: &City, params: &Params) -> Result<Vec<Polygon>, Error> {
    params
        .keep
        .iter()
        .map(|text| {
            let ring = params::parse_ring(text).map_err(Error::Params)?;
            let points: Option<Vec<GridPoint>> = ring
                .into_iter()
                .map(|(lon, lat)| city.frame.project_to_grid(LonLat { lon, lat }))
                .collect();
            points
                .and_then(|p| Polygon::new(p, Vec::new()))
                .ok_or_else(|| Error::Params(format!("`keep` is `{text}`, a ring without area")))
        })
        .collect()
}

impl Style {
    /// The layer's nodes that can begin growth, nearest to `p` first: junctions in patches, of three
    /// streets and more before others.
    pub fn starts_near(&self, p: Vec2) -> Vec<usize> {
        let nodes = &self.layer.nodes;
        let mut starts: Vec<usize> =
            (0..nodes.len()).filter(|n| nodes[*n].patch.is_some()).collect();
        starts.sort_by(|a, b| {
            let few = |n: usize| nodes[n].ends.len() < 3;
            let distance = nodes[*a].at.distance(p).total_cmp(&nodes[*b].at.distance(p));
            few(*a).cmp(&few(*b)).then(distance).then(a.cmp(b))
        });
        starts
    }
}
