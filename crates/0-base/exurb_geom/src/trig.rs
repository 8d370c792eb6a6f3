//! Trigonometry that gives the same bits on every machine (by `libm`); the platform's own functions
//! are forbidden by `clippy.toml`, because one differing bit can turn one city into another.

use crate::Vec2;

pub use libm::{acos, asin, atan, atan2, cos, erfc, exp, hypot, log as ln, log10, pow, sin, tan};

/// The direction `angle_rad` from east, counter-clockwise, as a unit vector.
pub fn unit(angle_rad: f64) -> Vec2 {
    Vec2::new(cos(angle_rad), sin(angle_rad))
}

/// The angle of `v` from east, counter-clockwise, in (-π, π].
pub fn angle(v: Vec2) -> f64 {
    atan2(v.y, v.x)
}

/// `angle_rad` brought into (-π, π].
pub fn wrap(angle_rad: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    let turned = (angle_rad + PI).rem_euclid(TAU) - PI;
    if turned == -PI { PI } else { turned }
}

/// The unsigned angle between `u` and `v` in `0..=π`; 0 when one of them is zero.
pub fn angle_between(u: Vec2, v: Vec2) -> f64 {
    atan2(u.perp_dot(v).abs(), u.dot(v))
}

/// `v` turned by `angle_rad` counter-clockwise.
pub fn rotate(v: Vec2, angle_rad: f64) -> Vec2 {
    unit(angle_rad).rotate(v)
}
