//! PBF: blobs are read in order and decoded in parallel, a batch at a time.
//!
//! Decoded with the messages of [`crate::pbf_format`] rather than a reader crate: those at hand
//! panic on corrupt deltas and unknown member types.

use std::cell::OnceCell;
use std::io::{BufRead, Read};
use std::sync::Arc;

use flate2::bufread::ZlibDecoder;
use prost::Message;
use prost::bytes::Bytes;
use rayon::prelude::*;

use crate::Error;
use crate::elements::{Elements, Member, is_ours};
use crate::pbf_format as pbf;
use crate::pbf_format::{GRANULARITY, MAX_BLOB_BYTES, MAX_HEADER_BYTES};
use crate::read::Ratio;
use crate::tags::{self, Key, Tags};

/// Blobs decoded at a time: enough for every core, few enough to stay small.
const BATCH: usize = 64;

/// Reads a whole file.
pub fn read(mut input: impl BufRead, file: &str) -> Result<Elements, Error> {
    let mut out = Elements::default();
    let mut ratio = Ratio::default();
    let mut begun = false;
    loop {
        let mut batch = Vec::with_capacity(BATCH);
        while batch.len() < BATCH {
            let Some(blob) = next_blob(&mut input, file)? else { break };
            batch.push(blob);
        }
        if batch.is_empty() {
            break;
        }
        let packed: usize = batch.iter().map(|(_, bytes)| bytes.len()).sum();
        let decoded: Vec<Result<Decoded, String>> =
            batch.into_par_iter().map(|(kind, bytes)| decode(&kind, bytes)).collect();
        for block in decoded {
            let block = block.map_err(|what| Error::corrupt(file, what))?;
            if let Some(feature) = block.unknown_feature {
                let what =
                    format!("needs `{feature}`, which is not supported; convert it with osmium");
                return Err(Error::Unsupported { file: file.to_owned(), what });
            }
            ratio.unpacked += block.unpacked as u64;
            begun |= block.is_header;
            out.append(block.elements);
        }
        ratio.packed += packed as u64;
        if ratio.is_bomb() {
            return Err(Error::Bomb { file: file.to_owned() });
        }
    }
    if begun { Ok(out) } else { Err(Error::corrupt(file, "it has no OSMHeader block")) }
}

/// Kind and bytes of the next blob; `None` at the end of the file.
fn next_blob(input: &mut impl BufRead, file: &str) -> Result<Option<(String, Bytes)>, Error> {
    let failed = |e| Error::reading(file, e);
    if input.fill_buf().map_err(failed)?.is_empty() {
        return Ok(None);
    }
    let mut size = [0; 4];
    input.read_exact(&mut size).map_err(failed)?;
    let size = u32::from_be_bytes(size) as usize;
    if size > MAX_HEADER_BYTES {
        return Err(Error::corrupt(file, format!("a blob header of {size} bytes")));
    }
    let header = read_bytes(input, size).map_err(failed)?;
    let header = pbf::BlobHeader::decode(header).map_err(|e| Error::corrupt(file, e))?;
    let size = usize::try_from(header.datasize).ok().filter(|size| *size <= MAX_BLOB_BYTES);
    let size =
        size.ok_or_else(|| Error::corrupt(file, format!("a blob of {} bytes", header.datasize)))?;
    Ok(Some((header.kind, read_bytes(input, size).map_err(failed)?)))
}

/// Exactly `size` bytes, with no more memory taken than there are bytes to read.
fn read_bytes(input: &mut impl BufRead, size: usize) -> std::io::Result<Bytes> {
    let mut bytes = Vec::new();
    input.by_ref().take(size as u64).read_to_end(&mut bytes)?;
    if bytes.len() < size {
        return Err(std::io::Error::new(
            std::io::ErrorKind::UnexpectedEof,
            "it ends inside a blob",
        ));
    }
    Ok(Bytes::from(bytes))
}

#[derive(Default)]
struct Decoded {
    is_header: bool,
    unknown_feature: Option<String>,
    unpacked: usize,
    elements: Elements,
}

fn decode(kind: &str, blob: Bytes) -> Result<Decoded, String> {
    match kind {
        "OSMHeader" => decode_header(unpack(blob)?),
        "OSMData" => {
            let data = unpack(blob)?;
            let unpacked = data.len();
            let block = pbf::PrimitiveBlock::decode(data).map_err(|e| e.to_string())?;
            let mut elements = Elements::default();
            Block::new(&block).read(&block, &mut elements);
            Ok(Decoded { unpacked, elements, ..Decoded::default() })
        }
        // The format asks readers to skip what they do not know.
        _ => Ok(Decoded::default()),
    }
}

fn unpack(blob: Bytes) -> Result<Bytes, String> {
    let blob = pbf::Blob::decode(blob).map_err(|e| e.to_string())?;
    if let Some(raw) = blob.raw {
        return Ok(raw);
    }
    let packed =
        blob.zlib_data.ok_or("a blob that is not packed by zlib; convert it with osmium")?;
    let size = usize::try_from(blob.raw_size.unwrap_or(0)).unwrap_or(0);
    if size > MAX_BLOB_BYTES {
        return Err(format!("a blob that unpacks to {size} bytes"));
    }
    // A false size must not reserve memory that the data cannot fill.
    let mut out = Vec::with_capacity(size.min(packed.len().saturating_mul(1024)));
    let limit = MAX_BLOB_BYTES as u64 + 1;
    ZlibDecoder::new(&packed[..]).take(limit).read_to_end(&mut out).map_err(|e| e.to_string())?;
    if out.len() > MAX_BLOB_BYTES {
        return Err("a blob that unpacks to over 32 MiB".to_owned());
    }
    Ok(Bytes::from(out))
}

