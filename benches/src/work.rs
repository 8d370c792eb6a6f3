//! The work that benches measure, a process each; prints what it did as one line of JSON:
//! `read MAP`, `grow EXAMPLE SIDE_M`, `faces MAP LINES.txt`, `measures MAP STREETS.json`,
//! `likeness MAP MAP`, `retarget MAP`, `query MAP...`, `outlines FILE.json`, `cadastre MAP FILE.json`.

#![allow(clippy::print_stdout, reason = "its output is the result")]

mod blocks_work;

use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

use exurb_city::{City, ImportOptions};
use exurb_geom::{GridPoint, Polygon, Vec2};
use exurb_graph::Faces;
use exurb_likeness::measures::Family;
use exurb_likeness::patches::{CANDIDATE, HELD_OUT, Patches};
use exurb_likeness::{HeldOut, Measured, Panel, STREETS, Side};
use exurb_measure::Network;
use exurb_operation::{Example, Run, Scope, erase};
use serde_json::{Value, json};

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    let said = match args[..] {
        ["read", map] => read(map.as_ref())?,
        ["grow", example, side_m] => grow(example.as_ref(), side_m.parse()?)?,
        ["faces", map, lines] => faces(map.as_ref(), lines.as_ref())?,
        ["measures", map, streets] => measures(map.as_ref(), streets.as_ref())?,
        ["likeness", one, other] => likeness(one.as_ref(), other.as_ref())?,
        ["retarget", map] => blocks_work::retarget(&city_of(map.as_ref())?)?,
        ["query", ref maps @ ..] => {
            let cities = maps.iter().map(|map| city_of(map.as_ref()));
            blocks_work::query(&cities.collect::<Result<Vec<City>, _>>()?)?
        }
        ["outlines", file] => blocks_work::outlines(file.as_ref())?,
        ["cadastre", map, file] => blocks_work::cadastre(&city_of(map.as_ref())?, file.as_ref())?,
        _ => return Err("no such work".into()),
    };
    println!("{said}");
    Ok(())
}

fn city_of(map: &Path) -> Result<City, Box<dyn Error>> {
    Ok(exurb_osm::read(map, &ImportOptions::default())?.city)
}

fn read(map: &Path) -> Result<Value, Box<dyn Error>> {
    let started = Instant::now();
    let city = city_of(map)?;
    let seconds = started.elapsed().as_secs_f64();
    let km = city.streets.length_m() / 1000.0;
    Ok(json!({ "seconds": seconds, "edges": city.streets.edge_count(), "km": km }))
}

/// Learning and growing in a square around the example's centre.
fn grow(example: &Path, side_m: f64) -> Result<Value, Box<dyn Error>> {
    let example = city_of(example)?;
    let centre = example.target.bounds().center();
    let corner = |sign: f64| GridPoint::round(centre + Vec2::new(sign, sign) * (side_m / 2.0));
    let target = Polygon::rectangle(corner(-1.0), corner(1.0));
    let city = City::empty(example.frame.clone(), target);
    let grow = erase::<exurb_streets::grow::Grow>();
    let examples = [Example::new(example)];
    let outcome = grow.run(&city, &Scope::All, &examples, Value::Null, &Run::new(1))?;
    Ok(json!({
        "km": outcome.city.streets.length_m() / 1000.0,
        "learn": outcome.seconds.learn,
        "synthesise": outcome.seconds.synthesise,
    }))
}

/// The faces of a map's streets; the same lines as text for the yardstick.
fn faces(map: &Path, lines: &Path) -> Result<Value, Box<dyn Error>> {
    let city = city_of(map)?;
    let mut text = String::new();
    for (_, edge) in city.streets.edges() {
        for point in edge.line_m() {
            write!(text, "{} {} ", point.x, point.y)?;
        }
        text.push('\n');
    }
    std::fs::write(lines, text)?;
    let mut seconds = f64::INFINITY;
    let mut count = 0;
    for _ in 0..3 {
        let started = Instant::now();
        count = Faces::of(&city.streets, |_| true).list.len();
        seconds = seconds.min(started.elapsed().as_secs_f64());
    }
    Ok(json!({ "seconds": seconds, "faces": count, "edges": city.streets.edge_count() }))
}

/// All measures of the streets and blocks of a map's densest 5 km square; the same streets, cut and
/// cleaned, as a file for the yardstick.
fn measures(map: &Path, streets: &Path) -> Result<Value, Box<dyn Error>> {
    let network = densest(&city_of(map)?);
    let nodes = network.graph.nodes().map(|(id, node)| {
        let at = node.at.to_m();
        json!([id.0, at.x, at.y, node.data.cut])
    });
    let line = |points: Vec<Vec2>| points.iter().map(|p| p.to_array()).collect::<Vec<_>>();
    let edges = network.graph.edges().map(|(_, e)| json!([e.from.0, e.to.0, line(e.line_m())]));
    let window = [network.window.min.to_array(), network.window.max.to_array()].concat();
    let document = json!({
        "window": window, "nodes": nodes.collect::<Vec<_>>(), "edges": edges.collect::<Vec<_>>(),
    });
    std::fs::write(streets, document.to_string())?;
    let mut seconds = f64::INFINITY;
    for _ in 0..3 {
        let started = Instant::now();
        let _ = Measured::of_network(&network);
        seconds = seconds.min(started.elapsed().as_secs_f64());
    }
    Ok(json!({ "seconds": seconds, "edges": network.graph.edge_count() }))
}

/// Two cities compared, densest 5 km square with densest 5 km square, without and with the
/// discriminator. Reading the maps is not counted.
fn likeness(one: &Path, other: &Path) -> Result<Value, Box<dyn Error>> {
    let panel = Panel::builtin()?;
    let (one, other) = (city_of(one)?, city_of(other)?);
    let started = Instant::now();
    let (a, b) = rayon::join(
        || Measured::of_network(&densest(&one)),
        || Measured::of_network(&densest(&other)),
    );
    let held_out = HeldOut::new(b.clone(), None, [&a], 1);
    let is_plain = |m: &&exurb_likeness::Measure| m.family != Family::Patches;
    let side = Side { measured: &a, patches: None };
    let mut found =
        STREETS.iter().filter(is_plain).filter_map(|m| held_out.distance(m, side)).count();
    let plain = started.elapsed().as_secs_f64();
    let look = |m: &Measured, key| {
        m.image.as_ref().map(|image| Patches::of(image, &panel.dictionary, 1, key))
    };
    let (patches, its) = rayon::join(|| look(&a, CANDIDATE), || look(&b, HELD_OUT));
    let held_out = HeldOut::new(b, its, [&a], 1);
    let side = Side { measured: &a, patches: patches.as_ref() };
    let of_patches = STREETS.iter().filter(|m| !is_plain(m));
    found += of_patches.filter_map(|m| held_out.distance(m, side)).count();
    let whole = started.elapsed().as_secs_f64();
    Ok(json!({ "plain": plain, "whole": whole, "measures": found }))
}

fn densest(city: &City) -> Network {
    Network::of(&city.streets, exurb_city::densest_square::of_city(city))
}
