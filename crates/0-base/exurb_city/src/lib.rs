//! The city model: streets, blocks, parcels, buildings, features, provenance.