fn decode_header(data: Bytes) -> Result<Decoded, String> {
    let header = pbf::HeaderBlock::decode(data).map_err(|e| e.to_string())?;
    let known = ["OsmSchema-V0.6", "DenseNodes"];
    let unknown_feature =
        header.required_features.into_iter().find(|f| !known.contains(&f.as_str()));
    let degrees = |nano: i64| nano as f64 * 1e-9;
    let bounds = header.bbox.map(|b| [b.left, b.bottom, b.right, b.top].map(degrees));
    let mut elements = Elements { bounds, ..Elements::default() };
    elements.is_ours = header.writingprogram.is_some_and(|p| is_ours(&p));
    if let Some(source) = header.source.filter(|_| elements.is_ours) {
        elements.attribution.extend(source.split("; ").map(str::to_owned));
    }
    Ok(Decoded { is_header: true, unknown_feature, elements, ..Decoded::default() })
}

/// The string table of a block, with the keys that matter found once, and its scale.
struct Block<'a> {
    keys: Vec<Option<Key>>,
    texts: &'a [Bytes],
    values: Vec<OnceCell<Option<Arc<str>>>>,
    granularity: i64,
    lat_offset: i64,
    lon_offset: i64,
}

impl<'a> Block<'a> {
    fn new(block: &'a pbf::PrimitiveBlock) -> Self {
        let texts = &block.stringtable.s[..];
        let keys = texts.iter().map(|s| std::str::from_utf8(s).ok().and_then(tags::key)).collect();
        Self {
            keys,
            texts,
            values: vec![OnceCell::new(); texts.len()],
            granularity: i64::from(block.granularity.unwrap_or(GRANULARITY)),
            lat_offset: block.lat_offset.unwrap_or(0),
            lon_offset: block.lon_offset.unwrap_or(0),
        }
    }

    fn read(&self, block: &pbf::PrimitiveBlock, out: &mut Elements) {
        for group in &block.groups {
            for node in &group.nodes {
                self.place(node.id, node.lon, node.lat, out);
                out.push_node_tags(node.id, self.tags(&node.keys, &node.vals));
            }
            if let Some(dense) = &group.dense {
                self.dense(dense, out);
            }
            for way in &group.ways {
                self.way(way, out);
            }
            for relation in &group.relations {
                let tags = self.tags(&relation.keys, &relation.vals);
                out.push_relation(relation.id, tags, self.members(relation));
            }
        }
    }

    fn dense(&self, dense: &pbf::DenseNodes, out: &mut Elements) {
        let places = undelta(&dense.lon).zip(undelta(&dense.lat));
        let mut keys_vals = dense.keys_vals.iter();
        out.nodes.reserve(dense.id.len());
        for (id, (lon, lat)) in undelta(&dense.id).zip(places) {
            self.place(id, lon, lat, out);
            let mut tags = Tags::default();
            while let Some(key) = keys_vals.next().filter(|key| **key != 0) {
                let value = keys_vals.next().copied().unwrap_or(0);
                self.tag(*key as usize, value as usize, &mut tags);
            }
            if !tags.is_empty() {
                out.push_node_tags(id, tags);
            }
        }
    }

    fn way(&self, way: &pbf::Way, out: &mut Elements) {
        let places = undelta(&way.lon).zip(undelta(&way.lat));
        for (id, (lon, lat)) in undelta(&way.refs).zip(places) {
            self.place(id, lon, lat, out);
        }
        out.push_way(way.id, self.tags(&way.keys, &way.vals), undelta(&way.refs));
    }

    fn members(&self, relation: &pbf::Relation) -> Vec<Member> {
        let kinds = relation.types.iter().zip(&relation.roles_sid);
        undelta(&relation.memids)
            .zip(kinds)
            .filter(|(_, (kind, _))| **kind == WAY)
            .map(|(way, (_, role))| {
                let role = usize::try_from(*role).ok().and_then(|role| self.texts.get(role));
                Member { way, is_inner: role.is_some_and(|role| role == "inner") }
            })
            .collect()
    }

    fn place(&self, id: i64, lon: i64, lat: i64, out: &mut Elements) {
        let degrees = |v: i64, offset: i64| {
            (v.saturating_mul(self.granularity).saturating_add(offset)) as f64 * 1e-9
        };
        out.push_node(id, degrees(lon, self.lon_offset), degrees(lat, self.lat_offset));
    }

    fn tags(&self, keys: &[u32], values: &[u32]) -> Tags {
        let mut tags = Tags::default();
        for (key, value) in keys.iter().zip(values) {
            self.tag(*key as usize, *value as usize, &mut tags);
        }
        tags
    }

    fn tag(&self, key: usize, value: usize, tags: &mut Tags) {
        if let Some(key) = self.keys.get(key).copied().flatten()
            && let Some(value) = self.value(value)
        {
            tags.push(key, value);
        }
    }

    /// A value, one copy for all elements of the block; `None` when it is no text.
    fn value(&self, at: usize) -> Option<Arc<str>> {
        let text = || std::str::from_utf8(&self.texts[at]).ok().map(Arc::from);
        self.values.get(at)?.get_or_init(text).clone()
    }
}

/// Member type of ways.
const WAY: i32 = 1;

/// Running sums of delta coded values; corrupt ones wrap around.
fn undelta(deltas: &[i64]) -> impl Iterator<Item = i64> {
    deltas.iter().scan(0i64, |sum, delta| {
        *sum = sum.wrapping_add(*delta);
        Some(*sum)
    })
}
