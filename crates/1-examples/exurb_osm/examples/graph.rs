//! Scratch: read to a graph.
#![allow(clippy::print_stdout, missing_docs, clippy::unwrap_used)]
use exurb_city::street_graph::{Derive, derive};
fn main() {
    for f in std::env::args().skip(1) {
        let t = std::time::Instant::now();
        let (d, _) = exurb_osm::read_draft(std::path::Path::new(&f), &Default::default()).unwrap();
        let a = t.elapsed();
        let g = derive(&d.streets, &Derive { with_other: false, area: d.area() });
        println!(
            "{f} draft {a:?} graph {:?} {} edges {} breaches",
            t.elapsed(),
            g.edge_count(),
            exurb_graph::laws::breaches(&g).len()
        );
    }
}
