//! Cutting a polygon along a straight line.

use crate::{GridPoint, Polygon, Vec2, polygon::signed_area_m2};

/// The pieces of `polygon` to the left of the directed line through `a` and `b`, largest first.
/// Cutting points are rounded to the grid, the same ones from either side of the line. The polygon
/// must be valid; pieces under 1e-4 m² go. O(n log n) in vertices, O(holes · pieces).
pub fn left_of(polygon: &Polygon, a: Vec2, b: Vec2) -> Vec<Polygon> {
    let direction = (b - a).normalize_or_zero();
    let side = |p: GridPoint| direction.perp_dot(p.to_m() - a);
    // Vertices nearer than a millimetre to the line count as on it, and so as not left.
    const ON_LINE_M: f64 = 1e-3;
    let is_left = |p: GridPoint| side(p) > ON_LINE_M;
    if direction == Vec2::ZERO || polygon.exterior().iter().all(|p| is_left(*p)) {
        return vec![polygon.clone()];
    }
    if !polygon.exterior().iter().any(|p| is_left(*p)) {
        return Vec::new();
    }
    let mut rings: Vec<Vec<GridPoint>> = Vec::new();
    let mut chains: Vec<Chain> = Vec::new();
    for ring in polygon.rings() {
        if ring.iter().all(|p| is_left(*p)) {
            rings.push(ring.to_vec());
        } else {
            chains.extend(chains_left(ring, is_left, side, a, direction));
        }
    }
    rings.extend(closed(chains));
    with_holes(rings)
}

/// A stretch of boundary left of the line, from the line to the line.
struct Chain {
    points: Vec<GridPoint>,
    enters_at: f64,
    leaves_at: f64,
}

fn chains_left(
    ring: &[GridPoint],
    is_left: impl Fn(GridPoint) -> bool,
    side: impl Fn(GridPoint) -> f64,
    origin: Vec2,
    direction: Vec2,
) -> Vec<Chain> {
    let n = ring.len();
    let along = |p: GridPoint| direction.dot(p.to_m() - origin);
    let cut = |p: GridPoint, q: GridPoint| {
        // From the left end to the other, so that both walks round the same number.
        let (left, right) = if is_left(p) { (p, q) } else { (q, p) };
        let (s, t) = (side(left), side(right).min(0.0));
        GridPoint::round(left.to_m().lerp(right.to_m(), s / (s - t)))
    };
    let mut out = Vec::new();
    for start in 0..n {
        let before = ring[(start + n - 1) % n];
        if !is_left(ring[start]) || is_left(before) {
            continue;
        }
        let mut points = vec![cut(before, ring[start])];
        let mut i = start;
        while is_left(ring[i % n]) {
            points.push(ring[i % n]);
            i += 1;
        }
        points.push(cut(ring[(i + n - 1) % n], ring[i % n]));
        let (first, last) = (points[0], points[points.len() - 1]);
        out.push(Chain { enters_at: along(first), leaves_at: along(last), points });
    }
    out
}

/// Joins chains along the line: with the inside to the left, a chain that leaves the left side goes
/// on where the next one, seen along the line, comes in.
fn closed(chains: Vec<Chain>) -> Vec<Vec<GridPoint>> {
    let mut order: Vec<usize> = (0..chains.len()).collect();
    order.sort_by(|i, j| chains[*i].enters_at.total_cmp(&chains[*j].enters_at).then(i.cmp(j)));
    let mut used = vec![false; chains.len()];
    let mut rings = Vec::new();
    for start in 0..chains.len() {
        if used[start] {
            continue;
        }
        let mut ring = Vec::new();
        let mut here = start;
        loop {
            used[here] = true;
            ring.extend(&chains[here].points);
            let leaves = chains[here].leaves_at;
            let next = order
                .iter()
                .copied()
                .find(|k| (!used[*k] || *k == start) && chains[*k].enters_at >= leaves);
            match next {
                Some(next) if next != start => here = next,
                _ => break,
            }
        }
        rings.push(ring);
    }
    rings
}

