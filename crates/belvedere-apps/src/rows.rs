//! Rows of the visibility matrix as a stream: which directions each target sees, a block of targets at a time.
//!
//! Sun hours, sky views, shadows, irradiance and exposure are sums over the directions that a target sees. A sum needs
//! the row of one target only, so that no application holds the matrix of all targets: memory stays bounded however
//! many targets and directions there are. Rows do not depend on each other, and no result depends on how targets are
//! cut into blocks.

use crate::tree_light::{CrownLight, Season, TreeLight};
use belvedere_core::medium::{HALF_DEPTH, Medium};
use belvedere_core::query::{MedialScene, VisibilityMatrix};
use belvedere_data::control::Control;
use belvedere_data::error::check_length;
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use std::ops::Range;

/// Bits of all rows that are held at a time: 64 MiB. Fewer would sweep the scene more often, more would not be faster.
pub const BLOCK_BITS: usize = 1 << 29;
/// Targets handed to a thread at once.
const CHUNK: usize = 256;

/// Obstacles to the light on its way to a target.
#[derive(Clone, Copy)]
pub struct Obstacles<'a> {
    /// All that blocks.
    pub scene: &'a MedialScene,
    /// The trees of the scene, where they let a share of the light through; `None` where they are opaque.
    pub trees: Option<&'a TreeLight>,
}

impl<'a> From<&'a MedialScene> for Obstacles<'a> {
    fn from(scene: &'a MedialScene) -> Self {
        Self { scene, trees: None }
    }
}

impl Obstacles<'_> {
    /// Number of matrices to compute: one, or two where trees let light through.
    #[must_use]
    pub fn matrix_count(&self) -> usize {
        SkyObstacles::from(*self).matrix_count()
    }
}

/// Obstacles that do not fit into memory, and are looked at part by part.
pub trait ObstacleParts: Send + Sync {
    /// Returns the transmissivity of crowns; `None` if trees are opaque.
    fn crowns(&self) -> Option<CrownLight>;

    /// The medium of crowns, where [`CrownLight::Measured`] is wanted.
    fn medium(&self) -> Option<&Medium>;

    /// Computes which of `directions`, (D, 3) unit vectors, each of `targets`, (M, 3) local metres, sees. If trees let
    /// a share of the light through, the second matrix is that of the scene without them. The bits are those of one
    /// scene of all parts. If crowns were measured, the first matrix is already without trees. Progress counts targets,
    /// once for each matrix.
    ///
    /// # Errors
    /// Those of [`MedialScene::visibility_matrix`] and of reading the parts.
    fn look(
        &self,
        targets: &[[f32; 3]],
        directions: &[[f64; 3]],
        control: &Control<'_>,
    ) -> Result<(VisibilityMatrix, Option<VisibilityMatrix>)>;

    /// Flags the `targets`, (M, 3) local metres, that lie inside an obstacle.
    ///
    /// # Errors
    /// Those of reading the parts.
    fn are_inside_obstacles(&self, targets: &[[f32; 3]], control: &Control<'_>) -> Result<Vec<bool>>;

    /// Returns 1 for each of `targets` that `lit`, (M), says is lit, but whose line of sight to the sun no pulse
    /// proves, and 0 for others; `None` for a survey without known pulses.
    ///
    /// # Errors
    /// Those of reading the parts.
    fn unproven_light(
        &self,
        targets: &[[f32; 3]],
        to_sun: [f64; 3],
        lit: &[f32],
        control: &Control<'_>,
    ) -> Result<Option<Vec<f32>>>;

    /// Returns the probability that each of `targets`, (M, 3) local metres, is lit by a sun with hard edges; NaN for
    /// one without a position.
    ///
    /// # Errors
    /// Those of reading the parts.
    fn lit_probabilities(
        &self,
        targets: &[[f32; 3]],
        to_sun: [f64; 3],
        season: Option<Season>,
        control: &Control<'_>,
    ) -> Result<Vec<f32>>;
}

/// All that may stand between targets and the sky.
#[derive(Clone, Copy)]
pub enum SkyObstacles<'a> {
    /// Scene in one piece.
    Whole(Obstacles<'a>),
    /// Part by part.
    InParts(&'a dyn ObstacleParts),
}

impl<'a> From<Obstacles<'a>> for SkyObstacles<'a> {
    fn from(obstacles: Obstacles<'a>) -> Self {
        Self::Whole(obstacles)
    }
}

impl<'a> From<&'a MedialScene> for SkyObstacles<'a> {
    fn from(scene: &'a MedialScene) -> Self {
        Self::Whole(scene.into())
    }
}

