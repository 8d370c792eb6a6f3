//! Same inputs, parameters and seed give the same files, byte for byte, whatever the number of
//! threads; another seed gives another city.

use std::collections::BTreeMap;
use std::fs;

use exurb_scenarios::{Sample, demo};

/// Contents of every file of a city, by name.
fn contents(sample: &Sample) -> BTreeMap<String, Vec<u8>> {
    fs::read_dir(sample.folder())
        .expect("it is there")
        .map(|entry| {
            let path = entry.expect("it can be listed").path();
            let name = path.file_name().expect("files have names").to_string_lossy().into_owned();
            (name, fs::read(path).expect("the file can be read"))
        })
        .collect()
}

fn assert_same(a: &Sample, b: &Sample) {
    let (a, b) = (contents(a), contents(b));
    assert!(a.keys().eq(b.keys()), "other files: {:?} and {:?}", a.keys(), b.keys());
    for (name, bytes) in &a {
        assert!(bytes == &b[name], "{name} differs between the two runs");
    }
}

#[test]
fn the_same_run_twice_gives_the_same_bytes() {
    assert_same(demo(), &Sample::make("again", &[]));
}

#[test]
fn one_thread_and_two_give_the_same_bytes() {
    let one = Sample::make("one_thread", &["--threads", "1"]);
    assert_same(&one, &Sample::make("two_threads", &["--threads", "2"]));
    assert_same(demo(), &one);
}

#[test]
fn another_seed_gives_another_city() {
    let streets = |sample: &Sample| fs::read(sample.file("city.geojson")).expect("it is there");
    assert_ne!(streets(demo()), streets(&Sample::make("seed_2", &["--seed", "2"])));
}
