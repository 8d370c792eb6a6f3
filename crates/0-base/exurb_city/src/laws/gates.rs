//! Likeness gates: shares that a synthesised city should have in common with its example.
//!
//! Measured on the network inside the target, cut ends left out. The limits are set so that windows
//! of 2 km of one real city mostly pass against the rest of it.
//!
//! | gate | what is measured | limit |
//! |---|---|---|
//! | `dead_end_share` | dead ends among all nodes of degree other than 2 | 0.4 to 1.8 times the example's |
//! | `near_miss_share` | dead ends with another street within 12 m, which they do not join | example + 0.10 |
//! | `legs_under_15` | junctions with two legs over 10 m less than 15° apart | example + 0.05 |
//! | `legs_under_30` | the same, less than 30° | example + 0.08 |
//! | `slivers_per_100_blocks` | faces under 250 m² or 10 m mean width per 100 others | example + 25 |

use std::collections::BTreeMap;

use exurb_geom::{GridPoint, SegmentGrid, polyline, trig};
use exurb_graph::{Dart, EdgeId, Faces};

use super::inside::{Inside, clipped};
use crate::block::ISLAND_WIDTH_M;
use crate::{City, block};

/// Names of the gates: keys of [`gates`], of the metadata and of reports.
pub const NAMES: [&str; 5] = [
    "dead_end_share",
    "near_miss_share",
    "legs_under_15",
    "legs_under_30",
    "slivers_per_100_blocks",
];

/// A dead end and a street nearer than this miss each other, in metres.
const NEAR_MISS_M: f64 = 12.0;
/// Legs this long have a direction, taken over their first 15 m.
const LEAST_LEG_M: f64 = 10.0;
const LEG_M: f64 = 15.0;
/// Faces below this area are slivers, in m².
const LEAST_FACE_M2: f64 = 250.0;

/// One gate, as compared with an example.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gate {
    /// The city's value; `None` where it has nothing to measure.
    pub value: Option<f64>,
    /// The least that passes, where the gate has a lower side.
    pub limit_min: Option<f64>,
    /// The most that passes; `None` without an example.
    pub limit: Option<f64>,
    /// Does it pass? `None` when value or limit is missing.
    pub pass: Option<bool>,
}

/// The city's values of the gates; what it has nothing to measure for is left out. O(n log n).
pub fn gates(city: &City) -> BTreeMap<String, f64> {
    let inside = Inside::of(city);
    let (under_15, under_30) = narrow_legs(&inside);
    let values = [
        dead_end_share(&inside),
        near_miss_share(&inside),
        under_15,
        under_30,
        slivers_per_100_blocks(city),
    ];
    let known = NAMES.iter().zip(values);
    known.filter_map(|(name, value)| Some(((*name).to_owned(), value?))).collect()
}

/// Compares a city's values with an example's. Every gate is there, with `None` for what is unknown.
pub fn compare_gates(
    values: &BTreeMap<String, f64>,
    example: Option<&BTreeMap<String, f64>>,
) -> BTreeMap<&'static str, Gate> {
    let gate = |name: &'static str| {
        let value = values.get(name).copied();
        let model = example.and_then(|e| e.get(name)).copied();
        let limit = model.map(|m| match name {
            "dead_end_share" => m * 1.8,
            "near_miss_share" => m + 0.10,
            "legs_under_15" => m + 0.05,
            "legs_under_30" => m + 0.08,
            _ => m + 25.0,
        });
        let limit_min = model.filter(|_| name == "dead_end_share").map(|m| m * 0.4);
        let pass = value.zip(limit).map(|(v, most)| v <= most && limit_min.is_none_or(|l| v >= l));
        (name, Gate { value, limit_min, limit, pass })
    };
    NAMES.into_iter().map(gate).collect()
}

fn share(part: usize, whole: usize) -> Option<f64> {
    (whole > 0).then(|| part as f64 / whole as f64)
}

fn dead_ends(inside: &Inside) -> Vec<Dart> {
    inside
        .own_nodes()
        .filter_map(|n| match inside.graph.darts(n) {
            [only] => Some(*only),
            _ => None,
        })
        .collect()
}

fn dead_end_share(inside: &Inside) -> Option<f64> {
    let nodes = inside.own_nodes().filter(|n| inside.graph.degree(*n) != 2).count();
    share(dead_ends(inside).len(), nodes)
}

fn near_miss_share(inside: &Inside) -> Option<f64> {
    let graph = &inside.graph;
    let mut owners: Vec<EdgeId> = Vec::new();
    let mut segments: Vec<(GridPoint, GridPoint)> = Vec::new();
    for (id, edge) in graph.edges() {
        for w in edge.line().windows(2) {
            owners.push(id);
            segments.push((w[0], w[1]));
        }
    }
    let grid = SegmentGrid::new(segments);
    let ends = dead_ends(inside);
    let mut near = Vec::new();
    let misses = ends.iter().filter(|end| {
        let at = graph.node(graph.tail(**end)).at;
        grid.near(at, at, (NEAR_MISS_M * 1000.0) as i32, &mut near);
        near.iter().any(|i| {
            let (a, b) = grid.segment(*i);
            owners[*i as usize] != end.edge()
                && polyline::nearest_on_segment(a.to_m(), b.to_m(), at.to_m()).0.distance(at.to_m())
                    <= NEAR_MISS_M
        })
    });
    share(misses.count(), ends.len())
}

/// Shares of junctions with two legs less than 15° and 30° apart.
fn narrow_legs(inside: &Inside) -> (Option<f64>, Option<f64>) {
    let graph = &inside.graph;
    let (mut junctions, mut under_15, mut under_30) = (0, 0, 0);
    for node in inside.own_nodes().filter(|n| graph.degree(*n) >= 3) {
        junctions += 1;
        let mut angles: Vec<f64> = graph
            .darts(node)
            .iter()
            .filter(|d| graph.edge(d.edge()).length_m() > LEAST_LEG_M)
            .map(|d| trig::angle(graph.direction(*d, LEG_M)))
            .collect();
        angles.sort_by(f64::total_cmp);
        let count = angles.len();
        let least = (0..count)
            .filter(|_| count > 1)
            .map(|i| {
                let between = angles[(i + 1) % count] - angles[i];
                trig::wrap(between).abs()
            })
            .fold(f64::INFINITY, f64::min);
        under_15 += usize::from(least < 15f64.to_radians());
        under_30 += usize::from(least < 30f64.to_radians());
    }
    (share(under_15, junctions), share(under_30, junctions))
}

fn slivers_per_100_blocks(city: &City) -> Option<f64> {
    let bounds = block::bounding_edges(&city.streets);
    let graph = clipped(city);
    let faces = Faces::of(&graph, |id| bounds[graph.edge(id).data.index()]);
    let (slivers, blocks): (Vec<_>, Vec<_>) = faces.list.iter().partition(|face| {
        face.polygon.area_m2() < LEAST_FACE_M2 || face.polygon.mean_width_m() < ISLAND_WIDTH_M
    });
    (!blocks.is_empty()).then(|| 100.0 * slivers.len() as f64 / blocks.len() as f64)
}
