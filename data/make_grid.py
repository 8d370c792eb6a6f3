"""Makes the fictional North American example: a street grid with alleys, houses and a downtown.

No package we know ships a small real map of one with its buildings and a licence that lets us pass it
on, so this script draws it from textbook dimensions. It lies at the null island and belongs to no real
place.

    python data/make_grid.py data/

Needs the packages of data/requirements.txt. Same script, same file.
"""

import math
import pathlib
import random
import sys

import osmium
from shapely.geometry import Polygon

EAST_M, NORTH_M = 111319.49, 110574.28  # metres per degree at the null island
SIZE_M = 2400.0


class Sheet:
    """Nodes and ways in metres, written as OSM; streets that meet share a node."""

    def __init__(self):
        self.nodes, self.ways, self.trees = {}, [], []

    def node(self, point):
        return self.nodes.setdefault((round(point[0], 2), round(point[1], 2)), len(self.nodes) + 1)

    def street(self, points, **tags):
        self.ways.append(([self.node(p) for p in points], tags))

    def area(self, polygon, **tags):
        ring = [self.node(p) for p in polygon.exterior.coords[:-1]]
        self.ways.append((ring + ring[:1], {k.replace("__", ":"): str(v) for k, v in tags.items()}))

    def write(self, path):
        header = osmium.io.Header()
        low, high = (lonlat((s * SIZE_M / 2, s * SIZE_M / 2)) for s in (-1, 1))
        header.add_box(osmium.osm.Box(*low, *high))
        header.set("generator", "exurb data/make_grid.py")
        mutable = osmium.osm.mutable
        with osmium.SimpleWriter(str(path), header=header, overwrite=True) as out:
            for point, number in self.nodes.items():
                out.add_node(mutable.Node(id=number, location=lonlat(centred(point)), tags={}))
            for number, point in enumerate(self.trees, len(self.nodes) + 1):
                place = lonlat(centred(point))
                out.add_node(mutable.Node(id=number, location=place, tags={"natural": "tree"}))
            for number, (refs, tags) in enumerate(self.ways, 1):
                out.add_way(mutable.Way(id=number, nodes=refs, tags=tags))


def centred(point):
    return point[0] - SIZE_M / 2, point[1] - SIZE_M / 2


def lonlat(point):
    return point[0] / EAST_M, point[1] / NORTH_M


def house(foot, along, width, depth):
    """A rectangle whose front's middle is `foot`; `along` is the unit vector of the street."""
    ax, ay = along[0] * width / 2, along[1] * width / 2
    bx, by = -along[1] * depth, along[0] * depth
    x, y = foot
    return Polygon([(x - ax, y - ay), (x + ax, y + ay), (x + ax + bx, y + ay + by),
                    (x - ax + bx, y - ay + by)])


ACROSS_M, UP_M = 200.0, 100.0  # block length and depth, street axis to street axis


def grid():
    rng, sheet = random.Random(7), Sheet()
    xs = [i * ACROSS_M for i in range(13)]
    ys = [i * UP_M for i in range(25)]
    park = {(c, r) for c in (3, 4) for r in (14, 15, 16, 17)}
    joined = park | {(8, 5), (8, 6), (2, 4), (2, 5), (10, 19), (10, 20)}  # schools, a hospital
    rank = lambda i, main, half: ("primary", 4) if i == main else (
        ("secondary", 4) if i in half else ("residential", 2))
    for r, y in enumerate(ys):
        kind, lanes = rank(r, 12, (0, 8, 16, 24))
        for c in range(12):
            if not ((c, r) in joined and (c, r - 1) in joined):
                sheet.street([(xs[c], y), (xs[c + 1], y)], highway=kind, lanes=str(lanes),
                             name=f"{ordinal(r + 1)} Street")
    for c, x in enumerate(xs):
        kind, lanes = rank(c, 6, (0, 4, 8, 12))
        for r in range(24):
            if not ((c, r) in joined and (c - 1, r) in joined):
                sheet.street([(x, ys[r]), (x, ys[r + 1])], highway=kind, lanes=str(lanes),
                             name=f"{ordinal(c + 1)} Avenue")
    for c in range(12):
        for r in range(24):
            if (c, r) not in joined:
                fill_block(sheet, rng, xs[c], ys[r])
    green = Polygon([(xs[3] + 8, ys[14] + 6), (xs[5] - 8, ys[14] + 6), (xs[5] - 8, ys[18] - 6),
                     (xs[3] + 8, ys[18] - 6)])
    sheet.area(green, leisure="park")
    sheet.trees += [(xs[3] + 20 + rng.random() * 360, ys[14] + 20 + rng.random() * 360)
                    for _ in range(220)]
    for c, r in ((8, 5), (2, 4), (10, 19)):
        sheet.area(house((xs[c] + 100, ys[r] + 30), (1, 0), 110, 60), building="school",
                   building__levels=2)
    return sheet


def ordinal(n):
    ending = "th" if 10 <= n % 100 <= 20 else {1: "st", 2: "nd", 3: "rd"}.get(n % 10, "th")
    return f"{n}{ending}"


def fill_block(sheet, rng, x, y):
    """Two rows of lots back to back, an alley between them."""
    middle = y + UP_M / 2
    sheet.street([(x, middle), (x + ACROSS_M, middle)], highway="service", service="alley")
    from_centre = math.hypot(x + 100 - SIZE_M / 2, y + 50 - SIZE_M / 2)
    town = from_centre < 330
    width = 28.0 if town else 14.0 if from_centre < 800 else 17.0
    margin = 9.0
    count = int((ACROSS_M - 2 * margin) // width)
    width = (ACROSS_M - 2 * margin) / count
    for row, (street, along) in enumerate(((y, (1, 0)), (y + UP_M, (-1, 0)))):
        for lot in range(count):
            if rng.random() < 0.06:
                continue
            centre = x + margin + (lot + 0.5) * width
            if town:
                levels = max(2, round(rng.gauss(14 - from_centre / 35, 3)))
                shape = house((centre, street + along[0] * 8), along, width - 0.6,
                              rng.uniform(24, 36))
                sheet.area(shape, building="commercial", building__levels=levels)
            else:
                shape = house((centre, street + along[0] * rng.uniform(11, 13)), along,
                              width - rng.uniform(4, 6), rng.uniform(11, 15))
                sheet.area(shape, building="house", building__levels=rng.choice((1, 2, 2)),
                           roof__shape=rng.choice(("gabled", "gabled", "hipped")))
        for tree in range(int(ACROSS_M // 18)):
            if rng.random() < (0.25 if town else 0.6):
                sheet.trees.append((x + 14 + tree * 18, street + along[0] * 6.5))


def main(folder):
    grid().write(pathlib.Path(folder) / "grid.osm.pbf")


if __name__ == "__main__":
    main(sys.argv[1])
