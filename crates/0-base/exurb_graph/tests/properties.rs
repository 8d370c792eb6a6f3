//! Laws of noding, faces and edits on random linework.
//!
//! Points lie on a coarse lattice, so that shared vertices, overlaps and touching ends are common.

use std::collections::BTreeMap;

use exurb_geom::{GridPoint, Polygon, grid, overlay, polyline};
use exurb_graph::{Dart, EdgeId, Faces, Graph, NodeId, laws, noding};
use proptest::prelude::*;

type Net = Graph<(), u32>;

fn point() -> impl Strategy<Value = GridPoint> {
    (0..24, 0..24).prop_map(|(x, y)| GridPoint { x: x * 4_093, y: y * 4_099 })
}

fn line() -> impl Strategy<Value = Vec<GridPoint>> {
    prop::collection::vec(point(), 2..6).prop_filter_map("has length", |mut line| {
        line.dedup();
        (line.len() > 1).then_some(line)
    })
}

fn linework(most: usize) -> impl Strategy<Value = Vec<Vec<GridPoint>>> {
    prop::collection::vec(line(), 1..most)
}

fn noded(lines: &[Vec<GridPoint>], snap_m: f64) -> Vec<noding::Line<u32>> {
    let lines = lines.iter().zip(0..).map(|(points, data)| noding::Line {
        points: points.clone(),
        level: 0,
        data,
    });
    noding::node(lines.collect(), noding::Options { snap_m, max_rounds: 30 })
}

/// The graph of noded lines, each drawn once.
fn graph_of(lines: &[noding::Line<u32>]) -> Net {
    let mut graph = Net::new();
    let mut at: BTreeMap<GridPoint, NodeId> = BTreeMap::new();
    for line in unique(lines) {
        let mut node = |p, g: &mut Net| *at.entry(p).or_insert_with(|| g.add_node(p, ()));
        let (a, b) = (node(line[0], &mut graph), node(line[line.len() - 1], &mut graph));
        graph.add_edge(a, b, line, 0).expect("has length");
    }
    graph
}

/// Lines in either direction, each once, sorted.
fn unique(lines: &[noding::Line<u32>]) -> Vec<Vec<GridPoint>> {
    let mut out: Vec<Vec<GridPoint>> = lines
        .iter()
        .map(|line| {
            let mut points = line.points.clone();
            if points.iter().rev().lt(points.iter()) {
                points.reverse();
            }
            points
        })
        .collect();
    out.sort();
    out.dedup();
    out
}

fn planar(most: usize) -> impl Strategy<Value = Net> {
    linework(most).prop_map(|lines| graph_of(&noded(&lines, 0.0)))
}

fn components(graph: &Net) -> usize {
    let mut seen = vec![false; graph.node_bound()];
    let mut count = 0;
    for (start, _) in graph.nodes() {
        count += usize::from(!seen[start.index()]);
        let mut open = vec![start];
        while let Some(node) = open.pop() {
            if !std::mem::replace(&mut seen[node.index()], true) {
                open.extend(graph.neighbors(node));
            }
        }
    }
    count
}

fn assert_sound(graph: &Net) {
    assert_eq!(laws::breaches(graph), []);
}

