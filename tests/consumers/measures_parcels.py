"""measures_parcels.py MEASURED.json: momepy and shapely measure parcels alike."""

import sys

import geopandas
import momepy
import pandas
from agree import load, polygon, same_in_order


def main(file):
    city = load(file)
    parcels = geopandas.GeoSeries([polygon(rings) for rings in city["parcels"]], city["ids"])
    same_in_order("parcel_area", city["area"]["values"], parcels.area)
    rectangularity = momepy.rectangularity(parcels)
    same_in_order("parcel_rectangularity", city["rectangularity"]["values"], rectangularity)
    counts = pandas.Series(city["parcel_of_building"]).value_counts()
    counts = counts.reindex(parcels.index).fillna(0)
    same_in_order("parcel_buildings", city["buildings"]["values"], counts)


main(*sys.argv[1:2])
