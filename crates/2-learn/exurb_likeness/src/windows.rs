//! Windows of equal size: which part of a city a comparison looks at.

use exurb_city::{City, Part, densest_square};
use exurb_geom::{Bounds, Vec2};

/// A city whose extent differs from the wanted size by no more than this share counts whole.
pub const SAME_SHARE: f64 = 0.02;

/// Both halves of a city's densest square.
pub fn halves(city: &City, [first, second]: [Part; 2]) -> [Bounds; 2] {
    let square = densest_square::of_city(city);
    [densest_square::half(square, first), densest_square::half(square, second)]
}

/// A window of that size around the middle of `bounds`, but not larger than `bounds`.
pub fn centred(bounds: Bounds, size: Vec2) -> Bounds {
    let half = size.min(bounds.size()) / 2.0;
    Bounds { min: bounds.center() - half, max: bounds.center() + half }
}

/// The window of a city in a comparison of windows of that size: all of it where it has about that
/// size, else a window around the middle of its densest square; smaller where the city is.
pub fn of_size(city: &City, size: Vec2) -> Bounds {
    let extent = city.target.bounds();
    let differs = (extent.size() - size).abs() / size;
    if differs.max_element() <= SAME_SHARE {
        return extent;
    }
    let middle = densest_square::of_city(city).center();
    // Moved inside, where the densest square lies at the border.
    let half = size.min(extent.size()) / 2.0;
    let center = middle.clamp(extent.min + half, extent.max - half);
    Bounds { min: center - half, max: center + half }
}
