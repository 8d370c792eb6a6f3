//! Uneven ground: grass and fields are not of one colour.

use glam::{Vec2, Vec3};

/// Size of patches in metres, and how much lighter or darker they are.
const OCTAVES: [(f32, f32); 4] = [(170.0, 0.10), (47.0, 0.08), (13.0, 0.06), (3.7, 0.05)];
/// How far dry patches turn to yellow.
const DRY: Vec3 = Vec3::new(1.08, 1.0, 0.86);

/// The colour of growing things at a place of the ground; others stay as they are. Patches smaller
/// than `sample_m`, what a sample covers, are left out: they would flicker.
pub fn uneven(albedo: Vec3, at: Vec3, sample_m: f32) -> Vec3 {
    if !(albedo.y > albedo.x && albedo.y > 1.15 * albedo.z) {
        return albedo;
    }
    let place = Vec2::new(at.x, at.z);
    let mut light = 0.0;
    for (size_m, share) in OCTAVES {
        let seen = (size_m / (2.0 * sample_m) - 0.5).clamp(0.0, 1.0);
        if seen > 0.0 {
            light += seen * share * noise(place / size_m);
        }
    }
    let dry = (0.5 + 0.5 * noise(place / 410.0 + 71.3)).clamp(0.0, 1.0);
    albedo * (1.0 + light) * Vec3::ONE.lerp(DRY, dry)
}

/// Woods in the open country, the denser the farther from the city (`outside_m`).
pub fn wooded(ground: Vec3, at: Vec3, outside_m: f32) -> Vec3 {
    const WOOD: Vec3 = Vec3::new(0.34, 0.46, 0.30);
    let place = Vec2::new(at.x, at.z);
    let hills = noise(place / 640.0 + 17.7) + 0.45 * noise(place / 190.0 + 5.1);
    let wood = ((hills - 0.18) * 6.0).clamp(0.0, 1.0) * (outside_m / 300.0).clamp(0.0, 1.0);
    ground.lerp(ground * WOOD, wood)
}

/// Smooth between random values of whole places, -1 to 1.
fn noise(p: Vec2) -> f32 {
    let cell = p.floor();
    let t = p - cell;
    let smooth = t * t * (3.0 - 2.0 * t);
    let (x, y) = (cell.x as i32, cell.y as i32);
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    let low = mix(value(x, y), value(x.wrapping_add(1), y), smooth.x);
    let high =
        mix(value(x, y.wrapping_add(1)), value(x.wrapping_add(1), y.wrapping_add(1)), smooth.x);
    mix(low, high, smooth.y)
}

/// A value of a whole place, -1 to 1.
fn value(x: i32, y: i32) -> f32 {
    let id = (x as u32).wrapping_mul(0x9e37_79b1) ^ (y as u32).wrapping_mul(0x85eb_ca77);
    crate::palette::dice(id, 31) as f32 / (u32::MAX as f32 / 2.0) - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grass_varies_a_little_and_asphalt_not_at_all() {
        let (grass, asphalt) = (Vec3::new(0.2, 0.3, 0.1), Vec3::splat(0.1));
        let mut lightest = 0.0f32;
        for i in 0..200 {
            let at = Vec3::new(i as f32 * 7.0, 0.0, i as f32 * -3.0);
            assert_eq!(uneven(asphalt, at, 0.5), asphalt);
            let factor = uneven(grass, at, 0.5).y / grass.y;
            assert!((0.7..1.3).contains(&factor), "{factor}");
            lightest = lightest.max(factor);
        }
        assert!(lightest > 1.05);
        // From far away nothing but the largest patches is left.
        let far = |x: f32| uneven(grass, Vec3::new(x, 0.0, 0.0), 1e4).y;
        assert!((far(0.0) / far(3.0) - 1.0).abs() < 0.01);
    }
}
