//! Points and bounds that a hierarchy or a catalogue announces for a file.

/// Description of a LAS or LAZ file by another file.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(not(feature = "las"), allow(dead_code, reason = "compared with headers of LAS files"))]
pub(crate) struct Announced {
    /// Name of the other file.
    pub(crate) by: String,
    /// Number of points.
    pub(crate) points: Option<u64>,
    /// Lowest and highest corner of a box around them, in the coordinates of the file.
    pub(crate) bounds: Option<([f64; 3], [f64; 3])>,
    /// Kind of the box.
    pub(crate) bounds_are: BoundsAre,
}

/// A box around points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BoundsAre {
    /// The bounds of the points, which a header repeats.
    OfPoints,
    /// A cell that holds the points. Headers of nodes may give the bounds of a larger cell.
    OfCell,
}
