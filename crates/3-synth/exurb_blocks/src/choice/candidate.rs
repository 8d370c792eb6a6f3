//! One example block tried in one block.

use exurb_city::{Block, Building, Class, StreetGraph};
use exurb_geom::{GridPoint, Polygon, Rigid, offset, polyline};
use exurb_match::{Match, Outline, align};

use super::descriptor::Descriptor;
use super::{Choosing, Learned, Ways};
use crate::database::Layout;
use crate::infill::{Room, add_free, infill};
use crate::kerb::Kerb;
use crate::lay::{Laid, Spacing, lay};
use crate::library::OpenNearby;
use crate::refine::Ground;
use crate::retarget::{Correspondence, source_of, wishes};
use crate::ring::Ring;

/// How a layout came into a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Way {
    /// Moved as a whole.
    Transferred,
    /// Laid out anew.
    Retargeted,
}

/// A layout in a block.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Index of the layout.
    pub entry: u32,
    /// How unlike the blocks are.
    pub cost: f64,
    /// How it was laid.
    pub way: Way,
    /// The rigid motion that lays it on the block.
    pub motion: Rigid,
    /// What came of it.
    pub laid: Laid,
    /// Its looks there.
    pub looks: Descriptor,
    /// Built area by what the layout would cover of the block, at most 1.
    pub kept: f64,
    /// Does the block lie in the example as it is?
    pub is_same: bool,
}

/// A block as layouts are tried in it.
pub struct Site<'a> {
    /// The block.
    pub block: &'a Block,
    /// Its outline without small notches.
    pub ring: Vec<GridPoint>,
    /// The same in samples.
    pub outline: Outline,
    /// Its kerb.
    pub kerb: Kerb,
    /// What reaches into it and stays.
    pub standing: Vec<Polygon>,
    /// Ends of pedestrian streets in it, which its outline leaves out for the doors that a map has there.
    pub ends: Vec<Polygon>,
}

impl<'a> Site<'a> {
    /// The site of a block with what stays standing in it.
    pub fn of(block: &'a Block, standing: Vec<Polygon>, streets: &StreetGraph) -> Self {
        let ring = crate::outline::plain_outline(&block.polygon);
        let outline = Outline::of(&ring);
        Self {
            block,
            ring,
            outline,
            kerb: Kerb::of(&block.polygon),
            standing,
            ends: ends_in(block, streets),
        }
    }

    /// What stands in the block, for its own layout or for another.
    fn standing(&self, is_same: bool) -> Vec<Polygon> {
        let ends = self.ends.iter().filter(|_| !is_same);
        self.standing.iter().chain(ends).cloned().collect()
    }

    fn ground<'g>(&'g self, standing: &'g [Polygon], at_home: bool) -> Ground<'g> {
        Ground { block: &self.block.polygon, kerb: &self.kerb, standing, at_home }
    }

    fn looks(&self, laid: &Laid) -> Descriptor {
        let footprints = laid.buildings.iter().filter(|b| !b.is_part).map(|b| &b.polygon);
        Descriptor::of(&self.block.polygon, &self.kerb, footprints)
    }
}

/// The last metres of the block's pedestrian dead ends, as long as the street is wide.
fn ends_in(block: &Block, streets: &StreetGraph) -> Vec<Polygon> {
    let mut out = Vec::new();
    for id in &block.dead_ends {
        let Some(edge) = streets.get_edge(*id).filter(|e| e.data.class == Class::Pedestrian) else {
            continue;
        };
        let (mut line, half_m) = (edge.line_m(), edge.data.width_m() / 2.0);
        for end in [edge.from, edge.to] {
            if streets.degree(end) == 1 {
                let tip = polyline::part(&line, 0.0, half_m);
                out.extend(offset::carriageway(&tip, half_m, offset::Cap::Butt));
            }
            line.reverse();
        }
    }
    out
}

/// Outlines that lie this near to each other, root mean square, are the same, in metres.
const SAME_M: f64 = 0.002;

/// Shifts that make up a layout's size, where every candidate is filled up and where the chosen one is.
const COARSE: u32 = 2;
const FINE: u32 = 4;
/// Buildings are added that are larger than this share of their layout's; where these do not suffice,
/// smaller ones, too.
pub const USUAL: f64 = 0.5;
pub const SMALL: f64 = 0.25;
pub const ANY: f64 = 0.0;

