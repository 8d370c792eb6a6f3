//! Sun and sky: a shadow map, and how much sky each place sees.

use exurb_geom::trig;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::View;
use super::camera::{Camera, Lens, compass};
use super::raster::Bands;
use super::surface::Surfaces;

/// Most samples along the sides of the shadow map.
const SHADOW_SIZE: u32 = 4096;
/// Samples along the sides of the map of heights.
const SKY_SIZE: usize = 1024;
const ROWS_PER_BAND: usize = 64;

/// What lights the city.
pub struct Light {
    /// Towards the sun.
    pub sun: Vec3,
    shadow: Map,
    sky: Map,
}

/// Values over the model, seen along one direction.
struct Map {
    camera: Camera,
    values: Vec<f32>,
}

impl Light {
    pub fn of(surfaces: &Surfaces, view: &View) -> Self {
        let elevation = view.sun_elevation_deg.clamp(5.0, 90.0).to_radians();
        let sun =
            compass(view.sun_azimuth_deg) * trig::cos(elevation) + DVec3::Y * trig::sin(elevation);
        // Finer than the picture would not show.
        let shadow_size = (view.width_px.max(view.height_px) * 3).clamp(512, SHADOW_SIZE);
        let (shadow, sky) = rayon::join(
            || Map::depth(surfaces, -sun, shadow_size as usize),
            || Map::depth(surfaces, DVec3::NEG_Y, SKY_SIZE).sky(),
        );
        Self { sun: sun.as_vec3(), shadow, sky }
    }

    /// Share of the sun that reaches a place, 0 to 1.
    pub fn sun_at(&self, p: Vec3, normal: Vec3) -> f32 {
        let step_m = self.shadow.camera.sample_m(0.0);
        // Off the surface, so that it does not shade itself.
        let seen = self.shadow.camera.seen(p + normal * (1.2 * step_m) + self.sun * (0.6 * step_m));
        let [x, y, nearness] = self.shadow.camera.place(seen);
        self.shadow.soft(x, y, |occluder| if occluder > nearness { 0.0 } else { 1.0 })
    }

    /// Share of the sky that a place sees, 0 to 1.
    pub fn sky_at(&self, p: Vec3, normal: Vec3) -> f32 {
        // Walls ask in front of them.
        let aside = Vec3::new(normal.x, 0.0, normal.z) * 2.5;
        let [x, y, _] = self.sky.camera.place(self.sky.camera.seen(p + aside));
        let open = self.sky.soft(x, y, |v| v);
        // Up the wall the houses across take less of the sky.
        let up = if normal.y < 0.5 { (p.y / 24.0).clamp(0.0, 1.0) } else { 0.0 };
        open + (1.0 - open) * up
    }
}

impl Map {
    /// Nearness over the whole scene along a direction.
    fn depth(surfaces: &Surfaces, along: DVec3, size: usize) -> Self {
        let (low, high) = (surfaces.low, surfaces.high);
        let middle = (low + high) / 2.0;
        let radius_m = ((high - low).length() / 2.0).max(1.0);
        let eye = middle.as_dvec3() - along * f64::from(radius_m) * 2.0;
        let unit = Lens::Parallel { half_x: radius_m, half_y: radius_m };
        let mut camera = Camera::looking(eye, along, unit, size, size);
        let (mut half_x, mut half_y) = (1.0_f32, 1.0_f32);
        for k in 0..8 {
            let pick = |bit: usize, l: f32, h: f32| if k >> bit & 1 == 0 { l } else { h };
            let corner =
                Vec3::new(pick(0, low.x, high.x), pick(1, low.y, high.y), pick(2, low.z, high.z));
            let seen = camera.seen(corner);
            half_x = half_x.max(seen.x.abs());
            half_y = half_y.max(seen.y.abs());
        }
        camera.lens = Lens::Parallel { half_x: half_x * 1.01, half_y: half_y * 1.01 };
        let bands = Bands::of(surfaces, &camera, ROWS_PER_BAND);
        let rows: Vec<Vec<f32>> =
            (0..bands.count()).into_par_iter().map(|band| bands.draw_depth(band)).collect();
        Self { camera, values: rows.concat() }
    }

    /// From heights to how much sky they leave each other: along eight directions the steepest
    /// rise within some steps, a place seeing the part of the sky above.
    fn sky(self) -> Self {
        const DIRECTIONS: [[i32; 2]; 8] =
            [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];
        const STEPS_M: [f32; 4] = [2.5, 7.0, 16.0, 34.0];
        let size = self.camera.width as i32;
        let Lens::Parallel { half_x, half_y } = self.camera.lens else { return self };
        let cell_m = [2.0 * half_x / size as f32, 2.0 * half_y / size as f32];
        // Steps in cells, with their lengths; in eight directions all lengths are about the same.
        let steps: Vec<Vec<(i32, i32, f32)>> = DIRECTIONS
            .iter()
            .map(|[dx, dy]| {
                let diagonal = dx * dy != 0;
                let share = if diagonal { std::f32::consts::FRAC_1_SQRT_2 } else { 1.0 };
                let cells = |step_m: f32, k: usize| (step_m * share / cell_m[k]).round() as i32;
                let step = |m: &f32| (cells(*m, 0) * dx, cells(*m, 1) * dy, *m);
                STEPS_M.iter().map(step).filter(|(x, y, _)| (*x, *y) != (0, 0)).collect()
            })
            .collect();
        let at = |x: i32, y: i32| {
            let (x, y) = (x.clamp(0, size - 1), y.clamp(0, size - 1));
            self.values[(y * size + x) as usize]
        };
        let open = |i: i32| {
            let (x, y) = (i % size, i / size);
            let here = at(x, y);
            let seen = steps.iter().map(|steps| {
                let rises = steps.iter().map(|(dx, dy, m)| (at(x + dx, y + dy) - here) / m);
                let steepest = rises.fold(0.0, f32::max);
                1.0 / (1.0 + steepest * steepest)
            });
            seen.sum::<f32>() / DIRECTIONS.len() as f32
        };
        let values = (0..size * size).into_par_iter().map(open).collect();
        Self { camera: self.camera, values }
    }

    /// `value` of the four nearest samples, by distance; 1 outside.
    fn soft(&self, x: f32, y: f32, value: impl Fn(f32) -> f32) -> f32 {
        let size = self.camera.width as f32;
        let (x, y) = (x - 0.5, y - 0.5);
        if !(x >= 0.0 && y >= 0.0 && x < size - 1.0 && y < size - 1.0) {
            return 1.0;
        }
        let (fx, fy) = (x.fract(), y.fract());
        let i = y as usize * self.camera.width + x as usize;
        let below = i + self.camera.width;
        let v = |i: usize| value(self.values[i]);
        let top = v(i) * (1.0 - fx) + v(i + 1) * fx;
        let bottom = v(below) * (1.0 - fx) + v(below + 1) * fx;
        top * (1.0 - fy) + bottom * fy
    }
}
