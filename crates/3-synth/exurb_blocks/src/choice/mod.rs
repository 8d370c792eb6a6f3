//! Which example block fills which block: candidates by shape, tried out, and chosen together.
//!
//! Steps: 1 blocks on open land stay open; a block that lies in an example as it is takes its own layout;
//! 2 parks, schools and shops are drawn ([`kinds`]); 3 density and height follow a smooth field
//! ([`field`]), brought to the example's coverage in all ([`level`]); 4 every block asks the database for
//! like blocks and tries the best out ([`candidate`]); 5 blocks choose together, so that neighbours look
//! alike as the example's do ([`joint`], [`descriptor`]) and what is built adds up to the example's
//! coverage; 6 where it does not yet, blocks with room are filled up ([`together`]).

mod candidate;
pub mod descriptor;
pub mod field;
pub mod joint;
pub mod kinds;
mod learned;
mod level;
mod options;
mod style;
mod together;

use exurb_city::{Block, City, Terrain};
use exurb_geom::{BoxGrid, Polygon, overlap};
use exurb_match::{Attributes, Match, Query};
use exurb_operation::{Failure, Run, rng};
use rayon::prelude::*;

pub use candidate::{Candidate, Site, Way};
pub use learned::Learned;
pub use options::Choosing;
pub use style::Styles;

use crate::database::{Layout, relief_m};
use crate::fill::Limits;
use crate::library::{OpenLand, Surroundings};
use crate::neighbours::{MainStreets, neighbours};
use crate::retarget::Settings;
use field::Place;
use kinds::{Kind, Situation};
use level::Expected;
use together::Together;

/// Ways a layout may be laid.
#[derive(Clone, Debug)]
pub struct Ways {
    /// Moved as a whole.
    pub transfer: bool,
    /// Laid out anew.
    pub retarget: bool,
    /// Outlines that lie nearer than this, root mean square, are like enough to move a layout as a
    /// whole, in metres.
    pub deviation_m: f64,
    /// How layouts are laid out anew.
    pub settings: Settings,
    /// When a layout does not suit a block.
    pub limits: Limits,
}

/// What was chosen for a block.
#[derive(Clone, Debug)]
pub enum Choice {
    /// It is not to be filled.
    None,
    /// It stays open land of this class.
    Open(std::sync::Arc<str>),
    /// Candidates, the chosen one first.
    Filled(Vec<Candidate>),
}

