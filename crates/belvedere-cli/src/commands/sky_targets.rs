//! Places that the sun and the sky are asked about, and what is found there as files.

use super::mesh_targets::{self, SPACING, mesh_of};
use super::query::points_of_file;
use super::sights::{georeference, ground, ground_cloud, on_map};
use super::{check_distinct, check_output, extension};
use crate::arguments::{FacingChoice, SkyOutputs, SkyPlaces, Usage};
use crate::pipeline::{Scene, flagged};
use crate::progress::Stages;
use crate::summary::{Summary, rounded};
use anyhow::Result;
use belvedere::apps::sky_view::SKY_TARGET_HEIGHT;
use belvedere::apps::viewshed::{cell_for, cell_targets};
use belvedere::figures::{MapLegend, MapPicture, Picture, map_picture, ramp_colors, write_png};
use belvedere::ground::{Ground, MapGrid, SurfaceParams, hidden_ground, highest_points, top_surface};
use belvedere::io::{
    Cells, ExtraColumn, ExtraValues, atomic, write_cloud, write_mesh_values, write_table, write_tif_f32,
};
use belvedere::query::{MeshTargetParams, SurfacePieces};
use belvedere::raster::Raster;
use belvedere::{Mesh, PointCloud};
use std::path::Path;

/// No measure: no ground is known.
const NO_VALUE: f32 = -9999.0;
/// Colours of measures on a map.
const COLORS: usize = 101;

/// Places that are asked about.
pub(crate) struct SkyTargets {
    /// Local metres, (M, 3); NaN where there is nothing to ask about.
    pub(crate) positions: Vec<[f32; 3]>,
    /// Outward unit normals, (M, 3), where surfaces are not taken as level.
    pub(crate) normals: Option<Vec<[f32; 3]>>,
    kind: Kind,
}

enum Kind {
    /// Cells of a grid, the ground below them, and the cloud that relief is drawn from.
    Cells { ground: Box<Ground>, cloud: Box<PointCloud> },
    /// Points with their attributes.
    Points(Box<PointCloud>),
    /// Pieces of the faces of a mesh.
    Mesh { mesh: Box<Mesh>, surface: SurfacePieces, frame: Box<PointCloud> },
}

