//! Distributions overlaid: the new city, the example's held-out part, the example's own part.

use std::fmt::Write;

use exurb_geom::trig;
use exurb_likeness::explain::figure;
use exurb_likeness::measures::Distance;
use exurb_likeness::words::{Words, words};
use exurb_likeness::{Measure, Measured, Score};
use exurb_measure::Sample;

use crate::Column;
use crate::html::{self, text};

/// Size of a chart in its own units.
const WIDTH: f64 = 300.0;
const HEIGHT: f64 = 110.0;
/// Bins of a histogram, each smoothed with its neighbours.
const BINS: usize = 40;
/// Radius of a rose; three stand beside each other.
const ROSE: f64 = 49.0;
/// A unit that stands at the figures themselves.
const DEGREES: &str = "°";
/// Blocks drawn of a fingerprint.
const DOTS: usize = 300;

/// The three sets of a chart with their classes, drawn in this order.
type Sets<'a> = [(&'a Measured, &'static str); 3];

fn sets<'a>(column: &Column<'a>) -> Sets<'a> {
    [
        (&column.reference.part.measured, "part"),
        (column.reference.yardstick.held_out().measured(), "held-out"),
        (&column.likeness.candidate.measured, "new"),
    ]
}

/// Charts of all measures that can be drawn, in the order of the scorecard.
pub fn charts(column: &Column) -> String {
    let cards = column.likeness.scorecard.measures.iter();
    cards.filter_map(|score| chart(column, score)).collect()
}

/// One measure: title, score, chart. `None` where there is nothing to draw.
pub fn chart(column: &Column, score: &Score) -> Option<String> {
    let measure = &score.measure;
    let sets = sets(column);
    let drawing = match measure.distance {
        Distance::Wasserstein(_) => histograms(measure, &sets)?,
        Distance::Variation => degrees(&sets)?,
        Distance::Rotation => roses(&sets)?,
        Distance::Discrepancy => dots(&sets)?,
        Distance::Classifier | Distance::Kernel => return None,
    };
    let faded = if score.informative { "" } else { " faded" };
    Some(format!(
        "<figure class=\"chart{faded}\"><figcaption><b>{}</b> <code>{}</code>{}</figcaption>\
         <svg viewBox=\"0 0 {WIDTH} {}\">{drawing}</svg></figure>\n",
        text(&title(words(measure))),
        measure.name,
        score.score.map_or(String::new(), |_| format!(" score {}", html::figure(score.score))),
        HEIGHT + 14.0,
    ))
}

/// What is measured, its scale and its unit; degrees stand at the axis.
fn title(words: Words) -> String {
    let scale = if words.scale.is_empty() { String::new() } else { format!(": {}", words.scale) };
    let logarithmic = if words.is_log { ", logarithmic" } else { "" };
    match words.unit {
        "" | DEGREES => format!("{}{scale}", words.title),
        unit => format!("{}{scale} ({unit}{logarithmic})", words.title),
    }
}

/// Shares by value, as lines.
fn histograms(measure: &Measure, sets: &Sets) -> Option<String> {
    let samples: Vec<(&Sample, &str)> =
        sets.iter().filter_map(|(m, class)| Some((m.samples.get(measure.name)?, *class))).collect();
    let ends = samples.iter().flat_map(|(s, _)| s.quantiles(&[0.005, 0.995]));
    let (low, high) =
        ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if samples.is_empty() || high - low < 1e-12 {
        return None;
    }
    let curves: Vec<(Vec<f64>, &str)> =
        samples.iter().map(|(s, class)| (bins(s, low, high), *class)).collect();
    let top = curves.iter().flat_map(|(c, _)| c).fold(0.0_f64, |a, b| a.max(*b));
    let mut out = String::new();
    for (curve, class) in &curves {
        let x = |i: usize| WIDTH * (i as f64 + 0.5) / BINS as f64;
        let y = |v: f64| HEIGHT * (1.0 - 0.95 * v / top);
        let points: Vec<String> =
            curve.iter().enumerate().map(|(i, v)| format!("{:.1},{:.1}", x(i), y(*v))).collect();
        let points = points.join(" ");
        if *class == "held-out" {
            let _ = write!(
                out,
                "<polygon class=\"{class}\" points=\"{:.1},{HEIGHT} {points} {:.1},{HEIGHT}\"/>",
                x(0),
                x(BINS - 1)
            );
        } else {
            let _ = write!(out, "<polyline class=\"{class}\" points=\"{points}\"/>");
        }
    }
    let words = words(measure);
    Some(out + &axis(low, high, words.is_log, words.unit == DEGREES))
}

