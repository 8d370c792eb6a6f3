//! Triangles → samples: clipped, binned by bands of rows, drawn with a depth buffer.

use std::ops::Range;

use glam::Vec3;
use rayon::prelude::*;

use super::camera::{Camera, Lens, NEAR_M};
use super::surface::Surfaces;

/// Number of no triangle.
pub const NOTHING: u32 = u32::MAX;
/// Triangles prepared together.
const CHUNK: usize = 8192;

/// A triangle on the grid of samples: columns, rows and nearness of its corners, by rows.
#[derive(Clone, Copy)]
struct Placed {
    corners: [[f32; 3]; 3],
    number: u32,
}

/// Triangles, by bands of rows.
pub struct Bands {
    chunks: Vec<Chunk>,
    rows: usize,
    width: usize,
    height: usize,
    background: f32,
}

struct Chunk {
    placed: Vec<Placed>,
    /// For each band the triangles that touch it.
    bands: Vec<Vec<u32>>,
}

/// The samples of a band.
pub struct Drawn {
    pub rows: Range<usize>,
    pub nearness: Vec<f32>,
    pub triangles: Vec<u32>,
}

impl Bands {
    /// All triangles that face the camera, in bands of `rows` rows.
    pub fn of(surfaces: &Surfaces, camera: &Camera, rows: usize) -> Self {
        let count = camera.height.div_ceil(rows);
        let stretches: Vec<(usize, Range<usize>)> = surfaces
            .parts
            .iter()
            .enumerate()
            .flat_map(|(k, part)| {
                let n = part.mesh.triangle_count();
                (0..n).step_by(CHUNK).map(move |from| (k, from..(from + CHUNK).min(n)))
            })
            .collect();
        let chunks = stretches
            .into_par_iter()
            .map(|(k, range)| {
                let placed = place(surfaces, k, range, camera);
                let mut bands = vec![Vec::new(); count];
                for (i, triangle) in placed.iter().enumerate() {
                    let [from, to] = row_range(triangle, camera.height);
                    if from < to {
                        for band in &mut bands[from / rows..=(to - 1) / rows] {
                            band.push(i as u32);
                        }
                    }
                }
                Chunk { placed, bands }
            })
            .collect();
        let background = match camera.lens {
            Lens::Perspective { .. } => 0.0,
            Lens::Parallel { .. } => f32::MIN,
        };
        Self { chunks, rows, width: camera.width, height: camera.height, background }
    }

    pub fn count(&self) -> usize {
        self.height.div_ceil(self.rows)
    }

    /// Draws a band; of equally near triangles the first one stays.
    pub fn draw(&self, band: usize) -> Drawn {
        let rows = band * self.rows..((band + 1) * self.rows).min(self.height);
        let size = rows.len() * self.width;
        let mut nearness = vec![self.background; size];
        let mut triangles = vec![NOTHING; size];
        for (triangle, start, columns, span) in self.spans(band, &rows) {
            let mut z = span.at;
            for i in start + columns.start..start + columns.end {
                let near = z.clamp(span.least, span.most);
                if near > nearness[i] {
                    nearness[i] = near;
                    triangles[i] = triangle;
                }
                z += span.step;
            }
        }
        Drawn { rows, nearness, triangles }
    }

    /// Nearness only.
    pub fn draw_depth(&self, band: usize) -> Vec<f32> {
        let rows = band * self.rows..((band + 1) * self.rows).min(self.height);
        let mut nearness = vec![self.background; rows.len() * self.width];
        for (_, start, columns, span) in self.spans(band, &rows) {
            let mut z = span.at;
            for depth in &mut nearness[start + columns.start..start + columns.end] {
                *depth = depth.max(z.clamp(span.least, span.most));
                z += span.step;
            }
        }
        nearness
    }

    /// The stretches of rows that the triangles of a band cover: triangle, start of the row in the
    /// band's samples, columns.
    fn spans<'a>(
        &'a self,
        band: usize,
        rows: &'a Range<usize>,
    ) -> impl Iterator<Item = (u32, usize, Range<usize>, Span)> + 'a {
        let listed = self
            .chunks
            .iter()
            .flat_map(move |c| c.bands[band].iter().map(move |i| &c.placed[*i as usize]));
        listed.flat_map(move |triangle| {
            let slope = Slope::of(triangle);
            let [from, to] = row_range(triangle, self.height);
            (from.max(rows.start)..to.min(rows.end)).filter_map(move |row| {
                let columns = columns(triangle, row, self.width)?;
                let start = (row - rows.start) * self.width;
                let span = slope.span(triangle, row, columns.start);
                Some((triangle.number, start, columns, span))
            })
        })
    }
}

/// Nearness along a row.
struct Span {
    at: f32,
    step: f32,
    least: f32,
    most: f32,
}

/// How nearness changes over a triangle.
struct Slope {
    x: f32,
    y: f32,
    least: f32,
    most: f32,
}

impl Slope {
    fn of(triangle: &Placed) -> Self {
        let [a, b, c] = triangle.corners;
        let (ux, uy, uz) = (b[0] - a[0], b[1] - a[1], b[2] - a[2]);
        let (vx, vy, vz) = (c[0] - a[0], c[1] - a[1], c[2] - a[2]);
        let area = ux * vy - uy * vx;
        let scale = if area.abs() > 1e-6 { 1.0 / area } else { 0.0 };
        Self {
            x: (uz * vy - vz * uy) * scale,
            y: (vz * ux - uz * vx) * scale,
            least: a[2].min(b[2]).min(c[2]),
            most: a[2].max(b[2]).max(c[2]),
        }
    }

