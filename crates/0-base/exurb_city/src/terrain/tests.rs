use exurb_geom::{Bounds, Frame, GridPoint, Polygon, Vec2};
use proptest::prelude::*;

use super::*;
use crate::{City, Street, street_graph};

fn bounds(size_m: f64) -> Bounds {
    Bounds { min: Vec2::ZERO, max: Vec2::splat(size_m) }
}

fn plane(p: Vec2) -> f32 {
    (100.0 + 0.25 * p.x - 0.5 * p.y) as f32
}

fn square(from: f64, to: f64) -> Polygon {
    Polygon::rectangle(GridPoint::m(from, from), GridPoint::m(to, to))
}

proptest! {
    #[test]
    fn a_plane_is_sampled_exactly(x in 0.0..200.0f64, y in 0.0..200.0f64) {
        let terrain = Terrain::over(bounds(200.0), 10.0, plane).unwrap();
        let p = Vec2::new(x, y);
        let height = terrain.height_m(p).unwrap();
        prop_assert!((height - f64::from(plane(p))).abs() < 1e-4);
        prop_assert!(terrain.gradient(p).unwrap().abs_diff_eq(Vec2::new(0.25, -0.5), 1e-5));
        prop_assert!((terrain.slope(p).unwrap() - 0.3125_f64.sqrt()).abs() < 1e-5);
    }

    /// Heights and gradients do not jump from cell to cell.
    #[test]
    fn sampling_is_continuous(
        heights in prop::collection::vec(0.0..50.0f32, 36), x in 0.1..49.9f64, y in 0.1..49.9f64,
    ) {
        let terrain = Terrain::new(GridPoint::m(0.0, 0.0), 10_000, 6, heights).unwrap();
        let (p, step) = (Vec2::new(x, y), Vec2::splat(1e-6));
        let rise = terrain.height_m(p + step).unwrap() - terrain.height_m(p - step).unwrap();
        prop_assert!(rise.abs() < 1e-3);
        let turn = terrain.gradient(p + step).unwrap() - terrain.gradient(p - step).unwrap();
        prop_assert!(turn.length() < 1e-3);
    }

    /// Filled gaps lie between what is known, and what is known stays.
    #[test]
    fn gaps_are_filled_from_around(
        known in prop::collection::btree_map(0usize..221, -20.0..500.0f32, 1..40),
    ) {
        let mut heights = vec![f32::NAN; 13 * 17];
        known.iter().for_each(|(at, height)| heights[*at] = *height);
        let gappy = Terrain::new(GridPoint::m(5.0, 7.0), 25_000, 13, heights).unwrap();
        let filled = gappy.filled();
        prop_assert_eq!(filled.missing(), 0);
        let (low, high) = gappy.range_m();
        for (before, after) in gappy.heights().iter().zip(filled.heights()) {
            prop_assert!(before.is_nan() || before == after);
            prop_assert!((low - 1e-3..=high + 1e-3).contains(after));
        }
    }

    #[test]
    fn a_part_has_the_heights_of_the_whole(
        x in -50.0..150.0f64, y in -50.0..150.0f64, w in 1.0..200.0f64, h in 1.0..200.0f64,
    ) {
        let hilly = |p: Vec2| ((p.x * 7.0) % 13.0 + (p.y * 3.0) % 11.0) as f32;
        let whole = Terrain::over(bounds(200.0), 10.0, hilly).unwrap();
        let asked = Bounds { min: Vec2::new(x, y), max: Vec2::new(x + w, y + h) };
        let Some(part) = whole.crop(asked) else {
            return Err(TestCaseError::reject("no ground in common"));
        };
        for row in 0..part.rows() {
            for column in 0..part.columns() {
                let p = part.post(column, row);
                prop_assert_eq!(part.height_m(p), whole.height_m(p));
            }
        }
        let kept = part.bounds();
        let wanted = Vec2::max(asked.min, whole.bounds().min);
        prop_assert!(kept.min.cmple(wanted + 1e-9).all() && (wanted - kept.min).max_element() < 10.0);
    }
}

#[test]
fn what_is_no_terrain_is_refused() {
    let new = |cell_mm, columns, heights| {
        Terrain::new(GridPoint::m(0.0, 0.0), cell_mm, columns, heights).unwrap_err()
    };
    assert_eq!(new(1000, 1, vec![0.0; 9]), TerrainError::Size { columns: 1, rows: 9 });
    assert_eq!(new(1000, 4, vec![0.0; 9]), TerrainError::Rows(9));
    assert_eq!(new(1000, 3, vec![f32::INFINITY; 9]), TerrainError::Empty);
    assert_eq!(new(900_000_000, 3, vec![0.0; 9]), TerrainError::Reach(900_000.0));
    let huge = Terrain::over(bounds(1e5), 0.1, plane);
    assert!(matches!(huge, Err(TerrainError::TooMany(_))));
}

