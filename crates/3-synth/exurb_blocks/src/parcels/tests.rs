use exurb_city::{BlockClass, City};
use exurb_geom::{GridPoint, Polygon, Vec2, overlay};
use exurb_operation::{Example, Rng, Run, Scope, erase};
use rand::SeedableRng;
use serde_json::{Value, json};

use super::{Input, Params, Parcels, synthesize};
use crate::footprints::Footprints;
use crate::test_city::{Style, grid, odd_block, with_parks};

fn input(frontage_m: f64, depth_m: f64) -> Input {
    Input { frontages_m: vec![frontage_m], depth_m, fronted_share: 1.0 }
}

fn cut(ground: &Polygon, input: &Input, seed: u64) -> Vec<super::Lot> {
    synthesize(ground, input, &Params::default(), &mut Rng::seed_from_u64(seed))
}

fn rectangle(w: f64, h: f64) -> Polygon {
    Polygon::rectangle(GridPoint::m(0.0, 0.0), GridPoint::m(w, h))
}

fn run_on(city: &City, example: &City, params: Value, seed: u64) -> City {
    let run = Run::new(seed);
    let examples = [Example::new(example.clone())];
    erase::<Parcels>().run(city, &Scope::All, &examples, params, &run).unwrap().city
}

#[test]
fn two_rows_of_ten_back_to_back() {
    let lots = cut(&rectangle(200.0, 60.0), &input(20.0, 30.0), 1);
    assert_eq!(lots.len(), 20);
    for lot in lots {
        assert!((lot.polygon.area_m2() - 600.0).abs() < 0.1, "{}", lot.polygon.area_m2());
        // The backs meet on the axis.
        assert!(lot.polygon.bounds().size().y - 30.0 < 0.01);
    }
}

#[test]
fn a_shallow_block_has_one_row_that_reaches_through() {
    let lots = cut(&rectangle(200.0, 40.0), &input(20.0, 30.0), 1);
    assert!((7..=14).contains(&lots.len()), "{}", lots.len());
    assert!(lots.iter().all(|lot| (lot.polygon.bounds().size().y - 40.0).abs() < 0.01));
}

#[test]
fn a_square_block_has_lots_on_all_four_sides() {
    let ground = rectangle(120.0, 120.0);
    let lots = cut(&ground, &input(20.0, 30.0), 1);
    for (a, b) in ground.segments() {
        let middle = (a.to_m() + b.to_m()) / 2.0;
        let here = lots.iter().find(|l| l.polygon.boundary_distance_m(middle) < 0.01).unwrap();
        assert!((10.0..40.0).contains(&here.frontage_m), "{}", here.frontage_m);
    }
    assert!((16..=32).contains(&lots.len()), "{}", lots.len());
}

#[test]
fn lots_tile_blocks_of_any_shape_and_reach_the_street() {
    for number in 0..270 {
        let Some(ground) = odd_block(number) else { continue };
        let share = if number % 4 == 3 { 0.4 } else { 1.0 };
        let frontages_m = vec![6.0 + f64::from(number % 23), 14.0, 9.0];
        let depth_m = 12.0 + f64::from(number % 31);
        let input = Input { frontages_m, depth_m, fronted_share: share };
        let lots = cut(&ground, &input, u64::from(number));
        let whole: f64 = lots.iter().map(|l| l.polygon.area_m2()).sum();
        assert!((whole / ground.area_m2() - 1.0).abs() < 1e-3, "{number}: {whole}");
        for (i, lot) in lots.iter().enumerate() {
            assert!(lot.polygon.is_valid(), "{number}: {i} {:?}", lot.polygon);
            assert!(lot.frontage_m >= 3.0 || ground.perimeter_m() < 6.0, "{number}: {i}");
            for other in &lots[i + 1..] {
                let shared = overlay::intersection(&lot.polygon, &other.polygon);
                let area: f64 = shared.iter().map(Polygon::area_m2).sum();
                assert!(area < 0.02, "{number}: {i} overlaps by {area}");
            }
        }
    }
}

#[test]
fn neighbours_share_their_border_exactly() {
    let ground = odd_block(3).unwrap();
    let lots = cut(&ground, &input(18.0, 25.0), 5);
    let mut once = std::collections::BTreeMap::new();
    for (a, b) in lots.iter().flat_map(|l| l.polygon.segments()) {
        *once.entry((a.min(b), a.max(b))).or_insert(0) += 1;
    }
    // What is not shared lies on the edge of the ground.
    for ((a, b), count) in once {
        let on_edge = [a, b].iter().all(|p| ground.boundary_distance_m(p.to_m()) < 1e-3);
        assert!(count == 2 || on_edge, "{a:?} {b:?}");
    }
}

