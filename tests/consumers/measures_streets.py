"""measures_streets.py MEASURED.json: momepy, OSMnx and networkx measure streets and blocks alike.

Both sides see the same streets, cut to a window and cleaned. Where a definition differs from that
of the other program, a comment says how, and the check is of what follows from it.
"""

import sys
import warnings

import geopandas
import momepy
import networkx
import numpy as np
import osmnx
import shapely
from agree import load, same, same_aspects, same_in_order

SIDE_M = {"cell": 500.0, "window": 1000.0}
STEP_M = 250.0


class Streets:
    """The streets of one window as the other programs want them."""

    def __init__(self, city):
        self.city = city
        self.window = shapely.box(*city["window"])
        self.at = {n: np.array([x, y]) for n, x, y, _ in city["nodes"]}
        self.cut = {n for n, _, _, cut in city["nodes"] if cut}
        lines = [shapely.LineString(line) for _, _, line in city["edges"]]
        self.lines = geopandas.GeoDataFrame(
            {"u": [e[0] for e in city["edges"]], "v": [e[1] for e in city["edges"]]},
            geometry=lines,
            crs="EPSG:32633",
        )
        self.graph = networkx.MultiGraph(crs="EPSG:32633")
        for node, (x, y) in self.at.items():
            self.graph.add_node(node, x=x, y=y)
        lengths = self.lines.length
        for (u, v), length in zip(self.lines[["u", "v"]].itertuples(index=False), lengths):
            self.graph.add_edge(u, v, length=length)
        # momepy counts degrees, OSMnx streets.
        self.graph = momepy.node_degree(self.graph)
        streets = osmnx.stats.count_streets_per_node(networkx.MultiDiGraph(self.directed()))
        networkx.set_node_attributes(self.graph, streets, "street_count")
        whole = ~self.lines["u"].isin(self.cut) & ~self.lines["v"].isin(self.cut)
        self.whole = self.lines[whole]
        self.ends = [n for n in self.graph if n not in self.cut]
        self.junctions = [n for n in self.ends if self.graph.nodes[n]["degree"] >= 3]

    def directed(self):
        """One directed edge a street, as OSMnx reads oneways."""
        directed = networkx.MultiDiGraph(crs=self.graph.graph["crs"])
        directed.add_nodes_from(self.graph.nodes(data=True))
        directed.add_edges_from(self.graph.edges(data=True))
        return directed

    def edge_m(self, node):
        """Distance of a node from the window's border."""
        (x, y), (x0, y0, x1, y1) = self.at[node], self.city["window"]
        return min(x - x0, y - y0, x1 - x, y1 - y)

    def squares(self, kind):
        """South-west corners of the squares of a kind, row by row."""
        x0, y0, x1, y1 = self.city["window"]
        steps = lambda length: int((length - SIDE_M[kind] + 1e-3) // STEP_M) + 1
        for row in range(steps(y1 - y0)):
            for column in range(steps(x1 - x0)):
                yield np.array([x0 + column * STEP_M, y0 + row * STEP_M])

    def inside(self, corner, kind):
        """All nodes but cut ends in a square."""
        top = corner + SIDE_M[kind]
        return [n for n in self.ends if (self.at[n] >= corner).all() and (self.at[n] < top).all()]

    def ours(self, measure):
        return self.city["measures"][measure]["values"]


def segments(s):
    same("seg_length", s.ours("seg_length"), np.log10(np.maximum(s.whole.length, 1.0)))
    total = osmnx.stats.edge_length_total(s.graph)
    same_in_order("total length, OSMnx", s.lines.length.sum(), total)

    # momepy's linearity is chord by length. Here: its inverse less 1, not above 1, and only of
    # streets with over 5 m between their ends.
    chords = shapely.distance(
        shapely.get_point(s.whole.geometry.array, 0), shapely.get_point(s.whole.geometry.array, -1)
    )
    linearity = momepy.linearity(s.whole)[chords > 5.0]
    same("seg_sinuosity", np.add(s.ours("seg_sinuosity"), 1), np.minimum(1 / linearity, 2.0))

    # momepy sums the cul-de-sacs around a node. One step around a dead end that is its own street
    # alone. Cut ends are dead ends there.
    own = networkx.MultiGraph()
    own.add_nodes_from(s.graph.nodes(data=True))
    for u, v, length in s.graph.edges(data="length"):
        if u != v:
            own.add_edge(u, v, mm_len=length)
    own = momepy.cds_length(own, radius=1, verbose=False)
    dead_ends = [n for n in s.ends if s.graph.nodes[n]["degree"] == 1]
    cut_off = {n for n in dead_ends for m in own[n] if m in s.cut}
    alone = {n for n in dead_ends for m in own[n] if own.degree(m) == 1}
    lengths = [own.nodes[n]["cds_len"] for n in dead_ends if n not in cut_off and n not in alone]
    same("deadend_length", s.ours("deadend_length"), np.log10(np.maximum(lengths, 1.0)))


def nodes(s):
    degrees = [s.graph.nodes[n]["degree"] for n in s.ends]
    counts = [sum(min(max(d, 1), 5) == k for d in degrees) for k in range(1, 6)]
    assert counts == s.city["degrees"], f"node_degree: {s.city['degrees']} here, {counts} there"
    streets = osmnx.stats.streets_per_node(s.graph)
    assert all(streets[n] == s.graph.nodes[n]["degree"] for n in s.ends)
    print(f"node_degree: {counts} by momepy and OSMnx")

    shares, mesh, junctions, dead_ends = [], [], [], []
    for corner in s.squares("window"):
        inside = s.inside(corner, "window")
        if len(inside) <= 10:
            continue
        crossings = [s.graph.nodes[n]["degree"] for n in inside if n in set(s.junctions)]
        if crossings:
            # momepy's proportion and OSMnx's divide by all nodes, dead ends among them.
            shares.append(np.mean([d >= 4 for d in crossings]))
        # momepy's meshedness around a node takes what can be walked to; here a square is cut out.
        mesh.append(momepy.meshedness(s.graph.subgraph(inside), radius=None))
    same("fourway_share_1km", s.ours("fourway_share_1km"), shares)
    same("meshedness_1km", s.ours("meshedness_1km"), mesh)
    for corner in s.squares("cell"):
        cell = s.graph.subgraph(s.inside(corner, "cell"))
        junctions.append(osmnx.stats.intersection_count(cell, min_streets=3) / 0.25)
        counts = osmnx.stats.streets_per_node_counts(cell)
        dead_ends.append(counts.get(1, 0) / 0.25)
    same("density_junction", s.ours("density_junction"), junctions)
    same("density_deadend", s.ours("density_deadend"), dead_ends)


def directions(s):
    pieces = np.array(s.city["pieces"])
    lengths = np.hypot(*(pieces[:, 2:] - pieces[:, :2]).T)
    assert lengths.max() <= 25.0 + 1e-6
    same_in_order("length of pieces", lengths.sum(), s.lines.length.sum())
    middles = (pieces[:, :2] + pieces[:, 2:]) / 2
    bearings = np.degrees(np.arctan2(*(pieces[:, 2:] - pieces[:, :2]).T)) % 360

    # OSMnx takes an edge from end to end; here every street is taken in pieces of up to 25 m.
    orders = []
    for corner in s.squares("window"):
        inside = ((middles >= corner) & (middles < corner + 1000.0)).all(axis=1)
        if lengths[inside].sum() <= 1000.0:
            continue
        graph = networkx.MultiGraph(crs="EPSG:4326")
        for i in np.flatnonzero(inside):
            graph.add_edge(2 * i, 2 * i + 1, length=lengths[i], bearing=bearings[i])
        entropy = osmnx.orientation_entropy(graph, num_bins=36, weight="length")
        share = (entropy - np.log(4)) / (np.log(36) - np.log(4))
        orders.append(1 - share**2)
    same("order_phi_1km", s.ours("order_phi_1km"), orders)

    # The plain histogram: 36 bins over half a circle, which OSMnx has not, smoothed.
    turned = [np.diff(shapely.get_coordinates(line), axis=0) for line in s.lines.geometry]
    turned = np.concatenate(turned)
    angles = np.degrees(np.arctan2(turned[:, 1], turned[:, 0])) % 180
    bins, _ = np.histogram(angles, bins=36, range=(0, 180), weights=np.hypot(*turned.T))
    bins /= bins.sum()
    smooth = np.roll(bins, 1) / 4 + bins / 2 + np.roll(bins, -1) / 4
    same_in_order("bearing_hist", s.city["bearings"], smooth)

    # OSMnx divides the length of edges by an area, of whole edges. Here a piece of up to 25 m counts
    # where its middle lies: cutting the streets at the cell's border gives the same but for half a
    # piece at every crossing of the border.
    for ours, corner in zip(s.ours("density_length"), s.squares("cell")):
        cell = shapely.box(*corner, *(corner + 500.0))
        crossings = s.lines.intersection(cell.exterior)
        crossings = shapely.get_num_geometries(crossings[~crossings.is_empty]).sum()
        exact = s.lines.intersection(cell).length.sum() / 1000 / 0.25
        assert abs(ours - exact) <= 12.5 * crossings / 1000 / 0.25 + 1e-6, f"{ours} {exact}"
    print("density_length agrees with streets cut at the border, within half a piece a crossing")


def paths(s):
    x0, y0, x1, y1 = s.city["window"]
    margin = min(500.0, 0.2 * min(x1 - x0, y1 - y0))
    inner = lambda nodes: [n for n in nodes if s.edge_m(n) >= margin]
    sources = inner(s.junctions)
    assert 0 < len(inner(s.ends)) <= 300, f"{len(inner(s.ends))} sources: choose a smaller window"

    reach = []
    for source in sources:
        # networkx's ego_graph takes whole edges; here an edge counts as far as it is reached.
        to = networkx.single_source_dijkstra_path_length(s.graph, source, weight="length")
        left = {n: 500.0 - d for n, d in to.items() if d < 500.0}
        reach.append(
            sum(
                min(length, left.get(u, 0.0) + left.get(v, 0.0))
                for u, v, length in s.graph.edges(left, data="length")
            )
            / 1000
        )
    same("reach_500m", s.ours("reach_500m"), reach)

    # momepy's straightness is the mean of straight by network distance, over all nodes.
    for low, high in ((150.0, 500.0), (500.0, 1200.0)):
        detours = []
        for source in inner(s.ends):
            to = networkx.single_source_dijkstra_path_length(s.graph, source, weight="length")
            straight = {n: np.hypot(*(s.at[n] - s.at[source])) for n in s.ends if n != source}
            for n, metres in straight.items():
                if low <= metres < high:
                    along = to.get(n, np.inf)
                    along = along if along <= 2500.0 else 2500.0
                    detours.append(min(along / metres, 4.0))
        same(f"detour_{low:.0f}_{high:.0f}m", s.ours(f"detour_{low:.0f}_{high:.0f}m"), detours)

    # momepy's local betweenness takes all pairs of an ego graph. Here: paths from the sources, of up
    # to 1 km, which networkx counts in the ego graph of each.
    simple = networkx.Graph()
    for u, v, length in s.graph.edges(data="length"):
        if u != v and length < simple.get_edge_data(u, v, {"length": np.inf})["length"]:
            simple.add_edge(u, v, length=length)
    between = dict.fromkeys(s.graph, 0.0)
    for source in sources:
        near = networkx.ego_graph(simple, source, radius=1000.0, distance="length")
        found = networkx.betweenness_centrality_subset(near, [source], list(near), weight="length")
        for node, value in found.items():
            between[node] += 2 * value
    own = np.array([between[n] for n in s.junctions if s.edge_m(n) > 250.0])
    same("betweenness_local", s.ours("betweenness_local"), np.log1p(own / own.mean()))


def natural_streets(s):
    # momepy's COINS joins by the angle of the last straight pieces and parts streets at every vertex
    # that turns too much. Here directions are taken over 15 m, and a street goes on through a bend.
    measured = s.city["measures"]["natural_street_length"]
    ours = np.average(measured["values"], weights=measured["weights"])
    strokes = momepy.COINS(s.lines, angle_threshold=140).stroke_gdf()
    theirs = np.average(np.log10(strokes.length), weights=strokes.length)
    same_in_order("length of natural streets", np.sum(measured["weights"]), strokes.length.sum())
    assert abs(ours - theirs) < 0.15, f"natural_street_length: {ours:.3f} here, {theirs:.3f} there"
    print(f"natural_street_length: {ours:.3f} here, {theirs:.3f} by COINS")


def blocks(s):
    # momepy's enclosures are all faces; slivers go by the rule of exurb.
    faces = momepy.enclosures(s.lines)
    faces = faces[(faces.area >= 250.0) & (2 * faces.area / faces.length >= 10.0)].geometry
    same("block_area", np.power(10, s.ours("block_area")), faces.area)
    same("block_shape_phi", s.ours("block_shape_phi"), momepy.circular_compactness(faces))
    # momepy's square compactness is 16 area / perimeter², this one 4π area / perimeter².
    compactness = momepy.square_compactness(faces) * np.pi / 4
    same("block_compactness", s.ours("block_compactness"), compactness)
    faces = faces.iloc[np.argsort(faces.area.to_numpy())]
    aspects = np.array(s.ours("block_aspect"))[np.argsort(s.ours("block_area"))]
    same_aspects("block_aspect", aspects, momepy.elongation(faces).to_numpy(), faces)
    same("block_rectangularity", s.ours("block_rectangularity"), momepy.rectangularity(faces))


def main(file):
    warnings.simplefilter("ignore")
    for city in load(file):
        print(f"-- {city['name']}")
        s = Streets(city)
        for check in (segments, nodes, directions, paths, natural_streets, blocks):
            check(s)


main(*sys.argv[1:2])
