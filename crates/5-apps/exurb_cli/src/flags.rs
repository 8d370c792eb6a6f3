//! Parameters of operations as flags, made from their JSON Schema.

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgAction, ArgMatches, Command};
use serde_json::{Map, Value};

/// What a parameter takes, by its schema.
#[derive(Debug, PartialEq)]
enum Kind {
    Flag,
    Number,
    Integer,
    /// One of the given words.
    Word(Vec<(String, String)>),
    Text,
    /// Repeatable.
    List(Box<Kind>),
    /// Anything else, given as JSON.
    Json,
}

/// A flag for each property of `schema`.
pub fn add(command: Command, schema: &Value, heading: &str) -> Command {
    let properties = schema.get("properties").and_then(Value::as_object);
    properties.into_iter().flatten().fold(command, |command, (name, property)| {
        command.arg(flag(name, property, schema).help_heading(heading.to_owned()))
    })
}

/// The parameters that were given, as the operation's document.
pub fn document(matches: &ArgMatches, schema: &Value) -> Result<Map<String, Value>, String> {
    let mut document = Map::new();
    let properties = schema.get("properties").and_then(Value::as_object);
    for (name, property) in properties.into_iter().flatten() {
        let Some(texts) = matches.get_many::<String>(name) else { continue };
        let wrong = |message: String| format!("--{}: {message}", kebab(name));
        let value = match kind(property, schema) {
            Kind::List(item) => {
                let items: Result<Vec<Value>, String> = texts.map(|t| value(t, &item)).collect();
                Value::Array(items.map_err(wrong)?)
            }
            kind => match texts.into_iter().next_back() {
                Some(text) => value(text, &kind).map_err(wrong)?,
                None => continue,
            },
        };
        document.insert(name.clone(), value);
    }
    Ok(document)
}

fn flag(name: &str, property: &Value, schema: &Value) -> Arg {
    let arg = Arg::new(name.to_owned()).long(kebab(name)).help(help(property));
    let kind = kind(property, schema);
    let arg = match &kind {
        Kind::List(_) => arg.action(ArgAction::Append),
        _ => arg.action(ArgAction::Set),
    };
    match kind {
        Kind::Flag => arg
            .num_args(0..=1)
            .require_equals(true)
            .default_missing_value("true")
            .value_name("BOOL")
            .value_parser(["true", "false"].map(String::from).to_vec()),
        Kind::Word(words) => arg.value_name("WORD").value_parser(PossibleValuesParser::new(
            words.into_iter().map(|(word, help)| match help.as_str() {
                "" => clap::builder::PossibleValue::new(word),
                _ => clap::builder::PossibleValue::new(word).help(help),
            }),
        )),
        _ => arg
            .value_name(value_name(property))
            .allow_hyphen_values(true)
            .value_parser(clap::builder::NonEmptyStringValueParser::new()),
    }
}

/// The doc line, its range, unit and default.
fn help(property: &Value) -> String {
    let text = |key| property.get(key).and_then(Value::as_str).unwrap_or_default();
    let mut help = text("description").split_whitespace().collect::<Vec<_>>().join(" ");
    let unit = match text("x-unit") {
        "" => String::new(),
        unit => format!(" {unit}"),
    };
    let bound = |key| property.get(key).and_then(Value::as_f64);
    let mut facts = Vec::new();
    match (bound("minimum"), bound("maximum")) {
        (Some(least), Some(most)) => facts.push(format!("{least} to {most}{unit}")),
        (Some(least), None) => facts.push(format!("at least {least}{unit}")),
        (None, Some(most)) => facts.push(format!("at most {most}{unit}")),
        (None, None) if !unit.is_empty() => facts.push(format!("in{unit}")),
        (None, None) => {}
    }
    match property.get("default") {
        None | Some(Value::Null) => {}
        Some(Value::Array(items)) if items.is_empty() => {}
        Some(Value::String(text)) if text.is_empty() => {}
        Some(Value::String(text)) => facts.push(format!("default: {text}")),
        Some(value) => facts.push(format!("default: {value}")),
    }
    if !facts.is_empty() {
        help.push_str(&format!(" [{}]", facts.join("; ")));
    }
    help
}

fn value_name(property: &Value) -> String {
    match property.get("x-value-name").or(property.get("x-unit")).and_then(Value::as_str) {
        Some(name) => name.to_uppercase(),
        None => "VALUE".to_owned(),
    }
}

fn kind(property: &Value, schema: &Value) -> Kind {
    let property = resolve(property, schema);
    if let Some(words) = words(property) {
        return Kind::Word(words);
    }
    let names: Vec<&str> = match property.get("type") {
        Some(Value::String(name)) => vec![name],
        Some(Value::Array(names)) => names.iter().filter_map(Value::as_str).collect(),
        _ => Vec::new(),
    };
    match names.iter().find(|name| **name != "null") {
        Some(&"boolean") => Kind::Flag,
        Some(&"number") => Kind::Number,
        Some(&"integer") => Kind::Integer,
        Some(&"string") => Kind::Text,
        Some(&"array") => match property.get("items").map(|items| kind(items, schema)) {
            Some(Kind::Json | Kind::List(_)) | None => Kind::Json,
            Some(item) => Kind::List(Box::new(item)),
        },
        _ => Kind::Json,
    }
}

