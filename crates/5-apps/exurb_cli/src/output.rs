//! Writing cities: all files of a job under way first, then all put in their places.

use std::path::Path;
use std::time::Instant;

use clap::builder::PossibleValuesParser;
use exurb_city::City;
use exurb_operation::Run;
use exurb_plan::{ColorBy, Layer, Style};
use exurb_recipe::Export;

use crate::format::Format;
use crate::layer;
use crate::pending::Pending;
use crate::problem::Problem;

/// The files that a job will write.
#[derive(Debug)]
pub struct Outputs {
    files: Vec<(Export, Format, Pending)>,
}

impl Outputs {
    /// Checks, before any long work, that every file can be written and its format is known.
    pub fn prepare(exports: &[Export], folder: &Path) -> Result<Self, Problem> {
        let formats: Result<Vec<Format>, Problem> =
            exports.iter().map(|e| Format::of(&e.file, e.to.as_deref())).collect();
        let mut files = Vec::new();
        for (export, format) in exports.iter().zip(formats?) {
            check(export, format)?;
            files.push((export.clone(), format, Pending::new(&folder.join(&export.file))?));
        }
        Ok(Self { files })
    }

    /// Writes them all; gives the seconds it took. A file appears only when all are whole.
    pub fn write(self, city: &City, run: &Run) -> Result<f64, Problem> {
        let started = Instant::now();
        for (export, format, pending) in &self.files {
            run.phase(&format!("writing {}", export.file.display()));
            run.check()?;
            match &export.layer {
                Some(name) => write(&layer::alone(city, name)?, export, *format, pending)?,
                None => write(city, export, *format, pending)?,
            }
        }
        run.check()?;
        for (.., pending) in self.files {
            pending.commit()?;
        }
        Ok(started.elapsed().as_secs_f64())
    }
}

/// Makes a folder and those around it.
pub fn make_folder(folder: &Path) -> Result<(), Problem> {
    std::fs::create_dir_all(folder)
        .map_err(|e| Problem::failed(format!("{} cannot be made: {e}", folder.display())))
}

/// The styles of maps, for the command line.
pub fn style_names() -> PossibleValuesParser {
    PossibleValuesParser::new(Style::ALL.map(Style::as_str))
}

/// What colours of maps can tell, for the command line.
pub fn color_names() -> PossibleValuesParser {
    PossibleValuesParser::new(ColorBy::ALL.map(ColorBy::as_str))
}

fn write(city: &City, export: &Export, format: Format, pending: &Pending) -> Result<(), Problem> {
    let path = pending.beside();
    let failed = |message: String| pending.problem(&message);
    match format {
        Format::GeoPackage => {
            exurb_gis::write_geopackage(city, path).map_err(|e| failed(e.to_string()))
        }
        Format::GeoJson | Format::OsmXml | Format::OsmPbf | Format::Glb | Format::Obj => {
            Err(failed("LATER".to_owned()))
        }
        Format::Svg => pending.write(exurb_plan::to_svg(city, &map_options(export)?).as_bytes()),
        Format::Png if export.view.as_deref() == Some("3d") => Err(failed("LATER".to_owned())),
        Format::Png => {
            let png = exurb_plan::to_png(city, &map_options(export)?);
            pending.write(&png.map_err(|e| failed(e.to_string()))?)
        }
    }
}

/// What the options of an export ask for is there.
fn check(export: &Export, format: Format) -> Result<(), Problem> {
    let name = export.file.display();
    map_options(export)?;
    if let Some(layer) = &export.layer {
        layer::check(layer)?;
    }
    match export.view.as_deref() {
        Some("3d") if format != Format::Png => Err(Problem::usage(format!(
            "{name}: perspective pictures are PNG; end the name in .png, or write a model as .glb or .obj"
        ))),
        Some("map" | "3d") | None => Ok(()),
        Some(view) => {
            Err(Problem::usage(format!("{name}: there is no view `{view}`; there are map and 3d")))
        }
    }
}

fn map_options(export: &Export) -> Result<exurb_plan::Options, Problem> {
    let default = exurb_plan::Options::default();
    let known = |kind: &str, name: &str, all: Vec<&str>| {
        Problem::usage(format!("there is no {kind} `{name}`; there are {}", all.join(", ")))
    };
    let style = match export.style.as_deref() {
        Some(name) => Style::parse(name)
            .ok_or_else(|| known("style", name, Style::ALL.map(Style::as_str).to_vec()))?,
        None => default.style,
    };
    let color_by =
        match export.color_by.as_deref() {
            Some(name) => Some(ColorBy::parse(name).ok_or_else(|| {
                known("colouring", name, ColorBy::ALL.map(ColorBy::as_str).to_vec())
            })?),
            None => default.color_by,
        };
    let layers = match export.layer.as_deref().and_then(Layer::parse) {
        Some(layer) => vec![layer],
        None => default.layers,
    };
    let width_px = export.width.unwrap_or(default.width_px);
    Ok(exurb_plan::Options { width_px, style, color_by, layers, ..default })
}