/// Chooses for every block that `wanted` names. The order of choices is that of `blocks`.
pub fn choose(
    city: &City,
    blocks: &[Block],
    wanted: &[bool],
    learned: &Learned,
    choosing: &Choosing,
    ways: &Ways,
    run: &Run,
) -> Result<Vec<Choice>, Failure> {
    let styles = Styles::of(
        &choosing.style_map,
        &choosing.style_legend,
        city.target.bounds(),
        &learned.sources(),
    );
    let styles =
        styles.map_err(|message| Failure::Params { operation: "blocks".into(), message })?;
    let serving = |block: &Block| styles.at(block.polygon.interior_point());
    let open = OpenLand::of(city);
    let standing = Standing::of(city, blocks, wanted);
    let site = |i: usize| {
        let within = || standing.within(&blocks[i].polygon);
        wanted[i].then(|| Site::of(&blocks[i], within(), &city.streets))
    };
    let mut sites: Vec<Option<Site<'_>>> = (0..blocks.len()).into_par_iter().map(site).collect();
    run.check()?;
    let same: Vec<Option<Match>> =
        sites.par_iter().map(|site| same(site.as_ref()?, learned, serving)).collect();
    // A block that lies in an example as it is takes after it, park or not.
    let given = |(block, same): (&Block, &Option<Match>)| {
        if same.is_none() { open.keeps_open(&block.polygon) } else { None }
    };
    let given: Vec<Option<std::sync::Arc<str>>> = blocks.par_iter().zip(&same).map(given).collect();
    for (site, given) in sites.iter_mut().zip(&given) {
        if given.is_some() {
            *site = None;
        }
    }
    run.check()?;
    let around = Around::of(city, blocks, wanted);
    let kinds = around.kinds(&sites, &given, &same, learned, choosing, run);
    let mut field = field::field(&around.places, &learned.samples, learned.spread.coherence);
    let expected = |i: usize| {
        let free = sites[i].is_some() && same[i].is_none();
        let area_m2 = blocks[i].polygon.area_m2();
        let usual = learned.coverage_of(&kinds[i]);
        let coverage = if kinds[i].is_none() { field.coverage[i] } else { usual };
        free.then_some(Expected { area_m2, coverage, is_ordinary: kinds[i].is_none() })
    };
    let mut expected: Vec<Option<Expected>> = (0..blocks.len()).map(expected).collect();
    let mut free: Vec<Expected> = expected.iter().flatten().copied().collect();
    if choosing.coverage > 0.0 {
        level::likened(&mut free, learned.coverage);
        expected.iter_mut().flatten().zip(&free).for_each(|(block, likened)| *block = *likened);
    }
    let total_m2 = level::total_m2(&free, learned.coverage, choosing.coverage);
    let factor = level::factor(&free, total_m2);
    for (coverage, expected) in field.coverage.iter_mut().zip(&expected) {
        *coverage = expected.map_or(*coverage, |e| level::raised(&e, factor));
    }
    let tried: Vec<Result<Vec<Candidate>, Failure>> = (0..blocks.len())
        .into_par_iter()
        .map(|i| {
            run.check()?;
            let Some(site) = &sites[i] else { return Ok(Vec::new()) };
            let near = open.near(&site.block.polygon);
            let found = match &same[i] {
                Some(same) => vec![same.clone()],
                None => asked(
                    site,
                    &kinds[i],
                    (field.coverage[i], field.height_m[i]),
                    learned,
                    choosing,
                    (serving(site.block), city.terrain.as_deref()),
                ),
            };
            let tries = found.iter().take(choosing.tries.max(choosing.alternatives) as usize);
            Ok(tries.map(|m| candidate::tried(site, m, learned, choosing, ways, &near)).collect())
        })
        .collect();
    let mut tried: Vec<Vec<Candidate>> = tried.into_iter().collect::<Result<_, _>>()?;
    run.check()?;
    let together = Together {
        blocks,
        expected: &expected,
        wishes: &field.coverage,
        total_m2,
        learned,
        choosing,
        limits: ways.limits,
    };
    let chosen = together.chosen(&tried, &around.places, run);
    together.fill_up(&mut tried, &chosen, &sites, &open);
    Ok(tried
        .into_iter()
        .zip(chosen)
        .zip(given)
        .zip(wanted)
        .map(|(((mut tried, ranked), given), wanted)| match given {
            _ if !wanted => Choice::None,
            Some(class) => Choice::Open(class),
            None => {
                let mut slots: Vec<Option<Candidate>> = tried.drain(..).map(Some).collect();
                Choice::Filled(ranked.into_iter().filter_map(|k| slots[k].take()).collect())
            }
        })
        .collect())
}

/// Buildings that stay as they are: in no block, or in blocks that are not filled.
struct Standing<'a> {
    polygons: Vec<&'a Polygon>,
    boxes: BoxGrid,
}

impl<'a> Standing<'a> {
    fn of(city: &'a City, blocks: &[Block], wanted: &[bool]) -> Self {
        let filled = blocks.iter().zip(wanted).filter(|(_, wanted)| **wanted).map(|(b, _)| b.id);
        let filled: std::collections::BTreeSet<u32> = filled.collect();
        let stays = city.buildings.iter().filter(|b| !b.is_part && !filled.contains(&b.block));
        let polygons: Vec<&Polygon> = stays.map(|b| &b.polygon).collect();
        let boxes = BoxGrid::of(polygons.iter().copied());
        Self { polygons, boxes }
    }

