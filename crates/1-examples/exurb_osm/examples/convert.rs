//! Scratch.
#![allow(clippy::print_stdout, missing_docs, clippy::unwrap_used)]
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let i = exurb_osm::read(std::path::Path::new(&a[1]), &Default::default()).unwrap();
    let t = std::time::Instant::now();
    let mut f = std::fs::File::create(&a[2]).unwrap();
    if a[2].ends_with(".pbf") {
        exurb_osm::write_pbf(&i.city, &mut f).unwrap()
    } else {
        exurb_osm::write_xml(&i.city, &mut f).unwrap()
    }
    println!("wrote in {:?}", t.elapsed());
}
