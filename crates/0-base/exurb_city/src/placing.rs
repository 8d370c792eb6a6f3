//! Which block and parcel things lie in, and what blocks are used for.

use std::sync::Arc;

use exurb_geom::{BoxGrid, GridPoint, Polygon, SegmentGrid, Vec2, polyline};
use exurb_graph::EdgeId;
use rayon::prelude::*;

use crate::{Area, Block, Building, Feature, FeatureShape, Parcel, StreetGraph};

/// Points sampled in a block to find its prevailing land use.
const SAMPLES: f64 = 100.0;

/// Polygons that can be asked for the one that holds a point.
struct Lookup<'a, T> {
    list: &'a [T],
    polygon: fn(&T) -> &Polygon,
    boxes: BoxGrid,
}

impl<'a, T> Lookup<'a, T> {
    fn new(list: &'a [T], polygon: fn(&T) -> &Polygon) -> Self {
        Self { list, polygon, boxes: BoxGrid::of(list.iter().map(polygon)) }
    }

    /// The number of the first one that holds `p`, counted from 1; 0 when none does.
    fn number(&self, p: Vec2) -> u32 {
        let p = GridPoint::round(p);
        let mut near = Vec::new();
        self.boxes.meeting(p, p, &mut near);
        let found = near.iter().find(|i| (self.polygon)(&self.list[**i as usize]).contains(p));
        found.map_or(0, |i| i + 1)
    }
}

/// Numbers all elements from 1 and tells buildings, parcels and features their block, and buildings
/// their parcel, by a point inside. Blocks are numbered already.
pub fn place(
    blocks: &[Block],
    parcels: &mut [Parcel],
    buildings: &mut [Building],
    features: &mut [Feature],
) {
    let in_blocks = Lookup::new(blocks, |b| &b.polygon);
    for (parcel, id) in parcels.iter_mut().zip(1..) {
        parcel.id = id;
        parcel.block = in_blocks.number(parcel.polygon.interior_point());
    }
    let in_parcels = Lookup::new(parcels, |p| &p.polygon);
    buildings.par_iter_mut().enumerate().for_each(|(i, building)| {
        let at = building.polygon.interior_point();
        building.id = i as u32 + 1;
        building.block = in_blocks.number(at);
        building.parcel = in_parcels.number(at);
    });
    for (feature, id) in features.iter_mut().zip(1..) {
        feature.id = id;
        feature.block = in_blocks.number(match &feature.shape {
            FeatureShape::Point(p) => p.to_m(),
            FeatureShape::Line(line) => line.get(line.len() / 2).map_or(Vec2::ZERO, |p| p.to_m()),
            FeatureShape::Polygon(polygon) => polygon.interior_point(),
        });
    }
}

/// Gives each block the land use that covers more than half of it; where areas overlap, the
/// smallest counts (a park in a residential quarter). By about a hundred points on a grid.
pub fn use_land(blocks: &mut [Block], land_use: &[Area]) {
    if land_use.is_empty() {
        return;
    }
    let boxes = BoxGrid::of(land_use.iter().map(|a| &a.polygon));
    let sizes: Vec<f64> = land_use.iter().map(|a| a.polygon.area_m2()).collect();
    blocks.par_iter_mut().for_each(|block| {
        let mut near = Vec::new();
        boxes.meeting_polygon(&block.polygon, &mut near);
        // Smallest first: the first that holds a point decides.
        near.sort_by(|i, j| sizes[*i as usize].total_cmp(&sizes[*j as usize]).then(i.cmp(j)));
        if !near.is_empty() {
            let near: Vec<&Area> = near.iter().map(|i| &land_use[*i as usize]).collect();
            block.land_use = prevailing(&block.polygon, &near);
        }
    });
}

/// The class of the areas, of which the first that holds a point decides, over most of a polygon.
fn prevailing(polygon: &Polygon, areas: &[&Area]) -> Option<Arc<str>> {
    let samples = polygon.lattice((polygon.area_m2() / SAMPLES).sqrt().max(0.5));
    let mut votes: Vec<(&Arc<str>, usize)> = Vec::new();
    for p in &samples {
        let Some(area) = areas.iter().find(|a| a.polygon.contains(*p)) else { continue };
        match votes.iter_mut().find(|(class, _)| **class == area.class) {
            Some((_, n)) => *n += 1,
            None => votes.push((&area.class, 1)),
        }
    }
    votes.into_iter().find(|(_, n)| 2 * n > samples.len()).map(|(class, _)| class.clone())
}

/// Tells parcels whether they lie on a street: at least 3 m of their boundary no farther from a
/// street's carriageway than a pavement and a front garden wall, 6 m.
pub fn give_access(parcels: &mut [Parcel], streets: &StreetGraph) {
    const NEAR_M: f64 = 6.0;
    const LEAST_M: f64 = 3.0;
    const WIDEST_M: f64 = 20.0;
    if parcels.is_empty() {
        return;
    }
    let mut owners: Vec<EdgeId> = Vec::new();
    let mut segments = Vec::new();
    for (id, edge) in streets.edges().filter(|(_, e)| e.data.crossing_level() == 0) {
        for w in edge.line().windows(2) {
            owners.push(id);
            segments.push((w[0], w[1]));
        }
    }
    let grid = SegmentGrid::new(segments);
    let on_street = |p: Vec2, near: &mut Vec<u32>| {
        let at = GridPoint::round(p);
        grid.near(at, at, ((WIDEST_M + NEAR_M) * 1000.0) as i32, near);
        near.iter().any(|i| {
            let half_m = streets.edge(owners[*i as usize]).data.width_m() / 2.0;
            let (a, b) = grid.segment(*i);
            let (foot, _) = polyline::nearest_on_segment(a.to_m(), b.to_m(), p);
            foot.distance(p) <= half_m.min(WIDEST_M) + NEAR_M
        })
    };
    parcels.par_iter_mut().for_each(|parcel| {
        let (mut length, mut near) = (0.0, Vec::new());
        for (a, b) in parcel.polygon.segments() {
            for piece in polyline::resample(&[a.to_m(), b.to_m()], 1.0).windows(2) {
                if length < LEAST_M && on_street((piece[0] + piece[1]) / 2.0, &mut near) {
                    length += piece[0].distance(piece[1]);
                }
            }
        }
        parcel.street_access |= length >= LEAST_M;
    });
}
