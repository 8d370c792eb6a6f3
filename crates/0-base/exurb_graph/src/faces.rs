//! The faces between the edges: outlines, dead ends inside, islands.
//!
//! A face lies to the left of its darts. The walk turns as sharply left as it can at every node
//! (half-edges sorted by angle), so that bounded faces come out counter-clockwise and the outside of
//! every component clockwise. Dead ends are walked up and down; they stay inside their face and are
//! not part of its outline. O(n log n) in edges, plus O(points of the faces around) per island.

use exurb_geom::{BoxGrid, GridPoint, Polygon, polygon::signed_area_m2};

use crate::{Dart, EdgeId, Graph};

/// A face of a [`Faces`] list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FaceId(pub u32);

/// One bounded face.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// Outline with holes for islands; dead ends are left out.
    pub polygon: Polygon,
    /// Darts of the outline in order, the face to their left.
    pub outline: Vec<Dart>,
    /// Darts of the outlines of islands inside, the face to their left.
    pub islands: Vec<Vec<Dart>>,
    /// Edges with the face on both sides: dead ends and trees inside.
    pub inner: Vec<EdgeId>,
}

/// All bounded faces of a graph.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Faces {
    /// The faces, in order of their first dart.
    pub list: Vec<Face>,
    /// For every dart the face to its left; `None` outside and for edges left out.
    pub left: Vec<Option<FaceId>>,
}

impl Faces {
    /// The faces of the edges that `keep` accepts.
    pub fn of<N, E>(graph: &Graph<N, E>, keep: impl Fn(EdgeId) -> bool) -> Self {
        let next = next_darts(graph, &keep);
        let mut seen = vec![false; next.len()];
        let mut walks: Vec<Vec<Dart>> = Vec::new();
        for (start, _) in next.iter().enumerate().filter(|(_, n)| n.is_some()) {
            if seen[start] {
                continue;
            }
            let mut walk = Vec::new();
            let mut dart = Dart(start as u32);
            while !seen[dart.index()] {
                seen[dart.index()] = true;
                walk.push(dart);
                dart = next[dart.index()].expect("a kept dart is followed by a kept dart");
            }
            walks.push(walk);
        }

        let mut left = vec![None; next.len()];
        let mut list: Vec<Face> = Vec::new();
        let mut outsides: Vec<Outside> = Vec::new();
        for walk in walks {
            let (inner, cycles) = strip_dead_ends(graph, &walk);
            // A walk that touches a node twice falls into cycles; the left of a bounded face is
            // inside exactly one of them. Between edges drawn twice there is nothing.
            let (mut outer, mut islands, mut nothing) = (None, Vec::new(), inner.is_empty());
            for cycle in cycles {
                let ring = ring(graph, &cycle);
                let area_m2 = signed_area_m2(&ring);
                if area_m2 > 0.0 && outer.is_none() {
                    outer = Some((cycle, ring));
                } else {
                    nothing &= area_m2 == 0.0;
                    islands.push((cycle, ring));
                }
            }
            let (islands, holes): (Vec<_>, Vec<_>) = islands.into_iter().unzip();
            let Some((outline, ring)) = outer else {
                if !nothing {
                    outsides.push(Outside { islands, holes, inner, first: walk[0] });
                }
                continue;
            };
            let Some(polygon) = Polygon::new(ring, holes) else { continue };
            let id = FaceId(list.len() as u32);
            for dart in &walk {
                left[dart.index()] = Some(id);
            }
            list.push(Face { polygon, outline, islands, inner });
        }
        place_islands(graph, &mut list, &mut left, outsides);
        Self { list, left }
    }

    /// The face `id`.
    pub fn face(&self, id: FaceId) -> &Face {
        &self.list[id.0 as usize]
    }
}

/// For every kept dart the dart that follows it around the face to its left.
fn next_darts<N, E>(graph: &Graph<N, E>, keep: &impl Fn(EdgeId) -> bool) -> Vec<Option<Dart>> {
    let mut next = vec![None; graph.edge_bound() * 2];
    for (node, _) in graph.nodes() {
        let mut darts = graph.darts_by_angle(node);
        darts.retain(|d| keep(d.edge()));
        for (i, dart) in darts.iter().enumerate() {
            // Arriving against `dart`, the sharpest left turn is the next dart clockwise.
            let clockwise = darts[(i + darts.len() - 1) % darts.len()];
            next[dart.twin().index()] = Some(clockwise);
        }
    }
    next
}

/// Splits a face walk into edges walked both ways and the simple cycles that remain.
fn strip_dead_ends<N, E>(graph: &Graph<N, E>, walk: &[Dart]) -> (Vec<EdgeId>, Vec<Vec<Dart>>) {
    let mut edges: Vec<EdgeId> = walk.iter().map(|d| d.edge()).collect();
    edges.sort_unstable();
    let mut inner: Vec<EdgeId> = edges.windows(2).filter(|w| w[0] == w[1]).map(|w| w[0]).collect();
    inner.dedup();
    let mut cycles = Vec::new();
    let mut path: Vec<Dart> = Vec::new();
    for dart in walk.iter().filter(|d| inner.binary_search(&d.edge()).is_err()) {
        path.push(*dart);
        let head = graph.head(*dart);
        if let Some(at) = path.iter().rposition(|d| graph.tail(*d) == head) {
            cycles.push(path.split_off(at));
        }
    }
    (inner, cycles)
}

