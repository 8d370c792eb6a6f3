//! Heights, roofs and shapes of buildings by example.
