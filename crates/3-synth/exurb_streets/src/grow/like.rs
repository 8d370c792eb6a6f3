//! The place of an example whose streets are most like a drawn fragment.
//!
//! Nishida et al. 2015 begin growth at a place of the example that the user points at; here a sketch
//! of some streets finds it, in one example or in a library of many.
//!
//! Growth then learns from the surroundings of that place alone, so that what was drawn goes on.
//!
//! Junctions of the example are looked at one by one, the streets around each compared with the
//! fragment in what they are like (lengths, bends, degrees, angles, alignment, slope). Around
//! the likest ones the fragment is laid on the streets, junction on junction and street on street, and
//! the mean distance between both is what decides.

use exurb_city::{City, Street};
use std::sync::Arc;

use exurb_city::street_graph::{self, StreetGraph};
use exurb_geom::{Bounds, GridPoint, LonLat, Polygon, SegmentIndex, Vec2, overlay, polyline, trig};
use exurb_graph::{EdgeId, NodeId, noding};
use exurb_operation::Lines;
use rayon::prelude::*;

use super::error::Error;
use super::polish::{Profile, Weights};
use super::prepare;

/// A fragment has at least so many streets.
const LEAST_STREETS: usize = 4;
/// Ends of lines this near to another line meet it, in metres.
const SNAP_M: f64 = 3.0;
/// Growth learns from streets around the place up to this many times as far as the fragment reaches,
/// and up to this far at least. Metres.
const AROUND: f64 = 3.0;
const LEAST_AROUND_M: f64 = 1000.0;
/// Points are compared this far apart, in metres.
const STEP_M: f64 = 12.0;
/// Streets farther apart than this have nothing to do with each other, in metres.
const APART_M: f64 = 40.0;
/// Places whose streets are laid on the fragment, for each example.
const LAID: usize = 700;
/// Of these, places that are measured with all points instead of every fourth.
const MEASURED: usize = 48;
const STRIDE: usize = 4;
/// What lies near a drawn street counts for this share, what lies near a street of the example for the
/// rest: nobody draws every street.
const DRAWN_SHARE: f64 = 0.75;
/// How much unlikeness in kind counts beside distance.
const KIND: f64 = 0.2;
/// Of these, places where the fragment is moved and turned a little to lie better.
const SHIFTED: usize = 12;
/// A slope that differs by this counts as much as streets that have nothing in common.
const SLOPE_UNIT: f64 = 0.15;
/// Streets around a place beyond the fragment's own reach do not count, but their ends are no dead
/// ends. As a share of the reach.
const RIM: f64 = 0.85;

/// A drawn fragment.
#[derive(Debug)]
pub struct Fragment {
    profile: Profile,
    alignment: f64,
    reach_m: f64,
    /// Points along its streets, around its anchor.
    points: Vec<Vec2>,
    index: SegmentIndex,
    /// Directions in which streets leave its anchor.
    legs: Vec<Vec2>,
    /// Mean slope of the ground that it is drawn on.
    slope: Option<f64>,
    /// Where its anchor lies in the target.
    pub at: Option<Vec2>,
}

/// Where an example is like the fragment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// The place in the example that the fragment's anchor lies on.
    pub source: Vec2,
    /// By how much the example is turned there to lie as the fragment does, in radians.
    pub turn_rad: f64,
    /// Mean distance between the streets of both, in metres.
    pub apart_m: f64,
    /// 0 is the same.
    pub cost: f64,
}

/// The likest of what was found in several examples, with the example's number.
pub fn likest(found: Vec<Option<Found>>) -> Option<(usize, Found)> {
    let found = found.into_iter().enumerate().filter_map(|(i, f)| Some((i, f?)));
    found.min_by(|a, b| a.1.cost.total_cmp(&b.1.cost).then(a.0.cmp(&b.0)))
}

/// The fragment laid on a place.
struct Laid {
    center: Vec2,
    /// Points along the example's streets, around the center.
    points: Vec<Vec2>,
    unlike: f64,
    turn_rad: f64,
    off: Vec2,
    apart_m: f64,
}

