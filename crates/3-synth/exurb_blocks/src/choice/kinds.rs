//! Which blocks become parks, schools, shopping centres: drawn by example.
//!
//! For each kind of block but ordinary ones, rarest kind first, as many blocks are drawn as the example
//! has among blocks that lie so (size, shape, streets around, distance to main streets); likely is one
//! that lies as far from its like as the example's do.

use std::collections::BTreeMap;
use std::sync::Arc;

use exurb_geom::{Vec2, trig};
use exurb_operation::Rng;
use rand::RngExt;

use crate::library::Features;

/// What a block is for; `None` is an ordinary built block.
pub type Kind = Option<Arc<str>>;

/// How a block lies.
#[derive(Clone, Debug)]
pub struct Situation {
    /// What blocks are compared by.
    pub features: Features,
    /// Distance of its middle to the nearest main street in metres; `None` where there is none.
    pub main_m: Option<f64>,
    /// Its middle.
    pub at: Vec2,
}

/// All example blocks together count as so many that lie like the place in question: where the example has
/// none of its size, its one large park does not make every large block a park.
const PRIOR: f64 = 0.5;
/// How likely a block is that lies this far from the example's, in units of the spread.
const REACH: f64 = 0.6;
/// Likeness of distances, in factors of e.
const DISTANCE_REACH: f64 = 0.5;

/// The kinds of `places`, those `known` staying. `example` holds each example block's kind and
/// situation. O(places · example).
pub fn draw(
    places: &[Situation],
    known: &[Option<Kind>],
    example: &[(Kind, Situation)],
    rng: &mut Rng,
) -> Vec<Kind> {
    let spread = Features::spread(example.iter().map(|(_, s)| &s.features));
    let mut by_kind: BTreeMap<&Arc<str>, Vec<&Situation>> = BTreeMap::new();
    for (kind, situation) in example {
        if let Some(kind) = kind {
            by_kind.entry(kind).or_default().push(situation);
        }
    }
    let mut kinds: Vec<(&Arc<str>, Vec<&Situation>)> = by_kind.into_iter().collect();
    kinds.sort_by(|a, b| a.1.len().cmp(&b.1.len()).then(a.0.cmp(b.0)));
    let mut out: Vec<Option<Kind>> = known.to_vec();
    let all: Vec<&Situation> = example.iter().map(|(_, s)| s).collect();
    let any: Vec<f64> = places.iter().map(|p| likeness(p, &all, &spread)).collect();
    for (kind, models) in kinds {
        // How often the example's blocks that lie so are of this kind; where hardly any lies so, how often
        // all of them are.
        let overall = models.len() as f64 / example.len().max(1) as f64;
        let share = |i: usize| {
            let like = likeness(&places[i], &models, &spread);
            (like + PRIOR * overall) / (any[i] + PRIOR)
        };
        let shares: Vec<f64> = (0..places.len()).map(share).collect();
        let free = |i: &usize| out[*i].is_none();
        // What is left of a block is drawn, too.
        let expected: f64 = (0..places.len()).filter(free).map(|i| shares[i]).sum();
        let wanted = (expected + rng.random::<f64>()) as usize;
        let between = nearest_distances(&models.iter().map(|m| m.at).collect::<Vec<_>>());
        for _ in 0..wanted {
            let mine: Vec<Vec2> = (0..places.len())
                .filter(|i| out[*i].as_ref().is_some_and(|k| k.as_ref() == Some(kind)))
                .map(|i| places[i].at)
                .collect();
            let weights: Vec<f64> = (0..places.len())
                .map(|i| {
                    if out[i].is_none() {
                        shares[i] * apart(&places[i], &mine, &between)
                    } else {
                        0.0
                    }
                })
                .collect();
            let Some(i) = drawn(&weights, rng) else { break };
            out[i] = Some(Some(kind.clone()));
        }
    }
    out.into_iter().map(Option::flatten).collect()
}

/// How much a place lies as example blocks do, in all.
fn likeness(place: &Situation, models: &[&Situation], spread: &Features) -> f64 {
    let one = |m: &&Situation| {
        let off = place.features.distance(&m.features, spread) / REACH;
        let main = match (place.main_m, m.main_m) {
            (Some(a), Some(b)) => (ln(a) - ln(b)) / DISTANCE_REACH,
            _ => 0.0,
        };
        trig::exp(-0.5 * (off * off + 0.25 * main * main))
    };
    models.iter().map(one).sum::<f64>() + 1e-9
}