#[test]
fn odd_wishes_do_no_harm() {
    let ground = rectangle(80.0, 50.0);
    for (frontage_m, depth_m) in [(0.01, 0.01), (1e6, 1e6), (0.01, 1e6), (1e6, 0.01)] {
        let lots = cut(&ground, &input(frontage_m, depth_m), 1);
        let whole: f64 = lots.iter().map(|l| l.polygon.area_m2()).sum();
        assert!((whole - 4000.0).abs() < 1.0, "{frontage_m} {depth_m}: {whole}");
    }
    let speck = Polygon::rectangle(GridPoint { x: 0, y: 0 }, GridPoint { x: 1, y: 1 });
    assert_eq!(cut(&speck, &input(20.0, 30.0), 1).len(), 1);
}

#[test]
fn lots_are_as_wide_as_those_of_the_example() {
    let block_m = Vec2::new(150.0, 90.0);
    let rows =
        run_on(&grid(4, 4, block_m, Style::Empty), &grid(4, 4, block_m, Style::Rows), json!({}), 1);
    let detached = run_on(
        &grid(4, 4, block_m, Style::Empty),
        &grid(4, 4, block_m, Style::Detached),
        json!({}),
        1,
    );
    let per_block = |city: &City| city.parcels.len() as f64 / city.blocks.len() as f64;
    // The example has 26 houses a block in rows, 14 detached ones.
    assert!((20.0..30.0).contains(&per_block(&rows)), "{}", per_block(&rows));
    assert!((11.0..18.0).contains(&per_block(&detached)), "{}", per_block(&detached));
}

#[test]
fn parks_come_as_often_as_in_the_example_and_stay_whole() {
    let block_m = Vec2::new(120.0, 100.0);
    let example = with_parks(grid(6, 6, block_m, Style::Rows), 4);
    let made = run_on(&grid(12, 12, block_m, Style::Empty), &example, json!({}), 3);
    let parks: Vec<u32> =
        made.blocks.iter().filter(|b| b.land_use.is_some()).map(|b| b.id).collect();
    assert!((15..=60).contains(&parks.len()), "{} of 144, one in four", parks.len());
    for park in &parks {
        assert_eq!(made.parcels.iter().filter(|p| p.block == *park).count(), 1);
    }
    assert_eq!(made.land_use.len(), parks.len());
    let without =
        run_on(&grid(4, 4, block_m, Style::Empty), &example, json!({"open_land": false}), 3);
    assert!(without.land_use.is_empty());
}

#[test]
fn given_open_land_and_islands_are_not_parcelled() {
    let block_m = Vec2::new(100.0, 80.0);
    let mut city = with_parks(grid(3, 3, block_m, Style::Empty), 2);
    let mut blocks = city.blocks.to_vec();
    blocks[1].class = BlockClass::Island;
    let island = blocks[1].id;
    city.blocks = blocks.into();
    let made = run_on(&city, &grid(3, 3, block_m, Style::Rows), json!({}), 1);
    assert_eq!(made.land_use.len(), city.land_use.len());
    assert!(made.parcels.iter().all(|p| p.block != island));
    let of_first = made.parcels.iter().filter(|p| p.block == made.blocks[0].id);
    assert_eq!(of_first.map(|p| p.land_use.as_deref()).collect::<Vec<_>>(), [Some("park")]);
}

#[test]
fn equal_seeds_give_equal_parcels_on_one_thread_and_two() {
    let block_m = Vec2::new(130.0, 95.0);
    let (city, example) =
        (grid(5, 5, block_m, Style::Empty), with_parks(grid(5, 5, block_m, Style::Rows), 3));
    let with = |threads, seed| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run_on(&city, &example, json!({}), seed).parcels)
    };
    assert_eq!(with(1, 7), with(2, 7));
    assert_ne!(with(1, 7), with(1, 8));
}

