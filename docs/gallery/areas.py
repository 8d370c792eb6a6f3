"""areas.py: draws the targets, sketches and streets of the figures of growth into docs/gallery/streets.

What it wrote is kept in the repository; run it again to change the figures. Needs nothing but Python.
"""

import json
import math
import pathlib
import struct
import zlib

OUT = pathlib.Path(__file__).parent / "streets"


class Place:
    """Metres around a place, written in degrees."""

    def __init__(self, lon, lat):
        self.lon, self.lat = lon, lat
        self.x = 111320.0 * math.cos(math.radians(lat))
        self.y = 110574.0 + 1118.0 * math.sin(math.radians(lat)) ** 2

    def degrees(self, point):
        return [round(self.lon + point[0] / self.x, 7), round(self.lat + point[1] / self.y, 7)]

    def line(self, points, **properties):
        geometry = {"type": "LineString", "coordinates": [self.degrees(p) for p in points]}
        return {"type": "Feature", "properties": properties, "geometry": geometry}

    def polygon(self, points, **properties):
        ring = [self.degrees(p) for p in [*points, points[0]]]
        geometry = {"type": "Polygon", "coordinates": [ring]}
        return {"type": "Feature", "properties": properties, "geometry": geometry}


def write(name, *features):
    text = json.dumps({"type": "FeatureCollection", "features": list(features)}, indent=1)
    (OUT / f"{name}.geojson").write_text(text + "\n")


def box(west, south, east, north):
    return [(west, south), (east, south), (east, north), (west, north)]


def disc(x, y, radius, count=28):
    turn = [math.tau * i / count for i in range(count)]
    return [(x + radius * math.cos(t), y + radius * math.sin(t)) for t in turn]


def paint(name, width, height, color):
    """A PNG of `width` x `height` pixels, `color(x, y)` from the north-west."""
    rows = b"".join(
        b"\0" + b"".join(bytes(color(x, y)) for x in range(width)) for y in range(height)
    )

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    png = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
    (OUT / f"{name}.png").write_bytes(b"\x89PNG\r\n\x1a\n" + png)


# A plain that is nowhere in particular.
PLAIN = Place(10.0, 50.0)
SALT_LAKE_CITY = Place(-111.8728, 40.7439)
PORTO_ALEGRE = Place(-51.2049, -30.0451)


def plain():
    write("square", PLAIN.polygon(box(-1350, -1350, 1350, 1350)))
    write("small", PLAIN.polygon(box(-650, -650, 650, 650)))
    write("wide", PLAIN.polygon(box(-1800, -900, 1800, 900)))
    write("tall", PLAIN.polygon(box(-1200, -2000, 1200, 2000)))
    write("huge", PLAIN.polygon(box(-7000, -7000, 7000, 7000)))


def content():
    """Figure 13: a coast, a river, a park, hills; then more hills."""
    half = 2500
    write("sketch_target", PLAIN.polygon(box(-half, -half, half, half)))
    coast = [(-2500, -2500), (2500, -2500), (2500, -2050), (1500, -1900), (300, -2150), (-900, -1750)]
    coast += [(-1800, -1900), (-2500, -1600)]
    bank = [(150, -2200), (250, -1500), (60, -800), (240, 0), (40, 700), (-250, 1500), (-300, 2500)]
    river = [(x - 55, y) for x, y in bank] + [(x + 55, y) for x, y in reversed(bank)]
    hills = [(-2500, 300), (-1700, 500), (-1350, 1200), (-1500, 2500), (-2500, 2500)]
    park = disc(1150, -700, 260)
    more = [(2500, 900), (1700, 1100), (1250, 1700), (1400, 2500), (2500, 2500)]
    shore = [(x, y + 450) for x, y in coast[2:]]
    low = [*coast[2:], *reversed(shore)]
    drawn = [
        PLAIN.polygon(low, use="coast"),
        PLAIN.polygon(hills, use="mountain"),
        PLAIN.polygon(park, use="park"),
        PLAIN.polygon(river, use="water"),
        PLAIN.polygon(coast, use="water"),
    ]
    write("sketch", *drawn)
    write("sketch_edited", *drawn[:1], PLAIN.polygon(more, use="mountain"), *drawn[1:])
    centre = disc(900, 300, 800)
    west = box(-2600, -1300, 200, 2600)
    areas = [
        PLAIN.polygon(box(-2600, -2600, 2600, 2600), use="flat", example="barcelona_eixample_santmarti"),
        PLAIN.polygon(west, use="flat", example="canberra"),
        PLAIN.polygon(low, use="coast", example="helsinki_center"),
        PLAIN.polygon(centre, use="flat", example="paris_center"),
        PLAIN.polygon(hills, use="mountain", example="quito"),
    ]
    write("domains", *areas)
    write("domains_edited", *areas, PLAIN.polygon(more, use="mountain", example="quito"))
    colors = {"water": (0x30, 0x70, 0xC0), "flat": (0xD0, 0xD0, 0xD0), "mountain": (0x80, 0x60, 0x40)}

    def color(x, y):
        east, north = (x - 125) * 20, (125 - y) * 20
        if abs(east - 300 * math.sin(north / 800)) < 60 or north < -2100:
            return colors["water"]
        return colors["mountain"] if east < -1300 and north > 0 else colors["flat"]

    paint("painted", 250, 250, color)


def redevelopment():
    """Figure 14: a part of Salt Lake City, step by step."""
    at = SALT_LAKE_CITY
    write("salt_area", at.polygon(box(-1500, -1400, 1500, 1400)))
    write("salt_top", at.polygon(box(-1450, 100, 1450, 1350)))
    write("salt_bottom", at.polygon(box(-1450, -1350, 1450, -100)))
    write("salt_plazas", at.polygon(box(-650, -500, 650, 500)))
    write("salt_park", at.polygon(disc(850, -750, 330)))
    write("salt_park_area", at.polygon(disc(850, -750, 290), use="park"))
    paths = [
        at.line([(540, -860), (760, -760), (900, -600), (1010, -470)], highway="residential"),
        at.line([(560, -620), (800, -720), (950, -880), (1080, -960)], highway="residential"),
    ]
    write("salt_paths", *paths)


def growing_city():
    """Figure 1: Porto Alegre grows a quarter, a corner of it is replaced, more is put in."""
    at = PORTO_ALEGRE
    write("porto_area", at.polygon(box(-1700, -1500, 1700, 1500)))
    write("porto_corner", at.polygon(box(500, 300, 1650, 1450)))
    write("porto_plazas", at.polygon(disc(-700, -500, 600)))


def guides():
    """Points for the commands of figures 1, 11, 12 and 14, to be copied into gallery.toml."""
    for x in (-1300, 1300):
        print("start", x, PLAIN.degrees((x, 0)))
    for x in (-1050, 1050):
        print("quarter", PORTO_ALEGRE.degrees((x, 0)))
    for x, y in [(-970, 730), (970, 730), (-530, -330), (0, 110), (530, 330)]:
        print("anew", SALT_LAKE_CITY.degrees((x, y)))
    for x, y in [(-600, -1900), (500, -900), (-500, 0), (500, 900), (-300, 1900)]:
        print("guide", PLAIN.degrees((x, y)))


OUT.mkdir(exist_ok=True)
plain()
content()
redevelopment()
growing_city()
guides()
