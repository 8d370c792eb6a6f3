"""What the checks of measures share: reading what exurb measured, and comparing."""

import json

import numpy as np
import shapely


def load(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def same(what, ours, theirs, rtol=1e-6):
    """Asserts that two sets of values agree, whatever their order."""
    ours, theirs = (np.sort(np.asarray(list(v), dtype=float)) for v in (ours, theirs))
    assert len(ours) == len(theirs) > 0, f"{what}: {len(ours)} values here, {len(theirs)} there"
    same_in_order(what, ours, theirs, rtol)


def same_in_order(what, ours, theirs, rtol=1e-6):
    """Asserts that two lists of values agree, one by one."""
    ours, theirs = (np.atleast_1d(np.asarray(v, dtype=float)) for v in (ours, theirs))
    assert ours.shape == theirs.shape and ours.size > 0, f"{what}: {ours.shape} and {theirs.shape}"
    assert np.isfinite(ours).all(), f"{what} is not finite here"
    off = np.abs(ours - theirs) / np.maximum(np.abs(theirs), 1e-3)
    worst = int(off.argmax())
    assert off[worst] <= rtol, f"{what}: {ours[worst]} here, {theirs[worst]} there"
    print(f"{what}: {len(ours)} values agree within {off[worst]:.1e}")


def polygon(rings):
    return shapely.Polygon(rings[0], rings[1:])
