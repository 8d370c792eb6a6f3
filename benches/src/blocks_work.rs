//! What the bench of blocks measures inside one process.

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use exurb_blocks::Spacing;
use exurb_blocks::database::BlockDatabase;
use exurb_blocks::library::OpenLand;
use exurb_blocks::parcels::{Method, Params, Parcels};
use exurb_blocks::retarget::{Editor, Settings};
use exurb_city::City;
use exurb_geom::{GridPoint, MeanValueMap, Polygon, Vec2, trig};
use exurb_match::{
    Attributes, Contexts, Database, Entry, Outline, Query, outer_radius_m, time_warp,
};
use exurb_operation::{Example, Run, Scope, erase};
use serde_json::{Value, json};

type Outcome = Result<Value, Box<dyn Error>>;

/// The best of so many runs, in seconds.
fn best(runs: usize, mut work: impl FnMut()) -> f64 {
    let timed = (0..runs).map(|_| {
        let started = Instant::now();
        work();
        started.elapsed().as_secs_f64()
    });
    timed.fold(f64::INFINITY, f64::min)
}

/// One call of the editor on the block whose number of footprints is nearest to 40, widened by a tenth.
pub fn retarget(city: &City) -> Outcome {
    let layouts =
        (0..city.blocks.len()).filter_map(|i| BlockDatabase::layout_of(city, &city.blocks, i));
    let layout = layouts.min_by_key(|l| l.footprints.len().abs_diff(40)).ok_or("no blocks")?;
    let settings = Settings::default();
    let spacing = Spacing { pavement_m: 2.0, tolerance: 0.1, cut: settings.cut };
    let editor = Editor::of(&layout, &settings, spacing);
    let middle = layout.kerb.centroid();
    let wider = |p: Vec2| middle + (p - middle) * Vec2::new(1.1, 1.0);
    let outline = layout.kerb.map(wider).ok_or("no outline")?;
    let open = OpenLand::of(city);
    let mut placed = 0;
    let seconds = best(20, || placed = editor.laid(&outline, &open).buildings.len());
    Ok(json!({ "seconds": seconds, "footprints": layout.footprints.len(), "placed": placed }))
}

/// Blocks that queries go against: Hartmann 2018, section 5.1.6, has about as many.
const QUERIED: usize = 13_500;

/// Queries against blocks of all maps together.
pub fn query(cities: &[City]) -> Outcome {
    let all: Vec<_> = cities.iter().flat_map(|c| c.blocks.iter()).collect();
    let each = all.len().div_ceil(QUERIED).max(1);
    let used = all.iter().step_by(each).map(|b| Outline::of(b.polygon.exterior()));
    let outlines: Vec<Outline> = used.collect();
    let asked: Vec<Outline> = outlines.iter().step_by(outlines.len() / 100 + 1).cloned().collect();
    let entry = |outline| Entry { outline, attributes: Attributes::default() };
    let count = outlines.len();
    let database = Database::new(outlines.into_iter().map(entry).collect());
    let attributes = Attributes::default();
    let mut found = 0;
    let seconds = best(3, || {
        found = 0;
        for outline in &asked {
            found += database.query(&Query::new(outline, &attributes), |_| true).len();
        }
    });
    Ok(json!({ "seconds": seconds / asked.len() as f64, "blocks": count, "found": found }))
}

/// Shape contexts with their costs, time warps and mean value maps of the outlines that are written to
/// `file` for the yardstick.
pub fn outlines(file: &Path) -> Outcome {
    let star = |k: u32| -> Vec<GridPoint> {
        let radius = |i: u32| 40.0 + 25.0 * trig::sin(f64::from(i * (k + 2)) * 0.7 + f64::from(k));
        let corner = |i: u32| trig::unit(f64::from(i) * std::f64::consts::TAU / 24.0) * radius(i);
        (0..24).map(|i| GridPoint::round(corner(i))).collect()
    };
    let rings: Vec<Vec<GridPoint>> = (0..10).map(star).collect();
    let metres = |ring: &Vec<GridPoint>| ring.iter().map(|p| p.to_m()).collect::<Vec<Vec2>>();
    let all: Vec<Outline> = rings.iter().map(|r| Outline::of(r)).collect();
    let radius = outer_radius_m(&all[0]);
    let own = Contexts::of(&all[0], radius);
    let contexts = best(5, || {
        for outline in &all {
            std::hint::black_box(own.costs(&Contexts::of(outline, radius)));
        }
    });
    let costs: Vec<_> = all.iter().map(|o| own.costs(&Contexts::of(o, radius))).collect();
    let mut sum = 0.0;
    let warps = best(5, || sum = costs.iter().map(|c| time_warp::cyclic(c).cost).sum());
    let map = MeanValueMap::new(metres(&rings[0]), metres(&rings[1])).ok_or("no map")?;
    let points: Vec<Vec2> = (0..10_000)
        .map(|i| trig::unit(f64::from(i) * 2.4) * (f64::from(i) / 10_000.0) * 30.0)
        .collect();
    let mean_value = best(5, || {
        std::hint::black_box(points.iter().map(|p| map.apply(*p)).sum::<Vec2>());
    });
    let pairs = |points: &[Vec2]| points.iter().map(|p| [p.x, p.y]).collect::<Vec<[f64; 2]>>();
    let document = json!({
        "outlines": all.iter().map(|o| pairs(o.points())).collect::<Vec<_>>(),
        "radius": radius,
        "from": pairs(&metres(&rings[0])),
        "to": pairs(&metres(&rings[1])),
        "points": pairs(&points),
    });
    std::fs::write(file, document.to_string())?;
    Ok(json!({ "contexts": contexts, "warps": warps, "mean_value": mean_value, "cost": sum }))
}

/// Parcels around the footprints of a map; blocks and footprints as rings for the yardstick.
pub fn cadastre(city: &City, file: &Path) -> Outcome {
    let ring = |p: &Polygon| -> Vec<[f64; 2]> {
        p.exterior().iter().map(|q| [q.to_m().x, q.to_m().y]).collect()
    };
    let whole = city.buildings.iter().filter(|b| !b.is_part && b.block != 0);
    let footprints: Vec<_> = whole.map(|b| ring(&b.polygon)).collect();
    let blocks: Vec<_> = city.blocks.iter().map(|b| ring(&b.polygon)).collect();
    let count = footprints.len();
    std::fs::write(file, json!({ "footprints": footprints, "blocks": blocks }).to_string())?;
    let params = serde_json::to_value(Params { method: Method::Footprints, ..Params::default() })?;
    let examples = [Example::new(city.clone())];
    let operation = erase::<Parcels>();
    let mut parcels = 0;
    let mut failed = None;
    let seconds = best(3, || {
        match operation.run(city, &Scope::All, &examples, params.clone(), &Run::new(1)) {
            Ok(made) => parcels = made.city.parcels.len(),
            Err(e) => failed = Some(e),
        }
    });
    match failed {
        Some(error) => Err(error.into()),
        None => Ok(json!({ "seconds": seconds, "footprints": count, "parcels": parcels })),
    }
}
