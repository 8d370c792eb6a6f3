//! Comparing a candidate with its example: which windows, against which floor, with what result.

use exurb_city::{City, Origin, Part};
use exurb_geom::{Bounds, Frame, Vec2};
use exurb_measure::Network;

use crate::copying::Original;
use crate::measures::{BUILT, Family, STREETS};
use crate::panel::{self, Panel, PanelCity};
use crate::patches::{CANDIDATE, HELD_OUT, Patches};
use crate::words::words;
use crate::{HeldOut, Measured, Scorecard, Side, Yardstick, windows};

/// Radii at which copies are looked for, in metres.
pub const COPY_RADII_M: [f64; 2] = [150.0, 300.0];
/// A window with fewer junctions tells little.
const FEW_JUNCTIONS: usize = 30;
/// A map is a strip when one side is so many times the other.
const STRIP: f64 = 1.5;
/// Two parts of one city overlap when they share more than this of the smaller, by area.
const OVERLAP: f64 = 0.05;

/// Other cities, whose mean distance is the floor.
#[derive(Clone, Copy, Debug)]
pub enum Floor<'a> {
    /// The cities of the panel.
    Panel,
    /// These cities, each in a window of the size compared.
    Cities(&'a [City]),
}

/// A window of a city.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    /// The city.
    pub city: &'a City,
    /// The window.
    pub window: Bounds,
}

impl Place<'_> {
    /// The part of the window of at most that size around its middle.
    fn cut(self, size: Vec2) -> Self {
        Self { window: windows::centred(self.window, size), ..self }
    }
}

/// An example and what it is known by: everything a comparison needs but the candidate.
#[derive(Debug)]
pub struct Reference {
    /// Name of the example.
    pub name: String,
    /// Name of the city that is its held-out part; `None` where that is a part of the example itself.
    pub held_out_name: Option<String>,
    /// Size of all windows in metres.
    pub size: Vec2,
    /// Ceilings and floors.
    pub yardstick: Yardstick,
    /// What was measured of the example's own other part.
    pub part: Subject,
    /// Streets of the held-out part.
    pub held_out: Network,
    /// Names of the cities of the floor.
    pub floor: Vec<String>,
    /// What a reader should know, a sentence each.
    pub notes: Vec<String>,
    original: Original,
    seed: u64,
}

/// One window, measured.
#[derive(Debug)]
pub struct Subject {
    /// The streets.
    pub network: Network,
    /// What was measured of them.
    pub measured: Measured,
    /// Patches of their picture.
    pub patches: Option<Patches>,
}

impl Subject {
    /// Measures a window. `key` is [`HELD_OUT`] for the part compared with, else [`CANDIDATE`].
    /// Buildings of an imported map count where they are complete.
    pub fn of(place: Place, panel: &Panel, seed: u64, key: u64) -> Self {
        let city = place.city;
        let network = Network::of(&city.streets, place.window);
        let is_made = !city.metadata.recipe.is_empty();
        let measured = if is_made || city.metadata.buildings_complete || !city.parcels.is_empty() {
            Measured::of_city(city, &network)
        } else {
            Measured::of_network(&network)
        };
        let look = |image| Patches::of(image, &panel.dictionary, seed, key);
        let patches = measured.image.as_ref().map(look);
        Self { network, measured, patches }
    }

    /// As one side of a comparison.
    pub fn side(&self) -> Side<'_> {
        Side { measured: &self.measured, patches: self.patches.as_ref() }
    }
}

/// How like its example a candidate is.
#[derive(Debug)]
pub struct Likeness {
    /// Scores.
    pub scorecard: Scorecard,
    /// Share of junctions that stand in the example with what lies within 150 m and 300 m.
    pub copy_rates: [Option<f64>; 2],
    /// Share of the candidate's street length that was copied from this example.
    pub example_share: Option<f64>,
    /// What was measured of the candidate.
    pub candidate: Subject,
    /// What a reader should know, a sentence each.
    pub notes: Vec<String>,
}

/// The size of all windows of a comparison: that of the held-out part, or the largest that every one
/// holds where another is smaller by over 2 %. With a note where the held-out part is cut to it.
pub fn common_size<'a>(
    part: Place<'a>,
    held_out: Place,
    others: impl IntoIterator<Item = &'a City>,
) -> (Vec2, Option<String>) {
    let wanted = held_out.window.size();
    let others = others.into_iter().map(|city| (city, city.target.bounds().size()));
    let all: Vec<(&City, Vec2)> = others.chain([(part.city, part.window.size())]).collect();
    let size = all.iter().fold(wanted, |least, (_, size)| least.min(*size));
    let about_equal = size.cmpge(wanted * (1.0 - windows::SAME_SHARE));
    let size = Vec2::select(about_equal, wanted, size);
    let is_least = |(_, own): &&(&City, Vec2)| (own.cmple(size) & !about_equal).any();
    let least = all.iter().filter(is_least).map(|(city, _)| &*city.metadata.name);
    let names: std::collections::BTreeSet<&str> = least.collect();
    let note = (!names.is_empty()).then(|| {
        let hold = if names.len() > 1 { "hold" } else { "holds" };
        let names: Vec<&str> = names.into_iter().collect();
        format!(
            "all windows were cut to {:.0} m x {:.0} m, the most that {} {hold}; the held-out part has \
             {:.0} m x {:.0} m",
            size.x,
            size.y,
            names.join(" and "),
            wanted.x,
            wanted.y
        )
    });
    (size, note)
}

