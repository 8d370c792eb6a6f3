use std::collections::BTreeMap;
use std::sync::Arc;

use exurb_city::{BlockClass, City, FeatureShape, area, block};
use exurb_geom::{BoxGrid, GridPoint, PointIndex, Vec2, polyline};
use exurb_operation::{Example, Failure, Run};

/// A row of things along a street.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Row {
    /// Usual distance from one to the next in metres.
    pub spacing_m: f64,
    /// Share of streets that have them.
    pub street_share: f64,
}

/// How streets and parks are furnished.
#[derive(Clone, Debug, PartialEq)]
pub struct Learned {
    /// Trees along streets.
    pub trees: Row,
    /// Lamps along streets.
    pub lamps: Row,
    /// Trees by m² of open land, by class.
    pub park_trees: BTreeMap<Arc<str>, f64>,
    /// Name of the example, where it told something.
    pub source: Option<Arc<str>>,
}

/// Trees and lamps alternate every 31·U(0.4, 0.6) m in the authors' program.
const DEFAULT_SPACING_M: f64 = 31.0;
/// Things this near to the kerb stand along the street, in metres.
const AT_KERB_M: f64 = 5.0;
/// Fewer things than this are what a mapper happened to note.
const ENOUGH: usize = 30;
/// Sparser than this along the kerb they are not mapped, but noted, in 1/m.
const LEAST_RATE: f64 = 1.0 / 250.0;
/// A tree row that is drawn as a line has a tree about every so many metres.
const TREE_ROW_STEP_M: f64 = 9.0;

/// Trees by m² of open land where the example does not tell; those of parks as in the authors'
/// program, others by the look of aerial images.
const PARK_TREES: [(&str, f64); 12] = [
    ("park", 0.002),
    ("garden", 0.003),
    ("forest", 0.012),
    ("wood", 0.012),
    ("cemetery", 0.003),
    ("orchard", 0.01),
    ("scrub", 0.003),
    ("village_green", 0.002),
    ("recreation_ground", 0.001),
    ("golf_course", 0.001),
    ("allotments", 0.002),
    ("grass", 0.0005),
];

/// Learns how densely streets and open land are furnished. O(features · blocks nearby).
pub fn learn(examples: &[Example], run: &Run) -> Result<Learned, Failure> {
    let (mut trees, mut lamps) = (Standing::default(), Standing::default());
    let mut kerb_m = 0.0;
    let mut open: BTreeMap<Arc<str>, (f64, f64)> = BTreeMap::new();
    for example in examples {
        run.check()?;
        let city = &*example.city;
        let points_of = |kind: &str| points(city, kind);
        let tree_points = points_of("tree");
        kerb_m += along_kerb(city, &tree_points, &mut trees);
        along_kerb(city, &points_of("lamp"), &mut lamps);
        in_open_land(city, &tree_points, &mut open);
    }
    let rows = (trees.row(kerb_m), lamps.row(kerb_m));
    if rows.0.is_none() && rows.1.is_none() {
        run.warn(
            "the example has too few trees and lamps to learn from; every 31 m stands one of each",
        );
    }
    let unknown = Row { spacing_m: DEFAULT_SPACING_M, street_share: 1.0 };
    let mut park_trees: BTreeMap<Arc<str>, f64> =
        PARK_TREES.iter().map(|(class, density)| ((*class).into(), *density)).collect();
    for (class, (count, area)) in open {
        let least = park_trees.get(&class).copied().unwrap_or(0.0005) / 4.0;
        if count >= ENOUGH as f64 && count / area > least {
            park_trees.insert(class, count / area);
        }
    }
    let source = examples.first().map(|e| e.city.metadata.name.clone());
    Ok(Learned {
        trees: rows.0.unwrap_or(unknown),
        lamps: rows.1.unwrap_or(unknown),
        park_trees,
        source: source.filter(|_| rows.0.is_some() || rows.1.is_some()),
    })
}

/// Things along the kerb and how far each is from the next.
#[derive(Default)]
struct Standing {
    nearest_m: Vec<f64>,
}

impl Standing {
    fn row(mut self, kerb_m: f64) -> Option<Row> {
        let count = self.nearest_m.len();
        let rate = count as f64 / kerb_m.max(1.0);
        if count < ENOUGH || rate < LEAST_RATE {
            return None;
        }
        self.nearest_m.sort_by(f64::total_cmp);
        let spacing_m = self.nearest_m[count / 2].clamp(5.0, 60.0);
        Some(Row { spacing_m, street_share: (rate * spacing_m).min(1.0) })
    }
}

/// Where features of a kind stand; rows drawn as lines at every step.
fn points(city: &City, kind: &str) -> Vec<Vec2> {
    let row = format!("{kind}_row");
    let mut out = Vec::new();
    for feature in city.features.iter() {
        match &feature.shape {
            FeatureShape::Point(p) if &*feature.kind == kind => out.push(p.to_m()),
            FeatureShape::Line(line) if *feature.kind == *row => {
                out.extend(polyline::resample(&polyline::to_m(line), TREE_ROW_STEP_M));
            }
            _ => {}
        }
    }
    out
}

/// Adds the points near a kerb; gives the length of all kerbs in metres.
fn along_kerb(city: &City, points: &[Vec2], standing: &mut Standing) -> f64 {
    let derived;
    let blocks = if city.blocks.is_empty() {
        derived = block::derive(&city.streets);
        &derived
    } else {
        &*city.blocks
    };
    let boxes = BoxGrid::of(blocks.iter().map(|b| &b.polygon));
    let mut near = Vec::new();
    let mut index = PointIndex::new(30.0);
    let mut at_kerb = Vec::new();
    for p in points {
        let at = GridPoint::round(*p);
        boxes.meeting(at, at, &mut near);
        let held = near.iter().any(|n| {
            let polygon = &blocks[*n as usize].polygon;
            polygon.contains(at) && polygon.boundary_distance_m(*p) < AT_KERB_M
        });
        if held {
            index.insert(at_kerb.len() as u32, *p);
            at_kerb.push(*p);
        }
    }
    for (i, p) in at_kerb.iter().enumerate() {
        let other = index.within(*p, 60.0).into_iter().find(|(n, d)| *n as usize != i && *d > 0.5);
        standing.nearest_m.push(other.map_or(60.0, |(_, d)| d));
    }
    let usual = blocks.iter().filter(|b| b.class == BlockClass::Block);
    usual.map(|b| b.polygon.perimeter_m()).sum()
}

/// Adds number of trees and area of open land, by class.
fn in_open_land(city: &City, trees: &[Vec2], open: &mut BTreeMap<Arc<str>, (f64, f64)>) {
    let areas: Vec<_> = city.land_use.iter().filter(|a| area::is_open(&a.class)).collect();
    let boxes = BoxGrid::of(areas.iter().map(|a| &a.polygon));
    for area in &areas {
        open.entry(area.class.clone()).or_default().1 += area.polygon.area_m2();
    }
    let mut near = Vec::new();
    for p in trees {
        let at = GridPoint::round(*p);
        boxes.meeting(at, at, &mut near);
        // The last area lies on top, as it is drawn.
        let home = near.iter().rev().find(|n| areas[**n as usize].polygon.contains(at));
        if let Some(home) = home {
            open.entry(areas[*home as usize].class.clone()).or_default().0 += 1.0;
        }
    }
}
