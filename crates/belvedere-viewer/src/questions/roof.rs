//! Energy of the roof here: of the plane that was clicked, under a year of clear sky.

use super::RequestContext;
use super::places::{local, number, rounded};
use crate::replies::{QuestionReply, Refusal};
use crate::scene::PageScene;
use belvedere::apps::irradiance::{
    CLEAR_SKY_YEAR, ClearSky, Grouping, IrradianceParams, RadiationSource, SeasonRadiation, period_seasons,
    roof_irradiation,
};
use belvedere::apps::roof_planes::{RoofPlane, RoofPlaneParams, roof_planes, roof_points};
use belvedere::control::Control;
use belvedere::ground::{Ground, GroundParams, MapGrid};
use belvedere::query::UnprovenAs;
use belvedere::{Error, Result};
use serde::Deserialize;
use serde_json::{Value, json};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RoofRequest {
    place: [f64; 3],
}

/// Cells of the ground that roofs are separated from, metres: those of the command line.
const GROUND_CELL: f64 = 1.0;
/// How far a clicked place may lie from the nearest point of a plane, metres.
const REACH: f64 = 1.0;

/// The planes of all roofs, and what sun and sky send in a year.
pub(crate) struct RoofPlanes {
    planes: Vec<RoofPlane>,
    /// The points that the rows of planes belong to, local metres.
    points: Vec<[f32; 3]>,
    seasons: Vec<SeasonRadiation>,
}

impl RoofPlanes {
    pub(crate) fn of(scene: &PageScene, control: &Control<'_>) -> Result<Self> {
        let cloud = scene.cloud()?;
        let (low, high) = scene.model().bounds().on_map();
        let grid = MapGrid::covering(low, high, GROUND_CELL, [cloud.frame.origin[0], cloud.frame.origin[1]])?;
        let (ground, _) = Ground::of_cloud(cloud, grid, &GroundParams::default(), control)?;
        let (rows, _) = roof_points(cloud, &ground)?;
        let points: Vec<[f32; 3]> = rows.iter().filter_map(|&row| cloud.positions.get(row as usize).copied()).collect();
        let planes = roof_planes(&points, &RoofPlaneParams::default(), control)?;
        let source = RadiationSource::ClearSky { clear_sky: ClearSky::default(), year: CLEAR_SKY_YEAR };
        let params = IrradianceParams::default().with_grouping(Grouping::Months);
        let (seasons, _) = period_seasons(&source, &scene.site()?, None, &params, control)?;
        Ok(Self { planes, points, seasons })
    }

    /// The plane with the point nearest to a place, and its number.
    fn at(&self, place: [f64; 3]) -> Option<(usize, &RoofPlane)> {
        let distance = |plane: &RoofPlane| {
            let away = |row: &u32| {
                let point = self.points.get(*row as usize)?;
                Some(point.iter().zip(place).map(|(&a, b)| (f64::from(a) - b).powi(2)).sum::<f64>())
            };
            plane.points.iter().filter_map(away).fold(f64::INFINITY, f64::min)
        };
        let all = self.planes.iter().enumerate().map(|(number, plane)| (distance(plane), number, plane));
        let (away, number, plane) = all.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (away <= REACH * REACH).then_some((number, plane))
    }
}

pub(super) fn answer(
    question: &RoofRequest,
    context: &RequestContext<'_>,
) -> std::result::Result<QuestionReply, Refusal> {
    let (scene, control) = (context.scene, context.control);
    let place = local(context, question.place)?;
    let site = scene.site()?;
    let roofs = scene.roofs(control)?;
    let Some((plane_index, plane)) = roofs.at(place) else {
        return Err(Refusal("There is no plane of a roof here: click a roof of at least 4 m².".to_owned()));
    };
    let blockers = scene.blockers(UnprovenAs::Visible, control)?;
    let energies = roof_irradiation(&*blockers, std::slice::from_ref(plane), &roofs.seasons, control)?;
    let Some(energy) = energies.first() else {
        return Err(Error::NoPoints { what: "the plane has no cells".to_owned() }.into());
    };
    let from_north = |azimuth: f64| (azimuth + site.convergence).to_degrees().rem_euclid(360.0);
    let months: Vec<Value> = energy.groups.iter().map(|&v| number(v, 2)).collect();
    let head = json!({
        "plane": plane_index + 1,
        "area_m2": number(plane.area, 2),
        "panel_area_m2": number(energy.panel_area(plane), 2),
        "tilt_deg": number(plane.tilt().to_degrees(), 2),
        "azimuth_deg": number(plane.azimuth().map_or(f64::NAN, from_north), 2),
        "kwh_m2": number(energy.mean.total(), 1),
        "free_kwh_m2": number(energy.mean.unshaded, 1),
        "min_loss": number(energy.mean.loss(), 4),
        "max_loss": number(energy.greatest_loss(), 4),
        "kwh": number(energy.panel_area(plane) * energy.mean.total(), 0),
        "months_kwh_m2": months,
        "year": CLEAR_SKY_YEAR,
        "planes": roofs.planes.len(),
        "roofs_m2": rounded(roofs.planes.iter().map(|plane| plane.area).sum(), 1),
        "command": context.text.command_on_ground("irradiance", "--clear-sky ineichen --months --min-cells 1 --planes roofs.csv"),
    });
    let points = plane.points.iter().filter_map(|&row| roofs.points.get(row as usize));
    Ok(QuestionReply { head, body: points.flatten().flat_map(|v| v.to_le_bytes()).collect() })
}
