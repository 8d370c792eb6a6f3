"""tessellation.py FILE.json: seconds momepy needs for the cells of footprints inside their blocks."""

import json
import sys
import time
import warnings

import geopandas
import momepy
import shapely

warnings.filterwarnings("ignore")
with open(sys.argv[1], encoding="ascii") as file:
    given = json.load(file)


def frame(rings):
    return geopandas.GeoDataFrame(geometry=[p for p in map(shapely.Polygon, rings) if p.is_valid], crs=3857)


footprints, blocks = frame(given["footprints"]), frame(given["blocks"])
started = time.perf_counter()
cells = momepy.enclosed_tessellation(footprints, blocks, n_jobs=1)
print(json.dumps({"seconds": time.perf_counter() - started, "cells": len(cells)}))
