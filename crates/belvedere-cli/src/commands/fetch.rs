//! `belvedere fetch`: open surveys of a place, and their points.

use crate::arguments::{FetchArguments, Global};
use crate::outputs::formats::{check_folder, check_output, is_folder};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::io::open_surveys::{
    FoundSurvey, MAX_CLOUD_RADIUS, SurveyArea, SurveyTile, best_covering, download_tiles, find_surveys, known_surveys,
    read_area, read_surveys, surveys_at, write_origin,
};
use belvedere::io::{atomic, write_cloud};
use belvedere::report::counted;
use serde_json::{Value, json};
use std::path::Path;

/// Bytes of a megabyte, as download pages count.
const MEGABYTE: f64 = 1e6;

pub(crate) fn run(arguments: &FetchArguments, global: &Global) -> Result<Summary> {
    if let Some(output) = &arguments.output {
        if is_folder(output) {
            check_folder(output)?;
        } else {
            check_output("-o", output, &["laz", "las"])?;
        }
    }
    let area = SurveyArea::around(arguments.at.0, arguments.radius)?;
    if arguments.output.as_deref().is_some_and(|output| !is_folder(output)) {
        area.check_cloud()?;
    }
    let table = arguments.surveys.as_deref().map_or_else(known_surveys, read_surveys)?;
    let surveys = surveys_at(table, arguments.survey.as_deref(), &area)?;
    let mut run = CommandContext::new(global);
    let found = find_surveys(&surveys, &area, &run.control())?;
    for text in found.iter().filter_map(FoundSurvey::failure_in_words) {
        run.summary.warn("survey-not-reached", text);
    }
    let Some(output) = &arguments.output else {
        list(&found, arguments, &mut run.summary);
        return Ok(run.finish());
    };
    let chosen = best_covering(&found)?;
    run.summary.add("survey", json!(chosen));
    if let Some(text) = chosen.part_in_words() {
        run.summary.warn("survey-covers-a-part", text);
    }
    if is_folder(output) {
        let files = download(chosen, output, &area, &mut run)?;
        run.summary.answer(&format!("{} of {}", counted(files, "tile"), chosen.survey.title));
    } else {
        let (cloud, report) = read_area(chosen, &area, &run.control())?;
        run.summary.add_report(&report);
        let written = run.stage("writing", 0, |_| write_cloud(output.as_path(), &cloud, &[]))?;
        run.summary.add_writing(output, &written);
        write_origin(&output.with_extension("origin.json"), chosen, &area)?;
        run.summary.add("points", cloud.len());
        run.summary.headline(format!("<points> points of {}", chosen.survey.title));
    }
    let name = if chosen.tiles.iter().any(SurveyTile::is_archive) { "unpack them, then: " } else { "" };
    run.summary.answer(&format!("licence: {}; name the source: {}", chosen.survey.licence, chosen.survey.attribution));
    run.summary.answer(&format!("next: {name}belvedere info {}", output.display()));
    run.summary.add("written", output.display().to_string());
    Ok(run.finish())
}

/// Writes whole tiles and their origin into a folder; returns their number.
fn download(found: &FoundSurvey, folder: &Path, area: &SurveyArea, run: &mut CommandContext) -> Result<usize> {
    atomic::make_folder(folder)?;
    let paths = download_tiles(found, folder, &run.control())?;
    write_origin(&folder.join(format!("{}.origin.json", found.survey.name)), found, area)?;
    Ok(paths.len())
}

/// Adds the surveys as the answer.
fn list(found: &[FoundSurvey], arguments: &FetchArguments, summary: &mut Summary) {
    let [latitude, longitude] = arguments.at.0;
    summary.answer(&format!("surveys within {} m of {latitude}, {longitude}:", arguments.radius));
    let (ready, others): (Vec<_>, Vec<_>) = found.iter().partition(|found| !found.tiles.is_empty());
    for found in &ready {
        let FoundSurvey { survey, tiles, covered_percent, .. } = found;
        let bytes: Option<u64> = tiles.iter().map(|tile| tile.bytes).sum();
        let size = bytes.map_or_else(String::new, |bytes| format!(", {:.0} MB", bytes as f64 / MEGABYTE));
        let density = survey.points_per_m2.map_or_else(String::new, |density| format!(", {density} points/m²"));
        let part = if found.is_whole() { String::new() } else { format!(", covers {covered_percent:.0} %") };
        let tiles = counted(tiles.len(), "tile");
        summary
            .answer(&format!("  {}: {}{density}, {tiles}{size}{part}, {}", survey.name, survey.title, survey.licence));
    }
    for FoundSurvey { survey, failure, .. } in &others {
        let why = if failure.is_some() { "not reached; its page is" } else { "choose tiles on" };
        summary.answer(&format!("  {}: {}: {why} {}", survey.name, survey.title, survey.page));
    }
    if found.is_empty() {
        summary.answer("  none has a tile there; https://portal.opentopography.org/datasets lists others");
    }
    if let Ok(best) = best_covering(found) {
        let is_whole_tiles = arguments.radius > MAX_CLOUD_RADIUS || best.tiles.iter().any(SurveyTile::is_archive);
        let output = if is_whole_tiles { "tiles" } else { "place.laz" };
        let at = format!("--at {latitude},{longitude} --radius {}", arguments.radius);
        let table = arguments.surveys.as_ref().map(|path| format!(" --surveys {}", path.display())).unwrap_or_default();
        summary.answer(&format!("next: belvedere fetch {at}{table} --survey {} -o {output}", best.survey.name));
    }
    summary.add("surveys", found.iter().map(|found| json!(found)).collect::<Vec<Value>>());
}
