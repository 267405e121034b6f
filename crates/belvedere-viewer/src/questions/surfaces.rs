//! Surfaces of the buildings: the lines on which they end, and the plane of a roof that a point lies on.

use super::context::RequestContext;
use super::places::{local, number};
use crate::replies::{QuestionReply, Refusal};
use belvedere::apps::roof_planes::MAX_LEVEL;
use belvedere::cloud::to_local;
use belvedere::planes::{BuildingOutlines, RoofPlane};
use serde::Deserialize;
use serde_json::{Value, json};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SurfacesRequest {
    /// A point of the cloud; without one, the lines are wanted.
    #[serde(default)]
    place: Option<[f64; 3]>,
}

pub(super) fn answer(question: &SurfacesRequest, context: &RequestContext<'_>) -> Result<QuestionReply, Refusal> {
    let outlines = context.scene.model().outlines();
    let Some(place) = question.place else { return Ok(lines(outlines)) };
    let plane = outlines.plane_at(local(context, place)?);
    Ok(QuestionReply::of(json!({ "roof": plane.map(of_plane) })))
}

/// Slope and azimuth, degrees from level and from grid north, and how well the plane is known.
fn of_plane(plane: &RoofPlane) -> Value {
    let [east, north, up] = plane.normal;
    let slope = east.hypot(north).atan2(up);
    let azimuth = if slope > MAX_LEVEL { east.atan2(north).to_degrees().rem_euclid(360.0) } else { f64::NAN };
    json!({
        "slope_deg": number(slope.to_degrees(), 2),
        "azimuth_deg": number(azimuth, 2),
        "points": plane.count,
        "noise_m": number(plane.noise, 4),
        "sd_m": number(plane.sd, 4),
    })
}

/// Both ends of each line, local metres: edges, then ridges and valleys, then walls at the height of their roofs.
fn lines(outlines: &BuildingOutlines) -> QuestionReply {
    let BuildingOutlines { edges, ridges, walls, .. } = outlines;
    let of_walls = walls.iter().map(|wall| wall.ends.map(|[x, y]| [x, y, wall.heights[1]]));
    let ends = edges.iter().map(|edge| edge.ends).chain(ridges.iter().map(|ridge| ridge.ends)).chain(of_walls);
    let body = ends.flatten().flat_map(|place| to_local(place, [0.0; 3])).flat_map(f32::to_le_bytes).collect();
    let head = json!({ "edges": edges.len(), "ridges": ridges.len(), "walls": walls.len() });
    QuestionReply { head, body }
}
