//! The modelled area as a box of longitude and latitude.

use exurb_geom::{GridPoint, LonLat, Polygon, Vec2, polyline};

use crate::City;

/// Cells along each side of the first, coarse search.
const CELLS: usize = 64;
/// Rounds of pushing all four sides outwards.
const ROUNDS: usize = 12;
/// Sides are refined to this many degrees, a centimetre.
const STEP_DEGREES: f64 = 1e-7;
/// Sides of the target are straight in the plane, a little bent in degrees: pieces of this length.
const PIECE_M: f64 = 250.0;

impl City {
    /// South-west and north-east corner of the largest box of longitude and latitude inside the
    /// target, which GeoJSON and OSM files declare as their extent. On a multiple of 1e-7 degrees,
    /// never outside the target by more than that. The largest box of a coarse grid of 64 x 64
    /// cells, then each side pushed outwards until it meets the target's boundary. `None` when the
    /// target is too small or too narrow for such a box.
    pub fn lonlat_bbox(&self) -> Option<[LonLat; 2]> {
        let outline = Outline::new(self)?;
        let coarse = outline.largest_of_cells()?;
        Some(outline.refine(coarse))
    }
}

/// The target's boundary in degrees.
struct Outline<'a> {
    city: &'a City,
    segments: Vec<(Vec2, Vec2)>,
    min: Vec2,
    max: Vec2,
}

impl<'a> Outline<'a> {
    fn new(city: &'a City) -> Option<Self> {
        let mut segments = Vec::new();
        for (a, b) in city.target.segments() {
            let pieces = polyline::resample(&[a.to_m(), b.to_m()], PIECE_M);
            let places: Vec<Vec2> =
                pieces.iter().map(|p| degrees(city.frame.unproject(*p))).collect();
            segments.extend(places.windows(2).map(|w| (w[0], w[1])));
        }
        let min = segments.iter().map(|s| s.0).reduce(Vec2::min)?;
        let max = segments.iter().map(|s| s.0).reduce(Vec2::max)?;
        (min.is_finite() && max.is_finite() && min.cmplt(max).all()).then_some(Self {
            city,
            segments,
            min,
            max,
        })
    }

    /// Does no boundary pass through the open box?
    fn is_free(&self, min: Vec2, max: Vec2) -> bool {
        !self.segments.iter().any(|(a, b)| passes(*a, *b, min, max))
    }

    fn is_inside(&self, place: Vec2) -> bool {
        let at = self.city.frame.project_to_grid(LonLat { lon: place.x, lat: place.y });
        at.is_some_and(|at: GridPoint| Polygon::contains(&self.city.target, at))
    }

    /// The largest box made of whole cells inside: for every row the heights of free columns above
    /// it, for every column the widest run at least that high. O(cells · columns).
    fn largest_of_cells(&self) -> Option<(Vec2, Vec2)> {
        let step = (self.max - self.min) / CELLS as f64;
        let corner = |x: usize, y: usize| self.min + step * Vec2::new(x as f64, y as f64);
        let mut heights = [0usize; CELLS];
        let mut best: Option<(f64, (Vec2, Vec2))> = None;
        for y in 0..CELLS {
            for (x, height) in heights.iter_mut().enumerate() {
                let (lo, hi) = (corner(x, y), corner(x + 1, y + 1));
                // A hair inside, so that sides along the boundary do not count as crossed.
                let hair = step * 1e-3;
                let free = self.is_free(lo + hair, hi - hair) && self.is_inside((lo + hi) / 2.0);
                *height = if free { *height + 1 } else { 0 };
            }
            for x in 0..CELLS {
                let mut low = heights[x];
                for (end, height) in heights.iter().enumerate().skip(x) {
                    low = low.min(*height);
                    let area = ((end + 1 - x) * low) as f64;
                    if low > 0 && best.as_ref().is_none_or(|(a, _)| area > *a) {
                        best = Some((area, (corner(x, y + 1 - low), corner(end + 1, y + 1))));
                    }
                }
            }
        }
        best.map(|(_, found)| found)
    }