/// Polygons of counter-clockwise rings, each with the clockwise ones inside it.
fn with_holes(rings: Vec<Vec<GridPoint>>) -> Vec<Polygon> {
    let (outer, holes): (Vec<_>, Vec<_>) =
        rings.into_iter().partition(|ring| signed_area_m2(ring) > 0.0);
    let shells: Vec<Polygon> =
        outer.into_iter().filter_map(|ring| Polygon::new(ring, Vec::new())).collect();
    let mut inside: Vec<Vec<Vec<GridPoint>>> = vec![Vec::new(); shells.len()];
    for hole in holes {
        let home = hole.first().and_then(|p| shells.iter().position(|s| s.contains(*p)));
        if let Some(home) = home {
            inside[home].push(hole);
        }
    }
    let mut out: Vec<Polygon> = shells
        .into_iter()
        .zip(inside)
        .filter_map(|(shell, holes)| Polygon::new(shell.exterior().to_vec(), holes))
        .filter(|polygon| polygon.area_m2() > 1e-4)
        .collect();
    out.sort_by(|p, q| q.area_m2().total_cmp(&p.area_m2()).then_with(|| p.cmp(q)));
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)]) -> Vec<GridPoint> {
        points.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect()
    }

    fn area(pieces: &[Polygon]) -> f64 {
        pieces.iter().map(Polygon::area_m2).sum()
    }

    #[test]
    fn a_comb_falls_apart_above_its_back() {
        let comb = [
            (0., 0.),
            (50., 0.),
            (50., 20.),
            (40., 20.),
            (40., 5.),
            (30., 5.),
            (30., 20.),
            (20., 20.),
            (20., 5.),
            (10., 5.),
            (10., 20.),
            (0., 20.),
        ];
        let comb = Polygon::new(ring(&comb), vec![]).expect("has area");
        let (a, b) = (Vec2::new(0.0, 10.0), Vec2::new(1.0, 10.0));
        let (above, below) = (left_of(&comb, a, b), left_of(&comb, b, a));
        assert_eq!((above.len(), below.len()), (3, 1));
        assert_eq!(area(&above), 300.0);
        assert_eq!(area(&above) + area(&below), comb.area_m2());
        assert!(below.iter().chain(&above).all(Polygon::is_valid));
    }

    #[test]
    fn a_hole_is_kept_cut_or_left_away() {
        let hole = ring(&[(40., 40.), (60., 40.), (60., 60.), (40., 60.)]);
        let shell = ring(&[(0., 0.), (100., 0.), (100., 100.), (0., 100.)]);
        let court = Polygon::new(shell, vec![hole]).expect("has area");
        for (y, holes) in [(20.0, 1), (50.0, 0), (80.0, 0)] {
            let (a, b) = (Vec2::new(0.0, y), Vec2::new(1.0, y));
            let (above, below) = (left_of(&court, a, b), left_of(&court, b, a));
            assert_eq!(above[0].interiors().len(), holes, "{y}");
            assert!((area(&above) + area(&below) - 9600.0).abs() < 1e-9);
        }
    }

    #[test]
    fn both_sides_of_any_line_make_the_whole() {
        let star: Vec<(f64, f64)> = (0..17)
            .map(|i| {
                let r = if i % 2 == 0 { 40.0 } else { 11.0 + f64::from(i) };
                let p = crate::trig::unit(f64::from(i) * std::f64::consts::TAU / 17.0) * r;
                (p.x, p.y)
            })
            .collect();
        let star = Polygon::new(ring(&star), vec![]).expect("has area");
        for i in 0..90 {
            let angle = f64::from(i) * 0.07;
            let a = crate::trig::unit(angle * 2.7) * 9.0;
            let b = a + crate::trig::unit(angle);
            let (left, right) = (left_of(&star, a, b), left_of(&star, b, a));
            let whole = area(&left) + area(&right);
            assert!((whole - star.area_m2()).abs() < 0.2, "{i}: {whole} {}", star.area_m2());
            assert!(left.iter().chain(&right).all(Polygon::is_valid), "{i}");
        }
    }

    #[test]
    fn a_line_beside_or_of_no_length_takes_all_or_nothing() {
        let square = Polygon::rectangle(GridPoint::m(0., 0.), GridPoint::m(9., 9.));
        let (a, b) = (Vec2::new(-1.0, 0.0), Vec2::new(-1.0, 1.0));
        assert!(left_of(&square, a, b).is_empty());
        assert_eq!(left_of(&square, b, a), std::slice::from_ref(&square));
        assert_eq!(left_of(&square, a, a), [square]);
    }
}
