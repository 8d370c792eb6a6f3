//! City → display list, from the ground up.

use exurb_city::City;
use exurb_geom::Vec2;

use crate::color::Color;
use crate::color_by::Key;
use crate::display::{Display, Group, Mark, Paint, Pen, Shape};
use crate::options::{Layer, Options};
use crate::sheet::Sheet;
use crate::view::View;
use crate::{buildings, caption, features, ground, relief, streets};

/// What every theme needs to draw itself.
pub struct Map<'a> {
    pub city: &'a City,
    pub options: &'a Options,
    pub view: View,
    pub sheet: Sheet,
    pub key: Key,
}

impl Map<'_> {
    /// A colour of the style, paler where other colours are to tell something.
    pub fn base(&self, color: Color) -> Color {
        if self.options.color_by.is_some() { color.mix(self.sheet.paper, 0.45) } else { color }
    }

    /// A thin line, the same share of the picture at any size.
    pub fn hair_px(&self) -> f32 {
        self.view.hair_px()
    }
}

/// The whole map.
pub fn draw(city: &City, options: &Options) -> Display {
    let view = View::of(city, options);
    let sheet = Sheet::of(options.style, streets::are_lines(city, &view));
    let map = Map { city, options, view, sheet, key: Key::of(city, options.color_by) };
    let mut groups = Vec::new();
    let mut add = |layer: Layer, marks: &dyn Fn(&Map) -> Vec<Mark>| {
        let only_streets = map.sheet.is_figure() && layer != Layer::Streets;
        if options.shows(layer) && !only_streets {
            groups.push(Group { id: layer.as_str(), marks: marks(&map) });
        }
    };
    add(Layer::Blocks, &ground::blocks);
    add(Layer::LandUse, &ground::land_use);
    add(Layer::Terrain, &relief::draw);
    add(Layer::Water, &ground::water);
    add(Layer::Parcels, &ground::parcels);
    add(Layer::Buildings, &buildings::draw);
    add(Layer::OtherWays, &streets::other_ways);
    add(Layer::Streets, &streets::draw);
    add(Layer::Features, &features::draw);
    groups.extend(veil(&map));
    if options.caption && !map.sheet.is_figure() {
        groups.push(Group { id: "caption", marks: caption::draw(&map) });
    }
    Display {
        width_px: map.view.width_px,
        height_px: map.view.height_px,
        paper: map.sheet.paper,
        groups,
        title: city.metadata.name.to_string(),
        attribution: city.metadata.attribution.join("; "),
    }
}

/// Covers what lies outside a target that does not fill the picture, and draws its outline.
fn veil(map: &Map) -> Option<Group> {
    let target = &map.city.target;
    let size = map.view.bounds.size();
    if (target.area_m2() / (size.x * size.y)) > 0.9999 {
        return None;
    }
    let (w, h) = (map.view.width_px as f32, map.view.height_px as f32);
    let mut rings = map.view.rings(target, Vec2::ZERO)?;
    let outline = Mark::new(
        Shape::Area(rings.clone()),
        Paint::pen(Pen::solid(map.sheet.text.alpha(150), 1.5 * map.hair_px())),
    );
    // Rings run clockwise on paper, where y points down; the page runs the other way round them.
    rings.push(vec![[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]]);
    let cover = Mark::new(Shape::Area(rings), Paint::fill(map.sheet.paper.alpha(225)));
    Some(Group { id: "outside", marks: vec![cover, outline] })
}
