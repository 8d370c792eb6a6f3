//! `--set KEY=VALUE` of the protocols.

use serde_json::{Map, Value, json};

/// Sets a parameter of the method: the value is JSON, or else a word.
pub fn set(params: &mut Map<String, Value>, pair: &str) -> Result<(), String> {
    let (key, text) = pair.split_once('=').ok_or("--set needs KEY=VALUE")?;
    let value = serde_json::from_str(text).unwrap_or_else(|_| json!(text));
    params.insert(key.replace('-', "_"), value);
    Ok(())
}
