//! What a user reads: messages on standard error, results on standard output.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "the one place that prints")]

use std::io::Write;

use exurb_operation::Warning;
use serde_json::Value;

use crate::problem::Problem;

/// Prints a result. A reader that went away (`| head`) ends the program quietly.
pub fn result(text: &str) -> Result<(), Problem> {
    let mut out = std::io::stdout().lock();
    let line_end = if text.ends_with('\n') { "" } else { "\n" };
    match write!(out, "{text}{line_end}").and_then(|()| out.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Problem::failed(format!("standard output cannot be written: {e}")))
        }
        _ => Ok(()),
    }
}

/// Prints a result as JSON.
pub fn json(value: &Value) -> Result<(), Problem> {
    result(&format!("{value:#}"))
}

/// Prints warnings.
pub fn warnings(warnings: &[Warning]) {
    for Warning { from, message } in warnings {
        let from = if from.is_empty() { String::new() } else { format!("{from}: ") };
        message_line(&format!("warning: {from}{message}"));
    }
}

/// Prints what went wrong.
pub fn problem(problem: &Problem) {
    message_line(&format!("error: {}", problem.message));
}

/// A line on standard error; nobody to read it is no reason to fail.
pub fn message_line(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}
