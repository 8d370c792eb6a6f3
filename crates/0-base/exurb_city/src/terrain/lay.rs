//! Putting a terrain under a city.

use std::sync::Arc;

use exurb_geom::{Polygon, contour, overlay};
use exurb_graph::NodeId;

use super::Terrain;
use crate::{Area, City, StreetGraph};

/// Class of the water that a terrain's water level makes.
const FLOODED: &str = "water";
/// Puddles smaller than this are left out.
const LEAST_WATER_M2: f64 = 400.0;
/// Heights on bridges and in tunnels are found to this accuracy.
const ACCURACY_M: f64 = 0.001;
const MOST_SWEEPS: usize = 2000;

impl City {
    /// Puts `terrain` under the city: junctions get their heights from it. Streets, blocks and
    /// water stay as they are; see [`City::flood`].
    pub fn lay(&mut self, terrain: impl Into<Arc<Terrain>>) {
        let terrain = terrain.into();
        let mut streets = (*self.streets).clone();
        let nodes: Vec<NodeId> = streets.nodes().map(|(id, _)| id).collect();
        nodes.iter().for_each(|node| streets.node_mut(*node).data.z_m = 0.0);
        elevate(&mut streets, &terrain);
        self.streets = Arc::new(streets);
        self.terrain = Some(terrain);
    }

    /// Adds to the city's water whatever of the target lies under its terrain's water level and is
    /// no water yet, in place of what an earlier terrain flooded. Puddles under 400 m² are left out. Nothing without such a level.
    pub fn flood(&mut self) {
        let Some(terrain) = &self.terrain else { return };
        let below = |level: f64| {
            let (values, columns) = (terrain.heights(), terrain.columns());
            let (first, step_m) = (terrain.first().to_m(), terrain.cell_m());
            contour::below(contour::Values { values, columns, first, step_m }, level as f32)
        };
        let areas = terrain.water_level_m().map(below).unwrap_or_default();
        let mut water = (*self.water).clone();
        water.retain(|area| *area.class != *FLOODED);
        let known: Vec<Polygon> = water.iter().map(|a| a.polygon.clone()).collect();
        for area in &areas {
            for piece in overlay::intersection(area, &self.target) {
                let new = overlay::difference(&piece, &known);
                let new = new.into_iter().filter(|p| p.area_m2() >= LEAST_WATER_M2);
                water.extend(new.map(|polygon| Area { id: 0, polygon, class: FLOODED.into() }));
            }
        }
        water.iter_mut().zip(1..).for_each(|(area, id)| area.id = id);
        self.water = Arc::new(water);
    }
}

/// Gives the junctions of a height 0, which is how they are made, the terrain's height. Those where
/// no street is on the ground, on bridges and in tunnels, lie between their neighbours: what a rod
/// held at the heads would do.
pub fn elevate(streets: &mut StreetGraph, terrain: &Terrain) {
    let mut floating = Vec::new();
    let nodes: Vec<NodeId> = streets.nodes().map(|(id, _)| id).collect();
    for node in nodes {
        if streets.node(node).data.z_m != 0.0 {
            continue;
        }
        if let Some(height) = terrain.height_m(streets.node(node).at.to_m()) {
            streets.node_mut(node).data.z_m = height;
        }
        let mut levels =
            streets.darts(node).iter().map(|d| streets.edge(d.edge()).data.crossing_level());
        if levels.all(|level| level != 0) {
            floating.push(node);
        }
    }
    for _ in 0..MOST_SWEEPS {
        let mut moved_m: f64 = 0.0;
        for node in &floating {
            let height = between_neighbours(streets, *node);
            let z_m = &mut streets.node_mut(*node).data.z_m;
            moved_m = moved_m.max((height - *z_m).abs());
            *z_m = height;
        }
        if moved_m < ACCURACY_M {
            break;
        }
    }
}

/// The mean height of a node's neighbours, the nearer the weightier.
fn between_neighbours(streets: &StreetGraph, node: NodeId) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for dart in streets.darts(node) {
        let weight = 1.0 / streets.edge(dart.edge()).length_m().max(0.1);
        sum += streets.node(streets.head(*dart)).data.z_m * weight;
        weights += weight;
    }
    if weights > 0.0 { sum / weights } else { streets.node(node).data.z_m }
}
