//! The map from above, as SVG and PNG.