/// Weighted shares of bins, smoothed; what lies beyond the ends counts in the last bin.
fn bins(sample: &Sample, low: f64, high: f64) -> Vec<f64> {
    let mut counts = vec![0.0; BINS];
    for (value, weight) in sample.values().iter().zip(sample.weights()) {
        let at = (value - low) / (high - low) * BINS as f64;
        counts[(at.max(0.0) as usize).min(BINS - 1)] += weight;
    }
    let total: f64 = counts.iter().sum();
    let at = |i: usize| counts[i] / total;
    let smooth =
        |i: usize| (at(i.saturating_sub(1)) + 2.0 * at(i) + at((i + 1).min(BINS - 1))) / 4.0;
    (0..BINS).map(smooth).collect()
}

/// Ground line, and the values at both ends and in the middle.
fn axis(low: f64, high: f64, is_log: bool, is_degrees: bool) -> String {
    let mut out = format!("<path class=\"axis\" d=\"M0 {HEIGHT}H{WIDTH}\"/>");
    let places = [(0.0, "start"), (0.5, "middle"), (1.0, "end")];
    for (share, anchor) in places {
        let value = low + (high - low) * share;
        let value = if is_log { trig::pow(10.0, value) } else { value };
        let label = figure(value, if is_degrees { DEGREES } else { "" });
        let _ = write!(
            out,
            "<text x=\"{:.0}\" y=\"{:.0}\" text-anchor=\"{anchor}\">{label}</text>",
            WIDTH * share,
            HEIGHT + 12.0
        );
    }
    out
}

/// Shares of nodes by degree, as bars side by side.
fn degrees(sets: &Sets) -> Option<String> {
    let mut out = String::new();
    let slot = WIDTH / 5.0;
    for (number, (measured, class)) in sets.iter().enumerate() {
        for (degree, share) in measured.degrees?.iter().enumerate() {
            let height = HEIGHT * share;
            let x = slot * (degree as f64 + 0.2 + 0.2 * number as f64);
            let _ = write!(
                out,
                "<rect class=\"{class} bar\" x=\"{x:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{height:.1}\"/>",
                HEIGHT - height,
                0.18 * slot
            );
        }
    }
    for (degree, label) in ["dead end", "2", "3 streets", "4", "5 and more"].iter().enumerate() {
        let x = slot * (degree as f64 + 0.5);
        let _ = write!(
            out,
            "<text x=\"{x:.0}\" y=\"{:.0}\" text-anchor=\"middle\">{label}</text>",
            HEIGHT + 12.0
        );
    }
    Some(out)
}

/// Street length by direction, as roses side by side.
fn roses(sets: &Sets) -> Option<String> {
    let mut out = String::new();
    for (number, (measured, class)) in sets.iter().enumerate() {
        let shares = measured.bearings?;
        let top = shares.iter().fold(0.0_f64, |a, b| a.max(*b));
        let middle = WIDTH * (number as f64 + 0.5) / 3.0;
        let both = shares.iter().chain(&shares).enumerate();
        let points: Vec<String> = both
            .map(|(i, share)| {
                let angle = (i as f64 + 0.5) * 5.0_f64.to_radians();
                // By area, as the eye sees it.
                let at = trig::unit(angle) * (ROSE * (share / top).sqrt());
                format!("{:.1},{:.1}", middle + at.x, HEIGHT / 2.0 - at.y)
            })
            .collect();
        let _ = write!(out, "<polygon class=\"{class}\" points=\"{}\"/>", points.join(" "));
    }
    Some(out)
}

/// Area of blocks across, their Φ upwards, as dots.
fn dots(sets: &Sets) -> Option<String> {
    let (low, high) = (2.2, 6.2);
    let mut out = String::new();
    for (measured, class) in sets.iter().filter(|(_, class)| *class != "part") {
        let blocks = &measured.fingerprint;
        let step = blocks.len().div_ceil(DOTS).max(1);
        for ([area, phi], _) in blocks.iter().step_by(step) {
            let (x, y) = (WIDTH * (area - low) / (high - low), HEIGHT * (1.0 - phi));
            let _ =
                write!(out, "<circle class=\"{class}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"1.6\"/>");
        }
    }
    (!out.is_empty()).then(|| out + &axis(low, high, true, false))
}