impl Laid {
    fn cost(&self) -> f64 {
        KIND * self.unlike + 4.0 * self.apart_m / APART_M
    }
}

/// What the streets within reach of a place are like.
struct Around {
    profile: Profile,
    alignment: f64,
}

impl Fragment {
    /// The fragment of the lines, drawn on or off the target of `city`.
    pub fn of(lines: &Lines, city: Option<&City>) -> Result<Self, Error> {
        let drawn = lines.lines.iter().map(|line| noding::Line {
            points: line.iter().map(|p| GridPoint::m(p[0], p[1])).collect(),
            level: 0,
            data: Street::default(),
        });
        // Hands leave gaps.
        let options = noding::Options { snap_m: SNAP_M, ..Default::default() };
        let noded = noding::node(drawn.collect(), options);
        let mut streets =
            street_graph::from_lines(noded.into_iter().map(|line| (line.points, line.data)));
        street_graph::dissolve_all(&mut streets);
        let count = streets.edge_count();
        if count < LEAST_STREETS {
            return Err(Error::Like(format!(
                "holds {count} streets between junctions, too few to look for; draw {LEAST_STREETS} or more"
            )));
        }
        let nodes: Vec<Vec2> = streets.nodes().map(|(_, n)| n.at.to_m()).collect();
        let middle = nodes.iter().copied().sum::<Vec2>() / nodes.len() as f64;
        let anchor = anchor(&streets, middle)?;
        let center = streets.node(anchor).at.to_m();
        let reach_m = nodes.iter().map(|p| p.distance(center)).fold(0.0, f64::max);
        // Its outer ends are where the drawing ends, not dead ends.
        let ends: Vec<NodeId> = streets.nodes().map(|(id, _)| id).collect();
        for id in ends {
            let off_m = streets.node(id).at.to_m().distance(center);
            if streets.degree(id) == 1 && off_m > reach_m / 2.0 {
                streets.node_mut(id).data.cut = true;
            }
        }
        let around = Around::of(&streets, center, reach_m, None);
        let (mut points, mut index) = (Vec::new(), SegmentIndex::new(APART_M));
        for (id, edge) in streets.edges() {
            let line: Vec<Vec2> = edge.line_m().into_iter().map(|p| p - center).collect();
            index.insert_line(id.0, &line);
            points.extend(polyline::resample(&line, STEP_M));
        }
        let origin = LonLat { lon: lines.origin[0], lat: lines.origin[1] };
        let at = city.and_then(|city| {
            let at = city.frame.project(origin)? + center;
            city.target.contains(GridPoint::round(at)).then_some(at)
        });
        let terrain = city.and_then(|city| city.terrain.as_ref()).zip(at);
        let slope = terrain
            .and_then(|(terrain, at)| mean(points.iter().filter_map(|p| terrain.slope(at + *p))));
        let legs = streets.darts(anchor).iter().map(|d| streets.direction(*d, 30.0)).collect();
        let Around { profile, alignment } = around;
        Ok(Self { profile, alignment, reach_m, points, index, legs, slope, at })
    }

    /// The place of an example that is most like it; `None` where the example has no junctions.
    /// O(junctions · streets around each).
    pub fn place_in(&self, city: &City) -> Option<Found> {
        let graph = prepare::learnable(&city.streets, &city.buildings);
        let mut index = SegmentIndex::new(60.0);
        for (id, edge) in graph.edges() {
            index.insert_line(id.0, &edge.line_m());
        }
        let junctions: Vec<NodeId> =
            graph.nodes().map(|(id, _)| id).filter(|id| graph.degree(*id) >= 3).collect();
        let mut likest: Vec<(f64, NodeId)> = junctions
            .par_iter()
            .map(|id| {
                let center = graph.node(*id).at.to_m();
                let around = Around::of(&graph, center, self.reach_m, Some(&index));
                let slope = city.terrain.as_ref().and_then(|t| t.slope(center));
                (self.unlike(&around, slope), *id)
            })
            .collect();
        likest.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        likest.truncate(LAID);
        let mut laid: Vec<Laid> = likest
            .par_iter()
            .filter_map(|(unlike, id)| self.laid_on(&graph, &index, *id, *unlike))
            .collect();
        laid.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
        laid.truncate(MEASURED);
        for laid in &mut laid {
            laid.apart_m = self.apart_m(&index, laid, laid.turn_rad, laid.off, 1);
        }
        laid.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
        laid.truncate(SHIFTED);
        let found: Vec<Found> =
            laid.into_par_iter().map(|laid| self.shifted(&index, laid)).collect();
        found.into_iter().min_by(|a, b| a.cost.total_cmp(&b.cost))
    }

