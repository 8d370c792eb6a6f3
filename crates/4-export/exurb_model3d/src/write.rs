//! Files that are whole or not there: written beside, then renamed.

use std::path::Path;

use crate::Error;

pub fn whole(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let failed = |source| Error::Write { path: path.display().to_string(), source };
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    let beside = path.with_file_name(name);
    let written = std::fs::write(&beside, bytes).and_then(|()| std::fs::rename(&beside, path));
    if written.is_err() {
        // What is left of the attempt is of no use; the error tells what matters.
        let _ = std::fs::remove_file(&beside);
    }
    written.map_err(failed)
}
