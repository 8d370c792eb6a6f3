//! Buildings, water, land use, parcels and features: everything with tags that is no street.

use std::sync::Arc;

use exurb_city::{Area, Building, Draft, Feature, FeatureShape, Origin, Parcel, Provenance};
use exurb_geom::{BoxGrid, GridPoint, Polygon, Vec2, offset};
use rayon::prelude::*;

use crate::elements::{Elements, Way};
use crate::outline::{self, Repairs};
use crate::places::{self, Places, Vertex};
use crate::tags::Tags;
use crate::{areas, buildings, coast, features};

/// What a way or relation is, by its tags.
#[derive(Clone, Debug, PartialEq)]
enum Kind {
    Building,
    Water(Arc<str>),
    LandUse(Arc<str>),
    Parcel,
    Feature(&'static str),
    /// The area of a city that this program made.
    Target,
}

fn kind(tags: &Tags) -> Option<Kind> {
    if tags.says(TARGET) {
        return Some(Kind::Target);
    }
    if buildings::is_building(tags) {
        return Some(Kind::Building);
    }
    let feature = || features::kind(tags).map(Kind::Feature);
    areas::water(tags)
        .map(|class| Kind::Water(class.into()))
        .or_else(feature)
        .or_else(|| areas::is_parcel(tags).then_some(Kind::Parcel))
        .or_else(|| areas::land_use(tags).map(|class| Kind::LandUse(class.into())))
}

/// Key of the outline of a city's target in files of our own.
pub const TARGET: &str = "exurb:target";

/// Do these tags make something other than a street?
pub fn matters(tags: &Tags) -> bool {
    !tags.is_empty()
        && (kind(tags).is_some() || areas::is_waterway(tags) || areas::is_coastline(tags))
}

/// Something read, on its way to its layer.
enum Found {
    Building(Building),
    Water(Area),
    LandUse(Area),
    Parcel(Parcel),
    Feature(Feature),
    Target(Polygon),
}

/// What became of the outlines, by layer.
#[derive(Default)]
struct Counts {
    buildings: Repairs,
    others: Repairs,
}

/// Ways handled at a time.
const PART: usize = 1 << 15;

/// Reads all layers but streets into the draft.
pub fn read(elements: &Elements, places: &Places, draft: &mut Draft, warnings: &mut Vec<String>) {
    let (relations, outer) = relations(elements);
    let mut counts = Counts::default();
    let mut take = |all: Vec<(bool, Vec<Found>, Repairs)>, draft: &mut Draft| {
        for (is_building, found, repairs) in all {
            (if is_building { &mut counts.buildings } else { &mut counts.others }).add(repairs);
            found.into_iter().for_each(|found| put(found, draft));
        }
    };
    // A part at a time, so that what is on its way stays small.
    for (part, ways) in elements.ways.chunks(PART).enumerate() {
        let of_ways = ways.par_iter().enumerate().filter_map(|(i, way)| {
            let is_spent = outer.binary_search(&(part * PART + i)).is_ok();
            let kind = if way.tags.is_empty() || is_spent { None } else { kind(&way.tags) };
            Some(from_way(elements, places, way, &kind?))
        });
        take(of_ways.collect(), draft);
    }
    let of_relations = relations.par_iter().map(|(kind, tags, ways)| {
        let mut repairs = Repairs::default();
        let polygons = outline::of_ways(elements, places, ways, &mut repairs);
        (*kind == Kind::Building, found(kind, tags, polygons), repairs)
    });
    take(of_relations.collect(), draft);
    waterways(elements, places, draft);
    coast(elements, places, draft, warnings);
    for (id, tags) in &elements.tagged {
        let at = places::search(&elements.nodes, *id, 0)
            .and_then(|i| places::project(&draft.frame, &elements.nodes[i]));
        if let (Some(at), Some(kind)) = (at, features::kind(tags)) {
            draft.features.push(feature(kind, FeatureShape::Point(at)));
        }
    }
    warnings.extend(counts.buildings.warning("buildings"));
    warnings.extend(counts.others.warning("areas"));
}

/// Rivers, canals and streams drawn as lines become areas of their width, but where most of their
/// vertices lie in water already.
fn waterways(elements: &Elements, places: &Places, draft: &mut Draft) {
    let boxes = BoxGrid::of(draft.water.iter().map(|a| &a.polygon));
    let is_wet = |p: &Vec2| {
        let (at, mut near) = (GridPoint::round(*p), Vec::new());
        boxes.meeting(at, at, &mut near);
        near.iter().any(|i| draft.water[*i as usize].polygon.contains(at))
    };
    let lines = elements.ways.par_iter().filter(|w| areas::is_waterway(&w.tags));
    let areas = lines.flat_map_iter(|way| {
        let width_m = areas::waterway_width_m(&way.tags).unwrap_or_default();
        let class: Arc<str> = way.tags.get("waterway").unwrap_or_default().into();
        let vertices: Vec<Option<Vertex>> = places.vertices(elements, way).collect();
        let runs = vertices.split(Option::is_none).map(|run| {
            let mut points: Vec<GridPoint> = run.iter().flatten().map(|(_, p)| *p).collect();
            points.dedup();
            exurb_geom::polyline::to_m(&points)
        });
        let dry = runs.filter(|run| {
            run.len() > 1 && 2 * run.iter().filter(|p| is_wet(p)).count() <= run.len()
        });
        let polygons =
            dry.flat_map(|run| offset::carriageway(&run, width_m / 2.0, offset::Cap::Round));
        let area = |polygon| Area { id: 0, polygon, class: class.clone() };
        polygons.map(area).collect::<Vec<_>>()
    });
    let areas: Vec<Area> = areas.collect();
    draft.water.extend(areas);
}

/// The sea behind the coastline.
fn coast(elements: &Elements, places: &Places, draft: &mut Draft, warnings: &mut Vec<String>) {
    let mut lines: Vec<Vec<Vertex>> = Vec::new();
    for way in elements.ways.iter().filter(|w| areas::is_coastline(&w.tags)) {
        let vertices: Vec<Option<Vertex>> = places.vertices(elements, way).collect();
        lines.extend(
            vertices.split(Option::is_none).map(|run| run.iter().copied().flatten().collect()),
        );
    }
    let Some(map) = draft.area().filter(|_| !lines.is_empty()) else { return };
    let sea = coast::close(lines, &map);
    if sea.dropped > 0 {
        let n = sea.dropped;
        warnings.push(format!("{n} pieces of coastline end inside the map; their sea is left out"));
    }
    let area = |polygon| Area { id: 0, polygon, class: "sea".into() };
    draft.water.extend(sea.polygons.into_iter().map(area));
}

fn put(found: Found, draft: &mut Draft) {
    match found {
        Found::Building(building) => draft.buildings.push(building),
        Found::Water(area) => draft.water.push(area),
        Found::LandUse(area) => draft.land_use.push(area),
        Found::Parcel(parcel) => draft.parcels.push(parcel),
        Found::Feature(feature) => draft.features.push(feature),
        Found::Target(polygon) => {
            draft.extent = Some(polygon);
            draft.runs_past = true;
        }
    }
}

/// The relations that are something, with kind, tags and member ways; and, sorted, the indices of
/// ways that are spent on them. Where a relation's own tags are silent, those of its only tagged
/// member that is something speak (the old style).
#[allow(clippy::type_complexity, reason = "two lists that are taken apart at once")]
fn relations(elements: &Elements) -> (Vec<(Kind, &Tags, Vec<&Way>)>, Vec<usize>) {
    let mut out = Vec::new();
    let mut spent = Vec::new();
    for relation in &elements.relations {
        let members: Vec<usize> =
            relation.ways.iter().filter_map(|id| elements.way_index(*id)).collect();
        let ways: Vec<&Way> = members.iter().map(|i| &elements.ways[*i]).collect();
        if let Some(kind) = kind(&relation.tags) {
            // Outer ways often repeat the relation's tags; they are the same thing.
            spent.extend(members.iter().zip(&ways).filter_map(|(i, way)| {
                (relation.outer.contains(&way.id) && self::kind(&way.tags) == Some(kind.clone()))
                    .then_some(*i)
            }));
            out.push((kind, &relation.tags, ways));
        } else if relation.tags.get("type") == Some("multipolygon") {
            let mut tagged =
                members.iter().zip(&ways).filter_map(|(i, w)| Some((*i, kind(&w.tags)?, &w.tags)));
            if let (Some((i, kind, tags)), None) = (tagged.next(), tagged.next()) {
                spent.push(i);
                out.push((kind, tags, ways));
            }
        }
    }
    spent.sort_unstable();
    (out, spent)
}

fn from_way(
    elements: &Elements,
    places: &Places,
    way: &Way,
    kind: &Kind,
) -> (bool, Vec<Found>, Repairs) {
    let mut repairs = Repairs::default();
    let is_building = *kind == Kind::Building;
    if let Kind::Feature(word) = kind
        && (features::is_line(word) || !outline::is_closed(elements, way))
    {
        let mut line: Vec<GridPoint> =
            places.vertices(elements, way).flatten().map(|(_, p)| p).collect();
        line.dedup();
        let found = (line.len() > 1 && features::is_line(word))
            .then(|| Found::Feature(feature(word, FeatureShape::Line(line))));
        return (false, found.into_iter().collect(), repairs);
    }
    if !outline::is_closed(elements, way) {
        repairs.dropped += 1;
        return (is_building, Vec::new(), repairs);
    }
    let polygons = outline::of_way(elements, places, way, !is_building, &mut repairs);
    (is_building, found(kind, &way.tags, polygons), repairs)
}

fn found(kind: &Kind, tags: &Tags, polygons: Vec<Polygon>) -> Vec<Found> {
    let area = |polygon, class: &Arc<str>| Area { id: 0, polygon, class: class.clone() };
    polygons
        .into_iter()
        .map(|polygon| match kind {
            Kind::Building => Found::Building(buildings::building(tags, polygon)),
            Kind::Water(class) => Found::Water(area(polygon, class)),
            Kind::LandUse(class) => Found::LandUse(area(polygon, class)),
            Kind::Parcel => Found::Parcel(areas::parcel(tags, polygon)),
            Kind::Feature(word) => Found::Feature(feature(word, FeatureShape::Polygon(polygon))),
            Kind::Target => Found::Target(polygon),
        })
        .collect()
}

fn feature(kind: &'static str, shape: FeatureShape) -> Feature {
    Feature {
        id: 0,
        kind: kind.into(),
        shape,
        block: 0,
        provenance: Provenance::of(Origin::Imported),
    }
}
