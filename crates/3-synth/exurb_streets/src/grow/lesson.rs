//! What growth learned, in figures.

use serde_json::{Value, json};

use super::learn::{Style, Vocabulary};

/// Patches, connectors and statistics of each example.
pub fn describe(vocabularies: &[Vocabulary]) -> Value {
    vocabularies.iter().map(of_example).collect()
}

fn of_example(example: &Vocabulary) -> Value {
    json!({
        "example": &*example.character.name,
        "main": of_style(&example.main),
        "local": of_style(&example.local),
        "large_block_m": example.large_block_m,
        "likeness_gates": example.gates,
    })
}

fn of_style(style: &Style) -> Value {
    let sizes = style.patches.iter().map(|patch| patch.core.len());
    json!({
        "patches": style.patches.len(),
        "junctions_in_patches": sizes.clone().sum::<usize>(),
        "junctions_in_largest_patch": sizes.max(),
        "connectors": style.connectors.list.len(),
        "streets": style.statistics,
        "empty_beyond_m": style.empty_m,
    })
}
