"""outlines.py EXURB: cuts single blocks out of the built-in example cities and draws new outlines for them.

Writes docs/gallery/blocks/NAME.geojson (a block, its buildings, a street around it) and
NAME-CASE.geojson (its outline in the case). Needs the package `shapely`. What it wrote is kept in the
repository; run it again to change the cases.
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

from shapely.geometry import LineString, Point, Polygon, shape

HERE = pathlib.Path(__file__).parent
EXURB = sys.argv[1]
# Half the width of the street around a block, in metres.
HALF = 3.0
MARGIN = 42.0


def export(source, folder, name):
    city, out = folder / f"{name}.gpkg", folder / f"{name}.geojson"
    subprocess.run([EXURB, "import", source, "-o", city, "-q"], check=True)
    subprocess.run([EXURB, "export", city, "-o", out, "-q"], check=True)
    return json.loads(out.read_text())


class Frame:
    """Metres around a place."""

    def __init__(self, lon, lat):
        self.lon, self.lat = lon, lat
        self.x = 111320.0 * math.cos(math.radians(lat))
        self.y = 111320.0

    def local(self, ring):
        return [((lon - self.lon) * self.x, (lat - self.lat) * self.y) for lon, lat in ring]

    def world(self, ring):
        return [[round(x / self.x + self.lon, 8), round(y / self.y + self.lat, 8)] for x, y in ring]


def elements(city, kind):
    return [f for f in city["features"] if f["properties"]["element"] == kind]


def write(path, features, city, **more):
    document = {"type": "FeatureCollection", **more, "attribution": city["exurb_attribution"], "features": features}
    path.write_text(json.dumps(document, separators=(",", ":")).replace('{"type":"Feature"', '\n{"type":"Feature"') + "\n")


def feature(kind, geometry, **properties):
    return {"type": "Feature", "properties": {"element": kind, **properties}, "geometry": geometry}


def simple(polygon):
    """The ring with no corners under 5 degrees: those are bends of kerbs."""
    ring = list(polygon.simplify(0.5).exterior.coords)[:-1]
    return ring if Polygon(ring).exterior.is_ccw else ring[::-1]


def cut(source, number, name, folder):
    """Writes the block alone; its frame, its outline as it is read back, and the city it is from."""
    city = export(source, folder, name)
    block = next(f for f in elements(city, "block") if f["properties"]["id"] == number)
    center = shape(block["geometry"]).centroid
    frame = Frame(center.x, center.y)
    outline = Polygon(simple(Polygon(frame.local(block["geometry"]["coordinates"][0]))))
    street = list(outline.buffer(HALF, join_style="mitre", mitre_limit=20).exterior.coords)
    features = []
    for a, b in zip(street, street[1:]):
        line = {"type": "LineString", "coordinates": frame.world([a, b])}
        features.append(feature("street", line, highway="residential", width=2 * HALF))
    for b in elements(city, "building"):
        if b["properties"].get("block") == number and not b["properties"].get("is_part"):
            ring = [frame.world(frame.local(r)) for r in b["geometry"]["coordinates"]]
            known = {k: b["properties"][k] for k in ("height", "building:levels", "building") if k in b["properties"]}
            features.append(feature("building", {"type": "Polygon", "coordinates": ring}, **known))
    x0, y0, x1, y1 = outline.bounds
    (w, s), (e, n) = frame.world([(x0 - MARGIN, y0 - MARGIN), (x1 + MARGIN, y1 + MARGIN)])
    drawn = folder / f"{name}-drawn.geojson"
    write(drawn, features, city)
    again = export(drawn, folder, f"{name}-block")
    for target in elements(again, "target"):
        target["geometry"]["coordinates"] = [[[w, s], [e, s], [e, n], [w, n], [w, s]]]
    again["bbox"] = [w, s, e, n]
    again["exurb_attribution"] = city["exurb_attribution"]
    text = json.dumps(again, separators=(",", ":")).replace('{"type":"Feature"', '\n{"type":"Feature"')
    (HERE / "blocks" / f"{name}.geojson").write_text(text + "\n")
    kerb = max(elements(again, "block"), key=lambda f: f["properties"]["area"])
    ring = frame.local(kerb["geometry"]["coordinates"][0])[:-1]
    return frame, ring, city, kerb["properties"]["id"]


def corners(ring, degrees=25.0):
    """Indices of the corners that turn."""
    out = []
    for i, p in enumerate(ring):
        a, b = ring[i - 1], ring[(i + 1) % len(ring)]
        u, v = (p[0] - a[0], p[1] - a[1]), (b[0] - p[0], b[1] - p[1])
        turn = math.degrees(abs(math.atan2(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1])))
        if turn > degrees:
            out.append(i)
    return out


def moved(ring, moves):
    """Corners by number moved by metres; bends between them follow."""
    which = corners(ring)
    shift = {i: (0.0, 0.0) for i in which}
    for number, by in moves.items():
        shift[which[number % len(which)]] = by
    out = []
    n = len(ring)
    for i, p in enumerate(ring):
        if i in shift:
            out.append((p[0] + shift[i][0], p[1] + shift[i][1]))
            continue
        before = next((i - k) % n for k in range(1, n) if (i - k) % n in shift)
        after = next((i + k) % n for k in range(1, n) if (i + k) % n in shift)
        a, b = math.dist(ring[before], p), math.dist(ring[after], p)
        t = a / (a + b)
        dx, dy = ((1 - t) * shift[before][k] + t * shift[after][k] for k in (0, 1))
        out.append((p[0] + dx, p[1] + dy))
    return out


def split(ring, side, inserts):
    """Points inserted on the side after corner `side`: (share along it, metres outwards)."""
    which = corners(ring)
    start, end = which[side % len(which)], which[(side + 1) % len(which)]
    a, b = ring[start], ring[end]
    length = math.dist(a, b)
    u = ((b[0] - a[0]) / length, (b[1] - a[1]) / length)
    new = [(a[0] + u[0] * t * length + u[1] * d, a[1] + u[1] * t * length - u[0] * d) for t, d in inserts]
    n = len(ring)
    count = (end - start) % n
    kept = [ring[(end + k) % n] for k in range(n - count + 1)]
    return kept + new


def scaled(ring, factor):
    c = Polygon(ring).centroid
    return [(c.x + factor * (x - c.x), c.y + factor * (y - c.y)) for x, y in ring]


def main():
    data = HERE.parent.parent / "data"
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name, source, number, cases in CASES:
            frame, ring, city, block = cut(data / source, number, name, folder)
            print(name, "block", block, "corners", [tuple(map(round, ring[i])) for i in corners(ring)])
            for case, change in cases.items():
                outline = change(ring)
                assert Polygon(outline).is_valid, (name, case)
                coordinates = frame.world(outline + outline[:1])
                polygon = {"type": "Polygon", "coordinates": [coordinates]}
                path = HERE / "blocks" / f"{name}-{case}.geojson"
                write(path, [feature("target", polygon)], city)


CASES = [
    ("tight", "helsinki.osm.pbf", 42, {
        "deformed": lambda r: moved(r, {0: (30.0, 15.0), 2: (-35.0, -10.0)}),
        "split": lambda r: split(r, 1, [(0.35, 22.0), (0.65, 22.0)]),
    }),
    ("houses", "karhula.osm.pbf", 31, {
        "enlarged": lambda r: moved(r, {0: (45.0, 35.0), 1: (-10.0, 40.0), 3: (40.0, -5.0)}),
        "shrunk": lambda r: scaled(r, 0.8),
        "split": lambda r: split(r, 1, [(0.35, 18.0), (0.65, 18.0)]),
        "heavy": lambda r: moved(split(r, 3, [(0.4, 30.0), (0.6, 30.0)]), {0: (35.0, 25.0)}),
    }),
    ("village", "karhula.osm.pbf", 24, {
        "shrunk": lambda r: moved(r, {1: (-28.0, 42.0), 2: (-5.0, -8.0)}),
    }),
]

if __name__ == "__main__":
    main()