    /// Pulls the sides in by a hair, then pushes them out as far as they stay free: half way in all
    /// rounds but the last, because on a boundary aslant one side could take what the next needs.
    fn refine(&self, (min, max): (Vec2, Vec2)) -> [LonLat; 2] {
        let hair = (self.max - self.min) / CELLS as f64 * 2e-3;
        let (mut min, mut max) = (min + hair, max - hair);
        for round in 0..ROUNDS {
            for side in 0..4 {
                let limit = [self.min.x, self.min.y, self.max.x, self.max.y][side];
                let mut good = [min.x, min.y, max.x, max.y][side];
                let mut bad = limit + if side < 2 { -STEP_DEGREES } else { STEP_DEGREES };
                while (bad - good).abs() > STEP_DEGREES / 4.0 {
                    let middle = (good + bad) / 2.0;
                    let (mut lo, mut hi) = (min, max);
                    *[&mut lo.x, &mut lo.y, &mut hi.x, &mut hi.y][side] = middle;
                    if self.is_free(lo, hi) {
                        good = middle;
                    } else {
                        bad = middle;
                    }
                }
                let end = if round + 1 < ROUNDS {
                    let start = [min.x, min.y, max.x, max.y][side];
                    (start + good) / 2.0
                } else {
                    good
                };
                *[&mut min.x, &mut min.y, &mut max.x, &mut max.y][side] = end;
            }
        }
        let fixed = |v: f64| (v / STEP_DEGREES).round() / (1.0 / STEP_DEGREES);
        [
            LonLat { lon: fixed(min.x), lat: fixed(min.y) },
            LonLat { lon: fixed(max.x), lat: fixed(max.y) },
        ]
    }
}

fn degrees(place: LonLat) -> Vec2 {
    Vec2::new(place.lon, place.lat)
}

/// Does the segment pass through the open box? (Clipping after Liang and Barsky.)
fn passes(a: Vec2, b: Vec2, min: Vec2, max: Vec2) -> bool {
    let d = b - a;
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for (d, start, lo, hi) in [(d.x, a.x, min.x, max.x), (d.y, a.y, min.y, max.y)] {
        if d == 0.0 {
            if start <= lo || start >= hi {
                return false;
            }
        } else {
            let (t, u) = ((lo - start) / d, (hi - start) / d);
            from = from.max(t.min(u));
            to = to.min(t.max(u));
        }
    }
    from < to
}

#[cfg(test)]
mod tests {
    use super::*;
    use exurb_geom::Frame;

    fn city(ring: &[(f64, f64)]) -> City {
        let frame = Frame::new(LonLat { lon: 24.94, lat: 60.17 }).expect("valid");
        let ring = ring.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect();
        City::empty(frame, Polygon::new(ring, Vec::new()).expect("has area"))
    }

    fn area_and_inside(city: &City) -> f64 {
        let [sw, ne] = city.lonlat_bbox().expect("room for a box");
        let target = city.target.bounds().grown(0.02);
        let mut corners = Vec::new();
        for (lon, lat) in [(sw.lon, sw.lat), (ne.lon, sw.lat), (ne.lon, ne.lat), (sw.lon, ne.lat)] {
            let p = city.frame.project(LonLat { lon, lat }).expect("near");
            let near = city.target.contains(GridPoint::round(p))
                || city.target.boundary_distance_m(p) < 0.02;
            assert!(near && target.contains(p), "{p} lies outside");
            corners.push(GridPoint::round(p));
        }
        Polygon::new(corners, Vec::new()).expect("has area").area_m2()
    }

    #[test]
    fn a_square_gives_nearly_all_of_itself() {
        let square = city(&[(-1000., -1000.), (1000., -1000.), (1000., 1000.), (-1000., 1000.)]);
        let area = area_and_inside(&square);
        assert!(area > 0.999 * 4e6 && area <= 4e6, "{area}");
    }

    #[test]
    fn a_concave_or_round_target_gives_a_box_inside() {
        let l = city(&[(0., 0.), (900., 0.), (900., 300.), (300., 300.), (300., 900.), (0., 900.)]);
        let area = area_and_inside(&l);
        assert!(area > 0.99 * 270_000.0, "{area}");
        let circle: Vec<(f64, f64)> = (0..64)
            .map(|i| exurb_geom::trig::unit(f64::from(i) / 64.0 * std::f64::consts::TAU) * 500.0)
            .map(|p| (p.x, p.y))
            .collect();
        // The largest box in a circle is a square of half its radius squared times four.
        let area = area_and_inside(&city(&circle));
        assert!(area > 0.95 * 500_000.0, "{area}");
    }
}
