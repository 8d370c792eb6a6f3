//! How blocks are built up: coverage, number of buildings, floor area, corners, the line of fronts.

use exurb_city::{Block, BlockClass, City};
use exurb_geom::{Bounds, BoxGrid, GridPoint, Vec2, polyline, trig};

use crate::Sample;
use crate::block_shapes::BlockShape;
use crate::buildings::Shape;
use crate::nearest::Segments;
use crate::network::inclusion_weight;

/// Metres of a storey where only the height is known.
const STOREY_M: f64 = 3.0;
/// Floor area needs the storeys of buildings with at least this share of the footprint area, in the
/// window and in the block.
const KNOWN_SHARE: f64 = 0.5;
/// A kerb turns by more than this at a corner, once it is simplified by so many metres.
const CORNER_RAD: f64 = 45.0 * std::f64::consts::PI / 180.0;
const KERB_M: f64 = 2.0;
/// A corner is built on when a building stands within this of it, in metres.
const CORNER_REACH_M: f64 = 15.0;
/// Buildings farther than this from the kerb stand in the second row, in metres.
const FRONT_ROW_M: f64 = 30.0;
/// A side of a block needs so many fronts before their line has a variation.
const LEAST_FRONTS: usize = 3;

/// How the blocks of a window are built up; one value a block, but for the last two.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BuiltBlocks {
    /// Footprint area by block area (GSI), weighted by block area.
    pub coverage: Sample,
    /// Buildings per hectare of block.
    pub buildings_per_ha: Sample,
    /// Footprint area times storeys by block area (FSI). Blocks where most storeys are unknown are
    /// left out, and all where most of the window's are.
    pub floor_space: Sample,
    /// Share of block corners with a building within 15 m; one value a block with corners.
    pub corners_built: Sample,
    /// Standard deviation of the distance from kerb to front along one side of a block, in metres.
    pub setback_variation: Sample,
}

/// A figure of a block and the buildings in it, with its weight; `None` where it says nothing.
type Figure<'a> = dyn Fn(&BlockShape, &[&Shape]) -> Option<(f64, f64)> + 'a;

/// Measures how blocks are built up. `blocks` are those of the window's network, `shapes` its
/// buildings. A building stands in the block that holds its centroid. O(n log n).
pub fn built_blocks(
    city: &City,
    blocks: &[BlockShape],
    shapes: &[Shape],
    window: Bounds,
) -> BuiltBlocks {
    let standing = standing_in(blocks, shapes);
    let of = |value: &Figure| {
        let values = blocks.iter().zip(&standing).filter_map(|(block, own)| value(block, own));
        Sample::weighted(values)
    };
    let footprint = |own: &[&Shape]| own.iter().map(|s| s.area_m2).sum::<f64>();
    let (corners_built, setback_variation) = along_kerbs(city, shapes, window);
    let all: Vec<&Shape> = shapes.iter().collect();
    let storeys_known = floor_m2(city, &all).is_some();
    let floor_space = |b: &BlockShape, own: &[&Shape]| {
        storeys_known.then(|| Some((floor_m2(city, own)? / b.area_m2, b.weight)))?
    };
    BuiltBlocks {
        coverage: of(&|b, own| Some((footprint(own) / b.area_m2, b.area_m2))),
        buildings_per_ha: of(&|b, own| Some((own.len() as f64 / (b.area_m2 / 1e4), b.weight))),
        floor_space: of(&floor_space),
        corners_built,
        setback_variation,
    }
}

/// The buildings of every block.
fn standing_in<'a>(blocks: &[BlockShape], shapes: &'a [Shape]) -> Vec<Vec<&'a Shape>> {
    let boxes = BoxGrid::of(blocks.iter().map(|b| &b.polygon));
    let mut out = vec![Vec::new(); blocks.len()];
    let mut near = Vec::new();
    for shape in shapes {
        let at = GridPoint::round(shape.at);
        boxes.meeting(at, at, &mut near);
        let home = near.iter().find(|i| blocks[**i as usize].polygon.contains(at));
        if let Some(home) = home {
            out[*home as usize].push(shape);
        }
    }
    out
}

/// Floor area in m²: unknown storeys are the mean of the known ones, by area. `None` where too few
/// are known.
fn floor_m2(city: &City, own: &[&Shape]) -> Option<f64> {
    let (mut all_m2, mut known_m2, mut floors_m2) = (0.0, 0.0, 0.0);
    for shape in own {
        all_m2 += shape.area_m2;
        let building = &city.buildings[shape.index];
        let levels = building.levels.or(building.height_m.map(|h| (h / STOREY_M).max(1.0)));
        if let Some(levels) = levels {
            known_m2 += shape.area_m2;
            floors_m2 += shape.area_m2 * levels;
        }
    }
    if own.is_empty() {
        return Some(0.0);
    }
    (known_m2 > 0.0 && known_m2 >= KNOWN_SHARE * all_m2).then(|| floors_m2 * all_m2 / known_m2)
}

