//! The points that questions about the whole cloud ask about: all of them, or a fair sample that is answered within a
//! tenth of a second.

use crate::chunks::Chunks;
use belvedere::apps::targets::Targets;
use belvedere::control::Control;
use belvedere::neighbors::NeighborIndex;
use belvedere::query::target_tree::TargetTree;
use belvedere::{PointCloud, Result};
use rayon::prelude::*;
use std::sync::Arc;

/// Maximum number of points of a sample: their lines of sight take two threads 20 to 70 ms. The standard error of a
/// share of all points is at most 0.3 %.
pub(crate) const SAMPLE: usize = 30_000;

/// Targets of questions, and which of them answers for each point that is shown.
pub(crate) struct TargetPoints {
    /// Targets of the sun, local metres.
    pub(crate) targets: Arc<Targets>,
    /// Ordered for viewers.
    pub(crate) tree: TargetTree,
    /// For each point, in the order in which points are sent, the target that answers for it.
    answerers: Vec<u32>,
}

/// In place of a point that is not there any more.
const NOBODY: u32 = u32::MAX;
/// Answer of such a point.
const CLEARED: u8 = 254;

impl TargetPoints {
    /// All points of a cloud. `place` gives the row in it of a point that is shown, if it is there.
    pub(crate) fn all(cloud: &PointCloud, chunks: &Chunks, place: impl Fn(u32) -> Option<u32> + Sync) -> Self {
        let answerers = chunks.rows().par_iter().map(|&row| place(row).unwrap_or(NOBODY)).collect();
        Self { targets: Arc::new(Targets::of_points(cloud, None)), tree: TargetTree::new(&cloud.positions), answerers }
    }

    /// A fair sample of them; others are answered for by the nearest.
    pub(crate) fn sample(
        cloud: &PointCloud,
        chunks: &Chunks,
        place: impl Fn(u32) -> Option<u32> + Sync,
        control: &Control<'_>,
    ) -> Result<Self> {
        let mut sample = PointCloud::in_frame(cloud.frame.clone());
        let position = |row: u32| place(row).and_then(|row| cloud.positions.get(row as usize).copied());
        sample.positions = chunks.sampled_rows(SAMPLE).filter_map(position).collect();
        let index = NeighborIndex::new(&sample.positions, control)?;
        let answerer = |&row: &u32| {
            position(row)
                .and_then(|position| index.nearest_within(position, f32::INFINITY))
                .map_or(NOBODY, |near| near.index)
        };
        let answerers = chunks.rows().par_iter().with_min_len(4096).map(answerer).collect();
        Ok(Self {
            targets: Arc::new(Targets::of_points(&sample, None)),
            tree: TargetTree::new(&sample.positions),
            answerers,
        })
    }

    /// A byte for each point shown, in the order in which points are sent, from those of the targets.
    pub(crate) fn in_order(&self, of_target: impl Fn(usize) -> u8 + Sync) -> Vec<u8> {
        let answer = |&target: &u32| if target == NOBODY { CLEARED } else { of_target(target as usize) };
        self.answerers.par_iter().with_min_len(4096).map(answer).collect()
    }
}
