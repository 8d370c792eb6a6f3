use std::sync::Arc;

use exurb_city::{
    Area, Building, City, Class, Feature, FeatureShape, Origin, Provenance, Street, block,
    street_graph,
};
use exurb_geom::{Frame, GridPoint, Polygon, Vec2};
use exurb_operation::{Example, Run, Scope, erase};
use serde_json::{Value, json};

use super::Furnish;

/// Two by two blocks of 120 m, in the first of them a park, in the second a house near the kerb.
fn town(class: Class) -> City {
    let mut lines = Vec::new();
    let p = |x: u32, y: u32| GridPoint::m(f64::from(x) * 120.0, f64::from(y) * 120.0);
    for i in 0..=2 {
        for j in 0..2 {
            let street = || Street { class, ..Street::default() };
            lines.push((vec![p(i, j), p(i, j + 1)], street()));
            lines.push((vec![p(j, i), p(j + 1, i)], street()));
        }
    }
    let mut city = City::empty(Frame::null_island(), Polygon::rectangle(p(0, 0), p(2, 2)));
    city.streets = Arc::new(street_graph::from_lines(lines));
    city.blocks = Arc::new(block::derive(&city.streets));
    let park = city.blocks[0].polygon.clone();
    city.land_use = Arc::new(vec![Area { id: 1, polygon: park, class: "park".into() }]);
    let low = city.blocks[1].polygon.bounds().min + Vec2::new(30.0, 0.5);
    let house = Polygon::rectangle(GridPoint::round(low), GridPoint::round(low + 40.0));
    city.buildings = Arc::new(vec![Building::new(1, house, Provenance::of(Origin::Imported))]);
    city
}

fn furnished(city: &City, example: Option<&City>, params: Value, seed: u64) -> City {
    let examples: Vec<Example> = example.map(|e| Example::new(e.clone())).into_iter().collect();
    let run = Run::new(seed);
    erase::<Furnish>().run(city, &Scope::All, &examples, params, &run).unwrap().city
}

fn of_kind<'a>(city: &'a City, kind: &'a str) -> impl Iterator<Item = (Vec2, u32)> + 'a {
    city.features.iter().filter(move |f| &*f.kind == kind).map(|f| match f.shape {
        FeatureShape::Point(p) => (p.to_m(), f.block),
        _ => panic!("only points are made"),
    })
}

#[test]
fn everything_stands_in_its_block_apart_and_clear_of_houses() {
    let city = town(Class::Residential);
    let made = furnished(&city, None, json!({}), 1);
    let all: Vec<(Vec2, u32)> = of_kind(&made, "tree").chain(of_kind(&made, "lamp")).collect();
    assert!(all.len() > 80, "{}", all.len());
    let house = &city.buildings[0].polygon;
    for (i, (p, block)) in all.iter().enumerate() {
        let block = &city.blocks.iter().find(|b| b.id == *block).unwrap().polygon;
        assert!(block.contains(GridPoint::round(*p)) && block.boundary_distance_m(*p) > 0.35);
        assert!(!house.contains(GridPoint::round(*p)) && house.boundary_distance_m(*p) > 0.95);
        assert!(all[i + 1..].iter().all(|(q, _)| q.distance(*p) > 2.9), "{p}");
    }
}

#[test]
fn street_trees_and_lamps_stand_on_the_pavement_every_thirty_metres() {
    let city = town(Class::Residential);
    let made = furnished(&city, None, json!({}), 1);
    for kind in ["tree", "lamp"] {
        let in_strip = of_kind(&made, kind).filter(|(p, _)| {
            city.blocks.iter().any(|b| {
                b.polygon.contains(GridPoint::round(*p)) && b.polygon.boundary_distance_m(*p) < 2.0
            })
        });
        // Four blocks of 114 m by 114 m within the kerbs, corners and the house left out.
        let per_block = in_strip.count() as f64 / 4.0;
        assert!((9.0..17.0).contains(&per_block), "{kind}: {per_block}");
    }
}

#[test]
fn parks_get_two_trees_by_a_thousand_square_metres() {
    let city = town(Class::Residential);
    let made = furnished(&city, None, json!({"street_trees": 0.0, "lamps": 0.0}), 1);
    let park = &city.blocks[0];
    assert!(of_kind(&made, "tree").all(|(_, block)| block == park.id));
    let expected = park.polygon.area_m2() * 0.002;
    let found = of_kind(&made, "tree").count() as f64;
    assert!((found / expected - 1.0).abs() < 0.35, "{found} of {expected}");
}

#[test]
fn spacing_is_learned_where_the_example_is_mapped_well() {
    let mut example = town(Class::Residential);
    let mut features = Vec::new();
    for block in example.blocks.iter() {
        let strip = exurb_geom::offset::inset(&block.polygon, 1.0);
        let ring = exurb_geom::polyline::to_m(strip[0].exterior());
        let line = [&ring[..], &ring[..1]].concat();
        for p in exurb_geom::polyline::resample(&line, 10.0) {
            features.push(Feature {
                id: features.len() as u32 + 1,
                kind: "tree".into(),
                shape: FeatureShape::Point(GridPoint::round(p)),
                block: block.id,
                provenance: Provenance::of(Origin::Imported),
            });
        }
    }
    let known = features.len() as f64;
    example.features = Arc::new(features);
    let mut city = town(Class::Residential);
    (city.buildings, city.land_use) = Default::default();
    let made = furnished(&city, Some(&example), json!({}), 1);
    let found = of_kind(&made, "tree").count() as f64;
    assert!((0.75..1.15).contains(&(found / known)), "{found} of {known}");
}

#[test]
fn motorways_have_neither() {
    let mut city = town(Class::Motorway);
    city.land_use = Arc::default();
    assert!(furnished(&city, None, json!({}), 1).features.is_empty());
}

#[test]
fn furnishing_again_replaces_and_what_was_imported_stays() {
    let mut city = town(Class::Residential);
    let at = GridPoint::round(city.blocks[3].polygon.centroid());
    let bench = Feature {
        id: 1,
        kind: "tree".into(),
        shape: FeatureShape::Point(at),
        block: city.blocks[3].id,
        provenance: Provenance::of(Origin::Imported),
    };
    city.features = Arc::new(vec![bench]);
    let once = furnished(&city, None, json!({}), 1);
    let twice = furnished(&once, None, json!({}), 1);
    assert_eq!(once.features, twice.features);
    assert!(matches!(once.features[0].shape, FeatureShape::Point(p) if p == at));
}

#[test]
fn equal_seeds_give_equal_features_on_one_thread_and_two() {
    let city = town(Class::Residential);
    let with = |threads, seed| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| furnished(&city, None, json!({}), seed).features)
    };
    assert_eq!(with(1, 7), with(2, 7));
    assert_ne!(with(1, 7), with(1, 8));
}
