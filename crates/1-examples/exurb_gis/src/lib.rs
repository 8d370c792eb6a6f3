//! GeoPackage and GeoJSON both ways.