/// The definition behind a reference, also behind `T or null`.
fn resolve<'a>(property: &'a Value, schema: &'a Value) -> &'a Value {
    let reference = property.get("$ref").and_then(Value::as_str);
    if let Some(target) = reference.and_then(|r| schema.pointer(r.trim_start_matches('#'))) {
        return target;
    }
    let choices = property.get("anyOf").and_then(Value::as_array);
    let real = choices.into_iter().flatten().find(|c| c.get("type") != Some(&"null".into()));
    real.map_or(property, |choice| resolve(choice, schema))
}

/// The words of an enumeration, each with its doc line.
fn words(property: &Value) -> Option<Vec<(String, String)>> {
    let text = |value: &Value| value.as_str().map(|word| (word.to_owned(), String::new()));
    if let Some(Value::Array(values)) = property.get("enum") {
        return values.iter().map(text).collect();
    }
    let choices = property.get("oneOf")?.as_array()?;
    choices
        .iter()
        .map(|choice| {
            let help = choice.get("description").and_then(Value::as_str).unwrap_or_default();
            choice.get("const")?.as_str().map(|word| (word.to_owned(), help.to_owned()))
        })
        .collect()
}

fn value(text: &str, kind: &Kind) -> Result<Value, String> {
    match kind {
        Kind::Flag => Ok(Value::Bool(text == "true")),
        Kind::Number => text
            .parse::<f64>()
            .ok()
            .and_then(serde_json::Number::from_f64)
            .map(Value::Number)
            .ok_or_else(|| format!("`{text}` is no number")),
        Kind::Integer => {
            text.parse::<i64>().map(Value::from).map_err(|_| format!("`{text}` is no whole number"))
        }
        Kind::Word(_) | Kind::Text => Ok(Value::String(text.to_owned())),
        Kind::List(_) | Kind::Json => {
            serde_json::from_str(text).map_err(|e| format!("`{text}` is not JSON: {e}"))
        }
    }
}

fn kebab(name: &str) -> String {
    name.replace('_', "-")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn schema() -> Value {
        json!({
            "$defs": {"Shape": {"oneOf": [
                {"const": "round", "description": "No corners."}, {"const": "square"}]}},
            "properties": {
                "width_m": {"type": "number", "minimum": 0.5, "maximum": 9.0, "x-unit": "m",
                    "description": "How wide it\nis.", "default": 4.0},
                "count": {"type": ["integer", "null"], "minimum": 0},
                "loops": {"type": "boolean", "default": false},
                "shape": {"$ref": "#/$defs/Shape", "default": "round"},
                "start": {"type": "array", "items": {"type": "string"}, "default": []},
                "curve": {"type": "array", "items": {"type": "array"}, "default": []},
            }
        })
    }

    fn read(args: &[&str]) -> Result<Map<String, Value>, String> {
        let command = add(Command::new("test").no_binary_name(true), &schema(), "Parameters");
        let matches = command.try_get_matches_from(args).map_err(|e| e.to_string())?;
        document(&matches, &schema())
    }

    #[test]
    fn every_kind_of_parameter_is_a_flag() {
        let given = read(&[
            "--width-m",
            "-2.5",
            "--count",
            "3",
            "--loops",
            "--shape",
            "square",
            "--start",
            "-1,2",
            "--start",
            "3,4=5,6",
            "--curve",
            "[[1,2]]",
        ]);
        let expected = json!({"width_m": -2.5, "count": 3, "loops": true, "shape": "square",
            "start": ["-1,2", "3,4=5,6"], "curve": [[1, 2]]});
        assert_eq!(given.map(Value::Object), Ok(expected));
        assert_eq!(read(&["--loops=false"]).map(Value::Object), Ok(json!({"loops": false})));
        assert_eq!(read(&[]).map(Value::Object), Ok(json!({})));
    }

    #[test]
    fn wrong_values_name_their_flag() {
        for (args, words) in [
            (["--width-m", "wide"], "--width-m: `wide` is no number"),
            (["--count", "1.5"], "--count: `1.5` is no whole number"),
            (["--curve", "{"], "--curve: `{` is not JSON"),
            (["--shape", "oval"], "possible values: round, square"),
        ] {
            let message = read(&args).unwrap_err();
            assert!(message.contains(words), "{message}");
        }
    }

    #[test]
    fn help_tells_range_unit_and_default() {
        let property = &schema()["properties"]["width_m"];
        assert_eq!(help(property), "How wide it is. [0.5 to 9 m; default: 4.0]");
    }
}
