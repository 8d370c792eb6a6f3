//! Recipes as text: reading with errors that name the line, printing, one normal form.

use serde_json::{Map, Number, Value};
use toml::de::{DeTable, DeValue};

use crate::{Error, Recipe, Registry, Source, Step, recipe::VERSION};

/// More threads are a slip of the pen.
const MOST_THREADS: usize = 1024;

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
        recipe.check_parts().map_err(|message| at(None, &message))?;
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
        let all: Vec<String> = self.examples.iter().map(Source::key).collect();
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

    /// What the types do not say: weights are positive, names and files differ, no step learns from
    /// an example that is not there.
    fn check_parts(&self) -> Result<(), String> {
        if self.threads.is_some_and(|n| !(1..=MOST_THREADS).contains(&n)) {
            return Err(format!("`threads` is out of range, expected 1 to {MOST_THREADS}"));
        }
        for Source { weight, name, file, .. } in self.examples.iter().chain(&self.city) {
            if !(*weight > 0.0 && weight.is_finite()) {
                let name = name.as_deref().map_or(file.display().to_string(), str::to_owned);
                return Err(format!("`weight` of {name} is {weight}, expected a positive number"));
            }
        }
        let names: Vec<String> = self.examples.iter().map(Source::key).collect();
        if let Some(name) = doubled(&names) {
            return Err(format!("two examples are named `{name}`; give one another `name`"));
        }
        let files: Vec<_> = self.exports.iter().map(|export| &export.file).collect();
        if let Some(file) = doubled(&files) {
            return Err(format!("{} is exported twice; give one another `file`", file.display()));
        }
        let mut wanted = self.steps.iter().filter_map(|step| step.examples.as_ref()).flatten();
        wanted.find(|wanted| !names.contains(wanted)).map_or(Ok(()), |wanted| {
            let there = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            Err(format!("there is no example named `{wanted}`; there are: {there}"))
        })
    }
}

fn doubled<T: PartialEq>(items: &[T]) -> Option<&T> {
    items.iter().enumerate().find(|(i, item)| items[..*i].contains(item)).map(|(_, item)| item)
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
