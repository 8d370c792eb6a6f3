//! Text safe to put into a page.

/// Text with the characters that mean something to HTML replaced.
pub fn text(raw: &str) -> String {
    let mut out = String::with_capacity(raw.len());
    for c in raw.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

/// Two decimals, or a dash.
pub fn figure(value: Option<f64>) -> String {
    // Adding 0 makes -0 a plain 0.
    let hundredths = |v: f64| (v * 100.0).round() / 100.0 + 0.0;
    value.map_or("–".to_owned(), |v| format!("{:.2}", hundredths(v)))
}

/// Hundredths, or a dash.
pub fn percent(value: Option<f64>) -> String {
    value.map_or("–".to_owned(), |v| format!("{:.0} %", 100.0 * v))
}

#[cfg(test)]
mod tests {
    #[test]
    fn names_of_files_cannot_break_a_page() {
        assert_eq!(super::text("<b>\"A&B\"\u{7}"), "&lt;b&gt;&quot;A&amp;B&quot; ");
    }
}
