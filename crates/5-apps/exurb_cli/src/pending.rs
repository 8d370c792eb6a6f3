//! Files that appear whole or not at all: written beside their place, then renamed.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::problem::Problem;

/// A file under way. Dropped without [`Pending::commit`], it leaves nothing behind.
#[derive(Debug)]
pub struct Pending {
    path: PathBuf,
    beside: PathBuf,
}

impl Pending {
    /// Makes sure, before any long work, that `path` can be written: its folder is there and takes
    /// files, and it is no folder itself.
    pub fn new(path: &Path) -> Result<Self, Problem> {
        let wrong =
            |what: &str| Problem::failed(format!("{} cannot be written: {what}", path.display()));
        let name = path.file_name().ok_or_else(|| wrong("it names no file"))?.to_string_lossy();
        if path.is_dir() {
            return Err(wrong("it is a folder; name a file in it"));
        }
        let beside = path.with_file_name(format!(".{}.{name}", std::process::id()));
        fs::write(&beside, b"").map_err(|e| match e.kind() {
            std::io::ErrorKind::NotFound => wrong("its folder is not there; make it first"),
            _ => wrong(&e.to_string()),
        })?;
        Ok(Self { path: path.to_owned(), beside })
    }

    /// The file's place.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file's name without its ending and without blanks, for the files that go with it.
    pub fn stem(&self) -> String {
        self.path.file_stem().unwrap_or_default().to_string_lossy().replace(' ', "_")
    }

    /// Where to write: beside the place, with the same ending.
    pub fn beside(&self) -> &Path {
        &self.beside
    }

    /// Writes bytes.
    pub fn write(&self, bytes: &[u8]) -> Result<(), Problem> {
        self.stream(|out| out.write_all(bytes))
    }

    /// Writes what `write` puts into a stream.
    pub fn stream(
        &self,
        write: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>,
    ) -> Result<(), Problem> {
        let whole = || {
            let mut out = BufWriter::new(File::create(&self.beside)?);
            write(&mut out)?;
            out.flush()
        };
        whole().map_err(|e| self.problem(&e.to_string()))
    }

    /// What a writer reports, under the file's own name.
    pub fn problem(&self, message: &str) -> Problem {
        let message =
            message.replace(&self.beside.display().to_string(), &self.path.display().to_string());
        if message.contains(&self.path.display().to_string()) {
            return Problem::failed(message);
        }
        Problem::failed(format!("{} cannot be written: {message}", self.path.display()))
    }

    /// Puts the file in its place, replacing what was there.
    pub fn commit(self) -> Result<(), Problem> {
        fs::rename(&self.beside, &self.path).map_err(|e| self.problem(&e.to_string()))
    }
}

impl Drop for Pending {
    fn drop(&mut self) {
        // After a commit there is nothing left to remove.
        let _ = fs::remove_file(&self.beside);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_appears_when_it_is_committed_and_not_before() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("city.svg");
        let pending = Pending::new(&path).unwrap();
        pending.write(b"half").unwrap();
        drop(pending);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        let pending = Pending::new(&path).unwrap();
        pending.write(b"whole").unwrap();
        assert!(!path.exists());
        pending.commit().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"whole");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn folders_and_places_without_a_folder_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        for path in [folder.path().to_owned(), folder.path().join("no/city.svg")] {
            let problem = Pending::new(&path).unwrap_err();
            assert_eq!(problem.status, 1);
            assert!(problem.message.contains(&path.display().to_string()), "{}", problem.message);
        }
    }
}
