//! What a block of an example is for.

use std::sync::Arc;

use super::Layout;

/// Share of a block's footprints that one use must take to make the block one of its kind.
const MOST: f64 = 0.5;

/// The class of its open land; `empty` where nothing stands; `civic`, `retail` or `industrial` where
/// such buildings take more than half of what is built, or the land use says so; `None` for an ordinary
/// block.
pub fn kind_of(layout: &Layout) -> Option<Arc<str>> {
    if layout.open.is_some() {
        return layout.open.clone();
    }
    if layout.footprints.is_empty() {
        return Some("empty".into());
    }
    let built = layout.built_m2();
    let group = |name: &str| {
        let of_group = layout.footprints.iter().filter(|f| {
            f.building.usage.as_deref().is_some_and(|usage| group_of(usage) == Some(name))
        });
        of_group.map(|f| f.building.polygon.area_m2()).sum::<f64>() > MOST * built
    };
    let by_use = ["civic", "retail", "industrial"].into_iter().find(|name| group(name));
    by_use.or_else(|| group_of(layout.land_use.as_deref()?)).map(Arc::from)
}

/// Is such a building one of its kind, not to be repeated in its block?
pub fn is_civic(usage: Option<&str>) -> bool {
    usage.and_then(group_of) == Some("civic")
}

/// The group of a building's or an area's use, in OSM's words.
fn group_of(usage: &str) -> Option<&'static str> {
    match usage {
        "school" | "university" | "college" | "kindergarten" | "hospital" | "clinic" | "church"
        | "chapel" | "cathedral" | "mosque" | "synagogue" | "temple" | "religious"
        | "place_of_worship" | "public" | "civic" | "government" | "townhall" | "stadium"
        | "grandstand" | "sports_hall" | "sports_centre" | "theatre" | "museum" | "library"
        | "train_station" | "fire_station" | "education" | "institutional" | "military"
        | "prison" => Some("civic"),
        "retail" | "supermarket" | "mall" | "department_store" | "shop" => Some("retail"),
        "industrial" | "warehouse" | "factory" | "manufacture" | "hangar" | "railway" | "port" => {
            Some("industrial")
        }
        _ => None,
    }
}
