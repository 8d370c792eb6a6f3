//! The columns of a row, as other programs write them.

use std::borrow::Cow;

use crate::value::Value;

/// The columns of a row; names are compared without case.
///
/// GDAL's OpenStreetMap driver puts the tags it has no column for into one, `other_tags`
/// (`"lanes"=>"2","bridge"=>"yes"`): they count as columns, after the real ones.
#[derive(Debug, Default)]
pub struct Attributes<'a>(Vec<(Cow<'a, str>, Value<'a>)>);

impl<'a> Attributes<'a> {
    /// Of names and values.
    pub fn new(columns: impl IntoIterator<Item = (Cow<'a, str>, Value<'a>)>) -> Self {
        let mut all: Vec<_> = columns.into_iter().collect();
        let tags = all.iter().find_map(|(name, value)| match value {
            Value::Text(text) if name.eq_ignore_ascii_case("other_tags") => Some(pairs(text)),
            _ => None,
        });
        let owned = |(key, value): (String, String)| (Cow::Owned(key), Value::from(value));
        all.extend(tags.into_iter().flatten().map(owned));
        Self(all)
    }

    /// Is there such a column, known or not?
    pub fn has(&self, name: &str) -> bool {
        self.0.iter().any(|(n, _)| n.eq_ignore_ascii_case(name))
    }

    /// The first known value among the columns of these names; of a list its first item.
    pub fn get(&self, names: &[&str]) -> Option<Value<'_>> {
        let value = self.raw(names)?;
        match value {
            Value::Text(text) if is_list(text) => items(text).next().map(Value::from),
            value => Some(value.clone()),
        }
    }

    /// All words of the first known value among these columns, in lower case: OSMnx writes the
    /// values of streets it joined as a list (`['residential', 'service']`), OSM parts them by `;`.
    pub fn words(&self, names: &[&str]) -> Vec<String> {
        let Some(text) = self.raw(names).and_then(Value::text) else { return Vec::new() };
        items(&text).map(str::to_lowercase).collect()
    }

    /// A text.
    pub fn text(&self, names: &[&str]) -> Option<String> {
        Some(self.get(names)?.text()?.trim().to_owned()).filter(|t| !t.is_empty())
    }

    /// A text in lower case, as classes are written.
    pub fn word(&self, names: &[&str]) -> Option<String> {
        self.text(names).map(|t| t.to_lowercase())
    }

    /// A number over 0.
    pub fn positive(&self, names: &[&str]) -> Option<f64> {
        self.get(names)?.real().filter(|n| *n > 0.0)
    }

    /// Yes or no. OSM has `bridge=viaduct` and the like: whatever is not a no is a yes.
    pub fn flag(&self, names: &[&str]) -> bool {
        self.get(names).is_some_and(|value| value.flag().unwrap_or(true))
    }

    fn raw(&self, names: &[&str]) -> Option<&Value<'a>> {
        names.iter().find_map(|name| {
            let known = self.0.iter().filter(|(_, value)| !value.is_null());
            known.into_iter().find(|(n, _)| n.eq_ignore_ascii_case(name)).map(|(_, value)| value)
        })
    }
}

fn is_list(text: &str) -> bool {
    let text = text.trim();
    text.starts_with('[') && text.ends_with(']')
}

/// The items of a list as Python or JSON prints it, or of OSM's `a;b`.
fn items(text: &str) -> impl Iterator<Item = &str> {
    let text = text.trim();
    let (inner, parting) = match is_list(text) {
        true => (&text[1..text.len() - 1], ','),
        false => (text, ';'),
    };
    let items = inner.split(parting).map(|item| item.trim().trim_matches(['\'', '"']).trim());
    items.filter(|item| !item.is_empty())
}

/// The pairs of `"key"=>"value","key"=>"value"`; inside quotes `\` takes the next character as it
/// is.
fn pairs(text: &str) -> Vec<(String, String)> {
    let mut strings = Vec::new();
    let mut open: Option<String> = None;
    let mut chars = text.chars();
    while let Some(c) = chars.next() {
        match (&mut open, c) {
            (None, '"') => open = Some(String::new()),
            (None, _) => {}
            (Some(_), '"') => strings.extend(open.take()),
            (Some(string), '\\') => string.extend(chars.next()),
            (Some(string), c) => string.push(c),
        }
    }
    strings.chunks_exact(2).map(|pair| (pair[0].clone(), pair[1].clone())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tags_in_one_column_are_columns() {
        let tags = r#""lanes"=>"2","name:de"=>"a \"b\", c","bridge"=>"yes""#;
        let row = Attributes::new([
            (Cow::Borrowed("bridge"), Value::from("no")),
            (Cow::Borrowed("other_tags"), Value::from(tags)),
        ]);
        assert_eq!(row.positive(&["lanes"]), Some(2.0));
        assert_eq!(row.text(&["name:de"]).as_deref(), Some("a \"b\", c"));
        assert!(!row.flag(&["bridge"]), "a column of its own goes first");
    }

    #[test]
    fn lists_are_read_by_their_items() {
        for list in ["['3', '2']", "[\"3\", \"2\"]", "[3,2]"] {
            let row = Attributes::new([(Cow::Borrowed("lanes"), Value::from(list))]);
            assert_eq!(row.positive(&["lanes"]), Some(3.0), "{list}");
            assert_eq!(row.words(&["lanes"]), ["3", "2"]);
        }
        let row = Attributes::new([(Cow::Borrowed("name"), Value::from("[]"))]);
        assert_eq!(row.text(&["name"]), None);
    }
}
