//! A street graph without what only traffic needs: dual carriageways become one street, small
//! roundabouts become junctions.
//!
//! Steps: 1 roundabouts under 40 m shrink to their centre; 2 carriageways are split where a partner
//! begins or ends to run beside them; 3 stretches with a partner along most of their length are
//! marked; 4 every node on one carriageway gets its counterpart on the other, which is split there
//! if need be, and the two become one node half way between: the pair is zipped up station by
//! station, so that no sliver can stay between its halves; 5 the two edges between the same
//! stations become one, half way between, with the lanes and widths of both (the ground between the
//! kerbs is no carriageway and not counted); side streets are drawn on to it, and carriageways that
//! part are bent towards it over some distance; 6 crossings that the moves made become nodes.
//!
//! Nothing is disconnected. The idea of closing faces between carriageways is that of face artifacts
//! (Fleischmann, Vybornova 2024, *A shape-based heuristic for the detection of urban block artifacts
//! in street networks*); zipping by stations is our own. O(n log n).

mod circles;
mod pairing;
mod rebuild;
mod slivers;
mod stations;

use std::sync::Arc;

use crate::{Building, StreetGraph, street_graph};

/// What is simplified, and how far.
#[derive(Clone, Debug)]
pub struct Simplify {
    /// Carriageways nearer than this belong together. Metres, default 30.
    pub gap_m: f64,
    /// Roundabouts under this across become junctions. Metres, default 40.
    pub roundabout_m: f64,
    /// Leave roundabouts as they are, for methods that copy circles. Default false.
    pub keep_circles: bool,
    /// Also join main streets of one class that run side by side without being oneways, and shrink
    /// small circular blocks: for maps whose tags of oneways and roundabouts were lost. Default false.
    pub by_geometry: bool,
    /// Carriageways with one of these between them stay apart. Default none.
    pub buildings: Arc<Vec<Building>>,
}

impl Default for Simplify {
    fn default() -> Self {
        Self {
            gap_m: 30.0,
            roundabout_m: 40.0,
            keep_circles: false,
            by_geometry: false,
            buildings: Arc::default(),
        }
    }
}

/// The simplified graph. Cut ends stay cut ends; edges and nodes get new numbers.
pub fn simplify(graph: &StreetGraph, options: &Simplify) -> StreetGraph {
    let mut graph = graph.clone();
    if !options.keep_circles {
        graph = circles::shrink(&graph, options);
    }
    street_graph::dissolve_all(&mut graph);
    pairing::split_where_partners_change(&mut graph, options);
    let dual = pairing::mark_dual(&graph, options);
    let (graph, dual, groups) = stations::zip(graph, dual, options);
    let joined = rebuild::join(&graph, &dual, groups, options);
    slivers::close(&rebuild::node_again(&joined))
}

/// Does the map tell oneways? Where it does not, ask for joining by geometry.
pub fn knows_oneways(graph: &StreetGraph) -> bool {
    graph.edges().any(|(_, e)| e.data.oneway)
}

#[cfg(test)]
mod tests;
