//! Domains: parts of the target that take after different examples (Nishida et al. 2015, section 3).
//!
//! A file of areas names them, or the ground does: split by height and slope, every part takes after
//! the examples whose own ground is most like it.

use std::collections::BTreeMap;

use exurb_city::{City, Land};
use exurb_geom::{Bounds, GridPoint, Polygon, Vec2};
use exurb_operation::{Domain, Run};

use super::character::{self, Character, Place};
use super::error::Error;
use super::params::Params;

/// Side of the squares that the ground is split by, in metres.
const CELL_M: f64 = 50.0;
/// Heights and slopes of a place are the means over so many squares to each side.
const SMOOTHED: i64 = 2;

/// Which examples serve where.
#[derive(Clone, Debug, Default)]
pub struct Domains {
    bounds: Option<Bounds>,
    columns: usize,
    /// Number of the domain from 1, row by row from the south-west; 0 is none.
    of: Vec<u16>,
    /// Weights of the examples by domain.
    weights: Vec<Vec<f64>>,
}

impl Domains {
    /// The domains that the parameters ask for; what was chosen and why goes to `run` as warnings.
    pub fn of(
        city: &City,
        area: &Polygon,
        examples: &[Character],
        params: &Params,
        run: &Run,
    ) -> Result<Self, Error> {
        let given = params.areas.areas();
        if given.is_empty() && !params.split {
            return Ok(Self::default());
        }
        let empty = Self::over(area);
        if given.is_empty() {
            return Ok(empty.split(&Land::of(city), examples, params, run));
        }
        empty.named(given, &Land::of(city), examples, run)
    }

    /// Which of the examples of a library serve somewhere, in their order. Where nothing divides the
    /// target, that is the one that fits it as a whole.
    pub fn serving(
        city: &City,
        area: &Polygon,
        library: &[Character],
        params: &Params,
        run: &Run,
    ) -> Result<Vec<usize>, Error> {
        let knows_ground = city.terrain.is_some() && library.iter().any(|c| c.relief.is_some());
        let areas = params.areas.areas();
        let is_open = |area: &Domain| area.examples.is_empty() && area.density.is_none();
        if !knows_ground && (areas.is_empty() || areas.iter().any(is_open)) {
            return Err(Error::Library);
        }
        let mut domains = Self::of(city, area, library, params, run)?;
        if domains.weights.is_empty() {
            let whole = Self::over(area);
            let cells: Vec<usize> = (0..whole.of.len())
                .filter(|i| area.contains(GridPoint::round(whole.center(*i))))
                .collect();
            let place = whole.mean(&cells, &Land::of(city));
            let (weights, why) = place.fitting(library);
            run.warn(format!("the target: {why}"));
            domains.weights.push(weights);
        }
        let serves = |i: &usize| domains.weights.iter().any(|weights| weights[*i] > 0.0);
        Ok((0..library.len()).filter(serves).collect())
    }

    fn over(area: &Polygon) -> Self {
        let bounds = area.bounds();
        let size = (bounds.size() / CELL_M).ceil().max(Vec2::ONE);
        let (columns, rows) = (size.x as usize, size.y as usize);
        Self { bounds: Some(bounds), columns, of: vec![0; columns * rows], weights: vec![] }
    }

    /// The weights of the examples at `p`; `None` where no domain says anything.
    pub fn weights_at(&self, p: Vec2) -> Option<&[f64]> {
        let bounds = self.bounds?;
        let place = (p.clamp(bounds.min, bounds.max) - bounds.min) / CELL_M;
        let rows = self.of.len() / self.columns;
        let (column, row) =
            ((place.x as usize).min(self.columns - 1), (place.y as usize).min(rows - 1));
        let domain = self.of[row * self.columns + column];
        Some(&self.weights[usize::from(domain).checked_sub(1)?])
    }

    fn center(&self, i: usize) -> Vec2 {
        let low = self.bounds.map_or(Vec2::ZERO, |b| b.min);
        low + (Vec2::new((i % self.columns) as f64, (i / self.columns) as f64) + 0.5) * CELL_M
    }

    fn named(
        mut self,
        areas: &[Domain],
        land: &Land,
        examples: &[Character],
        run: &Run,
    ) -> Result<Self, Error> {
        for (number, area) in areas.iter().enumerate() {
            let Some(polygon) = area.polygon() else { continue };
            let cells: Vec<usize> = (0..self.of.len())
                .filter(|i| polygon.contains(GridPoint::round(self.center(*i))))
                .collect();
            let weights = if area.examples.is_empty() {
                let place = Place { density: area.density, ..self.mean(&cells, land) };
                let (weights, why) = place.fitting(examples);
                let usage = &area.usage;
                run.warn(format!("area {} ({usage}): {why}", number + 1));
                weights
            } else {
                character::by_name(&area.examples, examples)?
            };
            self.weights.push(weights);
            let domain = self.weights.len() as u16;
            cells.into_iter().for_each(|i| self.of[i] = domain);
        }
        Ok(self)
    }

