//! Points near a point, while points come and go: a uniform grid, as in [`crate::segment_index`].

use rustc_hash::FxHashMap;

use crate::Vec2;

/// An index of points, each with a number of the caller's.
#[derive(Clone, Debug)]
pub struct PointIndex {
    cell_m: f64,
    cells: FxHashMap<(i32, i32), Vec<(u32, Vec2)>>,
}

impl PointIndex {
    /// An empty index with square cells of `cell_m`, best near the usual search radius.
    pub fn new(cell_m: f64) -> Self {
        Self { cell_m, cells: FxHashMap::default() }
    }

    /// Adds `p` as `id`.
    pub fn insert(&mut self, id: u32, p: Vec2) {
        self.cells.entry(self.cell(p)).or_default().push((id, p));
    }

    /// Removes the point added as `id` at `p`.
    pub fn remove(&mut self, id: u32, p: Vec2) {
        let cell = self.cell(p);
        if let Some(list) = self.cells.get_mut(&cell) {
            list.retain(|(i, _)| *i != id);
        }
    }

    /// Calls `visit` with the numbers of the points within `radius_m` of `p`, in order of cells and
    /// insertion.
    pub fn visit(&self, p: Vec2, radius_m: f64, mut visit: impl FnMut(u32)) {
        self.visit_with_distance(p, radius_m, |id, _| visit(id));
    }

    fn visit_with_distance(&self, p: Vec2, radius_m: f64, mut visit: impl FnMut(u32, f64)) {
        let (lo, hi) = (self.cell(p - radius_m), self.cell(p + radius_m));
        for y in lo.1..=hi.1 {
            for x in lo.0..=hi.0 {
                for (id, q) in self.cells.get(&(x, y)).into_iter().flatten() {
                    let d = q.distance(p);
                    if d <= radius_m {
                        visit(*id, d);
                    }
                }
            }
        }
    }

    /// The points within `radius_m` of `p`: number and distance, nearest first, ties by number.
    pub fn within(&self, p: Vec2, radius_m: f64) -> Vec<(u32, f64)> {
        let mut out = Vec::new();
        self.visit_with_distance(p, radius_m, |id, d| out.push((id, d)));
        out.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        out
    }

    /// The nearest point within `radius_m`.
    pub fn nearest(&self, p: Vec2, radius_m: f64) -> Option<(u32, f64)> {
        self.within(p, radius_m).into_iter().next()
    }

    fn cell(&self, p: Vec2) -> (i32, i32) {
        ((p.x / self.cell_m).floor() as i32, (p.y / self.cell_m).floor() as i32)
    }
}
