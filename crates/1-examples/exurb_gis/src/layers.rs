//! The layers and columns of a city file, once (contract, section 4): both formats write and read
//! them through these tables.

use exurb_city::{
    Area, Block, BlockClass, Building, City, Class, Feature, Junction, Origin, Parcel, Provenance,
    Roof, Street,
};
use exurb_graph::EdgeId;

use crate::value::Value;
use crate::wkb::Shape;

/// A column; without a setter, one that follows from the rest.
macro_rules! column {
    ($name:literal, $kind:ident, $get:expr) => {
        Column { name: $name, kind: Kind::$kind, get: $get, set: |_, _| Some(()) }
    };
    ($name:literal, $kind:ident, $get:expr, |$row:ident, $value:ident| $set:expr) => {
        Column {
            name: $name,
            kind: Kind::$kind,
            get: $get,
            set: |$row, $value| {
                $set;
                Some(())
            },
        }
    };
}

/// One column of a layer of `T`.
pub struct Column<T> {
    /// Its name in files.
    pub name: &'static str,
    /// What it holds.
    pub kind: Kind,
    /// The value of an element.
    pub get: fn(&T) -> Value<'_>,
    /// Takes a value over into an element; `None` when it cannot be one. Columns that follow from
    /// the geometry are passed over.
    pub set: fn(&mut T, &Value<'_>) -> Option<()>,
}

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// True or false.
    Boolean,
    /// Like `Boolean`, and `yes` or absent in GeoJSON, as OSM has it.
    Flag,
    /// A whole number.
    Integer,
    /// Any number.
    Real,
    /// A text.
    Text,
}

/// Type of the geometries of a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names are those of the standard")]
pub enum GeometryType {
    Point,
    LineString,
    Polygon,
    Any,
}

/// A layer of `T`.
pub struct Layer<T: 'static> {
    /// Its name in files.
    pub name: &'static str,
    /// Type of its geometries.
    pub geometry: GeometryType,
    groups: &'static [&'static [Column<T>]],
}

impl<T> Layer<T> {
    /// Its columns, in order.
    pub fn columns(&self) -> impl Iterator<Item = &'static Column<T>> + use<T> {
        self.groups.iter().copied().flatten()
    }

    /// Takes the values of a row over into `row`: `value` gives the column of that number and name.
    /// Fails with the name and value of the first bad column.
    pub fn take<'v>(
        &self,
        row: &mut T,
        mut value: impl FnMut(usize, &'static str) -> Value<'v>,
    ) -> Result<(), (&'static str, Value<'v>)> {
        for (number, column) in self.columns().enumerate() {
            let value = value(number, column.name);
            if (column.set)(row, &value).is_none() {
                return Err((column.name, value));
            }
        }
        Ok(())
    }
}

/// What of the street graph to write: its edges, its nodes, or both. A file without one of them is
/// no city to come back to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Streets {
    /// The layer `streets`.
    pub lines: bool,
    /// The layer `intersections`.
    pub intersections: bool,
}

impl Streets {
    /// Both.
    pub const ALL: Self = Self { lines: true, intersections: true };
    /// The intersections alone.
    pub const INTERSECTIONS: Self = Self { lines: false, intersections: true };
}

/// A row of the layer `streets`: an edge of the street graph or an imported way of role other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StreetRow {
    /// Its number, from 1.
    pub id: u32,
    /// Numbers of the intersections at its ends; 0 for a way, which is not part of the graph.
    pub ends: [u32; 2],
    /// What is known of it.
    pub street: Street,
    /// Number in the source, of a way.
    pub way: Option<i64>,
    /// Numbers in the source of a way's points.
    pub nodes: Vec<i64>,
}

/// A row of the layer `intersections`: a node of the street graph. Nodes of degree 2, where a street
/// changes its class or level, are rows of kind `change`, so that every street has both its ends.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IntersectionRow {
    /// Its number, from 1.
    pub id: u32,
    /// Number of street ends there.
    pub degree: usize,
    /// What is known of it.
    pub junction: Junction,
}

impl IntersectionRow {
    /// `end`, `cut`, `change` or `junction`.
    pub fn kind(&self) -> &'static str {
        match self.degree {
            _ if self.junction.cut => "cut",
            0 | 1 => "end",
            2 => "change",
            _ => "junction",
        }
    }
}

/// The row of the layer `target`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TargetRow {
    /// Always 1.
    pub id: u32,
}

/// The names of all layers, in the order of files.
pub const NAMES: [&str; 9] = [
    "streets",
    "intersections",
    "blocks",
    "parcels",
    "buildings",
    "features",
    "water",
    "land_use",
    "target",
];

