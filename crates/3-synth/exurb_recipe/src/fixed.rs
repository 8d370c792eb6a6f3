//! Streets that a user gives: read into the city's frame before a step.

use std::path::Path;

use exurb_city::{City, ImportOptions, StreetGraph, given};
use exurb_geom::{Frame, GridPoint, Vec2};
use exurb_operation::{Run, Scope};

use crate::{Error, open};

/// Lays the streets of a map into the city: into the scope's polygon, where it has one.
pub fn lay(
    city: &mut City,
    file: &Path,
    scope: &Scope,
    folder: &Path,
    run: &Run,
) -> Result<(), Error> {
    let path = open::locate(file, folder)?;
    let drawn = open::open_city(&path, &ImportOptions::default())?.city;
    let streets = in_frame(&drawn.streets, &drawn.frame, &city.frame).ok_or_else(|| {
        Error::Input(open::named(
            &path,
            "its streets lie too far from the target; draw them nearer",
        ))
    })?;
    let area = match scope {
        Scope::Inside(area) => Some(area),
        Scope::All | Scope::Blocks(_) => None,
    };
    if given::lay_given(city, &streets, area) == 0 {
        let message = "it has no street in the target; draw some there, or leave `fixed` out";
        return Err(Error::Input(open::named(&path, message)));
    }
    if area.is_none() && !streets.nodes().any(|(_, n)| city.target.contains(n.at)) {
        run.warn(open::named(&path, "none of its streets begins or ends in the target"));
    }
    city.metadata.credit(&drawn.metadata.attribution);
    Ok(())
}

/// The streets of another frame in this one; `None` where they lie beyond its reach.
fn in_frame(streets: &StreetGraph, from: &Frame, to: &Frame) -> Option<StreetGraph> {
    let moved = |p: &GridPoint| -> Option<GridPoint> {
        let at: Vec2 = to.project(from.unproject(p.to_m()))?;
        GridPoint::checked(at)
    };
    let lines: Option<Vec<_>> = streets
        .edges()
        .map(|(_, e)| {
            Some((e.line().iter().map(moved).collect::<Option<Vec<_>>>()?, e.data.clone()))
        })
        .collect();
    Some(exurb_city::street_graph::from_lines(lines?))
}
