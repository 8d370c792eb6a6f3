//! `exurb schema [METHOD]`

use clap::{ArgMatches, Args, Command, FromArgMatches};
use exurb_operation::AnyOperation;
use exurb_recipe::Registry;
use serde_json::{Map, Value};

use crate::problem::Problem;
use crate::report;

#[derive(Args)]
struct Options {
    /// Command words of one method, as in streets grow; every method when absent
    #[arg(value_name = "METHOD", num_args = 0..=2)]
    method: Vec<String>,
}

/// The command.
pub fn command() -> Command {
    Options::augment_args(Command::new("schema")).about("Parameters of the methods as JSON Schema")
}

/// Runs it.
pub fn run(matches: &ArgMatches, registry: &Registry) -> Result<(), Problem> {
    let options = Options::from_arg_matches(matches).map_err(|e| Problem::usage(e.to_string()))?;
    if options.method.is_empty() {
        let all = registry.iter().map(|operation| (operation.card().name(), schema(operation)));
        return report::json(&Value::Object(all.collect::<Map<_, _>>()));
    }
    let name = options.method.join(" ");
    report::json(&schema(registry.find(&name).map_err(Problem::usage)?))
}

/// The parameters' schema, under the operation's name and summary.
fn schema(operation: &dyn AnyOperation) -> Value {
    let card = operation.card();
    let mut schema = operation.schema();
    if let Some(object) = schema.as_object_mut() {
        object.insert("title".into(), card.name().into());
        object.insert("description".into(), card.summary.into());
        object.insert("x-source".into(), card.source.into());
    }
    schema
}