/// The names of a layer's columns, in order.
pub fn column_names(layer: &str) -> Vec<&'static str> {
    fn names<T>(layer: &Layer<T>) -> Vec<&'static str> {
        layer.columns().map(|column| column.name).collect()
    }
    match layer {
        "streets" => names(&STREETS),
        "intersections" => names(&INTERSECTIONS),
        "blocks" => names(&BLOCKS),
        "parcels" => names(&PARCELS),
        "buildings" => names(&BUILDINGS),
        "features" => names(&FEATURES),
        "water" => names(&WATER),
        "land_use" => names(&LAND_USE),
        _ => names(&TARGET),
    }
}

/// Streets.
pub static STREETS: Layer<StreetRow> = Layer {
    name: "streets",
    geometry: GeometryType::LineString,
    groups: &[STREET, Traced::COLUMNS],
};

const STREET: &[Column<StreetRow>] = &[
    column!("id", Integer, |r| Value::Int(r.id.into()), |r, v| r.id = id(v)?),
    column!("from", Integer, |r| Value::reference(r.ends[0]), |r, v| r.ends[0] = id(v)?),
    column!("to", Integer, |r| Value::reference(r.ends[1]), |r, v| r.ends[1] = id(v)?),
    column!("class", Text, |r| r.street.class.as_str().into(), |r, v| r.street.class =
        v.or(Class::default(), |v| Class::parse(&v.text()?))?),
    column!("role", Text, |r| r.street.role().as_str().into()),
    column!("level", Integer, |r| Value::Int(r.street.level.into()), |r, v| r.street.level =
        v.or(0, Value::integer)?),
    column!("lanes", Integer, |r| Value::Int(r.street.lanes().into()), |r, v| r.street.lanes =
        v.or(0, Value::integer)?),
    column!("width", Real, |r| r.street.width_m().into(), |r, v| r.street.width_m =
        v.or(0.0, Value::real)?),
    // Stands after the columns it speaks of.
    column!("assumed", Text, |r| assumed(&r.street), |r, v| take_assumed(&mut r.street, v)),
    column!("oneway", Flag, |r| Value::Bool(r.street.oneway), |r, v| r.street.oneway = flag(v)?),
    column!("bridge", Flag, |r| Value::Bool(r.street.bridge), |r, v| r.street.bridge = flag(v)?),
    column!("tunnel", Flag, |r| Value::Bool(r.street.tunnel), |r, v| r.street.tunnel = flag(v)?),
    column!("layer", Integer, |r| Value::Int(r.street.layer.into()), |r, v| r.street.layer =
        v.or(0, Value::integer)?),
    column!("junction", Text, |r| roundabout(&r.street), |r, v| r.street.roundabout =
        v.text().is_some_and(|t| t == ROUNDABOUT)),
    column!("name", Text, |r| (&r.street.name).into(), |r, v| r.street.name = v.shared()),
    column!("way", Integer, |r| r.way.map_or(Value::Null, Value::Int), |r, v| r.way =
        v.optional(Value::integer)?),
    column!("nodes", Text, |r| list(&r.nodes), |r, v| r.nodes = read_list(v)?),
];

/// Intersections.
pub static INTERSECTIONS: Layer<IntersectionRow> =
    Layer { name: "intersections", geometry: GeometryType::Point, groups: &[INTERSECTION] };

const INTERSECTION: &[Column<IntersectionRow>] = &[
    column!("id", Integer, |r| Value::Int(r.id.into()), |r, v| r.id = id(v)?),
    column!("kind", Text, |r| r.kind().into()),
    column!("degree", Integer, |r| Value::Int(r.degree as i64)),
    column!("z", Real, |r| r.junction.z_m.into(), |r, v| r.junction.z_m =
        v.or(0.0, Value::real)?),
    column!("cut", Boolean, |r| Value::Bool(r.junction.cut), |r, v| r.junction.cut = flag(v)?),
];

/// Blocks.
pub static BLOCKS: Layer<Block> =
    Layer { name: "blocks", geometry: GeometryType::Polygon, groups: &[BLOCK, Traced::COLUMNS] };

