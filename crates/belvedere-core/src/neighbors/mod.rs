//! Neighbours of points: the one spatial index, used by every stage that searches for near points.
//!
//! A tree with eight children a node and tight boxes, over leaves of 32 points kept as structure of arrays. Ball
//! centres lie far from the surface, where thousands of points are nearly equally far; only tight boxes separate them.
//! On half a million points of a simulated city a nearest point costs 0.34 µs on the surface, 0.5 µs from 5 m and 1.0
//! µs from 200 m below it. The kd-tree crate kiddo takes 0.24, 2.1 and 57 µs (`research/benches`).
//!
//! | question | method |
//! |---|---|
//! | which point is nearest, if within a bound | [`NeighborIndex::nearest_within`] |
//! | which k points are nearest | [`NeighborIndex::k_nearest`] |
//! | which points lie within a radius | [`NeighborIndex::within_radius`] |
//! | how large can a ball tangent here grow | [`NeighborIndex::smallest_tangent_ball`] |
//!
//! Every answer is exact in f32 and the same with and without AVX2; equally far points are ordered by index.

#[cfg(target_arch = "x86_64")]
mod avx2;
mod build;
mod lanes;
mod search;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
mod simd128;
mod tangent;
mod tangent_ball;

pub use crate::instructions::Instructions;
pub use search::Neighbor;
pub use tangent::Tangent;

use belvedere_data::control::Control;
use belvedere_data::{Error, Parameter, Result};
#[cfg(not(all(target_arch = "wasm32", target_feature = "simd128")))]
use lanes::NeighborScalar as NeighborPlain;
use lanes::PointTree;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
use simd128::NeighborSimd128 as NeighborPlain;

/// Maximum distance of a neighbour in a survey from the air, metres: more than the usual 16 neighbours need on any
/// surface.
pub const FARTHEST_NEIGHBOR: f32 = 16.0;

/// A spatial index over points, built once and searched by any number of threads.
///
/// Memory: 16 bytes a point and about 1 byte a point for the nodes.
#[derive(Debug)]
pub struct NeighborIndex {
    tree: PointTree,
    instructions: Instructions,
}

impl NeighborIndex {
    /// Builds the index over `points`, (N, 3), metres; N may be zero.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a coordinate that is not finite or beyond 1e18, and for 2³² points or more;
    /// [`Error::Cancelled`].
    pub fn new(points: &[[f32; 3]], control: &Control<'_>) -> Result<Self> {
        Self::with_instructions(points, Instructions::detect(), control)
    }

    /// Creates the index as [`NeighborIndex::new`], searched with the given instructions. A set that this machine lacks
    /// gives scalar searches.
    ///
    /// # Errors
    /// As [`NeighborIndex::new`].
    pub fn with_instructions(points: &[[f32; 3]], instructions: Instructions, control: &Control<'_>) -> Result<Self> {
        if u32::try_from(points.len()).is_err() {
            return Err(Error::invalid(Parameter::PointCount, points.len(), "below 2^32; split the cloud into tiles"));
        }
        check_positions(points)?;
        let instructions = if instructions == Instructions::detect() { instructions } else { Instructions::Scalar };
        Ok(Self { tree: build::build(points, control)?, instructions })
    }

    /// The index of the same points after each moved a little: faster to make than a new one, as fast to search.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] for another number of points, [`Error::InvalidParameter`] for a coordinate that is not
    /// finite or beyond 1e18.
    pub fn moved_to(self, points: &[[f32; 3]]) -> Result<Self> {
        if points.len() != self.len() {
            return Err(Error::LengthMismatch { what: "moved points", expected: self.len(), found: points.len() });
        }
        check_positions(points)?;
        Ok(Self { tree: build::refit(points, &self.tree.order), ..self })
    }

    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.tree.order.len()
    }

    /// Returns true if there is no point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.tree.is_empty()
    }

    /// Indices of the points in tree order: neighbours in this list are near each other in space, so work done in this
    /// order finds its memory in the cache.
    #[must_use]
    pub fn tree_order(&self) -> &[u32] {
        &self.tree.order
    }

    /// The point nearest to `query` whose squared distance is strictly below `bound_squared`, or `None`. Of equally
    /// near points the one with the lowest index.
    #[must_use]
    pub fn nearest_within(&self, query: [f32; 3], bound_squared: f32) -> Option<Neighbor> {
        match self.instructions {
            Instructions::Scalar => search::nearest::<NeighborPlain>(&self.tree, query, bound_squared),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => avx2::nearest(&self.tree, query, bound_squared),
        }
    }

    /// Puts the `k` points nearest to `query` (all, if there are fewer) into `found`, nearest first, equally near ones
    /// by index.
    pub fn k_nearest(&self, query: [f32; 3], k: usize, found: &mut Vec<Neighbor>) {
        match self.instructions {
            Instructions::Scalar => search::k_nearest::<NeighborPlain>(&self.tree, query, k, found),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => avx2::k_nearest(&self.tree, query, k, found),
        }
    }

    /// Calls `visit` with every point at most `radius` metres from `query`, in an order that depends on the points
    /// only.
    pub fn within_radius(&self, query: [f32; 3], radius: f32, visit: impl FnMut(Neighbor)) {
        match self.instructions {
            Instructions::Scalar => search::within_radius::<NeighborPlain>(&self.tree, query, radius, visit),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => avx2::within_radius(&self.tree, query, radius, visit),
        }
    }

    /// Returns the smallest radius, below `max_radius`, of a ball tangent as in `tangent` whose surface passes through
    /// a point, with the index of that point. `None` if the ball of `max_radius` holds no point.
    ///
    /// This is the nearest neighbour in the pencil of balls that touch one plane at one point.
    #[must_use]
    pub fn smallest_tangent_ball(&self, tangent: &Tangent, max_radius: f32) -> Option<(f32, u32)> {
        match self.instructions {
            Instructions::Scalar => tangent_ball::search::<NeighborPlain>(&self.tree, tangent, max_radius),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => avx2::smallest_tangent_ball(&self.tree, tangent, max_radius),
        }
    }
}

/// A squared distance must not overflow: (2e18)² · 3 is below the largest f32.
fn check_positions(points: &[[f32; 3]]) -> Result<()> {
    match points.iter().find(|p| !p.iter().all(|v| v.abs() < 1e18)) {
        Some(p) => Err(Error::invalid(Parameter::Position, format!("{p:?}"), "finite")),
        None => Ok(()),
    }
}
