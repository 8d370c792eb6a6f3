//! Turns the folders of `scenarios/` into tests: the list of folders is the list of tests.

use std::fmt::Write;
use std::path::PathBuf;
use std::{env, fs};

fn main() {
    println!("cargo::rerun-if-changed=scenarios");
    let mut names: Vec<String> = fs::read_dir("scenarios")
        .expect("the folder of scenarios is there")
        .filter_map(Result::ok)
        .filter(|entry| entry.path().join("scenario.toml").is_file())
        .filter_map(|entry| entry.file_name().into_string().ok())
        .collect();
    names.sort();
    let mut tests = String::new();
    for name in names {
        let test = format!("#[test]\nfn {name}() {{\n    scenario(\"{name}\");\n}}\n");
        tests.write_str(&test).expect("writing to a string cannot fail");
    }
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it"));
    fs::write(out.join("scenarios.rs"), tests).expect("the build folder can be written");
}
