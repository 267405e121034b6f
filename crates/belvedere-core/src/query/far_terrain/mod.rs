//! Terrain beyond the cloud that hides the sky above the horizon: a profile for all places, an elevation raster, or
//! both.

pub(super) mod line;
mod relief;
mod rows;
mod visible;

use super::EarthParams;
use super::coverage::CEILING;
use crate::triangle_tree::Corners;
use belvedere_data::ElevationGrid;
use belvedere_data::cast::to_index;
use belvedere_data::horizon::HorizonProfile;
use line::FarLine;
use rayon::prelude::*;
pub(super) use relief::TerrainGuess;
use relief::{LineStarts, TerrainHeights};
pub(super) use rows::hide_behind_terrain;
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;
pub use visible::VisibleTerrain;

/// Azimuths handed to a thread at once.
const CHUNK: usize = 90;

/// Far terrain: a direction is blocked for a place if it is below the horizon there.
///
/// A profile is the same for all places. A raster gives each place its own horizon, exact for heights that are bilinear
/// between the middles of its cells, over the curved earth. Inside the box of the cloud on the map, and a cell of the
/// raster around it, the cloud decides. Cells without a height block nothing.
#[derive(Clone, Debug, Default)]
pub struct FarTerrain {
    /// Azimuths from grid north.
    profile: Option<Arc<HorizonProfile>>,
    relief: Option<Arc<TerrainHeights>>,
    earth: EarthParams,
}

impl FarTerrain {
    /// This terrain with a profile for all places, azimuths from grid north, in place of an earlier profile.
    #[must_use]
    pub fn with_profile(mut self, profile: HorizonProfile) -> Self {
        self.profile = Some(Arc::new(profile));
        self
    }

    /// This terrain with a raster, in place of an earlier one; within the box `cloud` on the map, local metres, it
    /// blocks nothing.
    #[must_use]
    pub fn with_grid(mut self, grid: ElevationGrid, cloud: Option<([f64; 2], [f64; 2])>) -> Self {
        self.relief = Some(Arc::new(TerrainHeights::new(grid, cloud)));
        self
    }

    /// The profile of all places, if there is one.
    #[must_use]
    pub fn profile(&self) -> Option<&HorizonProfile> {
        self.profile.as_deref()
    }

    /// The raster, if there is one.
    #[must_use]
    pub fn grid(&self) -> Option<&ElevationGrid> {
        self.relief.as_ref().map(|relief| relief.grid())
    }

    /// Returns true if no terrain is known beyond the cloud.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.profile.is_none() && self.relief.is_none()
    }

    /// Visits the triangles of the terrain beyond the cloud in a box on the map, from its low to its high corner, local
    /// metres: four for each patch, around its middle.
    pub(super) fn each_triangle_near(&self, [low, high]: [[f64; 2]; 2], mut visit: impl FnMut(&Corners)) {
        let Some(relief) = self.relief.as_deref() else { return };
        let (grid, [box_low, box_high]) = (relief.grid(), relief.within());
        let [west, north] = grid.north_west();
        let patches = |from: f64, to: f64, cell: f64, nodes: usize| {
            let [from, to] = [from, to].map(|end| to_index((end / cell).floor() + 1.0));
            from.saturating_sub(1)..to.min(nodes - 1)
        };
        let columns = patches(low[0] - west, high[0] - west, grid.cell()[0], grid.heights().width());
        let rows = patches(north - high[1], north - low[1], grid.cell()[1], grid.heights().height());
        for (row, column) in rows.flat_map(|row| columns.clone().map(move |column| (row, column))) {
            let nodes = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(right, down)| grid.node(column + right, row + down));
            let [Some(a), Some(b), Some(c), Some(d)] = nodes else { continue };
            let middle: [f64; 3] = std::array::from_fn(|axis| (a[axis] + b[axis] + c[axis] + d[axis]) / 4.0);
            if (0..2).all(|axis| (box_low[axis]..=box_high[axis]).contains(&middle[axis])) {
                continue;
            }
            for [from, to] in [[a, b], [b, c], [c, d], [d, a]] {
                visit(&[from, to, middle]);
            }
        }
    }

    /// Returns true if the unit vector `direction` points below the horizon of `place`, local metres.
    #[must_use]
    pub fn hides(&self, place: [f64; 3], direction: [f64; 3]) -> bool {
        self.profile.as_ref().is_some_and(|profile| profile.hides(direction))
            || self.relief.as_ref().is_some_and(|relief| {
                let (along, tangent) = on_map(direction);
                relief.hides(place, along, tangent, &self.earth)
            })
    }

    /// Returns true if the raster covers `position`, local metres, in plan, and it is at most 10 km above the highest
    /// height. The height may be NaN.
    pub(super) fn holds(&self, position: [f64; 3]) -> bool {
        self.relief.as_ref().is_some_and(|relief| {
            let (low, high) = relief.grid().on_map();
            (0..2).all(|i| (low[i]..=high[i]).contains(&position[i]))
                && !(position[2] > f64::from(relief.highest()) + CEILING)
        })
    }

    /// Returns the horizontal distance from the observer, metres, at which the raster first rises above a line of
    /// sight.
    pub(super) fn meets_sight(&self, line: &FarLine<'_>) -> Option<f64> {
        self.relief.as_ref()?.meets_sight(line)
    }

    /// Returns true if the raster rises above a line of sight.
    pub(super) fn blocks_sight(&self, line: &FarLine<'_>) -> bool {
        self.relief.as_ref().is_some_and(|relief| relief.blocks_sight(line))
    }

    /// Returns the greatest tangent of an elevation, within `tangents`, at which the raster rises above lines from the
    /// observer of `line` up to its target. The first of `tangents` where it does not rise above that.
    pub(super) fn highest_before(
        &self,
        line: &FarLine<'_>,
        tangents: [f64; 2],
        guess: &mut TerrainGuess,
    ) -> Option<f64> {
        self.relief.as_ref().map(|relief| relief.highest_before(line, tangents, guess))
    }

    /// Returns the elevations of the horizon of `place`, local metres, over the earth of `earth`, radians; −π/2 without
    /// terrain. The `count` azimuths start at `first`, from grid north, and are `step` apart, radians.
    #[must_use]
    pub fn elevations(&self, place: [f64; 3], [first, step]: [f64; 2], count: usize, earth: &EarthParams) -> Vec<f64> {
        let mut elevations = vec![-FRAC_PI_2; count];
        elevations.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, elevations)| {
            let mut guess = None;
            for (i, elevation) in elevations.iter_mut().enumerate() {
                let azimuth = first + (chunk * CHUNK + i) as f64 * step;
                if let Some(profile) = &self.profile {
                    *elevation = profile.elevation_at(azimuth);
                }
                if let Some(relief) = &self.relief
                    && let Some(top) = relief.top(place, azimuth.sin_cos().into(), earth, guess)
                {
                    guess = Some(top.span);
                    *elevation = elevation.max(top.tangent.atan());
                }
            }
        });
        elevations
    }
}

/// Returns the horizontal direction of a unit vector, a unit vector, and the tangent of its elevation: infinite
/// upright.
fn on_map([x, y, z]: [f64; 3]) -> ([f64; 2], f64) {
    let across = x.hypot(y);
    if across > 0.0 { ([x / across, y / across], z / across) } else { ([0.0, 1.0], z * f64::INFINITY) }
}
