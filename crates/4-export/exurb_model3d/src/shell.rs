//! A building as a closed shell: floor, walls, roof.

use exurb_geom::{Polygon, Vec2};
use glam::DVec3;

use crate::facade::BAYS;
use crate::mesh::{Axes, Facing, Mesh};
use crate::palette::Linear;
use crate::roof::Top;

/// Width of a bay and height of a storey, in metres: what one window takes.
const BAY_M: f64 = 3.0;
const STOREY_M: f64 = 3.0;
/// Walls shorter than this have no window.
const LEAST_WALL_M: f64 = 2.2;

/// What a building is made of.
pub struct Body<'a> {
    pub axes: Axes,
    pub polygon: &'a Polygon,
    /// Where the walls begin.
    pub base_m: f64,
    pub top: &'a Top,
    pub wall: Linear,
    pub roof: Linear,
    /// Chooses the first bay of the texture, so that neighbours differ.
    pub dice: u32,
}

impl Body<'_> {
    /// The walls up to the eaves, into a mesh with a texture or without.
    pub fn walls(&self, mesh: &mut Mesh, textured: bool) {
        for (a, b) in self.polygon.segments() {
            let (a, b) = (a.to_m(), b.to_m());
            let (top_a, top_b) = (self.top.eaves_m(a), self.top.eaves_m(b));
            let p = |q: Vec2, h: f64| self.axes.place(q, h);
            let corners = [p(a, self.base_m), p(b, self.base_m), p(b, top_b), p(a, top_a)];
            if textured {
                mesh.textured(&corners, &self.bays(a.distance(b), top_a, top_b), self.wall);
            } else {
                mesh.convex(&corners, self.wall);
            }
        }
        for gable in self.top.faces.iter().filter(|face| face.is_gable) {
            let corners: Vec<DVec3> =
                gable.corners.iter().map(|(q, h)| self.axes.place(*q, *h)).collect();
            let uvs = vec![[0.0, 0.0]; if textured { corners.len() } else { 0 }];
            add_triangles(mesh, &corners, &gable.triangles, self.wall);
            mesh.uvs.extend(uvs);
        }
    }

    /// Floor and roof.
    pub fn caps(&self, mesh: &mut Mesh) {
        mesh.horizontal(self.axes, self.polygon, self.base_m, self.wall, Facing::Down);
        if self.top.faces.is_empty() {
            let height = |p: Vec2| self.top.eaves_m(p);
            mesh.draped(self.axes, self.polygon, height, self.roof, Facing::Up);
            return;
        }
        for face in self.top.faces.iter().filter(|face| !face.is_gable) {
            let corners: Vec<DVec3> =
                face.corners.iter().map(|(q, h)| self.axes.place(*q, *h)).collect();
            add_triangles(mesh, &corners, &face.triangles, self.roof);
        }
    }

    /// Whole bays and whole storeys for the four corners of a wall; a pillar's width of wall when
    /// there is no room for a window.
    fn bays(&self, length_m: f64, top_a: f64, top_b: f64) -> [[f32; 2]; 4] {
        let scale = BAYS as f64;
        let bays = if length_m < LEAST_WALL_M { 0.0 } else { (length_m / BAY_M).round().max(1.0) };
        let least_top = top_a.min(top_b);
        let storeys = ((least_top - self.base_m) / STOREY_M).round().max(1.0);
        let storey_m = ((least_top - self.base_m) / storeys).max(0.1);
        let u0 = f64::from(self.dice % 4) / scale;
        let v0 = f64::from(self.dice / 4 % 4) / scale;
        let u1 = u0 + bays / scale;
        let v = |top: f64| v0 + (least_top - top) / storey_m / scale;
        let bottom = v(self.base_m);
        [[u0, bottom], [u1, bottom], [u1, v(top_b)], [u0, v(top_a)]].map(|uv| uv.map(|c| c as f32))
    }
}

/// A flat face with its own triangles.
fn add_triangles(mesh: &mut Mesh, corners: &[DVec3], triangles: &[[u32; 3]], color: Linear) {
    let normal = crate::mesh::normal_of(corners);
    let first = mesh.positions.len() as u32;
    for corner in corners {
        mesh.vertex(*corner, normal, color);
    }
    for t in triangles {
        mesh.indices.extend(t.map(|i| i + first));
    }
}
