//! `exurb demo` of every built-in style, against the five seconds it may take.

#![allow(clippy::print_stdout, reason = "a program that reports")]

use exurb_benches::{Better, bench_folder, heading, measure, note, row};

/// What a demo may take once built.
const LIMIT_S: f64 = 5.0;

fn main() {
    heading("exurb demo: a whole city of 2 km x 2 km in every format");
    let exurb = std::env::var("EXURB_BIN").expect("`cargo xtask bench` names the program");
    for style in ["helsinki", "karhula", "prague", "suburb", "saltlake", "grid"] {
        let folder = bench_folder().join("demo").join(style);
        let words = ["demo", "--quiet", "--style", style, "-o"];
        let mut command = vec![exurb.as_ref()];
        command.extend(words.map(std::ffi::OsStr::new));
        command.push(folder.as_os_str());
        match measure(3, &command) {
            Some(took) => {
                row(style, "s", took.seconds, LIMIT_S, "5 s", Better::Less);
                note(&format!("peak memory {:.0} MB", took.peak_mb));
            }
            None => note(&format!("{style}: failed")),
        }
    }
}