    /// What growth learns from: the example around the place.
    pub fn around(&self, city: &City, source: Vec2) -> City {
        let reach_m = (self.reach_m * AROUND).max(LEAST_AROUND_M);
        let corner = |sign: f64| GridPoint::round(source + sign * reach_m);
        let square = Polygon::rectangle(corner(-1.0), corner(1.0));
        let parts = overlay::intersection(&square, &city.target);
        let mut out = city.clone();
        out.target =
            parts.into_iter().find(|p| p.boundary_distance_m(source) > 0.0).unwrap_or(square);
        let mut streets = (*city.streets).clone();
        for node in streets.clip(&out.target) {
            streets.node_mut(node).data.cut = true;
        }
        out.streets = Arc::new(streets.compacted());
        out
    }

    /// How much what is around a place differs from the fragment in kind. How dense streets are does
    /// not count: nobody draws every street.
    fn unlike(&self, around: &Around, slope: Option<f64>) -> f64 {
        let weights = Weights { lengths: 1.0, bends: 1.0, junctions: 1.0, density: 0.0 };
        let slopes = self.slope.zip(slope).map_or(0.0, |(a, b)| (a - b).abs() / SLOPE_UNIT);
        around.profile.distance(&self.profile, &weights) / 4.0
            + (around.alignment - self.alignment).abs()
            + slopes.min(2.0)
    }

    /// The fragment laid on a junction, turned so that streets fall on streets.
    fn laid_on(
        &self,
        graph: &StreetGraph,
        index: &SegmentIndex,
        junction: NodeId,
        unlike: f64,
    ) -> Option<Laid> {
        let center = graph.node(junction).at.to_m();
        let bounds = Bounds { min: center, max: center }.grown(self.reach_m);
        let ids = index.ids(bounds);
        let points: Vec<Vec2> = ids
            .iter()
            .flat_map(|id| polyline::resample(&graph.edge(EdgeId(*id)).line_m(), STEP_M))
            .map(|p| p - center)
            .filter(|p| p.length() <= self.reach_m * RIM)
            .collect();
        let turns = graph.darts(junction).iter().flat_map(|dart| {
            let there = graph.direction(*dart, 30.0);
            // The turn takes the example's street to the fragment's.
            self.legs.iter().map(move |own| Vec2::new(there.dot(*own), there.perp_dot(*own)))
        });
        let turns: Vec<f64> = turns.map(trig::angle).collect();
        let laid = Laid { center, points, unlike, turn_rad: 0.0, off: Vec2::ZERO, apart_m: 0.0 };
        let measured = turns
            .into_iter()
            .map(|turn_rad| (self.apart_m(index, &laid, turn_rad, Vec2::ZERO, STRIDE), turn_rad));
        let (apart_m, turn_rad) = measured.min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(Laid { apart_m, turn_rad, ..laid })
    }

    /// Mean distance between the fragment and the streets it is laid on, turned by that and moved; every
    /// `stride`th point is looked at.
    fn apart_m(
        &self,
        index: &SegmentIndex,
        laid: &Laid,
        turn_rad: f64,
        off: Vec2,
        stride: usize,
    ) -> f64 {
        let (turn, back) = (trig::unit(turn_rad), trig::unit(-turn_rad));
        let center = laid.center + off;
        let there =
            self.points.iter().step_by(stride).map(|p| near_m(index, center + back.rotate(*p)));
        let here =
            laid.points.iter().step_by(stride).map(|p| near_m(&self.index, turn.rotate(*p - off)));
        let [there, here] = [mean(there), mean(here)].map(|m| m.unwrap_or(APART_M));
        DRAWN_SHARE * there + (1.0 - DRAWN_SHARE) * here
    }

