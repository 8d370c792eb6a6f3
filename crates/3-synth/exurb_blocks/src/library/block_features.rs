use exurb_city::{Block, BlockClass, Role, StreetGraph};
use exurb_geom::{PointIndex, Vec2, trig};

/// What makes blocks alike before anything stands on them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Features {
    /// ln of area, ln of mean width, share of main streets along the sides, ln of dead ends plus one,
    /// ln of the usual block area around.
    values: [f64; 5],
}

/// What each feature weighs in the distance.
const WEIGHTS: [f64; 5] = [1.0, 0.8, 0.4, 0.4, 0.8];
/// Blocks this near make the surroundings, in metres.
const AROUND_M: f64 = 300.0;

impl Features {
    /// Standard deviation of each value; 1 where all are equal.
    pub fn spread<'a>(all: impl Iterator<Item = &'a Self> + Clone) -> Self {
        let count = all.clone().count().max(1) as f64;
        let mut values = [1.0; 5];
        for (k, value) in values.iter_mut().enumerate() {
            let mean = all.clone().map(|f| f.values[k]).sum::<f64>() / count;
            let square = all.clone().map(|f| (f.values[k] - mean).powi(2)).sum::<f64>();
            let deviation = (square / count).sqrt();
            *value = if deviation > 1e-6 { deviation } else { 1.0 };
        }
        Self { values }
    }

    /// Distance to `other` in units of the spread.
    pub fn distance(&self, other: &Self, spread: &Self) -> f64 {
        let square: f64 = (0..5)
            .map(|k| WEIGHTS[k] * ((self.values[k] - other.values[k]) / spread.values[k]).powi(2))
            .sum();
        square.sqrt()
    }

    /// Of a square block of so many m² among others.
    #[cfg(test)]
    pub fn of_area(m2: f64) -> Self {
        Self { values: [trig::ln(m2), trig::ln(m2) / 2.0, 0.0, 0.0, trig::ln(m2)] }
    }

    /// ln of the block's area.
    pub fn ln_area(&self) -> f64 {
        self.values[0]
    }
}

/// The blocks around each block.
#[derive(Clone, Debug)]
pub struct Surroundings {
    centers: PointIndex,
    ln_areas: Vec<f64>,
}

impl Surroundings {
    /// An index of `blocks`.
    pub fn of(blocks: &[Block]) -> Self {
        let mut centers = PointIndex::new(AROUND_M);
        let mut ln_areas = Vec::with_capacity(blocks.len());
        for (i, block) in blocks.iter().enumerate() {
            ln_areas.push(trig::ln(block.polygon.area_m2().max(1.0)));
            if block.class == BlockClass::Block {
                centers.insert(i as u32, block.polygon.centroid());
            }
        }
        Self { centers, ln_areas }
    }

    /// The features of one of the blocks.
    pub fn features(&self, block: &Block, streets: &StreetGraph) -> Features {
        let area = block.polygon.area_m2().max(1.0);
        let (mut main, mut all) = (0.0, 0.0);
        for edge in block.sides.iter().filter_map(|id| streets.get_edge(*id)) {
            let length = edge.length_m();
            all += length;
            main += if edge.data.role() == Role::Main { length } else { 0.0 };
        }
        Features {
            values: [
                trig::ln(area),
                trig::ln(block.polygon.mean_width_m().max(1.0)),
                if all > 0.0 { main / all } else { 0.0 },
                trig::ln(1.0 + block.dead_ends.len() as f64),
                self.usual_ln_area(block.polygon.centroid()).unwrap_or(trig::ln(area)),
            ],
        }
    }

    fn usual_ln_area(&self, center: Vec2) -> Option<f64> {
        let near = self.centers.within(center, AROUND_M);
        let mut areas: Vec<f64> = near.iter().map(|(i, _)| self.ln_areas[*i as usize]).collect();
        areas.sort_by(f64::total_cmp);
        areas.get(areas.len() / 2).copied()
    }
}
