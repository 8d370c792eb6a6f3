use std::collections::BTreeMap;
use std::io::{BufWriter, Result, Write};

use exurb_city::City;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use prost::Message;
use prost::bytes::Bytes;
use rayon::prelude::*;

use crate::GENERATOR;
use crate::document::{Document, OutNode, OutRelation, OutWay, Tag};
use crate::pbf_format as pbf;

/// Entities in a block at most, as the format advises.
const BLOCK: usize = 8000;

/// Writes a city as PBF: dense nodes, delta coded, sorted, packed by zlib; ids, bounds and
/// attribution as [`crate::write_xml()`]. Equal cities give equal bytes.
pub fn write_pbf(city: &City, out: &mut impl Write) -> Result<()> {
    let document = Document::new(city);
    let nodes = document.nodes.par_chunks(BLOCK).enumerate().map(|(i, nodes)| {
        let mut strings = Strings::default();
        let dense = dense(nodes, i * BLOCK, &mut strings);
        block(pbf::PrimitiveGroup { dense: Some(dense), ..Default::default() }, strings)
    });
    let ways = document.ways.par_chunks(BLOCK).enumerate().map(|(i, ways)| {
        let mut strings = Strings::default();
        let ways = ways.iter().zip(i * BLOCK + 1..).map(|(w, id)| way(w, id, &mut strings));
        let ways = ways.collect();
        block(pbf::PrimitiveGroup { ways, ..Default::default() }, strings)
    });
    let relations = document.relations.par_chunks(BLOCK).enumerate().map(|(i, relations)| {
        let mut strings = Strings::default();
        let all = relations.iter().zip(i * BLOCK + 1..);
        let relations = all.map(|(r, id)| relation(r, id, &mut strings)).collect();
        block(pbf::PrimitiveGroup { relations, ..Default::default() }, strings)
    });
    let blocks: Vec<Vec<u8>> = nodes.chain(ways).chain(relations).collect::<Result<_>>()?;

    let mut out = BufWriter::new(out);
    out.write_all(&blob("OSMHeader", &header(&document).encode_to_vec())?)?;
    for block in blocks {
        out.write_all(&block)?;
    }
    out.flush()
}

fn header(document: &Document) -> pbf::HeaderBlock {
    let nano = |fixed: i32| i64::from(fixed) * i64::from(pbf::GRANULARITY);
    let bbox = document.bounds.map(|b| {
        let [left, bottom, right, top] = b.map(nano);
        pbf::HeaderBBox { left, right, top, bottom }
    });
    pbf::HeaderBlock {
        bbox,
        required_features: vec!["OsmSchema-V0.6".to_owned(), "DenseNodes".to_owned()],
        optional_features: vec!["Sort.Type_then_ID".to_owned()],
        writingprogram: Some(format!("{GENERATOR} {}", env!("CARGO_PKG_VERSION"))),
        source: Some(document.attribution.clone()),
    }
}

/// The string table of a block; 0 is the empty string.
#[derive(Default)]
struct Strings {
    index: BTreeMap<String, u32>,
    list: Vec<Bytes>,
}

impl Strings {
    fn id(&mut self, text: &str) -> u32 {
        if let Some(id) = self.index.get(text) {
            return *id;
        }
        self.list.push(Bytes::copy_from_slice(text.as_bytes()));
        let id = self.list.len() as u32;
        self.index.insert(text.to_owned(), id);
        id
    }

    fn tags(&mut self, tags: &[Tag]) -> (Vec<u32>, Vec<u32>) {
        tags.iter().map(|(key, value)| (self.id(key), self.id(value))).unzip()
    }

    fn table(self) -> pbf::StringTable {
        pbf::StringTable { s: std::iter::once(Bytes::new()).chain(self.list).collect() }
    }
}

/// Differences of neighbours.
fn delta(values: impl IntoIterator<Item = i64>) -> Vec<i64> {
    let mut last = 0;
    let mut step = |value: i64| value - std::mem::replace(&mut last, value);
    values.into_iter().map(&mut step).collect()
}

fn dense(nodes: &[OutNode], before: usize, strings: &mut Strings) -> pbf::DenseNodes {
    let mut keys_vals = Vec::new();
    if nodes.iter().any(|n| !n.tags.is_empty()) {
        for node in nodes {
            for (key, value) in &node.tags {
                keys_vals.extend([strings.id(key) as i32, strings.id(value) as i32]);
            }
            keys_vals.push(0);
        }
    }
    pbf::DenseNodes {
        id: delta((before + 1..=before + nodes.len()).map(|id| id as i64)),
        lat: delta(nodes.iter().map(|n| i64::from(n.lat))),
        lon: delta(nodes.iter().map(|n| i64::from(n.lon))),
        keys_vals,
    }
}

fn way(way: &OutWay, id: usize, strings: &mut Strings) -> pbf::Way {
    let (keys, vals) = strings.tags(&way.tags);
    let refs = delta(way.nodes.iter().copied());
    pbf::Way { id: id as i64, keys, vals, refs, ..Default::default() }
}

fn relation(relation: &OutRelation, id: usize, strings: &mut Strings) -> pbf::Relation {
    const WAY: i32 = 1;
    let (keys, vals) = strings.tags(&relation.tags);
    let role = |(_, is_inner): &(i64, bool)| if *is_inner { "inner" } else { "outer" };
    pbf::Relation {
        id: id as i64,
        keys,
        vals,
        roles_sid: relation.members.iter().map(|m| strings.id(role(m)) as i32).collect(),
        memids: delta(relation.members.iter().map(|(way, _)| *way)),
        types: vec![WAY; relation.members.len()],
    }
}

fn block(group: pbf::PrimitiveGroup, strings: Strings) -> Result<Vec<u8>> {
    let block = pbf::PrimitiveBlock {
        stringtable: strings.table(),
        groups: vec![group],
        ..Default::default()
    };
    blob("OSMData", &block.encode_to_vec())
}

/// A blob with its header, packed.
fn blob(kind: &str, data: &[u8]) -> Result<Vec<u8>> {
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::default());
    packed.write_all(data)?;
    let blob = pbf::Blob {
        raw: None,
        raw_size: Some(data.len() as i32),
        zlib_data: Some(Bytes::from(packed.finish()?)),
    };
    let header = pbf::BlobHeader { kind: kind.to_owned(), datasize: blob.encoded_len() as i32 };
    let header = header.encode_to_vec();
    let mut out = (header.len() as u32).to_be_bytes().to_vec();
    out.extend(header);
    blob.encode(&mut out).map_err(std::io::Error::other)?;
    Ok(out)
}
