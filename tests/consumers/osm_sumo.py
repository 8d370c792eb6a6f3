"""osm_sumo.py CITY.osm: SUMO's netconvert makes a network of it without errors."""

import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as tree

import sumo


def main(xml):
    netconvert = os.path.join(sumo.SUMO_HOME, "bin", "netconvert")
    with tempfile.TemporaryDirectory() as folder:
        net = os.path.join(folder, "city.net.xml")
        line = [netconvert, "--osm-files", xml, "--junctions.join", "--output-file", net]
        run = subprocess.run(line, capture_output=True, text=True, stdin=subprocess.DEVNULL)
        messages = (run.stdout + run.stderr).splitlines()
        errors = [m for m in messages if m.startswith("Error")]
        assert run.returncode == 0 and not errors, f"status {run.returncode}: {errors}"
        edges = [e for e in tree.parse(net).getroot().iter("edge") if "function" not in e.attrib]
    ways = sum(1 for way in tree.parse(xml).getroot().iter("way")
               if any(t.get("k") == "highway" for t in way.iter("tag")))
    warnings = [m for m in messages if m.startswith("Warning")]
    print(f"{len(edges)} edges of {ways} ways, {len(warnings)} warnings")
    for warning in warnings[:20]:
        print(" ", warning)
    assert len(edges) >= ways, "streets are lost"


main(sys.argv[1])
