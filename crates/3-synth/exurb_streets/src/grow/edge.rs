//! The edge of the target: which streets end there and which run on.
//!
//! Streets are cut a little beyond the target, so that whoever clips to it cuts them (contract, section
//! 4). Blocks that lie mostly inside are closed: the streets around them stay whole, wherever they lie,
//! so that the city is built up to its edge.

use exurb_geom::{Polygon, SegmentIndex, offset, overlay};
use exurb_graph::Faces;

use super::finish::{Grown, keep_largest_piece};

/// How far streets run past the target, in metres (contract: at least 20).
pub const PAST_M: f64 = 22.0;
/// Share of a block's area that lies inside, from which on it is closed.
const MOSTLY: f64 = 0.5;

/// Cuts what grew at the target's edge, marks the cut ends and keeps one piece: the largest as seen
/// inside the target.
pub fn cut(graph: &mut Grown, target: &Polygon) {
    let outside = graph.cut_along(target, |_| true).outside;
    let mut is_inside = vec![true; graph.edge_bound()];
    for id in outside {
        is_inside[id.index()] = false;
    }
    keep_largest_piece(graph, |id| is_inside[id.index()]);
    let around = around_inside(graph, target);
    let strip = offset::inset(target, -PAST_M);
    let area = strip.first().unwrap_or(target);
    for node in graph.clip_some(area, |id| !around[id.index()]) {
        graph.node_mut(node).data.outside = true;
    }
    keep_largest_piece(graph, |_| true);
}

/// For every edge: does it lie around or inside a face that lies mostly in the target?
fn around_inside(graph: &Grown, target: &Polygon) -> Vec<bool> {
    let mut border = SegmentIndex::new(100.0);
    for (number, (a, b)) in (0..).zip(target.segments()) {
        border.insert(number, a.to_m(), b.to_m());
    }
    let mut around = vec![false; graph.edge_bound()];
    for face in Faces::of(graph, |_| true).list {
        if !lies_mostly_in(&face.polygon, target, &border) {
            continue;
        }
        let darts = face.outline.iter().chain(face.islands.iter().flatten());
        for id in darts.map(|d| d.edge()).chain(face.inner.iter().copied()) {
            around[id.index()] = true;
        }
    }
    around
}

fn lies_mostly_in(face: &Polygon, target: &Polygon, border: &SegmentIndex) -> bool {
    let mut near_border = false;
    border.visit(face.bounds(), |_| {
        near_border = true;
        false
    });
    if !near_border {
        return face.exterior().first().is_some_and(|p| target.contains(*p));
    }
    let inside: f64 = overlay::intersection(face, target).iter().map(Polygon::area_m2).sum();
    inside > MOSTLY * face.area_m2()
}
