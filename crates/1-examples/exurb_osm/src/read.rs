//! Opening a file: its format, unpacking, and the way to the reader.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use exurb_city::{Draft, ImportOptions, Imported};

use crate::elements::Elements;
use crate::{Error, import, read_overpass, read_pbf, read_xml};

/// The formats that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// OSM XML, `.osm`.
    Xml,
    /// OSM XML packed by gzip, `.osm.gz`.
    XmlGz,
    /// OSM XML packed by bzip2, `.osm.bz2`.
    XmlBz2,
    /// `.osm.pbf`.
    Pbf,
    /// Overpass JSON, `.json`.
    Overpass,
}

impl Format {
    /// The format of a file of that name; `None` when the ending is none of ours.
    pub fn of_name(name: &str) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        let ends = |ending| name.ends_with(ending);
        match () {
            () if ends(".pbf") => Some(Self::Pbf),
            () if ends(".osm.gz") || ends(".xml.gz") => Some(Self::XmlGz),
            () if ends(".osm.bz2") || ends(".xml.bz2") => Some(Self::XmlBz2),
            () if ends(".osm") || ends(".xml") => Some(Self::Xml),
            () if ends(".json") => Some(Self::Overpass),
            () => None,
        }
    }

    /// The format of a file that begins so; `None` when it is none of ours.
    pub fn of_content(start: &[u8]) -> Option<Self> {
        let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start).trim_ascii_start();
        match start {
            [0x1f, 0x8b, ..] => Some(Self::XmlGz),
            [b'B', b'Z', b'h', ..] => Some(Self::XmlBz2),
            _ if start.get(6..).is_some_and(|s| s.starts_with(b"OSMHeader")) => Some(Self::Pbf),
            _ if text.starts_with(b"<") => Some(Self::Xml),
            _ if text.starts_with(b"{") => Some(Self::Overpass),
            _ => None,
        }
    }
}

/// Reads a map and makes a city of it.
///
/// The content decides on the format; the ending is asked where the content does not tell.
/// The city's name is the file's without its endings.
pub fn read(path: &Path, options: &ImportOptions) -> Result<Imported, Error> {
    let (draft, warnings) = read_draft(path, options)?;
    city(draft, warnings, &path.display().to_string(), options)
}

/// [`read`] up to the draft: what the file holds, uncut, before streets become a graph and blocks.
/// With it one sentence for each thing to know. Of the options only the box matters, as the middle
/// of the frame.
pub fn read_draft(path: &Path, options: &ImportOptions) -> Result<(Draft, Vec<String>), Error> {
    let file = path.display().to_string();
    let open = File::open(path).map_err(|source| Error::Io { file: file.clone(), source })?;
    draft(BufReader::with_capacity(1 << 16, open), &file, Format::of_name(&file), options)
}

/// [`read`] from memory: `name` stands for the file's, `format` decides where the content does not
/// tell.
pub fn read_bytes(
    bytes: &[u8],
    name: &str,
    format: Option<Format>,
    options: &ImportOptions,
) -> Result<Imported, Error> {
    let (draft, warnings) = draft(bytes, name, format, options)?;
    city(draft, warnings, name, options)
}

fn draft(
    input: impl BufRead,
    file: &str,
    format: Option<Format>,
    options: &ImportOptions,
) -> Result<(Draft, Vec<String>), Error> {
    let mut elements = elements(input, file, format)?;
    elements.sort();
    import::draft(elements, file, options)
}

fn city(
    draft: Draft,
    warnings: Vec<String>,
    file: &str,
    options: &ImportOptions,
) -> Result<Imported, Error> {
    let failed = |source| Error::Draft { file: file.to_owned(), source };
    let mut imported = draft.assemble(options).map_err(failed)?;
    imported.warnings.splice(0..0, warnings);
    Ok(imported)
}

/// The elements of a file of any format.
pub fn elements(
    mut input: impl BufRead,
    file: &str,
    format: Option<Format>,
) -> Result<Elements, Error> {
    let start = input.fill_buf().map_err(|e| Error::reading(file, e))?;
    if start.is_empty() {
        return Err(Error::Empty { file: file.to_owned() });
    }
    let format = Format::of_content(start).or(format);
    match format.ok_or_else(|| Error::Format { file: file.to_owned() })? {
        Format::Pbf => read_pbf::read(input, file),
        Format::Xml => read_xml::read(input, file),
        Format::Overpass => read_overpass::read(input, file),
        Format::XmlGz => text(unpacked(input, flate2::bufread::MultiGzDecoder::new), file),
        Format::XmlBz2 => text(unpacked(input, bzip2::bufread::MultiBzDecoder::new), file),
    }
}

/// Unpacked XML or Overpass JSON.
fn text(mut input: impl BufRead, file: &str) -> Result<Elements, Error> {
    let start = input.fill_buf().map_err(|e| Error::reading(file, e))?;
    match Format::of_content(start) {
        Some(Format::Xml) => read_xml::read(input, file),
        Some(Format::Overpass) => read_overpass::read(input, file),
        _ => Err(Error::corrupt(file, "what is packed in it is neither OSM XML nor Overpass JSON")),
    }
}

/// Bytes before and after unpacking.
#[derive(Clone, Copy, Debug, Default)]
pub struct Ratio {
    /// Before.
    pub packed: u64,
    /// After.
    pub unpacked: u64,
}

impl Ratio {
    /// Over 64 MB at more than 200 to 1: maps pack at 10 to 30 to 1.
    pub fn is_bomb(self) -> bool {
        self.unpacked > 64_000_000 && self.unpacked / 200 > self.packed
    }
}

/// A decoder over `input` that refuses archive bombs.
fn unpacked<R: BufRead, D: Read>(
    input: R,
    decoder: impl FnOnce(BufReader<Counted<R>>) -> D,
) -> impl BufRead {
    let count = std::rc::Rc::new(std::cell::Cell::new(0));
    let counted = BufReader::new(Counted { input, count: count.clone() });
    let guarded = Guarded { decoder: decoder(counted), packed: count, unpacked: 0 };
    BufReader::with_capacity(1 << 16, guarded)
}

/// Counts the bytes that pass.
struct Counted<R> {
    input: R,
    count: std::rc::Rc<std::cell::Cell<u64>>,
}

impl<R: Read> Read for Counted<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let n = self.input.read(buffer)?;
        self.count.set(self.count.get() + n as u64);
        Ok(n)
    }
}

struct Guarded<D> {
    decoder: D,
    packed: std::rc::Rc<std::cell::Cell<u64>>,
    unpacked: u64,
}

impl<D: Read> Read for Guarded<D> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let n = self.decoder.read(buffer)?;
        self.unpacked += n as u64;
        if (Ratio { packed: self.packed.get(), unpacked: self.unpacked }).is_bomb() {
            return Err(std::io::Error::from(std::io::ErrorKind::FileTooLarge));
        }
        Ok(n)
    }
}