/// One figure for each place.
pub(crate) struct Measure<'a> {
    /// Name of its column, of 15 letters at most, and of its raster.
    pub(crate) name: &'a str,
    /// What it is and its unit, of 31 letters at most.
    pub(crate) description: &'static str,
    /// Digits behind the point in tables.
    pub(crate) decimals: usize,
    /// What a legend spans; `None` for what the values span.
    pub(crate) range: Option<[f64; 2]>,
    /// (M), NaN where there is none.
    pub(crate) values: &'a [f32],
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
        check_distinct(&outputs.output)?;
        let refused = [
            ("--measures", outputs.measures.is_some(), mesh || points, "a grid"),
            ("--cell", self.cell.is_some(), mesh || points, "a grid"),
            ("--target-height", self.height.is_some(), mesh || points, "a grid"),
            ("--spacing", self.spacing.is_some(), !mesh, "a mesh"),
        ];
        if let Some((flag, .., what)) = refused.into_iter().find(|(_, given, wrong, _)| *given && *wrong) {
            return Err(Usage(format!("{flag} belongs to places on {what}")).into());
        }
        if self.facing == Some(FacingChoice::Normals) && !mesh && !points {
            return Err(Usage("--facing normals belongs to points and meshes; cells are level".to_owned()).into());
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

    /// The places that were typed. Takes the points of the scene with it where it needs them.
    pub(crate) fn targets(
        &self,
        scene: &mut Scene,
        seed: u64,
        stages: &mut Stages,
        summary: &mut Summary,
    ) -> Result<SkyTargets> {
        if let Some(path) = &self.places.targets {
            if mesh_targets::is_mesh(path) {
                return self.of_mesh(path, scene, seed, stages, summary);
            }
            let cloud = points_of_file(path, None, &scene.cloud, stages, summary)?;
            let normals = cloud.attributes.normals.clone();
            return self.of_points(cloud, normals);
        }
        if self.places.own {
            if scene.cloud.is_empty() {
                return Err(Usage("--self needs the cloud itself; a ball file holds no points".to_owned()).into());
            }
            let frame = PointCloud::in_frame(scene.cloud.frame.clone());
            let normals = scene.model.take_normals();
            return self.of_points(std::mem::replace(&mut scene.cloud, frame), normals);
        }
        let [low, high] = on_map(scene.model.bounds());
        let cell = self.cell.unwrap_or_else(|| cell_for(low, high));
        let origin = [scene.cloud.frame.origin[0], scene.cloud.frame.origin[1]];
        let grid = flagged("--cell", MapGrid::covering(low, high, cell, origin))?;
        let (cloud, points) = ground_cloud(&self.ground, scene, stages)?;
        let mut ground = ground(&cloud, points, grid, stages, summary)?;
        if self.places.surface {
            ground.heights = stages
                .run("finding the surface", 0, |_| top_surface(&cloud.positions, &ground, &SurfaceParams::default()))?;
        }
        let height = self.height.map_or(SKY_TARGET_HEIGHT, f64::from);
        let mut positions = cell_targets(&ground, height);
        if !self.places.surface {
            let hidden = hidden_ground(&cloud.positions, &ground);
            summary.add("cells_under_cover_left_out", hidden.iter().filter(|&&is| is).count());
            for (position, _) in positions.iter_mut().zip(hidden).filter(|(_, is_hidden)| *is_hidden) {
                *position = [f32::NAN; 3];
            }
        }
        Ok(SkyTargets {
            positions,
            normals: None,
            kind: Kind::Cells { ground: Box::new(ground), cloud: Box::new(cloud) },
        })
    }

    fn of_points(&self, cloud: PointCloud, normals: Option<Vec<[f32; 3]>>) -> Result<SkyTargets> {
        let normals = match self.facing {
            Some(FacingChoice::Normals) => {
                let what = "--facing normals: the points have none; `belvedere normals` estimates them";
                Some(normals.ok_or_else(|| Usage(what.to_owned()))?)
            }
            _ => None,
        };
        Ok(SkyTargets { positions: cloud.positions.clone(), normals, kind: Kind::Points(Box::new(cloud)) })
    }

    fn of_mesh(
        &self,
        path: &Path,
        scene: &Scene,
        seed: u64,
        stages: &mut Stages,
        summary: &mut Summary,
    ) -> Result<SkyTargets> {
        let mesh = mesh_of(path, scene, stages, summary)?;
        let spacing = self.spacing.unwrap_or(SPACING);
        let surface =
            stages.run("sampling mesh", 0, |_| SurfacePieces::of_mesh(&mesh, scene.cloud.frame.origin, spacing, seed));
        let surface = flagged("--spacing", surface)?;
        let lift = MeshTargetParams::default().lift;
        let positions = surface.pieces.iter().map(|piece| piece.lifted_along_normal(lift)).collect();
        let level = self.facing == Some(FacingChoice::Level);
        let normals = (!level).then(|| surface.pieces.iter().map(|piece| piece.normal).collect());
        let frame = Box::new(PointCloud::in_frame(scene.cloud.frame.clone()));
        Ok(SkyTargets { positions, normals, kind: Kind::Mesh { mesh: Box::new(mesh), surface, frame } })
    }
}

impl SkyTargets {
    /// Local frame and reference system of the places.
    pub(crate) fn frame(&self) -> &PointCloud {
        match &self.kind {
            Kind::Cells { cloud, .. } | Kind::Points(cloud) => cloud,
            Kind::Mesh { frame, .. } => frame,
        }
    }

    /// The grid of cells and the ground below them, where places are cells.
    pub(crate) fn ground(&self) -> Option<&Ground> {
        match &self.kind {
            Kind::Cells { ground, .. } => Some(ground),
            _ => None,
        }
    }

    /// Heights of the highest points of the cells, to draw maps on; `None` where places are no cells.
    pub(crate) fn relief(&self) -> Option<Raster<f32>> {
        match &self.kind {
            Kind::Cells { ground, cloud } => Some(highest_points(&cloud.positions, ground)),
            _ => None,
        }
    }

