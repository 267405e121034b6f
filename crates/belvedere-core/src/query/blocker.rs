//! Kinds of obstacles on lines of sight.

use belvedere_data::PatchKind;

/// Kind of an obstacle on a line of sight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Blocker {
    /// A ball, by its row among those that the scene was made of.
    Ball(usize),
    /// A mesh that was added, by its number ([`super::BlockingTriangles::names`]).
    Mesh(usize),
    /// A patch of a surface of the survey, by the kind of its surface.
    Patch(PatchKind),
    /// Terrain of the elevation raster beyond the cloud.
    Terrain,
}

impl Blocker {
    /// The row of a ball.
    #[must_use]
    pub fn ball(self) -> Option<usize> {
        if let Self::Ball(row) = self { Some(row) } else { None }
    }

    /// The number of a mesh.
    #[must_use]
    pub fn mesh(self) -> Option<usize> {
        if let Self::Mesh(number) = self { Some(number) } else { None }
    }

    /// Returns the kind of the patch, if it is one.
    #[must_use]
    pub fn patch(self) -> Option<PatchKind> {
        if let Self::Patch(kind) = self { Some(kind) } else { None }
    }
}

/// The nearer of a ball and a triangle, each with its range; the ball where both are equally near.
pub(super) fn nearest_blocker(
    ball: Option<(Blocker, f64)>,
    triangle: Option<(Blocker, f64)>,
) -> Option<(Blocker, f64)> {
    match (ball, triangle) {
        (Some(ball), Some(triangle)) if triangle.1 < ball.1 => Some(triangle),
        (None, triangle) => triangle,
        (ball, _) => ball,
    }
}
