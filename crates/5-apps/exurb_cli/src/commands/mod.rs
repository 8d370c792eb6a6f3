//! The commands, a file for each.

mod compare;
mod completions;
mod demo;
mod export;
mod import;
mod info;
mod learn;
mod method;
mod render;
mod run;
mod schema;

use clap::{ArgMatches, Command};
use exurb_recipe::Registry;

use crate::problem::Problem;

/// The stages whose methods are commands, each with what it is about.
const STAGES: [(&str, &str); 3] = [
    ("streets", "Make streets, intersections and blocks, or furnish them with trees and lamps"),
    ("blocks", "Make parcels and footprints in the blocks of a city"),
    ("buildings", "Complete height, levels, roof and shape of a city's buildings"),
];

/// The command line.
pub fn app(registry: &Registry) -> Command {
    let stages = STAGES.iter().map(|(stage, about)| method::stage(stage, about, registry));
    Command::new("exurb")
        .version(env!("CARGO_PKG_VERSION"))
        .about("Example-based urban modelling: new cities in the style of real ones")
        .after_help("Begin with `exurb demo`. Each command explains itself with --help.")
        .subcommand_required(true)
        .arg_required_else_help(true)
        .max_term_width(100)
        .subcommand(demo::command())
        .subcommand(run::command())
        .subcommand(import::command())
        .subcommand(info::command())
        .subcommands(stages)
        .subcommand(export::command())
        .subcommand(render::command())
        .subcommand(compare::command())
        .subcommand(learn::command())
        .subcommand(schema::command())
        .subcommand(completions::command())
}

/// Runs the command that was asked for.
pub fn dispatch(matches: &ArgMatches, registry: &Registry) -> Result<(), Problem> {
    match matches.subcommand() {
        Some(("demo", matches)) => demo::run(matches, registry),
        Some(("run", matches)) => run::run(matches, registry),
        Some(("import", matches)) => import::run(matches),
        Some(("info", matches)) => info::run(matches),
        Some(("export", matches)) => export::run(matches),
        Some(("render", matches)) => render::run(matches),
        Some(("compare", matches)) => compare::run(matches),
        Some(("learn", matches)) => learn::run(matches, registry),
        Some(("schema", matches)) => schema::run(matches, registry),
        Some(("completions", matches)) => completions::run(matches, registry),
        Some((stage, matches)) => method::run(stage, matches, registry),
        None => Err(Problem::usage("no command was given; see exurb --help")),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_command_line_is_sound() {
        super::app(&exurb_recipe::Registry::all()).debug_assert();
    }
}
