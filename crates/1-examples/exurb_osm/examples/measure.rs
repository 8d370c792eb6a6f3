//! Import times: `cargo run --release -p exurb_osm --example measure -- FILE...`
#![allow(clippy::print_stdout, missing_docs)]
use std::time::Instant;
fn main() {
    let mut total = 0.0;
    for file in std::env::args().skip(1) {
        let start = Instant::now();
        let read = exurb_osm::read(std::path::Path::new(&file), &Default::default());
        let seconds = start.elapsed().as_secs_f64();
        total += seconds;
        match read {
            Ok(i) => {
                let c = &i.city;
                let share = exurb_city::completeness::built_share(&c.streets, &c.buildings);
                println!(
                    "{share:.3} {:30} {:7.1} ms  {:7.1} km {:5} nodes {:5} blocks {:9.4} km2 {:6} buildings {:5} water {:5} use {:5} features {:4} parcels {:?}",
                    c.metadata.name,
                    seconds * 1e3,
                    c.streets.length_m() / 1e3,
                    c.streets.node_count(),
                    c.blocks.len(),
                    c.blocks.iter().map(|b| b.polygon.area_m2()).sum::<f64>() / 1e6,
                    c.buildings.len(),
                    c.water.len(),
                    c.land_use.len(),
                    c.features.len(),
                    c.parcels.len(),
                    i.warnings
                );
            }
            Err(e) => println!("{file}: {e}"),
        }
    }
    println!("total {:.0} ms", total * 1e3);
}
