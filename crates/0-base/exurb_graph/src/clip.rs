//! Cutting a graph at the border of an area.

use exurb_geom::{GridPoint, Polygon, SegmentGrid, Vec2, grid, polyline};

use crate::{EdgeId, Graph, NodeId};

/// Pieces shorter than this are rounding: they stay with what they hang on. Metres.
const LEAST_PIECE_M: f64 = 0.002;

/// What [`Graph::cut_along`] found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cut {
    /// Nodes made on the border, in order.
    pub nodes: Vec<NodeId>,
    /// Edges outside the area.
    pub outside: Vec<EdgeId>,
}

impl<N: Clone + Default, E: Clone> Graph<N, E> {
    /// Removes what lies outside `area` and cuts edges at its boundary. Returns the nodes made by
    /// cutting, in order. Edges that only touch the boundary stay as they are; an edge that ends
    /// within 2 mm of it is not cut there.
    pub fn clip(&mut self, area: &Polygon) -> Vec<NodeId> {
        self.clip_some(area, |_| true)
    }

    /// As [`Graph::clip`], but leaves edges whole that `may_cut` refuses, wherever they lie.
    pub fn clip_some(&mut self, area: &Polygon, may_cut: impl Fn(EdgeId) -> bool) -> Vec<NodeId> {
        let mut cut = self.cut_along(area, may_cut);
        for id in cut.outside {
            self.remove_edge(id);
        }
        self.remove_isolated_nodes();
        cut.nodes.retain(|n| self.get_node(*n).is_some());
        cut.nodes
    }

    /// Cuts the edges that `may_cut` accepts at the boundary of `area` and says which of them, or
    /// pieces of them, lie outside. Nothing is removed.
    pub fn cut_along(&mut self, area: &Polygon, may_cut: impl Fn(EdgeId) -> bool) -> Cut {
        let border = SegmentGrid::new(area.segments().collect());
        let mut near = Vec::new();
        let mut cut = Cut::default();
        let ids: Vec<EdgeId> = self.edges().map(|(id, _)| id).filter(|id| may_cut(*id)).collect();
        for id in ids {
            let line = self.edge(id).line_m();
            let inside = stretches_inside(self.edge(id).line(), &line, area, &border, &mut near);
            let total = polyline::length(&line);
            if inside.is_empty() {
                cut.outside.push(id);
            } else if inside != [(0.0, total)] {
                self.cut_edge(id, &line, &inside, &mut cut);
            }
        }
        cut
    }

    /// Cuts an edge into its stretches inside and what lies between these.
    fn cut_edge(&mut self, id: EdgeId, line: &[Vec2], inside: &[(f64, f64)], cut: &mut Cut) {
        let Some(edge) = self.remove_edge(id) else { return };
        let total = polyline::length(line);
        let mut breaks: Vec<f64> = inside.iter().flat_map(|(a, b)| [*a, *b]).collect();
        breaks.extend([0.0, total]);
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        let mut from = edge.from;
        for w in breaks.windows(2) {
            let points = polyline::round(&polyline::part(line, w[0], w[1]));
            if points.len() < 2 {
                continue;
            }
            let to = if w[1] == total {
                edge.to
            } else {
                let node = self.add_node(points[points.len() - 1], N::default());
                cut.nodes.push(node);
                node
            };
            let piece = self.add_edge(from, to, points, edge.data.clone());
            if !inside.contains(&(w[0], w[1])) {
                cut.outside.extend(piece);
            }
            from = to;
        }
    }
}

