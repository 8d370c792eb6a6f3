//! Street networks by example.
