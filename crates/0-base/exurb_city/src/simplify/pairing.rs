//! Which carriageways run side by side.

use exurb_geom::{BoxGrid, GridPoint, SegmentGrid, Vec2, grid, polyline};
use exurb_graph::{Dart, EdgeId, NodeId};

use super::Simplify;
use crate::{Role, Street, StreetGraph};

/// Carriageways are looked at about this often along their length, in metres.
const SAMPLE_M: f64 = 10.0;
/// Partners may turn away from each other by this much: cosine of 30° (oneways), of 20° (others).
const OPPOSITE_COS: f64 = 0.866;
const PARALLEL_COS: f64 = 0.94;
/// Stretches with or without a partner shorter than this follow their surroundings, in metres.
const LEAST_STRETCH_M: f64 = 30.0;
/// Local streets without tags are carriageways only when nearer than this, in metres.
const LOCAL_GAP_M: f64 = 18.0;
/// Without tags only pairs that go on for this long are carriageways, both together, in metres.
const LEAST_UNTAGGED_M: f64 = 250.0;

/// All streets, to look up partners.
pub struct Carriageways<'a> {
    pub graph: &'a StreetGraph,
    options: &'a Simplify,
    /// All streets, and those that can be one half of a pair.
    all: Linework,
    halves: Linework,
    candidate: Vec<bool>,
    buildings: BoxGrid,
}

/// Segments of streets to look up.
struct Linework {
    grid: SegmentGrid,
    owners: Vec<EdgeId>,
}

impl Linework {
    fn of(graph: &StreetGraph, counts: impl Fn(EdgeId) -> bool) -> Self {
        let (mut owners, mut segments) = (Vec::new(), Vec::new());
        for (id, edge) in graph.edges().filter(|(id, _)| counts(*id)) {
            for w in edge.line().windows(2) {
                owners.push(id);
                segments.push((w[0], w[1]));
            }
        }
        Self { grid: SegmentGrid::new(segments), owners }
    }
}

/// Where the partner of a carriageway runs beside a point of it.
#[derive(Clone, Copy, Debug)]
pub struct Beside {
    pub edge: EdgeId,
    pub at: Vec2,
    pub distance_m: f64,
}

impl<'a> Carriageways<'a> {
    pub fn of(graph: &'a StreetGraph, options: &'a Simplify) -> Self {
        let mut candidate = vec![false; graph.edge_bound()];
        for (id, edge) in graph.edges() {
            candidate[id.index()] = may_be_half(&edge.data, options);
        }
        let all = Linework::of(graph, |_| true);
        let halves = Linework::of(graph, |id| candidate[id.index()]);
        let buildings = BoxGrid::of(options.buildings.iter().map(|b| &b.polygon));
        Self { graph, options, all, halves, candidate, buildings }
    }

    pub fn is_candidate(&self, edge: EdgeId) -> bool {
        self.candidate[edge.index()]
    }

    /// The nearest carriageway against `direction` beside the point `at` of `edge`, among those
    /// that `counts`, with nothing between.
    pub fn partner(
        &self,
        edge: EdgeId,
        at: Vec2,
        direction: Vec2,
        counts: impl Fn(EdgeId) -> bool,
    ) -> Option<Beside> {
        let mut near = Vec::new();
        let p = GridPoint::round(at);
        self.halves.grid.near(p, p, self.gap_mm(), &mut near);
        self.partner_among(&near, edge, at, direction, counts)
    }

    fn gap_mm(&self) -> i32 {
        (self.options.gap_m * 1000.0) as i32
    }

    /// [`Self::partner`] among some segments, which hold all within the gap around `at`.
    fn partner_among(
        &self,
        near: &[u32],
        edge: EdgeId,
        at: Vec2,
        direction: Vec2,
        counts: impl Fn(EdgeId) -> bool,
    ) -> Option<Beside> {
        let own = &self.graph.edge(edge).data;
        let mut best: Option<Beside> = None;
        for piece in near {
            let other = self.halves.owners[*piece as usize];
            if other == edge || !counts(other) {
                continue;
            }
            let (a, b) = self.halves.grid.segment(*piece);
            let (q, _) = polyline::nearest_on_segment(a.to_m(), b.to_m(), at);
            let distance_m = q.distance(at);
            let turn = (b.to_m() - a.to_m()).normalize().dot(direction);
            let facing = if self.options.by_geometry && !own.oneway {
                turn.abs() > PARALLEL_COS
            } else {
                turn < -OPPOSITE_COS
            };
            // Beside, not ahead or behind.
            let beside = (q - at).dot(direction).abs() <= 0.5 * distance_m;
            if facing
                && beside
                && distance_m < self.reach_m(own)
                && best.is_none_or(|b| distance_m < b.distance_m)
                && belong_together(own, &self.graph.edge(other).data)
            {
                best = Some(Beside { edge: other, at: q, distance_m });
            }
        }
        best.filter(|found| self.is_clear(edge, found, GridPoint::round(at)))
    }