    /// Those that reach into a block.
    fn within(&self, block: &Polygon) -> Vec<Polygon> {
        let mut near = Vec::new();
        self.boxes.meeting_polygon(block, &mut near);
        let found = near.iter().map(|i| self.polygons[*i as usize]);
        found.filter(|p| overlap::shared_m2(p, block, 0.1) > 0.1).cloned().collect()
    }
}

/// The layout of the very block, unless another example is to serve there.
fn same<'a>(
    site: &Site<'_>,
    learned: &Learned,
    serving: impl Fn(&Block) -> Option<&'a str>,
) -> Option<Match> {
    let found = learned.same(site)?;
    let source = &*learned.database.layouts[found.entry as usize].source;
    serving(site.block).is_none_or(|name| name == source).then_some(found)
}

/// Layouts built on by less than this share of what is wished for are not asked for: where the example has
/// no blocks of a size, next to empty ones would be the likest.
const LEAST_OF_WISH: f64 = 0.3;

/// Like blocks for a site, best first.
fn asked(
    site: &Site<'_>,
    kind: &Kind,
    (coverage, height_m): (f64, Option<f64>),
    learned: &Learned,
    choosing: &Choosing,
    (serving, terrain): (Option<&str>, Option<&Terrain>),
) -> Vec<Match> {
    let attributes = Attributes {
        density: kind.is_none().then_some(coverage),
        height_m: height_m.filter(|_| kind.is_none()),
        land_use: site.block.land_use.clone(),
        relief_m: terrain.and_then(|t| relief_m(t, site.outline.points())),
    };
    let query = Query {
        weights: choosing.weights(),
        candidates: choosing.candidates as usize,
        mirrored: choosing.mirrored,
        ..Query::new(&site.outline, &attributes)
    };
    let serves = |l: &Layout| serving.is_none_or(|name| name == &*l.source);
    let is_built = |l: &Layout| kind.is_some() || l.coverage >= coverage * LEAST_OF_WISH;
    let of_kind = learned.database.query(&query, |l| l.kind == *kind && serves(l) && is_built(l));
    if of_kind.is_empty() { learned.database.query(&query, serves) } else { of_kind }
}

/// What lies around blocks.
struct Around {
    situations: Vec<Situation>,
    places: Vec<Place>,
}

impl Around {
    fn of(city: &City, blocks: &[Block], wanted: &[bool]) -> Self {
        let surroundings = Surroundings::of(blocks);
        let main = MainStreets::of(&city.streets);
        let situations: Vec<Situation> = blocks
            .par_iter()
            .map(|block| {
                let at = block.polygon.centroid();
                let features = surroundings.features(block, &city.streets);
                Situation { features, main_m: main.distance_m(at), at }
            })
            .collect();
        let given = learned::built(city, blocks);
        let places = neighbours(blocks)
            .into_iter()
            .enumerate()
            .map(|(i, neighbours)| Place {
                features: situations[i].features,
                neighbours,
                given: given[i].filter(|_| !wanted[i]),
            })
            .collect();
        Self { situations, places }
    }

    /// The kind of each block: of those that lie in an example their own, of the others as drawn.
    fn kinds(
        &self,
        sites: &[Option<Site<'_>>],
        given: &[Option<std::sync::Arc<str>>],
        same: &[Option<Match>],
        learned: &Learned,
        choosing: &Choosing,
        run: &Run,
    ) -> Vec<Kind> {
        let kind_of = |m: &Match| learned.database.layouts[m.entry as usize].kind.clone();
        let known = |i: usize| -> Option<Kind> {
            match (&same[i], &given[i], &sites[i]) {
                (Some(same), ..) => Some(kind_of(same)),
                (None, Some(class), _) => Some(Some(class.clone())),
                (None, None, None) => Some(None),
                _ if !choosing.kinds => Some(None),
                _ => None,
            }
        };
        let known: Vec<Option<Kind>> = (0..sites.len()).map(known).collect();
        kinds::draw(
            &self.situations,
            &known,
            &learned.situations,
            &mut run.stream(rng::fnv1a(b"kinds")),
        )
    }
}