#[test]
fn a_scope_leaves_the_rest_as_it_is() {
    let block_m = Vec2::new(130.0, 95.0);
    let example = [Example::new(grid(3, 3, block_m, Style::Rows))];
    let operation = erase::<Parcels>();
    let run = |city: &City, scope: Scope, seed| {
        operation.run(city, &scope, &example, Value::Null, &Run::new(seed)).unwrap().city
    };
    let before = run(&grid(3, 3, block_m, Style::Empty), Scope::All, 1);
    let after = run(&before, Scope::Blocks(vec![2]), 9);
    let of = |city: &City, is: fn(u32) -> bool| {
        let held = city.parcels.iter().filter(|p| is(p.block));
        held.map(|p| p.polygon.clone()).collect::<Vec<_>>()
    };
    assert_eq!(of(&before, |b| b != 2), of(&after, |b| b != 2));
    assert_ne!(of(&before, |b| b == 2), of(&after, |b| b == 2));
}

/// A block cut into another number of parcels moves the numbers of all after it.
#[test]
fn buildings_follow_their_parcels_when_others_are_cut_anew() {
    let example = [Example::new(grid(3, 3, Vec2::new(130.0, 95.0), Style::Rows))];
    let on = |city: &City, params: Value, scope: Scope| {
        let run = Run::new(1);
        erase::<Parcels>().run(city, &scope, &example, params, &run).unwrap().city
    };
    let city = on(&grid(3, 3, Vec2::new(130.0, 95.0), Style::Empty), Value::Null, Scope::All);
    let stand = erase::<Footprints>();
    let built = stand.run(&city, &Scope::All, &example, Value::Null, &Run::new(1)).unwrap().city;
    let cut = on(&built, json!({ "method": "box" }), Scope::Blocks(vec![2, 3]));
    assert_ne!(cut.parcels.len(), built.parcels.len());
    let home = |city: &City, number: u32| {
        city.parcels.iter().find(|p| p.id == number).map(|p| p.polygon.clone())
    };
    let kept: Vec<_> = built.buildings.iter().filter(|b| ![2, 3].contains(&b.block)).collect();
    assert_eq!(kept.len(), cut.buildings.len());
    for (before, after) in kept.into_iter().zip(cut.buildings.iter()) {
        assert_eq!(home(&built, before.parcel), home(&cut, after.parcel));
        let polygon = home(&cut, after.parcel).expect("a parcel");
        assert!(polygon.contains(GridPoint::round(after.polygon.interior_point())));
    }
}

#[test]
fn without_examples_defaults_are_used_and_said() {
    let run = Run::new(1);
    let city = grid(2, 2, Vec2::new(120.0, 90.0), Style::Empty);
    let made = erase::<Parcels>().run(&city, &Scope::All, &[], Value::Null, &run).unwrap().city;
    assert!(made.parcels.len() > 8);
    let warnings = run.take_warnings();
    assert!(warnings.iter().any(|w| w.message.contains("neither parcels nor buildings")));
}

#[test]
fn a_city_without_streets_is_refused() {
    let city = City::empty(exurb_geom::Frame::null_island(), rectangle(10.0, 10.0));
    let failure = erase::<Parcels>().run(&city, &Scope::All, &[], Value::Null, &Run::new(1));
    assert!(failure.unwrap_err().to_string().contains("grow streets first"));
}

/// Walls that footprints have in common but for the rounding of their ends: lines within a millimetre of
/// one another cross at many places, and each crossing, rounded, makes others.
#[test]
fn lines_that_nearly_coincide_are_noded_to_the_end() {
    use rand::RngExt;
    let ground = Polygon::rectangle(GridPoint::m(0.0, 0.0), GridPoint::m(90.0, 70.0));
    let mut rng = Rng::seed_from_u64(5);
    for k in 0..200 {
        let along = exurb_geom::trig::unit(0.37 * f64::from(k));
        let mut near = |at: f64| {
            let off = Vec2::new(rng.random_range(-0.001..0.001), rng.random_range(-0.001..0.001));
            Vec2::new(45.0, 35.0) + along * at + off
        };
        let mut lines = vec![vec![near(-80.0), near(80.0)]];
        for i in 0..9 {
            let at = -30.0 + 5.0 * f64::from(i);
            lines.push(vec![near(at), near(at + 22.0)]);
        }
        let tiling = super::tiling::Tiling::of(&ground, &lines, |_| 0);
        let mut faces = super::tiling::Tiling::of(&ground, &lines, |p| {
            u32::from(along.perp_dot(p - Vec2::new(45.0, 35.0)) > 0.0)
        });
        faces.join(|piece| piece.area_m2 < 10.0);
        for (polygon, _) in tiling.polygons().into_iter().chain(faces.polygons()) {
            assert!(polygon.is_valid(), "{k}");
        }
    }
}
