//! The rigid motion that lays one outline on another.
//!
//! Source: Hartmann 2018, section 5.1.3: least squares over the pairs of the warping path, without
//! scaling. Departure: samples of two outlines seldom lie at the same places along them, so the motion
//! is refined until it brings the samples nearest to the other outline itself ([`refine`]); of equal
//! outlines one then lies on the other to rounding.

use exurb_geom::{GridPoint, Rigid, Vec2, polyline};

use crate::{Outline, time_warp::Warp};

/// The motion of `from` onto `to` by the pairs of a path whose first samples are `to`'s.
pub fn align(from: &Outline, to: &Outline, warp: &Warp) -> Rigid {
    let n = from.points().len();
    let pair =
        |(i, j): &(u32, u32)| (from.points()[*j as usize % n], to.points()[*i as usize], 1.0);
    Rigid::fit(warp.path.iter().map(pair))
}

/// Steps of refinement at most.
const STEPS: usize = 12;
/// A step that gains less than this on the mean square is the last, relatively.
const GAIN: f64 = 1e-4;

/// `motion` refined so that the samples of `from` come nearest to the closed line `ring`, by
/// Gauss-Newton on their distances to it. Never farther from it than before. O(samples · ring) a step.
pub fn refine(motion: Rigid, from: &Outline, ring: &[GridPoint]) -> Rigid {
    let segments: Vec<(Vec2, Vec2)> =
        (0..ring.len()).map(|i| (ring[i].to_m(), ring[(i + 1) % ring.len()].to_m())).collect();
    let feet = |motion: &Rigid| -> Vec<(Vec2, Vec2)> {
        from.points().iter().map(|p| nearest(motion.apply(*p), &segments)).collect()
    };
    let square =
        |feet: &[(Vec2, Vec2)]| feet.iter().map(|(p, q)| p.distance_squared(*q)).sum::<f64>();
    let (mut motion, mut found) = (motion, feet(&motion));
    let mut least = square(&found);
    for _ in 0..STEPS {
        let Some(step) = step(&found) else { break };
        let next = motion.then(&step);
        let next_found = feet(&next);
        let next_square = square(&next_found);
        if next_square >= least {
            break;
        }
        let is_last = next_square > least * (1.0 - GAIN);
        (motion, found, least) = (next, next_found, next_square);
        if is_last {
            break;
        }
    }
    motion
}

/// Root mean square distance of the moved samples of `from` to the closed line `ring`, in metres.
pub fn deviation_m(motion: &Rigid, from: &Outline, ring: &[GridPoint]) -> f64 {
    let segments: Vec<(Vec2, Vec2)> =
        (0..ring.len()).map(|i| (ring[i].to_m(), ring[(i + 1) % ring.len()].to_m())).collect();
    let square = |p: &Vec2| {
        let (p, q) = nearest(motion.apply(*p), &segments);
        p.distance_squared(q)
    };
    let sum: f64 = from.points().iter().map(square).sum();
    (sum / from.points().len() as f64).sqrt()
}

/// `p` and the point of the segments nearest to it.
fn nearest(p: Vec2, segments: &[(Vec2, Vec2)]) -> (Vec2, Vec2) {
    let mut best = (f64::INFINITY, p);
    for (a, b) in segments {
        let q = polyline::nearest_on_segment(*a, *b, p).0;
        let square = q.distance_squared(p);
        if square < best.0 {
            best = (square, q);
        }
    }
    (p, best.1)
}

/// The small motion that, with every foot taken as a line across the way to it, brings the points
/// nearest to their feet; `None` where all lie on them or the equations say nothing.
fn step(feet: &[(Vec2, Vec2)]) -> Option<Rigid> {
    let center = feet.iter().map(|(p, _)| *p).sum::<Vec2>() / feet.len().max(1) as f64;
    let mut matrix = [[0.0; 3]; 3];
    let mut right = [0.0; 3];
    for (p, q) in feet {
        let way = *q - *p;
        let distance = way.length();
        if distance < 1e-9 {
            continue;
        }
        let normal = way / distance;
        // Change of the way's length with a shift along x and y and with a turn about the centre.
        let row = [normal.x, normal.y, (*p - center).perp_dot(normal)];
        for (i, a) in row.iter().enumerate() {
            right[i] += a * distance;
            for (j, b) in row.iter().enumerate() {
                matrix[i][j] += a * b;
            }
        }
    }
    let [x, y, angle] = solved(matrix, right)?;
    let turn = Vec2::new(1.0, angle).normalize();
    Some(Rigid::about(center, turn, Vec2::new(x, y)))
}

/// Solves three equations by Cramer's rule.
fn solved(m: [[f64; 3]; 3], r: [f64; 3]) -> Option<[f64; 3]> {
    let det = |m: &[[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let whole = det(&m);
    let size = m[0][0].max(m[1][1]).max(1e-12) * m[2][2].max(1e-12);
    if whole.abs() < 1e-9 * size {
        return None;
    }
    let column = |k: usize| {
        let mut swapped = m;
        for i in 0..3 {
            swapped[i][k] = r[i];
        }
        det(&swapped) / whole
    };
    Some([column(0), column(1), column(2)])
}

#[cfg(test)]
mod tests {
    use exurb_geom::trig;

    use super::*;
    use crate::{shape_context::Contexts, shape_context::outer_radius_m, time_warp};

    const SHAPE: [(f64, f64); 6] =
        [(0.0, 0.0), (90.0, 10.0), (100.0, 60.0), (55.0, 45.0), (50.0, 95.0), (5.0, 80.0)];

    fn ring(motion: &Rigid, start: usize) -> Vec<GridPoint> {
        let at = |k: usize| SHAPE[(k + start) % SHAPE.len()];
        (0..6).map(|k| GridPoint::round(motion.apply(Vec2::new(at(k).0, at(k).1)))).collect()
    }

    #[test]
    fn a_turned_and_shifted_outline_is_laid_on_the_other_wherever_it_starts() {
        for start in 0..6 {
            let motion = Rigid::about(
                Vec2::ZERO,
                trig::unit(0.7 + f64::from(start as u8)),
                Vec2::new(40.0, -9.0),
            );
            let (from, to) = (ring(&Rigid::IDENTITY, 0), ring(&motion, start));
            let (a, b) = (Outline::of(&from), Outline::of(&to));
            let radius = outer_radius_m(&b);
            let costs = Contexts::of(&b, radius).costs(&Contexts::of(&a, radius));
            let rough = align(&a, &b, &time_warp::cyclic(&costs));
            let fine = refine(rough, &a, &to);
            assert!(deviation_m(&fine, &a, &to) < 2e-3, "{}", deviation_m(&fine, &a, &to));
            let worst = SHAPE.iter().map(|(x, y)| Vec2::new(*x, *y));
            let worst = worst.map(|p| fine.apply(p).distance(motion.apply(p))).fold(0.0, f64::max);
            assert!(worst < 5e-3, "{worst}");
        }
    }
}
