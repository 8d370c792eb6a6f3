//! Pass 2: where the nodes lie that some way needs.

use exurb_geom::{Frame, GridPoint, LonLat};
use rayon::prelude::*;

use crate::elements::{Elements, Node, Way};

/// Stands for a node that is missing.
const NONE: u32 = u32::MAX;

/// Node positions by way.
pub struct Places {
    /// Index into `points` for every entry of [`Elements::refs`].
    index: Vec<u32>,
    /// By node, in the frame; only needed ones are projected.
    points: Vec<Option<GridPoint>>,
}

/// A vertex of a way: node id and position.
pub type Vertex = (i64, GridPoint);

impl Places {
    /// Finds and projects the nodes of the ways that `needed` names. O(n log n) at worst; nearly
    /// O(n) because neighbours in a way are mostly neighbours by id.
    pub fn find(elements: &Elements, needed: &[bool], frame: &Frame) -> Self {
        let mut index = vec![NONE; elements.refs.len()];
        let mut used = vec![false; elements.nodes.len()];
        let mut last = 0;
        for (way, _) in elements.ways.iter().zip(needed).filter(|(_, needed)| **needed) {
            let range = way.start..way.end;
            for (slot, id) in index[range.clone()].iter_mut().zip(&elements.refs[range]) {
                if let Some(found) = search(&elements.nodes, *id, last) {
                    *slot = found as u32;
                    used[found] = true;
                    last = found;
                }
            }
        }
        let points = elements
            .nodes
            .par_iter()
            .zip(&used)
            .map(|(node, used)| if *used { project(frame, node) } else { None })
            .collect();
        Self { index, points }
    }

    /// The vertices of a way in order; `None` where a node is missing.
    pub fn vertices<'a>(
        &'a self,
        elements: &'a Elements,
        way: &Way,
    ) -> impl ExactSizeIterator<Item = Option<Vertex>> + 'a {
        (way.start..way.end).map(|at| {
            let point = self.points.get(self.index[at] as usize).copied().flatten()?;
            Some((elements.refs[at], point))
        })
    }

    /// All vertices of a way, or `None` when one is missing.
    pub fn whole(&self, elements: &Elements, way: &Way) -> Option<Vec<Vertex>> {
        self.vertices(elements, way).collect()
    }
}

/// The node's place in the frame.
pub fn project(frame: &Frame, node: &Node) -> Option<GridPoint> {
    frame.project_to_grid(LonLat { lon: degrees(node.lon), lat: degrees(node.lat) })
}

/// From 1e-7 degrees.
pub fn degrees(fixed: i32) -> f64 {
    f64::from(fixed) / 1e7
}

/// Index of node `id`, looked for in growing steps from `last`.
pub fn search(nodes: &[Node], id: i64, last: usize) -> Option<usize> {
    let (mut lo, mut hi) = (last, nodes.len());
    let mut step = 1;
    if nodes.get(last)?.id <= id {
        while lo + step < nodes.len() && nodes[lo + step].id <= id {
            lo += step;
            step *= 2;
        }
        hi = hi.min(lo + step);
    } else {
        hi = last;
        while hi > step && nodes[hi - step].id > id {
            hi -= step;
            step *= 2;
        }
        lo = hi.saturating_sub(step);
    }
    nodes[lo..hi].binary_search_by_key(&id, |n| n.id).ok().map(|at| lo + at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_node_is_found_from_everywhere_and_no_other() {
        let nodes: Vec<Node> = (0..40).map(|i| Node { id: i * i - 7, lon: 0, lat: 0 }).collect();
        for last in 0..nodes.len() {
            for id in -20..1600 {
                let expected = nodes.iter().position(|n| n.id == id);
                assert_eq!(search(&nodes, id, last), expected, "{id} from {last}");
            }
        }
        assert_eq!(search(&[], 1, 0), None);
    }
}
