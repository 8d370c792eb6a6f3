use exurb_geom::{GridPoint, Polygon};

use super::{Correspondence, Settings, Source};

fn ring(corners: &[(f64, f64)]) -> Vec<GridPoint> {
    corners.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect()
}

fn house(x: f64, y: f64, w: f64, d: f64) -> Polygon {
    Polygon::rectangle(GridPoint::m(x, y), GridPoint::m(x + w, y + d))
}

/// A block of 120 m by 70 m with a tight row below, detached houses above, and corner buildings.
fn block() -> (Vec<GridPoint>, Vec<Polygon>) {
    let outline = ring(&[(0., 0.), (120., 0.), (120., 70.), (0., 70.)]);
    let mut houses = vec![];
    let widths = [11.0, 9.0, 12.5, 10.0, 8.0, 13.0, 9.5, 10.5, 11.5];
    let mut x = 12.0;
    for w in widths {
        houses.push(house(x, 3.0, w, 11.0));
        x += w;
    }
    houses.extend([house(3., 3., 9., 14.), house(x, 3., 10., 14.)]);
    for k in 0..5 {
        houses.push(house(14.0 + 20.0 * f64::from(k), 56.0, 10.0, 9.0));
    }
    (outline, houses)
}

#[test]
fn an_undeformed_layout_comes_back() {
    let (outline, houses) = block();
    let settings = Settings::default();
    let source = Source::of(&outline, houses.clone(), &[], &settings);
    let domain = Polygon::new(outline.clone(), vec![]).expect("has area");
    let link = Correspondence::by_vertices(&outline, &outline).expect("vertices stayed");
    let placed = source.retarget(&domain, &outline, &link, &settings);
    let mut seen = vec![0; houses.len()];
    for placement in &placed {
        for member in &placement.members {
            seen[*member] += 1;
            let at = houses[*member].centroid();
            let moved = placement.motion.apply(at);
            assert!(moved.distance(at) < 0.01, "{member} {at} {moved}");
        }
    }
    assert!(seen.iter().all(|n| *n == 1), "{seen:?}");
}