/// The stretches of a line inside the area, by metres along it, in order and apart.
fn stretches_inside(
    points: &[GridPoint],
    line: &[Vec2],
    area: &Polygon,
    border: &SegmentGrid,
    near: &mut Vec<u32>,
) -> Vec<(f64, f64)> {
    let mut breaks = vec![0.0];
    let mut start = 0.0;
    for (w, m) in points.windows(2).zip(line.windows(2)) {
        let length = m[0].distance(m[1]);
        border.near(w[0], w[1], 0, near);
        for side in near.iter() {
            let (c, d) = border.segment(*side);
            meetings(w[0], w[1], c, d, |t| breaks.push(start + length * t));
        }
        start += length;
    }
    let total = start;
    breaks.push(total);
    breaks.sort_by(f64::total_cmp);
    let mut inside: Vec<(f64, f64)> = Vec::new();
    let mut from = 0.0;
    for (i, to) in breaks.iter().copied().enumerate().skip(1) {
        // A stretch of next to no length goes with the one before or after it.
        let last = i + 1 == breaks.len();
        if to - from < LEAST_PIECE_M && !(last && from == 0.0) {
            if last && let Some((_, end)) = inside.last_mut().filter(|(_, end)| *end == from) {
                *end = total;
            }
            continue;
        }
        let to = if total - to < LEAST_PIECE_M { total } else { to };
        if area.contains(GridPoint::round(polyline::point_at(line, f64::midpoint(from, to)))) {
            match inside.last_mut() {
                Some((_, end)) if *end == from => *end = to,
                _ => inside.push((from, to)),
            }
        }
        from = to;
        if to == total {
            break;
        }
    }
    inside
}

/// Where along `a b` (0 to 1) the segment `c d` crosses or touches it.
fn meetings(a: GridPoint, b: GridPoint, c: GridPoint, d: GridPoint, mut found: impl FnMut(f64)) {
    let place = |p: Vec2| {
        let along = b.to_m() - a.to_m();
        ((p - a.to_m()).dot(along) / along.length_squared()).clamp(0.0, 1.0)
    };
    if grid::cross_properly(a, b, c, d) {
        if let Some(p) = grid::line_intersection(a, b, c, d) {
            found(place(p));
        }
        return;
    }
    for p in [c, d] {
        if grid::on_segment(a, b, p) {
            found(place(p.to_m()));
        }
    }
    for p in [a, b] {
        if grid::on_segment(c, d, p) {
            found(place(p.to_m()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clipped(line: &[(f64, f64)]) -> (Graph<(), ()>, usize) {
        let mut graph: Graph<(), ()> = Graph::new();
        let points: Vec<GridPoint> = line.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect();
        let from = graph.add_node(points[0], ());
        let to = graph.add_node(points[points.len() - 1], ());
        graph.add_edge(from, to, points, ()).expect("has length");
        let area = Polygon::rectangle(GridPoint::m(0., 0.), GridPoint::m(100., 100.));
        let cut = graph.clip(&area).len();
        assert!(crate::laws::breaches(&graph).is_empty());
        (graph, cut)
    }

    #[test]
    fn an_edge_that_leaves_twice_falls_into_three_pieces() {
        let (graph, cut) = clipped(&[
            (10., 50.),
            (150., 50.),
            (150., 60.),
            (50., 60.),
            (-50., 60.),
            (-50., 70.),
            (9., 70.),
        ]);
        assert_eq!((graph.edge_count(), cut), (3, 4));
        assert!((graph.length_m() - (90. + 100. + 9.)).abs() < 0.01);
    }

    #[test]
    fn an_edge_that_touches_the_border_stays_whole() {
        let (graph, cut) = clipped(&[(10., 50.), (100., 60.), (10., 70.)]);
        assert_eq!((graph.edge_count(), cut), (1, 0));
        let (graph, cut) = clipped(&[(10., 0.), (90., 0.)]);
        assert_eq!((graph.edge_count(), cut), (1, 0));
    }

    #[test]
    fn what_ends_on_the_border_or_a_millimetre_beyond_is_not_cut() {
        assert_eq!(clipped(&[(10., 50.), (100., 50.)]).1, 0);
        let (graph, cut) = clipped(&[(10., 50.), (100.001, 50.)]);
        assert_eq!((graph.edge_count(), cut), (1, 0));
    }

    #[test]
    fn what_lies_outside_goes() {
        assert_eq!(clipped(&[(110., 50.), (200., 50.)]).0.node_count(), 0);
        assert_eq!(clipped(&[(-10., 50.), (0., 50.)]).0.node_count(), 0);
        assert_eq!(clipped(&[(-10., -10.), (50., -10.), (110., 200.)]).0.edge_count(), 1);
    }
}
