//! Targets of the sun and the sky: from flags and files to targets, and from measures to files.

use super::mesh_targets::{self, mesh_of};
use super::query::{points_of_file, text_rows_for};
use super::sights::{OUTSIDE_CLOUD, ground, ground_cloud};
use super::{check_output, extension};
use crate::arguments::{FacingChoice, SkyOutputs, SkyPlaces, Usage};
use crate::pipeline::{Scene, flagged};
use crate::run::Run;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::edge::{EdgeReport, near_edge};
use belvedere::apps::targets::{CellLevel, CellParams, Facing, Measure, MeshParams, Targets};
use belvedere::apps::viewshed::cell_for;
use belvedere::figures::{Picture, write_png};
use belvedere::ground::{MapGrid, highest_points};
use belvedere::io::{Georeference, atomic, write_tif_u8};
use belvedere::query::AddedMeshes;
use belvedere::raster::Raster;
use belvedere::results::{ResultKind, TakenFrom, georeference, measure_map, write_measures, write_raster};
use belvedere::{Mesh, PointCloud};
use std::path::{Path, PathBuf};

/// Share of targets near the edge that is warned of, percent.
const EDGE_WARNING_PERCENT: f64 = 1.0;
const NEAR_EDGE: &str = "are near the edge of the cloud: objects beyond it, as high as its highest point, could take some of their sun or sky";

/// Targets and what they were taken from.
pub(crate) struct Asked {
    pub(crate) targets: Targets,
    from: Source,
}

/// Heights of the highest points of cells, and where these lie.
pub(crate) struct Relief {
    pub(crate) heights: Raster<f32>,
    /// Side of a cell, metres.
    pub(crate) cell: f64,
    pub(crate) place: Georeference,
}

