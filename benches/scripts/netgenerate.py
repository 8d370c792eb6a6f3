"""netgenerate.py ITERATIONS: SUMO's random network; kilometres and seconds as JSON."""

import json
import os
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as tree

import sumo

with tempfile.TemporaryDirectory() as folder:
    net = os.path.join(folder, "r.net.xml")
    line = [os.path.join(sumo.SUMO_HOME, "bin", "netgenerate"), "--rand", "--rand.iterations",
            sys.argv[1], "--rand.max-distance", "250", "--rand.min-distance", "60", "--seed", "42",
            "--no-warnings", "-o", net]
    started = time.perf_counter()
    subprocess.run(line, check=True, stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
    seconds = time.perf_counter() - started
    pairs = {}
    for edge in tree.parse(net).getroot().iter("edge"):
        if "function" not in edge.attrib:
            ends = frozenset((edge.get("from"), edge.get("to")))
            pairs[ends] = float(edge.find("lane").get("length"))
print(json.dumps({"seconds": seconds, "km": sum(pairs.values()) / 1000}))
