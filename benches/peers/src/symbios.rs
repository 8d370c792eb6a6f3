//! symbios-tensor on flat land: streets, rationalised, of 2 km x 2 km at its default spacing.
//! Prints kilometres and seconds as JSON.

use std::time::Instant;

use symbios_ground::HeightMap;
use symbios_tensor::{
    RationalizeConfig, TensorConfig, extract_blocks, generate_roads, rationalize_graph,
};

fn main() {
    let land = HeightMap::new(500, 500, 4.0);
    let started = Instant::now();
    let mut graph = generate_roads(&land, &TensorConfig::default()).expect("the defaults are valid");
    rationalize_graph(&mut graph, &land, &RationalizeConfig::default());
    extract_blocks(&mut graph);
    let seconds = started.elapsed().as_secs_f64();
    let active = graph.edges.iter().filter(|edge| edge.active);
    let metres: f32 =
        active.map(|edge| graph.node_pos(edge.start).distance(graph.node_pos(edge.end))).sum();
    println!("{{\"km\": {:.1}, \"seconds\": {seconds:.3}}}", metres / 1000.0);
}
