"""gis_geopackage.py CITY.gpkg CITY.geojson: GDAL finds layers, place and scale."""

import sys

import pyogrio
import shapely
from cities import assert_close, elements, load, positions

# Layer, element in the GeoJSON, columns that must be there.
LAYERS = [
    ("streets", "street", "id from to class role level lanes width oneway bridge tunnel layer "
     "junction name origin source part"),
    ("intersections", "intersection", "id kind degree z cut"),
    ("blocks", "block", "id area face_area pavement land_use class origin source"),
    ("parcels", "parcel", "id block area street_access"),
    ("buildings", "building", "id block parcel height levels roof use origin source"),
]


def check(path, layer, features, columns):
    frame = pyogrio.read_dataframe(path, layer=layer)
    missing = set(columns.split()) - {"id"} - set(frame.columns)
    info = pyogrio.read_info(path, layer=layer)
    has_id = "id" in frame.columns or info.get("fid_column") == "id"
    assert not missing and has_id, f"{layer}: no column {missing or 'id'}"
    assert len(frame) == len(features), f"{layer}: {len(frame)} rows, {len(features)} in GeoJSON"
    assert frame.crs is not None and frame.crs.is_projected, f"{layer}: {frame.crs}"
    assert shapely.is_valid(frame.geometry.array).all(), f"{layer}: invalid geometry"

    lonlat = frame.to_crs(4326)
    wanted = [p for f in features for p in positions(f["geometry"]["coordinates"])]
    west, south, east, north = lonlat.total_bounds
    lons, lats = [p[0] for p in wanted], [p[1] for p in wanted]
    for name, got, want in [("west", west, min(lons)), ("south", south, min(lats)),
                            ("east", east, max(lons)), ("north", north, max(lats))]:
        assert abs(got - want) < 2e-7, f"{layer}: {name} {got}, expected {want}"
    return frame


def main(path, geojson):
    city = load(geojson)
    frames = {}
    for layer, element, columns in LAYERS:
        frames[layer] = check(path, layer, elements(city, element), columns)
        print(f"{layer}: {len(frames[layer])} features")
    names = {name for name, _ in pyogrio.list_layers(path)}
    assert {"features", "water", "land_use"} <= names, f"layers are {names}"

    streets, blocks = frames["streets"], frames["blocks"]
    geodesic = streets.crs.get_geod()
    lines = streets.to_crs(4326).geometry
    on_earth = sum(geodesic.geometry_length(line) for line in lines)
    assert_close("metres of streets on the ellipsoid", streets.length.sum(), on_earth, 1e-4)
    assert_close("area of blocks by column", blocks["area"].sum(), blocks.area.sum(), 1e-3)


main(*sys.argv[1:3])
