"""osm_osmium.py CITY.osm CITY.osm.pbf CITY.geojson: osmium reads both, whole and alike."""

import sys

import osmium
from cities import assert_close, distance_m, elements, load, streets_m


def read(path):
    header = osmium.io.Reader(path).header()
    assert header.box().valid(), f"{path} has no bounds"
    nodes, ways, relations = {}, [], []
    for thing in osmium.FileProcessor(path):
        assert thing.id > 0, f"{path}: id {thing.id} is not positive"
        if thing.is_node():
            assert thing.id not in nodes, f"{path}: node {thing.id} twice"
            nodes[thing.id] = (thing.location.lon, thing.location.lat)
        elif thing.is_way():
            ways.append((thing.id, [n.ref for n in thing.nodes], dict(thing.tags)))
        else:
            members = [(m.type, m.ref, m.role) for m in thing.members]
            relations.append((thing.id, members, dict(thing.tags)))
    known = {i for i, _, _ in ways}
    assert len(known) == len(ways), f"{path}: a way twice"
    for i, refs, _ in ways:
        assert len(refs) > 1, f"{path}: way {i} has {len(refs)} nodes"
        assert all(ref in nodes for ref in refs), f"{path}: way {i} names a missing node"
    for i, members, _ in relations:
        assert all(k != "w" or r in known for k, r, _ in members), f"{path}: relation {i}"
    return nodes, ways, relations


def check(path, city):
    nodes, ways, relations = read(path)
    streets = [refs for _, refs, tags in ways if "highway" in tags and "area" not in tags]
    metres = sum(
        distance_m(nodes[a], nodes[b]) for refs in streets for a, b in zip(refs, refs[1:])
    )
    assert_close(f"{path}: metres of streets", metres, streets_m(city))
    keys = ("building", "building:part")
    buildings = sum(any(k in tags for k in keys) for _, _, tags in ways + relations)
    wanted = len(elements(city, "building"))
    assert buildings == wanted, f"{path}: {buildings} buildings, expected {wanted}"
    return nodes, ways, relations


def areas(path):
    """osmium's own assembly of polygons finds nothing to complain about."""
    count = 0
    for thing in osmium.FileProcessor(path).with_areas():
        if thing.is_area() and ("building" in thing.tags or "building:part" in thing.tags):
            assert thing.num_rings()[0] > 0, f"{path}: area {thing.orig_id()} has no ring"
            count += 1
    return count


def main(xml, pbf, geojson):
    city = load(geojson)
    a, b = check(xml, city), check(pbf, city)
    assert a == b, "XML and PBF differ"
    assembled = areas(xml)
    assert assembled == len(elements(city, "building")), f"{assembled} buildings assembled"
    with open(xml, encoding="utf-8") as file:
        head = file.read(2000)
    assert "attribution=" in head or "copyright=" in head, "the XML names no attribution"


main(*sys.argv[1:4])