    fn span(&self, triangle: &Placed, row: usize, column: usize) -> Span {
        let [a, ..] = triangle.corners;
        let (dx, dy) = (column as f32 + 0.5 - a[0], row as f32 + 0.5 - a[1]);
        let at = a[2] + self.x * dx + self.y * dy;
        Span { at, step: self.x, least: self.least, most: self.most }
    }
}

/// The first sample whose middle lies at `v` or past it, up to `count`. (Cheaper than `ceil`, which
/// is a call where the processor is not known to have it.)
fn first_past(v: f32, count: usize) -> usize {
    let shifted = (v - 0.5).clamp(0.0, count as f32);
    let floor = shifted as usize;
    floor + usize::from(shifted > floor as f32)
}

/// Rows whose middles the triangle covers.
fn row_range(triangle: &Placed, height: usize) -> [usize; 2] {
    let [first, _, last] = triangle.corners;
    let clamp = |y: f32| first_past(y, height);
    [clamp(first[1]), clamp(last[1])]
}

/// Columns whose middles the triangle covers in a row. Edges that two triangles share are computed
/// from the same corners in the same order, so that nothing shows through between them.
fn columns(triangle: &Placed, row: usize, width: usize) -> Option<Range<usize>> {
    let [a, b, c] = triangle.corners;
    let y = row as f32 + 0.5;
    let cross = |p: [f32; 3], q: [f32; 3]| p[0] + (y - p[1]) * ((q[0] - p[0]) / (q[1] - p[1]));
    let long = cross(a, c);
    let short = if y < b[1] { cross(a, b) } else { cross(b, c) };
    let clamp = |x: f32| first_past(x, width);
    let (from, to) = (clamp(long.min(short)), clamp(long.max(short)));
    (from < to).then_some(from..to)
}

fn place(surfaces: &Surfaces, k: usize, range: Range<usize>, camera: &Camera) -> Vec<Placed> {
    let mesh = &surfaces.parts[k].mesh;
    let mut out = Vec::with_capacity(range.len());
    for t in range {
        let corners: [Vec3; 3] = [0, 1, 2]
            .map(|i| camera.seen(Vec3::from(mesh.positions[mesh.indices[t * 3 + i] as usize])));
        let number = surfaces.first_of(k) + t as u32;
        for seen in clipped(corners, camera.lens) {
            let mut corners = seen.map(|p| camera.place(p));
            let [a, b, c] = corners;
            let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            // Rows count downwards: what faces the camera turns the other way on the grid.
            let outside = |k: usize, limit: f32| {
                corners.iter().all(|p| p[k] < 0.0) || corners.iter().all(|p| p[k] > limit)
            };
            if turn >= 0.0 || outside(0, camera.width as f32) || outside(1, camera.height as f32) {
                continue;
            }
            corners.sort_by(|p, q| p[1].total_cmp(&q[1]));
            out.push(Placed { corners, number });
        }
    }
    out
}

/// What of a triangle lies in front of the camera: none, one or two triangles.
fn clipped(corners: [Vec3; 3], lens: Lens) -> impl Iterator<Item = [Vec3; 3]> {
    let mut ring: [Vec3; 4] = [Vec3::ZERO; 4];
    let mut n = 0;
    let in_front = |p: Vec3| p.z >= NEAR_M;
    if matches!(lens, Lens::Parallel { .. }) || corners.iter().all(|p| in_front(*p)) {
        ring[..3].copy_from_slice(&corners);
        n = 3;
    } else {
        for (i, p) in corners.iter().enumerate() {
            let q = corners[(i + 1) % 3];
            if in_front(*p) {
                ring[n] = *p;
                n += 1;
            }
            if in_front(*p) != in_front(q) {
                ring[n] = p.lerp(q, (NEAR_M - p.z) / (q.z - p.z));
                n += 1;
            }
        }
    }
    (2..n).map(move |i| [ring[0], ring[i - 1], ring[i]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Four triangles around a point fill a square, and no sample twice.
        #[test]
        fn triangles_that_share_sides_share_no_sample(
            x in 1.0..31.0f32, y in 1.0..31.0f32, w in 0.0..0.9f32,
        ) {
            let corners = [[w, w, 1.0], [32.0 - w, w, 1.0], [32.0 - w, 32.0 - w, 1.0], [w, 32.0 - w, 1.0]];
            let mut covered = vec![0; 32 * 32];
            for k in 0..4 {
                let mut corners = [corners[k], corners[(k + 1) % 4], [x, y, 1.0]];
                corners.sort_by(|p, q| p[1].total_cmp(&q[1]));
                let triangle = Placed { corners, number: 0 };
                let [from, to] = row_range(&triangle, 32);
                for row in from..to {
                    for column in columns(&triangle, row, 32).into_iter().flatten() {
                        covered[row * 32 + column] += 1;
                    }
                }
            }
            let inner = |i: &usize| (1..31).contains(&(i % 32)) && (1..31).contains(&(i / 32));
            prop_assert!((0..32 * 32).filter(inner).all(|i| covered[i] == 1));
        }
    }
}
