//! Streets as every learner, synthesiser and measure sees them: planar but for bridges and tunnels,
//! undirected, nodes where streets meet, end or change level or class.

use std::collections::HashMap;
use std::sync::Arc;

use exurb_geom::{GridPoint, Polygon};
use exurb_graph::{Dart, EdgeId, Graph, NodeId, noding};

use crate::{Class, Origin, Provenance, Role, StreetMap};

/// What is known of a street.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Street {
    /// OSM class.
    pub class: Class,
    /// Hierarchy level, 0 = main (Aliaga 2008, section 5).
    pub level: u8,
    /// Lanes in both directions together; 0 = unknown.
    pub lanes: u8,
    /// Width of the carriageway in metres; 0 = unknown. See [`Street::width_m`]. On an imported map no
    /// more than the facades beside it leave room for.
    pub width_m: f64,
    /// Driven along the line only.
    pub oneway: bool,
    /// On a bridge.
    pub bridge: bool,
    /// In a tunnel.
    pub tunnel: bool,
    /// Storey, 0 on the ground (OSM's `layer`).
    pub layer: i8,
    /// Part of a roundabout.
    pub roundabout: bool,
    /// Its name.
    pub name: Option<Arc<str>>,
    /// Where it came from.
    pub provenance: Provenance,
}

impl Street {
    /// Its role.
    pub fn role(&self) -> Role {
        self.class.role()
    }

    /// Lanes, by tag or class.
    pub fn lanes(&self) -> u8 {
        match self.lanes {
            0 if self.oneway => self.class.default_lanes().div_ceil(2),
            0 => self.class.default_lanes(),
            n => n,
        }
    }

    /// Width of the carriageway in metres, by tag, else lanes and class.
    pub fn width_m(&self) -> f64 {
        if self.width_m > 0.0 { self.width_m } else { self.class.default_width_m(self.lanes()) }
    }

    /// Streets cross without meeting when their levels differ. Bridges and tunnels without a
    /// `layer` stand one level over and under the ground.
    pub fn crossing_level(&self) -> i32 {
        match (self.layer, self.bridge, self.tunnel) {
            (0, true, false) => 1,
            (0, false, true) => -1,
            (layer, ..) => i32::from(layer),
        }
    }

    /// May a node of degree 2 between the two streets be dissolved?
    pub fn continues(&self, other: &Self) -> bool {
        self.class == other.class
            && self.crossing_level() == other.crossing_level()
            && self.bridge == other.bridge
            && self.tunnel == other.tunnel
            && self.roundabout == other.roundabout
            && self.provenance.origin == other.provenance.origin
    }
}

/// What is known of a node of the street graph.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Junction {
    /// The street runs on outside the modelled area: no dead end.
    pub cut: bool,
    /// Height above the terrain's zero in metres.
    pub z_m: f64,
}

/// The street graph of a city.
pub type StreetGraph = Graph<Junction, Street>;

/// How a street graph is derived from an imported map.
#[derive(Clone, Debug)]
pub struct Derive {
    /// Keep service roads and the like, too.
    pub with_other: bool,
    /// The map is complete inside this area; streets are clipped to it and cut ends flagged.
    pub area: Option<Polygon>,
}

/// Derives the street graph of an imported map.
///
/// Steps: 1 filter by role; 2 node ways of one level at every shared node and crossing, and where a
/// vertex lies within 2 cm of another street (bridges and tunnels pass); 3 drop exact duplicates;
/// 4 make nodes where ends meet; 5 clip; 6 dissolve nodes of degree 2 between like streets.
pub fn derive(map: &StreetMap, options: &Derive) -> StreetGraph {
    let kept = || map.ways.iter().filter(|w| options.with_other || w.street.role() != Role::Other);
    // 2 Ways of different levels meet at shared nodes that are an end of one of them: the foot of a
    // ramp. Split there first; crossings within a level follow.
    let mut shared: Vec<i64> = kept().flat_map(|w| w.nodes.iter().copied()).collect();
    shared.sort_unstable();
    shared = shared.chunk_by(|a, b| a == b).filter(|same| same.len() > 1).map(|s| s[0]).collect();
    let mut lines = Vec::new();
    for (number, way) in kept().enumerate() {
        let level = way.street.crossing_level();
        let mut start = 0;
        for i in 1..way.line.len() {
            let is_shared = way.nodes.get(i).is_some_and(|id| shared.binary_search(id).is_ok());
            if is_shared || i + 1 == way.line.len() {
                let points = way.line[start..=i].to_vec();
                lines.push(noding::Line { points, level, data: number });
                start = i;
            }
        }
    }
    let noded = noding::node(lines, noding::Options { snap_m: 0.02, ..Default::default() });

    let streets: Vec<&Street> = kept().map(|w| &w.street).collect();
    let mut graph = from_lines(noded.into_iter().map(|l| (l.points, streets[l.data].clone())));
    if let Some(area) = &options.area {
        for node in graph.clip(area) {
            graph.node_mut(node).data.cut = true;
        }
    }
    dissolve_all(&mut graph);
    graph.into_compacted()
}

