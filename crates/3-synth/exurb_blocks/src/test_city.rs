//! Cities for tests: a grid of streets, built on in one style or another.

use std::sync::Arc;

use exurb_city::{
    Area, Building, City, Class, Junction, Origin, Provenance, Street, StreetGraph, block,
};
use exurb_geom::{Frame, GridPoint, Polygon, Vec2, trig};

/// How the blocks of a grid are built on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Nothing stands.
    Empty,
    /// Houses 16 m wide and 12 m deep share walls all around every block, 3 m behind the kerb.
    Rows,
    /// Houses of 10 m by 9 m, 8 m apart, 7 m behind the kerb.
    Detached,
}

/// A city of `columns` by `rows` blocks of `block_m` between street centrelines.
pub fn grid(columns: u32, rows: u32, block_m: Vec2, style: Style) -> City {
    let size = block_m * Vec2::new(f64::from(columns), f64::from(rows));
    let target =
        Polygon::rectangle(GridPoint::m(-1.0, -1.0), GridPoint::m(size.x + 1.0, size.y + 1.0));
    let mut city = City::empty(Frame::null_island(), target);
    city.streets = Arc::new(streets(columns, rows, block_m));
    city.blocks = Arc::new(block::derive(&city.streets));
    city.metadata.name = "grid".into();
    city.metadata.buildings_complete = style != Style::Empty;
    let mut buildings = Vec::new();
    if style != Style::Empty {
        for block in city.blocks.iter() {
            let bounds = block.polygon.bounds();
            around(bounds.min, bounds.max, style, &mut buildings);
        }
    }
    city.buildings = Arc::new(
        buildings
            .into_iter()
            .zip(1..)
            .map(|(p, id)| Building::new(id, p, Provenance::of(Origin::Imported)))
            .collect(),
    );
    city
}

/// A grid whose every `each`-th block is a park.
pub fn with_parks(mut city: City, each: usize) -> City {
    let parks = city.blocks.iter().step_by(each).zip(1..);
    let areas: Vec<Area> = parks
        .map(|(b, id)| Area { id, polygon: b.polygon.clone(), class: "park".into() })
        .collect();
    let free = |b: &&Building| {
        let p = GridPoint::round(b.polygon.centroid());
        !areas.iter().any(|a| a.polygon.contains(p))
    };
    city.buildings = Arc::new(city.buildings.iter().filter(free).cloned().collect());
    city.land_use = Arc::new(areas);
    city
}

fn streets(columns: u32, rows: u32, block_m: Vec2) -> StreetGraph {
    let mut graph = StreetGraph::new();
    let mut node = Vec::new();
    for j in 0..=rows {
        for i in 0..=columns {
            let p = block_m * Vec2::new(f64::from(i), f64::from(j));
            node.push(graph.add_node(GridPoint::round(p), Junction::default()));
        }
    }
    let at = |i: u32, j: u32| (j * (columns + 1) + i) as usize;
    let street = || Street { class: Class::Residential, ..Street::default() };
    for j in 0..=rows {
        for i in 0..=columns {
            if i < columns {
                graph.add_edge(node[at(i, j)], node[at(i + 1, j)], Vec::new(), street());
            }
            if j < rows {
                graph.add_edge(node[at(i, j)], node[at(i, j + 1)], Vec::new(), street());
            }
        }
    }
    graph
}

