use std::sync::Arc;

use exurb_geom::{GridPoint, Polygon, trig};

use super::{Simplify, knows_oneways, simplify};
use crate::{Building, Class, Provenance, Street, StreetGraph, street_graph};

type Line<'a> = &'a [(f64, f64)];

fn main_street() -> Street {
    Street { class: Class::Secondary, lanes: 2, width_m: 7.0, ..Street::default() }
}

fn oneway() -> Street {
    Street { oneway: true, ..main_street() }
}

fn graph<'a>(lines: impl IntoIterator<Item = (Line<'a>, Street)>) -> StreetGraph {
    street_graph::from_lines(
        lines.into_iter().map(|(line, street)| {
            (line.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect(), street)
        }),
    )
}

/// A street that splits into two carriageways 16 m apart for 400 m, with a side street to the
/// north, one to the south, and one across both.
fn boulevard(half: Street, side: Street) -> StreetGraph {
    graph([
        (&[(-200., 0.), (-20., 0.)][..], main_street()),
        (&[(-20., 0.), (0., -8.), (100., -8.)], half.clone()),
        (&[(100., -8.), (200., -8.)], half.clone()),
        (&[(200., -8.), (400., -8.), (420., 0.)], half.clone()),
        (&[(420., 0.), (400., 8.), (300., 8.)], half.clone()),
        (&[(300., 8.), (200., 8.)], half.clone()),
        (&[(200., 8.), (0., 8.), (-20., 0.)], half),
        (&[(420., 0.), (600., 0.)], main_street()),
        (&[(300., 8.), (300., 90.)], side.clone()),
        (&[(100., -8.), (100., -90.)], side.clone()),
        (&[(200., -90.), (200., -8.)], side.clone()),
        (&[(200., -8.), (200., 8.)], side.clone()),
        (&[(200., 8.), (200., 90.)], side),
    ])
}

fn components(graph: &StreetGraph) -> usize {
    let mut seen = vec![false; graph.node_bound()];
    let mut count = 0;
    for (node, _) in graph.nodes() {
        let mut open = vec![node];
        count += usize::from(!seen[node.index()]);
        while let Some(at) = open.pop() {
            if !std::mem::replace(&mut seen[at.index()], true) {
                open.extend(graph.neighbors(at));
            }
        }
    }
    count
}

#[test]
fn two_carriageways_become_one_street_with_the_lanes_of_both() {
    let before = boulevard(oneway(), Street::default());
    let after = simplify(&before, &Simplify::default());
    assert!(exurb_graph::laws::breaches(&after).is_empty());
    let main: Vec<_> = after.edges().filter(|(_, e)| e.data.class == Class::Secondary).collect();
    // 800 m of street, straight through the middle.
    let length: f64 = main.iter().map(|(_, e)| e.length_m()).sum();
    assert!((length - 800.0).abs() < 1.0, "{length}");
    assert!(main.iter().all(|(_, e)| !e.data.oneway));
    // Where nothing but the number of lanes changes, the longer part tells it for both.
    let joined: f64 =
        main.iter().filter(|(_, e)| e.data.lanes == 4).map(|(_, e)| e.length_m()).sum();
    assert!((joined - 200.0).abs() < 1.0, "{joined}");
    assert!(main.iter().all(|(_, e)| e.data.lanes != 4 || e.data.width_m == 14.0));
    assert!(main.iter().flat_map(|(_, e)| e.line()).all(|p| p.y.abs() < 10));
    // Two T-junctions and a crossing, and all side streets reach the middle.
    let mut degrees: Vec<usize> =
        after.nodes().map(|(id, _)| after.degree(id)).filter(|d| *d > 2).collect();
    degrees.sort_unstable();
    assert_eq!(degrees, [3, 3, 4]);
    assert_eq!(components(&after), 1);
}

#[test]
fn simplifying_again_changes_nothing() {
    let once = simplify(&boulevard(oneway(), Street::default()), &Simplify::default());
    let streets = |graph: &StreetGraph| {
        let mut lines: Vec<_> =
            graph.edges().map(|(_, e)| (e.line().to_vec(), e.data.lanes)).collect();
        lines.sort();
        lines
    };
    assert_eq!(streets(&simplify(&once, &Simplify::default())), streets(&once));
}

