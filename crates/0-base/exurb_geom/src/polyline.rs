//! Lengths, positions, curvature and distances of open lines, in metres.

use crate::{GridPoint, Vec2, trig};

/// The points of a grid line in metres.
pub fn to_m(line: &[GridPoint]) -> Vec<Vec2> {
    line.iter().map(|p| p.to_m()).collect()
}

/// The points of a line rounded to the grid, without equal neighbours.
pub fn round(line: &[Vec2]) -> Vec<GridPoint> {
    let mut out: Vec<GridPoint> = line.iter().map(|p| GridPoint::round(*p)).collect();
    out.dedup();
    out
}

/// Length of a grid line.
pub fn grid_length_m(line: &[GridPoint]) -> f64 {
    line.windows(2).map(|w| w[0].distance_m(w[1])).sum()
}

/// Length of a line.
pub fn length(line: &[Vec2]) -> f64 {
    line.windows(2).map(|w| w[0].distance(w[1])).sum()
}

/// The point `at_m` along the line, kept within its ends. The line has at least one point.
pub fn point_at(line: &[Vec2], at_m: f64) -> Vec2 {
    let mut left = at_m.max(0.0);
    for w in line.windows(2) {
        let step = w[0].distance(w[1]);
        if left <= step && step > 0.0 {
            return w[0].lerp(w[1], left / step);
        }
        left -= step;
    }
    line[line.len() - 1]
}

/// The part of the line between `from_m` and `to_m` along it (`from_m < to_m`), with both ends.
pub fn part(line: &[Vec2], from_m: f64, to_m: f64) -> Vec<Vec2> {
    let mut out = vec![point_at(line, from_m)];
    let mut at = 0.0;
    for w in line.windows(2) {
        at += w[0].distance(w[1]);
        if at > from_m && at < to_m {
            out.push(w[1]);
        }
    }
    out.push(point_at(line, to_m));
    out.dedup();
    out
}

/// Points about `step_m` apart along the line, both ends included.
pub fn resample(line: &[Vec2], step_m: f64) -> Vec<Vec2> {
    let total = length(line);
    let pieces = (total / step_m).ceil().max(1.0) as usize;
    let mut out = Vec::with_capacity(pieces + 1);
    let (mut segment, mut start) = (0, 0.0);
    for i in 0..=pieces {
        let at = total * i as f64 / pieces as f64;
        while segment + 2 < line.len() {
            let end = start + line[segment].distance(line[segment + 1]);
            if at <= end {
                break;
            }
            start = end;
            segment += 1;
        }
        let (a, b) = (line[segment], line[(segment + 1).min(line.len() - 1)]);
        let step = a.distance(b);
        out.push(if step > 0.0 { a.lerp(b, ((at - start) / step).clamp(0.0, 1.0)) } else { a });
    }
    out
}

/// Curvature of a line in 1/m: the sum of changes of the unit direction over the length.
/// 0 for fewer than two segments.
///
/// Source: Nishida, Garcia-Dorado, Aliaga 2015, *Example-Driven Procedural Urban Roads*, eq. (1).
pub fn curvature(line: &[Vec2]) -> f64 {
    let total = length(line);
    let mut directions = line.windows(2).map(|w| w[1] - w[0]).filter(|d| d.length() > 0.0);
    let Some(first) = directions.next() else { return 0.0 };
    let mut last = first.normalize();
    let mut change = 0.0;
    for d in directions {
        let unit = d.normalize();
        change += unit.distance(last);
        last = unit;
    }
    change / total
}

/// Sum of absolute turning angles along the line, in radians.
pub fn turning(line: &[Vec2]) -> f64 {
    line.windows(3).map(|w| trig::angle_between(w[1] - w[0], w[2] - w[1])).sum()
}

/// The point of segment `a b` nearest to `p`, and its place in `0..=1` along the segment.
pub fn nearest_on_segment(a: Vec2, b: Vec2, p: Vec2) -> (Vec2, f64) {
    let d = b - a;
    let square = d.length_squared();
    let t = if square > 0.0 { ((p - a).dot(d) / square).clamp(0.0, 1.0) } else { 0.0 };
    (a + d * t, t)
}

