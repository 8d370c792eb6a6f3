"""measure.py COMMAND...: runs it once and prints seconds and peak memory as one line of JSON.

The command's own output goes to standard error, or to the file named by MEASURE_OUTPUT.
"""

import json
import os
import subprocess
import sys
import time

out = os.environ.get("MEASURE_OUTPUT")
with open(out, "wb") if out else os.fdopen(os.dup(2), "wb") as sink:
    started = time.perf_counter()
    child = subprocess.Popen(sys.argv[1:], stdin=subprocess.DEVNULL, stdout=sink)
    _, status, usage = os.wait4(child.pid, 0)
    seconds = time.perf_counter() - started
code = os.waitstatus_to_exitcode(status)
print(json.dumps({"seconds": seconds, "peak_mb": usage.ru_maxrss / 1000, "status": code}))
