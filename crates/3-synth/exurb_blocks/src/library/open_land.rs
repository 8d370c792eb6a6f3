use std::sync::Arc;

use exurb_city::{City, area};
use exurb_geom::{Bounds, BoxGrid, GridPoint, Polygon, grid};

use super::OPEN_SHARE;

/// From this share of water on, a block is water.
const WATER_SHARE: f64 = 0.9;

/// Land that is kept free of buildings, and water.
#[derive(Clone, Debug)]
pub struct OpenLand {
    areas: Vec<(Polygon, Arc<str>)>,
    boxes: BoxGrid,
}

impl OpenLand {
    /// Open land use and water of a city.
    pub fn of(city: &City) -> Self {
        let water: Arc<str> = "water".into();
        let open = city.land_use.iter().filter(|a| area::is_open(&a.class));
        let areas: Vec<(Polygon, Arc<str>)> = open
            .map(|a| (a.polygon.clone(), a.class.clone()))
            .chain(city.water.iter().map(|a| (a.polygon.clone(), water.clone())))
            .collect();
        let boxes = BoxGrid::of(areas.iter().map(|(polygon, _)| polygon));
        Self { areas, boxes }
    }

    /// The class that holds most of `ground`, and the share of all open classes together; `None` when
    /// all of it is other land. Measured on about a hundred points of a square grid.
    pub fn share(&self, ground: &Polygon) -> Option<(Arc<str>, f64)> {
        let mut near = Vec::new();
        self.boxes.meeting_polygon(ground, &mut near);
        if near.is_empty() {
            return None;
        }
        let points = sample(ground);
        let mut hits: Vec<usize> = vec![0; near.len()];
        for p in &points {
            // Of overlapping areas the last one lies on top, as it is drawn.
            if let Some(k) = near.iter().rposition(|n| self.areas[*n as usize].0.contains(*p)) {
                hits[k] += 1;
            }
        }
        let open: usize = hits.iter().sum();
        let class_hits = |class: &str| -> usize {
            let of_class = |k: &usize| &*self.areas[near[*k] as usize].1 == class;
            (0..near.len()).filter(of_class).map(|k| hits[k]).sum()
        };
        let most = near
            .iter()
            .map(|n| &self.areas[*n as usize].1)
            .max_by_key(|class| (class_hits(class), std::cmp::Reverse((*class).clone())))?;
        (open > 0).then(|| (most.clone(), open as f64 / points.len() as f64))
    }

    /// The class that keeps a block open: it is so by half, or lies in water but for a rim. A block with a
    /// river in it has banks to build on.
    pub fn keeps_open(&self, block: &Polygon) -> Option<Arc<str>> {
        let least = |class: &str| if class == "water" { WATER_SHARE } else { OPEN_SHARE };
        self.share(block).filter(|(class, share)| *share >= least(class)).map(|(class, _)| class)
    }

    /// What of it reaches the box around `ground`.
    pub fn near(&self, ground: &Polygon) -> OpenNearby<'_> {
        let mut near = Vec::new();
        self.boxes.meeting_polygon(ground, &mut near);
        let bounds = ground.bounds();
        let meets = |(a, b): &(GridPoint, GridPoint)| {
            let (a, b) = (a.to_m(), b.to_m());
            Bounds { min: a.min(b), max: a.max(b) }.intersects(bounds)
        };
        let areas = near.iter().map(|n| &self.areas[*n as usize]).filter_map(|(polygon, class)| {
            let border: Vec<_> = polygon.segments().filter(meets).collect();
            let reaches = !border.is_empty() || polygon.contains(GridPoint::round(bounds.center()));
            reaches.then_some(Reaching { polygon, is_water: &**class == "water", border })
        });
        OpenNearby { areas: areas.collect() }
    }
}

/// Open land and water around one block.
pub struct OpenNearby<'a> {
    areas: Vec<Reaching<'a>>,
}

struct Reaching<'a> {
    polygon: &'a Polygon,
    is_water: bool,
    /// Its border around the block.
    border: Vec<(GridPoint, GridPoint)>,
}

impl OpenNearby<'_> {
    /// Does `footprint` reach into water, or does its middle lie on open land?
    pub fn forbids(&self, footprint: &Polygon) -> bool {
        if self.areas.is_empty() {
            return false;
        }
        let middle = GridPoint::round(footprint.interior_point());
        let bounds = footprint.bounds();
        let crosses = |&(c, d): &(GridPoint, GridPoint)| {
            let (low, high) = (c.to_m().min(d.to_m()), c.to_m().max(d.to_m()));
            Bounds { min: low, max: high }.intersects(bounds)
                && footprint.segments().any(|(a, b)| grid::intersects(a, b, c, d))
        };
        self.areas.iter().any(|area| {
            (area.is_water && area.border.iter().any(crosses)) || area.polygon.contains(middle)
        })
    }
}

/// Points of a square grid inside `ground`, or one point where it is too thin for that.
fn sample(ground: &Polygon) -> Vec<GridPoint> {
    let bounds = ground.bounds();
    let step = (bounds.size().x * bounds.size().y / 100.0).sqrt().max(0.5);
    let count = |length: f64| ((length / step) as usize).min(400) + 1;
    let mut out = Vec::new();
    for j in 0..count(bounds.size().y) {
        for i in 0..count(bounds.size().x) {
            let offset = exurb_geom::Vec2::new(i as f64 + 0.5, j as f64 + 0.5) * step;
            out.push(GridPoint::round(bounds.min + offset));
        }
    }
    out.retain(|p| ground.contains(*p));
    if out.is_empty() {
        out.push(GridPoint::round(ground.interior_point()));
    }
    out
}

#[cfg(test)]
mod tests {
    use exurb_city::Area;
    use exurb_geom::Frame;

    use super::*;

    fn rectangle(x: f64, to_x: f64) -> Polygon {
        Polygon::rectangle(GridPoint::m(x, 0.0), GridPoint::m(to_x, 100.0))
    }

    #[test]
    fn a_block_with_a_river_has_banks_and_a_lake_is_water() {
        let with = |to_x: f64, class: &str| {
            let area = Area { id: 1, polygon: rectangle(0.0, to_x), class: class.into() };
            let mut city = City::empty(Frame::null_island(), rectangle(0.0, 200.0));
            match class {
                "water" => city.water = Arc::new(vec![area]),
                _ => city.land_use = Arc::new(vec![area]),
            }
            OpenLand::of(&city).keeps_open(&rectangle(0.0, 100.0))
        };
        assert_eq!(with(60.0, "water"), None);
        assert_eq!(with(96.0, "water").as_deref(), Some("water"));
        assert_eq!(with(60.0, "park").as_deref(), Some("park"));
        assert_eq!(with(40.0, "park"), None);
    }
}
