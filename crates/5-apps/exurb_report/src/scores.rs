//! The table of scores: each distance drawn between its ceiling and its floor.

use std::fmt::Write;

use exurb_likeness::document::MeasureDocument;
use exurb_likeness::measures::find;
use exurb_likeness::words::words;

use crate::Column;
use crate::html::{figure, text};

/// Length of a scale in pixels: from worse than another city (-1) to better than the ceiling (1.5), with
/// room for half a dot at both ends.
const LENGTH_PX: f64 = 150.0;
const ENDS: (f64, f64) = (-1.0, 1.5);
const DOT_PX: f64 = 4.5;

/// The table of one example.
pub fn table(column: &Column) -> String {
    let mut out =
        "<table class=\"scores\"><thead><tr><th>measure</th><th>example</th><th>new city</th>\
                   <th>distance</th><th>ceiling</th><th>floor</th><th>score</th>\
                   <th class=\"scale\">another city&nbsp;· · ·&nbsp;itself</th></tr></thead>\n"
            .to_owned();
    let mut family = "";
    for (name, m) in &column.document.measures {
        if m.distance.or(m.ceiling).is_none() && m.score.is_none() {
            continue;
        }
        if m.family != family {
            family = m.family;
            let score = column.document.families.get(family).copied().flatten();
            let _ = writeln!(
                out,
                "<tr class=\"family\"><th colspan=\"6\">{}</th><th>{}</th><td>{}</td></tr>",
                text(&family.replace('_', " ")),
                figure(score),
                scale(score)
            );
        }
        let _ = writeln!(
            out,
            "<tr{}><td>{}{} <code>{name}</code></td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>\
             <td>{}</td><td>{}</td><td>{}</td></tr>",
            if m.informative { "" } else { " class=\"faded\"" },
            if m.core { "<b title=\"core measure\">•</b> " } else { "" },
            text(find(name).map_or("", |measure| words(measure).title)),
            text(&MeasureDocument::with_unit(name, m.example)),
            text(&MeasureDocument::with_unit(name, m.candidate)),
            figure(m.distance),
            figure(m.ceiling),
            figure(m.floor),
            figure(m.score),
            scale(m.score)
        );
    }
    out + "</table>\n"
}

/// A score on its scale.
fn scale(score: Option<f64>) -> String {
    let share = |v: f64| (v.clamp(ENDS.0, ENDS.1) - ENDS.0) / (ENDS.1 - ENDS.0);
    let place = |v: f64| DOT_PX + (LENGTH_PX - 2.0 * DOT_PX) * share(v);
    let dot = score.map_or(String::new(), |score| {
        let class = match score {
            s if s >= 0.7 => "good",
            s if s >= 0.3 => "fair",
            _ => "poor",
        };
        format!("<circle class=\"{class}\" cx=\"{:.1}\" cy=\"7\" r=\"{DOT_PX}\"/>", place(score))
    });
    format!(
        "<svg class=\"scale\" width=\"{LENGTH_PX}\" height=\"14\"><path d=\"M0 7H{LENGTH_PX}M{0:.1} 1v12M{1:.1} 1v12\"/>{dot}</svg>",
        place(0.0),
        place(1.0)
    )
}
