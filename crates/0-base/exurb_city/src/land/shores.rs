//! Wet or dry, and how far to the water, by a grid of cells that know their nearest shore.

use std::sync::OnceLock;

use exurb_geom::{Bounds, Cell, Cells, GridPoint, Polygon, Vec2, overlay, polyline};

/// Cells are at least this wide. An odd number, so that the middle of a cell lies half a millimetre
/// off the grid and no vertex is level with one.
const LEAST_CELL_MM: u64 = 10_001;
/// About this many cells at most.
const MOST_CELLS: f64 = 1e6;
/// No shore.
const NONE: u32 = u32::MAX;

/// What a cell is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Dry,
    Wet,
    /// A shore runs through; the cell's middle is dry or wet.
    Shore {
        middle_is_wet: bool,
    },
}

/// Water areas over a box.
#[derive(Debug)]
pub struct Shores {
    cells: Cells,
    states: Vec<State>,
    segments: Vec<(GridPoint, GridPoint)>,
    /// The segments that pass each cell: those from `starts[cell]` to `starts[cell + 1]`.
    passing: Vec<u32>,
    starts: Vec<u32>,
    /// For each cell the shore segment nearest to its middle; made when first asked for.
    nearest: OnceLock<Vec<u32>>,
}

impl Shores {
    /// The water of the polygons, which may overlap, as far as it reaches into `bounds`.
    pub fn of(water: &[&Polygon], bounds: Bounds) -> Self {
        let near = water.iter().copied().filter(|p| p.bounds().intersects(bounds));
        // Joined, so that every shore has water on one side and land on the other.
        let areas = overlay::union(near);
        let size = (bounds.max - bounds.min) * 1000.0;
        let fair = (size.x * size.y / MOST_CELLS).sqrt().ceil() as u64;
        let low = GridPoint::round(bounds.min).to_m();
        let cell_m = (fair.max(LEAST_CELL_MM) | 1) as f64 / 1000.0;
        let cells = Cells::over(Bounds { min: low, ..bounds }, cell_m);
        let mut states = vec![State::Dry; cells.columns() * cells.rows()];
        for ((column, row), cell) in areas.iter().flat_map(|area| cells.of(area)) {
            let state = &mut states[row * cells.columns() + column];
            *state = match (cell, *state) {
                (Cell::Inside, _) => State::Wet,
                // Areas do not overlap: one of them holds the middle, or none.
                (Cell::Rim { middle }, State::Shore { middle_is_wet }) => {
                    State::Shore { middle_is_wet: middle || middle_is_wet }
                }
                (Cell::Rim { middle }, _) => State::Shore { middle_is_wet: middle },
            };
        }
        let segments = areas.iter().flat_map(|area| area.segments().collect::<Vec<_>>()).collect();
        let (passing, starts, nearest) = (Vec::new(), Vec::new(), OnceLock::new());
        let mut this = Self { cells, states, segments, passing, starts, nearest };
        this.list_segments();
        this
    }

    /// Is there no water?
    pub fn is_empty(&self) -> bool {
        self.segments.is_empty()
    }

    /// Is `p`, rounded to the millimetre, in water? Dry outside the box.
    pub fn is_wet(&self, p: Vec2) -> bool {
        let p = GridPoint::round(p).to_m();
        let Some(cell) = self.cell_of(p) else { return false };
        match self.states[cell] {
            State::Dry => false,
            State::Wet => true,
            State::Shore { middle_is_wet } => middle_is_wet ^ self.is_across(p, cell),
        }
    }

    /// Distance to water in metres.
    pub fn distance_m(&self, p: Vec2) -> f64 {
        if self.is_empty() {
            return f64::INFINITY;
        }
        let Some(cell) = self.cell_of(p) else { return self.distance_outside_m(p) };
        if self.is_wet(p) {
            return 0.0;
        }
        let nearest = self.nearest.get_or_init(|| self.nearest_shores());
        self.segment_distance_m(nearest[cell], p)
    }

    /// Outside the box, from its edge.
    fn distance_outside_m(&self, p: Vec2) -> f64 {
        let (low, high) = (self.cells.back(Vec2::ZERO), self.cells.back(self.cells.size()));
        let edge = p.clamp(low, high - 0.001);
        self.distance_m(edge) + p.distance(edge)
    }

