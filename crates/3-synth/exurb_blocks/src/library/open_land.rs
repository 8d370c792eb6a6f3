use std::sync::Arc;

use exurb_city::{City, area};
use exurb_geom::{BoxGrid, GridPoint, Polygon};

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

    /// Is the point on water?
    pub fn is_water(&self, p: GridPoint) -> bool {
        let mut near = Vec::new();
        self.boxes.meeting(p, p, &mut near);
        let areas = near.iter().map(|n| &self.areas[*n as usize]);
        areas.filter(|(_, class)| &**class == "water").any(|(polygon, _)| polygon.contains(p))
    }

    /// Is the point on open land or water?
    pub fn holds(&self, p: GridPoint) -> bool {
        let mut near = Vec::new();
        self.boxes.meeting(p, p, &mut near);
        near.iter().any(|n| self.areas[*n as usize].0.contains(p))
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
