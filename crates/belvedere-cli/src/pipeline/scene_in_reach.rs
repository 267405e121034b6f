//! Part of a survey, too large for memory, that a question about a few places can reach.

use crate::arguments::{MapPosition, MemoryArgument, Rectangle, SceneInput, refuse};
use crate::memory;
use crate::run::CommandContext;
use anyhow::Result;
use belvedere_tiles::TooLarge;

/// Returns the scene of a question that reaches `distance` metres from typed places in plan. It is the whole survey, or
/// the points around the places if one model of all needs more than the permitted memory. `None` is any distance: one
/// model is tried, unless the memory was typed.
pub(crate) fn scene_in_reach(
    (scene, memory): (&SceneInput, &MemoryArgument),
    places: &[MapPosition],
    distance: Option<f64>,
    run: &mut CommandContext,
) -> Result<SceneInput> {
    let mut part = scene.clone();
    let Some(limit) = memory::limit(memory).filter(|_| part.input.bounds.is_none()) else { return Ok(part) };
    let clouds = (&scene.input.clouds[..], scene.input.crs.as_deref());
    let Some(large) = TooLarge::of(clouds.0, limit) else { return Ok(part) };
    let places: Vec<[f64; 2]> = places.iter().map(|place| place.0).collect();
    match distance.map(|distance| large.part_around(clouds, &places, distance)).transpose()?.flatten() {
        Some((window, remark)) => {
            run.summary.remarks([remark]);
            part.input.bounds = Some(Rectangle(window));
        }
        None if memory.memory.is_some() => {
            let way_out = "allow more memory, or limit the question to typed places and a distance from them";
            return refuse(format!("{}, but this question reaches all of it: {way_out}", large.in_words()));
        }
        None => {}
    }
    Ok(part)
}
