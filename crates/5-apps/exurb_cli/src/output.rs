//! Writing cities: all files of a job under way first, then all put in their places.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Instant;

use exurb_city::City;
use exurb_operation::Run;
use exurb_recipe::Export;
use rayon::prelude::*;

use crate::format::Format;
use crate::layer;
use crate::pending::Pending;
use crate::picture;
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
            picture::check(export, format)?;
            files.push((export.clone(), format, Pending::new(&folder.join(&export.file))?));
        }
        Ok(Self { files })
    }

    /// Writes them all, at once on the threads of the current pool; gives the seconds it took. A
    /// file appears only when all are whole.
    pub fn write(self, city: &City, run: &Run) -> Result<f64, Problem> {
        let started = Instant::now();
        run.phase("writing");
        let (done, total) = (AtomicU32::new(0), self.files.len() as u32);
        let one = |(export, format, pending): &(Export, Format, Pending)| {
            run.check()?;
            let others = match &export.layer {
                Some(name) => {
                    let mut alone = layer::alone(city, name);
                    if format.is_model() || picture::is_perspective(export) {
                        // A layer stands where it stands in the whole.
                        alone.terrain.clone_from(&city.terrain);
                    }
                    write(&alone, export, *format, pending)?
                }
                None => write(city, export, *format, pending)?,
            };
            run.progress(done.fetch_add(1, Ordering::Relaxed) + 1, total);
            Ok(others)
        };
        let others: Result<Vec<Vec<Pending>>, Problem> = self.files.par_iter().map(one).collect();
        let others = others?;
        run.check()?;
        for (_, format, pending) in self.files {
            let path = pending.path().to_owned();
            pending.commit()?;
            if format == Format::GeoPackage {
                exurb_gis::forget_journals(&path);
            }
        }
        others.into_iter().flatten().try_for_each(Pending::commit)?;
        Ok(started.elapsed().as_secs_f64())
    }
}

/// A folder to write into. One that was made for this and stayed empty goes again, unless it is
/// kept.
#[derive(Debug)]
pub struct Folder {
    made: Option<PathBuf>,
}

impl Folder {
    /// Makes the folder and those around it where it is not there.
    pub fn make(folder: &Path) -> Result<Self, Problem> {
        let made = (!folder.exists()).then(|| folder.to_owned());
        std::fs::create_dir_all(folder)
            .map_err(|e| Problem::failed(format!("{} cannot be made: {e}", folder.display())))?;
        Ok(Self { made })
    }

    /// Lets it stay.
    pub fn keep(mut self) {
        self.made = None;
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if let Some(made) = &self.made {
            // What holds something stays.
            let _ = std::fs::remove_dir(made);
        }
    }
}

/// Writes one file; gives the files that go with it.
fn write(
    city: &City,
    export: &Export,
    format: Format,
    pending: &Pending,
) -> Result<Vec<Pending>, Problem> {
    let model = exurb_model3d::Options::default();
    let streets = layer::streets(export.layer.as_deref());
    match format {
        Format::GeoPackage => exurb_gis::write_geopackage_streets(city, streets, pending.beside())
            .map_err(|e| pending.problem(&e.to_string()))?,
        Format::GeoJson => {
            pending.stream(|out| exurb_gis::write_geojson_streets(city, streets, out))?;
        }
        Format::OsmXml => pending.stream(|out| exurb_osm::write_xml(city, out))?,
        Format::OsmXmlGz => pending.stream(|out| {
            let mut packed = flate2::write::GzEncoder::new(out, flate2::Compression::default());
            exurb_osm::write_xml(city, &mut packed)?;
            packed.finish().map(|_| ())
        })?,
        Format::OsmPbf => pending.stream(|out| exurb_osm::write_pbf(city, out))?,
        Format::Glb => {
            let glb = exurb_model3d::to_glb(city, &model);
            pending.write(&glb.map_err(|e| pending.problem(&e.to_string()))?)?;
        }
        Format::Obj => return write_obj(city, &model, pending),
        Format::Svg => {
            pending.write(exurb_plan::to_svg(city, &picture::map(export)?).as_bytes())?
        }
        Format::GeoTiff => {
            let tif = exurb_terrain::to_geotiff(city);
            pending.write(&tif.map_err(|e| pending.problem(&e.to_string()))?)?;
        }
        Format::Png if picture::is_height_map(export) => return write_height_map(city, pending),
        Format::Png if picture::is_perspective(export) => {
            let png = exurb_model3d::render_png(city, &model, &picture::view(export));
            pending.write(&png.map_err(|e| pending.problem(&e.to_string()))?)?;
        }
        Format::Png => {
            let png = exurb_plan::to_png(city, &picture::map(export)?);
            pending.write(&png.map_err(|e| pending.problem(&e.to_string()))?)?;
        }
    }
    Ok(Vec::new())
}

/// A height map, and beside it what its values mean and where it lies.
fn write_height_map(city: &City, pending: &Pending) -> Result<Vec<Pending>, Problem> {
    let map = exurb_terrain::to_png(city).map_err(|e| pending.problem(&e.to_string()))?;
    pending.write(&map.png)?;
    let beside = [("json", map.json), ("pgw", map.world), ("prj", map.projection)];
    let mut others = Vec::new();
    for (ending, text) in beside {
        let other = Pending::new(&pending.path().with_extension(ending))?;
        other.write(text.as_bytes())?;
        others.push(other);
    }
    Ok(others)
}

/// An OBJ, and beside it its materials and textures.
fn write_obj(
    city: &City,
    model: &exurb_model3d::Options,
    pending: &Pending,
) -> Result<Vec<Pending>, Problem> {
    let stem = pending.stem();
    let files = exurb_model3d::to_obj(city, model, &stem);
    let files = files.map_err(|e| pending.problem(&e.to_string()))?;
    pending.write(files.obj.as_bytes())?;
    let materials = (format!("{stem}.mtl"), files.mtl.into_bytes());
    let mut others = Vec::new();
    for (name, bytes) in files.textures.into_iter().chain([materials]) {
        let other = Pending::new(&pending.path().with_file_name(name))?;
        other.write(&bytes)?;
        others.push(other);
    }
    Ok(others)
}
