//! Patches: what is copied in one piece (Nishida et al. 2015, section 4.1, algorithm 2).
//!
//! Detectors name groups of nodes that belong together; every group is expanded along chains shorter
//! than a threshold; what remains becomes a patch junction by junction. All chains that leave the
//! core join the patch: to dead ends as they are, to other patches as connectors, which two patches
//! share. The paper tests the length of single edges; as in the authors' program the test is the
//! distance along the street to the next junction.

use std::collections::VecDeque;
use std::sync::Arc;

use super::layer::{ChainEnd, Layer, NodeKind};

/// A patch of one layer.
#[derive(Clone, Debug)]
pub struct Patch {
    /// Nodes that make it up.
    pub core: Vec<usize>,
    /// Chains between core nodes.
    pub inner: Vec<usize>,
    /// Chains that leave the core, seen from there: connectors and dead ends.
    pub outer: Vec<ChainEnd>,
    /// Value of the `part` column of what is copied from it.
    pub label: Arc<str>,
}

/// A detector: from a layer to groups of its nodes that must stay together.
pub type Detector<'a> = &'a dyn Fn(&Layer) -> Vec<Vec<usize>>;

/// Divides `layer` into patches and notes in each node which one holds it. `reach_m` is the
/// threshold of algorithm 2. O(n) besides the detectors.
pub fn extract(layer: &mut Layer, detectors: &[Detector], reach_m: f64, name: &str) -> Vec<Patch> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for detector in detectors {
        groups.extend(detector(layer));
    }
    // Every junction of three streets and more that no detector claimed, in order.
    let junction =
        |n: &usize| layer.nodes[*n].kind == NodeKind::Junction && layer.nodes[*n].ends.len() > 2;
    groups.extend((0..layer.nodes.len()).filter(junction).map(|n| vec![n]));
    // Then what is left: ends where a street of this layer becomes one of the other.
    let rest = |n: &usize| layer.nodes[*n].kind == NodeKind::Junction;
    groups.extend((0..layer.nodes.len()).filter(rest).map(|n| vec![n]));

    let mut patches = Vec::new();
    for group in groups {
        let core = expand(layer, group, reach_m, patches.len());
        if !core.is_empty() {
            let label = format!("{name} {}", patches.len() + 1).into();
            patches.push(assemble(layer, core, label));
        }
    }
    patches
}

/// Algorithm 2, `Expand`: the free nodes of `group` and what lies within reach of them.
fn expand(layer: &mut Layer, group: Vec<usize>, reach_m: f64, patch: usize) -> Vec<usize> {
    let mut core = Vec::new();
    let mut queue: VecDeque<usize> = VecDeque::new();
    for node in group {
        if layer.nodes[node].patch.is_none() {
            layer.nodes[node].patch = Some(patch);
            queue.push_back(node);
        }
    }
    while let Some(node) = queue.pop_front() {
        core.push(node);
        for end in layer.nodes[node].ends.clone() {
            let next = layer.head(end);
            let near = layer.chains[end.chain].length_m < reach_m;
            let free = layer.nodes[next].patch.is_none();
            if near && free && layer.nodes[next].kind == NodeKind::Junction {
                layer.nodes[next].patch = Some(patch);
                queue.push_back(next);
            }
        }
    }
    core.sort_unstable();
    core
}

fn assemble(layer: &Layer, core: Vec<usize>, label: Arc<str>) -> Patch {
    let (mut inner, mut outer) = (Vec::new(), Vec::new());
    for &node in &core {
        for &end in &layer.nodes[node].ends {
            if core.binary_search(&layer.head(end)).is_err() {
                outer.push(end);
            } else if end.forward {
                inner.push(end.chain);
            }
        }
    }
    inner.sort_unstable();
    inner.dedup();
    Patch { core, inner, outer, label }
}

/// Is the chain's far end a real dead end?
pub fn is_dead_end(layer: &Layer, end: ChainEnd) -> bool {
    layer.nodes[layer.head(end)].kind == NodeKind::DeadEnd
}
