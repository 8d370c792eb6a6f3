use exurb_geom::{GridPoint, Polygon};

use super::{Correspondence, Settings, Source};

fn ring(corners: &[(f64, f64)]) -> Vec<GridPoint> {
    corners.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect()
}

fn house(x: f64, y: f64, w: f64, d: f64) -> Polygon {
    Polygon::rectangle(GridPoint::m(x, y), GridPoint::m(x + w, y + d))
}

/// A block of 120 m by 70 m with a tight row below, detached houses above, and corner buildings.
fn block() -> (Vec<GridPoint>, Vec<Polygon>) {
    let outline = ring(&[(0., 0.), (120., 0.), (120., 70.), (0., 70.)]);
    let mut houses = vec![];
    let widths = [11.0, 9.0, 12.5, 10.0, 8.0, 13.0, 9.5, 10.5, 11.5];
    let mut x = 12.0;
    for w in widths {
        houses.push(house(x, 3.0, w, 11.0));
        x += w;
    }
    houses.extend([house(3., 3., 9., 14.), house(x, 3., 10., 14.)]);
    for k in 0..5 {
        houses.push(house(14.0 + 20.0 * f64::from(k), 56.0, 10.0, 9.0));
    }
    (outline, houses)
}

#[test]
fn an_undeformed_layout_comes_back() {
    let (outline, houses) = block();
    let settings = Settings::default();
    let source = Source::of(&outline, houses.clone(), &[], &settings);
    let domain = Polygon::new(outline.clone(), vec![]).expect("has area");
    let link = Correspondence::by_vertices(&outline, &outline).expect("vertices stayed");
    let placed = source.retarget(&domain, &outline, &link, &settings);
    let mut seen = vec![0; houses.len()];
    for placement in &placed {
        for member in &placement.members {
            seen[*member] += 1;
            let at = houses[*member].centroid();
            let moved = placement.motion.apply(at);
            assert!(moved.distance(at) < 0.01, "{member} {at} {moved}");
        }
    }
    assert!(seen.iter().all(|n| *n == 1), "{seen:?}");
}

fn placed(outline: &[(f64, f64)], settings: &Settings) -> Vec<super::Placement> {
    let (old, houses) = block();
    let outline = ring(outline);
    let source = Source::of(&old, houses, &[], settings);
    let domain = Polygon::new(outline.clone(), vec![]).expect("has area");
    let link = Correspondence::by_vertices(&old, &outline)
        .unwrap_or_else(|| Correspondence::by_shape(&old, &outline));
    source.retarget(&domain, &outline, &link, settings)
}

fn uses(placed: &[super::Placement], of: std::ops::Range<usize>) -> usize {
    placed.iter().flat_map(|p| &p.members).filter(|m| of.contains(m)).count()
}

/// Numbers of the row below and of the houses above in [`block`].
const ROW: std::ops::Range<usize> = 0..9;
const HOUSES: std::ops::Range<usize> = 11..16;

#[test]
fn a_longer_block_repeats_and_a_shorter_one_drops() {
    let settings = Settings::default();
    let long = placed(&[(0., 0.), (200., 0.), (200., 70.), (0., 70.)], &settings);
    assert!(uses(&long, ROW) >= 14, "{}", uses(&long, ROW));
    assert!(uses(&long, HOUSES) >= 7, "{}", uses(&long, HOUSES));
    let short = placed(&[(0., 0.), (80., 0.), (80., 70.), (0., 70.)], &settings);
    assert!((3..=6).contains(&uses(&short, ROW)), "{}", uses(&short, ROW));
}

#[test]
fn empty_space_goes_before_buildings() {
    // The upper side loses 20 of 120 m; its five houses take 50.
    let settings = Settings::default();
    let shorter = placed(&[(0., 0.), (120., 0.), (110., 70.), (10., 70.)], &settings);
    assert_eq!(uses(&shorter, HOUSES), 5);
}

#[test]
fn sides_whose_ends_stay_keep_their_layout_where_asked() {
    let settings = Settings { local: true, ..Settings::default() };
    let (_, houses) = block();
    // The upper side is drawn out; the lower one stays.
    let drawn = placed(&[(0., 0.), (120., 0.), (150., 90.), (-20., 90.)], &settings);
    for placement in drawn.iter().filter(|p| p.members.iter().any(|m| ROW.contains(m))) {
        let at = houses[placement.members[0]].centroid();
        assert!(placement.motion.apply(at).distance(at) < 0.01, "{:?}", placement.members);
    }
    assert_eq!(uses(&drawn, ROW), 9);
}

