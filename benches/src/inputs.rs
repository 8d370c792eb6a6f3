//! What is measured on: the real maps beside the repository, and files made of them.

use std::fs;
use std::path::{Path, PathBuf};

/// The root of the repository.
pub fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().expect("the benches lie in the repository").to_owned()
}

/// The real maps, largest first; prints `skipped` when they are not there.
pub fn shared_maps() -> Vec<PathBuf> {
    let folder = root().join("../shared/data/osm");
    let Ok(entries) = fs::read_dir(&folder) else {
        println!("skipped: no shared data");
        return Vec::new();
    };
    let mut maps: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    maps.retain(|path| path.to_string_lossy().ends_with(".osm.pbf"));
    maps.sort_by_key(|path| (std::cmp::Reverse(size(path)), path.clone()));
    maps
}

/// The `n` largest of the real maps; nothing when there are fewer.
pub fn largest_maps(n: usize) -> Option<Vec<PathBuf>> {
    shared_maps().get(..n).map(<[PathBuf]>::to_vec)
}

fn size(path: &Path) -> u64 {
    fs::metadata(path).map_or(0, |metadata| metadata.len())
}

/// A folder for what benches make.
pub fn bench_folder() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into());
    let folder = root().join(target).join("bench");
    fs::create_dir_all(&folder).expect("the target folder can be written");
    folder
}

/// A file in the bench folder, made by `make` when it is not there yet.
pub fn made_once(name: &str, make: impl FnOnce(&Path)) -> PathBuf {
    let path = bench_folder().join(name);
    if !path.exists() {
        make(&path);
    }
    path
}
