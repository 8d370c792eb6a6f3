#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use exurb_city::{
    Area, Block, BlockClass, Building, City, Class, Feature, FeatureShape, Origin, Provenance,
    Street, block, street_graph,
};
use exurb_geom::{Frame, GridPoint, Polygon};

use crate::{ColorBy, Error, Layer, Options, Style, to_png, to_svg};

fn rectangle(x: f64, y: f64, w: f64, h: f64) -> Polygon {
    Polygon::rectangle(GridPoint::m(x, y), GridPoint::m(x + w, y + h))
}

/// A town of 4 x 4 blocks with a bridge, a park, a pond, houses and trees.
fn town() -> City {
    let mut city = City::empty(Frame::null_island(), rectangle(0.0, 0.0, 400.0, 300.0));
    let mut lines = Vec::new();
    for i in 0..5 {
        let class = if i == 2 { Class::Primary } else { Class::Residential };
        let street = |k: i32| Street {
            class,
            bridge: i == 2 && k == 1,
            name: Some("A & <B>".into()),
            ..Street::default()
        };
        for k in 0..4 {
            let (at, from) = (f64::from(i) * 100.0, f64::from(k) * 100.0);
            lines.push((vec![GridPoint::m(at, from), GridPoint::m(at, from + 100.0)], street(k)));
            lines.push((vec![GridPoint::m(from, at), GridPoint::m(from + 100.0, at)], street(k)));
        }
    }
    let streets = street_graph::from_lines(lines);
    city.blocks = Arc::new(block::derive(&streets));
    city.streets = Arc::new(streets);
    let houses = (0..4).map(|i| {
        let x = f64::from(i) * 100.0 + 20.0;
        let outer = rectangle(x, 20.0, 40.0, 30.0);
        let hole = rectangle(x + 10.0, 30.0, 10.0, 10.0).exterior().to_vec();
        let polygon = Polygon::new(outer.exterior().to_vec(), vec![hole]).unwrap();
        let mut house = Building::new(i as u32 + 1, polygon, Provenance::of(Origin::Procedural));
        house.height_m = Some(5.0 + 12.0 * f64::from(i));
        house
    });
    city.buildings = Arc::new(houses.collect());
    let area = |id, x, class: &str| Area {
        id,
        polygon: rectangle(x, 120.0, 60.0, 60.0),
        class: class.into(),
    };
    city.land_use = Arc::new(vec![area(1, 110.0, "park")]);
    city.water = Arc::new(vec![area(1, 220.0, "lake")]);
    city.features = Arc::new(vec![Feature {
        id: 1,
        kind: "tree".into(),
        shape: FeatureShape::Point(GridPoint::m(130.0, 140.0)),
        block: 0,
        provenance: Provenance::default(),
    }]);
    city.metadata.name = "town".into();
    city.metadata.attribution = vec!["© OpenStreetMap contributors, ODbL 1.0".to_owned()];
    city
}

/// Width, height and pixels of a PNG.
fn decode(png: &[u8]) -> (u32, u32, Vec<u8>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    (info.width, info.height, pixels)
}

fn shade_at(png: &[u8], x: u32, y: u32) -> [u8; 3] {
    let (w, _, pixels) = decode(png);
    let i = ((y * w + x) * 3) as usize;
    [pixels[i], pixels[i + 1], pixels[i + 2]]
}

#[test]
fn the_picture_has_the_width_asked_for_and_the_shape_of_the_target() {
    let png = to_png(&town(), &Options { width_px: 800, ..Options::default() }).unwrap();
    let (w, h, _) = decode(&png);
    assert_eq!((w, h), (800, 600));
}

#[test]
fn what_lies_where_is_seen_there() {
    let options = Options { width_px: 800, caption: false, ..Options::default() };
    let png = to_png(&town(), &options).unwrap();
    let at = |x: f64, y: f64| shade_at(&png, (x * 2.0) as u32, ((300.0 - y) * 2.0) as u32);
    let [r, g, b] = at(250.0, 150.0);
    assert!(b > g && g > r, "the pond is blue");
    let [r, g, b] = at(150.0, 170.0);
    assert!(g > r && g > b, "the park is green");
    assert_eq!(at(100.0, 150.0), [255, 255, 255], "a local street is white");
    let [r, _, b] = at(200.0, 50.0);
    assert!(r > b + 60, "a primary street is yellow");
    assert_ne!(at(25.0, 25.0), at(35.0, 35.0), "a courtyard is not built on");
}

#[test]
fn the_figure_style_is_black_streets_on_white() {
    let options = Options { width_px: 800, style: Style::Figure, ..Options::default() };
    let (_, _, pixels) = decode(&to_png(&town(), &options).unwrap());
    assert!(pixels.chunks_exact(3).all(|p| p[0] == p[1] && p[1] == p[2]));
    let black = pixels.chunks_exact(3).filter(|p| p[0] == 0).count() as f64 / 480_000.0;
    assert!((0.1..0.35).contains(&black), "{black}");
}

/// Streets every 500 m over 8 km, one of them a main street, and nothing else.
#[test]
fn streets_are_seen_at_every_scale() {
    for side_m in [500.0, 2_000.0, 8_000.0] {
        let mut city = City::empty(Frame::null_island(), rectangle(0.0, 0.0, side_m, side_m));
        let middle = side_m / 2.0;
        let lines = [(middle / 2.0, Class::Residential), (middle, Class::Primary)];
        let lines = lines.map(|(x, class)| {
            let line = vec![GridPoint::m(x, 0.0), GridPoint::m(x, side_m)];
            (line, Street { class, ..Street::default() })
        });
        city.streets = Arc::new(street_graph::from_lines(lines));
        let png = to_png(&city, &Options { width_px: 1000, ..Options::default() }).unwrap();
        let grey = |x: u32| shade_at(&png, x, 600).map(i32::from).iter().sum::<i32>() / 3;
        let ground = grey(100);
        for x in [250, 500] {
            let difference = (x - 14..x + 14).map(|x| (grey(x) - ground).abs()).max();
            assert!(difference > Some(40), "{side_m} m at {x}: {difference:?}");
        }
    }
}