/// The parts of an example without a held-out one: west and east half of its densest square, north
/// and south where the map is a strip from north to south.
pub fn split(example: &City) -> [Place<'_>; 2] {
    let size = example.target.bounds().size();
    let parts = match size.y > STRIP * size.x {
        true => [Part::North, Part::South],
        false => [Part::West, Part::East],
    };
    windows::halves(example, parts).map(|window| Place { city: example, window })
}

impl Reference {
    /// Prepares an example. `parts` are its own parts, whose mean distance from `held_out` is the
    /// ceiling; the first one is shown beside the candidate. All windows are cut to `size` around
    /// their middles.
    pub fn new(
        example: &City,
        parts: &[Place],
        held_out: Place,
        floor: Floor,
        panel: &Panel,
        size: Vec2,
        seed: u64,
    ) -> Self {
        let own: Vec<Subject> =
            parts.iter().map(|p| Subject::of(p.cut(size), panel, seed, CANDIDATE)).collect();
        let cities = match floor {
            Floor::Cities(cities) => cities,
            Floor::Panel => &[],
        };
        let window = |city| Place { city, window: windows::of_size(city, size) };
        let elsewhere: Vec<Place> = cities.iter().map(window).collect();
        let others: Vec<Subject> =
            elsewhere.iter().map(|p| Subject::of(*p, panel, seed, CANDIDATE)).collect();
        let of_panel = match floor {
            Floor::Panel => panel.others(&[example, held_out.city]),
            Floor::Cities(_) => Vec::new(),
        };
        let floor: Vec<Side> =
            others.iter().map(Subject::side).chain(of_panel.iter().map(|c| c.side())).collect();
        let names = cities.iter().map(|c| c.metadata.name.to_string());
        let held_out_name = (!std::ptr::eq(held_out.city, example))
            .then(|| held_out.city.metadata.name.to_string());
        let held_out = held_out.cut(size);
        let mut notes: Vec<String> = overlapping(parts, held_out).into_iter().collect();
        notes.extend(elsewhere.iter().filter_map(|p| no_other_city(*p, parts, held_out)));
        let Subject { network, measured, patches } = Subject::of(held_out, panel, seed, HELD_OUT);
        notes.extend(thin(&network, "the held-out part"));
        let real = own.iter().map(|s| &s.measured).chain(floor.iter().map(|s| s.measured));
        let held_out = HeldOut::new(measured, patches, real, seed);
        let sides: Vec<Side> = own.iter().map(Subject::side).collect();
        let whole = Network::of(&example.streets, example.target.bounds());
        // Towns of the panel tell of buildings alone.
        let is_town = |c: &PanelCity| c.measured.degrees.is_none();
        let built = BUILT.iter().any(|m| held_out.has(m));
        let listed = of_panel.iter().filter(|c| built || !is_town(c)).map(|c| c.name.clone());
        let floor_names = names.chain(listed).collect();
        let measures = [&STREETS[..], &BUILT].concat();
        let yardstick = Yardstick::new(held_out, &measures, &sides, &floor);
        notes.extend(left_out(&yardstick));
        notes.extend(untold(&yardstick));
        Self {
            name: example.metadata.name.to_string(),
            held_out_name,
            size,
            yardstick,
            part: own.into_iter().next().expect("an example has a part"),
            held_out: network,
            floor: floor_names,
            notes,
            original: Original::new(&whole),
            seed,
        }
    }

    /// Compares a city in a window of the reference's size.
    pub fn compare(&self, candidate: &City, panel: &Panel) -> Likeness {
        let window = windows::of_size(candidate, self.size);
        let place = Place { city: candidate, window }.cut(self.size);
        self.compare_subject(candidate, Subject::of(place, panel, self.seed, CANDIDATE))
    }

