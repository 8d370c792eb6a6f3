//! Blocks filled by example: parcels and footprints.
