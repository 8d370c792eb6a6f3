//! Which piece of an example every place belongs to.
//!
//! The paper lets every patch grow wherever it crosses nothing. Then what is empty in the example,
//! its large blocks and parks, is filled with streets of other places, and the new city is denser than
//! any part of the example. Here a piece claims the ground around it: others may lead streets there to
//! meet its own, but nothing of theirs grows on. So every place has the streets, and the emptiness, of
//! one place of the example.

use std::collections::BTreeSet;
use std::sync::Arc;

use exurb_geom::{Bounds, Polygon, Vec2};

use super::network::Coherent;

/// Side of the squares that are claimed, in metres.
const CELL_M: f64 = 20.0;
/// A piece that reaches ground nobody claims takes so much around the place, in metres.
const STEP_M: f64 = 60.0;
/// And it does so up to this many times its reach.
const STRETCH: f64 = 1.5;
/// Stands in the grid for what lies outside the area.
const OUTSIDE: u32 = u32::MAX;

/// Claimed ground on a grid.
#[derive(Clone, Debug)]
pub struct Claims {
    min: Vec2,
    columns: usize,
    rows: usize,
    /// Number of the piece, 0 for none, or [`OUTSIDE`]; row by row from the south-west.
    owners: Vec<u32>,
    /// The pieces by number, from 1: those of the claims that this is a window of, which all windows
    /// share, then its own.
    shared: Arc<Vec<Option<Coherent>>>,
    pieces: Vec<Option<Coherent>>,
    /// Is there ground that nobody may have?
    has_water: bool,
}

impl Claims {
    /// Free ground inside `area`, but where it is wet.
    pub fn new(area: &Polygon, is_wet: impl Fn(Vec2) -> bool) -> Self {
        let mut claims = Self::over(area.bounds());
        for i in 0..claims.owners.len() {
            claims.owners[i] = OUTSIDE;
        }
        claims.open(area);
        for i in 0..claims.owners.len() {
            if claims.owners[i] != OUTSIDE && is_wet(claims.center(i)) {
                claims.owners[i] = OUTSIDE;
                claims.has_water = true;
            }
        }
        claims
    }

    fn over(bounds: Bounds) -> Self {
        let size = (bounds.size() / CELL_M).ceil().max(Vec2::ONE);
        let (columns, rows) = (size.x as usize, size.y as usize);
        let (owners, pieces) = (vec![0; columns * rows], vec![None]);
        let shared = Arc::default();
        Self { min: bounds.min, columns, rows, owners, shared, pieces, has_water: false }
    }

    /// The part of these claims inside `area`; what is claimed in it further does not count here.
    pub fn window(&self, area: &Polygon) -> Self {
        let shared = Arc::clone(&self.shared);
        let mut part = Self { shared, pieces: Vec::new(), ..Self::new(area, |_| false) };
        part.has_water = self.has_water;
        for i in 0..part.owners.len() {
            if part.owners[i] == 0 {
                // Its water lies outside; what lies outside its area is this one's edge.
                part.owners[i] = self.cell(part.center(i)).map_or(0, |k| self.owners[k]);
            }
        }
        part
    }

