//! The laws of a city, and the likeness gates: every breach with its place.
//!
//! Source: the definitions and limits were set on real maps before any method was written, and are
//! the same for imported and for synthesised cities. Laws are absolute and decide whether a city is
//! valid; likeness gates ([`gates()`]) compare with an example and never do. Shares of the network
//! (overlap, components, islands, junctions, short edges) are measured inside the target, where
//! streets cut at its border end in cut ends; everything else on the whole city. Lengths in metres.
//! O(n log n).
//!
//! | law | what is counted | limit |
//! |---|---|---|
//! | `crossings_without_node` | proper crossings of street pieces on one level, per 100 km | 0 |
//! | `touching_vertices` | vertices within 2 cm of a street on their level that they do not join, per 100 km | 0 |
//! | `self_intersecting_edges` | streets that cross, touch or fold back on themselves | 0 |
//! | `duplicate_length_share` | length of pieces between the same two vertices delivered before | 0 |
//! | `overlap_share` | points along streets with another street within 3 m and 15° | 0.003 |
//! | `largest_component_share` | length in the largest component, at least | 0.98 |
//! | `island_share` | length in components that touch neither the border nor the largest | 0.005 |
//! | `degree_6_share` | junctions of degree 6 and more | 0.004 |
//! | `short_edge_share` | streets under 5 m between junctions | 0.03 |
//! | `invalid_blocks`, `invalid_parcels`, `invalid_buildings` | polygons that cross or touch themselves | 0 |
//! | `parcels_tile_block` | worst deviation from 1 of a block's ground covered by its parcels | 0.001 |
//! | `parcels_overlapping` | parcels sharing over 0.1 m² with another | 0 |
//! | `street_access_share` | parcels of blocks with street access, at least | 0.99 |
//! | `buildings_overlapping` | buildings sharing over 0.1 m² with another | 0 |
//! | `buildings_outside_block` | buildings with over 0.1 m² outside their block | 0 |
//! | `buildings_crossed_by_street` | buildings that a street on the ground runs through | 0 |

pub mod gates;
mod ground;
mod inside;
mod network;
mod pieces;
mod planar;

pub use gates::{Gate, compare_gates, gates};

use exurb_geom::GridPoint;

use crate::City;
use inside::Inside;
use pieces::Pieces;

/// One law, as measured on a city.
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    /// Its name, as in the table above.
    pub name: &'static str,
    /// What was measured; `None` where the city has nothing to measure.
    pub value: Option<f64>,
    /// The most (for a share that should be high: the least) that passes.
    pub limit: f64,
    /// Does the city keep it? A law with nothing to measure is kept.
    pub pass: bool,
    /// Number of elements that count against it.
    pub count: usize,
}

/// One element against a law.
#[derive(Clone, Debug, PartialEq)]
pub struct Breach {
    /// Name of the law.
    pub law: &'static str,
    /// Layer of the element, as in the city file.
    pub layer: &'static str,
    /// Number of the element: of blocks, parcels and buildings their own, of streets and
    /// intersections the index in the graph plus one.
    pub id: u32,
    /// Where.
    pub at: GridPoint,
    /// What is wrong, in a few words.
    pub message: String,
}

/// All laws of a city.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LawReport {
    /// The laws, in the order of the table above.
    pub laws: Vec<Law>,
    /// What counts against the laws that are broken, in the order of laws, then of elements.
    pub breaches: Vec<Breach>,
}

impl LawReport {
    /// Are all laws kept?
    pub fn is_valid(&self) -> bool {
        self.laws.iter().all(|law| law.pass)
    }

    /// The law of that name.
    pub fn get(&self, name: &str) -> Option<&Law> {
        self.laws.iter().find(|law| law.name == name)
    }

    /// Number of elements that count against the law of that name; 0 when there is no such law.
    pub fn count(&self, name: &str) -> usize {
        self.get(name).map_or(0, |law| law.count)
    }

    /// Adds a law whose value may be `limit` at most.
    fn at_most(
        &mut self,
        name: &'static str,
        value: Option<f64>,
        limit: f64,
        against: Vec<Breach>,
    ) {
        self.add(
            Law { name, value, limit, pass: value.is_none_or(|v| v <= limit), count: 0 },
            against,
        );
    }

    /// Adds a law whose value must be `limit` at least.
    fn at_least(
        &mut self,
        name: &'static str,
        value: Option<f64>,
        limit: f64,
        against: Vec<Breach>,
    ) {
        self.add(
            Law { name, value, limit, pass: value.is_none_or(|v| v >= limit), count: 0 },
            against,
        );
    }

    /// Adds a law that allows nothing and is measured by counting.
    fn none_of(&mut self, name: &'static str, against: Vec<Breach>) {
        self.at_most(name, Some(against.len() as f64), 0.0, against);
    }

    fn add(&mut self, law: Law, against: Vec<Breach>) {
        self.laws.push(Law { count: against.len(), ..law.clone() });
        if !law.pass {
            self.breaches.extend(against);
        }
    }
}

/// Measures every law on `city`. Runs on rayon's current pool; the result does not depend on the
/// number of threads.
pub fn laws(city: &City) -> LawReport {
    let mut report = LawReport::default();
    let pieces = Pieces::of(&city.streets);
    let inside = Inside::of(city);
    planar::add_laws(&mut report, city, &pieces);
    network::add_laws(&mut report, &inside);
    ground::add_laws(&mut report, city, &pieces);
    report
}

/// Measures the laws of buildings alone, as [`laws`] does.
pub fn building_laws(city: &City) -> LawReport {
    let mut report = LawReport::default();
    ground::add_building_laws(&mut report, city, &Pieces::of(&city.streets));
    report
}

#[cfg(test)]
mod tests;