    fn compare_subject(&self, city: &City, candidate: Subject) -> Likeness {
        let mut notes = thin(&candidate.network, "the candidate");
        let mut unjudged = Vec::new();
        if city.buildings.is_empty() {
            unjudged.extend([Family::Buildings, Family::BuiltBlocks]);
        }
        if city.parcels.is_empty() {
            unjudged.push(Family::Parcels);
        }
        let held_out = self.yardstick.held_out();
        if unjudged.iter().any(|family| held_out.has_family(*family)) {
            notes.push("the candidate has no buildings or no parcels: they are not judged".into());
        }
        let scorecard = self.yardstick.score(candidate.side()).without(&unjudged);
        let copy_rates =
            COPY_RADII_M.map(|radius_m| self.original.copy_rate(&candidate.network, radius_m));
        let lacking =
            scorecard.measures.iter().filter(|s| s.distance.is_none() && s.score.is_some());
        let lacking: Vec<&str> = lacking.map(|s| words(&s.measure).title).collect();
        if !lacking.is_empty() {
            notes.push(format!(
                "the candidate has too few of these in its window, which score -1: {}",
                lacking.join("; ")
            ));
        }
        if copy_rates.iter().flatten().any(|rate| *rate > 0.99) {
            notes.push("the candidate is a copy of the example: scores near 1 mean nothing".into());
        }
        let example_share = example_share(city, &self.name);
        if self.held_out_name.is_none() && example_share.is_some_and(|share| share > 0.0) {
            notes.push(format!(
                "the candidate was made from {}, and what it is compared with is a half of that, so it \
                 was not unseen: make it from one part and give the other as --held-out",
                self.name
            ));
        }
        notes.extend(made_from_others(city, &self.name, example_share));
        Likeness { scorecard, copy_rates, example_share, candidate, notes }
    }
}

/// Share of the street length that was copied from the example of that name; `None` of no streets.
fn example_share(city: &City, name: &str) -> Option<f64> {
    let (mut copied, mut all) = (0.0, 0.0);
    for (_, edge) in city.streets.edges() {
        let provenance = &edge.data.provenance;
        let own = provenance.origin == Origin::Example
            && provenance.source.as_deref().is_some_and(|source| source == name);
        all += edge.length_m();
        copied += if own { edge.length_m() } else { 0.0 };
    }
    (all > 0.0).then(|| copied / all)
}

/// A note for a candidate whose streets name examples, but not this one.
fn made_from_others(city: &City, name: &str, example_share: Option<f64>) -> Option<String> {
    let mut sources: Vec<&str> =
        city.streets.edges().filter_map(|(_, e)| e.data.provenance.source.as_deref()).collect();
    sources.sort_unstable();
    sources.dedup();
    let is_strange = example_share == Some(0.0) && !sources.is_empty() && !sources.contains(&name);
    is_strange.then(|| {
        format!(
            "no street says that it comes from {name}, they name {}: compare with that file to see \
             what was laid from it",
            sources.join(", ")
        )
    })
}

fn thin(network: &Network, whose: &str) -> Vec<String> {
    match network.junctions().count() {
        few if few < FEW_JUNCTIONS => vec![format!(
            "{whose} has {few} junctions, fewer than {FEW_JUNCTIONS}: scores are unreliable; compare a larger area"
        )],
        _ => Vec::new(),
    }
}

/// A note on the measures of streets and blocks that the held-out part is too small for.
fn left_out(yardstick: &Yardstick) -> Option<String> {
    let absent = STREETS.iter().filter(|m| !yardstick.held_out().has(m)).map(|m| m.name);
    let absent: Vec<&str> = absent.collect();
    (!absent.is_empty())
        .then(|| format!("left out, too few values in windows of this size: {}", absent.join(", ")))
}

/// A note where no measure separates, so that there is no score.
fn untold(yardstick: &Yardstick) -> Option<String> {
    (yardstick.informative() == 0).then(|| {
        "there is no score: in no measure of streets and blocks does the example's own other part lie \
         clearly nearer than the other cities"
            .to_owned()
    })
}

/// A note where a part shares ground with the held-out one.
fn overlapping(parts: &[Place], held_out: Place) -> Option<String> {
    parts.iter().any(|part| share_ground(*part, held_out)).then(|| {
        "the example's part and the held-out part overlap: the held-out part was not unseen".into()
    })
}

/// A note where a city of the floor shares ground with the held-out part or with the example's own.
fn no_other_city(place: Place, own: &[Place], held_out: Place) -> Option<String> {
    let overlaps = own.iter().chain([&held_out]).any(|part| share_ground(place, *part));
    overlaps.then(|| {
        let name = &place.city.metadata.name;
        format!("{name} is part of the floor and overlaps the example: it is no other city")
    })
}

/// Do two windows overlap? Where a city without a place lies, only its own windows can tell.
fn share_ground(a: Place, b: Place) -> bool {
    let is_placeless = |p: Place| p.city.frame == Frame::null_island();
    if (is_placeless(a) || is_placeless(b)) && !std::ptr::eq(a.city, b.city) {
        return false;
    }
    let extent = |p: Place| {
        let (sw, ne) = (p.city.frame.unproject(p.window.min), p.city.frame.unproject(p.window.max));
        [sw.lon, sw.lat, ne.lon, ne.lat]
    };
    panel::shared_area(extent(a), extent(b)) > OVERLAP
}
