"""warp.py IN.geojson OUT.geojson: bends a map as an image is bent (figure 12 b).

Every place is moved as the guideline of figure 12 moves the middle of the map: north stays north, and
what lies beside the line is carried along. Circles become ellipses; that is the point.
"""

import json
import math
import sys

document = json.load(open(sys.argv[1]))
places = []


def walk(coordinates):
    if isinstance(coordinates[0], (int, float)):
        places.append(coordinates)
    else:
        for part in coordinates:
            walk(part)


for feature in document["features"]:
    if feature.get("geometry"):
        walk(feature["geometry"]["coordinates"])
low, high = min(p[1] for p in places), max(p[1] for p in places)
west, east = min(p[0] for p in places), max(p[0] for p in places)
for place in places:
    along = (place[1] - low) / (high - low)
    place[0] += 0.28 * (east - west) * math.sin(2.0 * math.tau * along * 0.5 * 2)
document.pop("bbox", None)
json.dump(document, open(sys.argv[2], "w"))
