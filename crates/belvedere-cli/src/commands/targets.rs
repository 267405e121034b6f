//! Targets of the sun and the sky: from flags and files to targets, and from measures to files.

use super::mesh_targets::{self, mesh_of};
use super::query::{points_of_file, text_rows_for};
use super::sights::{ground, ground_cloud};
use super::{check_output, extension};
use crate::arguments::{FacingChoice, SkyOutputs, SkyPlaces, Usage};
use crate::pipeline::{Scene, flagged};
use crate::progress::Stages;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::targets::{CellLevel, CellParams, Facing, Measure, MeshParams, Targets};
use belvedere::apps::viewshed::cell_for;
use belvedere::figures::{Picture, write_png};
use belvedere::ground::{MapGrid, highest_points};
use belvedere::io::atomic;
use belvedere::raster::Raster;
use belvedere::results::{TakenFrom, measure_map, write_measures, write_raster};
use belvedere::{Mesh, PointCloud};
use std::path::{Path, PathBuf};

/// Targets and what they were taken from.
pub(crate) struct Asked {
    pub(crate) targets: Targets,
    from: Source,
}

enum Source {
    /// The cloud that the ground below cells, and the relief of maps, come from.
    Cells(Box<PointCloud>),
    /// Points with their attributes, and the file they were read from unless they are those of the scene.
    Points(Box<PointCloud>, Option<PathBuf>),
    Mesh(Box<Mesh>),
}

impl SkyPlaces {
    /// Refuses flags that do not belong together and outputs that cannot be written, before hours of work go into them.
    pub(crate) fn check(&self, outputs: &SkyOutputs) -> Result<()> {
        let mesh = self.places.targets.as_deref().is_some_and(mesh_targets::is_mesh);
        let points = self.places.own || self.places.targets.is_some() && !mesh;
        let known: &[&str] = match (mesh, points) {
            (true, _) => &["csv", "ply"],
            (_, true) => &["laz", "las", "ply", "csv"],
            _ => &["tif", "tiff", "png", "laz", "las", "ply", "csv"],
        };
        for output in &outputs.output {
            check_output("-o", output, known)?;
        }
        let refused = [
            ("--measures", outputs.measures.is_some(), mesh || points, "a grid"),
            ("--cell", self.cell.is_some(), mesh || points, "a grid"),
            ("--target-height", self.height.is_some(), mesh || points, "a grid"),
            ("--spacing", self.spacing.is_some(), !mesh, "a mesh"),
        ];
        if let Some((flag, .., what)) = refused.into_iter().find(|(_, given, wrong, _)| *given && *wrong) {
            return Err(Usage(format!("{flag} applies only to targets on {what}")).into());
        }
        if self.facing == Some(FacingChoice::Normals) && !mesh && !points {
            return Err(
                Usage("--facing normals applies only to points and meshes; cells are horizontal".to_owned()).into()
            );
        }
        Ok(())
    }

    /// Whether places are cells of a grid.
    pub(crate) fn is_grid(&self) -> bool {
        !self.places.own && self.places.targets.is_none()
    }

    /// Whether the points of the scene are needed.
    pub(crate) fn needs_points(&self) -> bool {
        self.places.targets.is_none()
    }

    /// The targets that were typed. Takes the points of the scene with it where it needs them.
    pub(crate) fn targets(
        &self,
        scene: &mut Scene,
        seed: u64,
        stages: &mut Stages,
        summary: &mut Summary,
    ) -> Result<Asked> {
        if let Some(path) = &self.places.targets {
            if mesh_targets::is_mesh(path) {
                return self.of_mesh(path, scene, seed, stages, summary);
            }
            let cloud = points_of_file(path, None, &scene.cloud.frame, stages, summary)?;
            let normals = cloud.attributes.normals.clone();
            return self.of_points(cloud, normals, Some(path));
        }
        if self.places.own {
            if scene.cloud.is_empty() {
                return Err(Usage("--self needs a cloud; a ball file has no points".to_owned()).into());
            }
            let frame = scene.cloud.frame.clone();
            let normals = scene.model.take_normals();
            return self.of_points(
                std::mem::replace(&mut scene.cloud, PointCloud { frame, ..PointCloud::default() }),
                normals,
                None,
            );
        }
        let (low, high) = scene.model.bounds().on_map();
        let cell = self.cell.unwrap_or_else(|| cell_for(low, high));
        let [x, y, _] = scene.cloud.frame.origin;
        let grid = flagged("--cell", MapGrid::covering(low, high, cell, [x, y]))?;
        let (cloud, points) = ground_cloud(&self.ground, scene, stages)?;
        let ground = ground(&cloud, points, grid, stages, summary)?;
        let mut params = CellParams::default();
        if self.places.surface {
            params = params.with_level(CellLevel::Surface);
        }
        if let Some(height) = self.height {
            params = params.with_height(f64::from(height));
        }
        let name = if self.places.surface { "finding the surface" } else { "finding hidden ground" };
        let (targets, report) = stages.run(name, 0, |control| Targets::of_cells(&cloud, ground, &params, control))?;
        if !self.places.surface {
            summary.add_report(&report);
        }
        Ok(Asked { targets, from: Source::Cells(Box::new(cloud)) })
    }

