//! Operations in order: recipes in TOML.
