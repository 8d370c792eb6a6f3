//! Blocks: the faces between the streets less half of each street's carriageway.

use std::sync::Arc;

use exurb_geom::{Polygon, Roadside, SegmentGrid, Vec2, grid, offset, overlay, polyline};
use exurb_graph::{Dart, EdgeId, Face, FaceId, Faces};
use rayon::prelude::*;

use crate::{Class, Provenance, StreetGraph};

/// Is the block wide enough to build on?
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlockClass {
    /// An ordinary block.
    Block,
    /// Mean width under 10 m, such as the strip between two carriageways: never built on.
    Island,
}

/// A block: the ground inside a face of the street graph, up to the kerbs.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Its number, from 1.
    pub id: u32,
    /// Kerb line.
    pub polygon: Polygon,
    /// Area of the face of the street centrelines, in m².
    pub face_area_m2: f64,
    /// Width of the pavement inside the kerb, in metres: parcels begin behind it.
    pub pavement_m: f64,
    /// Prevailing land use, where known.
    pub land_use: Option<Arc<str>>,
    /// Block or island.
    pub class: BlockClass,
    /// Streets along its sides, in order around the face, each once.
    pub sides: Vec<EdgeId>,
    /// Dead-end streets inside.
    pub dead_ends: Vec<EdgeId>,
    /// Where it came from.
    pub provenance: Provenance,
}

/// Mean width below which a block is an island, in metres.
pub const ISLAND_WIDTH_M: f64 = 10.0;
/// Default width of the pavement, in metres (Hartmann 2018, section 5.1).
pub const PAVEMENT_M: f64 = 2.0;
/// Kerb areas below this are rounding, not blocks, in m².
const LEAST_AREA_M2: f64 = 1.0;

impl Block {
    /// The ground for parcels: the block less its pavement. May fall apart; largest first.
    pub fn buildable(&self) -> Vec<Polygon> {
        offset::inset(&self.polygon, self.pavement_m)
    }
}

/// Edges that bound blocks: all but tunnels and those that cross another street without a node
/// (bridges over streets).
pub fn bounding_edges(graph: &StreetGraph) -> Vec<bool> {
    let mut bounds = vec![false; graph.edge_bound()];
    let (mut raised, mut segments) = (Vec::new(), Vec::new());
    for (id, edge) in graph.edges() {
        let level = edge.data.crossing_level();
        bounds[id.index()] = !edge.data.tunnel && level >= 0;
        if level > 0 {
            raised.extend(std::iter::repeat_n(id, edge.line().len() - 1));
            segments.extend(edge.line().windows(2).map(|w| (w[0], w[1])));
        }
    }
    let grid = SegmentGrid::new(segments);
    let mut near = Vec::new();
    for (_, edge) in graph.edges().filter(|(_, e)| e.data.crossing_level() == 0) {
        for w in edge.line().windows(2) {
            grid.near(w[0], w[1], 0, &mut near);
            for i in &near {
                let (a, b) = grid.segment(*i);
                if grid::cross_properly(w[0], w[1], a, b) {
                    bounds[raised[*i as usize].index()] = false;
                }
            }
        }
    }
    bounds
}

/// The faces of the streets that bound blocks.
pub fn faces(graph: &StreetGraph) -> Faces {
    let keep = bounding_edges(graph);
    Faces::of(graph, |id| keep[id.index()])
}

/// The blocks of a street graph, in order of faces; a face cut apart by wide streets gives several.
/// Runs on rayon's current pool; the result does not depend on the number of threads.
pub fn derive(graph: &StreetGraph) -> Vec<Block> {
    let faces = faces(graph);
    // In runs of faces, so that few lists are joined.
    let runs = faces.list.par_chunks(64).map(|faces| {
        faces.iter().flat_map(|face| blocks_of_face(graph, face)).collect::<Vec<Block>>()
    });
    let mut blocks: Vec<Block> = runs.collect::<Vec<_>>().into_iter().flatten().collect();
    for (block, id) in blocks.iter_mut().zip(1..) {
        block.id = id;
    }
    blocks
}

