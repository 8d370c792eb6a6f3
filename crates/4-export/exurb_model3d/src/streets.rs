//! Streets: ribbons as wide as the carriageway, with round ends that fill the junctions; bridges as
//! decks on a ramp; centre lines on main streets.
//!
//! Ribbons lie in one plane and overlap at junctions in one colour, which no viewer can tell.

use exurb_city::{Class, Role, Street};
use exurb_geom::{GridPoint, Vec2, polyline, trig};
use exurb_graph::NodeId;

use crate::ground::BLOCK_M;
use crate::mesh::Mesh;
use crate::palette::{ASPHALT, CONCRETE, Linear, MARKING, PAVED, linear};
use crate::scene::{Layer, Material, Part, Site};

/// Height of one storey of bridges, in metres.
const STOREY_M: f64 = 5.5;
/// Steepest ramp.
const GRADE: f64 = 0.12;
const DECK_M: f64 = 0.9;
const PARAPET_M: f64 = 0.9;
/// Corners of a full turn of a round end.
const ROUND: usize = 12;
const MARK_M: f64 = 0.06;

pub fn layer(site: &Site) -> Layer {
    let mut part = Part::new(Material::Plain);
    for (id, edge) in site.city.streets.edges() {
        let street = &edge.data;
        if street.tunnel || !shown(site, edge.line()) {
            continue;
        }
        part.begin(id.0 + 1);
        let line = clean(&edge.line_m());
        if line.len() < 2 {
            continue;
        }
        let ends = [edge.from, edge.to].map(|n| node_height_m(site, n));
        if street.crossing_level() > 0 || ends != [0.0, 0.0] {
            let feet = [edge.from, edge.to].map(|n| foot_m(site, n));
            bridge(site, &mut part.mesh, &line, street, ends, feet);
        } else {
            let ribbon = Ribbon { line: &line, half_m: street.width_m() / 2.0 };
            let lie = Lie::Ground(level_m(street.class));
            ribbon.surface(site, &mut part.mesh, lie, color(street.class));
            if site.options.markings {
                center_line(site, &mut part.mesh, &line, street, Lie::Ground(MARK_M));
            }
        }
    }
    let other = other_ways(site);
    Layer { name: "streets", parts: [vec![part], other].concat() }
}

/// Service roads run over pavements and through blocks. They are no elements of the street layer:
/// their number is 0.
fn other_ways(site: &Site) -> Vec<Part> {
    let mut part = Part::new(Material::Plain);
    part.begin(0);
    for way in site.city.other_ways.iter() {
        let street = &way.street;
        let line = clean(&polyline::to_m(&way.line));
        if street.crossing_level() == 0 && line.len() >= 2 && shown(site, &way.line) {
            let ribbon = Ribbon { line: &line, half_m: street.width_m().min(5.0) / 2.0 };
            let lie = Lie::Ground(BLOCK_M + 0.04);
            ribbon.surface(site, &mut part.mesh, lie, color(street.class));
        }
    }
    vec![part]
}

fn shown(site: &Site, line: &[GridPoint]) -> bool {
    exurb_geom::Bounds::of(line.iter().copied()).is_some_and(|b| b.intersects(site.bounds))
}

fn color(class: Class) -> Linear {
    linear(match class {
        Class::Pedestrian | Class::LivingStreet => PAVED,
        _ => ASPHALT,
    })
}

/// Paved streets end under asphalt ones.
fn level_m(class: Class) -> f64 {
    if matches!(class, Class::Pedestrian | Class::LivingStreet) { -0.04 } else { 0.0 }
}

/// A node is up on a bridge if no street at it is on the ground.
fn node_height_m(site: &Site, node: NodeId) -> f64 {
    let graph = &site.city.streets;
    let levels = graph.darts(node).iter().map(|d| graph.edge(d.edge()).data.crossing_level());
    f64::from(levels.min().unwrap_or(0).max(0)) * STOREY_M
}

/// What the storeys of a node stand on: the ground, or what the city says of its height where no
/// street is on the ground.
fn foot_m(site: &Site, node: NodeId) -> f64 {
    let node_data = site.city.streets.node(node);
    let ground_m = site.drape.height_m(node_data.at.to_m());
    if site.drape.is_flat() || node_height_m(site, node) == 0.0 {
        return ground_m;
    }
    ground_m.max(node_data.data.z_m - site.drape.datum_m)
}

