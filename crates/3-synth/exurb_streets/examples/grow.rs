//! Grows streets from a map and draws them: `grow MAP OUT.png [SIZE_M] [SEED] [PARAMS-JSON]`.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a tool for looking")]

use std::time::Instant;

use exurb_city::{City, ImportOptions, street_graph};
use exurb_geom::{GridPoint, Polygon};
use exurb_operation::{Example, Run, Scope, erase};

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let read = Instant::now();
    let example = exurb_osm::read(args[0].as_ref(), &ImportOptions::default()).unwrap().city;
    let read = read.elapsed().as_secs_f64();
    let size: f64 = args.get(2).map_or(2000.0, |s| s.parse().unwrap());
    let seed: u64 = args.get(3).map_or(1, |s| s.parse().unwrap());
    let params = args.get(4).map_or(serde_json::Value::Null, |s| serde_json::from_str(s).unwrap());
    let c = example.target.bounds().center();
    let h = size / 2.0;
    let target = Polygon::rectangle(GridPoint::m(c.x - h, c.y - h), GridPoint::m(c.x + h, c.y + h));
    let city = City::empty(example.frame.clone(), target);
    let example_density = example.streets.length_m() / 1000.0 / example.area_km2();
    let g = &example.streets;
    let main = g
        .edges()
        .filter(|(_, e)| e.data.role() == exurb_city::Role::Main && !e.data.class.is_given_only());
    let example_main = main.map(|(_, e)| e.length_m()).sum::<f64>() / g.length_m();
    let operation = erase::<exurb_streets::grow::Grow>();
    let run = Run::new(seed);
    let outcome =
        operation.run(&city, &Scope::All, &[Example::new(example)], params, &run).unwrap();
    let streets = &outcome.city.streets;
    let km = streets.length_m() / 1000.0;
    let (e, p, o) = street_graph::shares_by_origin(streets);
    println!(
        "{}: {km:.1} km, {} edges, {} blocks, example {e:.2} procedural {p:.2} other {o:.2}, read {read:.2} learn {:.3} grow {:.3} = {:.0} km/s",
        args[0].rsplit('/').next().unwrap(),
        streets.edge_count(),
        outcome.city.blocks.len(),
        outcome.seconds.learn,
        outcome.seconds.synthesise,
        km / (outcome.seconds.learn + outcome.seconds.synthesise),
    );
    let main_share = |g: &exurb_city::StreetGraph| {
        let main = g.edges().filter(|(_, e)| {
            e.data.role() == exurb_city::Role::Main && !e.data.class.is_given_only()
        });
        main.map(|(_, e)| e.length_m()).sum::<f64>() / g.length_m()
    };
    println!(
        "   main share {:.2} of example {:.2}; km/km2 {:.1} of {:.1}",
        main_share(streets),
        example_main,
        km / outcome.city.area_km2(),
        example_density
    );
    let report = exurb_city::laws::laws(&outcome.city);
    for law in report.laws.iter().filter(|l| !l.pass) {
        let first = report.breaches.iter().find(|b| b.law == law.name);
        println!("   LAW {} {:?} > {} ({}) {first:?}", law.name, law.value, law.limit, law.count);
    }
    let values = exurb_city::laws::gates(&outcome.city);
    let example = &outcome.city.metadata.example_gates;
    for (name, gate) in exurb_city::laws::compare_gates(&values, Some(example)) {
        if gate.pass == Some(false) {
            println!(
                "   gate {name} {:?} not in {:?}..{:?}",
                gate.value, gate.limit_min, gate.limit
            );
        }
    }
    if args[1] == "-" {
        return;
    }
    let style =
        exurb_plan::Style::parse(&std::env::var("STYLE").unwrap_or("figure".into())).unwrap();
    let options = exurb_plan::Options { width_px: 1000, style, ..Default::default() };
    std::fs::write(&args[1], exurb_plan::to_png(&outcome.city, &options).unwrap()).unwrap();
}