fn blocks_of_face(graph: &StreetGraph, face: &Face) -> Vec<Block> {
    let mut sides: Vec<EdgeId> = Vec::new();
    for dart in face.outline.iter().chain(face.islands.iter().flatten()) {
        if !sides.contains(&dart.edge()) {
            sides.push(dart.edge());
        }
    }
    let mut dead_ends = face.inner.clone();
    dead_ends.sort_unstable();
    let face_area_m2 = face.polygon.area_m2();
    carriageways(graph, face)
        .taken_off(&face.polygon)
        .iter()
        // Rounding can make a kerb line touch itself.
        .flat_map(overlay::repair)
        .filter(|polygon| polygon.area_m2() >= LEAST_AREA_M2)
        .map(|polygon| {
            let island = polygon.mean_width_m() < ISLAND_WIDTH_M;
            Block {
                id: 0,
                face_area_m2,
                pavement_m: PAVEMENT_M,
                land_use: None,
                class: if island { BlockClass::Island } else { BlockClass::Block },
                sides: sides.clone(),
                dead_ends: dead_ends.clone(),
                provenance: Provenance::of(crate::Origin::Procedural),
                polygon,
            }
        })
        .collect()
}

/// The ground that the streets around and inside a face take of it.
fn carriageways(graph: &StreetGraph, face: &Face) -> Roadside {
    let half_width_m = |id: EdgeId| graph.edge(id).data.width_m() / 2.0;
    let mut out = Roadside::default();
    for cycle in std::iter::once(&face.outline).chain(&face.islands) {
        along_cycle(graph, cycle, &half_width_m, &mut out);
    }
    for id in &face.inner {
        let edge = graph.edge(*id);
        let (mut line, width_m) = (edge.line_m(), half_width_m(*id));
        for end in [edge.from, edge.to] {
            // One drives around the end of a street; a pedestrian one ends before a door.
            if graph.degree(end) > 1 || edge.data.class != Class::Pedestrian {
                out.disc(line[0], width_m);
            } else if polyline::length(&line) > 3.0 * width_m {
                line = polyline::part(&line, width_m, f64::INFINITY);
            }
            line.reverse();
        }
        out.left_of(&line, width_m);
        line.reverse();
        out.left_of(&line, width_m);
    }
    out
}

/// The ground left of a closed walk, streets of one width in one go.
fn along_cycle(
    graph: &StreetGraph,
    cycle: &[Dart],
    half_width_m: &impl Fn(EdgeId) -> f64,
    out: &mut Roadside,
) {
    let width_m = |i: usize| half_width_m(cycle[i % cycle.len()].edge());
    let first = (0..cycle.len()).find(|i| width_m(*i) != width_m(i + cycle.len() - 1));
    let start = first.unwrap_or(0);
    let mut line: Vec<Vec2> = Vec::new();
    for i in start..start + cycle.len() {
        let next = graph.dart_line_m(cycle[i % cycle.len()]);
        line.extend(&next[usize::from(!line.is_empty())..]);
        if width_m(i) != width_m(i + 1) {
            out.left_of(&line, width_m(i));
            // The end of the wider street sticks out beside the narrower one.
            out.disc(line[line.len() - 1], width_m(i).max(width_m(i + 1)));
            line.clear();
        }
    }
    if first.is_none() && line.len() > 1 {
        let (at, before, after) = (line[0], line[line.len() - 2], line[1]);
        out.left_of(&line, width_m(0));
        out.bend(at, at - before, after - at, width_m(0));
    }
}

/// Pairs of faces that share a street, each once with the streets between, in order.
/// Aliaga 2008, section 3.1.2: the block graph is dual to the street graph.
pub fn adjacency(faces: &Faces, graph: &StreetGraph) -> Vec<(FaceId, FaceId, EdgeId)> {
    let left = |d: Dart| faces.left.get(d.index()).copied().flatten();
    graph
        .edges()
        .filter_map(|(id, _)| {
            let (a, b) = (left(id.forward())?, left(id.backward())?);
            (a != b).then(|| (a.min(b), a.max(b), id))
        })
        .collect()
}
