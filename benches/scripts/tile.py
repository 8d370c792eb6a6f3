"""tile.py OUT.osm.pbf SIZE_MB MAP...: lays copies of maps side by side until the file is so large.

Every copy has a place and ids of its own. Ids are renumbered without gaps: programs that keep ids
in bit sets would otherwise be measured on empty pages.
"""

import math
import os
import sys

import osmium

STEP_DEGREES = 0.12  # wider than any of the maps


class Map:
    """A map's things with their new numbers."""

    def __init__(self, path):
        self.path = path
        corner = osmium.io.Reader(path).header().box().bottom_left
        self.west, self.south = corner.lon, corner.lat
        ids = {"n": set(), "w": set(), "r": set()}
        for thing in osmium.FileProcessor(path):
            ids[thing.type_str()].add(thing.id)
            if thing.is_way():
                ids["n"].update(n.ref for n in thing.nodes)
            elif thing.is_relation():
                for member in thing.members:
                    ids[member.type].add(member.ref)
        self.number = {
            kind: {old: new for new, old in enumerate(sorted(known), 1)}
            for kind, known in ids.items()
        }


def write(out, maps, count):
    columns = math.isqrt(count * len(maps) - 1) + 1
    with osmium.SimpleWriter(out, overwrite=True) as writer:
        for kind in (osmium.osm.NODE, osmium.osm.WAY, osmium.osm.RELATION):
            base = {"n": 0, "w": 0, "r": 0}
            for index in range(count * len(maps)):
                tile = maps[index % len(maps)]
                row, column = divmod(index, columns)
                east = column * STEP_DEGREES - tile.west
                north = row * STEP_DEGREES - tile.south
                for thing in osmium.FileProcessor(tile.path, kind):
                    write_one(writer, thing, tile.number, base, east, north)
                for key, known in tile.number.items():
                    base[key] += len(known)


def write_one(writer, thing, number, base, east, north):
    mutable, tags = osmium.osm.mutable, thing.tags
    new = lambda kind, old: number[kind][old] + base[kind]
    own = new(thing.type_str(), thing.id)
    if thing.is_node():
        place = (thing.location.lon + east, thing.location.lat + north)
        writer.add_node(mutable.Node(id=own, location=place, tags=tags))
    elif thing.is_way():
        refs = [new("n", n.ref) for n in thing.nodes]
        writer.add_way(mutable.Way(id=own, nodes=refs, tags=tags))
    else:
        members = [(m.type, new(m.type, m.ref), m.role) for m in thing.members]
        writer.add_relation(mutable.Relation(id=own, members=members, tags=tags))


def main(out, size_mb, *paths):
    once = sum(os.path.getsize(path) for path in paths)
    write(out, [Map(path) for path in paths], max(1, round(float(size_mb) * 1e6 / once)))
    print(f"{out}: {os.path.getsize(out) / 1e6:.1f} MB")


main(*sys.argv[1:])
