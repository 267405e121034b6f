//! Casters of shadows: what stands between each target and the sun.

use super::context::Context;
use super::places::Places;
use super::scene::Scene;
use super::seen_kinds::kinds_of_balls;
use super::sun::NamedSun;
use super::sun_and_sky::Light;
use crate::shadow::HALF_LIGHT;
use crate::sun_calendar::{SunObstacle, sun_obstacle};
use crate::targets::Measure;
use crate::window_views::{ClassMeanings, SeenKind};
use belvedere_data::control::Control;
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;

/// Start of the names of measures of casters.
pub const CASTER: &str = "caster";
/// Number of the first added mesh: others follow.
const FIRST_MESH: u8 = 8;
/// Names of casters by their numbers, below that of the first mesh.
const NAMES: [&str; FIRST_MESH as usize] =
    ["sun", "building", "trees", "ground", "water", "other", "terrain", "own surface"];
const DESCRIPTION: &str =
    "0 sun, 1 building, 2 trees, 3 ground, 4 water, 5 other, 6 terrain, 7 own surface, from 8 plans";
/// Targets handed to a thread at once.
const CHUNK: usize = 256;

/// Name of the caster with a number of a measure [`CASTER`]: for an added mesh that of `meshes`, else its kind.
#[must_use]
pub fn caster_name(number: u8, meshes: &[String]) -> &str {
    match number.checked_sub(FIRST_MESH) {
        Some(mesh) => meshes.get(usize::from(mesh)).map_or("plan", String::as_str),
        None => NAMES[usize::from(number)],
    }
}

/// Number of an obstacle. Where light fails without an obstacle, as where it is unproven, it is another thing.
fn number_of(obstacle: SunObstacle) -> u8 {
    match obstacle {
        SunObstacle::Seen(SeenKind::Building) => 1,
        SunObstacle::Seen(SeenKind::Vegetation) => 2,
        SunObstacle::Seen(SeenKind::Ground) => 3,
        SunObstacle::Seen(SeenKind::Water) => 4,
        SunObstacle::None | SunObstacle::Seen(_) => 5,
        SunObstacle::Terrain => 6,
        SunObstacle::OwnWall => 7,
        SunObstacle::Mesh(number) => u8::try_from(number).unwrap_or(u8::MAX).saturating_add(FIRST_MESH),
    }
}

/// Refuses faces of a mesh, whose casters would be averaged as numbers. Refuses more than 247 added meshes.
pub(super) fn check_casters(places: &Places, scene: &Scene) -> Result<()> {
    if matches!(places, Places::Mesh(..)) {
        return Err(Error::invalid(Parameter::Targets, "faces of a mesh", "cells or points, where casters are wanted"));
    }
    match scene.model().added().map_or(0, |added| added.names().len()) {
        count if count > usize::from(u8::MAX - FIRST_MESH) => Err(Error::invalid(
            Parameter::AddedMesh,
            format!("{count} of them"),
            "at most 247, where casters are wanted",
        )),
        _ => Ok(()),
    }
}

/// The caster of the shadow of each sun on each target of `light`, where its measure of `lit` says shadow. Names end in
/// what `suffix` says.
///
/// # Errors
/// Those of [`kinds_of_balls`], and [`Error::Cancelled`].
pub(super) fn casters(
    (suns, lit): (&[NamedSun], &[Measure]),
    light: &Light,
    suffix: impl Fn(&NamedSun) -> String,
    (scene, context): (&Scene, &mut Context),
    control: &Control<'_>,
) -> Result<Vec<Measure>> {
    let kinds = kinds_of_balls(scene, &ClassMeanings::default(), context)?;
    let targets = &light.targets;
    let (blockers, _) = light.whole()?;
    let of_target = |(row, light_there): (usize, &f32), to_sun: [f64; 3]| {
        control.check()?;
        // at night there are no shadows
        if light_there.is_nan() || !(to_sun[2] > 0.0) {
            return Ok(f32::NAN);
        }
        if *light_there >= HALF_LIGHT {
            return Ok(0.0);
        }
        let place = targets.positions[row].map(f64::from);
        let normal = targets.normals.as_ref().map(|normals| normals[row].map(f64::from));
        Ok(f32::from(number_of(sun_obstacle(blockers, place, normal, &kinds, to_sun))))
    };
    let of_sun = |(sun, lit): (&NamedSun, &Measure)| {
        let rows = lit.values.par_iter().enumerate().with_min_len(CHUNK);
        let values = rows.map(|one| of_target(one, sun.sun.to_sun)).collect::<Result<Vec<f32>>>()?;
        control.advance(lit.values.len());
        let name = format!("{CASTER}{}", suffix(sun));
        Ok(Measure::new(&name, values).with_description(DESCRIPTION).with_decimals(0).with_tags(&sun.tags))
    };
    control.stage("finding casters", suns.len() * targets.len(), || suns.iter().zip(lit).map(of_sun).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_obstacle_has_a_number_with_its_name() {
        let meshes = ["tower".to_owned(), "hall".to_owned()];
        for (obstacle, name) in [
            (SunObstacle::Seen(SeenKind::Building), "building"),
            (SunObstacle::Seen(SeenKind::Vegetation), "trees"),
            (SunObstacle::Seen(SeenKind::Other), "other"),
            (SunObstacle::Terrain, "terrain"),
            (SunObstacle::OwnWall, "own surface"),
            (SunObstacle::Mesh(1), "hall"),
            (SunObstacle::Mesh(5), "plan"),
        ] {
            assert_eq!(caster_name(number_of(obstacle), &meshes), name);
        }
        let listed = NAMES.iter().enumerate().map(|(number, name)| format!("{number} {name}")).collect::<Vec<_>>();
        assert!(DESCRIPTION.starts_with(&listed.join(", ")), "{DESCRIPTION}");
        assert_eq!(caster_name(u8::MAX, &meshes), "plan");
    }
}
