//! The colour of what a sample sees.

use glam::Vec3;

use super::camera::Camera;
use super::light::Light;
use super::meadow;
use super::raster::NOTHING;
use super::surface::Surfaces;
use super::texture::Texture;
use crate::palette::{self, to_srgb};
use crate::scene::{Material, Scene};

const SUN: Vec3 = Vec3::new(2.75, 2.5, 2.1);
const SKY: Vec3 = Vec3::new(0.62, 0.74, 0.95);
const BOUNCE: Vec3 = Vec3::new(0.36, 0.34, 0.3);
const ZENITH: Vec3 = Vec3::new(0.34, 0.62, 1.15);
const HAZE: Vec3 = Vec3::new(1.2, 1.36, 1.54);

/// What faces up below this height is ground, no roof, in metres.
const GROUND_TOP_M: f32 = 0.3;

/// All that decides on colours.
pub struct Shader<'a> {
    surfaces: &'a Surfaces<'a>,
    camera: &'a Camera,
    light: &'a Light,
    windows: Option<Texture>,
    glass: Option<Texture>,
    ground: Vec3,
    /// Distance at which haze takes half.
    haze_m: f32,
    /// Height of the open country around.
    plane_m: f32,
    /// Is it water?
    sea_around: bool,
}

impl<'a> Shader<'a> {
    /// A shader for the surfaces of `scene`.
    pub fn new(
        scene: &Scene,
        surfaces: &'a Surfaces<'a>,
        camera: &'a Camera,
        light: &'a Light,
    ) -> Self {
        let [r, g, b, _] = palette::linear(palette::GROUND).map(|v| f32::from(v) / 255.0);
        let size_m = (surfaces.high - surfaces.low).length().max(500.0);
        let to_middle_m = camera.eye.length();
        Self {
            surfaces,
            camera,
            light,
            windows: Texture::of(Material::Windows),
            glass: Texture::of(Material::Glass),
            ground: Vec3::new(r, g, b),
            haze_m: (to_middle_m + size_m) * 1.8,
            plane_m: scene.lowest_m as f32,
            sea_around: scene.by_the_sea,
        }
    }

    /// Linear light of a triangle, or of ground and sky, at a sample.
    pub fn color(&self, triangle: u32, place: [usize; 2], nearness: f32) -> Vec3 {
        let ray = self.camera.ray(place);
        if triangle == NOTHING {
            return self.beyond(ray);
        }
        let distance_m = 1.0 / nearness;
        let at = self.camera.eye + ray * distance_m;
        let found = self.surfaces.triangle(triangle);
        let shares = found.shares(at);
        let normal = found.normal(shares);
        let mut albedo = found.color(shares);
        let texture = match found.material() {
            Material::Windows => self.windows.as_ref(),
            Material::Glass => self.glass.as_ref(),
            Material::Plain | Material::Water => None,
        };
        if let Some(texture) = texture {
            let (uv, per_m) = found.uv(shares);
            // Two samples of a pixel, and more along a wall that is seen at an angle.
            let slant = (normal.dot(ray.normalize()).abs()).max(0.2);
            let patch_m = self.camera.sample_m(distance_m) * 1.6 / slant.sqrt();
            albedo *= texture.at(uv, per_m * patch_m);
        }
        if normal.y > 0.9 && at.y < GROUND_TOP_M {
            albedo = meadow::uneven(albedo, at, self.camera.sample_m(distance_m));
        }
        let lit = if found.material() == Material::Water {
            self.water(albedo, at, ray)
        } else {
            self.matt(albedo, at, normal)
        };
        self.hazy(lit, distance_m * ray.length(), ray)
    }

    fn matt(&self, albedo: Vec3, at: Vec3, normal: Vec3) -> Vec3 {
        let facing = normal.dot(self.light.sun).max(0.0);
        let sun = if facing > 0.0 { facing * self.light.sun_at(at, normal) } else { 0.0 };
        let open = self.light.sky_at(at, normal);
        let up = 0.5 + 0.5 * normal.y;
        let sky = (BOUNCE * (1.0 - up) + SKY * up) * (0.15 + 0.85 * open * open);
        albedo * (SUN * sun + sky)
    }

    /// Mirrors the sky, the more the flatter one looks.
    fn water(&self, albedo: Vec3, at: Vec3, ray: Vec3) -> Vec3 {
        let view = ray.normalize();
        let mirrored = Vec3::new(view.x, -view.y, view.z);
        let grazing = 1.0 - (-view.y).clamp(0.0, 1.0);
        let share = 0.06 + 0.74 * grazing * grazing * grazing;
        let deep = albedo * (SUN * 0.3 + SKY) * (0.35 + 0.65 * self.light.sun_at(at, Vec3::Y));
        deep.lerp(sky(mirrored), share)
    }

    /// Open country up to the horizon, and the sky.
    fn beyond(&self, ray: Vec3) -> Vec3 {
        if ray.y >= -1e-4 {
            return sky(ray.normalize());
        }
        let distance = (self.camera.eye.y - self.plane_m) / -ray.y;
        let at = self.camera.eye + ray * distance;
        if self.sea_around {
            let [r, g, b, _] = palette::linear(palette::WATER).map(|v| f32::from(v) / 255.0);
            let lit = self.water(Vec3::new(r, g, b), at, ray);
            return self.hazy(lit, distance * ray.length(), ray);
        }
        let outside = (self.surfaces.low - at).max(at - self.surfaces.high).max(Vec3::ZERO);
        let ground = meadow::uneven(self.ground, at, self.camera.sample_m(distance));
        let ground = meadow::wooded(ground, at, outside.x.max(outside.z));
        let lit = ground * (SUN * self.light.sun.y + SKY);
        self.hazy(lit, distance * ray.length(), ray)
    }

    fn hazy(&self, color: Vec3, distance_m: f32, ray: Vec3) -> Vec3 {
        let ratio = distance_m / self.haze_m;
        let share = ratio * ratio / (1.0 + ratio * ratio);
        let flat = ray.normalize();
        color.lerp(sky(Vec3::new(flat.x, flat.y.max(0.0), flat.z)), share)
    }
}

/// The sky in a direction of length 1.
fn sky(ray: Vec3) -> Vec3 {
    let up = ray.y.clamp(0.0, 1.0);
    let share = 1.0 - (1.0 - up) * (1.0 - up) * (1.0 - up);
    HAZE.lerp(ZENITH, share)
}

/// Linear light → screen values, from a table.
pub struct Screen {
    values: Vec<u8>,
}

impl Screen {
    pub fn new() -> Self {
        const STEPS: u32 = 4096;
        let value = |i: u32| to_srgb(f64::from(i) / f64::from(STEPS - 1)) * 255.0;
        Self { values: (0..STEPS).map(|i| value(i).round() as u8).collect() }
    }

    /// Highlights roll off, shadows stay.
    pub fn of(&self, light: Vec3) -> [u8; 3] {
        let exposed = light * 0.8;
        let rolled = exposed * (Vec3::ONE + exposed / 6.0) / (Vec3::ONE + exposed);
        // What rolling off takes from colours and darks comes back.
        let grey = Vec3::splat(rolled.dot(Vec3::new(0.21, 0.72, 0.07)));
        let vivid = grey + (rolled - grey) * 1.1;
        let toned = vivid * (Vec3::splat(0.82) + vivid * 0.3);
        let last = (self.values.len() - 1) as f32;
        let index = (toned.clamp(Vec3::ZERO, Vec3::ONE) * last).to_array();
        index.map(|v| self.values[(v + 0.5) as usize])
    }
}
