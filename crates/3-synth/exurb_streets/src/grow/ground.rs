//! The ground streets grow on: the target, what is given there, and the city around.

use std::collections::BTreeSet;

use exurb_city::street_graph::{self, StreetGraph};
use exurb_city::{City, Junction, Origin, Role, Street};
use exurb_geom::{GridPoint, Polygon, offset, polyline};
use exurb_graph::{EdgeId, NodeId};

use super::growth::{Growth, Open};
use super::network::{Network, Piece, Standing, Vertex};
use super::params::Params;
use super::relief::Relief;

/// Streets of the city around are kept in view up to this far from the ground, in metres.
const AROUND_M: f64 = 120.0;

/// Places this near to the border lie on it: they were rounded to the grid.
const ON_BORDER_M: f64 = 0.002;

/// Where streets grow.
#[derive(Debug)]
pub struct Ground {
    /// What is asked for.
    pub target: Polygon,
    /// Where growth goes on: the target and a margin, or the target alone where a city lies around it.
    pub area: Polygon,
    /// Streets that stay as they are, and that growth begins from.
    pub given: StreetGraph,
    /// The city around.
    pub around: Option<Around>,
    /// Water and slopes.
    pub relief: Relief,
}

/// The city around a target inside it.
#[derive(Debug)]
pub struct Around {
    /// Its streets, cut at the target's border; what lay inside is gone.
    pub streets: StreetGraph,
    /// Where they end there: growth meets them at these places only.
    pub gates: BTreeSet<GridPoint>,
}

impl Ground {
    /// A target in the open, with the streets that the city holds as given.
    pub fn open(city: &City, target: &Polygon, margin_m: f64, params: &Params) -> Self {
        let given = street_graph::subgraph(&city.streets, |_, street| is_given(street));
        let grown = offset::inset(target, -margin_m).into_iter().next();
        let area = grown.unwrap_or_else(|| target.clone());
        let relief = Relief::of(city, params);
        Self { target: target.clone(), area, given, around: None, relief }
    }

    /// A part of a city that is emptied, but for what is given.
    pub fn inside(city: &City, target: &Polygon, params: &Params) -> Self {
        let mut streets = (*city.streets).clone();
        let cut = streets.cut_along(target, |_| true);
        let outside: BTreeSet<EdgeId> = cut.outside.into_iter().collect();
        let mut given = streets.clone();
        for id in streets.clone().edges().map(|(id, _)| id) {
            let is_inside = !outside.contains(&id);
            if !is_inside || !is_given(&streets.edge(id).data) {
                given.remove_edge(id);
            }
            if is_inside {
                streets.remove_edge(id);
            }
        }
        given.remove_isolated_nodes();
        streets.remove_isolated_nodes();
        // Also where streets had been cut before.
        let on_border = |p: GridPoint| target.boundary_distance_m(p.to_m()) < ON_BORDER_M;
        let gates = streets.nodes().map(|(_, n)| n.at).filter(|p| on_border(*p)).collect();
        let around = Some(Around { streets, gates });
        let relief = Relief::of(city, params);
        Self {
            target: target.clone(),
            area: target.clone(),
            given: given.compacted(),
            around,
            relief,
        }
    }

    /// Does growth begin from streets that are there?
    pub fn has_streets(&self) -> bool {
        let is_open = |around: &Around| !around.gates.is_empty();
        self.given.edge_count() > 0 || self.around.as_ref().is_some_and(is_open)
    }

