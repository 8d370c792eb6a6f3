//! The rows a bench prints: ours, the yardstick's, the ratio.

/// Which way is good.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Better {
    /// Seconds, megabytes.
    Less,
    /// Kilometres a second.
    More,
}

/// Prints the name of a bench and its columns.
pub fn heading(title: &str) {
    println!("\n{title}");
    println!("{:<44} {:>12} {:>12}  {:<34} {:>8}", "", "exurb", "yardstick", "which", "ratio");
}

/// Prints one comparison. The ratio says how many times better exurb is; below 1 it is worse.
pub fn row(what: &str, unit: &str, ours: f64, yardstick: f64, which: &str, better: Better) {
    let ratio = match better {
        Better::Less => yardstick / ours,
        Better::More => ours / yardstick,
    };
    let figure = |value: f64| format!("{} {unit}", short(value));
    println!(
        "{what:<44} {:>12} {:>12}  {which:<34} {:>8}",
        figure(ours),
        figure(yardstick),
        short(ratio)
    );
}

/// Prints a remark under the rows.
pub fn note(text: &str) {
    println!("  {text}");
}

/// Three significant figures.
fn short(value: f64) -> String {
    match value.abs() {
        v if v >= 100.0 => format!("{value:.0}"),
        v if v >= 10.0 => format!("{value:.1}"),
        v if v >= 0.1 => format!("{value:.2}"),
        _ => format!("{value:.4}"),
    }
}
