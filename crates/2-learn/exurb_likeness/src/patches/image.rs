//! Streets as a picture of 8 m a pixel.

use exurb_geom::{Vec2, trig};
use exurb_measure::Network;

/// Metres a pixel.
const PIXEL_M: f64 = 8.0;
/// Standard deviation of the blur in pixels, and how far it reaches.
const BLUR_PX: f64 = 0.8;
const BLUR_REACH: usize = 3;

/// A grey picture, rows from south to north; 0 = nothing, 1 = street.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Pixels from west to east.
    pub width: usize,
    /// Pixels from south to north.
    pub height: usize,
    /// Row by row.
    pub pixels: Vec<f32>,
}

impl Image {
    /// Draws the streets of a network, one pixel wide and blurred. `None` where the window is
    /// smaller than a patch.
    pub fn draw(network: &Network) -> Option<Self> {
        let size = network.window.size() / PIXEL_M;
        let (width, height) = (size.x.round() as usize, size.y.round() as usize);
        if width < super::features::SIDE || height < super::features::SIDE {
            return None;
        }
        let mut image = Self { width, height, pixels: vec![0.0; width * height] };
        // A quarter of a pixel a step leaves no gap.
        for (a, b) in network.straight_pieces(PIXEL_M / 4.0) {
            image.mark((a - network.window.min) / PIXEL_M);
            image.mark((b - network.window.min) / PIXEL_M);
        }
        Some(image.blurred())
    }

    fn mark(&mut self, at: Vec2) {
        let (x, y) = (at.x.max(0.0) as usize, at.y.max(0.0) as usize);
        if x < self.width && y < self.height {
            self.pixels[y * self.width + x] = 1.0;
        }
    }

    /// Blurred along both axes, as if nothing lay outside but what lies on the border.
    fn blurred(&self) -> Self {
        let weight = |i: usize| {
            let d = i as f64 - BLUR_REACH as f64;
            trig::exp(-d * d / (2.0 * BLUR_PX * BLUR_PX))
        };
        let weights: Vec<f64> = (0..=2 * BLUR_REACH).map(weight).collect();
        let total: f64 = weights.iter().sum();
        let weights: Vec<f32> = weights.iter().map(|w| (w / total) as f32).collect();
        let blur = |along_x: bool, from: &Self| {
            let mut pixels = Vec::with_capacity(from.pixels.len());
            for y in 0..from.height {
                for x in 0..from.width {
                    let at = |i: usize| {
                        let moved = |v: usize, most: usize| {
                            (v + i).saturating_sub(BLUR_REACH).min(most - 1)
                        };
                        match along_x {
                            true => from.pixels[y * from.width + moved(x, from.width)],
                            false => from.pixels[moved(y, from.height) * from.width + x],
                        }
                    };
                    pixels.push(weights.iter().enumerate().map(|(i, w)| w * at(i)).sum());
                }
            }
            Self { pixels, ..*from }
        };
        blur(false, &blur(true, self))
    }

    /// Means of 3 x 3 pixels; what does not fill three is left out.
    pub fn coarse(&self) -> Self {
        let (width, height) = (self.width / 3, self.height / 3);
        let mut pixels = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                let sum: f32 =
                    (0..9).map(|i| self.pixels[(3 * y + i / 3) * self.width + 3 * x + i % 3]).sum();
                pixels.push(sum / 9.0);
            }
        }
        Self { width, height, pixels }
    }
}