/// Tries the layout of a match.
pub fn tried(
    site: &Site<'_>,
    found: &Match,
    learned: &Learned,
    choosing: &Choosing,
    ways: &Ways,
    open: &OpenNearby<'_>,
) -> Candidate {
    let layout = &learned.database.layouts[found.entry as usize];
    let outline = learned.database.outline(found.entry);
    let motion = align::refine(found.motion, outline, &site.ring);
    let deviation_m = align::deviation_m(&motion, outline, &site.ring);
    let is_same = deviation_m < SAME_M && found.shape_cost < 0.05;
    let standing = site.standing(is_same);
    let ground = site.ground(&standing, is_same);
    let spacing = choosing.spacing();
    let transferred = || {
        let (footprints, things) = layout.wished(motion.into());
        lay(layout, &footprints, &things, &ground, open, spacing)
    };
    let anew = || retargeted(site, found, layout, ways, &ground, open, spacing);
    let kept = |laid: &Laid| {
        let wanted_m2 = layout.coverage * site.block.polygon.area_m2();
        if wanted_m2 > 0.0 { (laid.built_m2() / wanted_m2).min(1.0) } else { 1.0 }
    };
    let as_whole = !ways.retarget
        || (ways.transfer && (is_same || deviation_m <= ways.deviation_m || layout.open.is_some()))
        || layout.footprints.is_empty();
    let (way, mut laid) =
        if as_whole { (Way::Transferred, transferred()) } else { (Way::Retargeted, anew()) };
    // A layout that lost too much is made good before it is given up.
    for least in [USUAL, ANY] {
        if !is_same && kept(&laid) < ways.limits.least_kept {
            let goal_m2 = layout.coverage * site.block.polygon.area_m2();
            let room = Room { ground: &ground, open, spacing, goal_m2, shifts: COARSE, least };
            infill(&mut laid, layout, &motion, &room);
        }
    }
    let looks = site.looks(&laid);
    let kept = kept(&laid);
    Candidate { entry: found.entry, cost: found.cost, way, motion, laid, looks, kept, is_same }
}

/// Builds the block of the candidate `first` on up to `goal_m2`, as far as there is room, with buildings
/// of the other candidates where they lie, then with more of its layout and of theirs; none smaller than
/// the quantile `least` of their sizes.
pub fn filled_up(
    site: &Site<'_>,
    tried: &mut [Candidate],
    first: usize,
    learned: &Learned,
    choosing: &Choosing,
    open: &OpenNearby<'_>,
    (goal_m2, least): (f64, f64),
) {
    let is_same = tried[first].is_same;
    let standing = site.standing(is_same);
    let ground = site.ground(&standing, is_same);
    let spacing = choosing.spacing();
    let room = Room { ground: &ground, open, spacing, goal_m2, shifts: FINE, least };
    let others = (0..tried.len()).filter(|k| *k != first);
    let sources: Vec<(u32, Rigid)> =
        std::iter::once(first).chain(others).map(|k| (tried[k].entry, tried[k].motion)).collect();
    let laid: Vec<Building> = (0..tried.len())
        .filter(|k| *k != first)
        .flat_map(|k| tried[k].laid.buildings.iter().cloned())
        .collect();
    let chosen = &mut tried[first];
    add_free(&mut chosen.laid, &laid, goal_m2, least);
    for (entry, motion) in sources {
        let layout = &learned.database.layouts[entry as usize];
        infill(&mut chosen.laid, layout, &motion, &room);
    }
    chosen.looks = site.looks(&chosen.laid);
}

fn retargeted(
    site: &Site<'_>,
    found: &Match,
    layout: &Layout,
    ways: &Ways,
    ground: &Ground<'_>,
    open: &OpenNearby<'_>,
    spacing: Spacing,
) -> Laid {
    let mirror = Rigid { mirrored: true, ..Rigid::IDENTITY };
    let mirrored;
    let layout = if found.motion.mirrored {
        mirrored = layout.moved(&mirror);
        &mirrored
    } else {
        layout
    };
    let source = source_of(layout, &ways.settings);
    let link = Correspondence::by_warp(&found.warp, source.ring(), &Ring::of(&site.ring));
    let placed = source.retarget(ground.block, &site.ring, &link, &ways.settings);
    let footprints = wishes(layout, &placed);
    let things = crate::retarget::things(layout, &source, &placed, ground.block, &site.ring, &link);
    let spacing = Spacing { cut: ways.settings.cut, ..spacing };
    lay(layout, &footprints, &things, ground, open, spacing)
}
