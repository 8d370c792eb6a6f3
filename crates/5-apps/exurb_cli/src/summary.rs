//! What came out of a command: the JSON of the contract, or a few lines for people.

use std::path::PathBuf;

use exurb_city::City;
use exurb_measure::Info;
use exurb_recipe::{Recipe, Seconds};
use serde_json::json;

use crate::options::RunOptions;
use crate::problem::Problem;
use crate::report;

/// Tells what a command made, and how long it took.
pub fn report(
    city: &City,
    example: Option<&City>,
    seconds: Seconds,
    files: &[&PathBuf],
    options: &RunOptions,
) -> Result<(), Problem> {
    if options.quiet && !options.json {
        return Ok(());
    }
    let info = Info::of(city, example);
    if options.json {
        let mut value = json!(info);
        if let Some(object) = value.as_object_mut() {
            object.insert("seconds".into(), json!(seconds));
        }
        return report::json(&value);
    }
    let Seconds { read, learn, synthesise, write } = seconds;
    let mut text = brief(&info);
    text.push_str(&format!(
        "time            {:.2} s: read {read:.2}, learn {learn:.2}, synthesise {synthesise:.2}, \
         write {write:.2}\n",
        read + learn + synthesise + write
    ));
    for file in files {
        text.push_str(&format!("written         {}\n", file.display()));
    }
    report::result(&text)
}

/// Prints the recipe of a dry run.
pub fn recipe(recipe: &Recipe, options: &RunOptions) -> Result<(), Problem> {
    if options.json { report::json(&json!(recipe)) } else { report::result(&recipe.print()?) }
}

/// Tells which files were written.
pub fn written(files: &[&PathBuf], options: &RunOptions) -> Result<(), Problem> {
    if options.json {
        let names: Vec<String> = files.iter().map(|f| f.display().to_string()).collect();
        return report::json(&json!({ "written": names }));
    }
    if !options.quiet {
        files.iter().for_each(|f| report::message_line(&format!("written {}", f.display())));
    }
    Ok(())
}

/// The figures, then what does not hold, if anything.
fn brief(info: &Info) -> String {
    let whole = info.to_text();
    let figures = whole.split("\n\n").next().unwrap_or(&whole);
    let broken = info.laws.iter().filter(|(_, law)| !law.pass).map(|(name, _)| name.as_str());
    let laws = verdict("broken", &broken.collect::<Vec<_>>());
    format!("{figures}\nlaws            {laws}\n{}", likeness(info))
}

/// How the gates stand; nothing where there is no example to compare with.
fn likeness(info: &Info) -> String {
    let gates = || info.likeness_gates.iter();
    if gates().all(|(_, gate)| gate.pass.is_none()) {
        return String::new();
    }
    let missed = gates().filter(|(_, gate)| gate.pass == Some(false));
    let missed: Vec<&str> = missed.map(|(name, _)| name.as_str()).collect();
    format!("likeness gates  {}\n", verdict("missed", &missed))
}

fn verdict(word: &str, names: &[&str]) -> String {
    match names {
        [] => "all kept".to_owned(),
        names => format!("{word}: {}; `exurb info` tells more", names.join(", ")),
    }
}
