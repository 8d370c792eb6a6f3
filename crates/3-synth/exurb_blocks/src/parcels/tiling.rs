//! Ground cut along lines into faces, each with an owner: joined and given back as polygons that
//! share their borders exactly.
//!
//! Everything is one planar graph on the millimetre grid, so that what lies on one side of a border
//! is exactly what the other side lacks.

use std::collections::BTreeMap;

use exurb_geom::{GridPoint, Polygon, RowSides, Vec2, polyline};
use exurb_graph::{EdgeId, FaceId, Faces, Graph, NodeId, noding};

/// Borders that run along walls for long cross them at every bend: they are noded in so many rounds at most.
const MOST_ROUNDS: usize = 64;

/// Faces of a cut ground, grouped into pieces.
pub struct Tiling {
    graph: Graph<(), ()>,
    faces: Faces,
    /// Piece of every face; `None` in the ground's holes.
    piece: Vec<Option<usize>>,
    /// Owner, area and frontage of every piece; empty pieces were joined to another.
    pieces: Vec<Piece>,
}

/// Connected faces of one owner.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Piece {
    /// Who owns it.
    pub owner: u32,
    /// Its area in m²; 0 when it was joined to another piece.
    pub area_m2: f64,
    /// Length of its border with the outside in metres.
    pub frontage_m: f64,
}

impl Tiling {
    /// `ground` cut along `lines`; `owner` tells whose the face around a point is.
    pub fn of(ground: &Polygon, lines: &[Vec<Vec2>], owner: impl Fn(Vec2) -> u32) -> Self {
        let closed = ground.rings().map(|ring| {
            let mut points = ring.to_vec();
            points.push(ring[0]);
            points
        });
        let cuts = lines.iter().map(|l| polyline::round(l)).filter(|l| l.len() > 1);
        let linework =
            closed.chain(cuts).map(|points| noding::Line { points, level: 0, data: () }).collect();
        let options = noding::Options { max_rounds: MOST_ROUNDS, ..noding::Options::default() };
        let graph = graph_of(noding::node(linework, options));
        let faces = Faces::of(&graph, |_| true);
        let inside = RowSides::new(ground);
        let owners: Vec<Option<u32>> = faces
            .list
            .iter()
            .map(|face| {
                let p = face.polygon.interior_point();
                inside.contains(GridPoint::round(p)).then(|| owner(p))
            })
            .collect();
        let (piece, pieces) = connected(&graph, &faces, &owners);
        Self { graph, faces, piece, pieces }
    }

