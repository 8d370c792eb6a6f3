//! Trees as small crowns on trunks, lamps as posts.

use exurb_city::{Feature, FeatureShape};
use exurb_geom::{Vec2, polyline, trig};
use glam::DVec3;

use crate::ground::BLOCK_M;
use crate::mesh::Mesh;
use crate::palette::{LAMP, LAMP_HEAD, LEAVES, Linear, TRUNK, linear, pick, scaled, share};
use crate::scene::{Layer, Material, Part, Site};

/// Distance of the trees in a row.
const ROW_STEP_M: f64 = 8.0;

pub fn layers(site: &Site) -> Vec<Layer> {
    let mut trees = Part::new(Material::Plain);
    let mut lamps = Part::new(Material::Plain);
    for feature in site.city.features.iter() {
        match (&*feature.kind, &feature.shape) {
            ("tree", FeatureShape::Point(p)) if site.options.trees => {
                trees.begin(feature.id);
                tree(site, &mut trees.mesh, p.to_m(), feature.id);
            }
            ("tree_row", FeatureShape::Line(line)) if site.options.trees => {
                trees.begin(feature.id);
                row(site, &mut trees.mesh, feature, &polyline::to_m(line));
            }
            ("lamp", FeatureShape::Point(p)) if site.options.furniture => {
                lamps.begin(feature.id);
                lamp(site, &mut lamps.mesh, p.to_m());
            }
            _ => {}
        }
    }
    vec![Layer { name: "trees", parts: vec![trees] }, Layer { name: "lamps", parts: vec![lamps] }]
}

fn row(site: &Site, mesh: &mut Mesh, feature: &Feature, line: &[Vec2]) {
    if line.len() < 2 {
        return;
    }
    for (p, k) in polyline::resample(line, ROW_STEP_M).into_iter().zip(0u32..) {
        tree(site, mesh, p, feature.id.wrapping_mul(1009).wrapping_add(k));
    }
}

fn tree(site: &Site, mesh: &mut Mesh, at: Vec2, dice: u32) {
    if !site.bounds.contains(at) {
        return;
    }
    let size = 0.75 + 0.6 * share(dice, 1);
    let (radius_m, trunk_m) = (2.3 * size, 2.2 * size);
    let base = site.axes.place(at, site.drape.height_m(at) + BLOCK_M - 0.3);
    prism(mesh, base, 0.18 * size, trunk_m + 1.2, 5, linear(TRUNK));
    let middle = base + DVec3::Y * (trunk_m + radius_m * 1.05);
    let stretch = 1.05 + 0.35 * share(dice, 2);
    let color = scaled(pick(&LEAVES, dice, 3), 0.85 + 0.3 * share(dice, 4));
    crown(mesh, middle, radius_m, stretch, share(dice, 5) * std::f64::consts::TAU, dice, color);
}

/// Rings of a crown from below: height over the middle and radius, both of 1.
const CROWN: [(f64, f64); 4] = [(-0.72, 0.62), (-0.18, 1.0), (0.42, 0.86), (0.86, 0.42)];
const CROWN_SIDES: usize = 7;

/// A bumpy ball.
fn crown(
    mesh: &mut Mesh,
    middle: DVec3,
    radius_m: f64,
    stretch: f64,
    turn_rad: f64,
    dice: u32,
    color: Linear,
) {
    let first = mesh.positions.len() as u32;
    let point = |up: f64, out: f64, angle_rad: f64| {
        let side = trig::unit(angle_rad) * out;
        DVec3::new(side.x, up * stretch, side.y)
    };
    // Lighter above, darker below: crowns shade themselves.
    let shade = |up: f64| scaled(color, 0.82 + 0.2 * up);
    let add = |mesh: &mut Mesh, p: DVec3, up: f64| {
        mesh.vertex(middle + p * radius_m, p, shade(up));
    };
    add(mesh, DVec3::NEG_Y * stretch, -1.0);
    for (k, (up, out)) in CROWN.iter().enumerate() {
        for s in 0..CROWN_SIDES {
            let bump = 0.86 + 0.28 * share(dice, 16 + (k * CROWN_SIDES + s) as u32);
            let step = std::f64::consts::TAU / CROWN_SIDES as f64;
            let angle = turn_rad + step * (s as f64 + 0.5 * (k % 2) as f64);
            add(mesh, point(*up, out * bump, angle), *up);
        }
    }
    add(mesh, DVec3::Y * stretch, 1.0);
    let sides = CROWN_SIDES as u32;
    let at = |ring: usize, s: u32| first + 1 + ring as u32 * sides + s % sides;
    let (bottom, top) = (first, first + 1 + CROWN.len() as u32 * sides);
    for s in 0..sides {
        mesh.indices.extend([bottom, at(0, s), at(0, s + 1)]);
        mesh.indices.extend([top, at(CROWN.len() - 1, s + 1), at(CROWN.len() - 1, s)]);
        for ring in 0..CROWN.len() - 1 {
            // Every other ring is turned by half a side.
            let (a, b) = (at(ring, s), at(ring, s + 1));
            let (c, d) = (at(ring + 1, s), at(ring + 1, s + 1));
            let split = if ring % 2 == 0 { [a, c, b, b, c, d] } else { [a, c, d, a, d, b] };
            mesh.indices.extend(split);
        }
    }
}

fn lamp(site: &Site, mesh: &mut Mesh, at: Vec2) {
    if !site.bounds.contains(at) {
        return;
    }
    let base = site.axes.place(at, site.drape.height_m(at) + BLOCK_M - 0.2);
    prism(mesh, base, 0.07, 5.2, 4, linear(LAMP));
    prism(mesh, base + DVec3::Y * 5.2, 0.22, 0.4, 4, linear(LAMP_HEAD));
}

/// An upright prism without a bottom.
fn prism(mesh: &mut Mesh, base: DVec3, radius_m: f64, height_m: f64, sides: usize, color: Linear) {
    let step = std::f64::consts::TAU / sides as f64;
    let corner = |k: usize| {
        let side = trig::unit(step * k as f64) * radius_m;
        base + DVec3::new(side.x, 0.0, -side.y)
    };
    let up = DVec3::Y * height_m;
    for k in 0..sides {
        let (a, b) = (corner(k), corner(k + 1));
        mesh.convex(&[a, b, b + up, a + up], color);
    }
    let top: Vec<DVec3> = (0..sides).map(|k| corner(k) + up).collect();
    mesh.convex(&top, color);
}
