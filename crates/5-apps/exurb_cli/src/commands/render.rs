//! `exurb render CITY -o FILE.png|.svg`

use std::path::{Path, PathBuf};

use clap::{ArgMatches, Args, Command, FromArgMatches};
use exurb_recipe::{Export, Source};

use crate::format::Format;
use crate::options::{DryOptions, OutputOptions, PartOptions, RunOptions};
use crate::output::Outputs;
use crate::problem::Problem;
use crate::{job, summary};

#[derive(Args)]
struct Options {
    /// City or map of any readable format
    city: PathBuf,
    #[command(flatten)]
    output: OutputOptions,
    /// The map from above, or a perspective picture (PNG only)
    #[arg(long, value_name = "VIEW", default_value = "map", value_parser = ["map", "3d"])]
    view: String,
    /// Colours and widths of the map
    #[arg(long, value_name = "NAME", value_parser = crate::picture::style_names())]
    style: Option<String>,
    /// What colours tell, instead of the style's own
    #[arg(long, value_name = "WHAT", value_parser = crate::picture::color_names())]
    color_by: Option<String>,
    /// Draw this layer alone
    #[arg(long, value_name = "LAYER")]
    layer: Option<String>,
    /// Width in pixels
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(16..=20_000))]
    width: Option<u32>,
    /// Perspective: where the camera stands, in degrees clockwise from north [default: 225]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    azimuth: Option<f64>,
    /// Perspective: how high it stands over the horizon, in degrees [default: 30]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    elevation: Option<f64>,
    /// Perspective: 1 fills the picture with the city, 2 with half of it [default: 1]
    #[arg(long, value_name = "FACTOR", allow_negative_numbers = true)]
    zoom: Option<f64>,
    #[command(flatten)]
    part: PartOptions,
    #[command(flatten)]
    dry: DryOptions,
    #[command(flatten)]
    run: RunOptions,
}

/// The command.
pub fn command() -> Command {
    let about = "Draw a city: the map from above, or a perspective picture";
    let command = Options::augment_args(Command::new("render")).about(about);
    command.mut_arg("to", |to| to.value_parser(["png", "svg"]))
}

/// Runs it.
pub fn run(matches: &ArgMatches) -> Result<(), Problem> {
    let options = Options::from_arg_matches(matches).map_err(|e| Problem::usage(e.to_string()))?;
    let output = &options.output.output;
    if !Format::of(output, options.output.to.as_deref())?.is_picture() {
        let message = format!("{} is no picture; end it in .png or .svg", output.display());
        return Err(Problem::usage(message));
    }
    let export = Export {
        file: output.clone(),
        to: options.output.to.clone(),
        layer: options.layer.clone(),
        view: Some(options.view.clone()),
        style: options.style.clone(),
        color_by: options.color_by.clone(),
        width: options.width,
        azimuth: options.azimuth,
        elevation: options.elevation,
        zoom: options.zoom,
    };
    let source = options.part.apply(Source::new(&options.city));
    job::work(&options.run, 1, |run| {
        let outputs = Outputs::prepare(&[export], Path::new(""))?;
        let city = exurb_recipe::read_source(&source, Path::new(""), run)?;
        if options.dry.dry_run { Ok(()) } else { outputs.write(&city, run).map(|_| ()) }
    })?;
    let files: &[&PathBuf] = if options.dry.dry_run { &[] } else { &[output] };
    summary::written(files, &options.run)
}