fn ring<N, E>(graph: &Graph<N, E>, cycle: &[Dart]) -> Vec<GridPoint> {
    let mut out = Vec::new();
    for dart in cycle {
        let line = graph.edge(dart.edge()).line();
        if dart.is_forward() {
            out.extend(&line[..line.len() - 1]);
        } else {
            out.extend(line[1..].iter().rev());
        }
    }
    out
}

/// The walk around a component from outside: cycles with their rings, and what is walked both ways.
struct Outside {
    islands: Vec<Vec<Dart>>,
    holes: Vec<Vec<GridPoint>>,
    inner: Vec<EdgeId>,
    first: Dart,
}

/// Puts each component into the smallest face that holds it.
fn place_islands<N, E>(
    graph: &Graph<N, E>,
    list: &mut [Face],
    left: &mut [Option<FaceId>],
    outsides: Vec<Outside>,
) {
    if outsides.len() < 2 {
        return;
    }
    let boxes = BoxGrid::of(list.iter().map(|f| &f.polygon));
    let areas: Vec<f64> = list.iter().map(|f| f.polygon.area_m2()).collect();
    let mut around = Vec::new();
    let mut homes: Vec<(usize, Outside)> = Vec::new();
    for outside in outsides {
        let at = graph.node(graph.tail(outside.first)).at;
        boxes.meeting(at, at, &mut around);
        let home = around
            .iter()
            .map(|i| *i as usize)
            .filter(|i| list[*i].polygon.contains(at) && !on_boundary(&list[*i].polygon, at))
            .min_by(|i, j| areas[*i].total_cmp(&areas[*j]));
        if let Some(home) = home {
            homes.push((home, outside));
        }
    }
    homes.sort_by_key(|(home, _)| *home);
    for in_one in homes.chunk_by_mut(|a, b| a.0 == b.0) {
        let home = in_one[0].0;
        let id = Some(FaceId(home as u32));
        let mut holes: Vec<Vec<GridPoint>> = list[home].polygon.interiors().to_vec();
        for (_, outside) in in_one {
            for dart in outside.islands.iter().flatten() {
                left[dart.index()] = id;
            }
            for edge in &outside.inner {
                left[edge.forward().index()] = id;
                left[edge.backward().index()] = id;
            }
            holes.append(&mut outside.holes);
            list[home].islands.append(&mut outside.islands);
            list[home].inner.append(&mut outside.inner);
        }
        if let Some(polygon) = Polygon::new(list[home].polygon.exterior().to_vec(), holes) {
            list[home].polygon = polygon;
        }
    }
}

fn on_boundary(polygon: &Polygon, p: GridPoint) -> bool {
    polygon.segments().any(|(a, b)| exurb_geom::grid::on_segment(a, b, p))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graph(lines: &[&[(f64, f64)]]) -> Graph<(), ()> {
        let mut graph = Graph::new();
        let mut at = std::collections::BTreeMap::new();
        for line in lines {
            let points: Vec<GridPoint> = line.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect();
            let mut node = |p: GridPoint, g: &mut Graph<(), ()>| {
                *at.entry(p).or_insert_with(|| g.add_node(p, ()))
            };
            let (a, b) = (node(points[0], &mut graph), node(points[points.len() - 1], &mut graph));
            graph.add_edge(a, b, points, ()).expect("has length");
        }
        graph
    }

    const SQUARE: &[(f64, f64)] = &[(0., 0.), (9., 0.), (9., 9.), (0., 9.), (0., 0.)];

    #[test]
    fn a_dead_end_stays_inside_its_face() {
        let g = graph(&[&SQUARE[..3], &SQUARE[2..], &[(0., 0.), (4., 4.)]]);
        let faces = Faces::of(&g, |_| true);
        assert_eq!(faces.list.len(), 1);
        assert_eq!(faces.list[0].polygon.area_m2(), 81.0);
        assert_eq!(faces.list[0].inner, [EdgeId(2)]);
    }

    #[test]
    fn an_island_is_a_hole() {
        let island: Vec<_> = SQUARE.iter().map(|(x, y)| (x / 3. + 2., y / 3. + 2.)).collect();
        let faces = Faces::of(&graph(&[SQUARE, &island]), |_| true);
        let mut areas: Vec<f64> = faces.list.iter().map(|f| f.polygon.area_m2()).collect();
        areas.sort_by(f64::total_cmp);
        assert_eq!(areas, [9.0, 72.0]);
    }

    #[test]
    fn squares_that_touch_in_one_node_are_two_faces() {
        let other: Vec<_> = SQUARE.iter().map(|(x, y)| (-x, -y)).collect();
        let faces = Faces::of(&graph(&[SQUARE, &other]), |_| true);
        assert_eq!(faces.list.len(), 2);
        assert!(faces.list.iter().all(|f| f.polygon.area_m2() == 81.0));
    }

    #[test]
    fn a_ring_inside_that_touches_the_outline_is_a_hole_of_the_outer_face() {
        let inner = [(0., 0.), (3., 1.), (3., 3.), (1., 3.), (0., 0.)];
        let faces = Faces::of(&graph(&[SQUARE, &inner]), |_| true);
        let total: f64 = faces.list.iter().map(|f| f.polygon.area_m2()).sum();
        assert_eq!(faces.list.len(), 2);
        assert!((total - 81.0).abs() < 1e-9, "{total}");
    }
}
