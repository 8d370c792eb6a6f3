//! A layout's buildings and things in their new places: refined, with all that is known of them.

use exurb_city::{Building, Feature, FeatureShape, Origin, Provenance};
use exurb_geom::{BoxGrid, GridPoint, Polygon, Rigid, overlap, overlay};

use crate::database::{self, Footprint, Layout};
use crate::library::OpenNearby;
use crate::motion::Motion;
use crate::refine::{Body, Fate, Ground, SLACK_M2, Why, refine};

/// Where an element of a layout is wished for.
#[derive(Clone, Copy, Debug)]
pub struct Wish<'a, T> {
    /// The element.
    pub what: &'a T,
    /// Its way there.
    pub motion: Motion,
}

/// How close things may come, and what they may lose for it.
#[derive(Clone, Copy, Debug)]
pub struct Spacing {
    /// Distance between kerb and footprints in metres, unless they stood nearer in the example.
    pub pavement_m: f64,
    /// Share by which footprints may change to fit.
    pub tolerance: f64,
    /// Share of a footprint that may be cut off where it is wished for in an earlier one.
    pub cut: f64,
}

/// A layout in its new place.
#[derive(Clone, Debug, Default)]
pub struct Laid {
    /// Buildings, each followed by its parts.
    pub buildings: Vec<Building>,
    /// Trees and the like.
    pub things: Vec<Feature>,
    /// Why footprints are missing, one each.
    pub dropped: Vec<Why>,
    /// Footprints that were moved or trimmed to make room.
    pub moved: usize,
}

impl Laid {
    /// Footprint area in m².
    pub fn built_m2(&self) -> f64 {
        self.buildings.iter().filter(|b| !b.is_part).map(|b| b.polygon.area_m2()).sum()
    }
}

