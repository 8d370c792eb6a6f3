//! Textures at every size, so that far facades do not glitter.

use glam::{Vec2, Vec3};

use crate::facade::{self, SIZE};
use crate::palette::from_srgb;
use crate::scene::Material;

/// A picture and its halves, linear light.
pub struct Texture {
    levels: Vec<Vec<Vec3>>,
}

impl Texture {
    pub fn of(material: Material) -> Option<Self> {
        let picture = facade::picture(material)?;
        let light: Vec<f32> = (0..256).map(|v| from_srgb(f64::from(v) / 255.0) as f32).collect();
        let linear = |p: &[u8; 3]| Vec3::from(p.map(|v| light[usize::from(v)]));
        let mut levels = vec![picture.pixels.iter().map(linear).collect::<Vec<_>>()];
        let mut size = SIZE;
        while size > 1 {
            let last = &levels[levels.len() - 1];
            let half = size / 2;
            let mean = |i: usize| {
                let (x, y) = (i % half * 2, i / half * 2);
                let at = |dx: usize, dy: usize| last[(y + dy) * size + x + dx];
                (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)) / 4.0
            };
            let next: Vec<Vec3> = (0..half * half).map(mean).collect();
            levels.push(next);
            size = half;
        }
        Some(Self { levels })
    }

    /// Colour at `uv`, of a patch `footprint` wide (1 = the whole picture).
    pub fn at(&self, uv: Vec2, footprint: f32) -> Vec3 {
        let texels = footprint * SIZE as f32;
        // Levels lie a factor of two apart: count the halvings, with a part of one for blending.
        let mut level = 0;
        let mut rest = texels;
        while rest >= 2.0 && level + 2 < self.levels.len() {
            rest /= 2.0;
            level += 1;
        }
        let blend = (rest - 1.0).clamp(0.0, 1.0);
        self.smooth(level, uv).lerp(self.smooth(level + 1, uv), blend)
    }

    fn smooth(&self, level: usize, uv: Vec2) -> Vec3 {
        let size = SIZE >> level;
        let wrap = |v: f32| (v - v.floor()) * size as f32 - 0.5;
        let (x, y) = (wrap(uv.x), wrap(uv.y));
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let mask = size - 1;
        let (x0, y0) = (x.floor() as i32 as usize & mask, y.floor() as i32 as usize & mask);
        let (x1, y1) = ((x0 + 1) & mask, (y0 + 1) & mask);
        let at = |x: usize, y: usize| self.levels[level][y * size + x];
        at(x0, y0).lerp(at(x1, y0), fx).lerp(at(x0, y1).lerp(at(x1, y1), fx), fy)
    }
}
