//! Programs that tests and benches run beside ours, installed on first use.
//!
//! Python packages go into an environment and npm packages into a folder under `target/tools`,
//! pinned by the files in `tests/consumers` and `benches`. What Debian has (Chromium, Node, osmium)
//! comes by `apt-get` when it is missing and we may; everything else is left to the user, who is
//! told what to install.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::shell::{Outcome, root, run, succeeds, target};

/// Sets `command` up to find the tools of the consumers' tests.
pub fn hand_over(command: &mut Command) -> Outcome<&mut Command> {
    let python = python("tests", &root().join("tests/consumers/requirements.txt"))?;
    let node_modules = node_modules(&root().join("tests/consumers"))?;
    let chromium = debian("chromium", "chromium")?;
    Ok(command
        .env("EXURB_PYTHON", python)
        .env("EXURB_NODE", debian("node", "nodejs")?)
        .env("EXURB_NODE_MODULES", node_modules)
        .env("EXURB_CHROMIUM", chromium))
}

/// The Python of the environment `name` with the pinned packages of `requirements`.
pub fn python(name: &str, requirements: &Path) -> Outcome<PathBuf> {
    let folder = target().join("tools").join(format!("python-{name}"));
    let python = folder.join("bin/python");
    install_once(&folder, &[requirements], || {
        let system = debian("python3", "python3")?;
        let mut make = Command::new(&system);
        make.args(["-m", "venv", "--clear"]).arg(&folder);
        if !succeeds(Command::new(&system).args(["-c", "import ensurepip"])) {
            apt_install("python3-venv")?;
        }
        run(&mut make)?;
        let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps"];
        run(Command::new(&python).args(pip).arg("--requirement").arg(requirements))
    })?;
    Ok(python)
}

/// A folder of npm packages as the lock file in `source` pins them.
fn node_modules(source: &Path) -> Outcome<PathBuf> {
    let folder = target().join("tools/node");
    let (list, lock) = (source.join("package.json"), source.join("package-lock.json"));
    install_once(&folder, &[&list, &lock], || {
        debian("node", "nodejs")?;
        let npm = debian("npm", "npm")?;
        fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
        for file in [&list, &lock] {
            let copy = folder.join(file.file_name().unwrap_or_default());
            fs::copy(file, copy).map_err(|e| format!("{}: {e}", file.display()))?;
        }
        let quiet = ["ci", "--ignore-scripts", "--no-audit", "--no-fund"];
        run(Command::new(npm).args(quiet).current_dir(&folder))
    })?;
    Ok(folder.join("node_modules"))
}

/// Runs `install` unless `folder` holds what it made from the same `pins` before.
fn install_once(folder: &Path, pins: &[&Path], install: impl FnOnce() -> Outcome) -> Outcome {
    let mut wanted = String::new();
    for pin in pins {
        wanted += &fs::read_to_string(pin).map_err(|e| format!("{}: {e}", pin.display()))?;
    }
    let stamp = folder.join("installed-from");
    if fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted) {
        return Ok(());
    }
    install()?;
    fs::write(&stamp, wanted).map_err(|e| format!("{}: {e}", stamp.display()))
}

/// The path of a program, installed from the Debian package `package` when it is missing.
pub fn debian(program: &str, package: &str) -> Outcome<PathBuf> {
    if find(program).is_none() {
        apt_install(package)?;
    }
    find(program).ok_or_else(|| format!("{program} is not in the path; install {package}"))
}

fn find(program: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let usual = [PathBuf::from("/usr/bin"), PathBuf::from("/usr/local/bin")];
    let folders = std::env::split_paths(&path).chain(usual);
    folders.map(|folder| folder.join(program)).find(|file| file.is_file())
}

fn apt_install(package: &str) -> Outcome {
    let apt = |words: &[&str]| {
        let mut command = Command::new(if is_root() { "apt-get" } else { "sudo" });
        if !is_root() {
            command.args(["--non-interactive", "apt-get"]);
        }
        command.args(words).env("DEBIAN_FRONTEND", "noninteractive");
        command
    };
    let may = find("apt-get").is_some()
        && (is_root() || succeeds(Command::new("sudo").args(["--non-interactive", "true"])));
    if !may {
        return Err(format!("the tests need {package}: install it, or run as root on Debian"));
    }
    run(&mut apt(&["update", "--quiet"]))?;
    run(&mut apt(&["install", "--quiet", "--yes", "--no-install-recommends", package]))
}

fn is_root() -> bool {
    let output = Command::new("id").arg("-u").output();
    output.is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}