/// How well the distance to the nearest of its like suits.
fn apart(place: &Situation, mine: &[Vec2], between: &[f64]) -> f64 {
    let nearest = mine.iter().map(|p| p.distance(place.at)).reduce(f64::min);
    let (Some(nearest), false) = (nearest, between.is_empty()) else { return 1.0 };
    let likeness = |d: &f64| {
        let off = (ln(nearest) - ln(*d)) / DISTANCE_REACH;
        trig::exp(-0.5 * off * off)
    };
    between.iter().map(likeness).sum::<f64>() / between.len() as f64 + 1e-6
}

fn nearest_distances(points: &[Vec2]) -> Vec<f64> {
    let nearest = |i: usize| {
        let others = (0..points.len()).filter(|j| *j != i).map(|j| points[i].distance(points[j]));
        others.reduce(f64::min)
    };
    (0..points.len()).filter_map(nearest).collect()
}

fn ln(v: f64) -> f64 {
    trig::ln(v.max(1.0))
}

fn drawn(weights: &[f64], rng: &mut Rng) -> Option<usize> {
    let total: f64 = weights.iter().sum();
    if total <= 0.0 {
        return None;
    }
    let mut left = rng.random::<f64>() * total;
    let found = weights.iter().position(|w| {
        left -= w;
        left < 0.0
    });
    found.or_else(|| weights.iter().rposition(|w| *w > 0.0))
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;

    use super::*;

    fn situation(k: u32, main_m: f64) -> Situation {
        let at = Vec2::new(f64::from(k % 20), f64::from(k / 20)) * 100.0;
        Situation { features: Features::default(), main_m: Some(main_m), at }
    }

    fn city(parks: &[u32]) -> Vec<(Kind, Situation)> {
        let kind = |k| parks.contains(&k).then(|| Arc::from("park"));
        (0..200).map(|k| (kind(k), situation(k, if k % 20 < 3 { 20.0 } else { 300.0 }))).collect()
    }

    fn parks(example: &[(Kind, Situation)], known: &[Option<Kind>], seed: u64) -> Vec<usize> {
        let places: Vec<Situation> =
            (0..200).map(|k| situation(k, if k % 20 < 3 { 20.0 } else { 300.0 })).collect();
        let kinds = draw(&places, known, example, &mut Rng::seed_from_u64(seed));
        (0..200).filter(|i| kinds[*i].is_some()).collect()
    }

    #[test]
    fn the_share_is_the_examples() {
        for seed in 0..20 {
            let found =
                parks(&city(&[5, 50, 95, 140, 185, 33, 78, 123, 168, 199]), &vec![None; 200], seed);
            assert!((10..=11).contains(&found.len()), "{}", found.len());
        }
    }

    #[test]
    fn what_lies_at_main_streets_does_so_again_and_like_keeps_apart() {
        let example = city(&[1, 81, 161]);
        let mut near = 0;
        for seed in 0..30 {
            let found = parks(&example, &vec![None; 200], seed);
            near += found.iter().filter(|i| *i % 20 < 3).count();
            let at = |i: usize| situation(i as u32, 0.0).at;
            let pairs = found
                .iter()
                .flat_map(|i| found.iter().filter(move |j| *j > i).map(move |j| (*i, *j)));
            assert!(pairs.into_iter().all(|(i, j)| at(i).distance(at(j)) > 90.0));
        }
        // Three columns of twenty lie there.
        assert!(near > 60, "{near} of 90");
    }

    #[test]
    fn blocks_of_sizes_that_the_example_has_not_are_of_its_kinds_as_often() {
        let mut example = city(&[7]);
        for (k, (kind, situation)) in example.iter_mut().enumerate() {
            let area = if kind.is_some() { 4e4 } else { 1e3 + 10.0 * k as f64 };
            situation.features = Features::of_area(area);
        }
        let places: Vec<Situation> = (0..200)
            .map(|k| Situation {
                features: Features::of_area(3e4 + 50.0 * f64::from(k)),
                ..situation(k, 20.0)
            })
            .collect();
        let kinds = draw(&places, &vec![None; 200], &example, &mut Rng::seed_from_u64(1));
        let parks = kinds.iter().filter(|k| k.is_some()).count();
        assert!((1..=40).contains(&parks), "{parks} of 200");
    }

    #[test]
    fn what_is_known_counts_and_stays() {
        let mut known: Vec<Option<Kind>> = vec![None; 200];
        known[0] = Some(Some("park".into()));
        known[1] = Some(None);
        let found = parks(&city(&[5, 105]), &known, 3);
        assert!(found.contains(&0) && !found.contains(&1) && found.len() <= 3);
    }
}
