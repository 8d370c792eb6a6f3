//! A city as OSM elements, the same for XML and PBF.
//!
//! Ids count from 1, nodes, ways and relations each on their own, in the order of the city's layers:
//! equal cities give equal files. Streets share nodes where the street graph does; other ways join
//! them where they pass the same point on the same level; outlines share corners. Ends of streets
//! that run on outside the city say so as mappers do (`fixme=continue`); the target is an outline of
//! its own, last, because streets run past it and bounds are but a box inside.

use std::borrow::Cow;
use std::collections::BTreeMap;

use exurb_city::{City, FeatureShape, Street, StreetGraph, Way};
use exurb_geom::{GridPoint, Polygon};

use crate::{areas, features, narrow, shared_walls, surfaces};

/// Key and value.
pub type Tag = (&'static str, String);

/// A node in 1e-7 degrees; its id is its place in the list, from 1.
#[derive(Clone, Debug, PartialEq)]
pub struct OutNode {
    pub lon: i32,
    pub lat: i32,
    pub tags: Vec<Tag>,
}

/// A way; its id is its place in the list, from 1.
#[derive(Clone, Debug, PartialEq)]
pub struct OutWay {
    pub nodes: Vec<i64>,
    pub tags: Vec<Tag>,
}

/// A multipolygon; its id is its place in the list, from 1.
#[derive(Clone, Debug, PartialEq)]
pub struct OutRelation {
    /// Way and whether it is an inner ring.
    pub members: Vec<(i64, bool)>,
    pub tags: Vec<Tag>,
}

/// All elements of a city.
pub struct Document<'a> {
    city: &'a City,
    /// West, south, east, north in 1e-7 degrees.
    pub bounds: Option<[i32; 4]>,
    pub attribution: String,
    pub nodes: Vec<OutNode>,
    pub ways: Vec<OutWay>,
    pub relations: Vec<OutRelation>,
}

impl<'a> Document<'a> {
    /// The elements of `city`. Blocks and parcels have no place in OSM. O(n log n).
    pub fn new(city: &'a City) -> Self {
        let bounds = city.lonlat_bbox().map(|[sw, ne]| [sw.lon, sw.lat, ne.lon, ne.lat].map(fixed));
        let attribution = city.metadata.attribution.join("; ");
        let (nodes, ways, relations) = Default::default();
        let mut out = Self { city, bounds, attribution, nodes, ways, relations };
        let mut at = out.streets(&city.streets);
        for way in city.other_ways.iter() {
            out.other_way(way, &mut at);
        }
        let mut corners = BTreeMap::new();
        let outlines = city.buildings.iter().map(|b| {
            narrow::mended(&b.polygon, &city.frame).map_or(Cow::Borrowed(&b.polygon), Cow::Owned)
        });
        let outlines: Vec<Cow<Polygon>> = outlines.collect();
        let outlines: Vec<&Polygon> = outlines.iter().map(|polygon| &**polygon).collect();
        let shared = shared_walls::rings(&outlines);
        for ((building, outline), rings) in city.buildings.iter().zip(&outlines).zip(shared) {
            let tags = building_tags(building);
            if narrow::are_valid(&rings, &city.frame) {
                out.rings(&rings, tags, &mut corners);
            } else {
                out.polygon(outline, tags, &mut corners);
            }
        }
        for area in city.water.iter() {
            let mut tags = vec![("natural", "water".to_owned())];
            if &*area.class != "water" {
                tags.push(("water", area.class.to_string()));
            }
            out.polygon(&area.polygon, tags, &mut corners);
        }
        for area in city.land_use.iter() {
            let (key, value) = areas::land_use_tag(&area.class);
            out.polygon(&area.polygon, vec![(key, value.to_owned())], &mut corners);
        }
        for feature in city.features.iter() {
            let (key, value) = features::tag(&feature.kind).unwrap_or(("man_made", &feature.kind));
            let tags = vec![(key, value.to_owned())];
            match &feature.shape {
                FeatureShape::Point(p) => {
                    out.node(*p, tags);
                }
                FeatureShape::Line(line) => {
                    let nodes = line.iter().map(|p| out.node(*p, Vec::new())).collect();
                    out.way(nodes, tags);
                }
                FeatureShape::Polygon(polygon) => out.polygon(polygon, tags, &mut corners),
            }
        }
        let tags = vec![(surfaces::TARGET, "yes".to_owned())];
        out.polygon(&city.target, tags, &mut BTreeMap::new());
        out
    }

    /// Writes the street graph; returns the nodes by place and level.
    fn streets(&mut self, graph: &StreetGraph) -> BTreeMap<(GridPoint, i32), i64> {
        let mut junctions = vec![0; graph.node_bound()];
        for (id, node) in graph.nodes() {
            let mut tags = Vec::new();
            if node.data.cut {
                tags.push(("fixme", "continue".to_owned()));
            }
            // On flat ground nobody needs to be told the height.
            if self.city.terrain.is_some() {
                tags.push(("ele", format!("{:.1}", node.data.z_m)));
            }
            junctions[id.index()] = self.node(node.at, tags);
        }
        let mut at = BTreeMap::new();
        for (_, edge) in graph.edges() {
            let line = edge.line();
            let level = edge.data.crossing_level();
            let mut nodes = vec![junctions[edge.from.index()]];
            nodes.extend(line[1..line.len() - 1].iter().map(|p| self.node(*p, Vec::new())));
            nodes.push(junctions[edge.to.index()]);
            for (p, node) in line.iter().zip(&nodes) {
                at.entry((*p, level)).or_insert(*node);
            }
            self.way(nodes, street_tags(&edge.data));
        }
        at
    }

