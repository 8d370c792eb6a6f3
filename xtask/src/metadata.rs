//! What `cargo metadata` tells of the workspace and its dependencies.

use serde_json::Value;

use crate::shell::{Outcome, cargo, output_of};

/// A package of the lock file.
#[derive(Debug, Clone)]
pub struct Package {
    pub name: String,
    pub version: String,
    /// SPDX expression; empty where the package names none.
    pub licence: String,
    /// Is it one of ours?
    pub is_member: bool,
    /// Path of its manifest.
    pub manifest: String,
    /// Names of what it needs to build and run (development needs left out).
    pub needs: Vec<String>,
}

/// All packages of the lock file, ours and others'.
pub fn packages() -> Outcome<Vec<Package>> {
    let text = output_of(&mut cargo("metadata --format-version 1 --locked"))?;
    let value: Value = serde_json::from_str(&text).map_err(|e| e.to_string())?;
    let members = list(&value, "workspace_members");
    Ok(list(&value, "packages").iter().map(|package| read(package, members)).collect())
}

fn read(package: &Value, members: &[Value]) -> Package {
    let needs = list(package, "dependencies")
        .iter()
        .filter(|dependency| text(dependency, "kind") != "dev")
        .map(|dependency| text(dependency, "name"))
        .collect();
    Package {
        name: text(package, "name"),
        version: text(package, "version"),
        licence: text(package, "license"),
        is_member: members.contains(&package["id"]),
        manifest: text(package, "manifest_path"),
        needs,
    }
}

fn list<'a>(value: &'a Value, key: &str) -> &'a [Value] {
    value[key].as_array().map_or(&[], Vec::as_slice)
}

fn text(value: &Value, key: &str) -> String {
    value[key].as_str().unwrap_or_default().to_owned()
}