/// Share of corners that are built on, and variation of the setback along sides.
fn along_kerbs(city: &City, shapes: &[Shape], window: Bounds) -> (Sample, Sample) {
    let footprints = || shapes.iter().map(|s| &city.buildings[s.index].polygon);
    let walls = Segments::of_polygons(footprints());
    let boxes = BoxGrid::of(footprints());
    let (mut corners_built, mut variations) = (Vec::new(), Vec::new());
    let ordinary = |b: &&Block| b.class == BlockClass::Block;
    for block in city.blocks.iter().filter(ordinary) {
        let bounds = block.polygon.bounds();
        if !window.contains(bounds.min) || !window.contains(bounds.max) {
            continue;
        }
        let weight = inclusion_weight(bounds.size(), window.size());
        let (ring, corners) = kerb(block);
        if !corners.is_empty() {
            let built =
                corners.iter().filter(|i| is_built(ring[**i], &walls, &boxes, city, shapes));
            corners_built.push((built.count() as f64 / corners.len() as f64, weight));
        }
        for side in sides(&ring, &corners) {
            variations.extend(variation(&side, city, shapes, &boxes, block).map(|v| (v, weight)));
        }
    }
    (Sample::weighted(corners_built), Sample::weighted(variations))
}

/// The kerb, simplified, and the numbers of its corners.
fn kerb(block: &Block) -> (Vec<Vec2>, Vec<usize>) {
    let mut closed = polyline::to_m(block.polygon.exterior());
    closed.push(closed[0]);
    let mut ring = polyline::simplify(&closed, KERB_M);
    ring.pop();
    let n = ring.len();
    let turn = |i: usize| {
        let (before, at, after) = (ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]);
        trig::angle_between(at - before, after - at)
    };
    let corners = (0..n).filter(|i| n > 2 && turn(*i) > CORNER_RAD).collect();
    (ring, corners)
}

fn is_built(at: Vec2, walls: &Segments, boxes: &BoxGrid, city: &City, shapes: &[Shape]) -> bool {
    let p = GridPoint::round(at);
    let mut near = Vec::new();
    boxes.meeting(p, p, &mut near);
    let holds = |i: &u32| city.buildings[shapes[*i as usize].index].polygon.contains(p);
    near.iter().any(holds) || walls.is_within(p, CORNER_REACH_M)
}

/// The sides of a block, from corner to corner; the whole kerb where there is none.
fn sides(ring: &[Vec2], corners: &[usize]) -> Vec<Vec<Vec2>> {
    let n = ring.len();
    let between = |from: usize, to: usize| -> Vec<Vec2> {
        let count = (to + n - from) % n;
        let count = if count == 0 { n } else { count };
        (0..=count).map(|i| ring[(from + i) % n]).collect()
    };
    match corners {
        [] if n > 2 => vec![between(0, 0)],
        _ => (0..corners.len())
            .map(|i| between(corners[i], corners[(i + 1) % corners.len()]))
            .collect(),
    }
}

/// Standard deviation of the distance between a side and the buildings of the block whose nearest
/// point lies along it, in the front row.
fn variation(
    side: &[Vec2],
    city: &City,
    shapes: &[Shape],
    boxes: &BoxGrid,
    block: &Block,
) -> Option<f64> {
    let bounds = Bounds::of(polyline::round(side))?.grown(FRONT_ROW_M);
    let mut near = Vec::new();
    boxes.meeting(GridPoint::round(bounds.min), GridPoint::round(bounds.max), &mut near);
    let length_m = polyline::length(side);
    let setback = |i: &u32| {
        let shape = &shapes[*i as usize];
        let footprint = &city.buildings[shape.index].polygon;
        let inside = block.polygon.contains(GridPoint::round(shape.at));
        let points = footprint.exterior().iter().map(|p| polyline::nearest(side, p.to_m()));
        let nearest = points
            .zip(footprint.exterior())
            .map(|((foot, along_m, _), p)| (foot.distance(p.to_m()), along_m));
        let (distance_m, along_m) = nearest.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let faces = along_m > 0.0 && along_m < length_m;
        (inside && faces && distance_m <= FRONT_ROW_M).then_some(distance_m)
    };
    let setbacks: Vec<f64> = near.iter().filter_map(setback).collect();
    let n = setbacks.len() as f64;
    let mean = setbacks.iter().sum::<f64>() / n;
    let variance = setbacks.iter().map(|s| (s - mean) * (s - mean)).sum::<f64>() / n;
    (setbacks.len() >= LEAST_FRONTS).then(|| variance.sqrt())
}
