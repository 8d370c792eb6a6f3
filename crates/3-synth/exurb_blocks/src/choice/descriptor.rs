//! What a layout looks like, for comparing blocks of different shape and size.
//!
//! Hartmann 2018, section 5.1.9, lacks such a measure: layouts chosen one by one change abruptly from
//! block to block. Five values tell a quarter from another: how much is built on, how far from the kerb,
//! how large and how turned the buildings are, and whether the corners are built.

use exurb_geom::{Polygon, Vec2, trig};

use crate::kerb::Kerb;
use crate::library::{main_direction, median};

/// A layout's looks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Descriptor {
    /// Coverage; usual distance to the kerb in tens of metres, capped; ln of the usual footprint;
    /// usual turn against the street, 1 = 45°; share of corners with a building near.
    values: [f64; VALUES],
}

const VALUES: usize = 5;
/// Distances to the kerb beyond this are alike, in metres.
const FAR_M: f64 = 30.0;
/// A building this near to a corner stands at it, in metres.
const CORNER_M: f64 = 16.0;

impl Descriptor {
    /// The looks of `footprints` in a block. Linear in their corners.
    pub fn of<'a>(
        block: &Polygon,
        kerb: &Kerb,
        footprints: impl Iterator<Item = &'a Polygon> + Clone,
    ) -> Self {
        let built: f64 = footprints.clone().map(Polygon::area_m2).sum();
        if built == 0.0 {
            return Self::default();
        }
        let front = |p: &Polygon| kerb.nearest(p.centroid()).1;
        let setback = |p: &Polygon| {
            let corners = p.exterior().iter().map(|c| kerb.nearest(c.to_m()).1.distance_m);
            corners.fold(FAR_M, f64::min)
        };
        let turn = |p: &Polygon| {
            let sides = p.segments().map(|(a, b)| (a.to_m(), b.to_m()));
            let angle = main_direction(sides) - trig::angle(front(p).direction);
            let quarter = std::f64::consts::FRAC_PI_2;
            (angle - (angle / quarter).round() * quarter).abs() / (quarter / 2.0)
        };
        let corners: Vec<Vec2> = kerb.rings[0]
            .corners()
            .into_iter()
            .filter(|c| c.1 > 0.0)
            .map(|c| kerb.rings[0].point_at(c.0))
            .collect();
        let is_built = |c: &&Vec2| {
            footprints.clone().any(|p| {
                p.bounds().grown(CORNER_M).contains(**c) && p.boundary_distance_m(**c) < CORNER_M
            })
        };
        let share = corners.iter().filter(is_built).count() as f64 / corners.len().max(1) as f64;
        Self {
            values: [
                built / block.area_m2(),
                median(footprints.clone().map(setback)) / 10.0,
                median(footprints.clone().map(|p| trig::ln(p.area_m2().max(1.0)))),
                median(footprints.clone().map(turn)),
                share,
            ],
        }
    }

    /// Share of the block that is built on.
    pub fn coverage(&self) -> f64 {
        self.values[0]
    }
}

/// How much layouts differ in an example.
#[derive(Clone, Copy, Debug)]
pub struct Spread {
    scales: [f64; VALUES],
    /// How much less neighbours differ than any two blocks, in `0..=1`.
    pub coherence: f64,
}

impl Spread {
    /// Learns from layouts and pairs of neighbours among them.
    pub fn of(all: &[Descriptor], neighbours: &[(usize, usize)]) -> Self {
        let n = all.len().max(1) as f64;
        let scales = std::array::from_fn(|k| {
            let mean = all.iter().map(|d| d.values[k]).sum::<f64>() / n;
            let square = all.iter().map(|d| (d.values[k] - mean).powi(2)).sum::<f64>() / n;
            square.sqrt().max(LEAST_SCALES[k])
        });
        let plain = Self { scales, coherence: 0.0 };
        let between = |pairs: &mut dyn Iterator<Item = (usize, usize)>| {
            let (mut sum, mut count) = (0.0, 0.0);
            for (i, j) in pairs {
                (sum, count) = (sum + plain.distance(&all[i], &all[j]), count + 1.0);
            }
            if count > 0.0 { sum / count } else { 0.0 }
        };
        let near = between(&mut neighbours.iter().copied());
        // Every block with the one half the list away: any two.
        let half = all.len() / 2;
        let any = between(&mut (0..all.len()).map(|i| (i, (i + half) % all.len())));
        let coherence = if any > 0.0 && neighbours.len() > 4 {
            (1.0 - near / any).clamp(0.0, 1.0)
        } else {
            0.0
        };
        Self { coherence, ..plain }
    }

    /// How different two layouts look: root mean square of the values in units of their spread.
    pub fn distance(&self, a: &Descriptor, b: &Descriptor) -> f64 {
        let square = |k: usize| ((a.values[k] - b.values[k]) / self.scales[k]).powi(2);
        ((0..VALUES).map(square).sum::<f64>() / VALUES as f64).sqrt()
    }
}

/// Where all blocks are alike, differences below these are none.
const LEAST_SCALES: [f64; VALUES] = [0.05, 0.1, 0.2, 0.1, 0.2];

#[cfg(test)]
mod tests {
    use exurb_geom::GridPoint;

    use super::*;

    fn looks(houses: &[(f64, f64, f64, f64)]) -> Descriptor {
        let block = Polygon::rectangle(GridPoint::m(0.0, 0.0), GridPoint::m(100.0, 60.0));
        let house = |&(x, y, w, d): &(f64, f64, f64, f64)| {
            Polygon::rectangle(GridPoint::m(x, y), GridPoint::m(x + w, y + d))
        };
        let houses: Vec<Polygon> = houses.iter().map(house).collect();
        Descriptor::of(&block, &Kerb::of(&block), houses.iter())
    }

    #[test]
    fn looks_are_what_one_sees() {
        let one = looks(&[(3.0, 3.0, 20.0, 12.0)]);
        let expected = [0.04, 0.3, trig::ln(240.0), 0.0, 0.25];
        assert!(one.values.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{one:?}");
        assert_eq!(looks(&[]), Descriptor::default());
    }

    #[test]
    fn like_neighbours_are_coherent_and_mixed_ones_are_not() {
        let (dense, loose) = (looks(&[(1., 1., 90., 50.)]), looks(&[(20., 20., 9., 9.)]));
        let all: Vec<Descriptor> = (0..20).map(|i| if i < 10 { dense } else { loose }).collect();
        let along: Vec<(usize, usize)> = (0..19).map(|i| (i, i + 1)).collect();
        assert!(Spread::of(&all, &along).coherence > 0.8);
        let across: Vec<(usize, usize)> = (0..10).map(|i| (i, i + 10)).collect();
        assert!(Spread::of(&all, &across).coherence < 1e-9);
    }
}
