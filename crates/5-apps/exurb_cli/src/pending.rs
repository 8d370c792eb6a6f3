//! Files that appear whole or not at all: written beside their place, then renamed. What is no file,
//! as `/dev/null` or a pipe, cannot be replaced: it gets all at once what was written elsewhere.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::problem::Problem;

/// A file under way. Dropped without [`Pending::commit`], it leaves nothing behind.
#[derive(Debug)]
pub struct Pending {
    path: PathBuf,
    beside: PathBuf,
    /// Is there something at the path that must stay what it is?
    is_device: bool,
}

impl Pending {
    /// Makes sure, before any long work, that `path` can be written: its folder is there and takes
    /// files, and it is no folder itself.
    pub fn new(path: &Path) -> Result<Self, Problem> {
        let wrong =
            |what: &str| Problem::failed(format!("{} cannot be written: {what}", path.display()));
        if path.is_dir() {
            return Err(wrong("it is a folder; name a file in it"));
        }
        // A link stays; what it points to is replaced.
        let place = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let name = place.file_name().ok_or_else(|| wrong("it names no file"))?.to_string_lossy();
        let hidden = format!(".{}.{name}", std::process::id());
        let is_device = fs::metadata(&place).is_ok_and(|there| !there.is_file());
        let beside = match is_device {
            true => std::env::temp_dir().join(hidden),
            false => place.with_file_name(hidden),
        };
        fs::write(&beside, b"").map_err(|e| match e.kind() {
            io::ErrorKind::NotFound => wrong("its folder is not there; make it first"),
            _ => wrong(&e.to_string()),
        })?;
        Ok(Self { path: path.to_owned(), beside, is_device })
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
        write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
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

    /// Puts the file in its place, replacing what was there; its permissions stay.
    pub fn commit(self) -> Result<(), Problem> {
        self.put().map_err(|e| self.problem(&e.to_string()))
    }

    fn put(&self) -> io::Result<()> {
        if self.is_device {
            let mut device = OpenOptions::new().write(true).open(&self.path)?;
            return io::copy(&mut File::open(&self.beside)?, &mut device).map(|_| ());
        }
        let place = fs::canonicalize(&self.path).unwrap_or_else(|_| self.path.clone());
        if let Ok(there) = fs::metadata(&place) {
            fs::set_permissions(&self.beside, there.permissions())?;
        }
        fs::rename(&self.beside, place)
    }
}

/// Is `file` one of these that are there already, by whatever name?
pub fn is_one_of<'a>(file: &Path, others: impl IntoIterator<Item = &'a Path>) -> bool {
    let place = |f: &Path| fs::canonicalize(f).ok();
    place(file).is_some_and(|to| others.into_iter().any(|f| place(f).as_ref() == Some(&to)))
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

    #[cfg(unix)]
    #[test]
    fn links_stay_links_and_permissions_stay() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("city.svg"), folder.path().join("latest.svg"));
        fs::write(&file, b"old").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        let pending = Pending::new(&link).unwrap();
        pending.write(b"new").unwrap();
        pending.commit().unwrap();
        assert!(link.is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
    }

    #[cfg(unix)]
    #[test]
    fn a_device_takes_what_was_written_and_stays() {
        let null = Path::new("/dev/null");
        let pending = Pending::new(null).unwrap();
        pending.write(b"whole").unwrap();
        let beside = pending.beside().to_owned();
        pending.commit().unwrap();
        assert!(!fs::metadata(null).unwrap().is_file());
        assert!(!beside.exists());
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
