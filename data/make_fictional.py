"""Makes the two fictional North American examples: a street grid and a suburb of loops.

No package we know ships a small real map of either with a licence that lets us pass it on, so this
script draws them from textbook dimensions: one street grid with alleys and a downtown, one suburb
of collectors, loops and cul-de-sacs. Both lie at the null island and belong to no real place.

    python data/make_fictional.py data/

Needs the packages of data/requirements.txt. Same script, same files.
"""

import math
import pathlib
import random
import sys

import osmium
import shapely
from shapely.geometry import LineString, Point, Polygon

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
        header.set("generator", "exurb data/make_fictional.py")
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


# --- the grid ----------------------------------------------------------------------------------

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


# --- the suburb --------------------------------------------------------------------------------

CELL_M = 1200.0
RIB_M = 92.0  # between neighbouring local streets


def warp(point):
    """Bends what is drawn on a square sheet; still on the arterials."""
    x, y = point
    u, v = x % CELL_M / CELL_M, y % CELL_M / CELL_M
    fade = (math.sin(math.pi * min(u, 1)) * math.sin(math.pi * min(v, 1))) ** 0.7
    cell = x // CELL_M + 2 * (y // CELL_M)
    dx = 70 * math.sin(2 * math.pi * v * 1.5 + cell) + 25 * math.sin(2 * math.pi * v * 3 + 2 * cell)
    dy = 60 * math.sin(2 * math.pi * u * 1.5 + 1.3 * cell)
    return x + fade * dx, y + fade * dy


def bent(points, step=20.0):
    line = LineString(points)
    count = max(1, round(line.length / step))
    stops = [line.interpolate(i / count, normalized=True) for i in range(count + 1)]
    return [warp((p.x, p.y)) for p in stops]


def suburb():
    rng, sheet = random.Random(11), Sheet()
    arterials, locals_ = [], []
    for cx in range(2):
        for cy in range(2):
            draw_cell(rng, cx * CELL_M, cy * CELL_M, arterials, locals_)
    edges = sorted({0.0, CELL_M, SIZE_M})
    for edge in edges:
        for along in edges[:-1]:
            arterials.append((bent([(along, edge), (along + CELL_M, edge)]), "secondary"))
            arterials.append((bent([(edge, along), (edge, along + CELL_M)]), "secondary"))
    lines = noded(arterials + locals_)
    for points, kind in lines:
        sheet.street(points, highway=kind, lanes="4" if kind == "secondary" else "2")
    place_houses(sheet, rng, lines)
    return sheet


def draw_cell(rng, x, y, arterials, locals_):
    """A collector from south to north, ribs to both sides, some joined to loops."""
    spine = x + CELL_M / 2
    arterials.append((bent([(spine, y), (spine, y + CELL_M)]), "tertiary"))
    cross = y + RIB_M * 7
    arterials.append((bent([(x, cross), (x + CELL_M, cross)]), "tertiary"))
    for side in (-1, 1):
        reach = None
        for rib in range(1, 13):
            level = y + rib * RIB_M
            if rib == 7:
                reach = None
                continue
            end = spine + side * rng.choice((380, 440, 500, 530))
            if reach is not None and rng.random() < 0.45:
                end = reach  # close a loop with the rib below
                locals_.append((bent([(end, level - RIB_M), (end, level)]), "residential"))
                reach = None
            else:
                reach = end
            locals_.append((bent([(spine, level), (end, level)]), "residential"))


def noded(lines):
    """Cuts the lines where they meet, so that streets share their crossings."""
    union = shapely.unary_union([LineString(points) for points, _ in lines])
    union = shapely.set_precision(union, 0.01)
    kinds = [(LineString(points).buffer(0.5), kind) for points, kind in lines]
    out = []
    for piece in sorted(union.geoms, key=lambda g: (g.coords[0], g.length)):
        middle = piece.interpolate(0.5, normalized=True)
        kind = next(kind for area, kind in kinds if area.contains(middle))
        out.append((list(piece.coords), kind))
    return merged(out)


def merged(pieces):
    """Joins pieces over points that only two of one kind share."""
    by_kind = {}
    for points, kind in pieces:
        by_kind.setdefault(kind, []).append(LineString(points))
    ends = [p[0] for p, _ in pieces] + [p[-1] for p, _ in pieces]
    crossing = {p for p in set(ends) if ends.count(p) != 2}
    out = []
    for kind, lines in sorted(by_kind.items()):
        joined = shapely.line_merge(shapely.union_all(lines))
        for line in shapely.get_parts(joined):
            run = [line.coords[0]]
            for point in line.coords[1:]:
                run.append(point)
                if point in crossing:
                    out.append((run, kind))
                    run = [point]
            if len(run) > 1:
                out.append((run, kind))
    return sorted(out)


def place_houses(sheet, rng, lines):
    streets = shapely.STRtree([LineString(points) for points, _ in lines])
    taken = []
    for points, kind in lines:
        if kind != "residential":
            continue
        line = LineString(points)
        for side in (1, -1):
            position = 14.0
            while position < line.length - 6:
                width = rng.uniform(17, 24)
                shape = house_beside(line, position, side, rng)
                if fits(shape, streets, taken):
                    taken.append(shape)
                    sheet.area(shape, building="house", building__levels=rng.choice((1, 1, 2)),
                               roof__shape=rng.choice(("gabled", "hipped", "hipped")))
                    tree = beside(line, position + width / 2, side, 6.0)[0]
                    if rng.random() < 0.7 and fits(Point(tree).buffer(1.0), streets, taken, 4.5):
                        sheet.trees.append(tree)
                position += width


def house_beside(line, position, side, rng):
    foot, along = beside(line, position, side, rng.uniform(12, 14))
    return house(foot, along, rng.uniform(11, 15), rng.uniform(9, 13))


def beside(line, position, side, back):
    """The point `back` metres off the line, and the unit vector to look along it from there."""
    position = min(position, line.length - 1)
    here, there = line.interpolate(position), line.interpolate(position + 1)
    length = here.distance(there)
    along = (there.x - here.x) / length * side, (there.y - here.y) / length * side
    return (here.x - along[1] * back, here.y + along[0] * back), along


def fits(shape, streets, taken, street_m=8.0):
    if shape.bounds[0] < 12 or shape.bounds[1] < 12:
        return False
    if shape.bounds[2] > SIZE_M - 12 or shape.bounds[3] > SIZE_M - 12:
        return False
    if len(streets.query(shape, predicate="dwithin", distance=street_m)):
        return False
    return all(shape.distance(other) > 3.0 for other in taken[-400:])


def main(folder):
    grid().write(pathlib.Path(folder) / "grid.osm.pbf")
    suburb().write(pathlib.Path(folder) / "suburb.osm.pbf")


if __name__ == "__main__":
    main(sys.argv[1])
