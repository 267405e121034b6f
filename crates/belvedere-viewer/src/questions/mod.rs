//! One file for each question. Each calls the library as the command line does, and says which command gives the same.

mod certainty;
pub(crate) mod context;
mod daylight;
mod line;
mod places;
mod plan;
mod reverse_viewshed;
mod roof;
mod seen;
mod shadow;
mod sun;
mod sun_area;
mod surfaces;
mod surroundings;

use crate::questions::context::RequestContext;
use crate::replies::{QuestionReply, Refusal};
use crate::scene::PageScene;
use serde::de::DeserializeOwned;

/// Answers the question of that name.
pub(crate) fn answer(name: &str, body: &[u8], context: &RequestContext<'_>) -> Result<QuestionReply, Refusal> {
    match name {
        "seen" => seen::answer(&parsed(body)?, context),
        "line" => line::answer(&parsed(body)?, context),
        "daylight" => daylight::answer(&parsed(body)?, context),
        "sun" => sun::answer(&parsed(body)?, context),
        "shadow" => shadow::answer(&parsed(body)?, context),
        "around" => surroundings::answer(&parsed(body)?, context),
        "who" => reverse_viewshed::answer(&parsed(body)?, context),
        "roof" => roof::answer(&parsed(body)?, context),
        "plan" => plan::answer(parsed(body)?, context),
        "sun_area" => sun_area::answer(&parsed(body)?, context),
        "surfaces" => surfaces::answer(&parsed(body)?, context),
        _ => Err(Refusal::Unanswerable("there is no such question".to_owned())),
    }
}

fn parsed<T: DeserializeOwned>(body: &[u8]) -> Result<T, Refusal> {
    serde_json::from_slice(body).map_err(|error| Refusal::Unanswerable(format!("the question cannot be read: {error}")))
}

/// Centres and radii of the balls, local metres: four f32 each, little endian.
pub(crate) fn balls(scene: &PageScene) -> Vec<u8> {
    let balls = scene.model().balls();
    let rows = balls.centers.iter().zip(&balls.radii);
    rows.flat_map(|(&[x, y, z], &r)| [x, y, z, r]).flat_map(f32::to_le_bytes).collect()
}