/// The point of the line nearest to `p`: point, metres along the line, and index of its segment.
pub fn nearest(line: &[Vec2], p: Vec2) -> (Vec2, f64, usize) {
    let mut best = (line[0], 0.0, 0);
    let mut best_distance = f64::INFINITY;
    let mut start = 0.0;
    for (i, w) in line.windows(2).enumerate() {
        let (q, t) = nearest_on_segment(w[0], w[1], p);
        let step = w[0].distance(w[1]);
        let distance = q.distance(p);
        if distance < best_distance {
            best_distance = distance;
            best = (q, start + step * t, i);
        }
        start += step;
    }
    best
}

/// Distance from `p` to the line in metres.
pub fn distance(line: &[Vec2], p: Vec2) -> f64 {
    nearest(line, p).0.distance(p)
}

/// Distance between the closed segments `a b` and `c d`.
pub fn segment_distance(a: Vec2, b: Vec2, c: Vec2, d: Vec2) -> f64 {
    let side = |p: Vec2, q: Vec2, r: Vec2| (q - p).perp_dot(r - p);
    if side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0 {
        return 0.0;
    }
    let to = |p, q, r: Vec2| nearest_on_segment(p, q, r).0.distance(r);
    to(a, b, c).min(to(a, b, d)).min(to(c, d, a)).min(to(c, d, b))
}

/// Symmetric Hausdorff distance between the vertices of two lines. Resample first when vertices
/// are sparse. O(n·m).
pub fn hausdorff(a: &[Vec2], b: &[Vec2]) -> f64 {
    let directed = |from: &[Vec2], to: &[Vec2]| {
        from.iter()
            .map(|p| to.iter().map(|q| p.distance_squared(*q)).fold(f64::INFINITY, f64::min))
            .fold(0.0, f64::max)
    };
    directed(a, b).max(directed(b, a)).sqrt()
}

/// Douglas–Peucker simplification: keeps both ends, drops vertices nearer than `tolerance_m`.
pub fn simplify(line: &[Vec2], tolerance_m: f64) -> Vec<Vec2> {
    if line.len() < 3 {
        return line.to_vec();
    }
    let mut keep = vec![false; line.len()];
    let mut open = vec![(0, line.len() - 1)];
    keep[0] = true;
    keep[line.len() - 1] = true;
    while let Some((i, j)) = open.pop() {
        let far = (i + 1..j)
            .map(|k| (k, nearest_on_segment(line[i], line[j], line[k]).0.distance(line[k])))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((k, d)) = far
            && d > tolerance_m
        {
            keep[k] = true;
            open.extend([(i, k), (k, j)]);
        }
    }
    line.iter().zip(keep).filter_map(|(p, k)| k.then_some(*p)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const BEND: [Vec2; 3] = [Vec2::ZERO, Vec2::new(10.0, 0.0), Vec2::new(10.0, 10.0)];

    #[test]
    fn a_right_angle_has_curvature_root_two_over_its_length() {
        assert!((curvature(&BEND) - 2f64.sqrt() / 20.0).abs() < 1e-12);
        assert_eq!(curvature(&BEND[..2]), 0.0);
    }

    #[test]
    fn parts_and_samples_lie_on_the_line() {
        assert_eq!(part(&BEND, 5.0, 15.0), [Vec2::new(5.0, 0.0), BEND[1], Vec2::new(10.0, 5.0)]);
        let samples = resample(&BEND, 3.0);
        assert_eq!(samples.len(), 8);
        assert!(samples.iter().all(|p| distance(&BEND, *p) < 1e-9));
        assert_eq!((samples[0], samples[7]), (BEND[0], BEND[2]));
    }

    #[test]
    fn crossing_segments_are_no_distance_apart() {
        let d = segment_distance(Vec2::ZERO, Vec2::new(2.0, 2.0), Vec2::X * 2.0, Vec2::Y * 2.0);
        assert_eq!(d, 0.0);
    }
}