    /// The network as it is before growth: given streets, the border that nothing crosses, and what
    /// lies beyond it.
    pub fn furnish(&self, net: &mut Network) {
        let mut at = std::collections::BTreeMap::new();
        let mut node = |net: &mut Network, p: GridPoint, vertex: Vertex| {
            *at.entry(p).or_insert_with(|| net.add_node(p, vertex))
        };
        for (_, edge) in self.given.edges() {
            let line = edge.line().to_vec();
            let ends = [line[0], line[line.len() - 1]].map(|p| node(net, p, Vertex::default()));
            let piece = Piece { standing: Standing::Given, ..Piece::of(edge.data.clone()) };
            net.add_edge(ends[0], ends[1], line, piece);
        }
        let Some(around) = &self.around else { return };
        let beyond = || Vertex { outside: true, ..Vertex::default() };
        for line in self.border() {
            let ends = [line[0], line[line.len() - 1]].map(|p| node(net, p, beyond()));
            net.add_edge(ends[0], ends[1], line, Piece::standing(Standing::Rim));
        }
        for (line, street) in self.near(around) {
            let ends = [line[0], line[line.len() - 1]].map(|p| node(net, p, beyond()));
            let piece = Piece { standing: Standing::Beyond, ..Piece::of(street) };
            net.add_edge(ends[0], ends[1], line, piece);
        }
    }

    /// The border of the area, in pieces between its corners and gates.
    pub fn border(&self) -> Vec<Vec<GridPoint>> {
        let gates: Vec<GridPoint> = self.around.iter().flat_map(|a| &a.gates).copied().collect();
        let mut pieces = Vec::new();
        for (a, b) in self.area.segments() {
            let mut points: Vec<GridPoint> = gates
                .iter()
                .copied()
                .filter(|p| *p != a && *p != b)
                .filter(|p| {
                    polyline::nearest_on_segment(a.to_m(), b.to_m(), p.to_m()).0.distance(p.to_m())
                        < ON_BORDER_M
                })
                .collect();
            points.sort_by(|p, q| p.distance_m(a).total_cmp(&q.distance_m(a)));
            points.insert(0, a);
            points.push(b);
            pieces.extend(points.windows(2).map(<[GridPoint]>::to_vec));
        }
        pieces
    }

    /// Streets of the city around that come near the border.
    fn near(&self, around: &Around) -> Vec<(Vec<GridPoint>, Street)> {
        let bounds = self.target.bounds().grown(AROUND_M);
        let edges = around.streets.edges().filter(|(_, e)| {
            exurb_geom::Bounds::of(e.line().iter().copied()).is_some_and(|b| b.intersects(bounds))
        });
        edges.map(|(_, e)| (e.line().to_vec(), e.data.clone())).collect()
    }

    /// Lets growth of main streets begin from what is there: at gates, and along given streets about
    /// as far apart as the example's main streets meet.
    pub fn begin_main(&self, growth: &mut Growth) {
        let mut along: Vec<EdgeId> = growth
            .net
            .graph
            .edges()
            .filter(|(_, e)| {
                e.data.standing == Standing::Given && e.data.street.role() == Role::Main
            })
            .map(|(id, _)| id)
            .collect();
        along.sort_unstable();
        for id in along {
            let line = growth.net.graph.edge(id).line_m();
            let total = polyline::length(&line);
            let from = growth.net.graph.edge(id).from;
            let step_m = growth.street_m(from).max(60.0);
            let count = (total / step_m).round() as usize;
            let mut rest = id;
            for i in 1..count {
                let at = polyline::point_at(&line, total * i as f64 / count as f64);
                if let Some(node) = growth.net.split(rest, GridPoint::round(at)) {
                    growth.frontier.push_back(Open::Node(node));
                    rest = EdgeId(growth.net.graph.edge_bound() as u32 - 1);
                }
            }
        }
        let ends: Vec<NodeId> = self.gates(&growth.net, Role::Main);
        growth.frontier.extend(ends.into_iter().map(Open::Node));
        let loose = growth
            .net
            .graph
            .nodes()
            .filter(|(id, n)| !n.data.outside && growth.net.graph.degree(*id) == 1);
        let loose: Vec<NodeId> = loose.map(|(id, _)| id).collect();
        growth.frontier.extend(loose.into_iter().map(Open::Node));
    }

    /// Nodes of the network at gates of streets of that role.
    pub fn gates(&self, net: &Network, role: Role) -> Vec<NodeId> {
        let Some(around) = &self.around else { return Vec::new() };
        let is_of_role = |node: NodeId| {
            net.graph.darts(node).iter().any(|dart| {
                let piece = &net.graph.edge(dart.edge()).data;
                piece.standing == Standing::Beyond && piece.street.role() == role
            })
        };
        net.graph
            .nodes()
            .filter(|(id, n)| around.gates.contains(&n.at) && is_of_role(*id))
            .map(|(id, _)| id)
            .collect()
    }

