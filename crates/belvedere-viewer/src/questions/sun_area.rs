//! Sun hours of an area that was drawn: of the cells on the ground whose middle lies in it.

use super::Asked;
use super::places::{local, number, rounded};
use crate::replies::{Answer, Refusal};
use belvedere::apps::sun::{Binning, Date, DayParams, Period, SunSchedule, Zone, sun_days};
use belvedere::apps::sun_hours::{SunPlan, scene_sun_hours};
use belvedere::apps::targets::{CellParams, Targets};
use belvedere::polygon::is_inside;
use belvedere::query::UnprovenAs;
use serde::Deserialize;
use serde_json::json;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Question {
    /// Corners on the map, in the coordinates of the file.
    corners: Vec<[f64; 2]>,
    date: String,
    zone: String,
}

pub(super) fn answer(question: &Question, asked: &Asked<'_>) -> Result<Answer, Refusal> {
    let (scene, control) = (asked.scene, asked.control);
    if question.corners.len() < 3 {
        return Err(Refusal("An area needs at least three corners.".to_owned()));
    }
    let corners = question
        .corners
        .iter()
        .map(|&[x, y]| local(asked, [x, y, 0.0]).map(|[x, y, _]| [x, y]))
        .collect::<Result<Vec<[f64; 2]>, _>>()?;
    let outline = [corners];
    let cloud = scene.cloud()?;
    let site = scene.site()?;
    let zone = Zone::parse(&question.zone)?;
    let date = Date::parse(&question.date)?;
    let ground = scene.ground(control)?;
    let grid = ground.grid;
    let cells = CellParams::default();
    let (mut targets, _) = Targets::of_cells(cloud, (*ground).clone(), &cells, control)?;
    if let Some(added) = scene.model.added() {
        targets.set_on_added(added, &cells);
    }
    for (cell, position) in targets.positions.iter_mut().enumerate() {
        if !is_inside(&outline, grid.center(cell % grid.width.max(1), cell / grid.width.max(1))) {
            *position = [f32::NAN; 3];
        }
    }
    let rows: Vec<usize> = (0..targets.len()).filter(|&row| targets.is_asked(row)).collect();
    if rows.is_empty() {
        return Err(Refusal(
            "There is no ground in this area: draw it on the ground, and larger than a cell.".to_owned(),
        ));
    }
    let days = sun_days(&site, &zone, &Period::Days(vec![date]), &DayParams::default())?;
    let plan = SunPlan::new(SunSchedule::new(&days, Binning::Auto)?, Vec::new());
    let blockers = scene.blockers(UnprovenAs::Visible, control)?;
    let few = of_rows(asked, &targets, &rows);
    let hours = scene_sun_hours(&*blockers, &few, &plan, Some(&site), control)?.period.hours;
    let mean = hours.iter().map(|&v| f64::from(v)).sum::<f64>() / hours.len().max(1) as f64;
    let least = hours.iter().copied().fold(f32::INFINITY, f32::min);
    let most = hours.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let head = json!({
        "cells": rows.len(),
        "cell_m": grid.cell,
        "area_m2": rounded(rows.len() as f64 * grid.cell * grid.cell, 1),
        "mean_hours": rounded(mean, 3),
        "min_hours": number(f64::from(least), 3),
        "max_hours": number(f64::from(most), 3),
        "possible_hours": rounded(plan.period().possible_hours(), 3),
        "command": asked.text.command_on_ground("sun-hours", &format!("--date {} --zone {} -o sun.tif", question.date, zone.name())),
    });
    let body =
        few.positions.iter().zip(&hours).flat_map(|(&[x, y, z], &hours)| [x, y, z, hours]).flat_map(f32::to_le_bytes);
    Ok(Answer { head, body: body.collect() })
}

/// Some of the targets as points.
fn of_rows(asked: &Asked<'_>, targets: &Targets, rows: &[usize]) -> Targets {
    let mut cloud = belvedere::PointCloud::in_frame(asked.scene.model.frame().clone());
    cloud.positions = rows.iter().map(|&row| targets.positions[row]).collect();
    Targets::of_points(&cloud, None)
}