    fn of_points(&self, cloud: PointCloud, normals: Option<Vec<[f32; 3]>>, file: Option<&Path>) -> Result<Asked> {
        let normals = match self.facing {
            Some(FacingChoice::Normals) => {
                let what = "--facing normals: the points have none; `belvedere normals` estimates them";
                Some(normals.ok_or_else(|| Usage(what.to_owned()))?)
            }
            _ => None,
        };
        Ok(Asked {
            targets: Targets::of_points(&cloud, normals),
            from: Source::Points(Box::new(cloud), file.map(Path::to_owned)),
        })
    }

    fn of_mesh(
        &self,
        path: &Path,
        scene: &Scene,
        seed: u64,
        stages: &mut Stages,
        summary: &mut Summary,
    ) -> Result<Asked> {
        let mesh = mesh_of(path, scene, stages, summary)?;
        let facing = if self.facing == Some(FacingChoice::Level) { Facing::Level } else { Facing::Normals };
        let mut params = MeshParams::default().with_seed(seed).with_facing(facing);
        if let Some(spacing) = self.spacing {
            params = params.with_spacing(spacing);
        }
        let targets = stages.run("sampling mesh", 0, |_| Targets::of_mesh(&mesh, &scene.cloud.frame, &params));
        Ok(Asked { targets: flagged("--spacing", targets)?, from: Source::Mesh(Box::new(mesh)) })
    }
}

impl Asked {
    /// Heights of the highest points of the cells, to draw maps on; `None` where targets are no cells.
    pub(crate) fn relief(&self) -> Option<Raster<f32>> {
        match (&self.from, self.targets.ground()) {
            (Source::Cells(cloud), Some(ground)) => Some(highest_points(&cloud.positions, ground)),
            _ => None,
        }
    }

    /// Writes all measures to each of the outputs; maps show the first.
    pub(crate) fn write(
        &self,
        outputs: &SkyOutputs,
        measures: &[Measure],
        title: &str,
        stages: &mut Stages,
        summary: &mut Summary,
    ) -> Result<()> {
        let map = |relief: &Raster<f32>, cell: f64| measure_map(&measures[0], relief, cell, title);
        self.write_with(outputs, measures, &map, stages, summary)
    }

    /// The same with maps of one's own, made of a relief and the side of its cells.
    pub(crate) fn write_with(
        &self,
        outputs: &SkyOutputs,
        measures: &[Measure],
        map: &dyn Fn(&Raster<f32>, f64) -> belvedere::Result<Picture>,
        stages: &mut Stages,
        summary: &mut Summary,
    ) -> Result<()> {
        let mut written: Vec<String> = Vec::new();
        for output in &outputs.output {
            stages.run("writing", 0, |_| self.write_one(output, measures, map, summary))?;
            written.push(output.display().to_string());
        }
        if let (Some(folder), Source::Cells(_)) = (&outputs.measures, &self.from) {
            atomic::make_folder(folder)?;
            for measure in measures {
                let path = folder.join(format!("{}.tif", measure.name));
                write_raster(&path, &self.targets, measure)?;
                written.push(path.display().to_string());
            }
        }
        summary.add("written", written);
        Ok(())
    }

    fn write_one(
        &self,
        output: &Path,
        measures: &[Measure],
        map: &dyn Fn(&Raster<f32>, f64) -> belvedere::Result<Picture>,
        summary: &mut Summary,
    ) -> Result<()> {
        if let (Some(ground), "png") = (self.targets.ground(), extension(output).as_str()) {
            let relief = self.relief().unwrap_or_else(|| ground.heights.clone());
            return Ok(write_png(output, &map(&relief, ground.grid.cell)?)?);
        }
        let rows = match &self.from {
            Source::Points(_, Some(file)) => text_rows_for(file, output, summary)?,
            _ => None,
        };
        let from = match &self.from {
            Source::Cells(_) => TakenFrom::Nothing,
            Source::Points(cloud, _) => rows.as_ref().map_or(TakenFrom::Cloud(cloud), TakenFrom::Rows),
            Source::Mesh(mesh) => TakenFrom::Mesh(mesh),
        };
        summary.add_writing(&write_measures(output, &self.targets, from, measures)?);
        Ok(())
    }

    /// How measures are spread, for people.
    pub(crate) fn statistics(&self, measures: &[Measure]) -> Summary {
        let mut section = Summary::default();
        section.add("targets", self.targets.asked_count());
        for measure in measures {
            section.add(&measure.name, Summary::of(&measure.rounded_statistics()));
        }
        section
    }
}
