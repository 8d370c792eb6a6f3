//! The ground that everything lies on: flat, or a mesh over a square grid.
//!
//! Each cell of the grid is two triangles, divided from south-west to north-east. Whatever is laid
//! on the ground is cut along these triangles, so that it runs parallel to the ground everywhere: no
//! surface pokes through another, however coarse or fine its own corners are.

use std::collections::HashMap;

use exurb_city::{City, Land};
use exurb_geom::{Bounds, Cell, Cells, Polygon, Vec2, trig};
use glam::DVec3;

use crate::mesh::{Axes, Facing, Mesh, triangles};
use crate::palette::Linear;

/// Most cells of the grid: finer terrain would make models too large to show.
const MOST_CELLS: f64 = 60_000.0;

/// The ground under a model; heights are above the model's origin.
#[derive(Clone, Debug)]
pub struct Drape {
    grid: Option<Grid>,
    /// Height of the model's origin over the terrain's zero.
    pub datum_m: f64,
}

#[derive(Clone, Debug)]
struct Grid {
    cells: Cells,
    /// Of posts, one more along each side than cells.
    heights: Vec<f64>,
}

impl Drape {
    /// The ground of a city over `bounds`. Its height at `center`, to the whole metre, becomes the
    /// model's zero.
    pub fn of(city: &City, bounds: Bounds, center: Vec2) -> Self {
        let Some(terrain) = &city.terrain else { return Self { grid: None, datum_m: 0.0 } };
        let dry = City { water: Default::default(), ..city.clone() };
        let land = Land::of(&dry);
        let size = bounds.size();
        let step_m = terrain.cell_m().max((size.x * size.y / MOST_CELLS).sqrt());
        let cells = Cells::over(bounds, step_m);
        let datum_m = land.height_m(center).round();
        let heights = cells.posts().map(|p| land.height_m(p) - datum_m).collect();
        Self { grid: Some(Grid { cells, heights }), datum_m }
    }

    /// Is there no relief?
    pub fn is_flat(&self) -> bool {
        self.grid.is_none()
    }

    /// The ground's height at a place.
    pub fn height_m(&self, p: Vec2) -> f64 {
        self.grid.as_ref().map_or(0.0, |grid| grid.height_m(p))
    }

    /// The lowest place of a polygon.
    pub fn lowest_m(&self, polygon: &Polygon) -> f64 {
        let Some(grid) = &self.grid else { return 0.0 };
        let rim = polygon.segments().flat_map(|(a, b)| self.along(a.to_m(), b.to_m()));
        let lowest = rim.map(|p| grid.height_m(p)).fold(f64::INFINITY, f64::min);
        grid.heights_in(polygon).into_iter().fold(lowest, f64::min)
    }

    /// Heights of the grid's posts inside a polygon.
    pub fn heights_in(&self, polygon: &Polygon) -> Vec<f64> {
        self.grid.as_ref().map_or_else(Vec::new, |grid| grid.heights_in(polygon))
    }

    /// Raises the ground in and around a polygon to `level_m` at least, so that water which stands
    /// there has shores.
    pub fn raise(&mut self, polygon: &Polygon, level_m: f64) {
        let Some(grid) = &mut self.grid else { return };
        for (cell, _) in grid.cells.of(polygon) {
            for post in grid.cells.corners(cell) {
                grid.heights[post] = grid.heights[post].max(level_m);
            }
        }
    }

    /// Lays a polygon on the ground, `over_m` above it.
    pub fn lay(&self, mesh: &mut Mesh, axes: Axes, polygon: &Polygon, over_m: f64, color: Linear) {
        let Some(grid) = &self.grid else {
            return mesh.horizontal(axes, polygon, over_m, color, Facing::Up);
        };
        let mut rim = Vec::new();
        // Whole cells share their corners.
        let mut known: HashMap<usize, u32> = HashMap::new();
        for (cell, kind) in grid.cells.of(polygon) {
            if kind != Cell::Inside {
                rim.push(cell);
                continue;
            }
            let [sw, se, ne, nw] = grid.cells.corners(cell).map(|post| {
                let place = grid.cells.post(post);
                *known.entry(post).or_insert_with(|| grid.vertex(mesh, axes, place, over_m, color))
            });
            mesh.indices.extend([sw, se, ne, sw, ne, nw]);
        }
        rim.sort_unstable();
        let (points, triangles) = triangles(polygon);
        for triangle in triangles {
            let corners = triangle.map(|i| points[i as usize]);
            grid.lay_convex(mesh, axes, &corners, over_m, color, |cell| {
                rim.binary_search(&cell).is_ok()
            });
        }
    }