#[test]
fn a_building_between_keeps_carriageways_apart() {
    let before = boulevard(oneway(), Street::default());
    let row = Polygon::rectangle(GridPoint::m(5., -4.), GridPoint::m(395., 4.));
    let buildings = Arc::new(vec![Building::new(1, row, Provenance::default())]);
    let after = simplify(&before, &Simplify { buildings, ..Simplify::default() });
    let joined: f64 =
        after.edges().filter(|(_, e)| e.data.lanes == 4).map(|(_, e)| e.length_m()).sum();
    assert!(joined < 60.0, "{joined}");
}

#[test]
fn streets_of_one_direction_or_far_apart_stay() {
    let pair = |y: f64, back: bool| {
        let there: [(f64, f64); 2] = [(0., 0.), (500., 0.)];
        let mut other = [(0., y), (500., y)];
        if back {
            other.reverse();
        }
        graph([(&there[..], oneway()), (&other[..], oneway())])
    };
    let count = |g: StreetGraph| simplify(&g, &Simplify::default()).edge_count();
    assert_eq!(count(pair(20., true)), 1);
    assert_eq!(count(pair(20., false)), 2);
    assert_eq!(count(pair(35., true)), 2);
}

#[test]
fn without_tags_streets_are_joined_only_when_asked() {
    let before = boulevard(main_street(), Street::default());
    assert!(!knows_oneways(&before));
    let left = simplify(&before, &Simplify::default());
    assert!((left.length_m() - before.length_m()).abs() < 1.0);
    let asked = Simplify { by_geometry: true, ..Simplify::default() };
    let after = simplify(&before, &asked);
    let main: f64 = after
        .edges()
        .filter(|(_, e)| e.data.class == Class::Secondary)
        .map(|(_, e)| e.length_m())
        .sum();
    assert!((main - 800.0).abs() < 1.0, "{main}");
}

/// Four streets of 100 m that end on a roundabout of the given radius.
fn roundabout(radius: f64) -> StreetGraph {
    let rim = |i: i32| {
        let p = trig::unit(f64::from(i) * std::f64::consts::FRAC_PI_8) * radius;
        (p.x, p.y)
    };
    let arcs: Vec<Vec<(f64, f64)>> =
        (0..4).map(|q| (q * 4..=q * 4 + 4).map(rim).collect()).collect();
    let legs: Vec<Vec<(f64, f64)>> = (0..4)
        .map(|q| {
            let p = trig::unit(f64::from(q) * std::f64::consts::FRAC_PI_2) * 100.0;
            vec![rim(q * 4), (p.x, p.y)]
        })
        .collect();
    let ring = Street { roundabout: true, oneway: true, ..main_street() };
    let arcs = arcs.iter().map(|l| (&l[..], ring.clone()));
    graph(arcs.chain(legs.iter().map(|l| (&l[..], main_street()))))
}

#[test]
fn a_small_roundabout_becomes_a_junction_at_its_centre() {
    let after = simplify(&roundabout(15.0), &Simplify::default());
    assert_eq!((after.edge_count(), after.node_count()), (4, 5));
    let center = after.nodes().find(|(id, _)| after.degree(*id) == 4).map(|(_, n)| n.at);
    assert_eq!(center, Some(GridPoint::m(0., 0.)));
    assert!((after.length_m() - 400.0).abs() < 0.01);
}

#[test]
fn large_roundabouts_and_kept_ones_stay() {
    assert_eq!(simplify(&roundabout(25.0), &Simplify::default()).edge_count(), 8);
    let keep = Simplify { keep_circles: true, ..Simplify::default() };
    assert_eq!(simplify(&roundabout(15.0), &keep).edge_count(), 8);
}

#[test]
fn cut_ends_stay_cut_ends() {
    let mut before = boulevard(oneway(), Street::default());
    let ends: Vec<_> = before.nodes().filter(|(id, _)| before.degree(*id) == 1).collect();
    let ends: Vec<_> = ends.into_iter().map(|(id, _)| id).collect();
    for id in &ends {
        before.node_mut(*id).data.cut = true;
    }
    let after = simplify(&before, &Simplify::default());
    let cut = after.nodes().filter(|(_, n)| n.data.cut).count();
    assert_eq!(cut, ends.len());
}
