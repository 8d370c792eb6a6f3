//! What came out of a command: the JSON of the contract, or a few lines for people.

use std::path::PathBuf;

use exurb_city::City;
use exurb_recipe::Seconds;
use serde_json::{Value, json};

use crate::options::RunOptions;
use crate::problem::Problem;
use crate::report;

/// What is in a city (contract, section 5).
pub fn info(city: &City, example: Option<&City>) -> Result<Value, Problem> {
    let _ = example;
    Ok(json!({"streets": {"count": city.streets.edge_count()}, "area_km2": city.area_km2()}))
}

/// Tells what a command made, and how long it took.
pub fn report(
    city: &City,
    example: Option<&City>,
    seconds: Option<Seconds>,
    files: &[&PathBuf],
    options: &RunOptions,
) -> Result<(), Problem> {
    if options.quiet && !options.json {
        return Ok(());
    }
    let mut info = info(city, example)?;
    if options.json {
        if let (Some(object), Some(seconds)) = (info.as_object_mut(), seconds) {
            object.insert("seconds".into(), json!(seconds));
        }
        return report::json(&info);
    }
    let mut text = text(&info);
    if let Some(Seconds { read, learn, synthesise, write }) = seconds {
        let total = read + learn + synthesise + write;
        text.push_str(&format!(
            "time        {total:.2} s: read {read:.2}, learn {learn:.2}, synthesise {synthesise:.2}, \
             write {write:.2}\n"
        ));
    }
    for file in files {
        text.push_str(&format!("written     {}\n", file.display()));
    }
    report::result(&text)
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

/// The report for people: a line for each layer that is there, then what is wrong.
pub fn text(info: &Value) -> String {
    let number = |pointer: &str| info.pointer(pointer).and_then(Value::as_f64);
    let count = |pointer: &str| number(pointer).unwrap_or(0.0);
    let percent =
        |pointer: &str| number(pointer).map_or("-".to_owned(), |v| format!("{:.0} %", v * 100.0));
    let mut lines = vec![format!("area        {:.2} km²", count("/area_km2"))];
    lines.push(format!(
        "streets     {:.1} km in {} pieces ({}); dead ends {}, largest component {}",
        count("/streets/km"),
        count("/streets/count"),
        by_role(info),
        percent("/streets/dead_end_share"),
        percent("/streets/largest_component_share"),
    ));
    lines.push(format!("junctions   {}", count("/intersections/count")));
    if count("/blocks/count") > 0.0 {
        let median = count("/blocks/median_area");
        lines.push(format!("blocks      {}, median {median:.0} m²", count("/blocks/count")));
    }
    if count("/parcels/count") > 0.0 {
        let access = percent("/parcels/street_access_share");
        lines.push(format!("parcels     {}, {access} with street access", count("/parcels/count")));
    }
    if count("/buildings/count") > 0.0 {
        let height =
            number("/buildings/median_height").map(|h| format!(", median height {h:.1} m"));
        lines.push(format!(
            "buildings   {}, coverage {}{}",
            count("/buildings/count"),
            percent("/buildings/coverage"),
            height.unwrap_or_default()
        ));
    }
    lines.push(format!(
        "copied      {} of the streets from examples, {} procedural",
        percent("/provenance/example_share"),
        percent("/provenance/procedural_share")
    ));
    lines.extend(verdict(info));
    lines.join("\n") + "\n"
}

fn by_role(info: &Value) -> String {
    let roles = info.pointer("/streets/km_by_role").and_then(Value::as_object);
    let parts: Vec<String> = roles
        .into_iter()
        .flatten()
        .map(|(role, km)| format!("{role} {:.1}", km.as_f64().unwrap_or(0.0)))
        .collect();
    parts.join(", ")
}

/// Laws that are broken, likeness gates that are missed, the first problems.
fn verdict(info: &Value) -> Vec<String> {
    let mut lines = Vec::new();
    let failed = |group: &str| -> Vec<String> {
        let all = info.get(group).and_then(Value::as_object);
        let failing = all.into_iter().flatten().filter(|(_, law)| law["pass"] == json!(false));
        failing
            .map(|(name, law)| format!("{name} is {} (limit {})", law["value"], law["limit"]))
            .collect()
    };
    let broken = failed("laws");
    lines.push(match broken.is_empty() {
        true => "laws        all hold".to_owned(),
        false => format!("laws        broken: {}", broken.join("; ")),
    });
    let missed = failed("likeness_gates");
    if !missed.is_empty() {
        lines.push(format!("likeness    missed: {}", missed.join("; ")));
    }
    let problems = info.get("problems").and_then(Value::as_array);
    for problem in problems.into_iter().flatten().take(5) {
        let text = |key: &str| problem[key].as_str().unwrap_or_default().to_owned();
        lines.push(format!(
            "  {} {} {}: {}",
            text("layer"),
            problem["id"],
            problem["at"],
            text("message")
        ));
    }
    let total = info.get("problems_total").and_then(Value::as_u64).unwrap_or(0);
    if total > 5 {
        lines.push(format!("  and {} more: --json lists up to 100", total - 5));
    }
    lines
}
