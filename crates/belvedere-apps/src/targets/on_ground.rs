//! Places on the map that get their height from the ground.

use crate::viewshed::cell_for;
use belvedere_core::ground::{Ground, MapGrid};
use belvedere_core::model::SceneModel;
use belvedere_data::Result;

/// Ground made around places that need it, metres.
const MARGIN: f64 = 10.0;

/// A grid of default cells over the `places`, (N, 3) local metres, that have no height (NaN), with a margin of 10 m;
/// `None` where all have one. `origin`, metres, is that of the frame.
///
/// # Errors
/// Those of [`MapGrid::covering`].
pub fn grid_around(places: impl IntoIterator<Item = [f64; 3]>, origin: [f64; 3]) -> Result<Option<MapGrid>> {
    let [mut low, mut high] = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    let mut is_needed = false;
    for place in places.into_iter().filter(|place| place[2].is_nan()) {
        is_needed = true;
        for axis in 0..2 {
            low[axis] = low[axis].min(place[axis]);
            high[axis] = high[axis].max(place[axis]);
        }
    }
    if !is_needed {
        return Ok(None);
    }
    let (low, high) = (low.map(|v| v - MARGIN), high.map(|v| v + MARGIN));
    MapGrid::covering(low, high, cell_for(low, high), [origin[0], origin[1]]).map(Some)
}

/// Gives each of `places`, local metres with its height above the ground, that has no height of its own (NaN) the one
/// of the ground below plus that. Returns the numbers of those below which no ground is known.
pub fn set_on_ground<'a>(places: impl IntoIterator<Item = (&'a mut [f64; 3], f64)>, ground: &Ground) -> Vec<usize> {
    let mut unknown = Vec::new();
    for (number, (place, height)) in places.into_iter().enumerate().filter(|(_, (place, _))| place[2].is_nan()) {
        match ground.height_at([place[0], place[1]]) {
            Some(level) => place[2] = level + height,
            None => unknown.push(number),
        }
    }
    unknown
}

/// The same for places that lie beyond the cloud, on the far terrain of `model`: they stand on its raster. The height
/// of the others stays.
pub fn set_on_terrain<'a>(places: impl IntoIterator<Item = (&'a mut [f64; 3], f64)>, model: &SceneModel) {
    let (Some(coverage), Some(terrain)) = (model.coverage(), model.far_terrain().grid()) else { return };
    for (place, height) in places {
        if place[2].is_nan()
            && !coverage.holds_on_map(*place)
            && let Some(level) = terrain.height_at([place[0], place[1]])
        {
            place[2] = level + height;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::raster::Raster;

    #[test]
    fn places_without_a_height_stand_on_the_ground_and_others_stay() {
        let mut places = [[1.0, 1.0, f64::NAN], [1.0, 1.0, 7.0], [90.0, 0.0, f64::NAN]];
        let grid = grid_around(places[..2].iter().copied(), [0.5, 0.0, 100.0]).unwrap().unwrap();
        // ten metres around the one place that needs it
        assert!(grid.cell_of([-8.9, -8.9]).is_some() && grid.cell_of([-10.0, 1.0]).is_none());
        assert_eq!(grid_around([[1.0, 1.0, 7.0]], [0.0; 3]).unwrap(), None);
        let heights = Raster::filled(grid.width, grid.height, 3.0);
        let ground = Ground { grid, gaps: heights.clone(), heights };
        let unknown = set_on_ground(places.iter_mut().zip([1.5, 2.0, 1.5]), &ground);
        assert_eq!(unknown, [2]);
        assert_eq!((places[0][2], places[1][2]), (4.5, 7.0));
        assert!(places[2][2].is_nan());
    }
}