    fn cell_of(&self, p: Vec2) -> Option<usize> {
        self.cells.at(p).map(|(column, row)| row * self.cells.columns() + column)
    }

    fn middle(&self, cell: usize) -> Vec2 {
        self.cells.middle((cell % self.cells.columns(), cell / self.cells.columns()))
    }

    /// Does an odd number of shores lie between `p` and the middle of its cell? Counted along the
    /// row of `p` up to the middle's column, then along that column.
    fn is_across(&self, p: Vec2, cell: usize) -> bool {
        let middle = self.middle(cell);
        let mut across = false;
        for id in &self.passing[self.starts[cell] as usize..self.starts[cell + 1] as usize] {
            let (a, b) = self.ends(*id);
            across ^= crosses_row(a, b, p.y, p.x, middle.x);
            across ^= crosses_row(turned(a), turned(b), middle.x, p.y, middle.y);
        }
        across
    }

    fn ends(&self, id: u32) -> (Vec2, Vec2) {
        let (a, b) = self.segments[id as usize];
        (a.to_m(), b.to_m())
    }

    /// Lists the segments that pass each cell.
    fn list_segments(&mut self) {
        let mut passed: Vec<(usize, u32)> = Vec::new();
        for id in 0..self.segments.len() as u32 {
            let (a, b) = self.ends(id);
            let columns = self.cells.columns();
            self.cells.along(a, b, |(column, row)| passed.push((row * columns + column, id)));
        }
        passed.sort_unstable();
        self.starts = vec![0; self.states.len() + 1];
        passed.iter().for_each(|(cell, _)| self.starts[cell + 1] += 1);
        for cell in 1..self.starts.len() {
            self.starts[cell] += self.starts[cell - 1];
        }
        self.passing = passed.into_iter().map(|(_, id)| id).collect();
    }

    /// For every cell the shore nearest to its middle, handed on from neighbour to neighbour: four
    /// sweeps over the grid.
    fn nearest_shores(&self) -> Vec<u32> {
        let (columns, rows) = (self.cells.columns(), self.cells.rows());
        let mut nearest = vec![NONE; columns * rows];
        let mut known_m = vec![f64::INFINITY; columns * rows];
        let mut offer = |nearest: &mut Vec<u32>, cell: usize, id: u32| {
            if id != NONE && nearest[cell] != id {
                let distance = self.segment_distance_m(id, self.middle(cell));
                if distance < known_m[cell] {
                    (known_m[cell], nearest[cell]) = (distance, id);
                }
            }
        };
        for cell in 0..columns * rows {
            let passing = self.starts[cell] as usize..self.starts[cell + 1] as usize;
            self.passing[passing].iter().for_each(|id| offer(&mut nearest, cell, *id));
        }
        let steps = [(-1_isize, 0_isize), (0, -1), (-1, -1), (1, -1)];
        for sweep in 0..4 {
            let back = sweep % 2 == 1;
            for k in 0..columns * rows {
                let cell = if back { columns * rows - 1 - k } else { k };
                let (column, row) = (cell % columns, cell / columns);
                for (dx, dy) in steps {
                    let (dx, dy) = if back { (-dx, -dy) } else { (dx, dy) };
                    let x = column.checked_add_signed(dx).filter(|x| *x < columns);
                    let y = row.checked_add_signed(dy).filter(|y| *y < rows);
                    if let (Some(x), Some(y)) = (x, y) {
                        let id = nearest[y * columns + x];
                        offer(&mut nearest, cell, id);
                    }
                }
            }
        }
        nearest
    }

    fn segment_distance_m(&self, id: u32, p: Vec2) -> f64 {
        if id == NONE {
            return f64::INFINITY;
        }
        let (a, b) = self.ends(id);
        polyline::nearest_on_segment(a, b, p).0.distance(p)
    }
}

fn turned(p: Vec2) -> Vec2 {
    Vec2::new(p.y, p.x)
}

/// Does the segment `a b` cross the row at `y` between `from` and `to`? A segment that ends on the
/// row belongs to the side above.
fn crosses_row(a: Vec2, b: Vec2, y: f64, from: f64, to: f64) -> bool {
    if (a.y > y) == (b.y > y) {
        return false;
    }
    let x = a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y);
    from.min(to) < x && x <= from.max(to)
}
