//! Laws of the network inside the target: connected, few islands, stars and stubs.

use exurb_geom::GridPoint;
use exurb_graph::{EdgeId, NodeId};

use super::{Breach, LawReport, inside::Inside};

/// Streets under this length are stubs, in metres.
const SHORT_M: f64 = 5.0;
/// Junctions of this degree are rare in any city.
const STAR_DEGREE: usize = 6;

pub fn add_laws(report: &mut LawReport, inside: &Inside) {
    let components = Components::of(inside);
    let share = |m: f64| (components.total_m > 0.0).then(|| m / components.total_m);
    let largest_m = components.list.first().map_or(0.0, |c| c.length_m);
    let apart = |c: &Component| component_breach(inside, "largest_component_share", c);
    let others = components.list.iter().skip(1).map(apart).collect();
    report.at_least("largest_component_share", share(largest_m), 0.98, others);
    let islands: Vec<&Component> = components.islands().collect();
    let island_m = islands.iter().fold(0.0, |sum, c| sum + c.length_m);
    let found = islands.iter().map(|c| component_breach(inside, "island_share", c)).collect();
    report.at_most("island_share", share(island_m), 0.005, found);
    stars(report, inside);
    stubs(report, inside);
}

fn stars(report: &mut LawReport, inside: &Inside) {
    let junctions: Vec<NodeId> =
        inside.own_nodes().filter(|n| inside.graph.degree(*n) >= 3).collect();
    let stars: Vec<Breach> = junctions
        .iter()
        .filter(|n| inside.graph.degree(**n) >= STAR_DEGREE)
        .filter_map(|n| {
            let message = format!("{} streets meet here", inside.graph.degree(*n));
            let edge = *inside.graph.darts(*n).first()?;
            let street = inside.graph.edge(edge.edge()).data;
            Some(breach("degree_6_share", street, inside.graph.node(*n).at, message))
        })
        .collect();
    let share = (!junctions.is_empty()).then(|| stars.len() as f64 / junctions.len() as f64);
    report.at_most("degree_6_share", share, 0.004, stars);
}

fn stubs(report: &mut LawReport, inside: &Inside) {
    let whole = || inside.graph.edges().filter(|(id, _)| !inside.is_cut_edge(*id));
    let stubs: Vec<Breach> = whole()
        .filter(|(_, e)| e.length_m() < SHORT_M)
        .map(|(_, e)| {
            let message = format!("is {:.1} m long", e.length_m());
            breach("short_edge_share", e.data, e.line()[0], message)
        })
        .collect();
    let count = whole().count();
    let share = (count > 0).then(|| stubs.len() as f64 / count as f64);
    report.at_most("short_edge_share", share, 0.03, stubs);
}

fn breach(law: &'static str, street: EdgeId, at: GridPoint, message: String) -> Breach {
    Breach { law, layer: "streets", id: street.0 + 1, at, message }
}

fn component_breach(inside: &Inside, law: &'static str, component: &Component) -> Breach {
    let edge = inside.graph.edge(component.first);
    let message = format!("begins {:.0} m of streets apart from the rest", component.length_m);
    breach(law, edge.data, edge.line()[0], message)
}

/// A connected part of the network.
pub struct Component {
    pub length_m: f64,
    first: EdgeId,
    touches_border: bool,
}

/// The connected parts, longest first.
pub struct Components {
    pub list: Vec<Component>,
    pub total_m: f64,
}

impl Components {
    pub fn of(inside: &Inside) -> Self {
        let graph = &inside.graph;
        let mut seen = vec![false; graph.node_bound()];
        let mut list = Vec::new();
        for (first, edge) in graph.edges() {
            if seen[edge.from.index()] {
                continue;
            }
            let mut component = Component { length_m: 0.0, first, touches_border: false };
            let mut open = vec![edge.from];
            seen[edge.from.index()] = true;
            while let Some(node) = open.pop() {
                component.touches_border |= inside.is_cut(node);
                for dart in graph.darts(node) {
                    // Either end of an edge brings one half of it.
                    component.length_m += graph.edge(dart.edge()).length_m() / 2.0;
                    let head = graph.head(*dart);
                    if !std::mem::replace(&mut seen[head.index()], true) {
                        open.push(head);
                    }
                }
            }
            list.push(component);
        }
        list.sort_by(|a, b| b.length_m.total_cmp(&a.length_m).then(a.first.cmp(&b.first)));
        let total_m = list.iter().map(|c| c.length_m).sum();
        Self { list, total_m }
    }

    /// Parts that touch neither the border nor the largest part.
    fn islands(&self) -> impl Iterator<Item = &Component> {
        self.list.iter().skip(1).filter(|c| !c.touches_border)
    }
}
