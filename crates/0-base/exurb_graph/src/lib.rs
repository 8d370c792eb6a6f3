//! Planar street graph: darts, faces, edits and their laws.
