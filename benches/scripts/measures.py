"""measures.py STREETS.json: the measures of streets and blocks that momepy, OSMnx and networkx have,
by their usual calls, on streets cut and cleaned already. Prints the seconds they took.

What has no counterpart (angles, curvature, alignment by distance, pictures) is left out, so it is less
work than exurb does.
"""

import json
import sys
import time
import warnings

import geopandas
import momepy
import networkx
import numpy as np
import osmnx
import shapely

STEP_M, CELL_M, WINDOW_M = 250.0, 500.0, 1000.0


def main(file):
    warnings.simplefilter("ignore")
    city = json.load(open(file, encoding="utf-8"))
    at = {n: np.array([x, y]) for n, x, y, _ in city["nodes"]}
    ends = [n for n, _, _, cut in city["nodes"] if not cut]
    lines = geopandas.GeoDataFrame(
        geometry=[shapely.LineString(line) for *_, line in city["edges"]], crs="EPSG:32633"
    )
    graph = networkx.MultiGraph(crs="EPSG:32633")
    for node, (x, y) in at.items():
        graph.add_node(node, x=x, y=y)
    for (u, v, _), line in zip(city["edges"], lines.geometry):
        graph.add_edge(u, v, length=line.length, geometry=line)
    parts = {}
    for part in (segments, blocks, neighbourhoods, paths, natural_streets):
        started = time.perf_counter()
        part(city, at, ends, lines, graph)
        parts[part.__name__] = round(time.perf_counter() - started, 2)
    print(json.dumps({"seconds": sum(parts.values()), "parts": parts}))


def segments(city, at, ends, lines, graph):
    np.log10(lines.length)
    momepy.linearity(lines)
    momepy.node_degree(graph)
    osmnx.stats.count_streets_per_node(networkx.MultiDiGraph(graph))


def blocks(city, at, ends, lines, graph):
    faces = momepy.enclosures(lines)
    for shape in (
        momepy.circular_compactness,
        momepy.square_compactness,
        momepy.elongation,
        momepy.rectangularity,
    ):
        shape(faces)


def squares(city, side_m):
    x0, y0, x1, y1 = city["window"]
    for y in np.arange(y0, y1 - side_m + 1e-3, STEP_M):
        for x in np.arange(x0, x1 - side_m + 1e-3, STEP_M):
            yield np.array([x, y])


def neighbourhoods(city, at, ends, lines, graph):
    counts = osmnx.stats.count_streets_per_node(networkx.MultiDiGraph(graph))
    networkx.set_node_attributes(graph, counts, "street_count")
    places = np.array([at[n] for n in ends])
    ends = np.array(ends)
    tree = shapely.STRtree(lines.geometry.array)
    for corner in squares(city, CELL_M):
        inside = ((places >= corner) & (places < corner + CELL_M)).all(axis=1)
        cell = graph.subgraph(ends[inside].tolist())
        if len(cell) > 0:
            osmnx.stats.intersection_count(cell, min_streets=3)
            osmnx.stats.streets_per_node_counts(cell)
        box = shapely.box(*corner, *(corner + CELL_M))
        shapely.length(shapely.intersection(lines.geometry.array[tree.query(box)], box)).sum()
    middles, bearings, lengths = pieces(lines)
    for corner in squares(city, WINDOW_M):
        inside = ((places >= corner) & (places < corner + WINDOW_M)).all(axis=1)
        window = graph.subgraph(ends[inside].tolist())
        if len(window) > 10:
            momepy.meshedness(window, radius=None)
            osmnx.stats.streets_per_node_proportions(window)
        near = ((middles >= corner) & (middles < corner + WINDOW_M)).all(axis=1)
        streets = networkx.MultiGraph(crs="EPSG:4326")
        for i in np.flatnonzero(near):
            streets.add_edge(2 * i, 2 * i + 1, length=lengths[i], bearing=bearings[i])
        if len(streets) > 0:
            osmnx.orientation_entropy(streets, weight="length")


def pieces(lines):
    """Straight pieces of up to 25 m, so that what lies in a window is known."""
    points, index = shapely.get_coordinates(
        shapely.segmentize(lines.geometry.array, 25.0), return_index=True
    )
    along = np.diff(points, axis=0)[np.diff(index) == 0]
    start = points[:-1][np.diff(index) == 0]
    return start + along / 2, np.degrees(np.arctan2(*along.T)) % 360, np.hypot(*along.T)


def paths(city, at, ends, lines, graph):
    x0, y0, x1, y1 = city["window"]
    inner = lambda n: min(at[n][0] - x0, at[n][1] - y0, x1 - at[n][0], y1 - at[n][1]) >= 500
    sources = [n for n in ends if inner(n) and graph.degree(n) >= 3]
    sources = np.random.default_rng(1).permutation(sources)[:300].tolist()
    places = np.array([at[n] for n in ends])
    for source in sources:
        to = networkx.single_source_dijkstra_path_length(graph, source, 2500.0, "length")
        left = {n: 500.0 - d for n, d in to.items() if d < 500.0}
        sum(
            min(length, left.get(u, 0.0) + left.get(v, 0.0))
            for u, v, length in graph.edges(left, data="length")
        )
        straight = np.hypot(*(places - at[source]).T)
        for n, metres in zip(ends, straight):
            if 150.0 <= metres < 1200.0:
                min(to.get(n, 2500.0) / metres, 4.0)
        near = networkx.ego_graph(graph, source, radius=1000.0, distance="length")
        networkx.betweenness_centrality_subset(near, [source], list(near), weight="length")


def natural_streets(city, at, ends, lines, graph):
    momepy.COINS(lines, angle_threshold=140).stroke_gdf()


main(*sys.argv[1:2])
