//! Files are written beside their place and renamed when they are whole.

use std::fs::File;
use std::path::{Path, PathBuf};

use crate::Error;

/// A file in the making: it goes when it is dropped, and takes its place on [`Beside::finish`].
pub struct Beside {
    target: PathBuf,
    partial: PathBuf,
}

impl Beside {
    /// An empty file beside `target`.
    pub fn create(target: &Path) -> Result<(Self, File), Error> {
        let name = target.file_name().unwrap_or_default().to_string_lossy();
        let partial = target.with_file_name(format!(".{name}.{}.partial", std::process::id()));
        let error = |source| Error::Write { file: target.display().to_string(), source };
        if target.is_dir() {
            return Err(error(std::io::ErrorKind::IsADirectory.into()));
        }
        let file = File::create(&partial).map_err(error)?;
        Ok((Self { target: target.to_owned(), partial }, file))
    }

    /// Where the file is while it is made.
    pub fn path(&self) -> &Path {
        &self.partial
    }

    /// Puts the file into its place.
    pub fn finish(self) -> Result<(), Error> {
        std::fs::rename(&self.partial, &self.target)
            .map_err(|source| Error::Write { file: self.target.display().to_string(), source })
    }
}

impl Drop for Beside {
    fn drop(&mut self) {
        // Nothing to be done where even this fails; after `finish` the file is gone already.
        let _ = std::fs::remove_file(&self.partial);
    }
}
