//! Streets: classes, lanes, widths, directions.

use exurb_city::{Class, Street, Way};
use exurb_geom::GridPoint;
use rayon::prelude::*;

use crate::elements::{self, Elements};
use crate::places::{Places, Vertex};
use crate::tags::{self, Tags};

/// Streets and the ends where their ways break off at missing nodes.
#[derive(Debug, Default)]
pub struct Streets {
    pub ways: Vec<Way>,
    pub broken_ends: Vec<GridPoint>,
}

/// The class of a street's tags; `None` for squares and what is no street.
pub fn class(tags: &Tags) -> Option<Class> {
    (tags.get("area") != Some("yes")).then(|| Class::parse(tags.get("highway")?)).flatten()
}

/// The streets of a file, in order of way ids; a way is split where a node is missing.
pub fn read(elements: &Elements, places: &Places) -> Streets {
    // In runs of ways, so that few lists are joined.
    let runs: Vec<Streets> = elements
        .ways
        .par_chunks(1024)
        .map(|ways| {
            let mut out = Streets::default();
            for way in ways {
                if let Some(class) = class(&way.tags) {
                    out.add(elements, places, way, class);
                }
            }
            out
        })
        .collect();
    let mut out = Streets::default();
    out.ways.reserve_exact(runs.iter().map(|r| r.ways.len()).sum());
    for mut run in runs {
        out.ways.append(&mut run.ways);
        out.broken_ends.append(&mut run.broken_ends);
    }
    out
}

impl Streets {
    /// Adds the pieces of a way between missing nodes.
    fn add(&mut self, elements: &Elements, places: &Places, way: &elements::Way, class: Class) {
        let vertices: Vec<Option<Vertex>> = places.vertices(elements, way).collect();
        let runs: Vec<&[Option<Vertex>]> = vertices.split(Option::is_none).collect();
        let last = runs.len() - 1;
        for (i, run) in runs.into_iter().enumerate() {
            let mut run: Vec<Vertex> = run.iter().copied().flatten().collect();
            run.dedup_by(|b, a| a.1 == b.1);
            if run.len() < 2 {
                continue;
            }
            if i > 0 {
                self.broken_ends.push(run[0].1);
            }
            if i < last {
                self.broken_ends.push(run[run.len() - 1].1);
            }
            let (street, backwards) = street(&way.tags, class);
            if backwards {
                run.reverse();
            }
            let (nodes, line) = run.into_iter().unzip();
            self.ways.push(Way { id: way.id, line, nodes, street });
        }
    }
}

/// What the tags tell of a street, and whether it is driven against its line.
fn street(tags: &Tags, class: Class) -> (Street, bool) {
    const WIDEST_M: f64 = 100.0;
    let junction = tags.get("junction");
    let implied = junction == Some("roundabout") || class == Class::Motorway;
    let (oneway, backwards) = match tags.get("oneway") {
        Some("yes" | "true" | "1") => (true, false),
        Some("-1" | "reverse") => (true, true),
        Some("no" | "false" | "0") => (false, false),
        _ => (implied, false),
    };
    let width = tags.get("width:carriageway").or(tags.get("width")).and_then(tags::length_m);
    let street = Street {
        class,
        lanes: tags.get("lanes").and_then(|v| tags::whole(v, 0, 24)).unwrap_or(0) as u8,
        width_m: width.filter(|w| (1.0..=WIDEST_M).contains(w)).unwrap_or(0.0),
        oneway,
        bridge: tags.says("bridge"),
        tunnel: tags.says("tunnel"),
        layer: tags.get("layer").and_then(|v| tags::whole(v, -10, 10)).unwrap_or(0) as i8,
        roundabout: matches!(junction, Some("roundabout" | "circular")),
        name: tags.get_shared("name"),
        ..Street::default()
    };
    (street, backwards)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(list: &[(&str, &str)]) -> Option<(Street, bool)> {
        let tags: Tags = list.iter().copied().collect();
        class(&tags).map(|class| street(&tags, class))
    }

    #[test]
    fn squares_paths_and_buildings_are_no_streets() {
        assert!(of(&[("highway", "pedestrian"), ("area", "yes")]).is_none());
        assert!(of(&[("highway", "residential"), ("area", "yes")]).is_none());
        assert!(of(&[("highway", "footway")]).is_none());
        assert!(of(&[("building", "yes")]).is_none());
        assert!(of(&[("highway", "pedestrian"), ("area", "no")]).is_some());
    }

    #[test]
    fn directions_are_given_implied_or_turned() {
        let direction = |list: &[(&str, &str)]| {
            let (street, backwards) = of(list).expect("a street");
            (street.oneway, backwards)
        };
        let residential = ("highway", "residential");
        for yes in ["yes", "true", "1"] {
            assert_eq!(direction(&[residential, ("oneway", yes)]), (true, false));
        }
        assert_eq!(direction(&[residential, ("oneway", "-1")]), (true, true));
        assert_eq!(direction(&[residential]), (false, false));
        assert_eq!(direction(&[residential, ("junction", "roundabout")]), (true, false));
        assert_eq!(direction(&[residential, ("junction", "circular")]), (false, false));
        assert_eq!(direction(&[("highway", "motorway")]), (true, false));
        assert_eq!(direction(&[("highway", "motorway"), ("oneway", "no")]), (false, false));
        assert_eq!(direction(&[("highway", "motorway_link")]), (false, false));
    }

    #[test]
    fn measures_and_levels() {
        let street = |list: &[(&str, &str)]| {
            let mut all = vec![("highway", "primary")];
            all.extend(list);
            of(&all).expect("a street").0
        };
        assert_eq!(street(&[("lanes", "3")]).lanes, 3);
        assert_eq!(street(&[("lanes", "two")]).lanes, 0);
        assert_eq!(street(&[("lanes", "-2")]).lanes, 0);
        assert_eq!(street(&[("width", "7 m")]).width_m, 7.0);
        assert!((street(&[("width", "23'")]).width_m - 7.0104).abs() < 1e-9);
        assert_eq!(street(&[("width", "0")]).width_m, 0.0);
        assert_eq!(street(&[("width", "900")]).width_m, 0.0);
        assert_eq!(street(&[("layer", "-99")]).layer, -10);
        assert_eq!(street(&[("layer", "0;1")]).layer, 0);
        assert!(street(&[("bridge", "viaduct")]).bridge);
        assert!(!street(&[("bridge", "no")]).bridge);
        assert!(street(&[("tunnel", "building_passage")]).tunnel);
        assert!(street(&[("junction", "circular")]).roundabout);
        assert_eq!(street(&[("name", "Rue \"<é>\"")]).name.as_deref(), Some("Rue \"<é>\""));
    }
}
