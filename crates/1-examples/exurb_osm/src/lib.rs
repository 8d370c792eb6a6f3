//! OpenStreetMap files both ways.
