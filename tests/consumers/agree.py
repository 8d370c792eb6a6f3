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


def same_aspects(what, ours, theirs, shapes):
    """Aspects of smallest rectangles agree, or belong to another rectangle of the same area."""
    off = np.abs(np.asarray(ours) - np.asarray(theirs)) > 1e-6 * np.asarray(theirs)
    for i in np.flatnonzero(off):
        tied = [aspect for aspect, _ in smallest_rectangles(np.asarray(shapes)[i])]
        assert len(tied) > 1 and any(abs(ours[i] - a) <= 1e-6 for a in tied), f"{what}: {ours[i]} {tied}"
    assert off.mean() < 0.05, f"{what}: {off.sum()} of {len(off)} differ"
    print(f"{what}: {len(off)} values agree but for {off.sum()} with several smallest rectangles")


def smallest_rectangles(shape):
    """Aspect and direction (0 to 90°) of the rectangles along the sides of the convex hull that have the
    smallest area, or nearly."""
    ring = shapely.get_coordinates(shape.convex_hull)
    sides = np.diff(ring, axis=0)
    axes = sides / np.hypot(*sides.T)[:, None]
    along = np.ptp(ring @ axes.T, axis=0)
    across = np.ptp(ring @ np.array([-axes[:, 1], axes[:, 0]]), axis=0)
    nearly = along * across <= (along * across).min() * (1 + 1e-8)
    aspects = np.minimum(along, across) / np.maximum(along, across)
    turned = np.degrees(np.arctan2(axes[:, 1], axes[:, 0])) % 90
    return list(zip(aspects[nearly], turned[nearly]))