const BLOCK: &[Column<Block>] = &[
    column!("id", Integer, |b| Value::Int(b.id.into()), |b, v| b.id = id(v)?),
    column!("area", Real, |b| b.polygon.area_m2().into()),
    column!("face_area", Real, |b| b.face_area_m2.into(), |b, v| b.face_area_m2 =
        v.or(b.polygon.area_m2(), Value::real)?),
    column!("pavement", Real, |b| b.pavement_m.into(), |b, v| b.pavement_m =
        v.or(exurb_city::block::PAVEMENT_M, Value::real)?),
    column!("land_use", Text, |b| (&b.land_use).into(), |b, v| b.land_use = v.shared()),
    column!("class", Text, |b| block_class(b.class).into(), |b, v| b.class =
        v.or(BlockClass::Block, |v| read_block_class(&v.text()?))?),
    column!("sides", Text, |b| streets(&b.sides), |b, v| b.sides = read_streets(v)?),
    column!("dead_ends", Text, |b| streets(&b.dead_ends), |b, v| b.dead_ends = read_streets(v)?),
];

/// Parcels.
pub static PARCELS: Layer<Parcel> =
    Layer { name: "parcels", geometry: GeometryType::Polygon, groups: &[PARCEL, Traced::COLUMNS] };

const PARCEL: &[Column<Parcel>] = &[
    column!("id", Integer, |p| Value::Int(p.id.into()), |p, v| p.id = id(v)?),
    column!("block", Integer, |p| Value::reference(p.block), |p, v| p.block = id(v)?),
    column!("area", Real, |p| p.polygon.area_m2().into()),
    column!("street_access", Boolean, |p| Value::Bool(p.street_access), |p, v| {
        p.street_access = flag(v)?
    }),
    column!("land_use", Text, |p| (&p.land_use).into(), |p, v| p.land_use = v.shared()),
];

/// Buildings.
pub static BUILDINGS: Layer<Building> = Layer {
    name: "buildings",
    geometry: GeometryType::Polygon,
    groups: &[BUILDING, Traced::COLUMNS],
};

const BUILDING: &[Column<Building>] = &[
    column!("id", Integer, |b| Value::Int(b.id.into()), |b, v| b.id = id(v)?),
    column!("block", Integer, |b| Value::reference(b.block), |b, v| b.block = id(v)?),
    column!("parcel", Integer, |b| Value::reference(b.parcel), |b, v| b.parcel = id(v)?),
    column!("height", Real, |b| b.height_m.into(), |b, v| b.height_m = v.optional(Value::real)?),
    column!("min_height", Real, |b| b.min_height_m.into(), |b, v| b.min_height_m =
        v.or(0.0, Value::real)?),
    column!("levels", Real, |b| b.levels.into(), |b, v| b.levels = v.optional(Value::real)?),
    column!("roof", Text, |b| b.roof.map_or(Value::Null, |r| r.as_str().into()), |b, v| {
        b.roof = v.optional(|v| Roof::parse(&v.text()?))?
    }),
    column!("use", Text, |b| (&b.usage).into(), |b, v| b.usage = v.shared()),
    column!("is_part", Boolean, |b| Value::Bool(b.is_part), |b, v| b.is_part = flag(v)?),
];

/// Trees, lamps and the like.
pub static FEATURES: Layer<Feature> =
    Layer { name: "features", geometry: GeometryType::Any, groups: &[FEATURE, Traced::COLUMNS] };

const FEATURE: &[Column<Feature>] = &[
    column!("id", Integer, |f| Value::Int(f.id.into()), |f, v| f.id = id(v)?),
    column!("kind", Text, |f| (&*f.kind).into(), |f, v| f.kind = v.shared().unwrap_or_default()),
    column!("block", Integer, |f| Value::reference(f.block), |f, v| f.block = id(v)?),
];

/// Water.
pub static WATER: Layer<Area> =
    Layer { name: "water", geometry: GeometryType::Polygon, groups: &[AREA] };

/// Land use.
pub static LAND_USE: Layer<Area> =
    Layer { name: "land_use", geometry: GeometryType::Polygon, groups: &[AREA] };

const AREA: &[Column<Area>] = &[
    column!("id", Integer, |a| Value::Int(a.id.into()), |a, v| a.id = id(v)?),
    column!("class", Text, |a| (&*a.class).into(), |a, v| a.class = v.shared().unwrap_or_default()),
];

/// The modelled area.
pub static TARGET: Layer<TargetRow> = Layer {
    name: "target",
    geometry: GeometryType::Polygon,
    groups: &[&[column!("id", Integer, |t| Value::Int(t.id.into()), |t, v| t.id = id(v)?)]],
};

/// What has a provenance; its three columns stand last.
struct Traced<T>(std::marker::PhantomData<T>);

/// Rows that say where they came from.
pub trait HasProvenance {
    /// Where it came from.
    fn provenance(&self) -> &Provenance;
    /// Where it came from, to change.
    fn provenance_mut(&mut self) -> &mut Provenance;
}

