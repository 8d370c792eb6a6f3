"""Writes streets of a city that neatnet's source distribution ships as an OpenStreetMap extract.

    python data/cut_neatnet.py original.parquet OUT.osm.pbf W,S,E,N

The file lies under `data/CITY` of the distribution: streets with their `highway` value, without names,
lanes or directions. Those that meet share a node. Needs the packages of data/requirements.txt.
"""

import sys

import geopandas
import osmium
import shapely


def streets(path, box):
    """Lines in degrees with seven decimals, and their `highway` values, in the file's order."""
    frame = geopandas.read_parquet(path).to_crs(4326)
    frame = frame[frame.intersects(shapely.box(*box))]
    for shape, highway in zip(frame.geometry, frame.highway, strict=True):
        for part in shapely.get_parts(shape):
            yield [(round(x, 7), round(y, 7)) for x, y in part.coords], highway


def main(source, target, corners):
    box = [float(c) for c in corners.split(",")]
    nodes, ways, seen = {}, [], set()
    for line, highway in streets(source, box):
        refs = [nodes.setdefault(point, len(nodes) + 1) for point in line]
        # The distribution holds each street once for either direction.
        key = min(tuple(refs), tuple(refs[::-1]))
        if key not in seen:
            seen.add(key)
            ways.append((refs, highway))
    header = osmium.io.Header()
    header.add_box(osmium.osm.Box(*box))
    header.set("generator", "exurb data/cut_neatnet.py")
    mutable = osmium.osm.mutable
    with osmium.SimpleWriter(target, header=header, overwrite=True) as out:
        for point, number in nodes.items():
            out.add_node(mutable.Node(id=number, location=point, tags={}))
        for number, (refs, highway) in enumerate(ways, 1):
            out.add_way(mutable.Way(id=number, nodes=refs, tags={"highway": highway}))


if __name__ == "__main__":
    main(*sys.argv[1:4])
