//! Sun here: the sun's path over the horizon of a place, its hours, and the first and last light.

use super::context::RequestContext;
use super::places::{command_at, local, number, rounded};
use crate::replies::{QuestionReply, Refusal};
use crate::scene_text::in_words;
use belvedere::PointCloud;
use belvedere::apps::ask::{
    self, Answers, Days, OnTargets, Places, SunHoursQuestion, SunPlace, ThroughTrees, knows_intervals,
};
use belvedere::apps::horizon::{HorizonParams, horizons};
use belvedere::apps::sun::{Date, DayParams, Period, Refraction, Site, SunDay, Zone, sun_days, sun_position_with};
use belvedere::apps::targets::Targets;
use belvedere::query::{Answer as Sight, MedialScene, UnprovenAs, Viewer};
use serde::Deserialize;
use serde_json::{Value, json};
use std::sync::Arc;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SunRequest {
    place: [f64; 3],
    /// Date, such as 2026-06-21.
    date: String,
    zone: String,
    /// Light through trees.
    #[serde(default)]
    trees: ThroughTrees,
}

/// Day of the months whose suns are shown: near both solstices.
const DAY_OF_MONTH: i8 = 21;

pub(super) fn answer(question: &SunRequest, context: &RequestContext<'_>) -> Result<QuestionReply, Refusal> {
    let (scene, control) = (context.scene, context.control);
    let place = local(context, question.place)?;
    let site = scene.site()?;
    let zone = Zone::parse(&question.zone)?;
    let date = Date::parse(&question.date)?;
    let blockers = scene.blockers(UnprovenAs::Visible, control)?;
    if blockers.is_outside_cloud(place) {
        return Err(Refusal::Unanswerable("This place is outside the cloud, where nothing is known.".to_owned()));
    }
    let targets = Arc::new(target_at(context, place));
    let interval = !question.trees.is_light() && knows_intervals(&scene.inner, control)?;
    let hours_on = |date: Date| {
        let days = Days { dates: vec![date.to_string()], ..Days::default() };
        let place = SunPlace { zone: Some(question.zone.clone()), ..SunPlace::default() };
        let trees = question.trees;
        let question = SunHoursQuestion { days, place, interval, trees, ..SunHoursQuestion::default() };
        ask::ask(&scene.inner, &question, &Places::Targets(Arc::clone(&targets)), control)
    };
    let of_day = hours_on(date)?;
    let steps_on = |date: Date| sun_days(&site, &zone, &Period::Days(vec![date]), &DayParams::default());
    let day = steps_on(date)?;
    let months: Result<Vec<Value>, Refusal> = (1..=12)
        .map(|month| {
            let date = Date::new(date.year(), month, DAY_OF_MONTH)?;
            let days = steps_on(date)?;
            Ok(json!({
                "month": month,
                "sun_hours": first_value(&hours_on(date)?, "sun_hours"),
                "possible_hours": rounded(possible(&days), 3),
                "path": days.iter().flat_map(|day| path(&site, day)).collect::<Vec<_>>(),
            }))
        })
        .collect();
    let skyline = HorizonParams::default().with_turn(scene.grid_north(Some(place)));
    let skyline = horizons(&blockers, &[place], &skyline, control)?;
    let horizon: Vec<Value> = skyline.iter().flatten().map(|point| number(point.elevation.to_degrees(), 3)).collect();
    let lit = lit_steps(&blockers, &targets, &day);
    let path: Vec<Value> = day.iter().flat_map(|day| path(&site, day)).collect();
    let trees = in_words(question.trees);
    let flags = format!("--date {} --zone {}{trees} -o sun.csv", question.date, zone.name());
    let head = json!({
        "sun_hours": first_value(&of_day, "sun_hours"),
        "interval_hours": interval.then(|| ["hours_low", "hours_high"].map(|end| first_value(&of_day, end))),
        "sun_share": first_value(&of_day, "sun_share"),
        "first_light": first_value(&of_day, "first_light"),
        "last_light": first_value(&of_day, "last_light"),
        "longest": first_value(&of_day, "longest"),
        "possible_hours": rounded(possible(&day), 3),
        "remarks": of_day.remarks,
        "horizon_deg": horizon,
        "path": path,
        "lit": lit,
        "months": months?,
        "zone": zone.name(),
        "latitude_deg": rounded(site.latitude.to_degrees(), 5),
        "longitude_deg": rounded(site.longitude.to_degrees(), 5),
        "command": command_at(context, question.place, "sun-hours", &flags),
    });
    Ok(QuestionReply::of(head))
}

/// The measure `name` of the first target.
fn first_value(answers: &Answers<OnTargets>, name: &str) -> Value {
    let measure = answers.measures.iter().find(|measure| measure.name == name);
    measure.and_then(|measure| measure.values.first()).map_or(Value::Null, |&v| number(f64::from(v), 3))
}

/// Hours of sun over a free horizon.
fn possible(days: &[SunDay]) -> f64 {
    days.iter().map(SunDay::possible_hours).sum()
}

/// The place as the only target.
pub(super) fn target_at(context: &RequestContext<'_>, place: [f64; 3]) -> Targets {
    let mut cloud = PointCloud::in_frame(context.scene.model().frame().clone());
    cloud.positions = vec![belvedere::cloud::to_local(place, [0.0; 3])];
    Targets::of_points(&cloud, None)
}

/// Time of day, azimuth and elevation of the sun halfway through each step of a day.
fn path(site: &Site, day: &SunDay) -> Vec<Value> {
    day.steps
        .iter()
        .filter_map(|step| {
            let middle = f64::midpoint(step.start, step.end);
            let position = sun_position_with(site, middle, Refraction::default()).ok()?;
            Some(json!([
                rounded(day.clock_hours(middle), 3),
                rounded(position.azimuth.to_degrees(), 2),
                rounded(position.elevation.to_degrees(), 2),
            ]))
        })
        .collect()
}

/// Flags the steps whose sun reaches the place.
fn lit_steps(blockers: &MedialScene, targets: &Targets, days: &[SunDay]) -> Vec<bool> {
    let steps = days.iter().flat_map(|day| &day.steps);
    steps
        .map(|step| {
            let answers = blockers.visible_from(
                Viewer::Direction(step.direction),
                &targets.positions,
                &belvedere::control::Control::none(),
            );
            answers.is_ok_and(|answers| answers.first() == Some(&Sight::Visible))
        })
        .collect()
}
