use std::borrow::Cow;
use std::io::{BufWriter, Result, Write};

use exurb_city::City;
use quick_xml::escape::escape;

use crate::GENERATOR;
use crate::document::{Document, Tag};

/// Writes a city as OSM XML: 7 decimals, ids from 1, bounds and attribution in the head. Equal
/// cities give equal bytes.
pub fn write_xml(city: &City, out: &mut impl Write) -> Result<()> {
    let document = Document::new(city);
    let mut out = BufWriter::new(out);
    let version = env!("CARGO_PKG_VERSION");
    let attribution = text(&document.attribution);
    writeln!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>")?;
    writeln!(
        out,
        "<osm version=\"0.6\" generator=\"{GENERATOR} {version}\" attribution=\"{attribution}\">"
    )?;
    if let Some(bounds) = document.bounds {
        let [w, s, e, n] = bounds.map(degrees);
        writeln!(out, " <bounds minlat=\"{s}\" minlon=\"{w}\" maxlat=\"{n}\" maxlon=\"{e}\"/>")?;
    }
    for (node, id) in document.nodes.iter().zip(1..) {
        let (lat, lon) = (degrees(node.lat), degrees(node.lon));
        write!(out, " <node id=\"{id}\" version=\"1\" lat=\"{lat}\" lon=\"{lon}\"")?;
        if node.tags.is_empty() {
            writeln!(out, "/>")?;
        } else {
            writeln!(out, ">")?;
            tags(&mut out, &node.tags)?;
            writeln!(out, " </node>")?;
        }
    }
    for (way, id) in document.ways.iter().zip(1..) {
        writeln!(out, " <way id=\"{id}\" version=\"1\">")?;
        for node in &way.nodes {
            writeln!(out, "  <nd ref=\"{node}\"/>")?;
        }
        tags(&mut out, &way.tags)?;
        writeln!(out, " </way>")?;
    }
    for (relation, id) in document.relations.iter().zip(1..) {
        writeln!(out, " <relation id=\"{id}\" version=\"1\">")?;
        for (way, is_inner) in &relation.members {
            let role = if *is_inner { "inner" } else { "outer" };
            writeln!(out, "  <member type=\"way\" ref=\"{way}\" role=\"{role}\"/>")?;
        }
        tags(&mut out, &relation.tags)?;
        writeln!(out, " </relation>")?;
    }
    writeln!(out, "</osm>")?;
    out.flush()
}

fn tags(out: &mut impl Write, tags: &[Tag]) -> Result<()> {
    for (key, value) in tags {
        writeln!(out, "  <tag k=\"{key}\" v=\"{}\"/>", text(value))?;
    }
    Ok(())
}

/// Escaped, and without the control characters that XML forbids.
fn text(value: &str) -> Cow<'_, str> {
    if value.contains(|c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}')) {
        let plain: String = value
            .chars()
            .map(|c| if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') { ' ' } else { c })
            .collect();
        return Cow::Owned(escape(&plain).into_owned());
    }
    escape(value)
}

/// 1e-7 degrees with 7 decimals, exactly.
fn degrees(fixed: i32) -> String {
    let sign = if fixed < 0 { "-" } else { "" };
    let whole = fixed.unsigned_abs();
    format!("{sign}{}.{:07}", whole / 10_000_000, whole % 10_000_000)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_are_exact() {
        assert_eq!(degrees(0), "0.0000000");
        assert_eq!(degrees(-1), "-0.0000001");
        assert_eq!(degrees(1_800_000_000), "180.0000000");
        assert_eq!(degrees(-601_716_300), "-60.1716300");
    }

    #[test]
    fn text_is_escaped_and_clean() {
        assert_eq!(text("A & \"B\" <c>"), "A &amp; &quot;B&quot; &lt;c&gt;");
        assert_eq!(text("a\u{0}b\nc"), "a b c");
    }
}
