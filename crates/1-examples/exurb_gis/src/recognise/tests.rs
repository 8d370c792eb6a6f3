use std::borrow::Cow;

use exurb_city::{Class, Street};

use super::{Attributes, Kind, recognise};
use crate::geometry::Geometry;
use crate::value::Value;

fn row(columns: &[(&'static str, &'static str)]) -> Attributes<'static> {
    Attributes::new(columns.iter().map(|(k, v)| (Cow::Borrowed(*k), Value::from(*v))))
}

fn line(columns: &[(&'static str, &'static str)], hint: &str) -> Option<Street> {
    match recognise(&Geometry::Line(vec![]), &row(columns), hint) {
        Some(Kind::Street { street, .. }) => Some(street),
        _ => None,
    }
}

fn area(columns: &[(&'static str, &'static str)], hint: &str) -> Option<Kind> {
    recognise(&Geometry::Polygon(vec![]), &row(columns), hint)
}

#[test]
fn untagged_lines_are_residential_streets_and_rivers_are_none() {
    assert_eq!(line(&[], "anything").map(|s| s.class), Some(Class::Residential));
    assert_eq!(line(&[], "rivers"), None);
    assert_eq!(line(&[("waterway", "river")], "lines"), None);
    assert_eq!(line(&[("highway", "footway")], "streets"), None);
    assert_eq!(line(&[("fclass", "primary")], "gis_roads").map(|s| s.class), Some(Class::Primary));
}

#[test]
fn roads_of_a_national_map() {
    let road = [("NATURE", "Route à 2 chaussées"), ("IMPORTANCE", "2"), ("LARGEUR", "7,5")];
    let road = line(&road, "roads").expect("a street");
    assert_eq!((road.class, road.width_m), (Class::Secondary, 7.5));
    assert_eq!(line(&[("NATURE", "Sentier")], "roads"), None);
}

#[test]
fn polygons_by_columns_first_and_names_second() {
    assert!(matches!(area(&[("building", "yes")], "parcels"), Some(Kind::Building(_))));
    assert!(
        matches!(area(&[("HAUTEUR", "7")], "layer"), Some(Kind::Building(w)) if w.height_m == Some(7.0))
    );
    assert_eq!(area(&[], "cz_plots"), Some(Kind::Parcel(None)));
    assert_eq!(area(&[("zoning", "R1")], "layer"), Some(Kind::Parcel(Some("r1".into()))));
    assert_eq!(
        area(&[("TYPEZONE", "N")], "town_zoning"),
        Some(Kind::LandUse("nature_reserve".into()))
    );
    assert_eq!(area(&[("natural", "water")], "x"), Some(Kind::Water("water".into())));
    assert_eq!(area(&[], "layer"), None);
    assert_eq!(area(&[], "tessellation"), None);
    assert!(matches!(area(&[("building", "house")], "blocks"), Some(Kind::Building(_))));
}

/// Columns of which some are there and unknown.
fn partly_known(columns: &[(&'static str, Option<&'static str>)]) -> Attributes<'static> {
    let value = |v: Option<&'static str>| v.map_or(Value::Null, Value::from);
    Attributes::new(columns.iter().map(|(k, v)| (Cow::Borrowed(*k), value(*v))))
}

#[test]
fn a_line_without_a_highway_is_no_street_where_others_have_one() {
    // What GDAL makes of an OpenStreetMap file: every kind of line in one layer.
    let rail = partly_known(&[("highway", None), ("other_tags", Some(r#""railway"=>"rail""#))]);
    assert_eq!(recognise(&Geometry::Line(vec![]), &rail, "lines"), None);
    let wall = partly_known(&[("highway", None), ("lanes", None)]);
    assert_eq!(recognise(&Geometry::Line(vec![]), &wall, "edges"), None);
    // A column that nobody filled says nothing.
    let classed = partly_known(&[("highway", None), ("fclass", Some("primary"))]);
    assert!(recognise(&Geometry::Line(vec![]), &classed, "roads").is_some());
    assert_eq!(line(&[("man_made", "pipeline")], "lines"), None);
}

#[test]
fn streets_that_osmnx_joined_are_streets_of_their_first_class() {
    let joined = [("highway", "['steps', 'tertiary', 'residential']"), ("lanes", "['2', '3']")];
    let joined = line(&joined, "edges").expect("a street");
    assert_eq!((joined.class, joined.lanes), (Class::Tertiary, 2));
    assert_eq!(line(&[("highway", "['steps', 'footway']")], "edges"), None);
}
