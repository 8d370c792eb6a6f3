use exurb_geom::GridPoint;

use super::{Hierarchy, assign_levels, strokes};
use crate::{Class, Street, StreetGraph, street_graph};

type Line<'a> = &'a [(f64, f64)];

fn graph(lines: &[(Line, Class)]) -> StreetGraph {
    street_graph::from_lines(lines.iter().map(|(line, class)| {
        let points = line.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect();
        (points, Street { class: *class, ..Street::default() })
    }))
}

/// Streets along x and y, `n` by `n` blocks of 100 m.
fn grid(n: i32, class: impl Fn(i32, bool) -> Class) -> StreetGraph {
    let at = |i: i32| f64::from(i) * 100.0;
    let mut lines = Vec::new();
    for i in 0..=n {
        for j in 0..n {
            lines.push(([(at(j), at(i)), (at(j + 1), at(i))], class(i, true)));
            lines.push(([(at(i), at(j)), (at(i), at(j + 1))], class(i, false)));
        }
    }
    let lines: Vec<(Line, Class)> = lines.iter().map(|(l, c)| (&l[..], *c)).collect();
    graph(&lines)
}

fn level_at(graph: &StreetGraph, x: f64, y: f64) -> u8 {
    let p = exurb_geom::Vec2::new(x, y);
    graph
        .edges()
        .find(|(_, e)| exurb_geom::polyline::distance(&e.line_m(), p) < 0.01)
        .map(|(_, e)| e.data.level)
        .expect("a street passes")
}

#[test]
fn a_grid_has_a_stroke_for_every_line() {
    let graph = grid(4, |_, _| Class::Residential);
    let found = strokes(&graph);
    // The corners have degree 2, where streets always go on: the four outer lines are one ring.
    assert_eq!(found.len(), 3 + 3 + 1);
    let edges: usize = found.iter().map(|s| s.darts.len()).sum();
    assert_eq!(edges, graph.edge_count());
    assert!(
        found.iter().all(|s| { s.darts.windows(2).all(|w| graph.head(w[0]) == graph.tail(w[1])) })
    );
}

#[test]
fn a_side_street_does_not_go_on_in_the_through_street() {
    let found = strokes(&graph(&[
        (&[(0., 0.), (100., 0.)], Class::Residential),
        (&[(100., 0.), (200., 10.)], Class::Residential),
        (&[(100., 0.), (150., 80.)], Class::Residential),
    ]));
    let mut lengths: Vec<usize> = found.iter().map(|s| s.darts.len()).collect();
    lengths.sort_unstable();
    assert_eq!(lengths, [1, 2]);
}

#[test]
fn classes_set_level_0_and_the_rest_follows_breadth_first() {
    let main = |i: i32, along_x: bool| {
        if along_x && i == 2 { Class::Secondary } else { Class::Residential }
    };
    let mut graph = grid(4, main);
    assign_levels(&mut graph, &Hierarchy::default());
    assert_eq!(level_at(&graph, 150.0, 200.0), 0);
    assert_eq!(level_at(&graph, 100.0, 150.0), 1); // crosses the main street
    assert_eq!(level_at(&graph, 150.0, 100.0), 2); // crosses only those
}

#[test]
fn without_classes_the_longest_street_is_main() {
    let mut graph = graph(&[
        (&[(0., 0.), (500., 0.)], Class::Residential),
        (&[(500., 0.), (900., 0.)], Class::Residential),
        (&[(500., 0.), (500., 300.)], Class::Residential),
        (&[(500., 300.), (600., 300.)], Class::Residential),
        (&[(500., 300.), (500., 400.)], Class::Residential),
        (&[(2000., 0.), (2100., 0.)], Class::Residential),
    ]);
    assign_levels(&mut graph, &Hierarchy::default());
    let levels = [(10., 0.), (700., 0.), (500., 100.), (500., 350.), (550., 300.), (2050., 0.)]
        .map(|(x, y)| level_at(&graph, x, y));
    assert_eq!(levels, [0, 0, 1, 1, 2, 1]);
}

#[test]
fn level_0_keeps_to_its_share_of_the_length() {
    let mut graph = grid(20, |_, _| Class::Residential);
    assign_levels(&mut graph, &Hierarchy { by_class: true, main_share: 0.2 });
    let main: f64 =
        graph.edges().filter(|(_, e)| e.data.level == 0).map(|(_, e)| e.length_m()).sum();
    let share = main / graph.length_m();
    assert!(share > 0.1 && share <= 0.2, "{share}");
    assert!(graph.edges().all(|(_, e)| e.data.level <= 2));
}
