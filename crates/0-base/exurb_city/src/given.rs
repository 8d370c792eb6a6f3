//! Streets that a user gives: they lie in the city before anything grows, and stay.

use std::sync::Arc;

use exurb_geom::{GridPoint, Polygon, polyline};
use exurb_graph::{EdgeId, NodeId, noding};

use crate::{City, Origin, Provenance, Role, Street, StreetGraph, street_graph};

/// Ends of given streets snap to ends of the city's streets within this, in metres.
const SNAP_M: f64 = 15.0;

/// Lays the main and local streets of `drawn`, in the city's frame, into `city` as [`Origin::Sketch`].
/// With an area, the streets that the city has there go first and only what lies in it is laid; ends
/// at its border join streets that were cut there. Where given streets cross, they get a junction.
/// Returns how many there are then.
pub fn lay_given(city: &mut City, drawn: &StreetGraph, area: Option<&Polygon>) -> usize {
    let kept = drawn.edges().filter(|(_, e)| e.data.role() != Role::Other);
    let lines: Vec<noding::Line<Street>> = kept
        .map(|(_, e)| {
            let data = Street { provenance: Provenance::of(Origin::Sketch), ..e.data.clone() };
            noding::Line { points: e.line().to_vec(), level: data.crossing_level(), data }
        })
        .collect();
    let noded = noding::node(lines, noding::Options { snap_m: 0.02, ..Default::default() });
    let mut given = street_graph::from_lines(noded.into_iter().map(|l| (l.points, l.data)));
    let mut streets = (*city.streets).clone();
    if let Some(area) = area {
        given.clip(area);
        empty(&mut streets, area);
        snap(&mut given, &streets, area);
    }
    let count = given.edge_count();
    let both =
        streets.edges().chain(given.edges()).map(|(_, e)| (e.line().to_vec(), e.data.clone()));
    let mut joined = street_graph::from_lines(both);
    // Ends that the city's border cut stay cut.
    for (_, node) in streets.nodes().filter(|(_, n)| n.data.cut) {
        let same = joined.nodes().find(|(_, n)| n.at == node.at).map(|(id, _)| id);
        if let Some(id) = same {
            joined.node_mut(id).data.cut = true;
        }
    }
    city.streets = Arc::new(joined);
    count
}

/// Removes the streets inside an area; those that cross its border are cut there.
fn empty(streets: &mut StreetGraph, area: &Polygon) {
    let mut is_outside = vec![false; streets.edge_bound()];
    let outside = streets.cut_along(area, |_| true).outside;
    is_outside.resize(streets.edge_bound(), false);
    for id in outside {
        is_outside[id.index()] = true;
    }
    let inside: Vec<EdgeId> =
        streets.edges().map(|(id, _)| id).filter(|id| !is_outside[id.index()]).collect();
    for id in inside {
        streets.remove_edge(id);
    }
    streets.remove_isolated_nodes();
}

/// Moves ends of given streets onto ends of the city's streets at the border of the area.
fn snap(given: &mut StreetGraph, streets: &StreetGraph, area: &Polygon) {
    let on_border = |p: GridPoint| area.boundary_distance_m(p.to_m()) < 0.01;
    let ends: Vec<GridPoint> =
        streets.nodes().map(|(_, n)| n.at).filter(|p| on_border(*p)).collect();
    let loose: Vec<NodeId> =
        given.nodes().map(|(id, _)| id).filter(|id| given.degree(*id) == 1).collect();
    for node in loose {
        let at = given.node(node).at;
        let nearest = ends.iter().min_by(|a, b| a.distance_m(at).total_cmp(&b.distance_m(at)));
        let Some(end) = nearest.filter(|end| end.distance_m(at) < SNAP_M) else { continue };
        let dart = given.darts(node)[0];
        let mut line = polyline::round(&given.dart_line_m(dart));
        line[0] = *end;
        if !dart.is_forward() {
            line.reverse();
        }
        given.node_mut(node).at = *end;
        given.set_line(dart.edge(), line);
    }
}
