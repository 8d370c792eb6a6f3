//! One attribute, as both formats hold it.

use std::borrow::Cow;
use std::sync::Arc;

/// The value of one column.
#[derive(Clone, Debug, PartialEq)]
pub enum Value<'a> {
    /// Unknown.
    Null,
    /// Yes or no.
    Bool(bool),
    /// A whole number.
    Int(i64),
    /// Any number.
    Real(f64),
    /// A text.
    Text(Cow<'a, str>),
}

impl<'a> From<&'a str> for Value<'a> {
    fn from(text: &'a str) -> Self {
        Self::Text(Cow::Borrowed(text))
    }
}

impl<'a> From<&'a Option<Arc<str>>> for Value<'a> {
    fn from(text: &'a Option<Arc<str>>) -> Self {
        text.as_deref().map_or(Self::Null, Self::from)
    }
}

impl From<String> for Value<'_> {
    fn from(text: String) -> Self {
        Self::Text(Cow::Owned(text))
    }
}

impl From<f64> for Value<'_> {
    fn from(number: f64) -> Self {
        if number.is_finite() { Self::Real(number) } else { Self::Null }
    }
}

impl From<Option<f64>> for Value<'_> {
    fn from(number: Option<f64>) -> Self {
        number.map_or(Self::Null, Self::from)
    }
}

impl Value<'_> {
    /// A number of another element; 0 means there is none.
    pub fn reference(id: u32) -> Self {
        if id == 0 { Self::Null } else { Self::Int(i64::from(id)) }
    }

    /// Unknown, or an empty text?
    pub fn is_null(&self) -> bool {
        match self {
            Self::Null => true,
            Self::Text(text) => text.trim().is_empty(),
            _ => false,
        }
    }

    /// A finite number; texts are read up to their unit (`12.5 m`, `3,5`).
    pub fn real(&self) -> Option<f64> {
        let number = match self {
            Self::Null => return None,
            Self::Bool(yes) => f64::from(u8::from(*yes)),
            Self::Int(n) => *n as f64,
            Self::Real(n) => *n,
            Self::Text(text) => leading_number(text)?,
        };
        number.is_finite().then_some(number)
    }

    /// A whole number in range.
    pub fn integer<I: TryFrom<i64>>(&self) -> Option<I> {
        let whole = match self {
            Self::Int(n) => *n,
            Self::Text(text) => match text.trim().parse() {
                Ok(n) => n,
                Err(_) => whole(self.real()?)?,
            },
            _ => whole(self.real()?)?,
        };
        I::try_from(whole).ok()
    }

    /// Yes or no, as databases and OSM write it.
    pub fn flag(&self) -> Option<bool> {
        match self {
            Self::Bool(yes) => Some(*yes),
            Self::Text(text) => match text.trim().to_ascii_lowercase().as_str() {
                "yes" | "true" | "t" | "1" | "y" => Some(true),
                "no" | "false" | "f" | "0" | "n" | "" => Some(false),
                _ => None,
            },
            _ => self.integer::<i64>().map(|n| n != 0),
        }
    }

    /// A text; numbers as written, nothing for what is unknown.
    pub fn text(&self) -> Option<Cow<'_, str>> {
        match self {
            Self::Null => None,
            Self::Bool(yes) => Some(Cow::Borrowed(if *yes { "yes" } else { "no" })),
            Self::Int(n) => Some(Cow::Owned(n.to_string())),
            Self::Real(n) => Some(Cow::Owned(n.to_string())),
            Self::Text(text) => Some(Cow::Borrowed(text)),
        }
    }

    /// [`Value::text`], to be kept.
    pub fn shared(&self) -> Option<Arc<str>> {
        self.text().map(Arc::from)
    }

    /// What `read` makes of a known value; `Some(None)` for an unknown one, `None` for a bad one.
    pub fn optional<T>(&self, read: impl FnOnce(&Self) -> Option<T>) -> Option<Option<T>> {
        if *self == Self::Null { Some(None) } else { read(self).map(Some) }
    }

    /// What `read` makes of a known value, `default` for an unknown one, `None` for a bad one.
    pub fn or<T>(&self, default: T, read: impl FnOnce(&Self) -> Option<T>) -> Option<T> {
        if *self == Self::Null { Some(default) } else { read(self) }
    }
}

/// Longest texts that are numbers with a unit.
const NUMBER_CHARS: usize = 32;

fn leading_number(text: &str) -> Option<f64> {
    let text = text.trim();
    let end = text
        .char_indices()
        .take(NUMBER_CHARS)
        .find(|(_, c)| !matches!(c, '0'..='9' | '.' | ',' | '-' | '+'))
        .map_or(text.len(), |(i, _)| i);
    text[..end].replace(',', ".").parse().ok()
}

fn whole(number: f64) -> Option<i64> {
    (number.fract() == 0.0 && number.abs() < 9e15).then_some(number as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_people_write_them() {
        for (text, number) in [("12.5 m", 12.5), ("3,5", 3.5), (" -2 ", -2.0), ("7;8", 7.0)] {
            assert_eq!(Value::from(text).real(), Some(number), "{text}");
        }
        assert_eq!(Value::from("tall").real(), None);
        assert_eq!(Value::Real(2.0).integer::<u8>(), Some(2));
        assert_eq!(Value::Int(300).integer::<u8>(), None);
        assert_eq!(Value::Real(2.5).integer::<u8>(), None);
    }
}
