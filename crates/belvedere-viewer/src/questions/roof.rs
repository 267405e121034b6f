//! Energy of the roof here: of the plane that was clicked, under a year of clear sky.

use super::context::RequestContext;
use super::places::{local, number, rounded};
use crate::replies::{QuestionReply, Refusal};
use belvedere::Error;
use belvedere::apps::ask::knows_intervals;
use belvedere::apps::irradiance::{CLEAR_SKY_YEAR, roof_irradiation};
use belvedere::apps::sum_errors::Intervals;
use belvedere::query::UnprovenAs;
use serde::Deserialize;
use serde_json::{Value, json};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RoofRequest {
    place: [f64; 3],
}

pub(super) fn answer(question: &RoofRequest, context: &RequestContext<'_>) -> Result<QuestionReply, Refusal> {
    let (scene, control) = (context.scene, context.control);
    let place = local(context, question.place)?;
    let site = scene.site()?;
    let roofs = scene.roofs(control)?;
    let Some((plane_index, plane)) = roofs.at(place) else {
        return Err(Refusal::Unanswerable(
            "There is no plane of a roof here: click a roof of at least 4 m².".to_owned(),
        ));
    };
    let blockers = scene.blockers(UnprovenAs::Visible, control)?;
    let intervals = Intervals::wanted(knows_intervals(&scene.inner, control)?);
    let energies = roof_irradiation(&*blockers, std::slice::from_ref(plane), &roofs.seasons, intervals, control)?;
    let Some(energy) = energies.first() else {
        return Err(Error::NoPoints { what: "the plane has no cells".to_owned() }.into());
    };
    let from_north = |azimuth: f64| (azimuth + site.convergence).to_degrees().rem_euclid(360.0);
    let [_, low, high] = energy.expected();
    let months: Vec<Value> = energy.groups.iter().map(|&v| number(v, 2)).collect();
    let head = json!({
        "plane": plane_index + 1,
        "area_m2": number(plane.area, 2),
        "panel_area_m2": number(energy.panel_area(plane), 2),
        "tilt_deg": number(plane.tilt().to_degrees(), 2),
        "azimuth_deg": number(plane.azimuth().map_or(f64::NAN, from_north), 2),
        "kwh_m2": number(energy.mean.total(), 1),
        "interval_kwh_m2": energy.class.map(|_| [low, high].map(|end| number(end, 1))),
        "free_kwh_m2": number(energy.mean.unshaded, 1),
        "min_loss": number(energy.mean.loss(), 4),
        "max_loss": number(energy.greatest_loss(), 4),
        "radiation_kwh": number(energy.panel_area(plane) * energy.mean.total(), 0),
        "months_kwh_m2": months,
        "year": CLEAR_SKY_YEAR,
        "planes": roofs.planes.len(),
        "roofs_m2": rounded(roofs.planes.iter().map(|plane| plane.area).sum(), 1),
        "command": context.text.command_on_ground("irradiance", "--clear-sky ineichen --months --min-cells 1 --planes roofs.csv"),
    });
    let points = plane.points.iter().filter_map(|&row| roofs.points.get(row as usize));
    Ok(QuestionReply { head, body: points.flatten().flat_map(|v| v.to_le_bytes()).collect() })
}
