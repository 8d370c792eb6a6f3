//! What an example is like as a whole, and which example fits a place.

use std::collections::BTreeMap;
use std::sync::Arc;

use exurb_city::City;

use super::error::Error;

/// What differs by this is as unlike as ground needs to be, for the choice of an example.
const HEIGHT_UNIT_M: f64 = 60.0;
const SLOPE_UNIT: f64 = 0.06;
/// Of densities that is a ratio of one and a half.
const DENSITY_UNIT: f64 = 0.5;

/// What is told of an example before anything is learned from it.
#[derive(Clone, Debug)]
pub struct Character {
    /// Its name, for `source`.
    pub name: Arc<str>,
    /// Its share where examples are mixed.
    pub weight: f64,
    /// Mean height in metres and mean slope of its ground, where it knows them.
    pub relief: Option<(f64, f64)>,
    /// Kilometres of streets for each square kilometre of its ground.
    pub density: f64,
}

/// A place that needs an example.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Mean height of its ground, in metres.
    pub height_m: f64,
    /// Mean slope of its ground, rise over run.
    pub slope: f64,
    /// Kilometres of streets wanted for each square kilometre.
    pub density: Option<f64>,
}

impl Character {
    /// That of a city. O(streets + ground known).
    pub fn of(city: &City, weight: f64) -> Self {
        let relief = city.terrain.as_ref().and_then(|t| t.relief(&city.target));
        Self {
            name: city.metadata.name.clone(),
            weight,
            relief: relief.map(|r| (r.mean_m, r.slope)),
            density: city.streets.length_m() / 1e3 / (city.target.area_m2() / 1e6).max(1e-6),
        }
    }
}

impl Place {
    /// Weights of the examples, and a word why: all to the one that is most like the place in height,
    /// slope and density, as far as both sides know them; the examples' own where nothing is known.
    pub fn fitting(&self, examples: &[Character]) -> (Vec<f64>, String) {
        let relief = |height_m: f64, slope: f64| format!("{height_m:.0} m, {:.0} %", slope * 100.0);
        let mut here = format!("{} steep", relief(self.height_m, self.slope));
        if let Some(density) = self.density {
            here += &format!(", {density:.1} km/km²");
        }
        let best = examples
            .iter()
            .enumerate()
            .filter_map(|(i, e)| Some((i, self.cost(e)?)))
            .min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        let Some((best, _)) = best else {
            let weights = examples.iter().map(|e| e.weight).collect();
            return (weights, format!("{here}; no example knows its ground, so all serve"));
        };
        let mut weights = vec![0.0; examples.len()];
        weights[best] = 1.0;
        let Character { name, relief: own, density, .. } = &examples[best];
        let mut its = own.map_or(String::new(), |(height_m, slope)| relief(height_m, slope));
        if self.density.is_some() {
            its = format!("{its} {density:.1} km/km²");
        }
        (weights, format!("{here}; like `{name}` ({})", its.trim()))
    }

    /// How unlike an example is; `None` where nothing is known to compare.
    fn cost(&self, example: &Character) -> Option<f64> {
        let ground = example.relief.map(|(height_m, slope)| {
            let apart = (height_m - self.height_m).abs() / HEIGHT_UNIT_M;
            // Heights count up to a limit: a plain at sea level and one at 600 m are both plains.
            apart.min(2.0) + (slope - self.slope).abs() / SLOPE_UNIT
        });
        let density = self.density.map(|wanted| {
            let ratio = wanted.max(0.01) / example.density.max(0.01);
            (ratio.max(1.0 / ratio) - 1.0) / DENSITY_UNIT
        });
        match (ground, density) {
            // An example whose ground is unknown stands behind those of fitting ground.
            (None, Some(density)) => Some(density + 2.0),
            (ground, density) => ground.map(|g| g + density.unwrap_or(0.0)),
        }
    }
}

/// The weights that an area gives to examples by their names.
pub fn by_name(wanted: &BTreeMap<String, f64>, examples: &[Character]) -> Result<Vec<f64>, Error> {
    let mut weights = vec![0.0; examples.len()];
    for (name, weight) in wanted {
        let Some(i) = examples.iter().position(|e| *e.name == **name) else {
            let known: Vec<&str> = examples.iter().map(|e| &*e.name).collect();
            return Err(Error::Params(format!(
                "`areas` names the example `{name}`, which is none of {}",
                known.join(", ")
            )));
        };
        if !(weight.is_finite() && *weight >= 0.0) {
            return Err(Error::Params(format!("`areas` gives `{name}` the weight {weight}")));
        }
        weights[i] = *weight;
    }
    if weights.iter().sum::<f64>() > 0.0 {
        Ok(weights)
    } else {
        Err(Error::Params("an area of `areas` gives no example any weight".into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example(name: &str, relief: Option<(f64, f64)>, density: f64) -> Character {
        Character { name: name.into(), weight: 1.0, relief, density }
    }

    #[test]
    fn the_example_is_chosen_that_differs_least_in_what_is_known() {
        let library = [
            example("plain", Some((10.0, 0.01)), 20.0),
            example("hills", Some((300.0, 0.15)), 12.0),
            example("dense plain", Some((12.0, 0.01)), 35.0),
            example("unknown", None, 12.0),
        ];
        let choice = |height_m, slope, density| {
            let (weights, why) = Place { height_m, slope, density }.fitting(&library);
            assert_eq!(weights.iter().sum::<f64>(), 1.0);
            let i = weights.iter().position(|w| *w == 1.0).unwrap();
            assert!(why.contains(&*library[i].name), "{why}");
            i
        };
        assert_eq!(choice(11.0, 0.01, Some(18.0)), 0);
        assert_eq!(choice(11.0, 0.01, Some(40.0)), 2);
        assert_eq!(choice(250.0, 0.12, None), 1);
        let (all, _) = Place { height_m: 0.0, slope: 0.0, density: None }.fitting(&library[3..]);
        assert_eq!(all, [1.0]);
    }
}
