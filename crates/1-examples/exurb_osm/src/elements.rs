//! What every reader delivers: nodes, ways and relations of a file, as far as they can matter.

use crate::tags::Tags;
use crate::{features, streets, surfaces};

/// A node's place in 1e-7 degrees.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Node {
    pub id: i64,
    pub lon: i32,
    pub lat: i32,
}

/// A way; its node ids are `refs[start..end]` of its [`Elements`].
#[derive(Clone, Debug)]
pub struct Way {
    pub id: i64,
    pub tags: Tags,
    pub start: usize,
    pub end: usize,
}

/// A relation and its member ways in order; `outer` are those that are not inner.
#[derive(Clone, Debug)]
pub struct Relation {
    pub id: i64,
    pub tags: Tags,
    pub ways: Vec<i64>,
    pub outer: Vec<i64>,
}

/// A member way of a relation.
#[derive(Clone, Copy, Debug)]
pub struct Member {
    pub way: i64,
    pub is_inner: bool,
}

/// West, south, east, north in degrees.
pub type Bounds = [f64; 4];

/// The elements of a file, in any order until [`Elements::sort`].
///
/// Ways are kept whether or not they are something by themselves, because a relation read later may
/// name them; tags only of ways that are, and only keys that matter; of tagged nodes only features.
#[derive(Debug, Default)]
pub struct Elements {
    /// Where the data are complete, as the file declares it.
    pub bounds: Option<Bounds>,
    /// Attribution given in the file.
    pub attribution: Vec<String>,
    /// What the server that made the file says went wrong.
    pub remarks: Vec<String>,
    /// Written by this program: its attribution is the whole of it.
    pub is_ours: bool,
    pub nodes: Vec<Node>,
    /// Ids and tags of nodes that are features.
    pub tagged: Vec<(i64, Tags)>,
    /// Ids of nodes at which a street is said to run on (`fixme=continue`).
    pub continued: Vec<i64>,
    pub ways: Vec<Way>,
    pub refs: Vec<i64>,
    pub relations: Vec<Relation>,
    /// Nodes without a place on earth; ways break there.
    pub misplaced: usize,
}

impl Elements {
    /// Adds a node given in degrees.
    pub fn push_node(&mut self, id: i64, lon: f64, lat: f64) {
        if lon.abs() <= 180.0 && lat.abs() <= 90.0 {
            let fixed = |degrees: f64| (degrees * 1e7).round() as i32;
            self.nodes.push(Node { id, lon: fixed(lon), lat: fixed(lat) });
        } else {
            self.misplaced += 1;
        }
    }

    /// Adds the tags of a node, if they make it a feature or an end where a street runs on.
    pub fn push_node_tags(&mut self, id: i64, tags: Tags) {
        if tags.get("fixme") == Some("continue") {
            self.continued.push(id);
        }
        if features::kind(&tags).is_some() {
            self.tagged.push((id, tags.shrunk()));
        }
    }

    /// Adds a way; its tags are kept if they make it something.
    pub fn push_way(&mut self, id: i64, tags: Tags, refs: impl IntoIterator<Item = i64>) {
        let matters = streets::class(&tags).is_some() || surfaces::matters(&tags);
        let tags = if matters { tags.shrunk() } else { Tags::default() };
        let start = self.refs.len();
        self.refs.extend(refs);
        self.ways.push(Way { id, tags, start, end: self.refs.len() });
    }

    /// Adds a relation, if its type is one of areas.
    pub fn push_relation(&mut self, id: i64, tags: Tags, members: Vec<Member>) {
        if matches!(tags.get("type"), Some("multipolygon" | "boundary")) {
            let outer = members.iter().filter(|m| !m.is_inner).map(|m| m.way).collect();
            let ways = members.into_iter().map(|m| m.way).collect();
            self.relations.push(Relation { id, tags, ways, outer });
        }
    }

    /// Adds all of `other`; its bounds only where this has none.
    pub fn append(&mut self, mut other: Self) {
        let shift = self.refs.len();
        self.bounds = self.bounds.or(other.bounds);
        self.attribution.append(&mut other.attribution);
        self.remarks.append(&mut other.remarks);
        self.is_ours |= other.is_ours;
        self.nodes.append(&mut other.nodes);
        self.tagged.append(&mut other.tagged);
        self.continued.append(&mut other.continued);
        self.refs.append(&mut other.refs);
        self.ways.extend(other.ways.into_iter().map(|mut way| {
            way.start += shift;
            way.end += shift;
            way
        }));
        self.relations.append(&mut other.relations);
        self.misplaced += other.misplaced;
    }

    /// Brings everything into order of ids. Of elements given twice the first one stays; of ways
    /// the first one with tags.
    pub fn sort(&mut self) {
        if !self.nodes.is_sorted_by_key(|n| n.id) {
            self.nodes.sort_by_key(|n| n.id);
        }
        self.nodes.dedup_by_key(|n| n.id);
        self.tagged.sort_by_key(|(id, _)| *id);
        self.tagged.dedup_by_key(|(id, _)| *id);
        self.ways.sort_by_key(|w| (w.id, w.tags.is_empty()));
        self.ways.dedup_by_key(|w| w.id);
        self.relations.sort_by_key(|r| r.id);
        self.relations.dedup_by_key(|r| r.id);
    }

    /// The node ids of a way.
    pub fn refs_of(&self, way: &Way) -> &[i64] {
        &self.refs[way.start..way.end]
    }

    /// The way `id`, once sorted.
    pub fn way_index(&self, id: i64) -> Option<usize> {
        self.ways.binary_search_by_key(&id, |w| w.id).ok()
    }
}

/// Did this program write a file whose head names that generator? Its scripts, such as the one that cuts
/// extracts, name themselves behind its name and no version.
pub fn is_ours(generator: &str) -> bool {
    let version = generator.strip_prefix(crate::GENERATOR).and_then(|v| v.strip_prefix(' '));
    version.is_some_and(|v| v.starts_with(|c: char| c.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_only_cut_an_extract_did_not_write_its_data() {
        assert!(is_ours("exurb 0.1.0"));
        for other in ["exurb", "exurb data/cut_osm.py", "exurbia 1", "osmium/1.16"] {
            assert!(!is_ours(other), "{other}");
        }
    }
}