    /// Frees the ground inside `area`: row by row between its borders, by the even-odd rule.
    fn open(&mut self, area: &Polygon) {
        let sides: Vec<(Vec2, Vec2)> = area.segments().map(|(a, b)| (a.to_m(), b.to_m())).collect();
        for row in 0..self.rows {
            let y = self.min.y + (row as f64 + 0.5) * CELL_M;
            let crossed = sides.iter().filter(|(a, b)| (a.y > y) != (b.y > y));
            let mut xs: Vec<f64> =
                crossed.map(|(a, b)| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y)).collect();
            xs.sort_by(f64::total_cmp);
            for inside in xs.chunks_exact(2) {
                let column = |x: f64| ((x - self.min.x) / CELL_M - 0.5).ceil().max(0.0) as usize;
                let (from, to) = (column(inside[0]), column(inside[1]).min(self.columns));
                self.owners[row * self.columns..][from.min(to)..to].fill(0);
            }
        }
    }

    /// Does `p` lie inside the area, as the grid sees it?
    pub fn is_inside(&self, p: Vec2) -> bool {
        self.cell(p).is_some_and(|i| self.owners[i] != OUTSIDE)
    }

    /// The number of the next piece.
    pub fn next_id(&mut self) -> u32 {
        self.pieces.push(None);
        (self.shared.len() + self.pieces.len()) as u32 - 1
    }

    /// Lets windows of these claims share the pieces so far.
    pub fn share(&mut self) {
        let mut all = (*self.shared).clone();
        all.append(&mut self.pieces);
        self.shared = Arc::new(all);
    }

    fn piece(&self, id: u32) -> Option<Coherent> {
        let id = id as usize;
        match id.checked_sub(self.shared.len()) {
            Some(own) => self.pieces[own],
            None => self.shared[id],
        }
    }

    /// The pieces that claim ground here, in order of their numbers.
    pub fn pieces_here(&self) -> Vec<Coherent> {
        let here: BTreeSet<u32> =
            self.owners.iter().copied().filter(|owner| *owner != OUTSIDE).collect();
        here.into_iter().filter_map(|id| self.piece(id)).collect()
    }

    /// No ground of `piece` lies farther than this from its beginning.
    pub fn reach_m(&self, piece: &Coherent) -> f64 {
        let far = (self.columns + self.rows) as f64 * CELL_M;
        let from_here = (self.min - piece.at).abs().max_element() + far;
        (STRETCH * piece.reach_m + STEP_M).min(from_here)
    }

    /// The piece that `p` belongs to.
    pub fn owner(&self, p: Vec2) -> Option<u32> {
        self.cell(p).map(|i| self.owners[i]).filter(|id| *id > 0 && *id != OUTSIDE)
    }

    /// Claims the free ground that `piece` reaches from its origin and that `may_have` accepts.
    pub fn begin(&mut self, piece: &Coherent, may_have: impl Fn(Vec2) -> bool) {
        let own = piece.id as usize - self.shared.len();
        self.pieces[own] = Some(*piece);
        let far = (self.columns + self.rows) as f64 * CELL_M;
        self.claim(piece.id, piece.at, piece.reach_m.min(far), may_have);
    }

    /// Does growth of `piece` go on at `p`? Where nobody claims the ground, it does not far from the
    /// piece, and takes it.
    pub fn holds(&mut self, piece: &Coherent, p: Vec2, may_have: impl Fn(Vec2) -> bool) -> bool {
        match self.owner(p) {
            Some(owner) => owner == piece.id,
            None if p.distance(piece.at) < STRETCH * piece.reach_m && may_have(p) => {
                self.claim(piece.id, p, STEP_M, may_have);
                true
            }
            None => false,
        }
    }

    fn claim(&mut self, id: u32, at: Vec2, radius_m: f64, may_have: impl Fn(Vec2) -> bool) {
        if self.has_water {
            return self.claim_on_foot(id, at, radius_m, may_have);
        }
        let low = ((at - radius_m - self.min) / CELL_M).floor().max(Vec2::ZERO);
        let high = ((at + radius_m - self.min) / CELL_M).ceil();
        let (columns, rows) =
            (self.columns.min(high.x.max(0.0) as usize), high.y.max(0.0) as usize);
        for row in low.y as usize..rows.min(self.rows) {
            for column in low.x as usize..columns {
                let i = row * self.columns + column;
                let center = self.center(i);
                if self.owners[i] == 0 && center.distance(at) <= radius_m && may_have(center) {
                    self.owners[i] = id;
                }
            }
        }
    }

    /// Claims only what can be reached without crossing water: the other bank is for others.
    fn claim_on_foot(&mut self, id: u32, at: Vec2, radius_m: f64, may_have: impl Fn(Vec2) -> bool) {
        let mut seen = BTreeSet::new();
        let mut open: Vec<usize> = self.cell(at).into_iter().collect();
        seen.extend(open.iter().copied());
        while let Some(i) = open.pop() {
            let center = self.center(i);
            if self.owners[i] == OUTSIDE || center.distance(at) > radius_m {
                continue;
            }
            if self.owners[i] == 0 && may_have(center) {
                self.owners[i] = id;
            }
            let steps = [Vec2::X, -Vec2::X, Vec2::Y, -Vec2::Y];
            let beside = steps.into_iter().filter_map(|d| self.cell(center + d * CELL_M));
            open.extend(beside.filter(|k| seen.insert(*k)));
        }
    }

    fn cell(&self, p: Vec2) -> Option<usize> {
        let place = (p - self.min) / CELL_M;
        let inside = place.min_element() >= 0.0
            && place.x < self.columns as f64
            && place.y < self.rows as f64;
        inside.then(|| place.y as usize * self.columns + place.x as usize)
    }

    fn center(&self, cell: usize) -> Vec2 {
        let place = Vec2::new((cell % self.columns) as f64, (cell / self.columns) as f64);
        self.min + (place + 0.5) * CELL_M
    }
}
