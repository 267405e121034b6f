//! Lines of sight that leave the cloud: to the terrain around it, and from there.

use super::far_terrain::piece_over;
use super::{Answer, EarthParams, MedialScene};

impl MedialScene {
    /// Whether `observer` sees `target`, local metres, where one of them or both lie beyond the cloud. Visible, blocked, or unproven where pulses are known;
    /// [`Answer::OutsideView`] where a coordinate is not finite or one end is above the other.
    ///
    /// Over the box of the cloud on the map, balls and added meshes block as they block any line of sight between the same ends ([`MedialScene::sight_answer`]), and pulses prove it. Beyond
    /// this box, and a cell of the raster around it, the raster of [`MedialScene::with_far_terrain`] blocks where it rises above the line: the same surface over the same earth as for
    /// horizons. A target on the surface does not hide itself. The profile of far terrain, which has no distances, is not asked.
    #[must_use]
    pub fn far_sight_answer(&self, observer: [f64; 3], target: [f64; 3], earth: &EarthParams) -> Answer {
        let across = [target[0] - observer[0], target[1] - observer[1]];
        let span = across[0].hypot(across[1]);
        if !(span > 0.0 && span.is_finite() && (target[2] - observer[2]).is_finite()) {
            return Answer::OutsideView;
        }
        let along = across.map(|v| v / span);
        let tangent = earth.apparent_tangent(target[2] - observer[2], span);
        if self.far_terrain.blocks_sight((observer, target), along, tangent, earth) {
            return Answer::Blocked;
        }
        let cloud = self.coverage().map(|coverage| coverage.bounds().on_map());
        let over = match cloud {
            Some((low, high)) => piece_over([low, high], observer, along, span),
            None => Some([0.0, span]),
        };
        let Some([from, to]) = over else { return Answer::Visible };
        let at = |range: f64| {
            let height = observer[2] + earth.height_along(tangent, range);
            [observer[0] + along[0] * range, observer[1] + along[1] * range, height]
        };
        let first = if from > 0.0 { at(from) } else { observer };
        let last = if to < span { at(to) } else { target };
        self.answer_on_chords((observer, target), &earth.corners(first, last))
    }
}
