//! What a score means, in a sentence a planner understands.

use crate::Measured;
use crate::measures::{Distance, Measure};
use crate::scorecard::{Score, Scorecard};
use crate::words::words;

/// Typical value of a measure: the median, in its own unit (logarithms undone); of degrees the mean.
/// `None` where it is no single number, or absent.
pub fn typical(measured: &Measured, measure: &Measure) -> Option<f64> {
    match measure.distance {
        Distance::Wasserstein(_) => quantile(measured, measure, 0.5),
        Distance::Variation => {
            let degrees = measured.degrees?;
            Some(degrees.iter().zip(1..).map(|(share, degree)| share * f64::from(degree)).sum())
        }
        _ => None,
    }
}

fn quantile(measured: &Measured, measure: &Measure, share: f64) -> Option<f64> {
    let value = *measured.samples.get(measure.name)?.quantiles(&[share]).first()?;
    Some(if words(measure).is_log { exurb_geom::trig::pow(10.0, value) } else { value })
}

/// A figure with its unit: three digits, two of what is less than 1.
pub fn figure(value: f64, unit: &str) -> String {
    let digits = match value.abs() {
        v if v >= 99.5 => 0,
        v if v >= 9.95 => 1,
        v if v >= 0.0995 => 2,
        v if v >= 0.00995 => 3,
        v if v >= 0.00005 => 4,
        _ => 0,
    };
    let space = if unit.is_empty() || unit.starts_with('°') { "" } else { " " };
    format!("{value:.digits$}{space}{unit}")
}

/// How the candidate differs from the held-out part in one measure.
pub fn sentence(score: &Score, candidate: &Measured, held_out: &Measured) -> String {
    let measure = &score.measure;
    let words = words(measure);
    let subject = words.subject;
    let Some(distance) = score.distance else {
        return format!("{}: the new city has too few to tell.", words.title);
    };
    match typical(candidate, measure).zip(typical(held_out, measure)) {
        Some((own, wanted)) if differ(own, wanted) => {
            let how = if own > wanted { words.more } else { words.less };
            let (own, wanted) = (figure(own, words.unit), figure(wanted, ""));
            format!("{subject} {how} than in the example: typically {own} instead of {wanted}.")
        }
        Some(_) if matches!(measure.distance, Distance::Wasserstein(_)) => {
            spread_sentence(measure, candidate, held_out)
        }
        _ if measure.distance == Distance::Classifier => format!(
            "{subject} are told from the example's: of a pair a classifier names the new one in \
             {:.0} % of cases, where 50 % would be chance.",
            100.0 * distance
        ),
        _ => format!("{subject} {}.", words.more),
    }
}

/// Do two typical values differ visibly?
fn differ(own: f64, wanted: f64) -> bool {
    (own - wanted).abs() > 0.03 * wanted.abs().max(1e-9) && figure(own, "") != figure(wanted, "")
}

/// Typical values agree, so the spread does not.
fn spread_sentence(measure: &Measure, candidate: &Measured, held_out: &Measured) -> String {
    let words = words(measure);
    let range = |m: &Measured, unit: &str| {
        let [low, high] = [0.1, 0.9].map(|share| quantile(m, measure, share).unwrap_or_default());
        format!("{} to {}", figure(low, ""), figure(high, unit))
    };
    if range(candidate, "") == range(held_out, "") {
        return format!("{}: alike in general, but the rare values differ.", words.title);
    }
    format!(
        "{} vary differently: four in five lie within {} instead of {}.",
        words.subject,
        range(candidate, words.unit),
        range(held_out, "")
    )
}

/// A measure that scores as much is not named as one of the worst.
const LIKE: f64 = 0.9;

/// The informative measures with the lowest scores, worst first; none that is like the example.
pub fn worst(card: &Scorecard, count: usize) -> Vec<&Score> {
    let score = |s: &Score| s.score.unwrap_or_default();
    let scored = card.measures.iter().filter(|s| s.informative && s.score.is_some());
    let mut scored: Vec<&Score> = scored.filter(|s| score(s) < LIKE).collect();
    scored.sort_by(|a, b| score(a).total_cmp(&score(b)));
    scored.truncate(count);
    scored
}