/// Do two noded pieces share anything but ends of both?
fn meet_inside(a: &[GridPoint], b: &[GridPoint]) -> bool {
    let is_end = |line: &[GridPoint], p| p == line[0] || p == line[line.len() - 1];
    a.windows(2).any(|s| {
        b.windows(2).any(|t| {
            let (p, q, r, u) = (s[0], s[1], t[0], t[1]);
            let on = |x, y, v: GridPoint, line: &[GridPoint]| {
                grid::on_segment(x, y, v) && !(v == x || v == y) && !line.is_empty()
            };
            grid::cross_properly(p, q, r, u)
                || on(p, q, r, a)
                || on(p, q, u, a)
                || on(r, u, p, b)
                || on(r, u, q, b)
                || [p, q].iter().any(|v| [r, u].contains(v) && !(is_end(a, *v) && is_end(b, *v)))
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 96,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn noded_lines_meet_at_their_ends_only(lines in linework(14)) {
        let pieces = unique(&noded(&lines, 0.0));
        for (i, a) in pieces.iter().enumerate() {
            for b in &pieces[i + 1..] {
                prop_assert!(!meet_inside(a, b), "{a:?} {b:?}");
            }
        }
    }

    #[test]
    fn noding_keeps_the_length_and_the_owner(lines in linework(14)) {
        let pieces = noded(&lines, 0.0);
        for (line, data) in lines.iter().zip(0..) {
            let own = || pieces.iter().filter(|p| p.data == data);
            let length: f64 = own().map(|p| polyline::grid_length_m(&p.points)).sum();
            // Every cut bends the line by a grid step at most.
            let slack = 0.002 * own().count() as f64;
            prop_assert!((length - polyline::grid_length_m(line)).abs() <= slack);
            let ends = (own().next().map(|p| p.points[0]), line.first().copied());
            prop_assert_eq!(ends.0, ends.1);
        }
    }

    #[test]
    fn noding_twice_changes_nothing(lines in linework(14), snap in prop::bool::ANY) {
        let snap_m = if snap { 0.02 } else { 0.0 };
        let once = noded(&lines, snap_m);
        let again = noding::node(once.clone(), noding::Options { snap_m, max_rounds: 30 });
        prop_assert_eq!(once, again);
    }

    #[test]
    fn noding_does_not_depend_on_order_or_direction(
        lines in linework(14),
        swaps in prop::collection::vec((0..14usize, 0..14usize, prop::bool::ANY), 14),
    ) {
        let mut other = lines.clone();
        let n = other.len();
        for (i, j, reverse) in swaps {
            other.swap(i % n, j % n);
            if reverse {
                other[i % n].reverse();
            }
        }
        prop_assert_eq!(unique(&noded(&lines, 0.0)), unique(&noded(&other, 0.0)));
    }

    #[test]
    fn snapped_vertices_are_shared_or_apart(lines in linework(8), jitter in prop::collection::vec((-9..9, -9..9), 40)) {
        let mut moves = jitter.into_iter().cycle();
        let shaken: Vec<Vec<GridPoint>> = lines
            .iter()
            .map(|line| {
                let shake = |p: &GridPoint| {
                    let (x, y) = moves.next().unwrap_or_default();
                    GridPoint { x: p.x + x, y: p.y + y }
                };
                line.iter().map(shake).collect()
            })
            .collect();
        let pieces = unique(&noded(&shaken, 0.02));
        let mut vertices: Vec<GridPoint> = pieces.concat();
        vertices.sort();
        vertices.dedup();
        for (i, p) in vertices.iter().enumerate() {
            for q in &vertices[i + 1..] {
                prop_assert!(p.distance_m(*q) >= 0.02, "{p:?} {q:?}");
            }
        }
    }

    #[test]
    fn faces_follow_euler(graph in planar(14)) {
        assert_sound(&graph);
        let faces = Faces::of(&graph, |_| true);
        // V - E + F = 1 + C, the outside counted.
        prop_assert_eq!(
            faces.list.len() + graph.node_count(),
            graph.edge_count() + components(&graph)
        );
    }

    #[test]
    fn every_dart_lies_on_one_face(graph in planar(14)) {
        let faces = Faces::of(&graph, |_| true);
        let mut seen: BTreeMap<Dart, usize> = BTreeMap::new();
        for (number, face) in faces.list.iter().enumerate() {
            let inner = face.inner.iter().flat_map(|e| [e.forward(), e.backward()]);
            for dart in face.outline.iter().chain(face.islands.iter().flatten()).copied().chain(inner) {
                prop_assert!(seen.insert(dart, number).is_none(), "{dart:?} lies on two walks");
            }
        }
        for (id, _) in graph.edges() {
            for dart in [id.forward(), id.backward()] {
                let listed = seen.get(&dart).copied();
                let left = faces.left[dart.index()].map(|f| f.0 as usize);
                prop_assert_eq!(listed, left);
            }
        }
    }

    #[test]
    fn faces_tile_what_they_enclose(graph in planar(12)) {
        let faces = Faces::of(&graph, |_| true);
        let apart: f64 = faces.list.iter().map(|f| f.polygon.area_m2()).sum();
        let filled: Vec<Polygon> = faces
            .list
            .iter()
            .filter_map(|f| Polygon::new(f.polygon.exterior().to_vec(), Vec::new()))
            .collect();
        let together: f64 = overlay::union(&filled).iter().map(Polygon::area_m2).sum();
        prop_assert!((apart - together).abs() <= 0.01 + 1e-6 * together, "{apart} {together}");
    }

    #[test]
    fn the_left_of_a_dart_is_its_face(graph in planar(12)) {
        let faces = Faces::of(&graph, |_| true);
        for (id, edge) in graph.edges() {
            let line = edge.line_m();
            let middle = (line[0] + line[1]) / 2.0;
            let beside = (line[1] - line[0]).normalize().perp() * 0.004;
            for (dart, side) in [(id.forward(), beside), (id.backward(), -beside)] {
                let p = GridPoint::round(middle + side);
                let inside: Vec<usize> = (0..faces.list.len())
                    .filter(|i| {
                        let polygon = &faces.list[*i].polygon;
                        polygon.contains(p)
                            && !polygon.segments().any(|(a, b)| grid::on_segment(a, b, p))
                    })
                    .collect();
                // A sliver thinner than the step aside says nothing.
                if inside.len() == 1 {
                    let expected = faces.left[dart.index()].map(|f| f.0 as usize);
                    let thin = expected.is_none_or(|f| faces.list[f].polygon.mean_width_m() < 0.1)
                        || faces.list[inside[0]].polygon.mean_width_m() < 0.1
                        || near_another(&graph, id, middle);
                    prop_assert!(thin || expected == Some(inside[0]));
                }
            }
        }
    }

    #[test]
    fn random_edits_keep_the_graph_sound(
        graph in planar(10),
        edits in prop::collection::vec((0..9u8, 0..1000usize, 0..1000usize, point()), 1..25),
    ) {
        let mut graph = graph;
        for (kind, i, j, p) in edits {
            edit(&mut graph, kind, i, j, p);
            assert_sound(&graph);
        }
        let compact = graph.compacted();
        assert_sound(&compact);
        prop_assert_eq!(compact.edge_count(), compact.edge_bound());
        prop_assert!((compact.length_m() - graph.length_m()).abs() < 1e-6);
    }

    #[test]
    fn splitting_on_a_line_keeps_the_length_and_dissolving_undoes_it(
        graph in planar(10),
        i in 0..1000usize,
        share in 0.0..1.0f64,
    ) {
        let mut after = graph.clone();
        let id = nth_edge(&graph, i);
        let line = graph.edge(id).line_m();
        let at = GridPoint::round(polyline::point_at(&line, share * polyline::length(&line)));
        let before = graph.length_m();
        if let Some((node, head, tail)) = after.split_edge(id, at) {
            assert_sound(&after);
            prop_assert!((after.length_m() - before).abs() < 0.004);
            prop_assert_eq!(after.degree(node), 2);
            prop_assert_eq!((after.edge(head).to, after.edge(tail).from), (node, node));
            let joined = after.dissolve(node).expect("two edges");
            assert_sound(&after);
            let (was, is) = (graph.edge(id), after.edge(joined));
            prop_assert_eq!((was.from, was.to), (is.from, is.to));
            prop_assert!((after.length_m() - before).abs() < 0.004);
        } else {
            prop_assert!(at == graph.edge(id).line()[0] || graph.edge(id).line().last() == Some(&at));
        }
    }

    #[test]
    fn clipping_leaves_what_lies_inside_and_does_it_once(graph in planar(10)) {
        let area = Polygon::rectangle(GridPoint { x: 20_001, y: 15_003 }, GridPoint { x: 70_007, y: 80_011 });
        let mut inside = graph.clone();
        let cut = inside.clip(&area);
        assert_sound(&inside);
        prop_assert!(cut.iter().all(|n| inside.degree(*n) == 1));
        let line_length: f64 = graph
            .edges()
            .flat_map(|(_, e)| overlay::clip_line(&area, &e.line_m()))
            .map(|piece| polyline::length(&piece))
            .sum();
        let slack = 0.005 * (1.0 + inside.edge_count() as f64);
        prop_assert!((inside.length_m() - line_length).abs() < slack, "{} {line_length}", inside.length_m());
        let mut again = inside.clone();
        prop_assert_eq!(again.clip(&area), vec![]);
        prop_assert_eq!(again, inside);
    }

    #[test]
    fn merging_and_collapsing_never_part_what_is_connected(
        graph in planar(10),
        i in 0..1000usize,
        j in 0..1000usize,
    ) {
        let parts = components(&graph);
        let mut merged = graph.clone();
        let (a, b) = (nth_node(&graph, i), nth_node(&graph, j));
        merged.merge_nodes(a, b);
        assert_sound(&merged);
        prop_assert!(components(&merged) <= parts);
        let mut collapsed = graph.clone();
        let kept = collapsed.collapse_edge(nth_edge(&graph, j)).expect("the edge exists");
        assert_sound(&collapsed);
        prop_assert!(collapsed.get_node(kept).is_some());
        prop_assert!(components(&collapsed) <= parts);
        prop_assert!(collapsed.edge_count() < graph.edge_count());
    }
}

/// Does another edge pass within a centimetre of the point?
fn near_another(graph: &Net, own: EdgeId, p: exurb_geom::Vec2) -> bool {
    graph.edges().any(|(id, e)| {
        let line = e.line_m();
        let pieces = line.windows(2).skip(usize::from(id == own));
        let mut close = pieces.map(|w| polyline::distance(w, p));
        close.any(|d| d < 0.01)
    })
}

fn nth_edge(graph: &Net, i: usize) -> EdgeId {
    let count = graph.edge_count();
    graph.edges().nth(i % count).expect("there are edges").0
}

fn nth_node(graph: &Net, i: usize) -> NodeId {
    let count = graph.node_count();
    graph.nodes().nth(i % count).expect("there are nodes").0
}

fn edit(graph: &mut Net, kind: u8, i: usize, j: usize, p: GridPoint) {
    if graph.edge_count() == 0 {
        return;
    }
    let (edge, node, other) = (nth_edge(graph, i), nth_node(graph, j), nth_node(graph, i + 1));
    match kind {
        0 => drop(graph.split_edge(edge, p)),
        1 => graph.merge_nodes(node, other),
        2 => graph.move_node(node, p),
        3 => drop(graph.snap_node_to_edge(node, edge)),
        4 => drop(graph.dissolve(node)),
        5 => drop(graph.collapse_edge(edge)),
        6 => drop(graph.remove_edge(edge)),
        7 => graph.set_line(edge, vec![GridPoint::default(), p, GridPoint::default()]),
        _ => {
            let corner = GridPoint { x: p.x + 60_001, y: p.y + 50_003 };
            drop(graph.clip(&Polygon::rectangle(p, corner)));
        }
    }
}
