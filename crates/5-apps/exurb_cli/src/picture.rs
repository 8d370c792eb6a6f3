//! What a picture shows, from the options of an export.

use clap::builder::PossibleValuesParser;
use exurb_model3d::View;
use exurb_plan::{ColorBy, Layer, Options, Style};
use exurb_recipe::Export;

use crate::format::Format;
use crate::layer;
use crate::problem::Problem;

/// The styles of maps, for the command line.
pub fn style_names() -> PossibleValuesParser {
    PossibleValuesParser::new(Style::ALL.map(Style::as_str))
}

/// What colours of maps can tell, for the command line.
pub fn color_names() -> PossibleValuesParser {
    PossibleValuesParser::new(ColorBy::ALL.map(ColorBy::as_str))
}

/// Is it a perspective picture, not a map?
pub fn is_perspective(export: &Export) -> bool {
    export.view.as_deref() == Some("3d")
}

/// Is it the terrain's height map, not a picture of it?
pub fn is_height_map(export: &Export) -> bool {
    export.layer.as_deref() == Some(layer::TERRAIN) && export.view.is_none()
}

/// Is there all that the options ask for?
pub fn check(export: &Export, format: Format) -> Result<(), Problem> {
    let name = export.file.display();
    map(export)?;
    if let Some(layer) = &export.layer {
        layer::check(layer, format)?;
    }
    options_fit(export)?;
    if is_perspective(export) && format != Format::Png {
        return Err(Problem::usage(format!(
            "{name}: perspective pictures are PNG; end the name in .png, or write a model as .glb \
             or .obj"
        )));
    }
    match export.view.as_deref() {
        Some("map" | "3d") | None => Ok(()),
        Some(view) => Err(unknown("view", view, &["map", "3d"])),
    }
}

/// Does every option say something of this kind of picture, within its range?
fn options_fit(export: &Export) -> Result<(), Problem> {
    let wrong =
        |message: String| Err(Problem::usage(format!("{}: {message}", export.file.display())));
    let of_maps = [("style", export.style.is_some()), ("color-by", export.color_by.is_some())];
    let on_view = of_maps.into_iter().find(|(_, given)| *given && is_perspective(export));
    if let Some((option, _)) = on_view {
        return wrong(format!(
            "{option} is for maps; a perspective picture has the colours of the model"
        ));
    }
    for (option, value, least, most) in [
        ("azimuth", export.azimuth, -360.0, 360.0),
        ("elevation", export.elevation, 2.0, 89.0),
        ("zoom", export.zoom, 0.1, 100.0),
        ("width", export.width.map(f64::from).filter(|_| is_perspective(export)), 32.0, 8192.0),
    ] {
        let Some(value) = value else { continue };
        if !is_perspective(export) {
            return wrong(format!("{option} is for perspective pictures; ask for view 3d"));
        }
        if !(least..=most).contains(&value) {
            return wrong(format!("{option} is {value}, expected {least} to {most}"));
        }
    }
    Ok(())
}

/// The map's options.
pub fn map(export: &Export) -> Result<Options, Problem> {
    let default = Options::default();
    let style = export.style.as_deref().map(|name| {
        Style::parse(name).ok_or_else(|| unknown("style", name, &Style::ALL.map(Style::as_str)))
    });
    let color_by = export.color_by.as_deref().map(|name| {
        let known = ColorBy::ALL.map(ColorBy::as_str);
        ColorBy::parse(name).ok_or_else(|| unknown("colouring", name, &known))
    });
    let layers = match export.layer.as_deref().and_then(Layer::parse) {
        Some(layer) => vec![layer],
        None => default.layers,
    };
    Ok(Options {
        width_px: export.width.unwrap_or(default.width_px),
        style: style.transpose()?.unwrap_or(default.style),
        color_by: color_by.transpose()?,
        layers,
        ..default
    })
}

/// The perspective picture's camera; its shape stays that of the default.
pub fn view(export: &Export) -> View {
    let default = View::default();
    let width_px = export.width.unwrap_or(default.width_px);
    let height_px = (width_px * default.height_px / default.width_px).max(16);
    View {
        width_px,
        height_px,
        azimuth_deg: export.azimuth.unwrap_or(default.azimuth_deg),
        elevation_deg: export.elevation.unwrap_or(default.elevation_deg),
        zoom: export.zoom.unwrap_or(default.zoom),
        ..default
    }
}

fn unknown(kind: &str, name: &str, known: &[&str]) -> Problem {
    Problem::usage(format!("there is no {kind} `{name}`; there are {}", known.join(", ")))
}
