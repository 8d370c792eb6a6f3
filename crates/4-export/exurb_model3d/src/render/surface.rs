//! All triangles of a scene under one number each.

use glam::{Vec2, Vec3};

use crate::palette::Linear;
use crate::scene::{Material, Part, Scene};

/// The parts of a scene, their triangles numbered through.
pub struct Surfaces<'a> {
    pub parts: Vec<&'a Part>,
    /// Number of the first triangle of each part, and of one past the last.
    first: Vec<u32>,
    /// Lowest and highest corner of what stands in the scene.
    pub low: Vec3,
    pub high: Vec3,
}

/// A triangle with what shading asks for.
pub struct Triangle<'a> {
    pub corners: [Vec3; 3],
    part: &'a Part,
    indices: [usize; 3],
}

impl<'a> Surfaces<'a> {
    pub fn of(scene: &'a Scene) -> Self {
        let parts: Vec<&Part> = scene.layers.iter().flat_map(|l| &l.parts).collect();
        let mut first = vec![0];
        let (mut low, mut high) = (Vec3::ZERO, Vec3::ZERO);
        let mut count = 0;
        for part in &parts {
            count += part.mesh.triangle_count() as u32;
            first.push(count);
            for p in &part.mesh.positions {
                low = low.min(Vec3::from(*p));
                high = high.max(Vec3::from(*p));
            }
        }
        Self { parts, first, low, high }
    }

    pub fn first_of(&self, part: usize) -> u32 {
        self.first[part]
    }

    pub fn triangle(&self, number: u32) -> Triangle<'a> {
        let k = self.first.partition_point(|f| *f <= number) - 1;
        let part = self.parts[k];
        let at = (number - self.first[k]) as usize * 3;
        let indices = [0, 1, 2].map(|i| part.mesh.indices[at + i] as usize);
        let corners = indices.map(|i| Vec3::from(part.mesh.positions[i]));
        Triangle { corners, part, indices }
    }
}

impl Triangle<'_> {
    pub fn material(&self) -> Material {
        self.part.material
    }

    /// Shares of the corners in a point of the triangle's plane, none below 0.
    pub fn shares(&self, at: Vec3) -> [f32; 3] {
        let [a, b, c] = self.corners;
        let (u, v, p) = (b - a, c - a, at - a);
        let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
        let (pu, pv) = (p.dot(u), p.dot(v));
        let area = (uu * vv - uv * uv).max(1e-12);
        let s = ((vv * pu - uv * pv) / area).clamp(0.0, 1.0);
        let t = ((uu * pv - uv * pu) / area).clamp(0.0, 1.0);
        [(1.0 - s - t).max(0.0), s, t]
    }

    pub fn normal(&self, shares: [f32; 3]) -> Vec3 {
        let n = |k: usize| Vec3::from(self.part.mesh.normals[self.indices[k]]) * shares[k];
        (n(0) + n(1) + n(2)).normalize_or(Vec3::Y)
    }

    /// Linear colour.
    pub fn color(&self, shares: [f32; 3]) -> Vec3 {
        let c = |k: usize| {
            let [r, g, b, _]: Linear = self.part.mesh.colors[self.indices[k]];
            Vec3::new(f32::from(r), f32::from(g), f32::from(b)) * (shares[k] / 255.0)
        };
        c(0) + c(1) + c(2)
    }

    /// Place in the texture, and how far it moves for each metre.
    pub fn uv(&self, shares: [f32; 3]) -> (Vec2, f32) {
        let uv = self.indices.map(|i| Vec2::from(self.part.mesh.uvs[i]));
        let at = uv[0] * shares[0] + uv[1] * shares[1] + uv[2] * shares[2];
        let moved = (uv[1] - uv[0]).perp_dot(uv[2] - uv[0]).abs();
        let [a, b, c] = self.corners;
        let area = (b - a).cross(c - a).length().max(1e-6);
        (at, (moved / area).sqrt())
    }
}
