//! Nishida, Garcia-Dorado, Aliaga 2015, figure 2: two districts that look different have similar simple
//! statistics. Theirs are of Amsterdam and Tel Aviv; here the halves of Liège and of Tel Aviv that are
//! nearest in these statistics.

#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a test, whose skip says why")]

use std::path::PathBuf;

use exurb_city::{City, ImportOptions, Part};
use exurb_geom::{Vec2, polyline};
use exurb_likeness::patches::{CANDIDATE, HELD_OUT};
use exurb_likeness::{HeldOut, Panel, Place, Subject, measures, windows};
use exurb_measure::{Network, junctions};

/// West and east half, 2.5 km x 5 km each.
fn halves(name: &str) -> Option<(City, [exurb_geom::Bounds; 2])> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../..");
    let path = root.join(format!("shared/data/osm/{name}.osm.pbf"));
    if !path.exists() {
        println!("skipped: no shared data");
        return None;
    }
    let city = exurb_osm::read(&path, &ImportOptions::default()).unwrap().city;
    let cut = |half| windows::centred(half, Vec2::new(2500.0, 5000.0));
    let halves = windows::halves(&city, [Part::West, Part::East]).map(cut);
    Some((city, halves))
}

/// Mean and standard deviation of the length, mean curvature, shares of junctions with three and with
/// more legs.
fn simple_statistics(network: &Network) -> [f64; 5] {
    let lines: Vec<Vec<Vec2>> = network.segments().map(|(_, s)| s.line_m()).collect();
    let n = lines.len() as f64;
    let mean = |value: &dyn Fn(&[Vec2]) -> f64| lines.iter().map(|l| value(l)).sum::<f64>() / n;
    let length_m = mean(&polyline::length);
    let variance = mean(&|l| (polyline::length(l) - length_m) * (polyline::length(l) - length_m));
    let degrees = junctions::degrees(network);
    let share = |count: usize| count as f64 / degrees.iter().sum::<usize>() as f64;
    let curvature = mean(&polyline::curvature);
    [length_m, variance.sqrt(), curvature, share(degrees[2]), share(degrees[3] + degrees[4])]
}

#[test]
fn districts_with_like_statistics_are_told_apart_and_halves_of_a_city_are_not() {
    let (Some((liege, l)), Some((tel_aviv, t))) = (halves("liege"), halves("tel_aviv")) else {
        return;
    };
    let panel = Panel::builtin().unwrap();
    let subject = |city, window, key| Subject::of(Place { city, window }, &panel, 1, key);
    let liege_east = subject(&liege, l[1], CANDIDATE);
    let [west, east] = [subject(&tel_aviv, t[0], HELD_OUT), subject(&tel_aviv, t[1], CANDIDATE)];

    let (a, b) = (simple_statistics(&liege_east.network), simple_statistics(&west.network));
    println!("{a:.4?} {b:.4?}");
    assert!((a[0] / b[0] - 1.0).abs() < 0.05 && (a[1] / b[1] - 1.0).abs() < 0.05);
    assert!((a[3] - b[3]).abs() < 0.1 && (a[4] - b[4]).abs() < 0.1);
    assert!((a[2] / b[2]).max(b[2] / a[2]) < 1.5);

    let held_out = |subject: &Subject, other: &Subject| {
        let patches = subject.patches.clone();
        HeldOut::new(subject.measured.clone(), patches, [&other.measured], 1)
    };
    let names = ["block_fingerprint", "align_20_150m", "align_150_400m", "patch_c2st_auc"];
    let apart = |from: &HeldOut, other: &Subject| {
        names.map(|name| from.distance(measures::find(name).unwrap(), other.side()).unwrap())
    };
    let in_tel_aviv = held_out(&west, &east);
    let of_halves = apart(&in_tel_aviv, &east);
    let liege_west = subject(&liege, l[0], HELD_OUT);
    let of_liege = apart(&held_out(&liege_west, &liege_east), &liege_east);
    let of_districts = apart(&in_tel_aviv, &liege_east);
    println!("{of_districts:.2?} between, {of_halves:.2?} and {of_liege:.2?} within");
    let own = |i: usize| of_halves[i].max(of_liege[i]);
    assert!(of_districts[0] > 1.25 * own(0), "fingerprint");
    assert!(of_districts[1] > 2.0 * own(1) && of_districts[2] > 2.0 * own(2), "alignment");
    assert!(of_districts[3] > 0.75 && own(3) < 0.65, "discriminator");
}