/// A graph of lines that meet at equal end points; exact duplicates (same line, either direction)
/// are dropped, the first one stays.
pub fn from_lines(lines: impl IntoIterator<Item = (Vec<GridPoint>, Street)>) -> StreetGraph {
    let mut graph = StreetGraph::new();
    let mut at: HashMap<GridPoint, NodeId> = HashMap::new();
    for (line, street) in lines {
        let (Some(first), Some(last)) = (line.first().copied(), line.last().copied()) else {
            continue;
        };
        let mut node = |p, g: &mut StreetGraph| {
            *at.entry(p).or_insert_with(|| g.add_node(p, Junction::default()))
        };
        let (from, to) = (node(first, &mut graph), node(last, &mut graph));
        let is_same = |dart: &Dart| {
            let known = graph.edge(dart.edge()).line();
            known == line || (known.len() == line.len() && known.iter().rev().eq(&line))
        };
        if !graph.darts(from).iter().any(is_same) {
            graph.add_edge(from, to, line, street);
        }
    }
    graph.remove_isolated_nodes();
    graph
}

/// Dissolves every node of degree 2 between streets that continue each other. Cut ends stay. What
/// does not make a node, such as lanes and width, is that of the longer of the two.
pub fn dissolve_all(graph: &mut StreetGraph) {
    let nodes: Vec<NodeId> = graph.nodes().map(|(id, _)| id).collect();
    for node in nodes {
        let [a, b] = graph.darts(node) else { continue };
        let (a, b) = (*a, *b);
        let (s, t) = (graph.edge(a.edge()), graph.edge(b.edge()));
        if !graph.node(node).data.cut && s.data.continues(&t.data) && same_direction(graph, a, b) {
            let longer = if s.length_m() >= t.length_m() { &s.data } else { &t.data }.clone();
            if let Some(joined) = graph.dissolve(node) {
                graph.edge_mut(joined).data = longer;
            }
        }
    }
}

/// Two oneways meeting head to head must stay apart.
fn same_direction(graph: &StreetGraph, a: exurb_graph::Dart, b: exurb_graph::Dart) -> bool {
    let (s, t) = (&graph.edge(a.edge()).data, &graph.edge(b.edge()).data);
    s.oneway == t.oneway && (!s.oneway || a.is_forward() != b.is_forward())
}

/// The part of the graph whose edges `keep` accepts, with nodes of degree 2 dissolved.
pub fn subgraph(graph: &StreetGraph, keep: impl Fn(EdgeId, &Street) -> bool) -> StreetGraph {
    let mut out = graph.clone();
    for (id, edge) in graph.edges() {
        if !keep(id, &edge.data) {
            out.remove_edge(id);
        }
    }
    out.remove_isolated_nodes();
    dissolve_all(&mut out);
    out.compacted()
}

/// Dead ends this near the border of an area were cut there, whether they say so or not, in metres.
const BORDER_M: f64 = 1.0;

/// Marks the ends within a metre of the area's border as cut.
pub fn mark_ends_on_border<E: Clone>(graph: &mut Graph<Junction, E>, area: &Polygon) {
    let ends: Vec<NodeId> = graph
        .nodes()
        .filter(|(id, node)| {
            graph.degree(*id) == 1
                && !node.data.cut
                && area.boundary_distance_m(node.at.to_m()) < BORDER_M
        })
        .map(|(id, _)| id)
        .collect();
    for id in ends {
        graph.node_mut(id).data.cut = true;
    }
}

/// Is the node an intersection: not of degree 2? (Dead ends and cut ends are, changes of layer or
/// class are not.)
pub fn is_intersection(graph: &StreetGraph, node: NodeId) -> bool {
    graph.degree(node) != 2
}

/// Share of the graph's length by origin: (example, procedural, other); zeros when empty.
pub fn shares_by_origin(graph: &StreetGraph) -> (f64, f64, f64) {
    let (mut example, mut procedural, mut other) = (0.0, 0.0, 0.0);
    for (_, edge) in graph.edges() {
        let length = edge.length_m();
        match edge.data.provenance.origin {
            Origin::Example => example += length,
            Origin::Procedural => procedural += length,
            _ => other += length,
        }
    }
    let total: f64 = example + procedural + other;
    if total == 0.0 {
        (0.0, 0.0, 0.0)
    } else {
        (example / total, procedural / total, other / total)
    }
}
