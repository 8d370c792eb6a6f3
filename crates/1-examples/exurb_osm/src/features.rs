//! Trees, lamps and other single things.

use crate::tags::Tags;

/// Key, value and the kind a feature of that tag has in the city.
const FEATURES: [(&str, &str, &str); 35] = [
    ("natural", "tree", "tree"),
    ("natural", "tree_row", "tree_row"),
    ("natural", "shrub", "shrub"),
    ("natural", "rock", "rock"),
    ("highway", "street_lamp", "lamp"),
    ("highway", "bus_stop", "bus_stop"),
    ("leisure", "playground", "playground"),
    ("leisure", "picnic_table", "picnic_table"),
    ("leisure", "swimming_pool", "swimming_pool"),
    ("leisure", "slipway", "slipway"),
    ("amenity", "post_box", "post_box"),
    ("amenity", "bench", "bench"),
    ("amenity", "fountain", "fountain"),
    ("amenity", "drinking_water", "drinking_water"),
    ("amenity", "waste_basket", "waste_basket"),
    ("amenity", "recycling", "recycling"),
    ("amenity", "telephone", "telephone"),
    ("amenity", "vending_machine", "vending_machine"),
    ("amenity", "bicycle_parking", "bicycle_parking"),
    ("amenity", "clock", "clock"),
    ("barrier", "hedge", "hedge"),
    ("barrier", "fence", "fence"),
    ("barrier", "wall", "wall"),
    ("barrier", "city_wall", "city_wall"),
    ("barrier", "bollard", "bollard"),
    ("man_made", "flagpole", "flagpole"),
    ("man_made", "mast", "mast"),
    ("man_made", "chimney", "chimney"),
    ("man_made", "tower", "tower"),
    ("man_made", "water_tower", "water_tower"),
    ("man_made", "storage_tank", "storage_tank"),
    ("historic", "memorial", "memorial"),
    ("tourism", "artwork", "artwork"),
    ("emergency", "fire_hydrant", "fire_hydrant"),
    ("power", "pole", "power_pole"),
];

/// The kind of feature these tags make.
pub fn kind(tags: &Tags) -> Option<&'static str> {
    tags.iter().find_map(|(key, value)| {
        FEATURES.iter().find(|(k, v, _)| *k == key && *v == value).map(|(.., kind)| *kind)
    })
}

/// Features that are drawn as lines, closed or not.
pub fn is_line(kind: &str) -> bool {
    matches!(kind, "tree_row" | "hedge" | "fence" | "wall" | "city_wall")
}

/// Key and value that make a feature of that kind.
pub fn tag(kind: &str) -> Option<(&'static str, &'static str)> {
    FEATURES.iter().find(|(.., k)| *k == kind).map(|(key, value, _)| (*key, *value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tags;

    #[test]
    fn kinds_and_tags_go_both_ways() {
        for (key, value, kind_) in FEATURES {
            assert_eq!(kind(&Tags::from_iter([(key, value)])), Some(kind_));
            assert_eq!(tag(kind_), Some((key, value)));
            assert!(tags::key(key).is_some(), "{key} is dropped while reading");
        }
    }
}
