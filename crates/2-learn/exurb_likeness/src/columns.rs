//! A candidate beside several examples: one column each.

use std::fmt::Write;

use crate::Document;
use crate::measures::Family;

/// Width of a column.
const WIDTH: usize = 16;

/// Scores, copy rates and provenance, a row each and a column for every example. For a merged or
/// blended city it tells which example it is like, and from which it was made.
pub fn side_by_side(documents: &[Document]) -> String {
    let mut out = row("", documents, |d| shortened(&d.example));
    let figure = |value: Option<f64>| value.map_or("-".to_owned(), |v| format!("{v:.2}"));
    type Value = fn(&Document) -> Option<f64>;
    let wholes: [(&str, Value); 3] =
        [("TOTAL", |d| d.total), ("CORE", |d| d.core), ("BUILT", |d| d.built)];
    for (name, value) in wholes {
        out += &row(name, documents, |d| figure(value(d)));
    }
    for family in Family::STREETS.into_iter().chain(Family::BUILT) {
        let score = |d: &Document| d.families.get(family.name()).copied().flatten();
        if documents.iter().any(|d| score(d).is_some()) {
            let name = format!("  {}", family.name());
            out += &row(&name, documents, |d| figure(score(d)));
        }
    }
    let origins: [(&str, Value); 3] = [
        ("copied within 150 m", |d| d.copy_rate_150m),
        ("copied within 300 m", |d| d.copy_rate_300m),
        ("laid from it", |d| d.example_share),
    ];
    for (name, value) in origins {
        out += &row(name, documents, |d| figure(value(d)));
    }
    out
}

fn row(name: &str, documents: &[Document], cell: impl Fn(&Document) -> String) -> String {
    let mut out = format!("{name:<24}");
    for document in documents {
        let _ = write!(out, " {:>WIDTH$}", cell(document));
    }
    out.push('\n');
    out
}

/// A name that fits its column.
fn shortened(name: &str) -> String {
    match name.chars().count() {
        fits if fits <= WIDTH => name.to_owned(),
        _ => name.chars().take(WIDTH - 1).chain(['…']).collect(),
    }
}
