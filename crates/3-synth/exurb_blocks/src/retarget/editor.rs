//! A block whose outline is changed, again and again: what a dragging hand needs.

use exurb_geom::{GridPoint, Polygon};

use super::{Correspondence, Settings, Source, things};
use crate::database::{Footprint, Layout, is_civic};
use crate::kerb::Kerb;
use crate::lay::{Laid, Spacing, Wish, lay};
use crate::library::OpenLand;
use crate::outline::plain_outline;
use crate::refine::Ground;

/// A block's layout, ready to be laid out in other outlines.
pub struct Editor<'a> {
    layout: &'a Layout,
    source: Source,
    settings: Settings,
    spacing: Spacing,
}

/// Vertices nearer than this to one of the old outline are that one, in metres: files round.
const SAME_M: f64 = 0.03;

impl<'a> Editor<'a> {
    /// Analyses the layout of a block once.
    pub fn of(layout: &'a Layout, settings: &Settings, spacing: Spacing) -> Self {
        Self { source: source_of(layout, settings), layout, settings: settings.clone(), spacing }
    }

    /// The layout in a new outline of its block, which is simple. Milliseconds for a block of some
    /// dozen buildings.
    pub fn laid(&self, outline: &Polygon, open: &OpenLand) -> Laid {
        let ring = plain_outline(outline);
        let link = self.link(&ring);
        let placed = self.source.retarget(outline, &ring, &link, &self.settings);
        let footprints = wishes(self.layout, &placed);
        let things = things(self.layout, &self.source, &placed, outline, &ring, &link);
        let kerb = Kerb::of(outline);
        let ground = Ground { block: outline, kerb: &kerb, standing: &[], at_home: false };
        lay(self.layout, &footprints, &things, &ground, &open.near(outline), self.spacing)
    }

    /// The deformed layout that guides the elements in a new outline.
    pub fn guidance_map(&self, outline: &Polygon) -> Vec<Polygon> {
        let ring = plain_outline(outline);
        let images =
            self.source.guidance_map(outline, &ring, &self.link(&ring), self.settings.map_scale);
        let round = |ring: &Vec<exurb_geom::Vec2>| exurb_geom::polyline::round(ring);
        images.iter().filter_map(|ring| Polygon::new(round(ring), Vec::new())).collect()
    }

    /// Vertices belong to themselves where enough of them stayed, else the time warp decides.
    fn link(&self, ring: &[GridPoint]) -> Correspondence {
        let old = &self.layout.outline;
        let by_vertices = Correspondence::by_vertices(old, ring);
        by_vertices.unwrap_or_else(|| Correspondence::by_shape(old, ring))
    }
}

/// `outline` with the vertices of `old` where they are the same but for rounding.
pub fn snapped(outline: &Polygon, old: &Polygon) -> Option<Polygon> {
    let near = |p: &GridPoint| {
        let same = old.rings().flatten().filter(|q| p.distance_m(**q) <= SAME_M);
        same.min_by(|a, b| p.distance_m(**a).total_cmp(&p.distance_m(**b))).copied().unwrap_or(*p)
    };
    let ring = |r: &[GridPoint]| r.iter().map(near).collect();
    Polygon::new(ring(outline.exterior()), outline.interiors().iter().map(|r| ring(r)).collect())
}

/// A layout as it is laid out anew: schools and the like are never repeated.
pub fn source_of(layout: &Layout, settings: &Settings) -> Source {
    let polygons = layout.footprints.iter().map(|f| f.building.polygon.clone()).collect();
    let once: Vec<bool> =
        layout.footprints.iter().map(|f| is_civic(f.building.usage.as_deref())).collect();
    Source::of(&layout.outline, polygons, &once, settings)
}

/// The buildings that a layout's elements stand for, where they go.
pub fn wishes<'a>(layout: &'a Layout, placed: &[super::Placement]) -> Vec<Wish<'a, Footprint>> {
    let of = |p: &super::Placement| {
        let motion = p.motion;
        let wish = move |m: &usize| Wish { what: &layout.footprints[*m], motion };
        p.members.iter().map(wish).collect::<Vec<_>>()
    };
    placed.iter().flat_map(of).collect()
}