impl<'a> SkyObstacles<'a> {
    /// Returns the transmissivity of crowns; `None` if trees are opaque.
    #[must_use]
    pub fn crowns(&self) -> Option<CrownLight> {
        match self {
            Self::Whole(obstacles) => obstacles.trees.map(|trees| trees.crowns),
            Self::InParts(parts) => parts.crowns(),
        }
    }

    /// Number of matrices to compute: two where trees let a share of the light through, else one.
    #[must_use]
    pub fn matrix_count(&self) -> usize {
        1 + usize::from(matches!(self.crowns(), Some(CrownLight::Share { .. })))
    }

    fn medium(&self) -> Option<&'a Medium> {
        match self {
            Self::Whole(obstacles) => obstacles.trees.and_then(|trees| trees.medium.as_deref()),
            Self::InParts(parts) => parts.medium(),
        }
    }

    /// Flags the `targets`, (M, 3) local metres, that lie inside an obstacle.
    ///
    /// # Errors
    /// Those of [`ObstacleParts::are_inside_obstacles`].
    pub(crate) fn are_inside_obstacles(&self, targets: &[[f32; 3]], control: &Control<'_>) -> Result<Vec<bool>> {
        match self {
            Self::Whole(obstacles) => {
                let is_inside = |target: &[f32; 3]| obstacles.scene.is_inside_obstacle(target.map(f64::from));
                Ok(targets.par_iter().with_min_len(CHUNK).map(is_inside).collect())
            }
            Self::InParts(parts) => parts.are_inside_obstacles(targets, control),
        }
    }

    fn look(
        &self,
        targets: &[[f32; 3]],
        directions: &[[f64; 3]],
        control: &Control<'_>,
    ) -> Result<(VisibilityMatrix, Option<VisibilityMatrix>)> {
        match self {
            Self::Whole(Obstacles { scene, trees }) => {
                let without = || trees.map(|trees| trees.opaque.visibility_matrix(targets, directions, control));
                if let (Some(_), Some(without)) = (self.medium(), without()) {
                    return Ok((without?, None));
                }
                Ok((scene.visibility_matrix(targets, directions, control)?, without().transpose()?))
            }
            Self::InParts(parts) => parts.look(targets, directions, control),
        }
    }
}

/// The rows of some targets.
#[derive(Clone, Debug)]
pub struct RowBlock<'a> {
    /// Range of the targets of the block.
    pub rows: Range<usize>,
    /// Directions that each of them sees; row 0 is that of the first target of the block. Crowns block, unless they
    /// were measured.
    pub matrix: VisibilityMatrix,
    /// Transmissivity of crowns; `None` if they are opaque.
    pub crowns: Option<CrownRows<'a>>,
}

/// Light through crowns to the targets of a block.
#[derive(Clone, Debug)]
pub enum CrownRows<'a> {
    /// The same share for all crowns: the matrix of the scene without trees.
    Share(VisibilityMatrix),
    /// Extinction measured by pulses.
    Measured {
        /// The crowns.
        medium: &'a Medium,
        /// The targets of the block, (M, 3) local metres.
        targets: &'a [[f32; 3]],
        /// Directions of the columns, (D, 3) unit vectors.
        directions: &'a [[f64; 3]],
    },
}

/// Obstruction of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LineLight {
    /// No obstacle.
    Free,
    /// Something opaque.
    Blocked,
    /// A crown that lets a share through that is the same for all.
    Crown,
    /// Crowns of this optical depth, above 0.
    Depth(f64),
}

impl LineLight {
    /// Share of the light that arrives, 0 to 1, where crowns have this [`CrownLight::factor`].
    #[must_use]
    pub fn share(self, factor: f64) -> f64 {
        match self {
            Self::Free => 1.0,
            Self::Blocked => 0.0,
            Self::Crown => factor,
            Self::Depth(depth) => (-factor * depth).exp(),
        }
    }

    /// Returns true if the line counts as free for a yes or no: half or more of the light passes the measured crowns,
    /// whose depth is multiplied by `factor`, and nothing else is there.
    #[must_use]
    pub fn is_free(self, factor: f64) -> bool {
        match self {
            Self::Free => true,
            Self::Blocked | Self::Crown => false,
            Self::Depth(depth) => factor * depth <= HALF_DEPTH,
        }
    }
}

impl From<VisibilityMatrix> for RowBlock<'_> {
    /// The rows of all targets, where trees are opaque.
    fn from(matrix: VisibilityMatrix) -> Self {
        Self { rows: 0..matrix.target_count(), matrix, crowns: None }
    }
}

