//! The straight pieces of all streets, indexed.

use exurb_geom::{GridPoint, SegmentGrid};
use exurb_graph::EdgeId;

use crate::StreetGraph;

/// Every segment of every street, in order.
pub struct Pieces<'a> {
    pub graph: &'a StreetGraph,
    pub grid: SegmentGrid,
    /// Piece → street and segment of its line.
    pub owners: Vec<(EdgeId, u32)>,
    /// Edge index → level on which it crosses others.
    pub levels: Vec<i32>,
    pub length_m: f64,
}

impl<'a> Pieces<'a> {
    pub fn of(graph: &'a StreetGraph) -> Self {
        let mut owners = Vec::new();
        let mut segments: Vec<(GridPoint, GridPoint)> = Vec::new();
        let mut levels = vec![0; graph.edge_bound()];
        for (id, edge) in graph.edges() {
            levels[id.index()] = edge.data.crossing_level();
            for (segment, w) in edge.line().windows(2).enumerate() {
                owners.push((id, segment as u32));
                segments.push((w[0], w[1]));
            }
        }
        Self { graph, grid: SegmentGrid::new(segments), owners, levels, length_m: graph.length_m() }
    }

    pub fn level(&self, edge: EdgeId) -> i32 {
        self.levels[edge.index()]
    }

    /// Is the piece the last of its street?
    pub fn is_last(&self, piece: u32) -> bool {
        let (edge, segment) = self.owners[piece as usize];
        segment as usize + 2 == self.graph.edge(edge).line().len()
    }
}