    /// How far the partner of a street may run. Local streets that are no oneways are not taken for
    /// carriageways unless they run as near each other as no two rows of lots would let them.
    fn reach_m(&self, street: &Street) -> f64 {
        if street.oneway || street.role() == Role::Main {
            self.options.gap_m
        } else {
            self.options.gap_m.min(LOCAL_GAP_M)
        }
    }

    /// Neither street, on whatever level, nor building between?
    fn is_clear(&self, edge: EdgeId, found: &Beside, p: GridPoint) -> bool {
        let q = GridPoint::round(found.at);
        let mut near = Vec::new();
        self.all.grid.near(p, q, 0, &mut near);
        let street = near.iter().any(|piece| {
            let other = self.all.owners[*piece as usize];
            let (a, b) = self.all.grid.segment(*piece);
            other != edge && other != found.edge && grid::cross_properly(p, q, a, b)
        });
        if street {
            return false;
        }
        let lo = GridPoint { x: p.x.min(q.x), y: p.y.min(q.y) };
        let hi = GridPoint { x: p.x.max(q.x), y: p.y.max(q.y) };
        self.buildings.meeting(lo, hi, &mut near);
        !near.iter().any(|i| {
            let outline = &self.options.buildings[*i as usize].polygon;
            outline.segments().any(|(a, b)| grid::cross_properly(p, q, a, b))
        })
    }

    /// Does another carriageway of the same road meet the tail of `dart`, side by side with it?
    fn meets_half(&self, dart: Dart) -> bool {
        let own = &self.graph.edge(dart.edge()).data;
        let leaving = self.graph.direction(dart, 15.0);
        self.graph.darts(self.graph.tail(dart)).iter().any(|other| {
            other.edge() != dart.edge()
                && self.is_candidate(other.edge())
                && (!own.oneway || other.is_forward() != dart.is_forward())
                && belong_together(own, &self.graph.edge(other.edge()).data)
                && self.graph.direction(*other, 15.0).dot(leaving) > 0.3
        })
    }

    /// Samples along an edge: metres along it, and does a partner run beside?
    fn samples(&self, edge: EdgeId) -> Vec<(f64, bool)> {
        // What lies along the edge is looked up once for all its samples.
        let (mut near, mut beside) = (Vec::new(), Vec::new());
        for w in self.graph.edge(edge).line().windows(2) {
            self.halves.grid.near(w[0], w[1], self.gap_mm() + 1, &mut near);
            beside.append(&mut near);
        }
        beside.sort_unstable();
        beside.dedup();
        let line = self.graph.edge(edge).line_m();
        let length = polyline::length(&line);
        let count = (length / SAMPLE_M).ceil().max(3.0);
        (0..count as usize)
            .map(|i| {
                let along = (i as f64 + 0.5) * length / count;
                let point = |m| polyline::point_at(&line, m);
                let step = point(along + 1.0) - point(along - 1.0);
                let found = step.length() > 0.0
                    && self
                        .partner_among(&beside, edge, point(along), step.normalize(), |_| true)
                        .is_some();
                (along, found)
            })
            .collect()
    }
}

/// Can the street be one half of a pair?
fn may_be_half(street: &Street, options: &Simplify) -> bool {
    let link = street.class.as_str().ends_with("_link");
    let tagged = street.oneway && !street.roundabout && !link;
    let untagged = options.by_geometry && !link && !street.oneway && !street.roundabout;
    tagged || untagged
}

fn belong_together(a: &Street, b: &Street) -> bool {
    a.oneway == b.oneway
        && a.crossing_level() == b.crossing_level()
        && (a.class == b.class || (a.name.is_some() && a.name == b.name))
}

