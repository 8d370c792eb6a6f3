//! From the model to rows and columns of samples.

use exurb_city::City;
use exurb_geom::trig;
use glam::{DVec3, Vec3};

use super::View;
use crate::scene::Scene;

/// Nothing nearer than this is drawn, in metres.
pub const NEAR_M: f32 = 1.0;

/// A view of the model onto a grid of samples.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    pub eye: Vec3,
    pub right: Vec3,
    pub up: Vec3,
    pub forward: Vec3,
    pub lens: Lens,
    /// Samples.
    pub width: usize,
    pub height: usize,
}

/// How depth changes size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Tangents of half the angles of view.
    Perspective { tan_x: f32, tan_y: f32 },
    /// Half of what is shown, in metres.
    Parallel { half_x: f32, half_y: f32 },
}

impl Camera {
    /// Looks over the middle of the city so that it fills the frame.
    pub fn over_city(city: &City, scene: &Scene, view: &View, samples: u32) -> Self {
        let (width, height) = (view.width_px * samples, view.height_px * samples);
        let radians = |deg: f64, low: f64, high: f64| deg.clamp(low, high).to_radians();
        let elevation = radians(view.elevation_deg, 2.0, 89.0);
        let tan_y = trig::tan(radians(view.field_of_view_deg, 5.0, 100.0) / 2.0);
        let tan_x = tan_y * f64::from(width) / f64::from(height);
        let azimuth = compass(view.azimuth_deg);
        let away = azimuth * trig::cos(elevation) + DVec3::Y * trig::sin(elevation);

        let bounds = city.target.bounds();
        let middle = bounds.center() - scene.center;
        // Half of what the frame shows across, at the middle: so much that hardly anything but city
        // is in it.
        let size = bounds.size();
        let half_m = (size.x * size.y).sqrt() * 0.335 / view.zoom.clamp(0.1, 100.0);
        let distance_m = (half_m / tan_x.max(tan_y)).max(20.0);
        // A little in front of the middle: what is near takes more of the picture.
        let ahead = azimuth * (half_m * 0.08);
        let look_at = DVec3::new(middle.x, 0.0, -middle.y) + ahead;
        let lens = Lens::Perspective { tan_x: tan_x as f32, tan_y: tan_y as f32 };
        Self::looking(look_at + away * distance_m, -away, lens, width as usize, height as usize)
    }

    /// At `eye`, along `forward`.
    pub fn looking(eye: DVec3, forward: DVec3, lens: Lens, width: usize, height: usize) -> Self {
        let side = if forward.y.abs() > 0.999 { DVec3::NEG_Z } else { DVec3::Y };
        let right = forward.cross(side).normalize();
        let up = right.cross(forward);
        Self {
            eye: eye.as_vec3(),
            right: right.as_vec3(),
            up: up.as_vec3(),
            forward: forward.as_vec3(),
            lens,
            width,
            height,
        }
    }

    /// Metres right of, over, and in front of the eye.
    pub fn seen(&self, p: Vec3) -> Vec3 {
        let v = p - self.eye;
        Vec3::new(v.dot(self.right), v.dot(self.up), v.dot(self.forward))
    }

    /// Column, row and nearness, the larger the nearer and linear over the picture.
    pub fn place(&self, seen: Vec3) -> [f32; 3] {
        let (w, h) = (self.width as f32 / 2.0, self.height as f32 / 2.0);
        match self.lens {
            Lens::Perspective { tan_x, tan_y } => {
                let near = 1.0 / seen.z;
                [w + w * seen.x * near / tan_x, h - h * seen.y * near / tan_y, near]
            }
            Lens::Parallel { half_x, half_y } => {
                [w + w * seen.x / half_x, h - h * seen.y / half_y, -seen.z]
            }
        }
    }

    /// The ray through the middle of a sample, 1 m along the camera's axis.
    pub fn ray(&self, place: [usize; 2]) -> Vec3 {
        let Lens::Perspective { tan_x, tan_y } = self.lens else { return self.forward };
        let x = ((place[0] as f32 + 0.5) / self.width as f32 * 2.0 - 1.0) * tan_x;
        let y = (1.0 - (place[1] as f32 + 0.5) / self.height as f32 * 2.0) * tan_y;
        self.forward + self.right * x + self.up * y
    }

    /// Metres that a sample covers at a distance along the axis.
    pub fn sample_m(&self, distance_m: f32) -> f32 {
        match self.lens {
            Lens::Perspective { tan_y, .. } => 2.0 * tan_y * distance_m / self.height as f32,
            Lens::Parallel { half_y, .. } => 2.0 * half_y / self.height as f32,
        }
    }
}

/// The direction of a compass bearing, on the ground.
pub fn compass(degrees: f64) -> DVec3 {
    let angle = degrees.to_radians();
    DVec3::new(trig::sin(angle), 0.0, -trig::cos(angle))
}
