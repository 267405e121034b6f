//! Lines of sight that leave the cloud: to the terrain around it, and from there.

use crate::query::far_terrain::line::{FarLine, piece_over};
use crate::query::{Answer, Blocker, EarthParams, LineOfSight, MedialScene, Obstruction};
use crate::ray_index::in_order;
use belvedere_data::vector::{length, sub};

impl MedialScene {
    /// Returns true if a position, local metres, lies beyond the cloud and over the raster of
    /// [`MedialScene::with_far_terrain`], so that lines of sight to it have answers. It may lie below the surface, and
    /// its height may be NaN. False if the extent of the cloud is not known.
    #[must_use]
    pub fn is_on_far_terrain(&self, position: [f64; 3]) -> bool {
        self.coverage().is_some_and(|coverage| !coverage.holds_on_map(position)) && self.far_terrain.holds(position)
    }

    /// Returns true if a position, local metres, lies neither over the cloud nor over far terrain.
    #[must_use]
    pub fn is_outside(&self, position: [f64; 3]) -> bool {
        self.is_outside_cloud(position) && !self.is_on_far_terrain(position)
    }

    /// Returns true if the line of sight between two ends, local metres, leaves the cloud for far terrain, and has an
    /// answer.
    #[must_use]
    pub fn leaves_cloud(&self, ends: [[f64; 3]; 2]) -> bool {
        ends.into_iter().any(|end| self.is_on_far_terrain(end)) && !ends.into_iter().any(|end| self.is_outside(end))
    }

    /// Returns whether `observer` sees `target`, local metres, if one or both lie beyond the cloud. Visible, blocked,
    /// or unproven where pulses are known; [`Answer::OutsideView`] if a coordinate is not finite or one end is above
    /// the other.
    ///
    /// Over the box of the cloud in plan, balls and added meshes block as on any line of sight between the same ends
    /// ([`MedialScene::sight_answer`]), and pulses prove it. Beyond this box, and a cell of the raster around it, the
    /// raster of [`MedialScene::with_far_terrain`] blocks where it rises above the line. It is the same surface over
    /// the same earth as for horizons. A target on the surface does not hide itself. The profile of far terrain, which
    /// has no distances, is not considered.
    #[must_use]
    pub fn far_sight_answer(&self, observer: [f64; 3], target: [f64; 3], earth: &EarthParams) -> Answer {
        let [first, second] = in_order([observer, target]);
        let Some(line) = FarLine::new(first, second, earth) else { return Answer::OutsideView };
        if self.far_terrain.blocks_sight(&line) {
            return Answer::Blocked;
        }
        match self.corners_over_cloud(&line) {
            Some(corners) => self.answer_on_chords(line.ends(), &corners),
            None => Answer::Visible,
        }
    }

    /// The answer of [`MedialScene::far_sight_answer`] and its first obstacle; `None` instead of
    /// [`Answer::OutsideView`].
    pub(in crate::query) fn far_line_of_sight(
        &self,
        observer: [f64; 3],
        target: [f64; 3],
        earth: &EarthParams,
    ) -> Option<LineOfSight> {
        let line = FarLine::new(observer, target, earth)?;
        // whether it is blocked does not depend on who looks, what blocks first does
        let ends = in_order([observer, target]);
        let ordered = FarLine::new(ends[0], ends[1], earth)?;
        let terrain = self.far_terrain.meets_sight(&ordered).map(|span| {
            let mirrored = if observer == ends[0] { span } else { line.span - span };
            self.far_terrain.meets_sight(&line).unwrap_or(mirrored)
        });
        let free = LineOfSight { answer: Answer::Visible, first_block: None, unproven_length: 0.0 };
        let mut sight = match self.corners_over_cloud(&ordered) {
            Some(corners) => self.sight_on_chords(observer, ends, &corners),
            None => free,
        };
        if let Some(span) = terrain
            && sight.first_block.is_none_or(|block| span < line.span_to(block.place))
        {
            let block = Obstruction { range: 0.0, blocker: Blocker::Terrain, place: line.at(span) };
            sight = LineOfSight { answer: Answer::Blocked, first_block: Some(block), ..free };
        }
        if let Some(block) = &mut sight.first_block {
            block.range = length(sub(block.place, observer));
        }
        Some(sight)
    }

    /// Corners of the chords of a line over the box of the cloud, from the side of the observer on; `None` where it
    /// passes beside it.
    fn corners_over_cloud(&self, line: &FarLine<'_>) -> Option<Vec<[f64; 3]>> {
        let over = match self.coverage().map(|coverage| coverage.bounds().on_map()) {
            Some((low, high)) => piece_over([low, high], line.observer, line.along, line.span),
            None => Some([0.0, line.span]),
        };
        let [from, to] = over?;
        let first = if from > 0.0 { line.at(from) } else { line.observer };
        let last = if to < line.span { line.at(to) } else { line.target };
        Some(line.earth.corners(first, last))
    }
}
