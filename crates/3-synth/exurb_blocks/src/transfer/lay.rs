//! One layout laid into one block.

use exurb_city::{Building, Feature, FeatureShape, Origin, Provenance};
use exurb_geom::{GridPoint, Polygon, Rigid};

use crate::database::Layout;
use crate::library::OpenNearby;
use crate::refine::{Body, Fate, Ground, Why, refine};

/// A layout in its new place.
#[derive(Clone, Debug, Default)]
pub struct Laid {
    /// Buildings, each followed by its parts.
    pub buildings: Vec<Building>,
    /// Trees and the like.
    pub things: Vec<Feature>,
    /// Why footprints are missing, one each.
    pub dropped: Vec<Why>,
    /// Footprints that were moved to make room.
    pub moved: usize,
}

/// Lays `layout` into the ground by `motion` and refines it.
pub fn lay(
    layout: &Layout,
    motion: &Rigid,
    ground: &Ground<'_>,
    open: &OpenNearby<'_>,
    pavement_m: f64,
    tolerance: f64,
) -> Laid {
    let mut out = Laid { dropped: layout.flaws.clone(), ..Laid::default() };
    let mut bodies = Vec::new();
    let mut of_body = Vec::new();
    for footprint in &layout.footprints {
        let Some(polygon) = motion.apply_polygon(&footprint.building.polygon) else {
            out.dropped.push(Why::Shape);
            continue;
        };
        if !footprint.on_open_land && open.forbids(&polygon) {
            out.dropped.push(Why::OpenLand);
            continue;
        }
        bodies.push(Body { polygon, clearance_m: footprint.clearance_m.min(pavement_m) });
        of_body.push(footprint);
    }
    let provenance = Provenance {
        origin: Origin::Example,
        source: Some(layout.source.clone()),
        part: Some(format!("block {}", layout.id).into()),
    };
    let fates = refine(ground, &bodies, tolerance);
    for ((fate, body), footprint) in fates.into_iter().zip(bodies).zip(of_body) {
        let polygon = match fate {
            Fate::Dropped(why) => {
                out.dropped.push(why);
                continue;
            }
            Fate::Stays => body.polygon.clone(),
            Fate::Moved(polygon) => {
                out.moved += 1;
                polygon
            }
        };
        let follow = motion.then(&between(&body.polygon, &polygon));
        let place = |b: &Building, polygon| Building {
            polygon,
            parcel: 0,
            provenance: provenance.clone(),
            ..b.clone()
        };
        out.buildings.push(place(&footprint.building, polygon));
        let parts = footprint.parts.iter().filter_map(|part| {
            follow.apply_polygon(&part.polygon).map(|polygon| place(part, polygon))
        });
        out.buildings.extend(parts);
    }
    let moved = layout.things.iter().filter_map(|thing| moved_thing(thing, motion, ground));
    out.things = moved.map(|f| Feature { provenance: provenance.clone(), ..f }).collect();
    out
}

/// The motion of an outline to what it became.
fn between(from: &Polygon, to: &Polygon) -> Rigid {
    let (a, b) = (from.exterior(), to.exterior());
    if a.len() != b.len() {
        let shift = to.centroid() - from.centroid();
        return Rigid { shift, ..Rigid::IDENTITY };
    }
    Rigid::fit(a.iter().zip(b).map(|(p, q)| (p.to_m(), q.to_m(), 1.0)))
}

/// A feature in its new place; `None` where that lies outside the block.
fn moved_thing(thing: &Feature, motion: &Rigid, ground: &Ground<'_>) -> Option<Feature> {
    let point = |p: &GridPoint| GridPoint::round(motion.apply(p.to_m()));
    let shape = match &thing.shape {
        FeatureShape::Point(p) => FeatureShape::Point(point(p)),
        FeatureShape::Line(line) => FeatureShape::Line(line.iter().map(point).collect()),
        FeatureShape::Polygon(polygon) => FeatureShape::Polygon(motion.apply_polygon(polygon)?),
    };
    let middle = GridPoint::round(crate::database::middle(&shape));
    ground.block.contains(middle).then(|| Feature { shape, ..thing.clone() })
}
