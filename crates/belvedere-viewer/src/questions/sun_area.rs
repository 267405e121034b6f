//! Sun hours of an area that was drawn: of the cells on the ground whose middle lies in it.

use super::context::RequestContext;
use super::places::{local, number, rounded};
use crate::replies::{QuestionReply, Refusal};
use crate::scene_text::in_words;
use belvedere::apps::ask::{self, Days, GridCells, Places, SunHoursQuestion, SunPlace, ThroughTrees};
use serde::Deserialize;
use serde_json::json;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SunAreaRequest {
    /// Corners on the map, in the coordinates of the file.
    corners: Vec<[f64; 2]>,
    date: String,
    zone: String,
    /// Light through trees.
    #[serde(default)]
    trees: ThroughTrees,
}

pub(super) fn answer(question: &SunAreaRequest, context: &RequestContext<'_>) -> Result<QuestionReply, Refusal> {
    let scene = context.scene;
    if question.corners.len() < 3 {
        return Err(Refusal::Unanswerable("An area needs at least three corners.".to_owned()));
    }
    let corners = question
        .corners
        .iter()
        .map(|&[x, y]| local(context, [x, y, 0.0]).map(|[x, y, _]| [x, y]))
        .collect::<Result<Vec<[f64; 2]>, _>>()?;
    let cells = GridCells { within: vec![corners], ..GridCells::default() };
    let days = Days { dates: vec![question.date.clone()], ..Days::default() };
    let place = SunPlace { zone: Some(question.zone.clone()), ..SunPlace::default() };
    let hours = SunHoursQuestion { days, place, trees: question.trees, ..SunHoursQuestion::default() };
    let answers = ask::ask(&scene.inner, &hours, &Places::Cells(cells), context.control)?;
    let targets = &answers.found.targets;
    let known: Vec<usize> = (0..targets.len()).filter(|&row| targets.is_target(row)).collect();
    let (Some(measure), false) = (answers.measures.first(), known.is_empty()) else {
        return Err(Refusal::Unanswerable(
            "There is no ground in this area: draw it on the ground, and larger than a cell.".to_owned(),
        ));
    };
    let hours: Vec<f32> = known.iter().map(|&row| measure.values[row]).collect();
    let cell = targets.ground().map_or(0.0, |ground| ground.grid.cell);
    let possible = measure.range.map_or(0.0, |[_, max]| max);
    let mean = hours.iter().map(|&v| f64::from(v)).sum::<f64>() / hours.len().max(1) as f64;
    let min = hours.iter().copied().fold(f32::INFINITY, f32::min);
    let max = hours.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let head = json!({
        "cells": known.len(),
        "cell_m": cell,
        "area_m2": rounded(known.len() as f64 * cell * cell, 1),
        "mean_hours": rounded(mean, 3),
        "min_hours": number(f64::from(min), 3),
        "max_hours": number(f64::from(max), 3),
        "possible_hours": rounded(possible, 3),
        "remarks": answers.remarks,
        "command": context.text.command_on_ground("sun-hours", &format!("--date {} --zone {}{} -o sun.tif", question.date, question.zone, in_words(question.trees))),
    });
    let places = known.iter().map(|&row| targets.positions[row]);
    let body = places.zip(&hours).flat_map(|([x, y, z], &hours)| [x, y, z, hours]).flat_map(f32::to_le_bytes);
    Ok(QuestionReply { head, body: body.collect() })
}
