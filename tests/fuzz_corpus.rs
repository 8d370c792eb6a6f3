//! The bodies of `fuzz/` over its corpus, and over broken versions of every file in it.

#[path = "../fuzz/bodies.rs"]
mod bodies;

use std::fs;

use exurb_scenarios::root;

/// The file itself, cut short, and with single bytes changed: what a damaged disk would give.
fn versions(bytes: &[u8]) -> Vec<Vec<u8>> {
    let mut versions = vec![bytes.to_vec()];
    let step = (bytes.len() / 40).max(1);
    for at in (0..bytes.len()).step_by(step) {
        versions.push(bytes[..at].to_vec());
        let mut changed = bytes.to_vec();
        changed[at] = changed[at].wrapping_mul(31).wrapping_add(at as u8 | 1);
        versions.push(changed);
    }
    versions
}

#[test]
fn every_body_survives_its_corpus() {
    for (name, body) in bodies::BODIES {
        let folder = root().join("fuzz/corpus").join(name);
        let files = fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
        let mut count = 0;
        for file in files {
            let bytes = fs::read(file.expect("it can be listed").path()).expect("it can be read");
            for version in versions(&bytes) {
                body(&version);
                count += 1;
            }
        }
        assert!(count > 0, "{name} has no corpus");
    }
}
