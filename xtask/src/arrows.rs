//! `arrows`: a crate uses only what stands below it.
//!
//! The number of a crate's folder is its layer. A crate may use crates of lower layers and, in its
//! own, those listed above it among the workspace's members. `4-export` is held tighter: layer 0
//! and its own only. Packages outside `crates/` (tasks, tests, benches) may use anything, and no
//! crate may use them. Development needs are free.

use std::fs;
use std::path::Path;

use crate::metadata::{self, Package};
use crate::shell::{Outcome, root};

const EXPORT: u32 = 4;

/// A package's place: its layer (`None` outside `crates/`) and its position among the members.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Place {
    layer: Option<u32>,
    position: usize,
}

/// Checks the workspace.
pub fn run() -> Outcome {
    println!("\narrows:");
    let members = members()?;
    let ours: Vec<Package> =
        metadata::packages()?.into_iter().filter(|package| package.is_member).collect();
    let breaches = [out_of_order(&members), breaches(&ours, &members)].concat();
    if breaches.is_empty() {
        println!("  {} packages, every arrow points down", ours.len());
        return Ok(());
    }
    for breach in &breaches {
        println!("  {breach}");
    }
    Err(format!("{} arrows point the wrong way", breaches.len()))
}

/// Folders of the members as the root manifest lists them.
fn members() -> Outcome<Vec<String>> {
    let text = fs::read_to_string(root().join("Cargo.toml")).map_err(|e| e.to_string())?;
    let manifest: toml::Table = text.parse().map_err(|e| format!("Cargo.toml: {e}"))?;
    let list = manifest["workspace"]["members"].as_array().ok_or("Cargo.toml has no members")?;
    Ok(list.iter().filter_map(|member| member.as_str()).map(str::to_owned).collect())
}

/// The layer of a folder `crates/N-.../...`.
fn layer(folder: &str) -> Option<u32> {
    folder.strip_prefix("crates/")?.split('-').next()?.parse().ok()
}

fn out_of_order(members: &[String]) -> Vec<String> {
    let layers: Vec<_> = members.iter().map(|m| layer(m).unwrap_or(u32::MAX)).collect();
    let falls =
        layers.windows(2).zip(members.windows(2)).filter(|(layers, _)| layers[0] > layers[1]);
    falls
        .map(|(_, folders)| format!("Cargo.toml lists {} after {}", folders[1], folders[0]))
        .collect()
}

fn place(package: &Package, members: &[String]) -> Place {
    let folder = Path::new(&package.manifest).parent().unwrap_or(Path::new(""));
    let position = members.iter().position(|member| folder.ends_with(member));
    let position = position.unwrap_or(members.len());
    Place { layer: members.get(position).and_then(|member| layer(member)), position }
}

fn breaches(ours: &[Package], members: &[String]) -> Vec<String> {
    let mut breaches = Vec::new();
    for user in ours {
        for used in ours.iter().filter(|used| user.needs.contains(&used.name)) {
            let (from, to) = (place(user, members), place(used, members));
            if !may_use(from, to) {
                breaches.push(format!("{} must not use {}", user.name, used.name));
            }
        }
    }
    breaches
}

fn may_use(from: Place, to: Place) -> bool {
    match (from.layer, to.layer) {
        (None, _) => true,
        (Some(_), None) => false,
        (Some(a), Some(b)) if a == b => to.position < from.position,
        (Some(EXPORT), Some(b)) => b == 0,
        (Some(a), Some(b)) => b < a,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MEMBERS: [&str; 6] = [
        "crates/0-base/geom",
        "crates/0-base/graph",
        "crates/1-examples/osm",
        "crates/3-synth/streets",
        "crates/4-export/plan",
        "xtask",
    ];

    fn package(folder: &str, needs: &[&str]) -> Package {
        Package {
            name: folder.rsplit('/').next().unwrap_or_default().to_owned(),
            version: String::new(),
            licence: String::new(),
            is_member: true,
            manifest: format!("/somewhere/{folder}/Cargo.toml"),
            needs: needs.iter().map(|&need| need.to_owned()).collect(),
        }
    }

    fn breaches_of(user: usize, need: &str) -> usize {
        let members: Vec<String> = MEMBERS.iter().map(|&m| m.to_owned()).collect();
        let mut ours: Vec<Package> = MEMBERS.iter().map(|m| package(m, &[])).collect();
        ours[user] = package(MEMBERS[user], &[need]);
        breaches(&ours, &members).len()
    }

    #[test]
    fn down_is_free_and_up_is_not() {
        assert_eq!(breaches_of(3, "osm"), 0);
        assert_eq!(breaches_of(2, "streets"), 1);
        assert_eq!(breaches_of(1, "geom"), 0);
        assert_eq!(breaches_of(0, "graph"), 1);
    }

    #[test]
    fn export_knows_the_base_only() {
        assert_eq!(breaches_of(4, "geom"), 0);
        assert_eq!(breaches_of(4, "osm"), 1);
        assert_eq!(breaches_of(4, "streets"), 1);
    }

    #[test]
    fn tasks_may_use_all_and_be_used_by_none() {
        assert_eq!(breaches_of(5, "plan"), 0);
        assert_eq!(breaches_of(4, "xtask"), 1);
    }

    #[test]
    fn members_are_listed_by_layer() {
        let sorted: Vec<String> = MEMBERS.iter().map(|&m| m.to_owned()).collect();
        assert!(out_of_order(&sorted).is_empty());
        let mut swapped = sorted;
        swapped.swap(2, 3);
        assert_eq!(out_of_order(&swapped).len(), 1);
    }
}
