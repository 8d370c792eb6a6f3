"""Cuts an OpenStreetMap extract down to what exurb reads.

Authors, time stamps and versions go, and so do tags no part of the program looks at. Ways are cut
where the upstream extract lacks their nodes; areas that do not close any more and relations that
lack members go. The header keeps the upstream box.

    python data/cut_osm.py IN.osm.pbf OUT.osm.pbf [W,S,E,N]

With a box, ways with a node inside stay, whole, and so do relations of these, unless they have over a
hundred members, such as whole islands. Needs the package `osmium` (data/requirements.txt).
"""

import sys

import osmium

KEYS = {
    "access", "amenity", "area", "barrier", "bridge", "building", "building:height",
    "building:levels", "building:min_level", "building:part", "denotation", "embankment",
    "footway", "height", "highway", "junction", "landuse", "lanes", "layer", "leisure", "man_made",
    "min_height", "name", "natural", "office", "oneway", "place", "roof:angle", "roof:colour",
    "roof:direction", "roof:height", "roof:levels", "roof:orientation", "roof:shape", "service",
    "shop", "tunnel", "type", "water", "waterway", "width",
}
# A way or relation is kept for one of these; the rest of its tags ride along.
AREA_KEYS = {"building", "building:part", "landuse", "leisure", "natural", "place", "amenity"}
LINE_KEYS = {"highway", "waterway", "natural"}
POINT_KEYS = {"amenity", "barrier", "highway", "leisure", "natural", "man_made"}
POINT_VALUES = {
    "tree", "street_lamp", "playground", "post_box", "bench", "fountain", "waste_basket",
    "bicycle_parking", "telephone", "bollard", "gate", "bus_stop", "traffic_signals", "crossing",
    "flagpole", "turning_circle",
}


def tags_of(thing):
    return {t.k: t.v for t in thing.tags if t.k in KEYS}


def point_is_kept(tags):
    return any(tags.get(key) in POINT_VALUES for key in POINT_KEYS)


def runs(refs, known):
    """The stretches of a way whose nodes are all there."""
    run = []
    for ref in refs:
        if ref in known:
            run.append(ref)
            continue
        if len(run) > 1:
            yield run
        run = []
    if len(run) > 1:
        yield run


def read(path):
    nodes, ways, relations = {}, [], []
    for thing in osmium.FileProcessor(path):
        if thing.is_node():
            nodes[thing.id] = (thing.location.lon, thing.location.lat, tags_of(thing))
        elif thing.is_way():
            ways.append((thing.id, [n.ref for n in thing.nodes], tags_of(thing)))
        else:
            members = [(m.type, m.ref, m.role) for m in thing.members]
            relations.append((thing.id, members, tags_of(thing)))
    return nodes, ways, relations


def inside(box, nodes, ways, relations):
    """The ways with a node in the box, the relations with such a way, and the ways of these."""
    low, high = box.bottom_left, box.top_right
    near = {
        n
        for n, (lon, lat, _) in nodes.items()
        if low.lon <= lon <= high.lon and low.lat <= lat <= high.lat
    }
    ways = {way: (way, refs, tags) for way, refs, tags in ways}
    touching = {way for way, (_, refs, _) in ways.items() if not near.isdisjoint(refs)}
    relations = [
        r for r in relations if len(r[1]) <= 100 and any(ref in touching for _, ref, _ in r[1])
    ]
    members = {ref for _, refs, _ in relations for kind, ref, _ in refs if kind == "w"}
    kept = [way for i, way in ways.items() if i in touching or i in members]
    used = near.union(*(refs for _, refs, _ in kept))
    return {n: node for n, node in nodes.items() if n in used}, kept, relations


def cut(nodes, ways, relations):
    whole = {w for w, refs, _ in ways if all(r in nodes for r in refs)}
    relations = [
        (i, members, tags)
        for i, members, tags in relations
        if tags.get("type") in ("multipolygon", "building")
        and AREA_KEYS & tags.keys()
        and all(kind == "w" and ref in whole for kind, ref, _ in members)
    ]
    members = {ref for _, refs, _ in relations for _, ref, _ in refs}
    kept, next_id = [], max(w for w, _, _ in ways) + 1
    for way, refs, tags in ways:
        if way in members:
            kept.append((way, refs, tags))
        elif way in whole and (AREA_KEYS | LINE_KEYS) & tags.keys():
            kept.append((way, refs, tags))
        elif LINE_KEYS & tags.keys() and not (AREA_KEYS - LINE_KEYS) & tags.keys():
            for part, run in enumerate(runs(refs, nodes)):
                kept.append((way if part == 0 else next_id, run, tags))
                next_id += part > 0
    used = {ref for _, refs, _ in kept for ref in refs}
    points = {n for n, (_, _, tags) in nodes.items() if point_is_kept(tags)}
    nodes = {n: nodes[n] for n in sorted(used | points)}
    return nodes, sorted(kept), sorted(relations, key=lambda r: r[0])


def write(path, box, nodes, ways, relations):
    header = osmium.io.Header()
    header.add_box(box)
    header.set("generator", "exurb data/cut_osm.py")
    mutable = osmium.osm.mutable
    with osmium.SimpleWriter(path, header=header, overwrite=True) as out:
        for i, (lon, lat, tags) in nodes.items():
            tags = tags if point_is_kept(tags) else {}
            out.add_node(mutable.Node(id=i, location=(lon, lat), tags=tags))
        for i, refs, tags in ways:
            out.add_way(mutable.Way(id=i, nodes=refs, tags=tags))
        for i, members, tags in relations:
            out.add_relation(mutable.Relation(id=i, members=members, tags=tags))


def main(source, target, corners=None):
    extract = read(source)
    if corners is None:
        box = osmium.io.Reader(source).header().box()
    else:
        box = osmium.osm.Box(*map(float, corners.split(",")))
        extract = inside(box, *extract)
    write(target, box, *cut(*extract))


if __name__ == "__main__":
    main(*sys.argv[1:4])
