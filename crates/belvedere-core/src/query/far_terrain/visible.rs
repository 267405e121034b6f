//! Visible pieces of a terrain profile, for drawings of what an eye sees.

use super::super::EarthParams;
use super::FarTerrain;
use super::line::piece_over;

/// Step along a profile as a share of the distance, and its limits: metres, and a share of a cell.
const STEP: f64 = 0.01;
const MIN_STEP: f64 = 0.25;
const MAX_STEP_CELLS: f64 = 0.5;
/// Maximum ratio of the two distances of a piece that reaches farther than [`ALIKE_TO`].
const MAX_RATIO: f64 = 1.1;
/// Distance up to which terrain is one piece, metres: drawings show it alike, and pieces of 100 views fill memory.
const ALIKE_TO: f64 = 200.0;

/// A piece of a terrain profile that nothing before it on the profile hides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisibleTerrain {
    /// Horizontal distances of its ends from the eye, metres.
    pub distances: [f64; 2],
    /// Elevations of its ends, radians: they rise.
    pub elevations: [f64; 2],
}

impl FarTerrain {
    /// The pieces of the raster that `eye`, local metres, sees at `azimuth`, radians from grid north, from near to far,
    /// over the earth of `earth`. Empty without a raster.
    ///
    /// Heights are taken at steps of at most half a cell, for drawings. [`FarTerrain::elevations`] is exact.
    #[must_use]
    pub fn visible_pieces(&self, eye: [f64; 3], azimuth: f64, earth: &EarthParams) -> Vec<VisibleTerrain> {
        let Some(relief) = &self.relief else { return Vec::new() };
        let (grid, within) = (relief.grid(), relief.within());
        let along: [f64; 2] = azimuth.sin_cos().into();
        let (low, high) = grid.on_map();
        let Some([from, to]) = piece_over([low, high], eye, along, f64::INFINITY) else { return Vec::new() };
        let max_step = (grid.cell()[0].min(grid.cell()[1]) * MAX_STEP_CELLS).max(MIN_STEP);
        let mut pieces: Vec<VisibleTerrain> = Vec::new();
        let (mut highest, mut is_open, mut distance) = (f64::NEG_INFINITY, false, from.max(MIN_STEP));
        while distance < to {
            let place = [0, 1].map(|axis| eye[axis] + distance * along[axis]);
            let is_of_cloud = (0..2).all(|axis| (within[0][axis]..=within[1][axis]).contains(&place[axis]));
            let height = if is_of_cloud { None } else { grid.height_at(place) };
            let tangent = height.map(|height| earth.apparent_tangent(height - eye[2], distance));
            match tangent.filter(|tangent| *tangent > highest) {
                Some(tangent) => {
                    let elevation = tangent.atan();
                    match pieces
                        .last_mut()
                        .filter(|last| is_open && distance <= (last.distances[0] * MAX_RATIO).max(ALIKE_TO))
                    {
                        Some(last) => (last.distances[1], last.elevations[1]) = (distance, elevation),
                        None => {
                            // a piece that goes on begins where the one before ends
                            let before = pieces.last().filter(|_| is_open);
                            let begin = before.map_or((distance, elevation), |b| (b.distances[1], b.elevations[1]));
                            pieces.push(VisibleTerrain {
                                distances: [begin.0, distance],
                                elevations: [begin.1, elevation],
                            });
                        }
                    }
                    (highest, is_open) = (tangent, true);
                }
                None => is_open = false,
            }
            distance += (distance * STEP).clamp(MIN_STEP, max_step);
        }
        pieces
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::ElevationGrid;
    use belvedere_data::raster::Raster;

    #[test]
    fn a_ridge_hides_the_plain_behind_it_and_a_higher_one_rises_above_it() {
        // to the north ridges of 50 and 200 m, 1 and 3 km away, on a plain
        let height = |row: usize| match 5000.0 - 10.0 * row as f64 {
            north if (north - 1000.0).abs() < 16.0 => 50.0,
            north if (north - 3000.0).abs() < 16.0 => 200.0,
            _ => 0.0,
        };
        let heights: Vec<f32> = (0..501).flat_map(|row| [height(row); 101]).collect();
        let grid = ElevationGrid::new(Raster::from_values(101, 501, heights).unwrap(), [-500.0, 5000.0], [10.0; 2]);
        let terrain = FarTerrain::default().with_grid(grid.unwrap(), None);
        let pieces = terrain.visible_pieces([0.0, 0.0, 2.0], 0.0, &EarthParams::flat());
        // the southern edges of their flat tops, to half a cell of 10 m
        let tops = [(48.0 / 990.0_f64).atan(), (198.0 / 2990.0_f64).atan()];
        let at =
            |elevation: f64| pieces.iter().position(|piece| (0.0..3e-4).contains(&(elevation - piece.elevations[1])));
        let [near, far] = tops.map(|top| at(top).unwrap_or_else(|| panic!("{top}: {pieces:?}")));
        assert_eq!(far, pieces.len() - 1, "nothing behind the higher ridge is seen");
        // between the ridges the plain and the foot of the second are hidden
        let hidden = pieces[near].distances[1]..pieces[near + 1].distances[0];
        assert!(hidden.start < 1020.0 && hidden.end > 2980.0, "{hidden:?}");
        for pair in pieces.windows(2) {
            assert!(pair[0].elevations[1] <= pair[1].elevations[0] && pair[0].distances[1] <= pair[1].distances[0]);
        }
        let end = |piece: &VisibleTerrain| (piece.distances[0] * MAX_RATIO).max(ALIKE_TO);
        assert!(pieces.iter().all(|piece| piece.distances[1] <= end(piece)));
        assert!(pieces[0].distances[1] > 0.9 * ALIKE_TO && pieces.len() < 30, "{}", pieces.len());
        // the exact horizon is where the drawing ends
        let exact = terrain.elevations([0.0, 0.0, 2.0], [0.0, 1.0], 1, &EarthParams::flat())[0];
        assert!((exact - tops[1]).abs() < 1e-9);
        assert!(FarTerrain::default().visible_pieces([0.0; 3], 0.0, &EarthParams::flat()).is_empty());
    }
}