impl<T: HasProvenance + 'static> Traced<T> {
    const COLUMNS: &'static [Column<T>] = &[
        column!("origin", Text, |r| r.provenance().origin.as_str().into(), |r, v| {
            r.provenance_mut().origin = v.or(Origin::Imported, |v| Origin::parse(&v.text()?))?
        }),
        column!("source", Text, |r| (&r.provenance().source).into(), |r, v| {
            r.provenance_mut().source = v.shared()
        }),
        column!("part", Text, |r| (&r.provenance().part).into(), |r, v| {
            r.provenance_mut().part = v.shared()
        }),
    ];
}

macro_rules! has_provenance {
    ($($row:ty: $($field:ident).+),*) => {
        $(impl HasProvenance for $row {
            fn provenance(&self) -> &Provenance {
                &self.$($field).+
            }
            fn provenance_mut(&mut self) -> &mut Provenance {
                &mut self.$($field).+
            }
        })*
    };
}
has_provenance!(
    StreetRow: street.provenance,
    Block: provenance,
    Parcel: provenance,
    Building: provenance,
    Feature: provenance
);

const ROUNDABOUT: &str = "roundabout";

fn roundabout(street: &Street) -> Value<'static> {
    if street.roundabout { ROUNDABOUT.into() } else { Value::Null }
}

/// Which of lanes and width are defaults of the class and no data.
fn assumed(street: &Street) -> Value<'static> {
    match (street.lanes == 0, street.width_m <= 0.0) {
        (false, false) => Value::Null,
        (true, false) => "lanes".into(),
        (false, true) => "width".into(),
        (true, true) => "lanes width".into(),
    }
}

fn take_assumed(street: &mut Street, value: &Value<'_>) -> Option<()> {
    for word in value.text().unwrap_or_default().split_whitespace() {
        match word {
            "lanes" => street.lanes = 0,
            "width" => street.width_m = 0.0,
            _ => return None,
        }
    }
    Some(())
}

fn block_class(class: BlockClass) -> &'static str {
    match class {
        BlockClass::Block => "block",
        BlockClass::Island => "island",
    }
}

fn read_block_class(name: &str) -> Option<BlockClass> {
    [BlockClass::Block, BlockClass::Island].into_iter().find(|c| block_class(*c) == name)
}

fn id(value: &Value<'_>) -> Option<u32> {
    value.or(0, Value::integer)
}

fn flag(value: &Value<'_>) -> Option<bool> {
    value.or(false, Value::flag)
}

/// Numbers with spaces between; nothing for none.
fn list<I: ToString>(numbers: impl IntoIterator<Item = I>) -> Value<'static> {
    let words: Vec<String> = numbers.into_iter().map(|n| n.to_string()).collect();
    if words.is_empty() { Value::Null } else { words.join(" ").into() }
}

fn read_list<I: std::str::FromStr>(value: &Value<'_>) -> Option<Vec<I>> {
    value.text().unwrap_or_default().split_whitespace().map(|word| word.parse().ok()).collect()
}

/// Streets are numbered from 1 in files.
fn streets(edges: &[EdgeId]) -> Value<'static> {
    list(edges.iter().map(|e| u64::from(e.0) + 1))
}

fn read_streets(value: &Value<'_>) -> Option<Vec<EdgeId>> {
    let numbers: Vec<u32> = read_list(value)?;
    numbers.into_iter().map(|n| n.checked_sub(1).map(EdgeId)).collect()
}

/// The rows of `streets` of a numbered city: the edges of its graph, then its other ways.
pub fn street_rows(city: &City) -> impl Iterator<Item = (StreetRow, Shape<'_>)> {
    let edges = city.streets.edges().map(|(_, edge)| {
        let ends = [edge.from.0 + 1, edge.to.0 + 1];
        let row = StreetRow { ends, street: edge.data.clone(), ..StreetRow::default() };
        (row, Shape::Line(edge.line()))
    });
    let ways = city.other_ways.iter().map(|way| {
        let (id, nodes) = (Some(way.id), way.nodes.clone());
        let row = StreetRow { street: way.street.clone(), way: id, nodes, ..StreetRow::default() };
        (row, Shape::Line(&way.line))
    });
    edges.chain(ways).zip(1..).map(|((row, shape), id)| (StreetRow { id, ..row }, shape))
}

/// The rows of `intersections` of a numbered city.
pub fn intersection_rows(city: &City) -> impl Iterator<Item = (IntersectionRow, Shape<'_>)> {
    city.streets.nodes().zip(1..).map(|((node_id, node), id)| {
        let degree = city.streets.degree(node_id);
        let row = IntersectionRow { id, degree, junction: node.data.clone() };
        (row, Shape::Point(node.at))
    })
}
