//! Mean and variance of length and curvature of the streets of one role.
//!
//! Source: Nishida, Garcia-Dorado, Aliaga 2015, *Example-Driven Procedural Urban Roads*, section
//! 4.2: average and variance of length and curvature of the edges of each graph, curvature by
//! eq. (1). As in the authors' program the mean of the curvature is weighted by length and its
//! variance is not: it is taken over streets, around their unweighted mean. Departures: an edge runs
//! from junction to junction of the role's own graph whatever its class or layer on the way; edges
//! that the map's border cuts short count only when there are no others. O(n).

use exurb_city::{Role, StreetGraph, street_graph};
use exurb_geom::polyline;
use exurb_graph::NodeId;

/// What the streets of one role are like. All zero when there are none.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct StreetStatistics {
    /// Number of streets measured, each between two junctions or dead ends.
    pub count: usize,
    /// Their total length in metres.
    pub length_total_m: f64,
    /// Mean length in metres.
    pub length_mean_m: f64,
    /// Variance of the length in m².
    pub length_variance_m2: f64,
    /// Mean curvature in 1/m, weighted by length.
    pub curvature_mean: f64,
    /// Variance of the curvature in 1/m², each street once.
    pub curvature_variance: f64,
}

impl StreetStatistics {
    /// The statistics of draws from both, weighted `share` to `1 - share` (eq. 5).
    pub fn mixed(self, other: Self, share: f64) -> Self {
        let rest = 1.0 - share;
        let mean = |a: f64, b: f64| share * a + rest * b;
        let variance = |a: f64, b: f64| share * share * a + rest * rest * b;
        Self {
            count: self.count + other.count,
            length_total_m: mean(self.length_total_m, other.length_total_m),
            length_mean_m: mean(self.length_mean_m, other.length_mean_m),
            length_variance_m2: variance(self.length_variance_m2, other.length_variance_m2),
            curvature_mean: mean(self.curvature_mean, other.curvature_mean),
            curvature_variance: variance(self.curvature_variance, other.curvature_variance),
        }
    }
}

/// Statistics of the streets of `role`, on the graph of that role alone with its nodes of degree 2
/// dissolved.
pub fn street_statistics(graph: &StreetGraph, role: Role) -> StreetStatistics {
    let mut own = street_graph::subgraph(graph, |_, street| street.role() == role);
    let nodes: Vec<NodeId> = own.nodes().map(|(id, _)| id).collect();
    for node in nodes {
        if !own.node(node).data.cut {
            own.dissolve(node);
        }
    }
    let is_cut = |node: NodeId| own.node(node).data.cut;
    let measured = |with_cut: bool| -> Vec<(f64, f64)> {
        own.edges()
            .filter(|(_, e)| with_cut || !(is_cut(e.from) || is_cut(e.to)))
            .map(|(_, e)| {
                let line = e.line_m();
                (polyline::length(&line), polyline::curvature(&line))
            })
            .collect()
    };
    let whole = measured(false);
    of_samples(&if whole.is_empty() { measured(true) } else { whole })
}

/// From pairs of length and curvature.
fn of_samples(samples: &[(f64, f64)]) -> StreetStatistics {
    if samples.is_empty() {
        return StreetStatistics::default();
    }
    let lengths = samples.iter().map(|(length, _)| *length);
    let curvatures = samples.iter().map(|(_, curvature)| *curvature);
    let total: f64 = lengths.clone().sum();
    let (length_mean_m, length_variance_m2) = mean_and_variance(lengths);
    let (_, curvature_variance) = mean_and_variance(curvatures);
    StreetStatistics {
        count: samples.len(),
        length_total_m: total,
        length_mean_m,
        length_variance_m2,
        curvature_mean: samples.iter().map(|(length, c)| length * c).sum::<f64>() / total,
        curvature_variance,
    }
}

fn mean_and_variance(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let n = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / n;
    (mean, values.map(|v| (v - mean) * (v - mean)).sum::<f64>() / n)
}

#[cfg(test)]
mod tests {
    use exurb_city::{Class, Street};
    use exurb_geom::GridPoint;

    use super::*;

    fn streets(lines: &[(&[(f64, f64)], Class)]) -> StreetGraph {
        street_graph::from_lines(lines.iter().map(|(line, class)| {
            let points = line.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect();
            (points, Street { class: *class, ..Street::default() })
        }))
    }

    #[test]
    fn lengths_run_through_changes_of_class_and_past_other_roles() {
        let graph = streets(&[
            (&[(0., 0.), (100., 0.)], Class::Primary),
            (&[(100., 0.), (300., 0.)], Class::Secondary),
            (&[(100., 0.), (100., 50.)], Class::Residential),
        ]);
        let main = street_statistics(&graph, Role::Main);
        assert_eq!((main.count, main.length_mean_m, main.length_variance_m2), (1, 300.0, 0.0));
        assert_eq!(main.curvature_mean, 0.0);
        assert_eq!(street_statistics(&graph, Role::Local).length_total_m, 50.0);
        assert_eq!(street_statistics(&graph, Role::Other), StreetStatistics::default());
    }

    #[test]
    fn the_mean_of_the_curvature_is_weighted_by_length_and_its_variance_is_not() {
        // A right angle over 20 m has curvature √2 / 20; a straight street of 60 m has none.
        let graph = streets(&[
            (&[(0., 0.), (10., 0.), (10., 10.)], Class::Residential),
            (&[(0., 100.), (60., 100.)], Class::Residential),
        ]);
        let local = street_statistics(&graph, Role::Local);
        let bend = 2f64.sqrt() / 20.0;
        assert!((local.curvature_mean - bend / 4.0).abs() < 1e-12);
        assert!((local.curvature_variance - bend * bend / 4.0).abs() < 1e-12);
        assert!((local.length_variance_m2 - 400.0).abs() < 1e-9);
    }

    #[test]
    fn streets_cut_by_the_border_count_only_when_there_are_no_others() {
        let mut graph = streets(&[
            (&[(0., 0.), (10., 0.)], Class::Residential),
            (&[(0., 50.), (90., 50.)], Class::Residential),
        ]);
        let ends: Vec<NodeId> = graph.nodes().map(|(id, _)| id).collect();
        graph.node_mut(ends[0]).data.cut = true;
        assert_eq!(street_statistics(&graph, Role::Local).length_mean_m, 90.0);
        graph.node_mut(ends[2]).data.cut = true;
        assert_eq!(street_statistics(&graph, Role::Local).length_mean_m, 50.0);
    }
}
