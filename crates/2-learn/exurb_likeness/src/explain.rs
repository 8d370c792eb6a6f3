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

/// A figure with its unit: three digits, two of what is less than 1, but no more than four decimals.
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
    let rounded = format!("{value:.digits$}");
    // A tiny negative value is a plain 0.
    let plain = if rounded.trim_start_matches(['-', '0', '.']).is_empty() { "0" } else { &rounded };
    format!("{plain}{space}{unit}")
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
        _ if measure.distance == Distance::Variation => {
            format!(
                "{}: dead ends, junctions of three and of four are mixed differently.",
                words.title
            )
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
        return format!("{}: typical and outer values are alike, others are not.", words.title);
    }
    format!(
        "{} vary differently: four in five lie within {} instead of {}.",
        words.subject,
        range(candidate, words.unit),
        range(held_out, "")
    )
}

/// From this score on a measure counts as alike and is not named among the worst.
const ALIKE_SCORE: f64 = 0.9;

/// The informative measures with the lowest scores, worst first; none that is like the example.
pub fn worst(card: &Scorecard, count: usize) -> Vec<&Score> {
    let scored = card.measures.iter().filter_map(|s| Some((s.score?, s)));
    let mut scored: Vec<(f64, &Score)> = scored.filter(|(score, _)| *score < ALIKE_SCORE).collect();
    scored.sort_by(|a, b| a.0.total_cmp(&b.0));
    scored.into_iter().take(count).map(|(_, measure)| measure).collect()
}
