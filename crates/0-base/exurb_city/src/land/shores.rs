//! Wet or dry, and how far to the water, by a grid of cells that know their nearest shore.

use std::sync::OnceLock;

use exurb_geom::{Bounds, GridPoint, Polygon, Vec2, overlay, polyline};

/// Cells are at least this wide.
const LEAST_CELL_MM: i64 = 10_000;
/// About this many cells at most.
const MOST_CELLS: f64 = 1e6;
/// No shore.
const NONE: u32 = u32::MAX;

/// What a cell is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cell {
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
    /// South-west corner. Middles of cells lie off the millimetre grid, so that no vertex is level
    /// with one.
    low: GridPoint,
    cell_mm: i64,
    columns: usize,
    cells: Vec<Cell>,
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
        let near: Vec<&Polygon> =
            water.iter().copied().filter(|p| p.bounds().intersects(bounds)).collect();
        // Joined, so that every shore has water on one side and land on the other.
        let shores: Vec<(GridPoint, GridPoint)> =
            overlay::union(near).iter().flat_map(|p| p.segments().collect::<Vec<_>>()).collect();
        let size = (bounds.max - bounds.min) * 1000.0;
        let fair = (size.x * size.y / MOST_CELLS).sqrt().ceil() as i64;
        // Odd, so that the middle of a cell lies half a millimetre off the grid.
        let cell_mm = fair.max(LEAST_CELL_MM) | 1;
        let most = if shores.is_empty() { 0.0 } else { f64::INFINITY };
        let count = |mm: f64| (mm / cell_mm as f64).ceil().min(most) as usize;
        let (columns, rows) = (count(size.x), count(size.y));
        let mut this = Self {
            low: GridPoint::round(bounds.min),
            cell_mm,
            columns,
            cells: vec![Cell::Dry; columns * rows],
            segments: shores,
            passing: Vec::new(),
            starts: vec![0; columns * rows + 1],
            nearest: OnceLock::new(),
        };
        this.fill_rows();
        this.mark_shores();
        this
    }

    /// Is there no water?
    pub fn is_empty(&self) -> bool {
        self.segments.is_empty()
    }

    /// Is `p`, rounded to the millimetre, in water? Dry outside the box.
    pub fn is_wet(&self, p: Vec2) -> bool {
        let p = GridPoint::round(p);
        match self.cell_of(p).map(|i| (i, self.cells[i])) {
            None | Some((_, Cell::Dry)) => false,
            Some((_, Cell::Wet)) => true,
            Some((i, Cell::Shore { middle_is_wet })) => middle_is_wet ^ self.is_across(p, i),
        }
    }

    /// Distance to water in metres.
    pub fn distance_m(&self, p: Vec2) -> f64 {
        if self.is_empty() {
            return f64::INFINITY;
        }
        let at = GridPoint::round(p);
        let Some(cell) = self.cell_of(at) else { return self.distance_outside_m(p) };
        if self.is_wet(p) {
            return 0.0;
        }
        let nearest = self.nearest.get_or_init(|| self.nearest_shores());
        self.segment_distance_m(nearest[cell], p)
    }

    /// Outside the box, from its edge.
    fn distance_outside_m(&self, p: Vec2) -> f64 {
        let low = self.low.to_m();
        let size =
            Vec2::new(self.columns as f64, self.rows() as f64) * self.cell_mm as f64 / 1000.0;
        let edge = p.clamp(low, low + size - 0.001);
        self.distance_m(edge) + p.distance(edge)
    }

    fn rows(&self) -> usize {
        self.cells.len().checked_div(self.columns).unwrap_or(0)
    }

    fn cell_of(&self, p: GridPoint) -> Option<usize> {
        let x = (i64::from(p.x) - i64::from(self.low.x)).div_euclid(self.cell_mm);
        let y = (i64::from(p.y) - i64::from(self.low.y)).div_euclid(self.cell_mm);
        let inside = (0..self.columns as i64).contains(&x) && (0..self.rows() as i64).contains(&y);
        inside.then(|| y as usize * self.columns + x as usize)
    }

    /// The middle of a cell in millimetres.
    fn middle_mm(&self, cell: usize) -> Vec2 {
        let (column, row) = (cell % self.columns, cell / self.columns);
        let low = Vec2::new(f64::from(self.low.x), f64::from(self.low.y));
        low + (Vec2::new(column as f64, row as f64) + 0.5) * self.cell_mm as f64
    }

    /// Does an odd number of shores lie between `p` and the middle of its cell? Counted along the
    /// row of `p` up to the middle's column, then along that column.
    fn is_across(&self, p: GridPoint, cell: usize) -> bool {
        let middle = self.middle_mm(cell);
        let p = Vec2::new(f64::from(p.x), f64::from(p.y));
        let mut across = false;
        for id in &self.passing[self.starts[cell] as usize..self.starts[cell + 1] as usize] {
            let (a, b) = self.ends_mm(*id);
            across ^= crosses_row(a, b, p.y, p.x, middle.x);
            across ^= crosses_row(turned(a), turned(b), middle.x, p.y, middle.y);
        }
        across
    }

    fn ends_mm(&self, id: u32) -> (Vec2, Vec2) {
        let (a, b) = self.segments[id as usize];
        let mm = |p: GridPoint| Vec2::new(f64::from(p.x), f64::from(p.y));
        (mm(a), mm(b))
    }

    /// Cells whose middles lie in water, row by row between the shores.
    fn fill_rows(&mut self) {
        let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); self.rows()];
        for id in 0..self.segments.len() as u32 {
            let (a, b) = self.ends_mm(id);
            let row = |y: f64| (y - f64::from(self.low.y)) / self.cell_mm as f64 - 0.5;
            let (from, to) = (row(a.y.min(b.y)).ceil().max(0.0), row(a.y.max(b.y)));
            for row in (from as usize..).take_while(|r| *r as f64 <= to && *r < self.rows()) {
                let y = self.middle_mm(row * self.columns).y;
                crossings[row].push(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
            }
        }
        for (row, mut crossings) in crossings.into_iter().enumerate() {
            crossings.sort_by(f64::total_cmp);
            let mut passed = 0;
            for column in 0..self.columns {
                let cell = row * self.columns + column;
                let x = self.middle_mm(cell).x;
                passed += crossings[passed..].iter().take_while(|c| **c < x).count();
                if !passed.is_multiple_of(2) {
                    self.cells[cell] = Cell::Wet;
                }
            }
        }
    }

    /// Cells that a shore runs through, or comes within a millimetre of.
    fn mark_shores(&mut self) {
        let mut passed: Vec<(usize, u32)> = Vec::new();
        for id in 0..self.segments.len() as u32 {
            passed.extend(self.cells_along(id).into_iter().map(|cell| (cell, id)));
        }
        passed.sort_unstable();
        for (cell, _) in &passed {
            let middle_is_wet =
                matches!(self.cells[*cell], Cell::Wet | Cell::Shore { middle_is_wet: true });
            self.cells[*cell] = Cell::Shore { middle_is_wet };
            self.starts[cell + 1] += 1;
        }
        for cell in 1..self.starts.len() {
            self.starts[cell] += self.starts[cell - 1];
        }
        self.passing = passed.into_iter().map(|(_, id)| id).collect();
    }

    /// The cells that a segment passes: in each column the rows between its ends there.
    fn cells_along(&self, id: u32) -> Vec<usize> {
        let (a, b) = self.ends_mm(id);
        let (a, b) = if a.x <= b.x { (a, b) } else { (b, a) };
        let low = Vec2::new(f64::from(self.low.x), f64::from(self.low.y));
        let cell = self.cell_mm as f64;
        let range = |from: f64, to: f64, count: usize| {
            let first = ((from - 1.0) / cell).floor().max(0.0) as usize;
            let last = ((to + 1.0) / cell).floor();
            first..if last < 0.0 { 0 } else { (last as usize + 1).min(count) }
        };
        let mut out = Vec::new();
        for column in range(a.x - low.x, b.x - low.x, self.columns) {
            let (west, east) = (low.x + column as f64 * cell, low.x + (column + 1) as f64 * cell);
            let y_at =
                |x: f64| a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x).max(1.0)).clamp(0.0, 1.0);
            let (p, q) = if b.x - a.x < 1.0 { (a.y, b.y) } else { (y_at(west), y_at(east)) };
            let rows = range(p.min(q) - low.y, p.max(q) - low.y, self.rows());
            out.extend(rows.map(|row| row * self.columns + column));
        }
        out
    }

    /// For every cell the shore nearest to its middle, handed on from neighbour to neighbour: four
    /// sweeps over the grid and back.
    fn nearest_shores(&self) -> Vec<u32> {
        let (columns, rows) = (self.columns, self.rows());
        let mut nearest = vec![NONE; columns * rows];
        let mut known_m = vec![f64::INFINITY; columns * rows];
        let mut offer = |nearest: &mut Vec<u32>, cell: usize, id: u32| {
            if id != NONE && nearest[cell] != id {
                let distance = self.segment_distance_m(id, self.middle_mm(cell) / 1000.0);
                if distance < known_m[cell] {
                    (known_m[cell], nearest[cell]) = (distance, id);
                }
            }
        };
        // Those that pass within reach of the box; others could only be nearest from outside it.
        for id in 0..self.segments.len() as u32 {
            self.cells_along(id).into_iter().for_each(|cell| offer(&mut nearest, cell, id));
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
        let (a, b) = self.segments[id as usize];
        polyline::nearest_on_segment(a.to_m(), b.to_m(), p).0.distance(p)
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