    /// Lays a convex polygon on the ground; its corners run counter-clockwise.
    pub fn lay_convex(
        &self,
        mesh: &mut Mesh,
        axes: Axes,
        corners: &[Vec2],
        over_m: f64,
        color: Linear,
    ) {
        match &self.grid {
            Some(grid) => grid.lay_convex(mesh, axes, corners, over_m, color, |_| true),
            None => {
                let places: Vec<DVec3> = corners.iter().map(|p| axes.place(*p, over_m)).collect();
                mesh.convex(&places, color);
            }
        }
    }

    /// An upright strip along a ring's segment `a b`, outside on the right, between two heights,
    /// each given for a place and the ground's height there. Where the second is lower, the strip
    /// looks the other way.
    pub fn wall(
        &self,
        mesh: &mut Mesh,
        axes: Axes,
        [a, b]: [Vec2; 2],
        from_m: impl Fn(f64) -> f64,
        to_m: impl Fn(f64) -> f64,
        color: Linear,
    ) {
        for w in self.along(a, b).windows(2) {
            let ground = [self.height_m(w[0]), self.height_m(w[1])];
            let (low, high) = (ground.map(&from_m), ground.map(&to_m));
            let p = |i: usize, h: [f64; 2]| axes.place(w[i], h[i]);
            let quad = [p(0, low), p(1, low), p(1, high), p(0, high)];
            // A quad that vanishes at one end has three corners.
            let mut corners: Vec<DVec3> = quad.to_vec();
            corners.dedup();
            if corners.len() > 3 || (corners.len() == 3 && corners[0] != corners[2]) {
                mesh.convex(&corners, color);
            }
        }
    }

    /// The ends of a segment and where it crosses the lines of the grid, in order.
    fn along(&self, a: Vec2, b: Vec2) -> Vec<Vec2> {
        let Some(grid) = &self.grid else { return vec![a, b] };
        let (p, q) = (grid.cells.place(a), grid.cells.place(b));
        let mut shares = Vec::new();
        // Across columns, rows and the diagonals of cells.
        for (from, to) in [(p.x, q.x), (p.y, q.y), (p.x - p.y, q.x - q.y)] {
            let (low, high) = (from.min(to), from.max(to));
            let mut line = low.floor() + 1.0;
            while line < high {
                shares.push((line - from) / (to - from));
                line += 1.0;
            }
        }
        shares.sort_by(f64::total_cmp);
        let mut out = vec![a];
        out.extend(shares.into_iter().map(|share| a.lerp(b, share)));
        out.push(b);
        out.dedup_by(|p, q| p.distance(*q) < 1e-4);
        out
    }
}

impl Grid {
    /// Columns and rows up to the last cell.
    fn height_m(&self, p: Vec2) -> f64 {
        let place = self.cells.place(p).clamp(Vec2::ZERO, self.cells.size());
        let low = place.floor().min(self.cells.size() - 1.0);
        let share = place - low;
        let [sw, se, ne, nw] = self.corner_heights((low.x as usize, low.y as usize));
        if share.x >= share.y {
            sw + (se - sw) * share.x + (ne - se) * share.y
        } else {
            sw + (nw - sw) * share.y + (ne - nw) * share.x
        }
    }

    fn corner_heights(&self, cell: (usize, usize)) -> [f64; 4] {
        self.cells.corners(cell).map(|post| self.heights[post])
    }