    /// Local streets of the city around that end at the border of a cell: the place, and the street from
    /// there.
    pub fn local_gates(&self, cell: &Polygon) -> Vec<(GridPoint, Vec<GridPoint>, Street)> {
        let Some(around) = &self.around else { return Vec::new() };
        let bounds = cell.bounds().grown(1.0);
        let mut found = Vec::new();
        for (_, edge) in around.streets.edges().filter(|(_, e)| e.data.role() == Role::Local) {
            let line = edge.line().to_vec();
            let reversed: Vec<GridPoint> = line.iter().rev().copied().collect();
            for line in [line, reversed] {
                let at = line[0];
                if around.gates.contains(&at)
                    && bounds.contains(at.to_m())
                    && cell.boundary_distance_m(at.to_m()) < 0.01
                {
                    found.push((at, line, edge.data.clone()));
                }
            }
        }
        found
    }

    /// May that street go? Those of the city around and given ones may not.
    pub fn may_remove(&self, streets: &StreetGraph, id: u32) -> bool {
        let edge = streets.edge(EdgeId(id));
        let middle = polyline::point_at(&edge.line_m(), edge.length_m() / 2.0);
        let is_inside = self.around.as_ref().is_none_or(|around| {
            let is_around = || around.streets.edges().any(|(_, other)| other.line() == edge.line());
            match self.target.boundary_distance_m(middle) < ON_BORDER_M {
                true => !is_around(),
                false => self.target.contains(GridPoint::round(middle)),
            }
        });
        is_inside && !is_given(&edge.data)
    }

    /// Does a street end there that runs on where there is no telling where to?
    pub fn runs_on(&self, streets: &StreetGraph, node: NodeId) -> bool {
        let here = streets.node(node);
        here.data.cut || (streets.degree(node) == 1 && !self.target.contains(here.at))
    }

    /// Streets of the city around get back the level that they had.
    pub fn restore_levels(&self, streets: &mut StreetGraph) {
        let Some(around) = &self.around else { return };
        let before: std::collections::BTreeMap<&[GridPoint], u8> =
            around.streets.edges().map(|(_, e)| (e.line(), e.data.level)).collect();
        let ids: Vec<EdgeId> = streets.edges().map(|(id, _)| id).collect();
        for id in ids {
            if let Some(level) = before.get(streets.edge(id).line()) {
                streets.edge_mut(id).data.level = *level;
            }
        }
    }

    /// The streets with those of the city around: they join at the gates.
    pub fn whole(&self, grown: StreetGraph) -> StreetGraph {
        let Some(around) = &self.around else { return grown };
        let mut streets = around.streets.clone();
        let mut at: std::collections::BTreeMap<GridPoint, NodeId> =
            streets.nodes().map(|(id, n)| (n.at, id)).collect();
        for (_, edge) in grown.edges() {
            let line = edge.line().to_vec();
            let mut node = |p: GridPoint, graph: &mut StreetGraph| {
                *at.entry(p).or_insert_with(|| graph.add_node(p, Junction::default()))
            };
            let ends = [line[0], line[line.len() - 1]].map(|p| node(p, &mut streets));
            streets.add_edge(ends[0], ends[1], line, edge.data.clone());
        }
        self.dissolve(&mut streets);
        streets.compacted()
    }

    /// Dissolves nodes of degree 2, but those of the city around.
    pub fn dissolve(&self, streets: &mut StreetGraph) {
        let Some(_) = &self.around else { return street_graph::dissolve_all(streets) };
        street_graph::dissolve_where(streets, |p| {
            self.target.contains(p) && self.target.boundary_distance_m(p.to_m()) > ON_BORDER_M
        });
    }
}

/// Does the street stay whatever grows?
fn is_given(street: &Street) -> bool {
    street.provenance.origin == Origin::Sketch
}
