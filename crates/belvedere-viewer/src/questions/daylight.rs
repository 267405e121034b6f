//! Day and solar noon: choice of the first shadow that the page shows.

use super::context::RequestContext;
use crate::replies::{QuestionReply, Refusal};
use belvedere::apps::sun::{Zone, parse_instant, sun_position, sun_times};
use belvedere::report::rounded;
use serde::Deserialize;
use serde_json::json;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DaylightRequest {
    /// Date and time on the clocks of the zone, such as 2026-06-21T15:00.
    time: String,
    /// Name of a zone, or hours from UTC.
    zone: String,
}

const HOUR: f64 = 3600.0;

pub(super) fn answer(question: &DaylightRequest, context: &RequestContext<'_>) -> Result<QuestionReply, Refusal> {
    let site = context.scene.site()?;
    let zone = Zone::parse(&question.zone)?;
    let instant = parse_instant(&question.time, Some(&zone))?;
    let midnight = zone.instant_of(zone.date_at(instant)?, 0.0)?;
    let transits = sun_times(&site, midnight, midnight + 24.0 * HOUR)?.transits;
    // days without a transit are those of the poles, and one of clocks that change
    let noon = transits.first().copied().unwrap_or(midnight + 12.0 * HOUR);
    let minutes = ((noon + zone.offset_at(noon)) / 60.0).rem_euclid(24.0 * 60.0);
    Ok(QuestionReply::of(json!({
        "elevation_deg": rounded(sun_position(&site, instant)?.elevation.to_degrees(), 4),
        "noon_minutes": rounded(minutes, 2),
    })))
}