/// Step 2: splits carriageways where a partner begins or ends to run beside them.
pub fn split_where_partners_change(graph: &mut StreetGraph, options: &Simplify) {
    let mut cuts: Vec<(EdgeId, Vec<GridPoint>)> = Vec::new();
    {
        let carriageways = Carriageways::of(graph, options);
        for (id, edge) in graph.edges().filter(|(id, _)| carriageways.is_candidate(*id)) {
            let line = edge.line_m();
            let meets = [id.forward(), id.backward()].map(|dart| carriageways.meets_half(dart));
            let places = changes(&carriageways.samples(id), polyline::length(&line), meets);
            let points: Vec<GridPoint> =
                places.iter().map(|m| GridPoint::round(polyline::point_at(&line, *m))).collect();
            if !points.is_empty() {
                cuts.push((id, points));
            }
        }
    }
    for (id, points) in cuts {
        let mut rest = id;
        for p in points {
            if let Some((_, _, tail)) = graph.split_edge(rest, p) {
                rest = tail;
            }
        }
    }
}

/// Where samples change between with and without, in metres along, short stretches left out.
/// `meets`: does the start, the end lie where the two halves meet?
fn changes(samples: &[(f64, bool)], length: f64, meets: [bool; 2]) -> Vec<f64> {
    let mut runs: Vec<(f64, bool)> = Vec::new(); // start, with
    for (i, (along, with)) in samples.iter().enumerate() {
        let start = if i == 0 { 0.0 } else { f64::midpoint(samples[i - 1].0, *along) };
        if runs.last().is_none_or(|(_, last)| last != with) {
            runs.push((start, *with));
        }
    }
    // Drop the shortest run while it is too short; its neighbours close over it. An end without a
    // partner, where carriageways part towards a roundabout, is one however short.
    loop {
        let end = |i: usize| runs.get(i + 1).map_or(length, |(start, _)| *start);
        let is_end = |i: usize| (i == 0 && !meets[0]) || (i + 1 == runs.len() && !meets[1]);
        let shortest = (0..runs.len())
            .filter(|i| runs[*i].1 || !is_end(*i))
            .map(|i| (end(i) - runs[i].0, i))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        match shortest {
            Some((m, i)) if m < LEAST_STRETCH_M && runs.len() > 1 => {
                runs.remove(i);
                runs.dedup_by_key(|(_, with)| *with);
                runs[0].0 = 0.0;
            }
            _ => break,
        }
    }
    runs.iter().skip(1).map(|(start, _)| *start).collect()
}

/// Step 3: carriageways with a partner along most of their length.
pub fn mark_dual(graph: &StreetGraph, options: &Simplify) -> Vec<bool> {
    let carriageways = Carriageways::of(graph, options);
    let mut dual = vec![false; graph.edge_bound()];
    for (id, _) in graph.edges().filter(|(id, _)| carriageways.is_candidate(*id)) {
        let samples = carriageways.samples(id);
        let with = samples.iter().filter(|(_, with)| *with).count();
        dual[id.index()] = 2 * with > samples.len();
    }
    if options.by_geometry {
        drop_short_untagged(graph, &mut dual);
    }
    dual
}

/// Without oneway tags, side by side for a short while says nothing.
fn drop_short_untagged(graph: &StreetGraph, dual: &mut [bool]) {
    let mut seen = vec![false; graph.node_bound()];
    for (node, _) in graph.nodes() {
        if std::mem::replace(&mut seen[node.index()], true) {
            continue;
        }
        let mut edges: Vec<EdgeId> = Vec::new();
        let mut open: Vec<NodeId> = vec![node];
        while let Some(at) = open.pop() {
            for dart in graph.darts(at).iter().filter(|d| dual[d.edge().index()]) {
                edges.push(dart.edge());
                let head = graph.head(*dart);
                if !std::mem::replace(&mut seen[head.index()], true) {
                    open.push(head);
                }
            }
        }
        edges.sort_unstable();
        edges.dedup();
        let untagged = edges.iter().any(|id| !graph.edge(*id).data.oneway);
        let length: f64 = edges.iter().map(|id| graph.edge(*id).length_m()).sum();
        if untagged && length < LEAST_UNTAGGED_M / 2.0 {
            for id in edges {
                dual[id.index()] = false;
            }
        }
    }
}