    /// Writes all measures to each of the outputs; maps show the first.
    pub(crate) fn write(
        &self,
        outputs: &SkyOutputs,
        measures: &[Measure<'_>],
        title: &str,
        stages: &mut Stages,
        summary: &mut Summary,
    ) -> Result<()> {
        let map = |relief: &Raster<f32>, cell: f64| map_of(&measures[0], relief, cell, title);
        self.write_with(outputs, measures, &map, stages, summary)
    }

    /// The same with maps of one's own, made of a relief and the side of its cells.
    pub(crate) fn write_with(
        &self,
        outputs: &SkyOutputs,
        measures: &[Measure<'_>],
        map: &dyn Fn(&Raster<f32>, f64) -> belvedere::Result<Picture>,
        stages: &mut Stages,
        summary: &mut Summary,
    ) -> Result<()> {
        let mut written: Vec<String> = Vec::new();
        for output in &outputs.output {
            stages.run("writing", 0, |_| self.write_one(output, measures, map, summary))?;
            written.push(output.display().to_string());
        }
        if let (Some(folder), Kind::Cells { ground, cloud }) = (&outputs.measures, &self.kind) {
            atomic::make_folder(folder)?;
            for measure in measures {
                let path = folder.join(format!("{}.tif", measure.name));
                write_raster(&path, measure, ground, cloud)?;
                written.push(path.display().to_string());
            }
        }
        summary.add("written", written);
        Ok(())
    }

    fn write_one(
        &self,
        output: &Path,
        measures: &[Measure<'_>],
        map: &dyn Fn(&Raster<f32>, f64) -> belvedere::Result<Picture>,
        summary: &mut Summary,
    ) -> Result<()> {
        let first = &measures[0];
        match (&self.kind, extension(output).as_str()) {
            (Kind::Cells { ground, cloud }, "tif" | "tiff") => write_raster(output, first, ground, cloud),
            (Kind::Cells { ground, cloud }, "png") => {
                let relief = highest_points(&cloud.positions, ground);
                Ok(write_png(output, &map(&relief, ground.grid.cell)?)?)
            }
            (Kind::Cells { cloud, .. }, _) => {
                let rows: Vec<usize> =
                    (0..self.positions.len()).filter(|&row| self.positions[row][2].is_finite()).collect();
                let positions = rows.iter().map(|&row| self.positions[row]).collect();
                let cells = PointCloud { positions, ..PointCloud::in_frame(cloud.frame.clone()) };
                let picked: Vec<Vec<f32>> =
                    measures.iter().map(|measure| rows.iter().map(|&row| measure.values[row]).collect()).collect();
                write_points(output, &cells, measures, &picked, summary)
            }
            (Kind::Points(cloud), _) => {
                let all: Vec<Vec<f32>> = measures.iter().map(|measure| measure.values.to_vec()).collect();
                write_points(output, cloud, measures, &all, summary)
            }
            (Kind::Mesh { mesh, surface, frame }, "ply") => {
                let values = surface.face_means(first.values);
                let unit = frame.frame.crs.metres_per_unit_xyz();
                Ok(write_mesh_values(output, mesh, unit, first.name, &values, span(first, &values))?)
            }
            (Kind::Mesh { mesh, surface, .. }, _) => write_faces(output, mesh, surface, measures),
        }
    }

    /// How measures are spread, for people.
    pub(crate) fn told(&self, measures: &[Measure<'_>]) -> Summary {
        let mut section = Summary::default();
        section.add("places", self.positions.iter().filter(|p| p.iter().all(|v| v.is_finite())).count());
        for measure in measures {
            let known: Vec<f64> = measure.values.iter().filter(|v| v.is_finite()).map(|&v| f64::from(v)).collect();
            let digits = i32::try_from(measure.decimals).unwrap_or(3);
            let mut figures = Summary::default();
            let mean = known.iter().sum::<f64>() / known.len() as f64;
            figures
                .add("mean", rounded(mean, digits))
                .add("least", rounded(known.iter().copied().fold(f64::INFINITY, f64::min), digits))
                .add("most", rounded(known.iter().copied().fold(f64::NEG_INFINITY, f64::max), digits));
            if known.is_empty() {
                figures = Summary::default();
            }
            section.add(measure.name, figures);
        }
        section
    }
}

/// What a legend spans, the values given being all.
fn span(measure: &Measure<'_>, values: &[f64]) -> [f64; 2] {
    measure.range.unwrap_or_else(|| {
        let known = || values.iter().copied().filter(|v| v.is_finite());
        let (low, high) = (known().fold(f64::INFINITY, f64::min), known().fold(f64::NEG_INFINITY, f64::max));
        if low < high { [low, high] } else { [low.min(0.0), low.max(0.0) + 1.0] }
    })
}

/// A measure as a map over shaded relief.
pub(crate) fn map_of(
    measure: &Measure<'_>,
    relief: &Raster<f32>,
    cell: f64,
    title: &str,
) -> belvedere::Result<Picture> {
    let values: Vec<f64> = measure.values.iter().map(|&v| f64::from(v)).collect();
    let [low, high] = span(measure, &values);
    let ramp = ramp_colors(&(0..COLORS).map(|i| i as f32).collect::<Vec<f32>>());
    let color = |&value: &f64| {
        let share = ((value - low) / (high - low)).clamp(0.0, 1.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place in the ramp")]
        let place = (share * (COLORS - 1) as f64).round() as usize;
        if value.is_finite() { ramp.get(place).copied() } else { None }
    };
    let colors: Vec<Option<[u8; 3]>> = values.iter().map(color).collect();
    let legend = MapLegend::Ramp(measure.description, [low, high]);
    map_picture(&MapPicture { relief, cell, colors: &colors, marks: &[], title, legend })
}

fn write_points(
    output: &Path,
    cloud: &PointCloud,
    measures: &[Measure<'_>],
    values: &[Vec<f32>],
    summary: &mut Summary,
) -> Result<()> {
    let column = |(measure, values)| {
        let (measure, values): (&Measure<'_>, &Vec<f32>) = (measure, values);
        ExtraColumn { name: measure.name, description: measure.description, values: ExtraValues::F32(values) }
    };
    let columns: Vec<ExtraColumn<'_>> = measures.iter().zip(values).map(column).collect();
    summary.add_writing(&write_cloud(output, cloud, &columns)?);
    Ok(())
}

fn write_raster(output: &Path, measure: &Measure<'_>, ground: &Ground, cloud: &PointCloud) -> Result<()> {
    let grid = ground.grid;
    let raster = Raster::from_values(grid.width, grid.height, measure.values.to_vec())?;
    let place = georeference(&grid, cloud);
    Ok(write_tif_f32(output, &raster, Some(&place), Some(NO_VALUE), Some(measure.description))?)
}

/// A row for each object, without a face, then one for each face.
fn write_faces(output: &Path, mesh: &Mesh, surface: &SurfacePieces, measures: &[Measure<'_>]) -> Result<()> {
    let areas = surface.face_areas();
    let names: Vec<String> = mesh.object_names.iter().map(|name| mesh_targets::quoted(name)).collect();
    let object_of = |face: usize| mesh.objects.get(face).map(|&object| object as usize);
    // as many rows as objects, at least one for all faces together
    let object_count = names.len().max(1);
    let row_of = |face: usize| if names.is_empty() { Some(0) } else { object_of(face) };
    let add_up = |weights: &[f64]| -> Vec<f64> {
        let mut sums = vec![0.0; object_count];
        for (face, weight) in weights.iter().enumerate().filter(|(_, weight)| weight.is_finite()) {
            if let Some(sum) = row_of(face).and_then(|row| sums.get_mut(row)) {
                *sum += weight;
            }
        }
        sums
    };
    let object_areas = add_up(&areas);
    let mut columns: Vec<(&str, Vec<f64>, usize)> = Vec::new();
    columns.push(("area_m2", object_areas.iter().chain(&areas).copied().collect(), 4));
    for measure in measures {
        let means = surface.face_means(measure.values);
        let weighted: Vec<f64> = means.iter().zip(&areas).map(|(mean, area)| mean * area).collect();
        let counted: Vec<f64> =
            weighted.iter().zip(&areas).map(|(w, area)| if w.is_finite() { *area } else { 0.0 }).collect();
        let of_objects = add_up(&weighted).into_iter().zip(add_up(&counted)).map(|(sum, area)| sum / area);
        columns.push((measure.name, of_objects.chain(means.iter().copied()).collect(), measure.decimals));
    }
    let word = |row: Option<usize>| row.and_then(|row| names.get(row)).map_or("", String::as_str);
    let words: Vec<&str> = (0..object_count)
        .map(|row| word(Some(row)))
        .chain((0..areas.len()).map(|face| word(object_of(face))))
        .collect();
    let numbers: Vec<Option<u64>> =
        std::iter::repeat_n(None, object_count).chain((0_u64..).take(areas.len()).map(Some)).collect();
    let mut cells = vec![("object", Cells::Words(&words)), ("face", Cells::Whole(&numbers))];
    cells.extend(columns.iter().map(|(name, values, decimals)| (*name, Cells::Real(values, *decimals))));
    Ok(write_table(output, &cells)?)
}
