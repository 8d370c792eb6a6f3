//! Other programs, which `cargo xtask test` installs.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::root;

/// Runs a script of `consumers/` on files; what it prints is shown when it fails.
pub fn check(interpreter: &str, script: &str, files: &[&Path]) {
    let Some(program) = std::env::var_os(interpreter) else {
        println!("skipped: no {interpreter}; `cargo xtask test` installs it");
        return;
    };
    let mut command = Command::new(program);
    if let Some(modules) = std::env::var_os("EXURB_NODE_MODULES") {
        command.env("NODE_PATH", modules);
    }
    let script_path = root().join("tests/consumers").join(script);
    let output = command
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .arg(script_path)
        .args(files)
        .stdin(Stdio::null())
        .output()
        .expect("the installed program starts");
    let said = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    println!("{}", said(&output.stdout));
    assert!(output.status.success(), "{script}: {}", said(&output.stderr));
}
