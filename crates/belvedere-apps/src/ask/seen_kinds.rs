//! Kinds of the balls of a scene.

use super::context::Context;
use super::remark::Remark;
use super::scene::Scene;
use crate::window_views::{ClassMeanings, SeenKind, are_made_from, balls_seen};
use belvedere_data::Result;

/// Returns the kind of each ball of a scene.
///
/// # Errors
/// Those of [`balls_seen`].
pub(super) fn kinds_of_balls(scene: &Scene, meanings: &ClassMeanings, context: &mut Context) -> Result<Vec<SeenKind>> {
    let (model, cloud) = (scene.model(), scene.cloud());
    let classes = cloud.attributes.classification.as_deref();
    let of_balls = classes.filter(|_| are_made_from(model.balls(), &cloud.positions));
    if of_balls.is_none() {
        let why = match classes {
            _ if cloud.is_empty() => "; give the cloud that the balls were built from",
            Some(_) => "; the balls were not built from the cloud that was given",
            None => "",
        };
        let text = format!("the classes of points are unknown: only vegetation is known, from pulses{why}");
        context.add(Some(Remark::warning("classes-unknown", text)));
    }
    balls_seen(model.balls(), of_balls, model.vegetation(), meanings)
}
