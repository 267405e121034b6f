//! `belvedere sun-hours`.

use crate::arguments::{Global, SunHoursArguments, refuse};
use crate::in_tiles::{TiledAnswers, TypedCells};
use crate::outputs::formats::refuse_files_of;
use crate::outputs::targets::TargetOutput;
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::ask::{Ask, HourlySun, Places, SunHoursQuestion};
use belvedere::io::{BandLabel, BandValues, Bands, MetadataTag, atomic, write_tif_bands};
use belvedere::raster::Raster;
use belvedere::results::georeference;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub(crate) fn run(arguments: &SunHoursArguments, global: &Global) -> Result<Summary> {
    arguments.places.check(&arguments.outputs)?;
    let question = SunHoursQuestion {
        days: arguments.when.days(),
        rules: arguments.rule.clone(),
        place: arguments.sun.place_from_true_north()?,
        sun_tolerance_deg: arguments.within,
        trees: arguments.trees.choice()?,
        interval: arguments.interval.interval,
    };
    question.check()?;
    if let Some(folder) = &arguments.hourly_sun {
        if !arguments.places.is_grid() {
            return refuse("--hourly-sun applies only to a grid");
        }
        let months: Vec<PathBuf> = (1..=12).map(|month| month_file(folder, month)).collect();
        let others = arguments.outputs.output.iter().chain(&arguments.places.edge_mask);
        refuse_files_of("--hourly-sun", &months, others)?;
    }
    let mut run = CommandContext::new(global);
    let cells = TypedCells::of_sky(
        (&arguments.scene, &arguments.tiles),
        &arguments.places,
        question.trees,
        &arguments.outputs,
        &[("--shell", arguments.shell.shell.is_some()), ("--hourly-sun", arguments.hourly_sun.is_some())],
    );
    let write = |tiled: &TiledAnswers, run: &mut CommandContext| {
        tiled.shown().write(&arguments.outputs, &tiled.answers.measures, run)
    };
    if cells.answered(question.clone(), write, &mut run)? {
        return Ok(run.finish());
    }
    let places = (&arguments.places, arguments.shell.shell);
    let of_places = cells.scene_of_sky(question.clone(), places, &mut run)?;
    let scene = of_places.scene();
    let (places, source) = arguments.places.places(scene, &mut run)?;
    let answers = run.ask(scene, &question, &places)?;
    of_places.finish(&run)?;
    let sun_of_year = match &arguments.hourly_sun {
        Some(folder) => {
            // places have said what there is to remark
            let places = Places::Targets(Arc::clone(&answers.found.targets));
            Some((folder, question.hourly_sun(None, &places, scene, &run.control())?.found))
        }
        None => None,
    };
    let shown = TargetOutput::new(&answers.found, source, scene);
    shown.write(&arguments.outputs, &answers.measures, &mut run)?;
    shown.write_edge_mask(arguments.places.edge_mask.as_deref(), &mut run)?;
    if let Some((folder, sun)) = &sun_of_year {
        write_hourly_sun(folder, sun, &mut run)?;
    }
    Ok(run.finish())
}

/// Writes a file for each month of a year, with a band for each hour.
fn write_hourly_sun(folder: &Path, sun: &HourlySun, run: &mut CommandContext) -> Result<()> {
    let Some(grid) = sun.targets.ground().map(|ground| ground.grid) else { return Ok(()) };
    let place = georeference(&grid, &sun.targets.frame);
    let tags: Vec<MetadataTag> = run.tags.iter().cloned().chain([("YEAR".to_owned(), sun.year.to_string())]).collect();
    atomic::make_folder(folder)?;
    run.stage("writing", 12, |control| {
        for month in 1..=12 {
            let hours = 0..HourlySun::HOURS;
            let labels: Vec<BandLabel> =
                hours.clone().map(|hour| BandLabel::new(&format!("{hour:02}:30"), "1")).collect();
            let band = |hour: u32| Raster::from_values(grid.width, grid.height, sun.days(month, hour));
            let rasters = hours.map(band).collect::<belvedere::Result<Vec<_>>>()?;
            let bands = Bands {
                values: BandValues::U32(&rasters, HourlySun::NO_BITS),
                labels: &labels,
                tags: &tags,
                description: Some("days with sun in the middle of an hour, a bit for each, the lowest for day 1"),
            };
            write_tif_bands(&month_file(folder, month), &bands, Some(&place))?;
            control.advance(1);
        }
        Ok::<_, belvedere::Error>(())
    })?;
    run.summary.add("hourly_sun_written", format!("{} ({})", folder.display(), sun.year));
    Ok(())
}

/// The file of a month, 1 to 12.
fn month_file(folder: &Path, month: i8) -> PathBuf {
    folder.join(format!("{month:02}.tif"))
}