/// Houses along the four kerbs of a rectangular block.
fn around(low: Vec2, high: Vec2, style: Style, out: &mut Vec<Polygon>) {
    let (width, depth, gap, setback) = match style {
        Style::Detached => (10.0, 9.0, 8.0, 7.0),
        _ => (16.0, 12.0, 0.0, 3.0),
    };
    let (low, high) = (low + setback, high - setback);
    let size = high - low;
    let count = |length: f64| ((length - gap) / (width + gap)).floor().max(1.0);
    // Long rows below and above, the short ones between them.
    let n = count(size.x);
    let pitch = size.x / n;
    for i in 0..n as u32 {
        let x = low.x + pitch * f64::from(i);
        let (from, to) = if gap == 0.0 { (x, x + pitch) } else { (x, x + width) };
        for (y, top) in [(low.y, low.y + depth), (high.y - depth, high.y)] {
            out.push(Polygon::rectangle(GridPoint::m(from, y), GridPoint::m(to, top)));
        }
    }
    let rest = size.y - 2.0 * depth - 2.0 * gap;
    if rest < width {
        return;
    }
    let n = count(rest);
    let pitch = rest / n;
    for i in 0..n as u32 {
        let y = low.y + depth + gap + pitch * f64::from(i);
        let top = if gap == 0.0 { y + pitch } else { y + width };
        for (x, to) in [(low.x, low.x + depth), (high.x - depth, high.x)] {
            out.push(Polygon::rectangle(GridPoint::m(x, y), GridPoint::m(to, top)));
        }
    }
}

/// Blocks of many shapes: rectangles, triangles, slivers, stars, bent strips, with holes, notched by
/// dead ends. The same for equal numbers.
pub fn odd_block(number: u32) -> Option<Polygon> {
    let k = f64::from(number);
    let wave = |f: f64, low: f64, high: f64| low + (high - low) * ((k * f).fract());
    let ring = |points: &[(f64, f64)]| -> Vec<GridPoint> {
        let turn = trig::unit(wave(0.377, 0.0, 6.0));
        points.iter().map(|(x, y)| GridPoint::round(turn.rotate(Vec2::new(*x, *y)))).collect()
    };
    let (w, h) = (wave(0.618, 8.0, 260.0), wave(0.414, 6.0, 180.0));
    let star = |n: u32, deep: f64| -> Vec<(f64, f64)> {
        (0..n)
            .map(|i| {
                let r = if i % 2 == 0 { w } else { w * deep };
                let p = trig::unit(f64::from(i) * std::f64::consts::TAU / f64::from(n)) * r;
                (p.x, p.y)
            })
            .collect()
    };
    let rectangle = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)];
    match number % 9 {
        0 => Polygon::new(ring(&rectangle), vec![]),
        1 => Polygon::new(ring(&[(0.0, 0.0), (w, 0.0), (wave(0.77, 0.0, w), h)]), vec![]),
        2 => Polygon::new(ring(&[(0.0, 0.0), (w * 2.0, 0.0), (w * 2.0, 0.8), (0.0, 1.5)]), vec![]),
        3 => Polygon::new(ring(&star(10, wave(0.29, 0.4, 0.9))), vec![]),
        4 => {
            let l =
                [(0.0, 0.0), (w, 0.0), (w, h * 0.4), (w * 0.4, h * 0.4), (w * 0.4, h), (0.0, h)];
            Polygon::new(ring(&l), vec![])
        }
        5 => {
            let hole =
                [(0.3, 0.3), (0.6, 0.3), (0.6, 0.7), (0.3, 0.7)].map(|(x, y)| (x * w, y * h));
            Polygon::new(ring(&rectangle), vec![ring(&hole)])
        }
        6 => {
            // A bent strip, as between two curved streets.
            let arc = |r: f64| {
                (0..=12).map(move |i| trig::unit(f64::from(i) * 0.15) * r).map(|p| (p.x, p.y))
            };
            let mut points: Vec<(f64, f64)> = arc(200.0 + h).collect();
            points.extend(arc(200.0).collect::<Vec<_>>().into_iter().rev());
            Polygon::new(ring(&points), vec![])
        }
        7 => {
            let block = Polygon::new(ring(&rectangle), vec![])?;
            let middle = block.centroid();
            let corner = block.exterior()[0].to_m();
            let line = [corner, corner.lerp(middle, 0.5), middle + Vec2::new(h * 0.1, 0.0)];
            let cap = exurb_geom::offset::Cap::Round;
            let road = exurb_geom::offset::carriageway(&line, 3.0, cap);
            exurb_geom::overlay::difference(&block, &road).into_iter().next()
        }
        _ => Polygon::new(ring(&star(24, 0.98)), vec![]),
    }
}
