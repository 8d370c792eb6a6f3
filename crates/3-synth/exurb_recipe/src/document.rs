//! Recipes as text: reading with errors that name the line, printing, one normal form.

use serde_json::{Map, Number, Value};
use toml::de::{DeTable, DeValue};

use crate::{Error, Recipe, Registry, Source, Step, recipe::VERSION};

impl Recipe {
    /// Reads a recipe and checks it against the operations of this program. `name` is the name of
    /// the file, for errors, which give the line.
    pub fn parse(text: &str, name: &str) -> Result<Self, Error> {
        Self::parse_with(text, name, &Registry::all())
    }

    /// [`Recipe::parse`] against a list of operations.
    pub fn parse_with(text: &str, name: &str, registry: &Registry) -> Result<Self, Error> {
        let at = |offset: Option<usize>, message: &str| {
            let line = offset.map(|o| text[..o.min(text.len())].matches('\n').count() + 1);
            let place = line.map(|l| format!(", line {l}")).unwrap_or_default();
            Error::Recipe(format!("{name}{place}: {}", message.trim()))
        };
        let mut recipe: Self = toml::from_str(text)
            .map_err(|error| at(error.span().map(|s| s.start), error.message()))?;
        if recipe.exurb != VERSION {
            let message = format!(
                "`exurb` is {}, the version of another program's recipes; this one reads {VERSION}",
                recipe.exurb
            );
            return Err(at(offset_of(text, None, "exurb"), &message));
        }
        for (i, step) in recipe.steps.iter().enumerate() {
            let operation = registry
                .find(&step.op)
                .map_err(|message| at(offset_of(text, Some(i), "op"), &message))?;
            operation.check(&Value::Object(step.params.clone())).map_err(|failure| {
                let message = failure.to_string();
                let named = step.params.keys().find(|key| message.contains(&format!("`{key}`")));
                at(offset_of(text, Some(i), named.map_or("op", String::as_str)), &message)
            })?;
        }
        recipe.check_sources().map_err(|message| at(None, &message))?;
        recipe.normalise(registry);
        Ok(recipe)
    }

    /// The recipe as text that [`Recipe::parse`] reads back as the same recipe.
    pub fn print(&self) -> Result<String, Error> {
        toml::to_string(self)
            .map_err(|e| Error::Recipe(format!("the recipe cannot be printed: {e}")))
    }

    /// One form for all recipes that do the same: parameters sorted by name, numbers as the
    /// operation has them, defaults left out.
    pub fn normalise(&mut self, registry: &Registry) {
        let all: Vec<String> = self.examples.iter().map(Source::name).collect();
        for step in &mut self.steps {
            if !all.is_empty() && step.examples.as_ref() == Some(&all) {
                step.examples = None;
            }
            if let Ok(operation) = registry.find(&step.op) {
                step.params = normal_params(&step.params, &operation.schema());
            }
            if step.seed == Some(self.seed) {
                step.seed = None;
            }
        }
    }

    /// Weights are positive, and no step learns from an example that is not there.
    fn check_sources(&self) -> Result<(), String> {
        if let Some(source) =
            self.examples.iter().find(|s| !(s.weight > 0.0 && s.weight.is_finite()))
        {
            return Err(format!(
                "`weight` of {} is {}, expected a positive number",
                source.name(),
                source.weight
            ));
        }
        let names: Vec<String> = self.examples.iter().map(Source::name).collect();
        for wanted in self.steps.iter().filter_map(|step| step.examples.as_ref()).flatten() {
            if !names.contains(wanted) {
                let there = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
                return Err(format!("there is no example named `{wanted}`; there are: {there}"));
            }
        }
        Ok(())
    }
}

fn normal_params(params: &Map<String, Value>, schema: &Value) -> Map<String, Value> {
    let mut sorted: Vec<(String, Value)> = params
        .iter()
        .map(|(key, value)| (key, value, schema.pointer(&format!("/properties/{key}"))))
        .map(|(key, value, property)| (key.clone(), normal_value(value, property), property))
        .filter(|(_, value, property)| {
            !value.is_null() && property.and_then(|p| p.get("default")) != Some(value)
        })
        .map(|(key, value, _)| (key, value))
        .collect();
    sorted.sort_by(|a, b| a.0.cmp(&b.0));
    sorted.into_iter().collect()
}

/// A whole number where the operation has a fraction becomes one: `1` and `1.0` are the same.
fn normal_value(value: &Value, property: Option<&Value>) -> Value {
    let kind = property.and_then(|p| p.get("type"));
    let is = |name: &str| match kind {
        Some(Value::String(kind)) => kind == name,
        Some(Value::Array(kinds)) => kinds.iter().any(|k| k == name),
        _ => false,
    };
    match value.as_f64().and_then(Number::from_f64) {
        Some(number) if is("number") => Value::Number(number),
        _ => value.clone(),
    }
}

/// Where a key stands in the text: at the top, or in a step.
fn offset_of(text: &str, step: Option<usize>, key: &str) -> Option<usize> {
    let document = DeTable::parse(text).ok()?.into_inner();
    let find = |table: &DeTable<'_>, key: &str| {
        table.iter().find(|(k, _)| k.get_ref() == key).map(|(k, _)| k.span().start)
    };
    let Some(step) = step else { return find(&document, key) };
    let (_, steps) = document.iter().find(|(k, _)| k.get_ref() == "steps")?;
    let table = steps.get_ref().get(step)?;
    match table.get_ref() {
        DeValue::Table(entries) => find(entries, key).or(Some(table.span().start)),
        _ => Some(table.span().start),
    }
}

impl Step {
    /// Sets a parameter.
    #[must_use]
    pub fn with(mut self, name: &str, value: impl Into<Value>) -> Self {
        self.params.insert(name.to_owned(), value.into());
        self
    }
}

#[cfg(test)]
#[path = "document_tests.rs"]
mod tests;