/// Lays footprints and things of `layout` into the ground where they are wished for. Height, storeys,
/// roof and use stay with a building; its parts follow it.
pub fn lay(
    layout: &Layout,
    footprints: &[Wish<'_, Footprint>],
    things: &[Wish<'_, Feature>],
    ground: &Ground<'_>,
    open: &OpenNearby<'_>,
    spacing: Spacing,
) -> Laid {
    let mut out = Laid { dropped: layout.flaws.clone(), ..Laid::default() };
    let mut bodies = Vec::new();
    let mut of_body = Vec::new();
    for wish in footprints {
        match body(wish, open, spacing.pavement_m) {
            Ok(body) => {
                bodies.push(body);
                of_body.push(wish);
            }
            Err(why) => out.dropped.push(why),
        }
    }
    cut_by_earlier(&mut bodies, spacing.cut);
    let provenance = layout.provenance();
    let fates = refine(ground, &bodies, spacing.tolerance);
    for ((fate, body), wish) in fates.into_iter().zip(bodies).zip(of_body) {
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
        put(&mut out.buildings, wish, &body.polygon, polygon, &provenance);
    }
    let moved = things.iter().filter_map(|wish| moved_thing(wish, ground));
    out.things = moved.map(|f| Feature { provenance: provenance.clone(), ..f }).collect();
    out
}

/// Adds a building whose wished outline became `polygon`, and its parts.
pub(crate) fn put(
    out: &mut Vec<Building>,
    wish: &Wish<'_, Footprint>,
    wished: &Polygon,
    polygon: Polygon,
    provenance: &Provenance,
) {
    let follow = wish.motion.then(&between(wished, &polygon));
    let place = |b: &Building, polygon| Building {
        polygon,
        parcel: 0,
        provenance: provenance.clone(),
        ..b.clone()
    };
    out.push(place(&wish.what.building, polygon));
    let parts =
        wish.what.parts.iter().filter_map(|part| {
            follow.apply_polygon(&part.polygon).map(|polygon| place(part, polygon))
        });
    out.extend(parts);
}

/// A footprint where it is wished for, or why it may not stand there.
pub(crate) fn body(
    wish: &Wish<'_, Footprint>,
    open: &OpenNearby<'_>,
    pavement_m: f64,
) -> Result<Body, Why> {
    let polygon = wish.motion.apply_polygon(&wish.what.building.polygon).ok_or(Why::Shape)?;
    if !wish.what.on_open_land && open.forbids(&polygon) {
        return Err(Why::OpenLand);
    }
    Ok(Body { polygon, clearance_m: wish.what.clearance_m.min(pavement_m) })
}

/// Where footprints are wished for in one another, later ones lose what they share with earlier ones: rows
/// that are laid out anew end at the rows that stand. What would lose more than `most`, a share, is left
/// for refinement to part.
fn cut_by_earlier(bodies: &mut [Body], most: f64) {
    if most <= 0.0 {
        return;
    }
    let boxes = BoxGrid::of(bodies.iter().map(|b| &b.polygon));
    let mut near = Vec::new();
    for i in 0..bodies.len() {
        boxes.meeting_polygon(&bodies[i].polygon, &mut near);
        let earlier = near.iter().map(|j| *j as usize).filter(|j| *j < i);
        let met: Vec<&Polygon> = earlier
            .map(|j| &bodies[j].polygon)
            .filter(|p| overlap::shared_m2(&bodies[i].polygon, p, SLACK_M2) > SLACK_M2)
            .collect();
        if met.is_empty() {
            continue;
        }
        let left = overlay::difference(&bodies[i].polygon, met).into_iter().next();
        let least_m2 = bodies[i].polygon.area_m2() * (1.0 - most);
        if let Some(left) = left.filter(|p| p.area_m2() >= least_m2 && p.is_valid()) {
            bodies[i].polygon = left;
        }
    }
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
fn moved_thing(wish: &Wish<'_, Feature>, ground: &Ground<'_>) -> Option<Feature> {
    let point = |p: &GridPoint| GridPoint::round(wish.motion.apply(p.to_m()));
    let shape = match &wish.what.shape {
        FeatureShape::Point(p) => FeatureShape::Point(point(p)),
        FeatureShape::Line(line) => FeatureShape::Line(line.iter().map(point).collect()),
        FeatureShape::Polygon(polygon) => {
            FeatureShape::Polygon(wish.motion.apply_polygon(polygon)?)
        }
    };
    let middle = GridPoint::round(database::middle(&shape));
    ground.block.contains(middle).then(|| Feature { shape, ..wish.what.clone() })
}

impl Layout {
    /// What was copied from it.
    pub fn provenance(&self) -> Provenance {
        Provenance {
            origin: Origin::Example,
            source: Some(self.source.clone()),
            part: Some(format!("block {}", self.id).into()),
        }
    }

    /// Everything in it, moved as one.
    pub fn wished(&self, motion: Motion) -> (Vec<Wish<'_, Footprint>>, Vec<Wish<'_, Feature>>) {
        let footprints = self.footprints.iter().map(|what| Wish { what, motion });
        let things = self.things.iter().map(|what| Wish { what, motion });
        (footprints.collect(), things.collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn later_footprints_are_cut_where_they_meet_earlier_ones() {
        let body = |x: f64| Body {
            polygon: Polygon::rectangle(GridPoint::m(x, 0.0), GridPoint::m(x + 10.0, 10.0)),
            clearance_m: 2.0,
        };
        // The second lies in the first with a fifth, the third in the second with a half.
        let wished = [body(0.0), body(8.0), body(13.0)];
        let mut bodies = wished.clone();
        cut_by_earlier(&mut bodies, 0.0);
        assert!(bodies.iter().zip(&wished).all(|(a, b)| a.polygon == b.polygon));
        cut_by_earlier(&mut bodies, 0.35);
        let areas: Vec<f64> = bodies.iter().map(|b| b.polygon.area_m2()).collect();
        assert_eq!(areas, [100.0, 80.0, 100.0]);
        assert_eq!(overlap::shared_m2(&bodies[0].polygon, &bodies[1].polygon, 0.0), 0.0);
    }
}
