//! What targets see in each direction: the sky, or a surface.

use super::materials::{GroundCover, Material};
use crate::rows::{LineLight, RowBlock};
use crate::sky_view::SkyDirections;
use crate::targets::TARGET_LIFT;
use crate::window_views::SeenKind;
use belvedere_core::medial::MedialBalls;
use belvedere_core::query::{Blocker, MedialScene};
use belvedere_data::control::Control;
use belvedere_data::error::check_length;
use belvedere_data::vector::{sub, to_f32, unit};
use belvedere_data::{Error, Result};
use rayon::prelude::*;

/// Number of the sky, in place of a surface.
pub(super) const SKY: u32 = u32::MAX;
/// Number of open ground beyond the cloud, in place of a surface.
pub(super) const FAR: u32 = u32::MAX - 1;

/// Division of the sky into patches: 145, and as many below the horizon.
const DIVISION: usize = 1;

/// Returns the patches of the sky of a body.
///
/// # Errors
/// Those of [`SkyDirections::patches`].
pub(super) fn sky_of_bodies() -> Result<SkyDirections> {
    SkyDirections::patches(DIVISION)
}

/// Returns the directions in which a body takes up radiation, with their solid angles, steradians: the middles of the
/// patches of the sky, then their mirror images below the horizon.
///
/// # Errors
/// Those of [`SkyDirections::patches`].
pub fn body_directions() -> Result<Vec<([f64; 3], f64)>> {
    let sky = sky_of_bodies()?;
    let above = || sky.directions.iter().copied().zip(sky.solid_angles.iter().copied());
    Ok(above().chain(above().map(|([x, y, z], angle)| ([x, y, -z], angle))).collect())
}

/// A surface that is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Place on it, local metres, lifted off by [`TARGET_LIFT`].
    pub position: [f32; 3],
    /// Outward unit normal; `None` for leaves, which are turned to all sides.
    pub normal: Option<[f32; 3]>,
    /// Its material.
    pub material: Material,
}

/// The surfaces of a scene.
#[derive(Clone, Copy)]
pub struct SceneSurfaces<'a> {
    /// All that blocks.
    pub scene: &'a MedialScene,
    /// The balls of the model.
    pub balls: &'a MedialBalls,
    /// Points that the balls were made from, (N, 3) local metres.
    pub points: &'a [[f32; 3]],
    /// Kind of each ball, (B).
    pub kinds: &'a [SeenKind],
    /// Cover of the ground.
    pub cover: GroundCover,
}

/// First thing that a line meets.
#[derive(Clone, Copy)]
enum Hit {
    Sky,
    Far,
    Ball(usize),
    Other(Surface),
}

impl SceneSurfaces<'_> {
    /// Checks that each ball has a kind and a point.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`].
    pub fn validate(&self) -> Result<()> {
        let points = self.balls.source.iter().map(|&row| row as usize + 1).max().unwrap_or(0);
        if self.points.len() < points {
            let found = self.points.len();
            return Err(Error::LengthMismatch { what: "points of balls", expected: points, found });
        }
        check_length("kinds of balls", self.balls.len(), self.kinds.len())?;
        Ok(())
    }

    /// The surface at the point that a ball was made from.
    fn of_ball(&self, row: usize) -> Option<Surface> {
        let point = *self.points.get(*self.balls.source.get(row)? as usize)?;
        let outward = sub(point.map(f64::from), self.balls.centers.get(row)?.map(f64::from));
        let normal = unit(outward).unwrap_or([0.0, 0.0, 1.0]);
        let kind = self.kinds.get(row).copied().unwrap_or_default();
        let material = Material::of(kind, normal, self.cover);
        let position = [0, 1, 2].map(|axis| to_f32(f64::from(point[axis]) + TARGET_LIFT * normal[axis]));
        let normal = (material != Material::Leaves).then_some(normal.map(to_f32));
        Some(Surface { position, normal, material })
    }

    fn first_hit(&self, place: [f64; 3], direction: [f64; 3]) -> Hit {
        let Some(seen) = self.scene.surface_before(place, direction) else {
            let is_sky = direction[2] >= 0.0 && !self.scene.far_terrain().hides(place, direction);
            return if is_sky { Hit::Sky } else { Hit::Far };
        };
        match seen.blocker {
            Blocker::Ball(row) => Hit::Ball(row),
            Blocker::Terrain => Hit::Far,
            Blocker::Mesh(_) | Blocker::Patch(_) => {
                let normal = seen.normal.unwrap_or(direction.map(|v| -v));
                let at = |axis: usize| place[axis] + seen.range * direction[axis] + TARGET_LIFT * normal[axis];
                let position = [0, 1, 2].map(|axis| to_f32(at(axis)));
                Hit::Other(Surface { position, normal: Some(normal.map(to_f32)), material: Material::Built })
            }
        }
    }
}

/// What each of some targets sees.
#[derive(Clone, Debug, Default)]
pub(super) struct SeenSurfaces {
    /// The surfaces, each once.
    pub(super) surfaces: Vec<Surface>,
    /// For each target a number for each direction: of a surface, [`SKY`] or [`FAR`].
    pub(super) seen: Vec<u32>,
}

impl SeenSurfaces {
    /// Finds what `targets`, (M, 3) local metres, see in `directions`: those of the columns of `rows` first, which need
    /// no second look where the line is free.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub(super) fn find(
        scene: &SceneSurfaces<'_>,
        targets: &[[f32; 3]],
        rows: &RowBlock<'_>,
        directions: &[([f64; 3], f64)],
        control: &Control<'_>,
    ) -> Result<Self> {
        let columns = rows.matrix.direction_count();
        let hits = |(row, target): (usize, &[f32; 3])| {
            control.check()?;
            let place = target.map(f64::from);
            let is_target = place.iter().all(|v| v.is_finite());
            let hit = |(column, (direction, _)): (usize, &([f64; 3], f64))| {
                if !is_target || column < columns && rows.line(row, column) == LineLight::Free {
                    return Hit::Sky;
                }
                scene.first_hit(place, *direction)
            };
            control.advance(1);
            Ok(directions.iter().enumerate().map(hit).collect::<Vec<Hit>>())
        };
        let hits: Vec<Vec<Hit>> = targets.par_iter().enumerate().map(hits).collect::<Result<_>>()?;
        let mut found = Self::default();
        let mut of_ball = vec![SKY; scene.balls.len()];
        found.seen.reserve(targets.len() * directions.len());
        for hit in hits.into_iter().flatten() {
            let number = match hit {
                Hit::Sky => SKY,
                Hit::Far => FAR,
                Hit::Other(surface) => found.push(surface),
                Hit::Ball(row) => match (of_ball.get(row).copied(), scene.of_ball(row)) {
                    (Some(SKY), Some(surface)) => {
                        of_ball[row] = found.push(surface);
                        of_ball[row]
                    }
                    (Some(known), _) => known,
                    (None, _) => FAR,
                },
            };
            found.seen.push(number);
        }
        Ok(found)
    }

    fn push(&mut self, surface: Surface) -> u32 {
        self.surfaces.push(surface);
        // a block of targets has far fewer directions than this type has numbers
        u32::try_from(self.surfaces.len() - 1).unwrap_or(FAR)
    }
}
