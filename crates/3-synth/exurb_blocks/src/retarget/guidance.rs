//! The guidance map: where the elements of a layout come to lie when the inside follows the outline.
//!
//! Hartmann et al. 2015, sections 3.3 and 4.3: mean value coordinates, on elements stretched along their
//! side. Where the map folds an element or carries it out of the new outline (it may in concave ones),
//! the element is carried along the outline instead: as far along its side, as deep inside.

use exurb_geom::{GridPoint, MeanValueMap, Polygon, RowPolygon, Vec2};

use super::correspondence::Correspondence;
use super::groups::{Element, Group};
use super::path::inverse;
use crate::ring::Ring;

/// From one outline to another.
pub struct Guidance<'a> {
    /// The new outline.
    pub target: &'a Ring,
    /// The new domain.
    pub domain: RowPolygon<'a>,
    /// Which place belongs to which.
    pub link: &'a Correspondence,
    map: Option<MeanValueMap>,
}

impl<'a> Guidance<'a> {
    /// The map that `link` makes.
    pub fn new(
        source: &'a Ring,
        target: &'a Ring,
        domain: &'a Polygon,
        link: &'a Correspondence,
    ) -> Self {
        let domain = RowPolygon::new(domain);
        Self { target, domain, link, map: link.map(source, target) }
    }

    /// Where the rings of an element come to lie when it is first stretched by `scale` along its path;
    /// `None` where nothing says.
    pub fn image(&self, group: &Group, element: &Element, scale: f64) -> Option<Vec<Vec<Vec2>>> {
        let to_plane = inverse(&element.to_frame);
        let middle = middle(&element.rings[0]);
        let stretched = |p: &Vec2| Vec2::new(middle.x + (p.x - middle.x) * scale, p.y);
        let rings = || element.rings.iter().map(|r| r.iter().map(stretched).collect::<Vec<Vec2>>());
        let mapped: Option<Vec<Vec<Vec2>>> = rings()
            .map(|ring| self.ring(&ring.iter().map(|p| to_plane.apply(*p)).collect::<Vec<_>>()))
            .collect();
        mapped.or_else(|| {
            let side = group.side.as_ref()?;
            let span = element.span_m;
            let start_m = side.start_m + (span.0 + span.1) / 2.0;
            Some(rings().map(|ring| self.along(&ring, start_m)).collect())
        })
    }

    /// Where a ring in the plane comes to lie; `None` where it folds or leaves the domain.
    pub fn ring(&self, ring: &[Vec2]) -> Option<Vec<Vec2>> {
        let image = self.map.as_ref()?.ring(ring)?;
        self.domain.contains(GridPoint::round(middle(&image))).then_some(image)
    }

    /// Where a point comes to lie.
    pub fn point(&self, p: Vec2) -> Vec2 {
        self.map.as_ref().map_or(p, |map| map.apply(p))
    }

    /// A ring in the frame of a place on the outline, carried along the outline.
    fn along(&self, ring: &[Vec2], start_m: f64) -> Vec<Vec2> {
        ring.iter()
            .map(|p| {
                let at = self.link.to_target(start_m + p.x);
                let (a, b) = (self.target.point_at(at - 0.5), self.target.point_at(at + 0.5));
                (a + b) / 2.0 + (b - a).normalize_or(Vec2::X).perp() * p.y
            })
            .collect()
    }
}

/// Middle of a ring's corners.
pub fn middle(ring: &[Vec2]) -> Vec2 {
    ring.iter().sum::<Vec2>() / ring.len().max(1) as f64
}
