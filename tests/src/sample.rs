//! One whole city, made once, that several tests look at.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::exurb;

/// A folder with the files that `exurb demo` writes, under the target folder.
#[derive(Debug)]
pub struct Sample {
    folder: PathBuf,
}

impl Sample {
    /// Path of one of its files.
    pub fn file(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// The folder itself.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Runs `exurb demo` with further arguments into a folder of the given name, made anew.
    pub fn make(name: &str, arguments: &[&str]) -> Self {
        let test = std::env::current_exe().expect("a test knows its own program");
        let build = test.ancestors().nth(2).expect("it lies two folders down the build folder");
        let stem = test.file_stem().expect("it has a name");
        let folder = build.join("samples").join(stem).join(name);
        fs::remove_dir_all(&folder).or_else(|_| fs::create_dir_all(&folder)).expect("writable");
        let mut line = vec!["demo".as_ref(), "-o".as_ref(), folder.as_os_str()];
        line.extend(arguments.iter().map(std::ffi::OsStr::new));
        let done = exurb(line);
        assert_eq!(done.status, Some(0), "exurb demo failed: {}", done.stderr);
        Self { folder }
    }
}

/// The default demo city, made at the first call.
pub fn demo() -> &'static Sample {
    static DEMO: OnceLock<Sample> = OnceLock::new();
    DEMO.get_or_init(|| Sample::make("demo", &[]))
}