/// A block of 100 m by 162 m, tightly packed: two rows of six houses 30 m deep, a house between the rows at
/// both ends, and behind one of these a shed that a corner building stands before, too.
fn packed_block() -> (Vec<GridPoint>, Vec<Polygon>) {
    let outline = ring(&[(0., 0.), (100., 0.), (100., 162.), (0., 162.)]);
    let mut houses = vec![];
    for x in [3.0, 67.0] {
        houses.extend((0..6).map(|k| house(x, 3.0 + 26.0 * f64::from(k), 30.0, 26.0)));
    }
    houses.extend([3.0, 129.0].map(|y| house(33.0, y, 34.0, 30.0)));
    houses.push(house(33.0, 33.0, 12.0, 10.0));
    (outline, houses)
}

/// Figure 5 of the paper: a tightly packed block stays one when it is sheared and drawn out.
#[test]
fn closed_rows_stay_closed() {
    let (old, houses) = packed_block();
    let settings = Settings { cut: 0.35, ..Settings::default() };
    let source = Source::of(&old, houses.clone(), &[], &settings);
    let outline = ring(&[(-30., -10.), (100., 0.), (130., 165.), (0., 162.)]);
    let domain = Polygon::new(outline.clone(), vec![]).expect("has area");
    let link = Correspondence::by_vertices(&old, &outline).expect("vertices stayed");
    let placed = source.retarget(&domain, &outline, &link, &settings);
    let stands: Vec<Polygon> = placed
        .iter()
        .flat_map(|p| p.members.iter().filter_map(|m| p.motion.apply_polygon(&houses[*m])))
        .collect();
    let around = crate::ring::Ring::of(&outline);
    let is_open = |p: &exurb_geom::Vec2| {
        let at_corner = outline.iter().any(|c| c.to_m().distance(*p) < 25.0);
        !at_corner && stands.iter().all(|house| house.boundary_distance_m(*p) > 8.0)
    };
    let kerb = (0..around.length_m() as u32).map(|at| around.point_at(f64::from(at)));
    let open: Vec<exurb_geom::Vec2> = kerb.filter(is_open).collect();
    assert!(open.is_empty(), "nothing stands at {open:?}");
}

/// What stands behind two houses at a corner goes with one of them: each can be laid out without the
/// other.
#[test]
fn what_stands_behind_goes_with_one_house() {
    let (outline, houses) = packed_block();
    let shed = houses.len() - 1;
    let source = Source::of(&outline, houses, &[], &Settings::default());
    let elements = source.groups().groups.iter().flat_map(|g| &g.elements);
    assert!(elements.filter(|e| e.members.contains(&shed)).count() <= 1);
}

/// Figure 1b of the paper: an office floor. Rooms share walls along a corridor.
#[test]
fn a_floor_plan_is_laid_out_anew() {
    let outline = ring(&[(0., 0.), (40., 0.), (40., 14.), (0., 14.)]);
    let mut rooms: Vec<Polygon> = (0..8).map(|k| house(5.0 * f64::from(k), 0., 5., 6.)).collect();
    rooms.extend((0..8).map(|k| house(5.0 * f64::from(k), 8., 5., 6.)));
    let settings = Settings { reach: 7.0, fit_whole: false, ..Settings::default() };
    let source = Source::of(&outline, rooms.clone(), &[], &settings);
    let longer = ring(&[(0., 0.), (60., 0.), (60., 14.), (0., 14.)]);
    let domain = Polygon::new(longer.clone(), vec![]).expect("has area");
    let link = Correspondence::by_vertices(&outline, &longer).expect("vertices stayed");
    let placed = source.retarget(&domain, &longer, &link, &settings);
    let count: usize = placed.iter().map(|p| p.members.len()).sum();
    assert!((22..=24).contains(&count), "{count} rooms");
    let covered: f64 = placed
        .iter()
        .flat_map(|p| p.members.iter().filter_map(|m| p.motion.apply_polygon(&rooms[*m])))
        .map(|room| room.area_m2())
        .sum();
    assert!((covered / (60.0 * 12.0) - 1.0).abs() < 0.1, "{covered}");
}

#[test]
fn an_outline_that_crosses_itself_is_told_and_changes_nothing() {
    use exurb_geom::Vec2;
    use exurb_operation::{Run, Scope, erase};

    let city = crate::test_city::grid(2, 1, Vec2::new(100.0, 70.0), crate::test_city::Style::Rows);
    let b = city.blocks[0].polygon.bounds();
    let bow =
        [[b.min.x, b.min.y], [b.max.x, b.min.y], [b.min.x + 10.0, b.max.y], [b.max.x, b.max.y]];
    let longer = [[b.min.x, b.min.y], [b.max.x, b.min.y], [b.max.x, b.max.y], [b.min.x, b.max.y]];
    let edit = |ring: &[[f64; 2]]| {
        let params =
            serde_json::json!({ "block": city.blocks[0].id, "outline": { "polygon": [ring] } });
        erase::<super::Retarget>().run(&city, &Scope::All, &[], params, &Run::new(1))
    };
    let message = edit(&bow).map(|_| ()).expect_err("it crosses itself").to_string();
    assert!(message.contains("crosses or touches itself"), "{message}");
    edit(&longer).expect("a simple outline");
}
