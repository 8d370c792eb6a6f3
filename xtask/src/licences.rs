//! `licences`: every dependency may be used under a licence on the list.

use crate::metadata;
use crate::shell::Outcome;

/// Licences whose terms we keep by naming the dependency. `bzip2-1.0.6` is a BSD licence in bzip2's
/// own words.
const ALLOWED: [&str; 13] = [
    "MIT",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "ISC",
    "Zlib",
    "Unicode-3.0",
    "BSL-1.0",
    "MPL-2.0",
    "CC0-1.0",
    "Unlicense",
    "0BSD",
    "bzip2-1.0.6",
];

/// Checks the lock file.
pub fn run() -> Outcome {
    println!("\nlicences:");
    let packages = metadata::packages()?;
    let others: Vec<_> = packages.iter().filter(|package| !package.is_member).collect();
    let refused: Vec<_> = others.iter().filter(|package| !is_allowed(&package.licence)).collect();
    for package in &refused {
        println!("  {} {}: `{}`", package.name, package.version, package.licence);
    }
    if !refused.is_empty() {
        return Err(format!("{} dependencies have no licence on the list", refused.len()));
    }
    println!("  {} dependencies, all under {}", others.len(), ALLOWED.join(", "));
    Ok(())
}

/// Does an SPDX expression leave a choice on the list? `/` is the old way to write OR. An
/// exception (`WITH`) only ever permits more.
fn is_allowed(expression: &str) -> bool {
    let spaced = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let mut rest = &words[..];
    any_of(&mut rest) && rest.is_empty()
}

fn any_of(words: &mut &[&str]) -> bool {
    let mut allowed = all_of(words);
    while let ["OR", rest @ ..] = *words {
        *words = rest;
        allowed |= all_of(words);
    }
    allowed
}

fn all_of(words: &mut &[&str]) -> bool {
    let mut allowed = one(words);
    while let ["AND", rest @ ..] = *words {
        *words = rest;
        allowed &= one(words);
    }
    allowed
}

fn one(words: &mut &[&str]) -> bool {
    match **words {
        ["(", ref rest @ ..] => {
            *words = rest;
            let allowed = any_of(words);
            let closed = words.first() == Some(&")");
            *words = words.get(1..).unwrap_or_default();
            allowed && closed
        }
        [licence, "WITH", _, ref rest @ ..] | [licence, ref rest @ ..] => {
            *words = rest;
            ALLOWED.contains(&licence)
        }
        [] => false,
    }
}

#[cfg(test)]
mod tests {
    use super::is_allowed;

    #[test]
    fn a_choice_on_the_list_is_enough() {
        for good in [
            "MIT",
            "MIT/Apache-2.0",
            "GPL-3.0 OR MIT",
            "(MIT OR GPL-2.0) AND Unicode-3.0",
            "Apache-2.0 WITH LLVM-exception OR GPL-2.0",
            "LGPL-3.0-or-later OR MPL-2.0",
        ] {
            assert!(is_allowed(good), "{good}");
        }
    }

    #[test]
    fn all_parts_of_an_and_must_be_on_the_list() {
        for bad in ["", "GPL-3.0", "MIT AND GPL-3.0", "(MIT", "MIT Apache-2.0", "OR MIT"] {
            assert!(!is_allowed(bad), "{bad}");
        }
    }
}
