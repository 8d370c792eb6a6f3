"""osmnx_graph.py MAP.osm: seconds OSMnx needs for its graph, imports left out, as JSON."""

import json
import sys
import time

import osmnx

started = time.perf_counter()
graph = osmnx.graph_from_xml(sys.argv[1])
seconds = time.perf_counter() - started
print(json.dumps({"seconds": seconds, "edges": graph.number_of_edges()}))
