//! Parameters of operations, defined once.
//!
//! A struct with `Default`, doc comments and `#[schemars(range(...))]` gives flags, recipe keys,
//! JSON Schema, help and, later, forms and Python signatures. Units go into the schema as `x-unit`.
//!
//! ```
//! use exurb_operation::{Params, params};
//!
//! /// How blocks are cut.
//! #[derive(Clone, Debug, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
//! #[serde(deny_unknown_fields, default)]
//! struct Cut {
//!     /// No parcel is narrower than this.
//!     #[schemars(range(min = 0.5, max = 100.0), extend("x-unit" = "m"))]
//!     min_frontage: f64,
//! }
//! impl Default for Cut {
//!     fn default() -> Self {
//!         Self { min_frontage: 4.0 }
//!     }
//! }
//! impl Params for Cut {}
//!
//! let wrong = serde_json::json!({ "min_frontage": 0.1 });
//! let message = params::parse::<Cut>(wrong).unwrap_err();
//! assert_eq!(message, "`min_frontage` is 0.1, expected 0.5 to 100 m");
//! ```

use schemars::JsonSchema;
use serde::{Serialize, de::DeserializeOwned};
use serde_json::Value;

/// Parameters of an operation.
pub trait Params:
    Clone + Default + Serialize + DeserializeOwned + JsonSchema + Send + Sync
{
    /// What ranges alone cannot say. The message names the parameter, its value, and what is
    /// expected.
    fn check(&self) -> Result<(), String> {
        Ok(())
    }
}

/// The JSON Schema of a parameter type, with its defaults.
pub fn schema<P: Params>() -> Value {
    let mut schema = schemars::schema_for!(P).to_value();
    let defaults = serde_json::to_value(P::default()).unwrap_or_default();
    if let Some(properties) = schema.get_mut("properties").and_then(Value::as_object_mut) {
        for (name, property) in properties.iter_mut() {
            if let (Some(property), Some(default)) = (property.as_object_mut(), defaults.get(name))
            {
                property.insert("default".into(), default.clone());
            }
        }
    }
    schema
}

/// Reads parameters from a document: missing ones take their default; unknown names, wrong types
/// and values out of range are errors that name the parameter.
pub fn parse<P: Params>(document: Value) -> Result<P, String> {
    let document = if document.is_null() { Value::Object(Default::default()) } else { document };
    check_ranges(&schema::<P>(), &document)?;
    let params: P = serde_json::from_value(document).map_err(|e| e.to_string())?;
    params.check()?;
    Ok(params)
}

fn check_ranges(schema: &Value, document: &Value) -> Result<(), String> {
    let (Some(properties), Some(values)) =
        (schema.get("properties").and_then(Value::as_object), document.as_object())
    else {
        return Ok(());
    };
    for (name, value) in values {
        let Some(property) = properties.get(name) else {
            let known: Vec<&str> = properties.keys().map(String::as_str).collect();
            return Err(format!("there is no parameter `{name}`; there are {}", known.join(", ")));
        };
        let Some(number) = value.as_f64() else { continue };
        let bound = |key| property.get(key).and_then(Value::as_f64);
        let (least, most) = (bound("minimum"), bound("maximum"));
        if least.is_some_and(|l| number < l) || most.is_some_and(|m| number > m) {
            let unit = property.get("x-unit").and_then(Value::as_str).unwrap_or_default();
            let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
            let range = match (least, most) {
                (Some(l), Some(m)) => format!("{l} to {m}"),
                (Some(l), None) => format!("at least {l}"),
                (None, Some(m)) => format!("at most {m}"),
                (None, None) => String::new(),
            };
            return Err(format!("`{name}` is {number}, expected {range}{unit}"));
        }
    }
    Ok(())
}
