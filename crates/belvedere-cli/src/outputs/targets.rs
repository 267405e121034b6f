//! Answers at targets, as files.

use crate::arguments::{AreaOutputs, SkyOutputs, refuse};
use crate::outputs::formats::{extension, text_rows_for, warn_of_geojson};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::ask::{OnTargets, Remark, Scene, remark_on_empty_areas};
use belvedere::apps::targets::{AreaMeans, Measure, Targets};
use belvedere::figures::{Picture, write_png};
use belvedere::io::{Georeference, MetadataTag, PolygonArea, TextRows, atomic, read_features, write_tif_u8};
use belvedere::raster::Raster;
use belvedere::results::{
    ResultKind, TakenFrom, areas_of, georeference, measure_map, relief_of_cells, write_area_means, write_measures,
    write_raster,
};
use belvedere::{Mesh, PointCloud};
use belvedere_tiles::SurveyCells;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Source of targets.
pub(crate) enum TargetSource {
    Cells,
    /// Places that were typed.
    Single,
    /// The points of the scene.
    Own,
    /// Points with their attributes, and the file they were read from.
    File(Arc<PointCloud>, PathBuf),
    /// Places without heights, and their rows in tables.
    Places(TextRows),
    Mesh(Arc<Mesh>),
}

/// Targets of which something was found, to be shown.
pub(crate) struct TargetOutput<'a> {
    on: &'a OnTargets,
    source: TargetSource,
    of: Shown<'a>,
}