    fn other_way(&mut self, way: &Way, at: &mut BTreeMap<(GridPoint, i32), i64>) {
        let level = way.street.crossing_level();
        let mut nodes = Vec::with_capacity(way.line.len());
        for p in &way.line {
            let node = match at.get(&(*p, level)) {
                Some(node) => *node,
                None => {
                    let node = self.node(*p, Vec::new());
                    at.insert((*p, level), node);
                    node
                }
            };
            nodes.push(node);
        }
        self.way(nodes, street_tags(&way.street));
    }

    fn node(&mut self, p: GridPoint, tags: Vec<Tag>) -> i64 {
        let place = self.city.frame.unproject(p.to_m());
        self.nodes.push(OutNode { lon: fixed(place.lon), lat: fixed(place.lat), tags });
        self.nodes.len() as i64
    }

    fn way(&mut self, nodes: Vec<i64>, tags: Vec<Tag>) -> i64 {
        self.ways.push(OutWay { nodes, tags });
        self.ways.len() as i64
    }

    fn polygon(
        &mut self,
        polygon: &Polygon,
        tags: Vec<Tag>,
        corners: &mut BTreeMap<GridPoint, i64>,
    ) {
        let rings: Vec<&[GridPoint]> = polygon.rings().collect();
        self.rings(&rings, tags, corners);
    }

    /// A closed way, or a multipolygon where there are holes.
    fn rings(
        &mut self,
        rings: &[impl AsRef<[GridPoint]>],
        tags: Vec<Tag>,
        corners: &mut BTreeMap<GridPoint, i64>,
    ) {
        let simple = rings.len() == 1;
        let mut members = Vec::new();
        let mut tags = Some(tags);
        for (i, ring) in rings.iter().map(AsRef::as_ref).enumerate() {
            let mut nodes = Vec::with_capacity(ring.len() + 1);
            for p in spaced(ring) {
                let known = corners.get(&p).copied();
                let node = known.unwrap_or_else(|| self.node(p, Vec::new()));
                corners.insert(p, node);
                nodes.push(node);
            }
            nodes.push(nodes[0]);
            let own = if simple { tags.take() } else { None };
            members.push((self.way(nodes, own.unwrap_or_default()), i > 0));
        }
        if let Some(mut tags) = tags {
            tags.insert(0, ("type", "multipolygon".to_owned()));
            self.relations.push(OutRelation { members, tags });
        }
    }
}

/// A ring without corners that lie so near to the one before that OSM's centimetre could swap them.
pub fn spaced(ring: &[GridPoint]) -> Vec<GridPoint> {
    const APART_M: f64 = 0.03;
    let mut out: Vec<GridPoint> = Vec::with_capacity(ring.len());
    for p in ring {
        if out.last().is_none_or(|last| last.distance_m(*p) >= APART_M) {
            out.push(*p);
        }
    }
    while out.len() > 1 && out[0].distance_m(out[out.len() - 1]) < APART_M {
        out.pop();
    }
    if out.len() < 3 { ring.to_vec() } else { out }
}

/// In 1e-7 degrees.
pub fn fixed(degrees: f64) -> i32 {
    (degrees * 1e7).round() as i32
}

fn street_tags(street: &Street) -> Vec<Tag> {
    let class = street.class;
    let mut tags: Vec<Tag> = vec![("highway", class.as_str().to_owned())];
    let mut put = |key, value: String| tags.push((key, value));
    if let Some(name) = &street.name {
        put("name", name.to_string());
    }
    if street.lanes > 0 {
        put("lanes", street.lanes.to_string());
    }
    if street.width_m > 0.0 {
        put("width", number(street.width_m));
    }
    if street.roundabout {
        put("junction", "roundabout".to_owned());
    }
    if street.oneway {
        put("oneway", "yes".to_owned());
    } else if street.roundabout || class == exurb_city::Class::Motorway {
        put("oneway", "no".to_owned());
    }
    if street.bridge {
        put("bridge", "yes".to_owned());
    }
    if street.tunnel {
        put("tunnel", "yes".to_owned());
    }
    if street.layer != 0 {
        put("layer", street.layer.to_string());
    }
    tags
}

fn building_tags(building: &exurb_city::Building) -> Vec<Tag> {
    let usage = building.usage.as_deref().unwrap_or("yes").to_owned();
    let key = if building.is_part { "building:part" } else { "building" };
    let mut tags: Vec<Tag> = vec![(key, usage)];
    if let Some(height) = building.height_m {
        tags.push(("height", number(height)));
    }
    if let Some(levels) = building.levels {
        tags.push(("building:levels", number(levels)));
    }
    if building.min_height_m > 0.0 {
        tags.push(("min_height", number(building.min_height_m)));
    }
    if let Some(roof) = building.roof {
        tags.push(("roof:shape", roof.as_str().to_owned()));
    }
    tags
}

/// To the millimetre, without trailing zeros.
fn number(value: f64) -> String {
    ((value * 1000.0).round() / 1000.0).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_within_osm_s_centimetre_become_one() {
        let m = |x: f64, y: f64| GridPoint::m(x, y);
        let ring = [m(0.0, 0.0), m(9.0, 0.0), m(9.006, 0.001), m(9.0, 9.0), m(0.001, 0.004)];
        assert_eq!(spaced(&ring), [m(0.0, 0.0), m(9.0, 0.0), m(9.0, 9.0)]);
        let tiny = [m(0.0, 0.0), m(0.01, 0.0), m(0.0, 0.01)];
        assert_eq!(spaced(&tiny), tiny);
    }
}