    /// Moved and turned a little as long as that brings both nearer: ever smaller steps.
    fn shifted(&self, index: &SegmentIndex, mut laid: Laid) -> Found {
        let (mut turn_rad, mut move_m) = (0.06, 12.0);
        while move_m > 1.0 {
            let steps = [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)];
            let moved = steps.map(|(x, y)| (laid.turn_rad, laid.off + Vec2::new(x, y) * move_m));
            let turned = [-1.0, 1.0].map(|sign| (laid.turn_rad + sign * turn_rad, laid.off));
            let tried = moved.into_iter().chain(turned);
            let measured =
                tried.map(|(turn, off)| (self.apart_m(index, &laid, turn, off, 1), turn, off));
            match measured.min_by(|a, b| a.0.total_cmp(&b.0)) {
                Some((apart_m, turn_rad, off)) if apart_m < laid.apart_m - 0.01 => {
                    laid = Laid { apart_m, turn_rad, off, ..laid };
                }
                _ => (turn_rad, move_m) = (turn_rad / 2.0, move_m / 2.0),
            }
        }
        Found {
            source: laid.center + laid.off,
            turn_rad: laid.turn_rad,
            apart_m: laid.apart_m,
            cost: laid.cost(),
        }
    }
}

impl Around {
    fn of(graph: &StreetGraph, center: Vec2, reach_m: f64, index: Option<&SegmentIndex>) -> Self {
        let is_near = |p: GridPoint| p.to_m().distance(center) <= reach_m + 0.01;
        let bounds = Bounds { min: center, max: center }.grown(reach_m);
        let ids = match index {
            Some(index) => index.ids(bounds),
            None => graph.edges().map(|(id, _)| id.0).collect(),
        };
        let mut profile = Profile::EMPTY;
        let (mut length_m, mut fourfold) = (0.0, Vec2::ZERO);
        let mut nodes = Vec::new();
        for id in ids.into_iter().map(EdgeId) {
            let edge = graph.edge(id);
            let near = [edge.from, edge.to].map(|n| is_near(graph.node(n).at));
            if near == [true, true] {
                profile.count_street(graph, id, 1.0);
            }
            nodes.extend([edge.from, edge.to].into_iter().filter(|n| is_near(graph.node(*n).at)));
            for w in edge.line_m().windows(2) {
                if w[0].lerp(w[1], 0.5).distance(center) > reach_m {
                    continue;
                }
                let along = w[1] - w[0];
                let length = along.length();
                length_m += length;
                // Four times the angle, so that crossings of right angles count as aligned.
                fourfold += trig::unit(4.0 * trig::angle(along)) * length;
            }
        }
        nodes.sort_unstable();
        nodes.dedup();
        nodes.into_iter().for_each(|n| profile.count_node(graph, n, 1.0));
        Self { profile, alignment: fourfold.length() / length_m.max(1.0) }
    }
}

/// The junction of most streets, of these the one nearest to `middle`: where a fragment is laid on an
/// example's junction.
fn anchor(streets: &StreetGraph, middle: Vec2) -> Result<NodeId, Error> {
    let off = |n: GridPoint| n.to_m().distance(middle);
    let anchor = streets.nodes().map(|(id, n)| (id, n.at)).max_by(|(a, p), (b, q)| {
        let degrees = streets.degree(*a).min(4).cmp(&streets.degree(*b).min(4));
        degrees.then(off(*q).total_cmp(&off(*p))).then(b.cmp(a))
    });
    let anchor = anchor.map(|(id, _)| id).filter(|id| streets.degree(*id) >= 3);
    anchor.ok_or_else(|| Error::Like("holds no junction of three streets; draw one".into()))
}

/// Distance to the nearest street, [`APART_M`] at most.
fn near_m(index: &SegmentIndex, p: Vec2) -> f64 {
    index.nearest_m(p, APART_M).unwrap_or(APART_M)
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0.0), |(s, n), v| (s + v, n + 1.0));
    (count > 0.0).then_some(sum / count)
}
