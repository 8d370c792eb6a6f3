"""Writes the Prague example (streets, parcels, buildings) as one GeoJSON file.

    python data/cut_prague.py bubenec.gpkg data/prague.geojson

`bubenec.gpkg` lies in momepy's wheel under `momepy/datasets`. Needs the packages of
data/requirements.txt.
"""

import json
import sys

import geopandas
import shapely

# Layer of the package, its element here, further properties of every feature.
LAYERS = [
    ("streets", "street", {"highway": "residential"}),
    ("plots", "parcel", {}),
    ("buildings", "building", {"building": "yes"}),
]


def features(path):
    for layer, element, properties in LAYERS:
        frame = geopandas.read_file(path, layer=layer).to_crs(4326)
        for shape in frame.geometry:
            for part in shapely.get_parts(shape):
                if part.geom_type == "Polygon":
                    part = shapely.geometry.polygon.orient(part)
                geometry = shapely.geometry.mapping(shapely.transform(part, lambda c: c.round(7)))
                yield {
                    "type": "Feature",
                    "properties": {"element": element, **properties},
                    "geometry": geometry,
                }


def main(source, target):
    with open(target, "w", encoding="utf-8") as out:
        lines = ",\n".join(json.dumps(f, separators=(",", ":")) for f in features(source))
        out.write('{"type":"FeatureCollection","features":[\n' + lines + "\n]}\n")


if __name__ == "__main__":
    main(*sys.argv[1:3])
