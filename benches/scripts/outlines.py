"""outlines.py FILE.json: seconds numpy needs for shape contexts, cyclic time warps and mean value maps."""

import json
import sys
import time

import numpy

with open(sys.argv[1], encoding="ascii") as file:
    given = json.load(file)
outlines = [numpy.array(o) for o in given["outlines"]]
radius = given["radius"]


def best(work, runs=3):
    seconds = float("inf")
    for _ in range(runs):
        started = time.perf_counter()
        result = work()
        seconds = min(seconds, time.perf_counter() - started)
    return seconds, result


def contexts(points):
    tangent = numpy.roll(points, -1, 0) - numpy.roll(points, 1, 0)
    along = numpy.arctan2(tangent[:, 1], tangent[:, 0])
    offset = points[None] - points[:, None]
    distance = numpy.hypot(offset[..., 0], offset[..., 1])
    angle = numpy.arctan2(offset[..., 1], offset[..., 0]) - along[:, None]
    sector = numpy.rint(angle / (2 * numpy.pi) * 8).astype(int) % 8
    ring = numpy.searchsorted(radius / 2.0 ** numpy.arange(4, -1, -1), distance)
    bins = numpy.zeros((len(points), 41))
    index = numpy.where(ring < 5, sector * 5 + numpy.minimum(ring, 4), 40)
    numpy.fill_diagonal(index, 40)
    for row in range(len(points)):
        bins[row] = numpy.bincount(index[row], minlength=41)
    bins = bins[:, :40]
    return bins / numpy.maximum(bins.sum(1, keepdims=True), 1)


def costs(a, b):
    total = a[:, None] + b[None]
    square = (a[:, None] - b[None]) ** 2
    return 0.5 * numpy.divide(square, total, out=numpy.zeros_like(total), where=total > 0).sum(2)


def warp(cost):
    """All rotations at once, by antidiagonals."""
    n, m = cost.shape
    turned = cost[:, (numpy.arange(m)[None] + numpy.arange(m)[:, None]) % m].transpose(1, 0, 2)
    table = numpy.full((m, n + 1, m + 1), numpy.inf)
    table[:, 0, 0] = 0
    for diagonal in range(n + m - 1):
        i = numpy.arange(max(0, diagonal - m + 1), min(n, diagonal + 1))
        j = diagonal - i
        before = numpy.minimum(table[:, i, j], numpy.minimum(table[:, i, j + 1], table[:, i + 1, j]))
        table[:, i + 1, j + 1] = before + turned[:, i, j]
    return table[:, n, m].min() / (n + m)


def mean_value(ring, to, points):
    offset = ring[None] - points[:, None]
    after = numpy.roll(offset, -1, 1)
    distance = numpy.hypot(offset[..., 0], offset[..., 1])
    cross = offset[..., 0] * after[..., 1] - offset[..., 1] * after[..., 0]
    dot = (offset * after).sum(2)
    half = (distance * numpy.roll(distance, -1, 1) - dot) / cross
    weight = (half + numpy.roll(half, 1, 1)) / distance
    return (weight / weight.sum(1, keepdims=True)) @ to


own = contexts(outlines[0])
in_contexts, table = best(lambda: [costs(own, contexts(o)) for o in outlines])
in_warps, _ = best(lambda: [warp(cost) for cost in table], 1)
ring, to, points = (numpy.array(given[k]) for k in ("from", "to", "points"))
in_mean_value, _ = best(lambda: mean_value(ring, to, points))
print(json.dumps({"contexts": in_contexts, "warps": in_warps, "mean_value": in_mean_value}))