#[test]
fn svg_is_well_formed_and_names_its_layers_and_its_source() {
    for color_by in [None].into_iter().chain(ColorBy::ALL.map(Some)) {
        let svg = to_svg(&town(), &Options { color_by, ..Options::default() });
        let mut reader = quick_xml::Reader::from_str(&svg);
        let mut groups = Vec::new();
        let mut paths = 0;
        loop {
            match reader.read_event().unwrap() {
                quick_xml::events::Event::Start(e) if e.name().as_ref() == "g" => {
                    let id = e.try_get_attribute("id").unwrap();
                    groups.extend(id.map(|a| a.value.to_string()));
                }
                quick_xml::events::Event::Start(e) | quick_xml::events::Event::Empty(e) => {
                    paths += usize::from(e.name().as_ref() == "path");
                }
                quick_xml::events::Event::Eof => break,
                _ => {}
            }
        }
        for layer in Layer::ALL {
            assert!(groups.iter().any(|g| g == layer.as_str()), "{layer:?}");
        }
        assert!(paths > 50);
        assert!(svg.contains("A &amp; &lt;B&gt;") && !svg.contains("NaN"));
        assert_eq!(svg.matches("OpenStreetMap").count(), 2, "in the metadata and in the picture");
    }
}

#[test]
fn only_the_layers_asked_for_are_drawn() {
    let svg = to_svg(&town(), &Options { layers: vec![Layer::Water], ..Options::default() });
    assert!(svg.contains("id=\"water\"") && !svg.contains("id=\"streets\""));
}

#[test]
fn the_same_city_gives_the_same_bytes() {
    let options = Options { width_px: 300, ..Options::default() };
    assert_eq!(to_png(&town(), &options).unwrap(), to_png(&town(), &options).unwrap());
    assert_eq!(to_svg(&town(), &options), to_svg(&town(), &options));
}

#[test]
fn an_empty_city_is_a_sheet_of_paper() {
    let city = City::empty(Frame::null_island(), rectangle(0.0, 0.0, 1.0, 5000.0));
    for style in Style::ALL {
        let options = Options { width_px: 64, style, ..Options::default() };
        let (w, h, _) = decode(&to_png(&city, &options).unwrap());
        assert_eq!((w, h), (64, 640), "no picture is more than ten times as high as wide");
        assert!(to_svg(&city, &options).ends_with("</svg>\n"));
    }
}

#[test]
fn a_width_out_of_range_is_refused() {
    let options = Options { width_px: 8, ..Options::default() };
    assert!(matches!(to_png(&town(), &options), Err(Error::Width(8))));
}

#[test]
fn what_lies_outside_the_target_is_veiled() {
    let mut city = town();
    let corners = [(0.0, 0.0), (400.0, 0.0), (0.0, 300.0)].map(|(x, y)| GridPoint::m(x, y));
    city.target = Polygon::new(corners.to_vec(), vec![]).unwrap();
    let mut island = city.blocks[0].clone();
    island.class = BlockClass::Island;
    city.blocks = Arc::new([Block { id: 99, ..island }].into_iter().collect());
    let options = Options { width_px: 800, caption: false, ..Options::default() };
    let png = to_png(&city, &options).unwrap();
    let [r, g, b] = shade_at(&png, 600, 200);
    assert!(r > 225 && g > 220 && b > 205, "the yellow street is veiled: {r} {g} {b}");
}

/// Mean brightness of a picture's middle.
fn brightness(city: &City, layers: &[Layer]) -> f64 {
    let options =
        Options { width_px: 200, caption: false, layers: layers.to_vec(), ..Options::default() };
    let png = to_png(city, &options).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    pixels.iter().map(|v| f64::from(*v)).sum::<f64>() / pixels.len() as f64
}

#[test]
fn slopes_towards_the_north_west_are_light_and_those_away_dark() {
    let ground = |east: f32, north: f32| {
        let mut city = town();
        let bounds = city.target.bounds().grown(50.0);
        let height = |p: exurb_geom::Vec2| p.x as f32 * east + p.y as f32 * north;
        city.lay(exurb_city::Terrain::over(bounds, 10.0, height).unwrap());
        brightness(&city, &Layer::ALL)
    };
    let plain = brightness(&town(), &Layer::ALL);
    assert!((ground(0.0, 0.0) - plain).abs() < 0.5, "flat ground changes nothing");
    assert!(ground(0.3, -0.3) > plain + 3.0 && ground(-0.3, 0.3) < plain - 15.0);
    assert!(ground(-0.9, 0.9) > 60.0, "steep ground is not black");
}

#[test]
fn the_terrain_alone_is_coloured_by_height() {
    let mut city = town();
    let bounds = city.target.bounds();
    city.lay(exurb_city::Terrain::over(bounds, 10.0, |p| p.x as f32 / 10.0).unwrap());
    let options = Options { layers: vec![Layer::Terrain], width_px: 100, ..Options::default() };
    let svg = to_svg(&city, &options);
    assert!(
        svg.contains("<g id=\"terrain\">") && svg.contains("href=\"data:image/png;base64,iVBOR")
    );
    assert!(!svg.contains("id=\"streets\""));
    let mut reader = quick_xml::Reader::from_str(&svg);
    while !matches!(reader.read_event().unwrap(), quick_xml::events::Event::Eof) {}
}
