//! Where streets grow: a part of a city, around given streets, on hills and along water.

use std::sync::Arc;

use exurb_city::street_graph::{self, shares_by_origin};
use exurb_city::{City, Class, Street};
use exurb_geom::{Frame, GridPoint, Polygon, Vec2, trig};
use exurb_operation::{Example, Run, Scope, erase};

use super::super::Grow;
use super::{assert_lawful, city_of, grid, params, square};

/// Streets of the city that lie outside `area`, as lines, in order.
fn outside(city: &City, area: &Polygon) -> Vec<(Vec<GridPoint>, Street)> {
    let edges = city.streets.edges().map(|(_, e)| (e.line().to_vec(), e.data.clone()));
    let is_outside = |line: &[GridPoint]| {
        line.iter().all(|p| !area.contains(*p) && area.boundary_distance_m(p.to_m()) > 0.01)
    };
    let mut kept: Vec<_> = edges.filter(|(line, _)| is_outside(line)).collect();
    kept.sort_by(|a, b| a.0.cmp(&b.0));
    kept
}

#[test]
fn a_part_grown_anew_leaves_the_rest_as_it_is_and_joins_it() {
    let city = grid(16);
    // Obliquely across the blocks, so that most of its border meets streets anywhere.
    let corners = [(310.0, 420.0), (1130.0, 290.0), (1270.0, 1080.0), (440.0, 1210.0)];
    let ring = corners.map(|(x, y)| GridPoint::m(x, y)).to_vec();
    let area = Polygon::new(ring, vec![]).expect("has area");
    let mut example = grid(12);
    example.metadata.name = "other".into();
    let examples = [Example::new(example)];
    for seed in 1..4 {
        let document = serde_json::json!({ "rotate": 20.0 * seed as f64 });
        let outcome = erase::<Grow>()
            .run(&city, &Scope::Inside(area.clone()), &examples, document, &Run::new(seed))
            .expect("grows");
        let new = outcome.city;
        assert_lawful(&new);
        assert_eq!(outside(&city, &area), outside(&new, &area));
        let (copied, ..) = shares_by_origin(&new.streets);
        assert!(copied > 0.15, "{copied}");
        let border =
            new.streets.nodes().filter(|(_, n)| area.boundary_distance_m(n.at.to_m()) < 0.01);
        let degrees: Vec<usize> = border.map(|(id, _)| new.streets.degree(id)).collect();
        let joined = degrees.iter().filter(|d| **d > 1).count();
        assert!(joined * 2 > degrees.len(), "{joined} of {}", degrees.len());
    }
}

#[test]
fn no_street_lies_along_the_border_of_a_part_grown_anew() {
    // The border lies as the example's streets do, and cuts the city's streets slantwise.
    let turned = |p: &Vec2| trig::unit(0.14).rotate(*p);
    let lines = grid(16);
    let lines = lines.streets.edges().map(|(_, e)| {
        let line: Vec<Vec2> = e.line_m().iter().map(turned).collect();
        (exurb_geom::polyline::round(&line), e.data.clone())
    });
    let city = city_of(street_graph::from_lines(lines));
    let middle = city.target.bounds().center();
    let examples = [Example::new(grid(12))];
    for seed in 1..9 {
        let area = square(middle, 600.0 + 40.0 * seed as f64);
        let outcome = erase::<Grow>()
            .run(&city, &Scope::Inside(area.clone()), &examples, params(0.5), &Run::new(seed))
            .expect("grows");
        assert_lawful(&outcome.city);
        for (_, edge) in outcome.city.streets.edges() {
            let points = exurb_geom::polyline::resample(&edge.line_m(), 5.0);
            assert!(points.iter().any(|p| area.boundary_distance_m(*p) > 0.5), "seed {seed}");
        }
    }
}

