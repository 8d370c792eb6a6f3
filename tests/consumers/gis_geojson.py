"""gis_geojson.py CITY.geojson: RFC 7946 and the city's own columns."""

import sys

from cities import elements, load, positions

ELEMENTS = {"street", "intersection", "block", "parcel", "building", "tree", "lamp", "feature",
            "water", "land_use", "target"}
DEPTH = {"Point": 0, "LineString": 1, "Polygon": 2, "MultiPolygon": 3}


def area(ring):
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(ring, ring[1:])) / 2


def depth(coordinates):
    return 0 if isinstance(coordinates[0], (int, float)) else 1 + depth(coordinates[0])


def check_polygon(rings, where):
    for index, ring in enumerate(rings):
        assert len(ring) >= 4 and ring[0] == ring[-1], f"{where}: open ring"
        assert area(ring) != 0, f"{where}: ring without area"
        assert (area(ring) > 0) == (index == 0), f"{where}: ring {index} is wound the wrong way"


def check(feature, where):
    assert feature["type"] == "Feature", where
    assert feature["properties"]["element"] in ELEMENTS, f"{where}: {feature['properties']}"
    geometry = feature["geometry"]
    kind, coordinates = geometry["type"], geometry["coordinates"]
    assert depth(coordinates) == DEPTH[kind], f"{where}: {kind} of depth {depth(coordinates)}"
    for lon, lat, *height in positions(coordinates):
        assert -180 <= lon <= 180 and -90 <= lat <= 90 and len(height) <= 1, f"{where}: {lon} {lat}"
    if kind == "LineString":
        assert len(coordinates) >= 2, f"{where}: line of one point"
    if kind == "Polygon":
        check_polygon(coordinates, where)
    if kind == "MultiPolygon":
        for rings in coordinates:
            check_polygon(rings, where)


def main(path):
    city = load(path)
    assert city["type"] == "FeatureCollection" and "crs" not in city
    for index, feature in enumerate(city["features"]):
        check(feature, f"feature {index}")
    assert len(elements(city, "target")) == 1, "one target"
    for element, key in (("street", "highway"), ("building", "building")):
        assert elements(city, element), f"no {element}"
        assert all(key in f["properties"] for f in elements(city, element)), f"{element}: {key}"

    west, south, east, north = city["bbox"]
    assert west < east and south < north, "empty bbox"
    outline = elements(city, "target")[0]["geometry"]["coordinates"][0]
    lons, lats = zip(*(p[:2] for p in outline))
    slack = 1e-7
    assert min(lons) - slack <= west and east <= max(lons) + slack, "bbox wider than the target"
    assert min(lats) - slack <= south and north <= max(lats) + slack, "bbox higher than the target"
    print(f"{len(city['features'])} features, bbox {city['bbox']}")


main(sys.argv[1])
