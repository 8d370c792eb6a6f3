//! The real maps beside the repository, when they are there.

use std::path::PathBuf;

/// The folder of shared data; `None`, with a word on why, when it is absent.
pub fn data() -> Option<PathBuf> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data");
    if folder.join("osm").is_dir() {
        return Some(folder);
    }
    #[allow(clippy::print_stdout, reason = "a skip says why")]
    {
        println!("skipped: no shared data");
    }
    None
}

/// A shared map by its stem.
pub fn map(stem: &str) -> Option<PathBuf> {
    data().map(|folder| folder.join(format!("osm/{stem}.osm.pbf")))
}
