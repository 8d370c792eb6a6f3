//! Buildings and their parts.

use std::sync::Arc;

use exurb_city::{Building, Origin, Provenance, Roof};
use exurb_geom::Polygon;

use crate::tags::{self, Tags};

/// Do these tags make a building or a part of one?
pub fn is_building(tags: &Tags) -> bool {
    tags.says("building") || tags.says("building:part")
}

/// A building of that outline.
pub fn building(tags: &Tags, polygon: Polygon) -> Building {
    const TALLEST_M: f64 = 1000.0;
    const MOST_LEVELS: f64 = 200.0;
    const LEVEL_M: f64 = 3.0;
    let metres = |key| tags.get(key).and_then(tags::length_m).filter(|m| *m <= TALLEST_M);
    let levels = |key| tags.get(key).and_then(tags::number).filter(|n| *n <= MOST_LEVELS);
    let mut out = Building::new(0, polygon, Provenance::of(Origin::Imported));
    out.height_m = metres("height").filter(|m| *m > 0.0);
    out.levels = levels("building:levels").filter(|n| *n > 0.0);
    let lifted = levels("building:min_level").map(|n| n * LEVEL_M);
    out.min_height_m = metres("min_height").or(lifted).unwrap_or(0.0);
    out.roof = tags.get("roof:shape").and_then(Roof::parse);
    out.is_part = !tags.says("building");
    out.usage = usage(tags);
    out
}

/// The value of `building`; of `shop`, `amenity` or `office` where that only says yes.
fn usage(tags: &Tags) -> Option<Arc<str>> {
    let given = |key| tags.get_shared(key).filter(|v| !matches!(&**v, "yes" | "no"));
    ["building", "building:part", "shop", "amenity", "office"].into_iter().find_map(given)
}

#[cfg(test)]
mod tests {
    use super::*;
    use exurb_geom::GridPoint;

    fn of(list: &[(&str, &str)]) -> Building {
        let square = Polygon::rectangle(GridPoint::m(0.0, 0.0), GridPoint::m(9.0, 9.0));
        building(&list.iter().copied().collect(), square)
    }

    #[test]
    fn heights_levels_and_roofs() {
        let b = of(&[
            ("building", "house"),
            ("height", "40'"),
            ("building:levels", "3.5"),
            ("roof:shape", "half-hipped"),
        ]);
        assert!((b.height_m.expect("given") - 12.192).abs() < 1e-9);
        assert_eq!((b.levels, b.roof), (Some(3.5), Some(Roof::HalfHipped)));
        let odd = of(&[("height", "tall"), ("building:levels", "-1"), ("roof:shape", "odd")]);
        assert_eq!((odd.height_m, odd.levels, odd.roof), (None, None, None));
        assert_eq!(of(&[("height", "0")]).height_m, None);
        assert_eq!(of(&[("height", "99999")]).height_m, None);
    }

    #[test]
    fn parts_begin_at_their_height_or_level() {
        assert_eq!(of(&[("building:part", "yes"), ("min_height", "6 m")]).min_height_m, 6.0);
        assert_eq!(of(&[("building:part", "yes"), ("building:min_level", "2")]).min_height_m, 6.0);
        assert!(of(&[("building:part", "yes")]).is_part);
        assert!(!of(&[("building", "yes"), ("building:part", "yes")]).is_part);
        assert!(!is_building(&Tags::from_iter([("building", "no")])));
    }

    #[test]
    fn the_use_is_looked_for_where_the_building_only_says_yes() {
        let usage = |list| of(list).usage.as_deref().map(str::to_owned);
        assert_eq!(
            usage(&[("building", "church"), ("amenity", "cafe")]).as_deref(),
            Some("church")
        );
        assert_eq!(usage(&[("building", "yes"), ("amenity", "cafe")]).as_deref(), Some("cafe"));
        assert_eq!(usage(&[("building", "yes"), ("shop", "yes")]), None);
        assert_eq!(usage(&[("building", "yes"), ("office", "it")]).as_deref(), Some("it"));
    }
}
