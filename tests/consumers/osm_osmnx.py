"""osm_osmnx.py CITY.osm CITY.geojson: OSMnx makes the same street graph of it."""

import sys

import networkx
import osmnx
from cities import assert_close, elements, load, streets_m


def main(xml, geojson):
    city = load(geojson)
    everything = osmnx.graph_from_xml(xml, bidirectional=True, simplify=False, retain_all=True)
    # OSMnx turns every way of a file into edges, outlines of houses as well.
    streets = [e for e in everything.edges(keys=True) if "highway" in everything.edges[e]]
    graph = osmnx.convert.to_undirected(everything.edge_subgraph(streets).copy())
    metres = sum(length for *_, length in graph.edges(data="length"))
    assert_close("metres of streets", metres, streets_m(city))

    simple = networkx.Graph(graph)
    degrees = {n: d for n, d in graph.degree() if d != 2}
    junctions = [f["properties"] for f in elements(city, "intersection")]
    cuts = sum(bool(junction.get("cut")) for junction in junctions)
    wanted = sum(junction["degree"] != 2 for junction in junctions)
    # A loop's own node has degree 2 here and may be an intersection there.
    assert abs(len(degrees) - wanted) <= 0.01 * wanted, f"{len(degrees)} intersections, not {wanted}"
    largest = max(networkx.connected_components(simple), key=len)
    print(f"{len(degrees)} intersections, {cuts} cut, {len(largest) / len(simple):.4f} connected")
    simplified = osmnx.simplify_graph(everything.edge_subgraph(streets).copy())
    print(f"{len(simplified)} nodes after OSMnx's own simplification")


main(*sys.argv[1:3])
