"""What the checks share: a city's GeoJSON read with nothing but the standard library."""

import json
import math

EARTH_M = 6371008.8


def load(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def elements(city, element):
    return [f for f in city["features"] if f["properties"]["element"] == element]


def distance_m(a, b):
    """Great circle between two points (lon, lat); within 0.6 % of the ellipsoid."""
    (lon1, lat1), (lon2, lat2) = ([math.radians(v) for v in p[:2]] for p in (a, b))
    half = math.sin((lat2 - lat1) / 2) ** 2
    half += math.cos(lat1) * math.cos(lat2) * math.sin((lon2 - lon1) / 2) ** 2
    return 2 * EARTH_M * math.asin(math.sqrt(half))


def length_m(points):
    return sum(distance_m(a, b) for a, b in zip(points, points[1:]))


def streets_m(city):
    return sum(length_m(f["geometry"]["coordinates"]) for f in elements(city, "street"))


def positions(coordinates):
    """All positions of nested coordinates."""
    if isinstance(coordinates[0], (int, float)):
        yield coordinates
        return
    for part in coordinates:
        yield from positions(part)


def assert_close(what, got, wanted, share=0.001):
    assert abs(got - wanted) <= share * abs(wanted), f"{what}: {got}, expected {wanted}"
    print(f"{what}: {got:.6g} (expected {wanted:.6g})")