impl RowBlock<'_> {
    /// Returns the obstruction of the line from a target of the block in the direction of a column.
    #[must_use]
    pub fn line(&self, row: usize, column: usize) -> LineLight {
        match (&self.crowns, self.matrix.is_free(row, column)) {
            (Some(CrownRows::Measured { medium, targets, directions }), true) => {
                let (Some(target), Some(direction)) = (targets.get(row), directions.get(column)) else {
                    return LineLight::Blocked;
                };
                let depth = medium.optical_depth(target.map(f64::from), *direction, f64::INFINITY);
                if depth > 0.0 { LineLight::Depth(depth) } else { LineLight::Free }
            }
            (_, true) => LineLight::Free,
            (Some(CrownRows::Share(without)), false) if without.is_free(row, column) => LineLight::Crown,
            (_, false) => LineLight::Blocked,
        }
    }

    /// Share of the light that arrives at a target of the block from the direction of each column, (D), where crowns
    /// have this [`CrownLight::factor`].
    #[must_use]
    pub fn light(&self, row: usize, factor: f64) -> Vec<f64> {
        (0..self.matrix.direction_count()).map(|column| self.line(row, column).share(factor)).collect()
    }

    /// The bits of [`LineLight::is_free`] of all lines of the block, where crowns have this [`CrownLight::factor`].
    ///
    /// # Errors
    /// Those of [`VisibilityMatrix::from_words`].
    pub fn free_lines(&self, factor: f64) -> Result<VisibilityMatrix> {
        if !matches!(self.crowns, Some(CrownRows::Measured { .. })) {
            return Ok(self.matrix.clone());
        }
        let (targets, directions) = (self.matrix.target_count(), self.matrix.direction_count());
        let of_target = |row: usize| {
            let bit = |column: usize| u64::from(column < directions && self.line(row, column).is_free(factor));
            (0..directions.div_ceil(64))
                .map(|word| (0..64).fold(0, |bits, place| bits | bit(64 * word + place) << place))
                .collect::<Vec<u64>>()
        };
        let words: Vec<Vec<u64>> = (0..targets).into_par_iter().map(of_target).collect();
        VisibilityMatrix::from_words(targets, directions, words.concat())
    }
}

/// Computes which of `directions`, (D, 3) unit vectors, each of `targets`, (M, 3) local metres, sees. It passes the
/// rows to `fold`, block after block in the order of the targets. A target that is not finite sees nothing. Progress
/// counts targets, twice each if trees let light through.
///
/// # Errors
/// Those of [`MedialScene::visibility_matrix`], of [`ObstacleParts::look`] and of `fold`, and [`Error::Cancelled`].
pub fn fold_rows(
    surroundings: SkyObstacles<'_>,
    targets: &[[f32; 3]],
    directions: &[[f64; 3]],
    control: &Control<'_>,
    fold: impl FnMut(RowBlock<'_>) -> Result<()>,
) -> Result<()> {
    let of_target = directions.len().max(1) * surroundings.matrix_count();
    fold_blocks(surroundings, targets, directions, (BLOCK_BITS / of_target).max(1), control, fold)
}

/// Folds rows as [`fold_rows`], with blocks of `block` targets.
///
/// # Errors
/// Those of [`fold_rows`], and [`Error::InvalidParameter`] for blocks without a target.
pub fn fold_blocks(
    surroundings: SkyObstacles<'_>,
    targets: &[[f32; 3]],
    directions: &[[f64; 3]],
    block: usize,
    control: &Control<'_>,
    mut fold: impl FnMut(RowBlock<'_>) -> Result<()>,
) -> Result<()> {
    if block == 0 {
        return Err(Error::invalid(Parameter::TargetCount, "0", "1 or more"));
    }
    for (number, of_block) in targets.chunks(block).enumerate() {
        control.check()?;
        let (matrix, without_trees) = surroundings.look(of_block, directions, control)?;
        let first = number * block;
        let measured = || {
            let medium = surroundings.medium()?;
            Some(CrownRows::Measured { medium, targets: of_block, directions })
        };
        let crowns = without_trees.map(CrownRows::Share).or_else(measured);
        fold(RowBlock { rows: first..first + of_block.len(), matrix, crowns })?;
    }
    Ok(())
}

/// The normals of the targets of a block.
pub(crate) fn normals_of<'a>(normals: Option<&'a [[f32; 3]]>, rows: &Range<usize>) -> Option<&'a [[f32; 3]]> {
    normals.map(|normals| normals.get(rows.clone()).unwrap_or_default())
}

/// Checks that there is a normal for each target.
pub(crate) fn check_normals(normals: Option<&[[f32; 3]]>, expected: usize) -> Result<()> {
    check_length("normals of targets", expected, normals.map_or(expected, <[_]>::len))
}
