//! `test` and `bless`.

use std::process::Command;

use crate::shell::{self, Outcome, cargo, output_of, root};
use crate::tools;

/// All tests: units, laws, docs, scenarios, determinism, consumers, fuzz bodies over their corpus.
pub fn run() -> Outcome {
    let before = tree_state();
    if !root().join("../shared/data").is_dir() {
        println!("no ../shared/data beside the repository: tests on its maps print `skipped`");
    }
    let mut tests = cargo("test --workspace --locked --no-fail-fast");
    // One seed for property tests here, so that a run says the same twice; other seeds whenever
    // somebody runs `cargo test`, whose findings proptest writes down beside the source.
    tests.env("PROPTEST_RNG_SEED", "1").env("PROPTEST_DISABLE_FAILURE_PERSISTENCE", "true");
    let (mut passed, mut failed, mut suites) = (0, 0, 0);
    let outcome = shell::run_reading(tools::hand_over(&mut tests)?, |line| {
        if let Some((good, bad)) = counts(line) {
            (passed, failed, suites) = (passed + good, failed + bad, suites + 1);
        }
    });
    let verdict = if outcome.is_ok() { "ok" } else { "FAILED" };
    println!("\ntest result: {verdict}. {passed} passed; {failed} failed; all {suites} suites");
    outcome?;
    clean(&before)
}

/// Accepts what the scenarios give now.
pub fn bless() -> Outcome {
    shell::run(cargo("test --package exurb_scenarios --test scenarios").env("EXURB_BLESS", "1"))?;
    shell::run(&mut cargo("test --package exurb_scenarios --test scenarios"))
}

/// Passed and failed of a line `test result: ok. 3 passed; 0 failed; ...`.
fn counts(line: &str) -> Option<(u32, u32)> {
    let rest = line.strip_prefix("test result: ")?;
    let (_, rest) = rest.split_once(". ")?;
    let mut numbers = rest.split("; ").map(|part| part.split(' ').next()?.parse().ok());
    Some((numbers.next()??, numbers.next()??))
}

/// What git says of the tree; nothing where there is no git.
fn tree_state() -> String {
    let mut git = Command::new("git");
    output_of(git.args(["status", "--porcelain"]).current_dir(root())).unwrap_or_default()
}

/// In CI, tests must leave the tree as they found it.
fn clean(before: &str) -> Outcome {
    let after = tree_state();
    if std::env::var_os("CI").is_none() || after == before {
        return Ok(());
    }
    Err(format!("the tests changed the tree:\n{after}"))
}

#[cfg(test)]
mod tests {
    use super::counts;

    #[test]
    fn cargo_s_summary_is_counted() {
        let line = "test result: FAILED. 12 passed; 3 failed; 0 ignored; 0 measured; finished";
        assert_eq!(counts(line), Some((12, 3)));
        assert_eq!(counts("test grow::tests::is_planar ... ok"), None);
    }
}
