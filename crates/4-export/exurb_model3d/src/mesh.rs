//! Triangle meshes with the attributes that files and pictures need.

use exurb_geom::{Polygon, Vec2};
use glam::DVec3;

use crate::palette::Linear;

/// A triangle mesh in metres: x east, y up, z south. Triangles run counter-clockwise seen from
/// outside. Vertices carry one normal each, so sharp edges have their vertices twice.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Positions.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals.
    pub normals: Vec<[f32; 3]>,
    /// Places in the texture; empty in a mesh without.
    pub uvs: Vec<[f32; 2]>,
    /// Linear colours and opacity, 255 = 1.
    pub colors: Vec<Linear>,
    /// Three for each triangle.
    pub indices: Vec<u32>,
}

/// From the city's frame to the meshes' axes.
#[derive(Clone, Copy, Debug)]
pub struct Axes {
    /// What becomes (0, 0), in metres of the city's frame.
    pub center: Vec2,
    /// Added to heights: that of the ground under a building.
    pub lift_m: f64,
}

impl Axes {
    /// The same, with everything `lift_m` higher.
    pub fn lifted(self, lift_m: f64) -> Self {
        Self { lift_m, ..self }
    }

    /// The place over `p` at a height.
    pub fn place(&self, p: Vec2, height_m: f64) -> DVec3 {
        let q = p - self.center;
        DVec3::new(q.x, height_m + self.lift_m, -q.y)
    }
}

impl Mesh {
    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.indices.len() / 3
    }

    /// Appends another mesh of the same attributes.
    pub fn append(&mut self, other: &Self) {
        let first = self.positions.len() as u32;
        self.positions.extend(&other.positions);
        self.normals.extend(&other.normals);
        self.uvs.extend(&other.uvs);
        self.colors.extend(&other.colors);
        self.indices.extend(other.indices.iter().map(|i| i + first));
    }

    /// Adds a vertex and returns its number.
    pub fn vertex(&mut self, at: DVec3, normal: DVec3, color: Linear) -> u32 {
        self.positions.push(at.as_vec3().to_array());
        self.normals.push(normal.as_vec3().normalize_or(glam::Vec3::Y).to_array());
        self.colors.push(color);
        self.positions.len() as u32 - 1
    }

    /// Adds a flat polygon of at least three corners in one plane, convex, with one normal.
    pub fn convex(&mut self, corners: &[DVec3], color: Linear) {
        let normal = normal_of(corners);
        let first = self.positions.len() as u32;
        for corner in corners {
            self.vertex(*corner, normal, color);
        }
        for i in 1..corners.len() as u32 - 1 {
            self.indices.extend([first, first + i, first + i + 1]);
        }
    }

    /// [`Mesh::convex`] with a place in the texture for each corner.
    pub fn textured(&mut self, corners: &[DVec3], uvs: &[[f32; 2]], color: Linear) {
        self.convex(corners, color);
        self.uvs.extend(uvs);
    }

    /// Adds a horizontal polygon that looks up, or down.
    pub fn horizontal(
        &mut self,
        axes: Axes,
        polygon: &Polygon,
        height_m: f64,
        color: Linear,
        facing: Facing,
    ) {
        self.draped(axes, polygon, |_| height_m, color, facing);
    }

    /// Adds a polygon at a height of its own for each corner; all in one plane.
    pub fn draped(
        &mut self,
        axes: Axes,
        polygon: &Polygon,
        height_m: impl Fn(Vec2) -> f64,
        color: Linear,
        facing: Facing,
    ) {
        let (points, triangles) = triangles(polygon);
        let corners: Vec<DVec3> = points.iter().map(|p| axes.place(*p, height_m(*p))).collect();
        let Some(normal) = largest_normal(&corners, &triangles) else { return };
        let up = if facing == Facing::Up { normal } else { -normal };
        let first = self.positions.len() as u32;
        for corner in corners {
            self.vertex(corner, up, color);
        }
        for [a, b, c] in triangles {
            let (b, c) = if facing == Facing::Up { (b, c) } else { (c, b) };
            self.indices.extend([first + a, first + b, first + c]);
        }
    }

    /// Adds the upright strip under both sides of a ring's segment `a b`, outside on the right.
    pub fn wall(&mut self, axes: Axes, a: Vec2, b: Vec2, from_m: f64, to_m: f64, color: Linear) {
        let (a0, b0) = (axes.place(a, from_m), axes.place(b, from_m));
        self.convex(&[a0, b0, axes.place(b, to_m), axes.place(a, to_m)], color);
    }
}

/// The side a horizontal polygon shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facing {
    /// The sky sees it.
    Up,
    /// The ground sees it.
    Down,
}

/// Normal of a polygon in space, by Newell's sum.
pub fn normal_of(corners: &[DVec3]) -> DVec3 {
    let mut sum = DVec3::ZERO;
    for (i, a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        sum += (*a - corners[0]).cross(b - corners[0]);
    }
    sum.normalize_or(DVec3::Y)
}

fn largest_normal(corners: &[DVec3], triangles: &[[u32; 3]]) -> Option<DVec3> {
    let normal = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| corners[i as usize]);
        (b - a).cross(c - a)
    };
    let normals = triangles.iter().map(normal);
    normals.max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
}

/// The corners of a polygon in metres, and triangles between them, counter-clockwise.
pub fn triangles(polygon: &Polygon) -> (Vec<Vec2>, Vec<[u32; 3]>) {
    let points: Vec<Vec2> = polygon.rings().flatten().map(|p| p.to_m()).collect();
    let mut holes = Vec::with_capacity(polygon.interiors().len());
    let mut at = polygon.exterior().len();
    for ring in polygon.interiors() {
        holes.push(at as u32);
        at += ring.len();
    }
    let triangles = triangulate(&points, &holes);
    (points, triangles)
}

/// Triangles over rings, the first one outside, the others beginning at `holes`.
pub fn triangulate(points: &[Vec2], holes: &[u32]) -> Vec<[u32; 3]> {
    let mut flat: Vec<u32> = Vec::new();
    let mut earcut = earcut::Earcut::new();
    earcut.earcut(points.iter().map(|p| [p.x, p.y]), holes, &mut flat);
    let turned = |t: &[u32]| {
        let [a, b, c] = [t[0], t[1], t[2]];
        let [p, q, r] = [a, b, c].map(|i| points[i as usize]);
        if (q - p).perp_dot(r - p) >= 0.0 { [a, b, c] } else { [a, c, b] }
    };
    flat.chunks_exact(3).map(turned).collect()
}
