//! `exurb completions SHELL`

use clap::{ArgMatches, Args, Command, FromArgMatches};
use clap_complete::Shell;
use exurb_recipe::Registry;

use crate::problem::Problem;
use crate::report;

#[derive(Args)]
struct Options {
    /// The shell to complete for
    shell: Shell,
}

/// The command.
pub fn command() -> Command {
    let about = "Print completions for a shell, to be sourced from its start-up file";
    Options::augment_args(Command::new("completions")).about(about)
}

/// Runs it.
pub fn run(matches: &ArgMatches, registry: &Registry) -> Result<(), Problem> {
    let options = Options::from_arg_matches(matches).map_err(|e| Problem::usage(e.to_string()))?;
    let mut script = Vec::new();
    clap_complete::generate(options.shell, &mut super::app(registry), "exurb", &mut script);
    report::result(&String::from_utf8_lossy(&script))
}