enum Source {
    /// The cloud that the ground below cells, and the relief of maps, come from.
    /// The meshes that were added are part of the relief.
    Cells(Box<PointCloud>, Option<AddedMeshes>),
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
        if let Some(mask) = &self.edge_mask {
            check_output("--edge-mask", mask, &["tif", "tiff"])?;
        }
        let refused = [
            ("--measures", outputs.measures.is_some(), mesh || points, "a grid"),
            ("--edge-mask", self.edge_mask.is_some(), mesh || points, "a grid"),
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
    pub(crate) fn targets(&self, scene: &mut Scene, run: &mut Run) -> Result<Asked> {
        let mut asked = self.typed(scene, run)?;
        // cells are those of the cloud
        if !self.is_grid() {
            leave_out_outside(&mut asked.targets, scene, &mut run.summary);
        }
        Ok(asked)
    }

    fn typed(&self, scene: &mut Scene, run: &mut Run) -> Result<Asked> {
        if let Some(path) = &self.places.targets {
            if mesh_targets::is_mesh(path) {
                return self.of_mesh(path, scene, run);
            }
            let cloud = points_of_file(path, None, &scene.cloud.frame, run)?;
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
        let (cloud, points) = ground_cloud(&self.ground, scene, run)?;
        let ground = ground(&cloud, points, grid, run)?;
        let mut params = CellParams::default();
        if self.places.surface {
            params = params.with_level(CellLevel::Surface);
        }
        if let Some(height) = self.height {
            params = params.with_height(f64::from(height));
        }
        let name = if self.places.surface { "finding the surface" } else { "finding hidden ground" };
        let (mut targets, mut report) =
            run.stage(name, 0, |control| Targets::of_cells(&cloud, ground, &params, control))?;
        if let Some(added) = scene.model.added() {
            report.cells_below_objects_excluded += targets.set_on_added(added, &params);
        }
        if !self.places.surface {
            run.summary.add_report(&report);
        }
        Ok(Asked { targets, from: Source::Cells(Box::new(cloud), scene.model.added().cloned()) })
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

    fn of_mesh(&self, path: &Path, scene: &Scene, run: &mut Run) -> Result<Asked> {
        let mesh = mesh_of(path, scene, run)?;
        let facing = if self.facing == Some(FacingChoice::Level) { Facing::Level } else { Facing::Normals };
        let mut params = MeshParams::default().with_seed(run.seed).with_facing(facing);
        if let Some(spacing) = self.spacing {
            params = params.with_spacing(spacing);
        }
        let targets = run.stage("sampling mesh", 0, |_| Targets::of_mesh(&mesh, &scene.cloud.frame, &params));
        Ok(Asked { targets: flagged("--spacing", targets)?, from: Source::Mesh(Box::new(mesh)) })
    }
}

/// Reports how many targets are so near the edge of the cloud that objects beyond it could change their result, warns of many, and gives a flag for each.
pub(super) fn report_edge(
    targets: &Targets,
    scene: &Scene,
    directions: &[[f64; 3]],
    run: &mut Run,
) -> Result<Vec<Option<bool>>> {
    let Some(coverage) = scene.model.coverage() else { return Ok(vec![None; targets.len()]) };
    let flags = run.stage("testing the edge of the cloud", targets.len(), |control| {
        near_edge(&coverage, &targets.positions, directions, control)
    })?;
    let report = EdgeReport::of(&flags);
    run.summary.add_report(&report);
    if report.targets_near_edge_percent >= EDGE_WARNING_PERCENT {
        run.summary.warn_of_share(report.targets_near_edge, targets.asked_count(), "targets", NEAR_EDGE);
    }
    Ok(flags)
}

/// Leaves out targets beside or below the cloud, and warns of them.
pub(super) fn leave_out_outside(targets: &mut Targets, scene: &Scene, summary: &mut Summary) {
    let count = targets.asked_count();
    let outside = scene.model.coverage().map_or(0, |coverage| targets.leave_out_outside(&coverage));
    summary.add("targets_outside_cloud", outside).warn_of_share(outside, count, "targets", OUTSIDE_CLOUD);
}

impl Asked {
    /// What maps are drawn on; `None` where targets are no cells.
    pub(crate) fn relief(&self) -> Option<Relief> {
        let (Source::Cells(cloud, added), Some(ground)) = (&self.from, self.targets.ground()) else { return None };
        let mut heights = highest_points(&cloud.positions, ground);
        if let Some(added) = added {
            added.raise(&mut heights, &ground.grid);
        }
        Some(Relief { heights, cell: ground.grid.cell, place: georeference(&ground.grid, &self.targets.frame) })
    }

    /// [`report_edge`] of these targets, with a mask of their cells where it is wanted.
    pub(crate) fn report_edge(
        &self,
        places: &SkyPlaces,
        scene: &Scene,
        directions: &[[f64; 3]],
        run: &mut Run,
    ) -> Result<()> {
        let flags = report_edge(&self.targets, scene, directions, run)?;
        if let (Some(path), Some(ground)) = (&places.edge_mask, self.targets.ground()) {
            let values = flags.iter().map(|&flag| ResultKind::answer(flag)).collect();
            let raster = Raster::from_values(ground.grid.width, ground.grid.height, values)?;
            let place = georeference(&ground.grid, &self.targets.frame);
            let what = "1 near the edge of the cloud, 0 not, 255 nodata";
            let nothing = Some(ResultKind::NO_ANSWER);
            run.stage("writing", 0, |_| write_tif_u8(path, &raster, Some(&place), nothing, Some(what)))?;
            run.summary.add("edge_mask_written", path.display().to_string());
        }
        Ok(())
    }

    /// Writes all measures to each of the outputs; maps show the first.
    pub(crate) fn write(&self, outputs: &SkyOutputs, measures: &[Measure], title: &str, run: &mut Run) -> Result<()> {
        let map = |relief: &Relief| measure_map(&measures[0], &relief.heights, relief.cell, &relief.place, title);
        self.write_with(outputs, measures, &map, run)
    }

    /// The same with maps of one's own.
    pub(crate) fn write_with(
        &self,
        outputs: &SkyOutputs,
        measures: &[Measure],
        map: &dyn Fn(&Relief) -> belvedere::Result<Picture>,
        run: &mut Run,
    ) -> Result<()> {
        let mut written: Vec<String> = Vec::new();
        for output in &outputs.output {
            let mut section = Summary::default();
            run.stage("writing", 0, |_| self.write_one(output, measures, map, &mut section))?;
            run.summary.add_all(section);
            written.push(output.display().to_string());
        }
        if let (Some(folder), Source::Cells(..)) = (&outputs.measures, &self.from) {
            atomic::make_folder(folder)?;
            for measure in measures {
                let path = folder.join(format!("{}.tif", measure.name));
                write_raster(&path, &self.targets, &[measure])?;
                written.push(path.display().to_string());
            }
        }
        run.summary.add("written", written);
        Ok(())
    }

    fn write_one(
        &self,
        output: &Path,
        measures: &[Measure],
        map: &dyn Fn(&Relief) -> belvedere::Result<Picture>,
        summary: &mut Summary,
    ) -> Result<()> {
        if let (Some(relief), "png") = (self.relief(), extension(output).as_str()) {
            return Ok(write_png(output, &map(&relief)?)?);
        }
        let rows = match &self.from {
            Source::Points(_, Some(file)) => text_rows_for(file, output, summary)?,
            _ => None,
        };
        let from = match &self.from {
            Source::Cells(..) => TakenFrom::Nothing,
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
