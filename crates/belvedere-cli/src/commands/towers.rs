//! `belvedere towers`.

use crate::arguments::{Global, SkyPlaces, TowersArguments, refuse};
use crate::outputs::formats::{check_folder, check_outputs, extension, refuse_files_of};
use crate::outputs::sheet::Sheet;
use crate::outputs::targets::{TargetOutput, remark_on_first};
use crate::pipeline::{self, KeepPoints};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::Frame;
use belvedere::apps::ask::{self, Ask, FarTowers, GivenTower, MAX_WIRELINES, Reach, Standing, TowersResults};
use belvedere::crs::Crs;
use belvedere::figures::{MapLegend, MapPicture, Picture, map_picture, ramp, write_png};
use belvedere::io::{TowerRow, read_towers};
use belvedere::results::{ResultRaster, terrain_georeference, wireline_files, write_wirelines};
use std::path::Path;

pub(crate) fn run(arguments: &TowersArguments, global: &Global) -> Result<Summary> {
    let places = arguments.places();
    places.check(&arguments.outputs)?;
    check_outputs("--far-output", &arguments.far_output, &["tif", "tiff", "png"])?;
    if let Some(folder) = &arguments.wirelines {
        check_wirelines(folder, &places, arguments)?;
    }
    let mut run = CommandContext::new(global);
    // wrong towers must not be found out after the balls were made; only points need the system of the cloud
    let is_table = matches!(extension(&arguments.towers).as_str(), "csv" | "txt");
    let of_table = is_table.then(|| read_towers(arguments.towers.as_path(), &Crs::default())).transpose()?;
    if let Some(rows) = &of_table {
        question(arguments, rows)?.check()?;
    }
    if places.far.terrain.is_none() {
        places.check_on_map(&arguments.scene.input)?;
    }
    let mut scene = pipeline::scene(&arguments.scene, KeepPoints::Keep, &mut run)?;
    places.far.set(&mut scene, &mut run)?;
    let scene = scene.into_question_scene(Some(&arguments.ground), arguments.shell.shell, &run)?;
    let rows = of_table.map_or_else(|| read_towers(arguments.towers.as_path(), &scene.frame().crs), Ok)?;
    let mut question = question(arguments, &rows)?;
    for (tower, row) in question.towers.iter_mut().zip(&rows) {
        tower.foot = Standing::on_map(row.place, row.base, scene.frame(), &scene.model().bounds())?.place;
    }
    let (places, source) = places.places_within(Reach::FarTerrain, &scene, &mut run)?;
    let answers = run.ask(&scene, &question, &places)?;
    let found = &answers.found;
    let shown = TargetOutput::new(&found.on_targets, source, &scene);
    shown.write(&arguments.outputs, &answers.measures, &mut run)?;
    if let Some(far) = &found.far {
        for output in &arguments.far_output {
            write_far(output, (found, far), scene.frame(), &mut run)?;
        }
        run.summary.add_paths("far_written", &arguments.far_output);
    }
    if let (Some(folder), Some(wirelines)) = (&arguments.wirelines, &found.wirelines) {
        let files = run.stage("writing", 0, |_| write_wirelines(folder, wirelines, scene.frame()))?;
        run.summary.add_paths("wirelines_written", files);
    }
    Ok(run.finish())
}

fn question(arguments: &TowersArguments, rows: &[TowerRow]) -> Result<ask::TowersQuestion> {
    let tower = |row: &TowerRow| GivenTower {
        // it needs the frame of the scene
        foot: [f64::NAN; 3],
        hub: row.hub,
        tip: row.tip,
        name: row.name.clone(),
        scheme: row.scheme.clone(),
    };
    Ok(ask::TowersQuestion {
        towers: rows.iter().map(tower).collect(),
        observer_height: arguments.height.map(f64::from),
        max_distance: arguments.max_distance,
        earth: arguments.earth.params()?,
        ground: arguments.ground.points(),
        far: !arguments.far_output.is_empty(),
        wirelines: arguments.wirelines.is_some(),
    })
}

/// Refuses wirelines of cells, and other results among their files.
fn check_wirelines(folder: &Path, places: &SkyPlaces, arguments: &TowersArguments) -> Result<()> {
    if places.is_grid() || places.places.own {
        return refuse("--wirelines needs places: --at X,Y or --targets FILE");
    }
    check_folder(folder)?;
    let inputs = std::iter::once(&arguments.towers).chain(&places.places.targets).chain(&places.far.terrain);
    let others = arguments.outputs.output.iter().chain(&arguments.far_output).chain(inputs);
    refuse_files_of("--wirelines", &wireline_files(folder, MAX_WIRELINES), others)
}

/// Writes the views from far terrain as a raster or a map.
fn write_far(
    output: &Path,
    (found, far): (&TowersResults, &FarTowers),
    frame: &Frame,
    run: &mut CommandContext,
) -> Result<()> {
    let FarTowers { terrain, measures } = far;
    if extension(output) == "png" {
        let picture = run.compute("drawing map", || map_of_terrain(found, far, frame))?;
        run.summary.remarks(remark_on_first(output, measures));
        return Ok(run.stage("writing", 0, |_| write_png(output, &picture))?);
    }
    let place = terrain_georeference(terrain, frame);
    let size = [terrain.heights().width(), terrain.heights().height()];
    let raster = ResultRaster::of_measures(measures, size)?.with_tags(&run.tags);
    Ok(run.stage("writing", 0, |_| raster.write(output, Some(&place)))?)
}

/// Visible metres over the relief of the terrain, with the towers.
fn map_of_terrain(found: &TowersResults, far: &FarTowers, frame: &Frame) -> belvedere::Result<Picture> {
    let measure = &far.measures[0];
    let values: Vec<f64> = measure.values.iter().map(|&value| value.into()).collect();
    let [low, high] = measure.span(&values);
    let color = |&value: &f64| value.is_finite().then(|| ramp((value - low) / (high - low)));
    let colors: Vec<Option<[u8; 3]>> = values.iter().map(color).collect();
    let sheet = Sheet::of_terrain(&far.terrain, &colors, frame)?;
    let feet: Vec<[f64; 3]> = found.towers.iter().map(|tower| tower.line.foot).collect();
    map_picture(&MapPicture {
        marks: &sheet.marks(&feet),
        mark_name: "tower",
        ..MapPicture::of_colors(
            &sheet.relief,
            sheet.cell,
            Some(&sheet.place),
            &sheet.colors,
            &format!("{}, from the terrain", found.on_targets.title),
            MapLegend::Ramp(measure.description, [low, high], &[]),
        )
    })
}
