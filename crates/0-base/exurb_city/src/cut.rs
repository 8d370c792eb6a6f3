//! Cutting a draft to the target: what lies outside goes, what crosses the edge is cut there.

use exurb_geom::{Bounds, GridPoint, Polygon, Vec2, overlay, polyline};
use rayon::prelude::*;

use crate::{Area, Draft, Feature, FeatureShape, Role, Way};

/// Cuts everything but the streets that count, whose ways stay whole and are cut as a graph: only
/// those that cannot touch the target go.
pub fn cut(draft: &mut Draft, target: &Polygon, with_other: bool) {
    let edge = Edge::new(target);
    draft.streets.ways.retain(|way| edge.may_touch(&way.line));
    if !with_other {
        let ways = std::mem::take(&mut draft.streets.ways);
        draft.streets.ways = ways.into_iter().flat_map(|way| edge.other_way(way)).collect();
    }
    draft.buildings.retain(|b| edge.holds(b.polygon.centroid()));
    draft.parcels.retain(|p| edge.holds(p.polygon.centroid()));
    draft.water = edge.areas(std::mem::take(&mut draft.water));
    draft.land_use = edge.areas(std::mem::take(&mut draft.land_use));
    let features = std::mem::take(&mut draft.features);
    draft.features = features.into_iter().flat_map(|f| edge.feature(f)).collect();
}

/// The target, with a quick answer where it is a rectangle.
struct Edge<'a> {
    target: &'a Polygon,
    bounds: Bounds,
    is_rectangle: bool,
}

impl<'a> Edge<'a> {
    fn new(target: &'a Polygon) -> Self {
        let bounds = target.bounds();
        let is_rectangle = target.interiors().is_empty()
            && (target.area_m2() - bounds.size().x * bounds.size().y).abs() < 1e-6;
        Self { target, bounds, is_rectangle }
    }

    fn holds(&self, p: Vec2) -> bool {
        self.bounds.contains(p) && (self.is_rectangle || self.target.contains(GridPoint::round(p)))
    }

    /// Nothing of it reaches outside?
    fn holds_box(&self, bounds: Bounds) -> bool {
        self.is_rectangle && self.bounds.contains(bounds.min) && self.bounds.contains(bounds.max)
    }

    fn may_touch(&self, line: &[GridPoint]) -> bool {
        Bounds::of(line.iter().copied()).is_some_and(|b| b.intersects(self.bounds))
    }

    /// The runs of segments of a way of role other that touch the target, uncut: it is drawn and
    /// exported, never measured. Other ways pass as they are.
    fn other_way(&self, way: Way) -> Vec<Way> {
        let bounds = Bounds::of(way.line.iter().copied());
        if way.street.role() != Role::Other || bounds.is_some_and(|b| self.holds_box(b)) {
            return vec![way];
        }
        let touches: Vec<bool> = way.line.windows(2).map(|w| self.touches(w[0], w[1])).collect();
        let mut out = Vec::new();
        let mut start = 0;
        for run in touches.chunk_by(|a, b| a == b) {
            if run[0] {
                let range = start..=start + run.len();
                let nodes = way.nodes.get(range.clone()).unwrap_or_default().to_vec();
                out.push(Way { line: way.line[range].to_vec(), nodes, ..way.clone() });
            }
            start += run.len();
        }
        out
    }

    fn touches(&self, a: GridPoint, b: GridPoint) -> bool {
        let segment = Bounds { min: a.to_m().min(b.to_m()), max: a.to_m().max(b.to_m()) };
        segment.intersects(self.bounds)
            && (self.target.contains(a)
                || self.target.segments().any(|(c, d)| exurb_geom::grid::intersects(a, b, c, d)))
    }

    fn areas(&self, areas: Vec<Area>) -> Vec<Area> {
        let cut = areas.into_par_iter().map(|area| {
            let bounds = area.polygon.bounds();
            if self.holds_box(bounds) {
                return vec![area];
            }
            if !bounds.intersects(self.bounds) {
                return Vec::new();
            }
            let pieces = overlay::intersection(&area.polygon, self.target);
            pieces.into_iter().map(|polygon| Area { polygon, ..area.clone() }).collect()
        });
        cut.collect::<Vec<_>>().into_iter().flatten().collect()
    }

    fn feature(&self, feature: Feature) -> Vec<Feature> {
        let line = match &feature.shape {
            FeatureShape::Point(p) => {
                return self.holds(p.to_m()).then_some(feature).into_iter().collect();
            }
            FeatureShape::Polygon(p) => {
                return self.holds(p.centroid()).then_some(feature).into_iter().collect();
            }
            FeatureShape::Line(line) => line,
        };
        match Bounds::of(line.iter().copied()) {
            Some(bounds) if self.holds_box(bounds) => vec![feature],
            Some(bounds) if bounds.intersects(self.bounds) => {
                let mut pieces: Vec<Vec<GridPoint>> =
                    overlay::clip_line(self.target, &polyline::to_m(line))
                        .iter()
                        .map(|piece| polyline::round(piece))
                        .filter(|piece| piece.len() > 1)
                        .collect();
                pieces.sort();
                let of = |line| Feature { shape: FeatureShape::Line(line), ..feature.clone() };
                pieces.into_iter().map(of).collect()
            }
            _ => Vec::new(),
        }
    }
}