/// A bridge with its ramps: `ends` are the heights of its ends over `feet`.
fn bridge(
    site: &Site,
    mesh: &mut Mesh,
    line: &[Vec2],
    street: &Street,
    ends: [f64; 2],
    feet: [f64; 2],
) {
    let total_m = polyline::length(line);
    let top_m = f64::from(street.crossing_level().max(0)) * STOREY_M;
    let height = |at_m: f64| {
        let ramp = |from_m: f64, run_m: f64| from_m + (top_m - from_m).min(run_m * GRADE);
        let over_m = ramp(ends[0], at_m).min(ramp(ends[1], total_m - at_m)).max(0.0) + 0.02;
        let foot_m = feet[0] + (feet[1] - feet[0]) * (at_m / total_m);
        (foot_m + over_m).max(site.drape.height_m(polyline::point_at(line, at_m)) + 0.02)
    };
    // Ramps bend: enough points to follow.
    let fine = polyline::resample(line, 6.0);
    let half_m = street.width_m() / 2.0;
    Ribbon { line: &fine, half_m }.surface(site, mesh, Lie::Along(&height), color(street.class));
    let deck = Deck { line: &fine, half_m: half_m + 0.3 };
    deck.draw(site, mesh, height);
    if site.options.markings {
        let marks = |at_m: f64| height(at_m) + MARK_M;
        center_line(site, mesh, &fine, street, Lie::Along(&marks));
    }
}

/// How a street lies.
#[derive(Clone, Copy)]
enum Lie<'a> {
    /// On the ground, so many metres over it.
    Ground(f64),
    /// At a height by metres along its line.
    Along(&'a dyn Fn(f64) -> f64),
}

impl Lie<'_> {
    /// Puts down a piece of a street whose first and last corner are `from_m` along it, the two
    /// between them `to_m`; or any piece that lies level.
    fn piece(
        self,
        site: &Site,
        mesh: &mut Mesh,
        corners: &[Vec2],
        [from_m, to_m]: [f64; 2],
        color: Linear,
    ) {
        match self {
            Self::Ground(over_m) => site.drape.lay_convex(mesh, site.axes, corners, over_m, color),
            Self::Along(height) => {
                let (first, last) = (height(from_m), height(to_m));
                let height = |i: usize| if i == 1 || i == 2 { last } else { first };
                let places =
                    corners.iter().enumerate().map(|(i, p)| site.axes.place(*p, height(i)));
                mesh.convex(&places.collect::<Vec<_>>(), color);
            }
        }
    }
}

/// A line and half its width.
struct Ribbon<'a> {
    line: &'a [Vec2],
    half_m: f64,
}

impl Ribbon<'_> {
    /// The top.
    fn surface(&self, site: &Site, mesh: &mut Mesh, lie: Lie, color: Linear) {
        let mut at_m = 0.0;
        let last = self.line.len() - 1;
        for (i, w) in self.line.windows(2).enumerate() {
            let along = (w[1] - w[0]).normalize_or_zero();
            let left = along.perp() * self.half_m;
            let end_m = at_m + w[0].distance(w[1]);
            // Bends are mitred; sharp ones get a disc below.
            let (l0, r0) = self.miter(i, left);
            let (l1, r1) = self.miter(i + 1, left);
            lie.piece(site, mesh, &[r0, r1, l1, l0], [at_m, end_m], color);
            if i == 0 || self.is_sharp(i) {
                lie.piece(site, mesh, &self.disc(w[0]), [at_m; 2], color);
            }
            if i + 1 == last {
                lie.piece(site, mesh, &self.disc(w[1]), [end_m; 2], color);
            }
            at_m = end_m;
        }
    }

    fn is_sharp(&self, i: usize) -> bool {
        if i == 0 || i + 1 == self.line.len() {
            return false;
        }
        let (u, v) = (self.line[i] - self.line[i - 1], self.line[i + 1] - self.line[i]);
        u.dot(v) < 0.7 * u.length() * v.length()
    }

    /// Left and right corner at point `i`, seen from a segment whose left offset is `left`.
    fn miter(&self, i: usize, left: Vec2) -> (Vec2, Vec2) {
        let p = self.line[i];
        if i == 0 || i + 1 == self.line.len() || self.is_sharp(i) {
            return (p + left, p - left);
        }
        let u = (self.line[i] - self.line[i - 1]).normalize_or_zero();
        let v = (self.line[i + 1] - self.line[i]).normalize_or_zero();
        let offset = (u.perp() + v.perp()) / (1.0 + u.dot(v)) * self.half_m;
        (p + offset, p - offset)
    }

    /// A round end.
    fn disc(&self, center: Vec2) -> [Vec2; ROUND] {
        let step = std::f64::consts::TAU / ROUND as f64;
        std::array::from_fn(|k| center + trig::unit(step * k as f64) * self.half_m)
    }
}