#[test]
fn the_last_row_and_column_belong_to_the_terrain_and_nothing_beyond() {
    let terrain = Terrain::over(bounds(200.0), 10.0, plane).unwrap();
    assert_eq!(terrain.height_m(Vec2::splat(200.0)), Some(50.0));
    assert_eq!(terrain.height_m(Vec2::new(200.001, 0.0)), None);
    assert_eq!(terrain.height_m(Vec2::NAN), None);
}

#[test]
fn missing_heights_are_told_by_their_share() {
    let terrain = Terrain::over(bounds(200.0), 10.0, |p| if p.x < 100.0 { 5.0 } else { f32::NAN });
    let terrain = terrain.unwrap();
    assert_eq!(terrain.missing_share(&square(10.0, 80.0)), 0.0);
    assert_eq!(terrain.missing_share(&square(120.0, 180.0)), 1.0);
    // Known up to the post at 90 m; outside the grid nothing is.
    assert!((terrain.missing_share(&square(0.0, 200.0)) - 0.55).abs() < 0.01);
    assert!(terrain.missing_share(&square(0.0, 400.0)) > 0.85);
    assert_eq!(terrain.relief(&square(120.0, 180.0)), None);
    let relief = terrain.relief(&square(0.0, 200.0)).unwrap();
    assert_eq!(relief, Relief { mean_m: 5.0, range_m: (5.0, 5.0), slope: 0.0 });
}

#[test]
fn another_cell_keeps_the_ground() {
    let terrain = Terrain::over(bounds(200.0), 10.0, plane).unwrap().with_water_level(Some(3.0));
    let fine = terrain.resample(terrain.bounds(), 2.5).unwrap();
    assert_eq!((fine.columns(), fine.rows(), fine.water_level_m()), (81, 81, Some(3.0)));
    assert!((fine.height_m(Vec2::new(33.3, 77.7)).unwrap() - 69.475).abs() < 1e-3);
}

fn city(size_m: f64) -> City {
    City::empty(Frame::null_island(), square(0.0, size_m))
}

#[test]
fn junctions_stand_on_the_ground_and_bridges_between_their_heads() {
    let line = |points: &[(f64, f64)]| points.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect();
    let bridge = Street { bridge: true, ..Street::default() };
    let streets = [
        (line(&[(0.0, 50.0), (40.0, 50.0)]), Street::default()),
        (line(&[(40.0, 50.0), (100.0, 50.0)]), bridge.clone()),
        (line(&[(100.0, 50.0), (160.0, 50.0)]), bridge.clone()),
        (line(&[(100.0, 50.0), (100.0, 90.0)]), bridge),
        (line(&[(160.0, 50.0), (200.0, 50.0)]), Street::default()),
    ];
    let mut city = city(200.0);
    city.streets = street_graph::from_lines(streets).into();
    // A valley from south to north, 20 m deep in the middle.
    let valley = |p: Vec2| (p.x - 100.0).abs() as f32 / 5.0 + 10.0;
    city.lay(Terrain::over(bounds(200.0), 10.0, valley).unwrap());
    let z = |x: f64| {
        let node = city.streets.nodes().find(|(_, n)| n.at == GridPoint::m(x, 50.0)).unwrap();
        node.1.data.z_m
    };
    assert_eq!((z(0.0), z(40.0), z(160.0)), (30.0, 22.0, 22.0));
    assert!((z(100.0) - 22.0).abs() < 0.01, "not in the valley at 10 m but {}", z(100.0));
}

#[test]
fn what_lies_under_the_water_level_becomes_water_once() {
    let mut city = city(200.0);
    city.water =
        vec![crate::Area { id: 1, polygon: square(0.0, 50.0), class: "sea".into() }].into();
    let ramp = Terrain::over(bounds(200.0), 10.0, |p| p.x as f32 / 10.0).unwrap();
    city.lay(ramp.with_water_level(Some(8.0)));
    city.flood();
    let area = |city: &City| city.water.iter().map(|a| a.polygon.area_m2()).sum::<f64>();
    assert!((area(&city) - 80.0 * 200.0).abs() < 2.0, "{}", area(&city));
    assert_eq!(city.water.iter().map(|a| a.id).collect::<Vec<_>>(), [1, 2]);
    city.flood();
    assert_eq!(city.water.len(), 2, "a second flood finds nothing new");
}
