"""polygonize.py LINES.txt: seconds shapely needs for the faces of noded lines, as JSON.

A line of the file is one line of the network: coordinates x y x y ...
"""

import json
import sys
import time

import numpy
import shapely

with open(sys.argv[1], encoding="ascii") as file:
    lines = [numpy.array(row.split(), dtype=float).reshape(-1, 2) for row in file]
lines = numpy.array([shapely.LineString(line) for line in lines])
best = float("inf")
for _ in range(3):
    started = time.perf_counter()
    faces = shapely.polygonize(lines)
    best = min(best, time.perf_counter() - started)
area = shapely.area(faces)
print(json.dumps({"seconds": best, "faces": len(faces.geoms), "area_m2": float(area)}))
