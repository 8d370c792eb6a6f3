use super::*;

fn line(points: &[(f64, f64)], level: i32) -> Line<()> {
    Line { points: points.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect(), level, data: () }
}

#[test]
fn a_crossing_on_one_level_makes_four_pieces() {
    let cross = vec![line(&[(-5., 0.), (5., 0.)], 0), line(&[(0., -5.), (0., 5.)], 0)];
    assert_eq!(node(cross, Options::default()).len(), 4);
}

#[test]
fn a_bridge_passes_over() {
    let cross = vec![line(&[(-5., 0.), (5., 0.)], 0), line(&[(0., -5.), (0., 5.)], 1)];
    assert_eq!(node(cross, Options::default()).len(), 2);
}

#[test]
fn shared_inner_vertices_and_touching_ends_split() {
    let shared =
        vec![line(&[(-5., 0.), (0., 0.), (5., 0.)], 0), line(&[(0., -5.), (0., 0.), (0., 5.)], 0)];
    assert_eq!(node(shared, Options::default()).len(), 4);
    let tee = vec![line(&[(-5., 0.), (5., 0.)], 0), line(&[(0., 5.), (0., 0.)], 0)];
    assert_eq!(node(tee, Options::default()).len(), 3);
}

#[test]
fn a_near_miss_is_joined_when_asked() {
    let tee = || vec![line(&[(-5., 0.), (5., 0.)], 0), line(&[(0., 5.), (0., 0.04)], 0)];
    assert_eq!(node(tee(), Options::default()).len(), 2);
    assert_eq!(node(tee(), Options { snap_m: 0.05, ..Options::default() }).len(), 3);
}

#[test]
fn a_line_that_crosses_itself_falls_into_pieces() {
    let eight = vec![line(&[(0., 0.), (10., 10.), (10., 0.), (0., 10.)], 0)];
    assert_eq!(node(eight, Options::default()).len(), 3);
}

#[test]
fn after_noding_nothing_crosses() {
    // A fan of odd slopes: every crossing is rounded.
    let fan: Vec<_> = (0..40)
        .map(|i| {
            let i = f64::from(i);
            line(&[(i * 7.3, (i * 13.7) % 29.0), (280.0 - i * 6.1, 300.0 + (i * 5.3) % 31.0)], 0)
        })
        .collect();
    let noded = node(fan, Options::default());
    let segments: Vec<_> = noded.iter().flat_map(|l| l.points.windows(2)).collect();
    for (i, s) in segments.iter().enumerate() {
        for t in &segments[i + 1..] {
            assert!(!grid::cross_properly(s[0], s[1], t[0], t[1]), "{s:?} {t:?}");
        }
    }
}

#[test]
fn vertices_beside_each_other_become_one() {
    let bent = vec![line(&[(-5., 0.), (0., 0.)], 0), line(&[(0.01, 0.), (5., 3.)], 0)];
    let noded = node(bent, Options { snap_m: 0.02, ..Options::default() });
    assert_eq!(noded.len(), 2);
    assert_eq!(noded[0].points[1], noded[1].points[0]);
}

#[test]
fn a_fold_is_split_at_its_tip_and_a_straight_line_is_not() {
    assert_eq!(node(vec![line(&[(0., 0.), (9., 0.), (0., 0.)], 0)], Options::default()).len(), 2);
    assert_eq!(node(vec![line(&[(0., 0.), (9., 0.), (4., 0.)], 0)], Options::default()).len(), 3);
    assert_eq!(node(vec![line(&[(0., 0.), (4., 0.), (9., 0.)], 0)], Options::default()).len(), 1);
}
