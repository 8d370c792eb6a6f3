//! Running other programs: printed before, checked after, never reading from the keyboard.

use std::ffi::OsStr;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// What a task returns; the message is one sentence for a person.
pub type Outcome<T = ()> = Result<T, String>;

/// The root of the repository.
pub fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().expect("xtask lies in the repository").to_owned()
}

/// Where built things go.
pub fn target() -> PathBuf {
    let chosen = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    root().join(chosen.unwrap_or_else(|| "target".into()))
}

/// `cargo` in the repository, with the arguments of `line`.
pub fn cargo(line: &str) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root()).args(line.split_whitespace());
    command
}

/// Prints a command.
fn announce(command: &Command) {
    let program = Path::new(command.get_program()).file_name().unwrap_or_default();
    let words: Vec<_> =
        std::iter::once(program).chain(command.get_args()).map(OsStr::to_string_lossy).collect();
    println!("\n$ {}", words.join(" "));
}

/// Runs a command; an error when it cannot start or fails.
pub fn run(command: &mut Command) -> Outcome {
    announce(command);
    let status = command.stdin(Stdio::null()).status();
    finish(command, status.map_err(|e| e.to_string())?.success())
}

/// Runs a command and hands over each line of its output after printing it.
pub fn run_reading(command: &mut Command, mut line: impl FnMut(&str)) -> Outcome {
    announce(command);
    let mut child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|e| format!("{} does not start: {e}", name(command)))?;
    let output = child.stdout.take().expect("the output is piped");
    for text in BufReader::new(output).lines().map_while(Result::ok) {
        println!("{text}");
        line(&text);
    }
    let status = child.wait().map_err(|e| e.to_string())?;
    finish(command, status.success())
}

/// The output of a quiet command that succeeds.
pub fn output_of(command: &mut Command) -> Outcome<String> {
    let output = command
        .stdin(Stdio::null())
        .stderr(Stdio::inherit())
        .output()
        .map_err(|e| format!("{} does not start: {e}", name(command)))?;
    finish(command, output.status.success())?;
    String::from_utf8(output.stdout).map_err(|e| e.to_string())
}

/// Does a command start and succeed? Its output is dropped.
pub fn succeeds(command: &mut Command) -> bool {
    let quiet = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    quiet.status().is_ok_and(|status| status.success())
}

fn name(command: &Command) -> String {
    command.get_program().to_string_lossy().into_owned()
}

fn finish(command: &Command, success: bool) -> Outcome {
    if success { Ok(()) } else { Err(format!("{} failed", name(command))) }
}
