"""measures_buildings.py MEASURED.json: momepy and shapely measure buildings and built blocks alike."""

import sys
import warnings

import geopandas
import momepy
import numpy as np
import pandas
import shapely
from agree import load, polygon, same_aspects, same_in_order, smallest_rectangles
from libpysal.graph import Graph


def main(file):
    warnings.simplefilter("ignore")
    city = load(file)
    everything = geopandas.GeoSeries([polygon(rings) for rings in city["footprints"]])
    shapes = pandas.DataFrame(city["shapes"]).set_index("number")
    own = everything[shapes.index]
    same_in_order("b_area", shapes["area"], own.area)
    same_in_order("b_rectangularity", shapes["rectangularity"], momepy.rectangularity(own))
    elongation = shapes["elongation"].to_numpy()
    same_aspects("b_elongation", elongation, momepy.elongation(own).to_numpy(), own)
    corners(shapes, own)
    streets(shapes, own, city["streets"])
    gaps(shapes, own, everything)
    blocks(city, shapes, own)


def corners(shapes, own):
    # momepy counts vertices that turn by more than 10°, whatever they cut off; here what stands out
    # by under 0.7 m is no corner. A rectangle has four by either.
    theirs = momepy.corners(own)
    plain = (theirs == 4) & (momepy.rectangularity(own) > 0.999)
    assert (shapes["corners"][plain] == 4).all() and plain.sum() > 100
    simple = own.simplify(0.7).count_coordinates() - 1
    share = (shapes["corners"] == np.minimum(simple, 30)).mean()
    assert share > 0.9, f"b_corners: {share:.3f} of the buildings have the vertices of shapely's outline"
    print(f"b_corners: 4 of {plain.sum()} rectangles; {share:.3f} as shapely's simplified outline")


def streets(shapes, own, lines):
    pieces = [pair for line in lines for pair in zip(line, line[1:])]
    pieces = geopandas.GeoSeries([shapely.LineString(pair) for pair in pieces])
    # The nearest street is momepy's get_nearest_street, the distance shapely's.
    tree = shapely.STRtree(pieces.array)
    near = tree.nearest(own.array)
    setbacks = shapely.distance(own.array, pieces.array[near])
    same_in_order("b_setback", shapes["setback"], np.minimum(setbacks, 150.0))

    # momepy compares two orientations that are folded to 0..45° already, which loses on which side
    # of the axis each lies: its difference is never the larger one.
    has = shapes["alignment"].notna().to_numpy()
    theirs = momepy.street_alignment(momepy.orientation(own), momepy.orientation(pieces), pandas.Series(near))
    theirs, ours = theirs.to_numpy()[has], shapes["alignment"].to_numpy(dtype=float)[has]
    # Where several pieces are equally near, or several rectangles equally small, anything goes.
    tied = [len(tree.query(b, "dwithin", d + 1e-6)) for b, d in zip(own.array[has], setbacks[has])]
    clear = (np.array(tied) == 1) & np.array([has_one_direction(b) for b in own.array[has]])
    assert clear.mean() > 0.5, f"{clear.mean()} of the buildings are clear"
    assert (theirs[clear] <= ours[clear] + 1e-5).all()
    axis = np.array([smallest_rectangles(b)[0][1] for b in own.array[has]])
    ends = shapely.get_coordinates(pieces.array[near[has]]).reshape(-1, 2, 2)
    street = np.degrees(np.arctan2(*(ends[:, 1] - ends[:, 0]).T[::-1]))
    quarter = (axis - street) % 90
    wanted = np.minimum(quarter, 90 - quarter)
    same_in_order("b_street_alignment", ours[clear], wanted[clear], 1e-5)


def has_one_direction(shape):
    turned = np.array([turned for _, turned in smallest_rectangles(shape)])
    apart = np.abs(turned - turned[0])
    return np.minimum(apart, 90 - apart).max() < 1e-5


def gaps(shapes, own, everything):
    tree = shapely.STRtree(everything.array)
    nearest = pandas.Series(everything.index, everything.index)
    for number, footprint in own.items():
        others = tree.query(footprint, "dwithin", 60.0)
        others = others[others != number]
        if len(others):
            apart = shapely.distance(footprint, everything.array[others])
            nearest[number] = others[np.argmin(apart)]
    # momepy's neighbor_distance is the mean over the neighbours of a graph: here of the nearest one.
    alone = (nearest == nearest.index).to_numpy()
    graph = Graph.from_arrays(everything.index, nearest, np.where(alone, 0, 1))
    theirs = momepy.neighbor_distance(everything, graph)[own.index]
    theirs[alone[own.index]] = 60.0
    same_in_order("b_nearest_building", shapes["gap"], theirs)


def blocks(city, shapes, own):
    faces = geopandas.GeoDataFrame(geometry=[polygon(rings) for rings in city["blocks"]])
    points = geopandas.GeoDataFrame({"area": own.area}, geometry=own.centroid)
    home = points.sjoin(faces, predicate="within")["index_right"]
    # momepy's describe_agg sums what lies in a block.
    found = momepy.describe_agg(points["area"].loc[home.index], home)
    found = found.reindex(faces.index).fillna(0.0)
    same_in_order("blk_coverage_gsi", city["coverage"]["values"], found["sum"] / faces.area)
    per_ha = found["count"] / (faces.area / 1e4)
    same_in_order("blk_buildings_per_ha", city["buildings_per_ha"]["values"], per_ha)


main(*sys.argv[1:2])