    /// Which way is up at a place: smooth over cells.
    fn normal(&self, p: Vec2) -> DVec3 {
        let step = Vec2::splat(self.cells.step_m());
        let slope = |d: Vec2| (self.height_m(p + d) - self.height_m(p - d)) / (2.0 * d.length());
        let (x, y) = (slope(step * Vec2::X), slope(step * Vec2::Y));
        // The model's z points south.
        DVec3::new(-x, 1.0, y) / trig::hypot(1.0, trig::hypot(x, y))
    }

    fn heights_in(&self, polygon: &Polygon) -> Vec<f64> {
        let mut inside = Vec::new();
        for (cell, kind) in self.cells.of(polygon) {
            let [post, ..] = self.cells.corners(cell);
            let at = exurb_geom::GridPoint::round(self.cells.post(post));
            if kind == Cell::Inside || polygon.contains(at) {
                inside.push(self.heights[post]);
            }
        }
        inside
    }

    fn vertex(&self, mesh: &mut Mesh, axes: Axes, p: Vec2, over_m: f64, color: Linear) -> u32 {
        mesh.vertex(axes.place(p, self.height_m(p) + over_m), self.normal(p), color)
    }

    /// The pieces of a convex polygon in the cells that `wanted` accepts.
    fn lay_convex(
        &self,
        mesh: &mut Mesh,
        axes: Axes,
        corners: &[Vec2],
        over_m: f64,
        color: Linear,
        wanted: impl Fn((usize, usize)) -> bool,
    ) {
        let places: Vec<Vec2> = corners.iter().map(|p| self.cells.place(*p)).collect();
        let low = places.iter().copied().fold(Vec2::INFINITY, Vec2::min);
        let high = places.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
        let range = |low: f64, high: f64, count: f64| {
            low.floor().clamp(0.0, count) as usize..high.ceil().clamp(0.0, count) as usize
        };
        let size = self.cells.size();
        for column in range(low.x, high.x, size.x) {
            let x = column as f64;
            let strip = clip(&clip(&places, |p| p.x - x), |p| x + 1.0 - p.x);
            for row in range(low.y, high.y, size.y) {
                if strip.len() < 3 || !wanted((column, row)) {
                    continue;
                }
                let y = row as f64;
                let piece = clip(&clip(&strip, |p| p.y - y), |p| y + 1.0 - p.y);
                let east = |p: Vec2| (p.x - x) - (p.y - y);
                for half in [clip(&piece, east), clip(&piece, |p| -east(p))] {
                    self.fan(mesh, axes, &half, over_m, color);
                }
            }
        }
    }

    /// A convex piece inside one triangle of the grid.
    fn fan(&self, mesh: &mut Mesh, axes: Axes, places: &[Vec2], over_m: f64, color: Linear) {
        let area = |a: Vec2, b: Vec2, c: Vec2| (b - a).perp_dot(c - a);
        let whole: f64 = (2..places.len()).map(|i| area(places[0], places[i - 1], places[i])).sum();
        // Slivers of a square centimetre or so show nowhere.
        if whole * self.cells.step_m() * self.cells.step_m() < 1e-4 {
            return;
        }
        let first = mesh.positions.len() as u32;
        for place in places {
            self.vertex(mesh, axes, self.cells.back(*place), over_m, color);
        }
        for i in 1..places.len() as u32 - 1 {
            mesh.indices.extend([first, first + i, first + i + 1]);
        }
    }
}

/// The part of a convex polygon where `side` is not negative.
fn clip(corners: &[Vec2], side: impl Fn(Vec2) -> f64) -> Vec<Vec2> {
    let mut out = Vec::with_capacity(corners.len() + 1);
    for (i, p) in corners.iter().enumerate() {
        let q = corners[(i + 1) % corners.len()];
        let (s, t) = (side(*p), side(q));
        if s >= 0.0 {
            out.push(*p);
        }
        if (s > 0.0 && t < 0.0) || (s < 0.0 && t > 0.0) {
            out.push(p.lerp(q, s / (s - t)));
        }
    }
    out
}