/// The body of a bridge: sides, underside and parapets.
struct Deck<'a> {
    line: &'a [Vec2],
    half_m: f64,
}

impl Deck<'_> {
    fn draw(&self, site: &Site, mesh: &mut Mesh, height: impl Fn(f64) -> f64) {
        let color = linear(CONCRETE);
        let ribbon = Ribbon { line: self.line, half_m: self.half_m };
        let inner = Ribbon { line: self.line, half_m: self.half_m - 0.25 };
        let mut at_m = 0.0;
        for (i, w) in self.line.windows(2).enumerate() {
            let end_m = at_m + w[0].distance(w[1]);
            let (h0, h1) = (height(at_m), height(end_m));
            at_m = end_m;
            let left = (w[1] - w[0]).normalize_or_zero().perp();
            let (l0, r0) = ribbon.miter(i, left * ribbon.half_m);
            let (l1, r1) = ribbon.miter(i + 1, left * ribbon.half_m);
            let (il0, ir0) = inner.miter(i, left * inner.half_m);
            let (il1, ir1) = inner.miter(i + 1, left * inner.half_m);
            let p = |q: Vec2, h: f64| site.axes.place(q, h);
            let (low0, low1) = (h0 - DECK_M, h1 - DECK_M);
            let (top0, top1) = (h0 + PARAPET_M, h1 + PARAPET_M);
            mesh.convex(&[p(r0, low0), p(r1, low1), p(r1, top1), p(r0, top0)], color);
            mesh.convex(&[p(l1, low1), p(l0, low0), p(l0, top0), p(l1, top1)], color);
            mesh.convex(&[p(l0, low0), p(l1, low1), p(r1, low1), p(r0, low0)], color);
            mesh.convex(&[p(r0, top0), p(r1, top1), p(ir1, top1), p(ir0, top0)], color);
            mesh.convex(&[p(il0, top0), p(il1, top1), p(l1, top1), p(l0, top0)], color);
            mesh.convex(&[p(ir1, h1), p(ir0, h0), p(ir0, top0), p(ir1, top1)], color);
            mesh.convex(&[p(il0, h0), p(il1, h1), p(il1, top1), p(il0, top0)], color);
        }
    }
}

/// Dashes of 3 m every 9 m on main streets, away from the junctions.
fn center_line(site: &Site, mesh: &mut Mesh, line: &[Vec2], street: &Street, lie: Lie) {
    const DASH_M: f64 = 3.0;
    const PERIOD_M: f64 = 9.0;
    if street.role() != Role::Main || street.width_m() < 6.5 {
        return;
    }
    let free_m = street.width_m();
    let end_m = polyline::length(line) - free_m;
    let mut at_m = free_m;
    while at_m + DASH_M < end_m {
        let (a, b) = (polyline::point_at(line, at_m), polyline::point_at(line, at_m + DASH_M));
        let side = (b - a).normalize_or_zero().perp() * 0.11;
        let corners = [a - side, b - side, b + side, a + side];
        lie.piece(site, mesh, &corners, [at_m, at_m + DASH_M], linear(MARKING));
        at_m += PERIOD_M;
    }
}

/// The line without points closer than 5 cm.
fn clean(line: &[Vec2]) -> Vec<Vec2> {
    let mut out: Vec<Vec2> = Vec::with_capacity(line.len());
    for p in line {
        if out.last().is_none_or(|q| q.distance(*p) > 0.05) {
            out.push(*p);
        }
    }
    out
}
