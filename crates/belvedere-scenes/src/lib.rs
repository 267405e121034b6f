//! Simulated towns with exact meshes, and simulated laser scans of them.
