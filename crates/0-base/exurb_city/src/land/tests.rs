use exurb_geom::{Frame, GridPoint, Polygon, Vec2, polyline, trig};
use proptest::prelude::*;

use super::Land;
use crate::{Area, City, Terrain};

fn city(water: Vec<Polygon>) -> City {
    let target = Polygon::rectangle(GridPoint::m(-500.0, -500.0), GridPoint::m(500.0, 500.0));
    let mut city = City::empty(Frame::null_island(), target);
    let area = |polygon| Area { id: 1, polygon, class: "lake".into() };
    city.water = water.into_iter().map(area).collect::<Vec<_>>().into();
    city
}

/// A wobbly lake around `center`.
fn lake(center: Vec2, radius_m: f64, lobes: f64) -> Polygon {
    let corner = |k: i32| {
        let angle = f64::from(k) / 90.0 * std::f64::consts::TAU;
        let out = radius_m * (1.0 + 0.35 * trig::sin(lobes * angle));
        GridPoint::round(center + trig::unit(angle) * out)
    };
    Polygon::new((0..90).map(corner).collect(), vec![]).unwrap()
}

fn lakes() -> impl Strategy<Value = Vec<Polygon>> {
    let one = ((-700.0..700.0, -700.0..700.0), 5.0..400.0f64, 0u8..7);
    prop::collection::vec(one, 1..5).prop_map(|lakes| {
        let lake =
            |((x, y), r, lobes): ((f64, f64), f64, u8)| lake(Vec2::new(x, y), r, lobes.into());
        lakes.into_iter().map(lake).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// The grid answers as walking every polygon does.
    #[test]
    fn wet_is_what_lies_in_a_water_polygon(water in lakes(), seed in 0u32..1000) {
        let land = Land::of(&city(water.clone()));
        let shore = |p: Vec2| water.iter().map(|w| w.boundary_distance_m(p)).fold(f64::MAX, f64::min);
        for k in seed..seed + 400 {
            // Spread over the box and a little beyond, every fourth one near a shore.
            let mix = |n: u32| f64::from(k.wrapping_mul(n) % 20_011) / 20_011.0;
            let mut p = Vec2::new(mix(7919), mix(6007)) * 1990.0 - 995.0;
            if k % 4 == 0 {
                let ring = water[k as usize % water.len()].exterior();
                p = ring[k as usize % ring.len()].to_m() + Vec2::new(mix(31), mix(17)) * 3.0 - 1.5;
            }
            // Within two millimetres of a shore the union's own rounding decides.
            if p.abs().max_element() > 999.0 || shore(p) < 0.003 {
                continue;
            }
            let at = GridPoint::round(p);
            let wet = water.iter().any(|w| w.contains(at));
            prop_assert_eq!(land.is_wet(p), wet, "{}", p);
            let distance = if wet { 0.0 } else { shore(p) };
            let told = land.water_distance_m(p);
            prop_assert!(told > distance - 0.01, "{}: {} of {}", p, told, distance);
            prop_assert!(told < distance + 14.2, "{}: {} of {}", p, told, distance);
        }
    }
}

#[test]
fn holes_in_water_are_dry_and_overlaps_are_wet() {
    let sea = Polygon::rectangle(GridPoint::m(-900.0, -900.0), GridPoint::m(0.0, 900.0));
    let island = Polygon::rectangle(GridPoint::m(-300.0, -50.0), GridPoint::m(-200.0, 50.0));
    let sea = Polygon::new(sea.exterior().to_vec(), vec![island.exterior().to_vec()]).unwrap();
    let bay = Polygon::rectangle(GridPoint::m(-100.0, -100.0), GridPoint::m(80.0, 100.0));
    let land = Land::of(&city(vec![sea, bay]));
    assert!(!land.is_wet(Vec2::new(-250.0, 0.0)) && land.is_wet(Vec2::new(-310.0, 0.0)));
    assert!(land.is_wet(Vec2::new(-50.0, 0.0)) && land.is_wet(Vec2::new(70.0, 0.0)));
    assert_eq!(land.water_distance_m(Vec2::new(-50.0, 0.0)), 0.0);
    assert_eq!(land.water_distance_m(Vec2::new(200.0, 0.0)), 120.0);
    // Outside the grid, too.
    assert!((land.water_distance_m(Vec2::new(5080.0, 0.0)) - 5000.0).abs() < 15.0);
}

#[test]
fn a_city_without_ground_or_water_is_flat_and_dry() {
    let land = Land::of(&city(vec![]));
    let p = Vec2::new(12.0, 34.0);
    assert_eq!((land.height_m(p), land.slope(p), land.is_wet(p)), (0.0, 0.0, false));
    assert_eq!(land.water_distance_m(p), f64::INFINITY);
    assert!(!land.has_terrain() && !land.has_water());
}

#[test]
fn gaps_and_edges_of_the_terrain_are_bridged() {
    let mut city = city(vec![]);
    let bounds = city.target.bounds();
    let ramp = |p: Vec2| if p.length() < 60.0 { f32::NAN } else { (p.x / 10.0) as f32 };
    let terrain = Terrain::over(bounds, 20.0, ramp).unwrap().with_water_level(Some(-45.0));
    city.lay(terrain);
    let land = Land::of(&city);
    assert!(land.height_m(Vec2::ZERO).abs() < 3.0, "{}", land.height_m(Vec2::ZERO));
    assert_eq!(land.height_m(Vec2::new(9e3, 0.0)), 50.0);
    assert!((land.gradient(Vec2::new(200.0, 0.0)) - Vec2::new(0.1, 0.0)).length() < 1e-6);
    assert!(land.is_wet(Vec2::new(-480.0, 0.0)) && !land.is_wet(Vec2::new(-440.0, 0.0)));
}

#[test]
fn near_a_shore_the_nearest_segment_counts() {
    let shore = lake(Vec2::ZERO, 200.0, 3.0);
    let land = Land::of(&city(vec![shore.clone()]));
    let p = Vec2::new(0.0, 299.0);
    let exact = shore
        .segments()
        .map(|(a, b)| polyline::nearest_on_segment(a.to_m(), b.to_m(), p).0.distance(p))
        .fold(f64::MAX, f64::min);
    assert!((land.water_distance_m(p) - exact).abs() < 1.0);
}