    /// The pieces that are left.
    pub fn pieces(&self) -> impl Iterator<Item = (usize, Piece)> + '_ {
        self.pieces.iter().copied().enumerate().filter(|(_, p)| p.area_m2 > 0.0)
    }

    /// Joins the smallest piece for which `wanting` holds to a neighbour, until there is none that
    /// has one. The neighbour with the longest shared border takes it, those for which `wanting`
    /// holds, too, come last.
    pub fn join(&mut self, wanting: impl Fn(&Piece) -> bool) {
        let mut alone = vec![false; self.pieces.len()];
        // The edges around each piece; those that come to lie inside stay listed.
        let mut edges = vec![Vec::new(); self.pieces.len()];
        for (id, _) in self.graph.edges() {
            let (a, b) = self.beside(id);
            for piece in [a, b.filter(|_| a != b)].into_iter().flatten() {
                edges[piece].push(id);
            }
        }
        loop {
            let smallest = self
                .pieces()
                .filter(|(i, p)| !alone[*i] && wanting(p))
                .min_by(|a, b| a.1.area_m2.total_cmp(&b.1.area_m2).then(a.0.cmp(&b.0)));
            let Some((small, _)) = smallest else { return };
            let shared = self.shared_borders(small, &edges[small]);
            let taker = shared.iter().max_by(|a, b| {
                let fit = |i: usize| !wanting(&self.pieces[i]);
                fit(*a.0).cmp(&fit(*b.0)).then(a.1.total_cmp(b.1)).then(b.0.cmp(a.0))
            });
            match taker {
                Some((taker, _)) => {
                    self.give(small, *taker);
                    let given = std::mem::take(&mut edges[small]);
                    edges[*taker].extend(given);
                    // In order, so that lengths sum up the same however pieces came together.
                    edges[*taker].sort_unstable();
                }
                None => alone[small] = true,
            }
        }
    }

    /// The polygons of the pieces, with owner and frontage, by piece.
    pub fn polygons(&self) -> Vec<(Polygon, Piece)> {
        let border = |id: EdgeId| {
            let (a, b) = self.beside(id);
            a != b
        };
        let mut found: Vec<(usize, Polygon)> = Faces::of(&self.graph, border)
            .list
            .into_iter()
            .filter_map(|face| {
                let dart = face.outline.first()?;
                let piece = self.piece_of(self.faces.left[dart.index()])?;
                Some((piece, face.polygon))
            })
            .collect();
        found.sort_by_key(|(piece, _)| *piece);
        found.into_iter().map(|(piece, polygon)| (polygon, self.pieces[piece])).collect()
    }

    fn piece_of(&self, face: Option<FaceId>) -> Option<usize> {
        self.piece[face?.0 as usize]
    }

    /// The pieces on both sides of an edge.
    fn beside(&self, id: EdgeId) -> (Option<usize>, Option<usize>) {
        let side = |dart: exurb_graph::Dart| self.piece_of(self.faces.left[dart.index()]);
        (side(id.forward()), side(id.backward()))
    }

    /// Length of the border with each neighbouring piece, of the edges around a piece.
    fn shared_borders(&self, piece: usize, edges: &[EdgeId]) -> BTreeMap<usize, f64> {
        let mut shared = BTreeMap::new();
        for id in edges {
            let (a, b) = self.beside(*id);
            let other = if a == Some(piece) { b } else { a };
            if (a == Some(piece) || b == Some(piece)) && a != b {
                *shared.entry(other).or_insert(0.0) += self.graph.edge(*id).length_m();
            }
        }
        shared.into_iter().filter_map(|(other, length)| Some((other?, length))).collect()
    }

    fn give(&mut self, from: usize, to: usize) {
        for piece in self.piece.iter_mut().filter(|p| **p == Some(from)) {
            *piece = Some(to);
        }
        let given = std::mem::take(&mut self.pieces[from]);
        self.pieces[to].area_m2 += given.area_m2;
        self.pieces[to].frontage_m += given.frontage_m;
    }
}

fn graph_of(lines: Vec<noding::Line<()>>) -> Graph<(), ()> {
    let mut graph = Graph::new();
    let mut at: BTreeMap<GridPoint, NodeId> = BTreeMap::new();
    let mut seen = std::collections::BTreeSet::new();
    for line in lines {
        let (Some(&first), Some(&last)) = (line.points.first(), line.points.last()) else {
            continue;
        };
        let mut key = line.points.clone();
        if key.iter().rev().lt(key.iter()) {
            key.reverse();
        }
        if !seen.insert(key) {
            continue;
        }
        let mut node = |p| *at.entry(p).or_insert_with(|| graph.add_node(p, ()));
        let (from, to) = (node(first), node(last));
        graph.add_edge(from, to, line.points, ());
    }
    graph
}

/// Groups faces of one owner that share a border.
fn connected(
    graph: &Graph<(), ()>,
    faces: &Faces,
    owners: &[Option<u32>],
) -> (Vec<Option<usize>>, Vec<Piece>) {
    let mut root: Vec<usize> = (0..owners.len()).collect();
    fn find(root: &mut [usize], mut i: usize) -> usize {
        while root[i] != i {
            root[i] = root[root[i]];
            i = root[i];
        }
        i
    }
    let side = |dart: exurb_graph::Dart| faces.left[dart.index()].map(|f| f.0 as usize);
    for (id, _) in graph.edges() {
        if let (Some(a), Some(b)) = (side(id.forward()), side(id.backward()))
            && owners[a] == owners[b]
        {
            let (a, b) = (find(&mut root, a), find(&mut root, b));
            root[a.max(b)] = a.min(b);
        }
    }
    let piece: Vec<Option<usize>> =
        (0..owners.len()).map(|i| owners[i].map(|_| find(&mut root, i))).collect();
    let mut pieces = vec![Piece::default(); owners.len()];
    for (i, owner) in owners.iter().enumerate() {
        if let (Some(owner), Some(p)) = (owner, piece[i]) {
            pieces[p].owner = *owner;
            pieces[p].area_m2 += faces.list[i].polygon.area_m2();
        }
    }
    for (id, edge) in graph.edges() {
        let inside = |dart| side(dart).and_then(|f| piece[f]);
        match (inside(id.forward()), inside(id.backward())) {
            (Some(p), None) | (None, Some(p)) => pieces[p].frontage_m += edge.length_m(),
            _ => {}
        }
    }
    (piece, pieces)
}
