//! Scenarios: a folder of `scenarios/` each; its form is told in `scenarios/README.md`.

use std::fs;
use std::path::Path;

use exurb_scenarios::{Finished, exurb, root, shared_data};

include!(concat!(env!("OUT_DIR"), "/scenarios.rs"));

fn scenario(name: &str) {
    let folder = root().join("tests/scenarios").join(name);
    let text = fs::read_to_string(folder.join("scenario.toml")).expect("a scenario has this file");
    let plan: toml::Table = text.parse().expect("scenario.toml is TOML");
    let Some(shared) = shared_data().or_else(|| (!text.contains("{shared}")).then(root)) else {
        return;
    };
    let out = tempfile::tempdir().expect("a temporary folder can be made");
    let fill = |line: &str| {
        line.replace("{in}", &folder.to_string_lossy())
            .replace("{data}", &root().join("data").to_string_lossy())
            .replace("{shared}", &shared.to_string_lossy())
            .replace("{out}", &out.path().to_string_lossy())
    };

    let lines = plan["commands"].as_array().expect("`commands` is a list");
    for (index, line) in lines.iter().enumerate() {
        let line = line.as_str().expect("a command is one line");
        let done = exurb(fill(line).split_whitespace());
        if index + 1 == lines.len() {
            ends_as_told(&plan, line, &done);
        } else {
            assert_eq!(done.status, Some(0), "exurb {line}: {}", done.stderr);
        }
    }
    if let Some(city) = plan.get("info").and_then(|city| city.as_str()) {
        let city = fill(city);
        let info = exurb(["info", &city, "--json"]);
        assert_eq!(info.status, Some(0), "exurb info: {}", info.stderr);
        compare(&folder.join("expected.json"), &info.stdout);
    }
    if plan.get("status").is_some() {
        let left: Vec<_> = fs::read_dir(out.path()).expect("it is there").collect();
        assert!(left.is_empty(), "a failed run left {left:?}");
    }
}

/// Exit status and message of the last command, 0 and nothing unless told.
fn ends_as_told(plan: &toml::Table, line: &str, done: &Finished) {
    let status = plan.get("status").and_then(|status| status.as_integer()).unwrap_or(0);
    let ended = done.status.map(i64::from);
    assert_eq!(ended, Some(status), "exurb {line}: {}", done.stderr);
    if let Some(message) = plan.get("message").and_then(|message| message.as_str()) {
        assert!(done.stderr.contains(message), "`{message}` is not in: {}", done.stderr);
    }
}

/// What came out against what should; `EXURB_BLESS=1` accepts it.
fn compare(expected: &Path, got: &str) {
    let value: serde_json::Value = serde_json::from_str(got).expect("--json prints JSON");
    let got = serde_json::to_string_pretty(&value).expect("JSON can be printed") + "\n";
    if std::env::var_os("EXURB_BLESS").is_some() {
        fs::write(expected, got).expect("the scenario's folder can be written");
        return;
    }
    let wanted = fs::read_to_string(expected).unwrap_or_default();
    let differs = wanted.lines().zip(got.lines()).position(|(wanted, got)| wanted != got);
    if let Some(line) = differs {
        let of = |text: &str| text.lines().nth(line).unwrap_or_default().trim().to_owned();
        panic!(
            "{}, line {}: expected `{}`, got `{}`; look, then `cargo xtask bless`",
            expected.display(),
            line + 1,
            of(&wanted),
            of(&got)
        );
    }
    assert_eq!(wanted.len(), got.len(), "{} has another length", expected.display());
}
