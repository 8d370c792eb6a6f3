//! Rows of buildings inside a block, along a fitted curve.
//!
//! Hartmann et al. 2015, section 6, names the two things needed: a curve along the elements, and a term
//! for how well they are turned to it. Elements are linked to the nearest one that lies ahead in their
//! own direction and is turned as they are; chains of three and more are rows, their curve runs through
//! the middles.

use exurb_geom::{Polygon, Vec2, polyline, trig};

use super::groups::{Group, Kind, element};
use super::path::Path;
use crate::library::main_direction;

/// Elements of a row have gaps up to this many times their length.
const MOST_GAP: f64 = 1.5;
/// Neighbours in a row are turned alike to within this, in radians.
const TURN_RAD: f64 = 0.26;
/// The next element lies ahead to within this, in radians.
const AHEAD_RAD: f64 = 0.35;
/// Fewer elements make no row.
const LEAST: usize = 3;

/// The rows among `inner`, and what stands in none.
pub fn rows(inner: &[usize], polygons: &[Polygon]) -> (Vec<Group>, Vec<usize>) {
    let bodies: Vec<Body> = inner.iter().map(|i| Body::of(&polygons[*i])).collect();
    let chains = chains(&bodies);
    let mut out = Vec::new();
    let mut in_row = vec![false; bodies.len()];
    for chain in chains.into_iter().filter(|c| c.len() >= LEAST) {
        let Some(path) = curve(&chain, &bodies) else { continue };
        let elements = chain.iter().map(|k| {
            let corners = polyline::to_m(polygons[inner[*k]].exterior());
            let along = corners.iter().map(|p| path.project(*p));
            let span =
                along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), a| (l.min(a), h.max(a)));
            element(&path, vec![inner[*k]], Kind::Repeatable, span, polygons)
        });
        let elements = elements.collect();
        chain.iter().for_each(|k| in_row[*k] = true);
        out.push(Group { path, side: None, elements });
    }
    let singles = inner.iter().zip(in_row).filter(|(_, in_row)| !in_row).map(|(i, _)| *i).collect();
    (out, singles)
}

struct Body {
    middle: Vec2,
    angle_rad: f64,
    size_m: f64,
}

impl Body {
    fn of(polygon: &Polygon) -> Self {
        let sides = polygon.segments().map(|(a, b)| (a.to_m(), b.to_m()));
        let angle_rad = main_direction(sides);
        Self { middle: polygon.centroid(), angle_rad, size_m: polygon.area_m2().sqrt() }
    }

    /// Is `other` the next in a row, and how far away?
    fn ahead(&self, other: &Self) -> Option<f64> {
        let quarter = std::f64::consts::FRAC_PI_2;
        let off = |a: f64| (a - (a / quarter).round() * quarter).abs();
        let way = other.middle - self.middle;
        let distance = way.length();
        let alike = off(other.angle_rad - self.angle_rad) < TURN_RAD
            && off(trig::angle(way) - self.angle_rad) < AHEAD_RAD
            && self.size_m.max(other.size_m) < 2.5 * self.size_m.min(other.size_m);
        let near = distance < (1.0 + MOST_GAP) * (self.size_m + other.size_m) / 2.0;
        (alike && near).then_some(distance)
    }
}

/// Chains of elements, each linked to at most one on either side; nearest pairs are linked first.
fn chains(bodies: &[Body]) -> Vec<Vec<usize>> {
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for j in 0..bodies.len() {
        for i in 0..j {
            if let (Some(d), Some(_)) = (bodies[i].ahead(&bodies[j]), bodies[j].ahead(&bodies[i])) {
                pairs.push((d, i, j));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut links: Vec<Vec<usize>> = vec![Vec::new(); bodies.len()];
    let mut root: Vec<usize> = (0..bodies.len()).collect();
    let find = |root: &[usize], mut i: usize| {
        while root[i] != i {
            i = root[i];
        }
        i
    };
    for (_, i, j) in pairs {
        // A row goes on in the direction it came from.
        let goes_on = |here: usize, there: usize| match links[here][..] {
            [] => true,
            [other] => {
                let (u, v) = (
                    bodies[here].middle - bodies[other].middle,
                    bodies[there].middle - bodies[here].middle,
                );
                trig::angle_between(u, v) < 2.0 * AHEAD_RAD
            }
            _ => false,
        };
        let (a, b) = (find(&root, i), find(&root, j));
        if a != b && goes_on(i, j) && goes_on(j, i) {
            links[i].push(j);
            links[j].push(i);
            root[a.max(b)] = a.min(b);
        }
    }
    let mut seen = vec![false; bodies.len()];
    let mut out = Vec::new();
    for start in (0..bodies.len()).filter(|i| links[*i].len() <= 1) {
        let (mut chain, mut here) = (Vec::new(), start);
        while !seen[here] {
            seen[here] = true;
            chain.push(here);
            let next = links[here].iter().copied().find(|n| !seen[*n]);
            here = next.unwrap_or(here);
        }
        out.push(chain);
    }
    out.retain(|c| !c.is_empty());
    out
}

/// The line through the middles, carried on by half an element at both ends.
fn curve(chain: &[usize], bodies: &[Body]) -> Option<Path> {
    let mut line: Vec<Vec2> = chain.iter().map(|k| bodies[*k].middle).collect();
    let n = line.len();
    let ends = [(line[0], line[1], chain[0]), (line[n - 1], line[n - 2], chain[n - 1])];
    let [first, last] = ends
        .map(|(end, before, k)| end + (end - before).normalize_or_zero() * bodies[k].size_m * 0.7);
    line.insert(0, first);
    line.push(last);
    Path::new(line)
}

#[cfg(test)]
mod tests {
    use exurb_geom::GridPoint;

    use super::*;

    fn house(x: f64, y: f64) -> Polygon {
        Polygon::rectangle(GridPoint::m(x, y), GridPoint::m(x + 12.0, y + 9.0))
    }

    #[test]
    fn houses_in_line_are_a_row_and_one_apart_is_none() {
        let houses = [house(0., 0.), house(40., 1.), house(20., 0.), house(30., 60.)];
        let (rows, singles) = rows(&[0, 1, 2, 3], &houses);
        assert_eq!((rows.len(), singles), (1, vec![3]));
        let order: Vec<usize> = rows[0].elements.iter().map(|e| e.members[0]).collect();
        assert_eq!(order, [0, 2, 1]);
        assert!(rows[0].elements.iter().all(|e| e.rings[0].iter().any(|p| p.y < 0.0)));
    }
}