#[test]
fn given_streets_stay_and_are_joined() {
    let sketched = |class| Street {
        class,
        provenance: exurb_city::Provenance::of(exurb_city::Origin::Sketch),
        ..Street::default()
    };
    let line = |points: &[(f64, f64)]| points.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect();
    let given: Vec<(Vec<GridPoint>, Street)> = vec![
        (line(&[(100.0, 200.0), (700.0, 500.0), (1100.0, 1000.0)]), sketched(Class::Primary)),
        (line(&[(200.0, 1000.0), (500.0, 900.0)]), sketched(Class::Residential)),
    ];
    let example = grid(16);
    let mut empty = City::empty(example.frame.clone(), square(Vec2::splat(600.0), 1200.0));
    empty.streets = Arc::new(street_graph::from_lines(given.clone()));
    let city = erase::<Grow>()
        .run(&empty, &Scope::All, &[Example::new(example)], params(0.5), &Run::new(1))
        .expect("grows")
        .city;
    assert_lawful(&city);
    for (line, street) in given {
        let kept = city.streets.edges().filter(|(_, e)| {
            e.data.provenance.origin == exurb_city::Origin::Sketch && e.data.class == street.class
        });
        let length: f64 = kept.map(|(_, e)| e.length_m()).sum();
        let wanted =
            exurb_geom::polyline::length(&line.iter().map(|p| p.to_m()).collect::<Vec<_>>());
        assert!((length - wanted).abs() < 0.1, "{length} of {wanted} m");
        let along = city.streets.nodes().filter(|(id, n)| {
            let line: Vec<Vec2> = line.iter().map(|p| p.to_m()).collect();
            city.streets.degree(*id) > 2
                && exurb_geom::polyline::distance(&line, n.at.to_m()) < 0.01
        });
        assert!(along.count() > 1, "nothing joins a given street");
    }
}

/// An empty city with a river from south to north, 90 m wide, and hills in the east.
fn riverside(side_m: f64) -> City {
    let mut city = City::empty(Frame::null_island(), square(Vec2::splat(side_m / 2.0), side_m));
    let river = Polygon::rectangle(
        GridPoint::m(0.4 * side_m, -400.0),
        GridPoint::m(0.4 * side_m + 90.0, side_m + 400.0),
    );
    city.water = Arc::new(vec![exurb_city::Area { id: 1, polygon: river, class: "river".into() }]);
    let bounds = city.target.bounds().grown(400.0);
    // A ridge of 70 m, its flanks rising by a quarter.
    let height = |p: Vec2| (70.0 - (p.x - 0.8 * side_m).abs() * 0.25).max(0.0) as f32;
    city.lay(exurb_city::Terrain::over(bounds, 10.0, height).expect("small"));
    city
}

#[test]
fn streets_keep_out_of_water_and_off_steep_ground_and_cross_on_bridges() {
    let city = riverside(1800.0);
    let land = exurb_city::Land::of(&city);
    for seed in 1..3 {
        let document = serde_json::json!({ "grade": 0.15, "continuation": 0.4 });
        let grown = erase::<Grow>()
            .run(&city, &Scope::All, &[Example::new(grid(20))], document, &Run::new(seed))
            .expect("grows")
            .city;
        assert_lawful(&grown);
        let (mut bridges, mut banks) = (0, [0.0, 0.0]);
        for (_, edge) in grown.streets.edges() {
            let line = edge.line_m();
            if edge.data.bridge {
                assert_eq!(edge.data.provenance.origin, exurb_city::Origin::Bridge);
                assert_eq!(edge.data.layer, 1);
                bridges += 1;
                continue;
            }
            let places = exurb_geom::polyline::resample(&line, 5.0);
            assert!(places.iter().all(|p| !land.is_wet(*p)), "a street in water");
            banks[usize::from(line[0].x > 760.0)] += edge.length_m();
            let inside = |p: &Vec2| city.target.contains(GridPoint::round(*p));
            for w in places.windows(8).filter(|w| w.iter().all(inside)) {
                let rise = (land.height_m(w[7]) - land.height_m(w[0])).abs();
                assert!(rise <= 0.19 * 35.0, "rises by {rise} m over 35 m");
            }
        }
        assert!(bridges >= 1, "no bridge");
        assert!(banks.iter().all(|m| *m > 3000.0), "{banks:?}");
        let deck = grown.streets.nodes().filter(|(_, n)| (700.0..830.0).contains(&n.at.to_m().x));
        assert!(deck.count() >= 2);
    }
}

#[test]
fn a_target_in_the_sea_and_a_start_in_water_are_refused() {
    let mut city = riverside(1000.0);
    let wet = serde_json::json!({ "start": ["0.0039,0.004"] });
    let run = |city: &City, document| {
        let examples = [Example::new(grid(12))];
        erase::<Grow>().run(city, &Scope::All, &examples, document, &Run::new(1))
    };
    let error = run(&city, wet).unwrap_err().to_string();
    assert!(error.contains("lies in water"), "{error}");
    let sea = exurb_city::Area {
        id: 1,
        polygon: square(Vec2::splat(500.0), 3000.0),
        class: "sea".into(),
    };
    city.water = Arc::new(vec![sea]);
    let error = run(&city, serde_json::json!({})).unwrap_err().to_string();
    assert!(error.contains("the whole target lies in water"), "{error}");
}