    /// The ground of some squares.
    fn mean(&self, cells: &[usize], land: &Land) -> Place {
        let dry = cells.iter().map(|i| self.center(*i)).filter(|p| !land.is_wet(*p));
        let (sum, count) = dry.fold(((0.0, 0.0), 0.0), |((h, s), n), p| {
            ((h + land.height_m(p), s + land.slope(p)), n + 1.0)
        });
        let count: f64 = f64::max(count, 1.0);
        Place { height_m: sum.0 / count, slope: sum.1 / count, density: None }
    }

    /// Splits the ground by bins of height and slope; parts smaller than the least area join what is
    /// beside them most.
    fn split(mut self, land: &Land, examples: &[Character], params: &Params, run: &Run) -> Self {
        let rows = self.of.len() / self.columns;
        let places: Vec<Vec2> = (0..self.of.len()).map(|i| self.center(i)).collect();
        let ground: Vec<(f64, f64)> =
            places.iter().map(|p| (land.height_m(*p), land.slope(*p))).collect();
        let bins: Vec<(i64, i64)> = (0..ground.len())
            .map(|i| {
                let (height, slope) = smoothed(&ground, self.columns, rows, i);
                let bin = |v: f64, unit: f64| (v / unit).floor() as i64;
                (bin(height, params.height_bin), bin(slope, params.slope_bin))
            })
            .collect();
        let least = (params.least_domain * 1e6 / (CELL_M * CELL_M)).ceil() as usize;
        let parts = parts(&bins, self.columns, least);
        let mut numbers: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (i, part) in parts.iter().enumerate() {
            numbers.entry(*part).or_default().push(i);
        }
        for cells in numbers.values() {
            let (weights, why) = self.mean(cells, land).fitting(examples);
            let km2 = cells.len() as f64 * CELL_M * CELL_M / 1e6;
            run.warn(format!("domain {} of {km2:.2} km²: {why}", self.weights.len() + 1));
            self.weights.push(weights);
            let domain = self.weights.len() as u16;
            cells.iter().for_each(|i| self.of[*i] = domain);
        }
        self
    }
}

fn smoothed(ground: &[(f64, f64)], columns: usize, rows: usize, i: usize) -> (f64, f64) {
    let (column, row) = ((i % columns) as i64, (i / columns) as i64);
    let (mut sum, mut count) = ((0.0, 0.0), 0.0);
    for y in (row - SMOOTHED).max(0)..=(row + SMOOTHED).min(rows as i64 - 1) {
        for x in (column - SMOOTHED).max(0)..=(column + SMOOTHED).min(columns as i64 - 1) {
            let (height, slope) = ground[y as usize * columns + x as usize];
            sum = (sum.0 + height, sum.1 + slope);
            count += 1.0;
        }
    }
    (sum.0 / count, sum.1 / count)
}

/// Connected squares of one bin, each by the number of its first; small parts join the part that
/// most of their border is beside.
fn parts(bins: &[(i64, i64)], columns: usize, least: usize) -> Vec<usize> {
    let beside = |i: usize| {
        let (column, row) = (i % columns, i / columns);
        let list = [
            (column > 0).then(|| i - 1),
            (column + 1 < columns).then_some(i + 1),
            (row > 0).then(|| i - columns),
            (i + columns < bins.len()).then_some(i + columns),
        ];
        list.into_iter().flatten()
    };
    let mut part = vec![usize::MAX; bins.len()];
    let mut members: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for first in 0..bins.len() {
        if part[first] != usize::MAX {
            continue;
        }
        let mut open = vec![first];
        part[first] = first;
        while let Some(i) = open.pop() {
            members.entry(first).or_default().push(i);
            for j in beside(i).filter(|j| bins[*j] == bins[first]) {
                if part[j] == usize::MAX {
                    part[j] = first;
                    open.push(j);
                }
            }
        }
    }
    // The smallest first, until all are large enough or one is left.
    while let Some((small, cells)) = members
        .iter()
        .filter(|(_, cells)| cells.len() < least)
        .min_by_key(|(id, cells)| (cells.len(), **id))
        .map(|(id, cells)| (*id, cells.clone()))
    {
        let mut border: BTreeMap<usize, usize> = BTreeMap::new();
        for j in cells.iter().flat_map(|i| beside(*i)).filter(|j| part[*j] != small) {
            *border.entry(part[j]).or_default() += 1;
        }
        let Some((into, _)) = border.into_iter().max_by_key(|(id, n)| (*n, usize::MAX - id)) else {
            break;
        };
        members.remove(&small);
        cells.iter().for_each(|i| part[*i] = into);
        members.entry(into).or_default().extend(cells);
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_parts_join_what_is_beside_them() {
        // Two halves, and a single square of another bin in the left one.
        let columns = 10;
        let mut bins: Vec<(i64, i64)> =
            (0..100).map(|i| if i % columns < 5 { (0, 0) } else { (1, 0) }).collect();
        bins[42] = (7, 7);
        let part = parts(&bins, columns, 4);
        assert_eq!(part[42], part[41]);
        assert_ne!(part[44], part[45]);
        let all: std::collections::BTreeSet<usize> = part.iter().copied().collect();
        assert_eq!(all.len(), 2);
        let one = parts(&bins, columns, 1000);
        assert!(one.iter().all(|p| *p == one[0]));
    }
}
