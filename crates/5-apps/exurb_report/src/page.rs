//! The page, section by section.

use exurb_likeness::explain;

use crate::html::{figure, percent, text};
use crate::{Column, Error, Report, charts, maps, scores, tiles};

const STYLE: &str = include_str!("style.css");
/// Worst measures explained.
const WORST: usize = 3;

/// The whole page.
pub fn page(report: &Report) -> Result<String, Error> {
    let name = text(&report.candidate.metadata.name);
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width\">\
         <title>{name}: how like its example</title>\n<style>{STYLE}</style></head>\n<body>\n\
         <h1>{name}: how like its example?</h1>\n"
    );
    for column in report.columns {
        out += &verdict(column);
    }
    out += "<h2>Side by side</h2>\n";
    out += &maps::maps(report)?;
    for column in report.columns {
        out += &section(column, report.columns.len() > 1);
    }
    out += &laws(report);
    out += &footer(report);
    Ok(out + "</body></html>\n")
}

/// The figures that matter, and what they mean.
fn verdict(column: &Column) -> String {
    let document = column.document;
    let card = |title: &str, score: Option<f64>, about: &str| {
        format!(
            "<div class=\"card\"><b>{}</b><span>{title}</span><small>{about}</small></div>",
            figure(score)
        )
    };
    let mut out = format!("<p class=\"lead\">{}</p>\n<div class=\"cards\">", reading(column));
    out += &card("TOTAL", document.total, "streets and blocks, all measures");
    out += &card("CORE", document.core, "the core measures: those that tell cities apart best");
    if document.built.is_some() {
        out += &card("BUILT", document.built, "buildings and parcels");
    }
    let copied = format!(
        "of junctions stand in the example with all that lies within 300 m; {} within 150 m",
        percent(document.copy_rate_150m)
    );
    out += &format!(
        "<div class=\"card\"><b>{}</b><span>copied</span><small>{copied}</small></div>",
        percent(document.copy_rate_300m)
    );
    out += &format!(
        "<div class=\"card\"><b>{}</b><span>laid from it</span><small>of the street length was \
         copied from this example</small></div></div>\n",
        percent(document.example_share)
    );
    if !document.notes.is_empty() {
        let notes: String =
            document.notes.iter().map(|n| format!("<li>{}</li>", text(n))).collect();
        out += &format!("<ul class=\"notes\">{notes}</ul>\n");
    }
    out
}

/// The score in words.
fn reading(column: &Column) -> String {
    let name = text(&column.document.example);
    let said = match column.document.total {
        None => "Nothing can be said: no measure separates this city from others here.",
        Some(t) if t >= 0.7 => "Statistically it is like real fabric of the same city.",
        Some(t) if t >= 0.5 => {
            "It is clearly the right city, though not quite like its real fabric."
        }
        Some(t) if t >= 0.3 => {
            "The style is partly learned: it is nearer than another real city, but not by much."
        }
        Some(t) if t >= 0.0 => {
            "The style is hardly learned: it is about as far as another real city."
        }
        Some(_) => "It is farther from the example than another real city.",
    };
    format!(
        "Compared with <b>{name}</b>: {}. {said} 1 is as near as the city's own other part, 0 as far as \
         another city; {} of 30 measures of streets and blocks tell something here.",
        text(&column.document.held_out_words()),
        column.document.informative
    )
}

fn section(column: &Column, named: bool) -> String {
    let of = if named { format!(": {}", text(&column.document.example)) } else { String::new() };
    let mut out = format!("<h2>What differs most{of}</h2>\n");
    let worst = explain::worst(&column.likeness.scorecard, WORST);
    if worst.is_empty() {
        out += match column.document.informative {
            0 => "<p>No measure tells anything here.</p>\n",
            _ => "<p>No measure that tells something here differs notably.</p>\n",
        };
    }
    out += "<ol class=\"worst\">\n";
    for (score, sentence) in worst.iter().zip(&column.document.worst) {
        let chart = charts::chart(column, score).unwrap_or_default();
        out += &format!("<li><p>{}</p>{chart}</li>\n", text(sentence));
    }
    out += "</ol>\n";
    if let Some(tiles) = tiles::tiles(column) {
        out += &format!(
            "<h2>Most telling patches{of}</h2>\n<p>Squares of 512 m by which a classifier tells the \
             two cities apart most surely.</p>\n{tiles}"
        );
    }
    out += &format!(
        "<h2>Distributions{of}</h2>\n<p class=\"legend\"><i class=\"new\"></i> the new city \
         <i class=\"held-out\"></i> the example: {} <i class=\"part\"></i> the example: its other part, \
         as on its map</p>\n<p>Of curves and bars, upwards: how frequent. Pale charts have no score: they do not count here.</p>\n\
         <div class=\"charts\">\n{}</div>\n",
        text(&column.document.held_out_words()),
        charts::charts(column)
    );
    out += &format!("<h2>All scores{of}</h2>\n<div class=\"wide\">{}</div>", scores::table(column));
    let floor: Vec<String> = column.document.floor.iter().map(|name| text(name)).collect();
    let [width, height] = column.document.window_m;
    out + &format!(
        "<p class=\"fine\">Windows of {width:.0} m × {height:.0} m. Another city is the mean of {}: scores \
         made with other cities must not be compared with these. • core measure; pale rows do not \
         separate cities here and do not count.</p>\n",
        floor.join(", ")
    )
}

fn laws(report: &Report) -> String {
    let value = |v: Option<f64>| v.map_or("–".to_owned(), |v| format!("{v:.3}"));
    let mut out = "<h2>Laws and likeness gates</h2>\n<table class=\"laws\"><tr><th>law</th>\
                   <th>value</th><th>limit</th><th></th></tr>"
        .to_owned();
    for (name, law) in &report.info.laws {
        let verdict = if law.pass { "kept" } else { "<b>broken</b>" };
        out += &format!(
            "<tr><td><code>{name}</code></td><td>{}</td><td>{}</td><td>{verdict}</td></tr>\n",
            value(law.value),
            value(Some(law.limit))
        );
    }
    out +=
        "</table><table class=\"laws\"><tr><th>gate</th><th>value</th><th>limit</th><th></th></tr>";
    for (name, gate) in &report.info.likeness_gates {
        let verdict = match gate.pass {
            Some(true) => "passed",
            Some(false) => "<b>missed</b>",
            None => "–",
        };
        out += &format!(
            "<tr><td><code>{name}</code></td><td>{}</td><td>{}</td><td>{verdict}</td></tr>\n",
            value(gate.value),
            value(gate.limit)
        );
    }
    out + "</table>\n"
}

fn footer(report: &Report) -> String {
    let mut credits: Vec<&String> = report.candidate.metadata.attribution.iter().collect();
    for column in report.columns {
        for line in
            column.example.metadata.attribution.iter().chain(&column.held_out.metadata.attribution)
        {
            if !credits.contains(&line) {
                credits.push(line);
            }
        }
    }
    let credits: Vec<String> = credits.into_iter().map(|line| text(line)).collect();
    format!(
        "<footer>Made by exurb {}. Data: {}. The floor was measured on OpenStreetMap data, © \
         OpenStreetMap contributors, ODbL 1.0.</footer>\n",
        env!("CARGO_PKG_VERSION"),
        credits.join("; ")
    )
}
