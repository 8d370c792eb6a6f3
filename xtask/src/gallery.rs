//! `gallery`: makes the pictures of docs/gallery from the list in `docs/gallery/gallery.toml`, and the
//! page that shows them.
//!
//! A picture is a list of command lines for `exurb`, the last of which writes it. `{here}` is the folder
//! of the list, `{recipes}` the recipes of the repository, `{data}` the built-in example cities,
//! `{shared}` the real maps beside the repository, `{out}` a fresh folder that the pictures of one figure
//! share, `{picture}` the picture. Without the real maps pictures that need them are skipped, aloud.

mod palette;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::shell::{self, Outcome, cargo, output_of, root, target};

/// No picture is larger, in bytes.
const MOST_BYTES: usize = 300_000;

const HEADER: &str = "\
# Gallery

Figures of the papers, made again. `cargo xtask gallery` makes every picture from the command lines in
[gallery.toml](gallery.toml) and writes this page; `cargo xtask gallery NAME` makes one figure.
";

/// A figure: pictures side by side.
struct Figure {
    name: String,
    title: String,
    about: String,
    /// Lines that all pictures need.
    commands: Vec<String>,
    pictures: Vec<Picture>,
}

struct Picture {
    name: String,
    caption: String,
    commands: Vec<String>,
}

/// Makes the figure of that name, or all of them and the page.
pub fn run(chosen: Option<&str>) -> Outcome {
    let figures = figures()?;
    if let Some(name) = chosen.filter(|name| figures.iter().all(|f| f.name != *name)) {
        let known: Vec<&str> = figures.iter().map(|f| f.name.as_str()).collect();
        return Err(format!("there is no figure {name}; there are {}", known.join(", ")));
    }
    shell::run(&mut cargo("build --release --locked --package exurb_cli"))?;
    for figure in figures.iter().filter(|f| chosen.is_none_or(|name| f.name == name)) {
        make(figure)?;
    }
    std::fs::write(folder().join("README.md"), page(&figures)).map_err(|e| e.to_string())
}

fn folder() -> PathBuf {
    root().join("docs/gallery")
}

/// The list.
fn figures() -> Outcome<Vec<Figure>> {
    let file = folder().join("gallery.toml");
    let text = std::fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
    let list: Value = toml::from_str(&text).map_err(|e| format!("{}: {e}", file.display()))?;
    let figures = list["figure"].as_array().ok_or("gallery.toml has no [[figure]]")?;
    figures.iter().map(figure).collect()
}

fn figure(value: &Value) -> Outcome<Figure> {
    let text = |value: &Value, key: &str| -> Outcome<String> {
        let found = value[key].as_str().map(str::to_owned);
        found.ok_or_else(|| format!("gallery.toml: a figure or picture has no `{key}`"))
    };
    let lines = |value: &Value| -> Vec<String> {
        let list = value["commands"].as_array().into_iter().flatten();
        list.filter_map(Value::as_str).map(str::to_owned).collect()
    };
    let picture = |value: &Value| -> Outcome<Picture> {
        let (name, caption) = (text(value, "name")?, text(value, "caption")?);
        Ok(Picture { name, caption, commands: lines(value) })
    };
    let pictures = value["picture"].as_array().into_iter().flatten();
    Ok(Figure {
        name: text(value, "name")?,
        title: text(value, "title")?,
        about: text(value, "about")?,
        commands: lines(value),
        pictures: pictures.map(picture).collect::<Outcome<_>>()?,
    })
}

/// Runs the lines of a figure.
fn make(figure: &Figure) -> Outcome {
    let shared = root().join("../shared/data");
    let all = figure.commands.iter().chain(figure.pictures.iter().flat_map(|p| &p.commands));
    if !shared.is_dir() && all.into_iter().any(|line| line.contains("{shared}")) {
        println!("{}: skipped: no shared data", figure.name);
        return Ok(());
    }
    let out = target().join("gallery").join(&figure.name);
    if out.exists() {
        std::fs::remove_dir_all(&out).map_err(|e| format!("{}: {e}", out.display()))?;
    }
    std::fs::create_dir_all(&out).map_err(|e| format!("{}: {e}", out.display()))?;
    for line in &figure.commands {
        exurb(line, &out, Path::new(""))?;
    }
    for picture in &figure.pictures {
        let file = folder().join(format!("{}.png", picture.name));
        for line in &picture.commands {
            exurb(line, &out, &file)?;
        }
        let bytes = palette::pack(&file).map_err(|e| format!("{}: {e}", file.display()))?;
        if bytes > MOST_BYTES {
            return Err(format!("{} has {bytes} bytes; make it smaller", file.display()));
        }
    }
    println!("{}: {} pictures", figure.name, figure.pictures.len());
    Ok(())
}

fn exurb(line: &str, out: &Path, picture: &Path) -> Outcome {
    let (here, recipes) = (folder(), root().join("recipes"));
    let (data, shared) = (root().join("data"), root().join("../shared/data"));
    let places: [(&str, &Path); 6] = [
        ("{here}", &here),
        ("{recipes}", &recipes),
        ("{data}", &data),
        ("{shared}", &shared),
        ("{out}", out),
        ("{picture}", picture),
    ];
    let filled = |word: &str| {
        places.iter().fold(word.to_owned(), |word, (name, path)| {
            word.replace(name, &path.display().to_string())
        })
    };
    let mut command = Command::new(target().join("release/exurb"));
    command.args(line.split_whitespace().map(filled)).arg("--quiet");
    output_of(&mut command).map(|_| ()).map_err(|e| format!("{line}: {e}"))
}

/// The page with all pictures that are there.
fn page(figures: &[Figure]) -> String {
    let mut page = HEADER.to_owned();
    for figure in figures {
        let there = |p: &&Picture| folder().join(format!("{}.png", p.name)).exists();
        let shown: Vec<&Picture> = figure.pictures.iter().filter(there).collect();
        if shown.is_empty() {
            continue;
        }
        let _ = writeln!(page, "\n## {}\n\n{}\n", figure.title, figure.about.trim());
        let row = |cell: &dyn Fn(&Picture) -> String| {
            let cells: Vec<String> = shown.iter().map(|p| cell(p)).collect();
            format!("| {} |\n", cells.join(" | "))
        };
        page.push_str(&row(&|p| p.caption.clone()));
        page.push_str(&row(&|_| "---".to_owned()));
        page.push_str(&row(&|p| format!("![{}]({}.png)", p.caption, p.name)));
    }
    page
}