/// Scene or survey that targets lie in.
#[derive(Clone, Copy)]
enum Shown<'a> {
    Scene(&'a Scene),
    Survey(&'a SurveyCells),
}

/// Heights of the highest points of cells, and where these lie.
pub(crate) struct HighestPoints {
    pub(crate) heights: Raster<f32>,
    /// Side of a cell, metres.
    pub(crate) cell: f64,
    pub(crate) place: Georeference,
}

impl<'a> TargetOutput<'a> {
    pub(crate) fn new(on: &'a OnTargets, source: TargetSource, scene: &'a Scene) -> Self {
        Self { on, source, of: Shown::Scene(scene) }
    }

    /// Cells of a survey that was answered in tiles.
    pub(crate) fn of_survey(on: &'a OnTargets, cells: &'a SurveyCells) -> Self {
        Self { on, source: TargetSource::Cells, of: Shown::Survey(cells) }
    }

    /// Returns the targets.
    pub(crate) fn targets(&self) -> &Targets {
        &self.on.targets
    }

    /// Returns the relief below maps; `None` if targets are no cells.
    pub(crate) fn relief(&self, run: &CommandContext) -> Result<Option<HighestPoints>> {
        let Some(ground) = self.on.targets.ground() else { return Ok(None) };
        let heights = match self.of {
            Shown::Scene(scene) => relief_of_cells(&self.on.targets, scene),
            Shown::Survey(cells) => Some(run.stage("reading relief", 0, |control| cells.relief(control))?),
        };
        let place = georeference(&ground.grid, &self.on.targets.frame);
        Ok(heights.map(|heights| HighestPoints { heights, cell: ground.grid.cell, place }))
    }

    /// Writes which cells are near the edge of the cloud.
    pub(crate) fn write_edge_mask(&self, path: Option<&Path>, run: &mut CommandContext) -> Result<()> {
        let (Some(path), Some(ground)) = (path, self.on.targets.ground()) else { return Ok(()) };
        let values = self.on.near_edge.iter().map(|&flag| ResultKind::answer(flag)).collect();
        let raster = Raster::from_values(ground.grid.width, ground.grid.height, values)?;
        let place = georeference(&ground.grid, &self.on.targets.frame);
        let what = "1 near the edge of the cloud, 0 not, 255 nodata";
        let nothing = Some(ResultKind::NO_ANSWER);
        run.stage("writing", 0, |_| write_tif_u8(path, &raster, Some(&place), nothing, Some(what)))?;
        run.summary.add("edge_mask_written", path.display().to_string());
        Ok(())
    }

    /// Writes all measures to each of the outputs; maps show the first.
    pub(crate) fn write(&self, outputs: &SkyOutputs, measures: &[Measure], run: &mut CommandContext) -> Result<()> {
        let map = |relief: &HighestPoints| {
            measure_map(&measures[0], &relief.heights, relief.cell, &relief.place, &self.on.title)
        };
        self.write_with(outputs, measures, &map, run)?;
        let maps = outputs.output.iter().filter(|output| extension(output) == "png");
        maps.for_each(|output| run.summary.remarks(remark_on_first(output, measures)));
        Ok(())
    }

    /// Writes all measures to each of the outputs, with maps of one's own.
    pub(crate) fn write_with(
        &self,
        outputs: &SkyOutputs,
        measures: &[Measure],
        map: &dyn Fn(&HighestPoints) -> belvedere::Result<Picture>,
        run: &mut CommandContext,
    ) -> Result<()> {
        let mut written = self.write_files(&outputs.output, measures, map, run)?;
        if let (Some(folder), TargetSource::Cells) = (&outputs.measures, &self.source) {
            atomic::make_folder(folder)?;
            for measure in measures {
                let path = folder.join(format!("{}.tif", measure.name));
                write_raster(&path, &self.on.targets, &[measure], &run.tags)?;
                written.push(path.display().to_string());
            }
        }
        if let AreaOutputs { areas: Some(areas), by_area: Some(output) } = &outputs.by_area {
            self.write_by_area((areas, output), measures, run)?;
            written.push(output.display().to_string());
        }
        if matches!(self.source, TargetSource::Mesh(_)) {
            let meshes = outputs.output.iter().filter(|output| extension(output) == "ply");
            meshes.for_each(|output| run.summary.remarks(remark_on_first(output, measures)));
        }
        run.summary.add("written", written);
        Ok(())
    }

    /// Writes all measures to each of the files, and returns their names.
    pub(crate) fn write_files(
        &self,
        outputs: &[PathBuf],
        measures: &[Measure],
        map: &dyn Fn(&HighestPoints) -> belvedere::Result<Picture>,
        run: &mut CommandContext,
    ) -> Result<Vec<String>> {
        let has_pictures = outputs.iter().any(|output| extension(output) == "png");
        let relief = if has_pictures { self.relief(run)? } else { None };
        for output in outputs {
            let mut section = Summary::default();
            run.stage("writing", 0, |_| match (&relief, extension(output).as_str()) {
                (Some(relief), "png") => Ok(write_png(output, &map(relief)?)?),
                _ => self.write_one(output, (measures, &run.tags), &mut section),
            })?;
            run.summary.add_all(section);
        }
        Ok(outputs.iter().map(|output| output.display().to_string()).collect())
    }

    /// Writes the measures of cells, summed up over the areas of a file.
    fn write_by_area(
        &self,
        (areas, output): (&Path, &Path),
        measures: &[Measure],
        run: &mut CommandContext,
    ) -> Result<()> {
        let frame = &self.on.targets.frame;
        let areas_read = areas_of(&read_features(areas, &frame.crs)?);
        if areas_read.is_empty() {
            return refuse(format!("--areas: {} has no polygons", areas.display()));
        }
        let local =
            |ring: &Vec<[f64; 2]>| ring.iter().map(|[x, y]| [x - frame.origin[0], y - frame.origin[1]]).collect();
        let local = |rings: &Vec<Vec<[f64; 2]>>| rings.iter().map(local).collect();
        let means = |area: &PolygonArea| {
            let polygons: Vec<Vec<Vec<[f64; 2]>>> = area.polygons.iter().map(local).collect();
            AreaMeans::of(&polygons, &self.on.targets, measures)
        };
        let means = areas_read.iter().map(means).collect::<belvedere::Result<Vec<_>>>()?;
        run.summary.remarks(remark_on_empty_areas(&means));
        warn_of_geojson(std::slice::from_ref(&output.to_owned()), &frame.crs, &mut run.summary);
        run.stage("writing", 0, |_| write_area_means(output, &areas_read, &means, frame))?;
        Ok(())
    }

    fn write_one(
        &self,
        output: &Path,
        (measures, tags): (&[Measure], &[MetadataTag]),
        summary: &mut Summary,
    ) -> Result<()> {
        if let Shown::Survey(cells) = self.of {
            return Ok(cells.write_cog(output, measures, tags)?);
        }
        let rows = match &self.source {
            TargetSource::File(_, file) => text_rows_for(file, output)?,
            _ => None,
        };
        let from = match &self.source {
            TargetSource::Cells | TargetSource::Single => TakenFrom::Nothing,
            TargetSource::Own => match self.of {
                Shown::Scene(scene) => TakenFrom::Cloud(scene.cloud()),
                Shown::Survey(_) => TakenFrom::Nothing,
            },
            TargetSource::Places(rows) if extension(output) == "csv" => TakenFrom::Rows(rows),
            TargetSource::Places(_) => TakenFrom::Nothing,
            TargetSource::File(cloud, _) => rows.as_ref().map_or(TakenFrom::Cloud(cloud), TakenFrom::Rows),
            TargetSource::Mesh(mesh) => TakenFrom::Mesh(mesh),
        };
        summary.add_writing(output, &write_measures(output, &self.on.targets, from, measures, tags)?);
        Ok(())
    }
}

/// Warns of a file that has room for one of several measures.
pub(crate) fn remark_on_first(output: &Path, measures: &[Measure]) -> Option<Remark> {
    let (output, count, name) = (output.display(), measures.len(), &measures.first()?.name);
    let text = || format!("{output}: shows {name}, the first of {count} results; .tif and .csv hold all of them");
    (count > 1).then(|| Remark::note("one-result-of-several", text()).with("count", count as f64))
}
