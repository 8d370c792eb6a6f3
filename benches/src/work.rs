//! The work that benches measure, a process each; prints what it did as one line of JSON:
//! `read MAP`, `grow EXAMPLE SIDE_M`, `faces MAP LINES.txt`, `retarget MAP`, `query MAP...`,
//! `outlines FILE.json`, `cadastre MAP FILE.json`.

#![allow(clippy::print_stdout, reason = "its output is the result")]

mod blocks_work;

use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

use exurb_city::{City, ImportOptions};
use exurb_geom::{GridPoint, Polygon, Vec2};
use exurb_graph::Faces;
use exurb_operation::{Example, Run, Scope, erase};
use serde_json::{Value, json};

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    let said = match args[..] {
        ["read", map] => read(map.as_ref())?,
        ["grow", example, side_m] => grow(example.as_ref(), side_m.parse()?)?,
        ["faces", map, lines] => faces(map.as_ref(), lines.as_ref())?,
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
