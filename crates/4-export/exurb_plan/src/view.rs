//! From metres to pixels.

use exurb_city::City;
use exurb_geom::{Bounds, GridPoint, Polygon, Vec2};

use crate::display::{Px, Shape};
use crate::options::{MAX_PX, Options};

/// Vertices nearer than this to the one before are not drawn.
const LEAST_STEP_PX: f32 = 0.3;
/// No picture is more than this many times as long as wide, or the other way round.
const MAX_ASPECT: f64 = 10.0;

/// The window of the map.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// What is shown, in metres.
    pub bounds: Bounds,
    pub width_px: u32,
    pub height_px: u32,
    pub px_per_m: f64,
}

impl View {
    /// The box around the target with the margin of the options.
    pub fn of(city: &City, options: &Options) -> Self {
        let tight = city.target.bounds();
        let margin_m = options.margin_m.clamp(0.0, 1e6);
        let mut bounds = tight.grown(margin_m);
        let size = bounds.size();
        let least = size.max(Vec2::new(size.y, size.x) / MAX_ASPECT).max(Vec2::ONE);
        bounds = Bounds { min: bounds.center() - least / 2.0, max: bounds.center() + least / 2.0 };
        let px_per_m = f64::from(options.width_px) / least.x;
        let height_px = (least.y * px_per_m).round().clamp(1.0, f64::from(MAX_PX)) as u32;
        Self { bounds, width_px: options.width_px, height_px, px_per_m }
    }

    /// A thin line, the same share of the picture at any size.
    pub fn hair_px(&self) -> f32 {
        (self.width_px as f32 / 2400.0).clamp(0.5, 4.0)
    }

    /// Pixels of a length.
    pub fn px(&self, length_m: f64) -> f32 {
        (length_m * self.px_per_m) as f32
    }

    /// Place on the paper.
    pub fn place(&self, p: Vec2) -> Px {
        let (x, y) = (p.x - self.bounds.min.x, self.bounds.max.y - p.y);
        [(x * self.px_per_m) as f32, (y * self.px_per_m) as f32]
    }

    /// Is any of it in the window?
    pub fn shows(&self, bounds: Bounds) -> bool {
        bounds.intersects(self.bounds.grown(40.0 / self.px_per_m))
    }

    /// A line on the paper; `None` when it lies outside.
    pub fn line(&self, line: &[GridPoint]) -> Option<Vec<Px>> {
        let bounds = Bounds::of(line.iter().copied())?;
        let points = line.iter().map(|p| self.place(p.to_m()));
        self.shows(bounds).then(|| thinned(points, false)).filter(|l| l.len() >= 2)
    }

    /// A polygon on the paper; `None` when it lies outside or is too small to see.
    pub fn area(&self, polygon: &Polygon) -> Option<Shape> {
        self.moved_area(polygon, Vec2::ZERO)
    }

    /// The polygon moved by `by_m`.
    pub fn moved_area(&self, polygon: &Polygon, by_m: Vec2) -> Option<Shape> {
        self.rings(polygon, by_m).map(Shape::Area)
    }

    /// Rings on the paper, the polygon moved by `by_m`.
    pub fn rings(&self, polygon: &Polygon, by_m: Vec2) -> Option<Vec<Vec<Px>>> {
        if !self.shows(polygon.bounds()) {
            return None;
        }
        let ring = |r: &[GridPoint]| thinned(r.iter().map(|p| self.place(p.to_m() + by_m)), true);
        let mut rings = polygon.rings().map(ring).filter(|r| r.len() >= 3).peekable();
        rings.peek()?;
        Some(rings.collect())
    }
}

/// Points without those that cannot be told from the one before; the last of a line stays.
fn thinned(points: impl Iterator<Item = Px>, closed: bool) -> Vec<Px> {
    let far = |a: Px, b: Px| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) >= LEAST_STEP_PX;
    let mut out: Vec<Px> = Vec::with_capacity(points.size_hint().0);
    let mut skipped = None;
    for p in points {
        match out.last() {
            Some(last) if !far(*last, p) => skipped = Some(p),
            _ => {
                out.push(p);
                skipped = None;
            }
        }
    }
    if !closed {
        out.extend(skipped);
    }
    out
}
