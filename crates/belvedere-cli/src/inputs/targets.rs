//! Targets of the sun and the sky: from flags and files to places, and from measures to files.

use crate::arguments::{
    AreaOutputs, CloudInput, FacingChoice, GroundChoice, MapPosition, SkyOutputs, SkyPlaces, Usage,
};
use crate::commands::query::{points_of_file, text_rows_for};
use crate::inputs::observers::{ObserverUse, observer_rows, rows_as_given};
use crate::inputs::typed_places::on_map;
use crate::outputs::formats::warn_of_geojson;
use crate::outputs::formats::{check_output, extension};
use crate::pipeline::mesh_in;
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::ask::{
    GridCells, OnTargets, Places, Reach, Remark, Scene, Standing, Turned, position_on_map, remark_on_empty_areas,
    standing_on_map,
};
use belvedere::apps::targets::{AreaMeans, CellLevel, Facing, Measure, MeshParams, Route};
use belvedere::apps::viewshed::places_along;
use belvedere::figures::{Picture, write_png};
use belvedere::ground::GroundPoints;
use belvedere::io::{
    FEATURE_EXTENSIONS, Georeference, MetadataTag, PolygonArea, ReadOptions, RowsAre, TextRows, atomic, is_mesh,
    read_features, write_tif_u8,
};
use belvedere::raster::Raster;
use belvedere::results::{
    ResultKind, TakenFrom, areas_of, georeference, measure_map, relief_of_cells, write_area_means, write_measures,
    write_raster,
};
use belvedere::{Mesh, PointCloud};
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Distance of places along lines of a file, metres.
const ALONG_LINES: f64 = 2.0;
/// Bytes of the header of a table that are looked at.
const LONGEST_HEADER: u64 = 1 << 16;

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
    scene: &'a Scene,
}

/// Heights of the highest points of cells, and where these lie.
pub(crate) struct HighestPoints {
    pub(crate) heights: Raster<f32>,
    /// Side of a cell, metres.
    pub(crate) cell: f64,
    pub(crate) place: Georeference,
}

impl GroundChoice {
    /// Returns the source of ground points.
    pub(crate) fn points(&self) -> GroundPoints {
        match self {
            Self::OfScene(points) => *points,
            Self::Cloud(_) => GroundPoints::Auto,
        }
    }
}

impl SkyPlaces {
    /// Refuses flags that do not belong together and outputs that cannot be written, before hours of work go into them.
    pub(crate) fn check(&self, outputs: &SkyOutputs) -> Result<()> {
        let mesh = self.places.targets.as_deref().is_some_and(is_mesh);
        let points = self.places.own || self.places.targets.is_some() && !mesh || !self.places.at.is_empty();
        let in_file = self.places.targets.as_deref().is_some_and(lacks_heights);
        let on_ground = !self.places.at.is_empty() || in_file;
        MapPosition::refuse_twice("--at", &self.places.at)?;
        let known: &[&str] = match (mesh, points) {
            (true, _) => &["csv", "ply"],
            (_, true) => &["laz", "las", "ply", "csv"],
            _ => &["tif", "tiff", "png", "laz", "las", "ply", "csv"],
        };
        for output in &outputs.output {
            check_output("-o", output, known)?;
        }
        if let Some(output) = &outputs.by_area.by_area {
            check_output("--by-area", output, &["csv", "geojson", "gpkg"])?;
        }
        if let Some(mask) = &self.edge_mask {
            check_output("--edge-mask", mask, &["tif", "tiff"])?;
        }
        let refused = [
            ("--measures", outputs.measures.is_some(), mesh || points, "a grid"),
            ("--edge-mask", self.edge_mask.is_some(), mesh || points, "a grid"),
            ("--by-area", outputs.by_area.by_area.is_some(), mesh || points, "a grid"),
            ("--cell", self.cell.is_some(), mesh || points, "a grid"),
            (
                "--target-height",
                self.height.is_some(),
                mesh || points && !on_ground,
                "a grid, and places without heights",
            ),
            ("--spacing", self.spacing.is_some(), !mesh && !in_file, "a mesh, and lines of a file"),
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

    /// Returns true if places are cells of a grid.
    pub(crate) fn is_grid(&self) -> bool {
        !self.places.own && self.places.targets.is_none() && self.places.at.is_empty()
    }

    /// Returns true if the points of the scene are needed.
    pub(crate) fn needs_points(&self) -> bool {
        self.places.targets.as_deref().is_none_or(lacks_heights)
    }

    /// The cells that were typed.
    pub(crate) fn cells(&self) -> GridCells {
        GridCells {
            cell: self.cell,
            level: if self.places.surface { CellLevel::Surface } else { CellLevel::Ground },
            height: self.height.map(f64::from),
            ground: self.ground.points(),
            ..GridCells::default()
        }
    }

    /// Refuses single places beside the points, before anything is built, as far as headers tell.
    pub(crate) fn check_on_map(&self, input: &CloudInput) -> Result<()> {
        if self.places.at.is_empty() {
            return Ok(());
        }
        let Some((crs, bounds)) = on_map(input)? else { return Ok(()) };
        self.places.at.iter().try_for_each(|place| position_on_map(place.0, &crs, bounds).map(|_| ()))?;
        Ok(())
    }

    /// The places that were typed, and what they are taken from.
    pub(crate) fn places(&self, scene: &Scene, run: &mut CommandContext) -> Result<(Places, TargetSource)> {
        self.places_within(Reach::Cloud, scene, run)
    }

    /// [`SkyPlaces::places`] of lines of sight of this extent.
    pub(crate) fn places_within(
        &self,
        reach: Reach,
        scene: &Scene,
        run: &mut CommandContext,
    ) -> Result<(Places, TargetSource)> {
        if !self.places.at.is_empty() {
            let typed = self.places.at.iter().map(|place| (place.0, place.1));
            let places = standing_on_map(typed, self.height.map(f64::from), reach, scene)?;
            return Ok((Places::At(places, self.ground.points()), TargetSource::Single));
        }
        let Some(path) = &self.places.targets else {
            if self.places.own {
                let is_turned = self.facing == Some(FacingChoice::Normals);
                return Ok((Places::Own(if is_turned { Turned::Normals } else { Turned::Level }), TargetSource::Own));
            }
            return Ok((Places::Cells(self.cells()), TargetSource::Cells));
        };
        if is_mesh(path) {
            let mesh = Arc::new(mesh_in(path, &scene.frame().crs, run)?);
            let facing = if self.facing == Some(FacingChoice::Level) { Facing::Level } else { Facing::Normals };
            let usual = MeshParams::default().with_seed(run.seed).with_facing(facing);
            let params = self.spacing.map_or(usual, |spacing| usual.with_spacing(spacing));
            return Ok((Places::Mesh(Arc::clone(&mesh), params), TargetSource::Mesh(mesh)));
        }
        if lacks_heights(path) {
            let (places, rows) = self.places_of_file(path, scene, run)?;
            return Ok((Places::At(places, self.ground.points()), TargetSource::Places(rows)));
        }
        let cloud = Arc::new(points_of_file(path, &ReadOptions::new(), scene.frame(), run)?);
        let normals = match (self.facing, &cloud.attributes.normals) {
            (Some(FacingChoice::Normals), None) => {
                let what = "--facing normals: the points have none; `belvedere normals` estimates them";
                return Err(Usage(what.to_owned()).into());
            }
            (Some(FacingChoice::Normals), Some(normals)) => Some(normals.clone()),
            _ => None,
        };
        Ok((Places::Cloud(Arc::clone(&cloud), normals), TargetSource::File(cloud, path.clone())))
    }

    /// The places of a file without heights, `--target-height` or their own height above the ground, and their rows in
    /// tables. Lines have a place each `--spacing`.
    fn places_of_file(
        &self,
        path: &Path,
        scene: &Scene,
        run: &mut CommandContext,
    ) -> Result<(Vec<Standing>, TextRows)> {
        let frame = scene.frame();
        let rows = observer_rows(path, frame, RowsAre::Places, ObserverUse::Places, run)?;
        let as_given = rows_as_given(Some(path))?;
        let names = ["name", "distance_m", "x", "y"].map(str::to_owned).into();
        let (mut places, mut listed) = (Vec::new(), TextRows::new(names));
        for row in &rows {
            let local = |corner: &[f64; 3]| [0, 1, 2].map(|axis| corner[axis] - frame.origin[axis]);
            let corners: Vec<[f64; 3]> = row.corners.iter().map(local).collect();
            let height = row.height.or(self.height.map(f64::from));
            let along = places_along(&corners, self.spacing.unwrap_or(ALONG_LINES))?;
            let distances = Route { places: along.clone() }.distances();
            for (place, distance) in along.into_iter().zip(distances) {
                let [x, y, _] = frame.file_from_local(place).map(|v| format!("{v:.3}"));
                let distance = if corners.len() > 1 { format!("{distance:.2}") } else { String::new() };
                listed.push([&row.name, &distance, &x, &y]);
                places.push(Standing { place, height });
            }
        }
        Ok((places, if as_given.row_count() > 0 { as_given } else { listed }))
    }
}

/// Returns true for places of a map, and for a table whose header has x and y, but no z: they stand on the ground.
fn lacks_heights(path: &Path) -> bool {
    if is_mesh(path) {
        return false;
    }
    match extension(path).as_str() {
        "csv" | "txt" => {}
        other => return FEATURE_EXTENSIONS.contains(&other),
    }
    let mut header = String::new();
    let read = File::open(path).and_then(|file| BufReader::new(file.take(LONGEST_HEADER)).read_line(&mut header));
    let names: Vec<String> =
        header.split([',', ';', '\t', ' ']).map(|name| name.trim().trim_matches('"').to_ascii_lowercase()).collect();
    let has = |wanted: &str| names.iter().any(|name| name == wanted);
    read.is_ok() && has("x") && has("y") && !has("z")
}

impl<'a> TargetOutput<'a> {
    pub(crate) fn new(on: &'a OnTargets, source: TargetSource, scene: &'a Scene) -> Self {
        Self { on, source, scene }
    }

    /// Returns the relief below maps; `None` if targets are no cells.
    pub(crate) fn relief(&self) -> Option<HighestPoints> {
        let ground = self.on.targets.ground()?;
        Some(HighestPoints {
            heights: relief_of_cells(&self.on.targets, self.scene)?,
            cell: ground.grid.cell,
            place: georeference(&ground.grid, &self.on.targets.frame),
        })
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
        let mut written: Vec<String> = Vec::new();
        for output in &outputs.output {
            let mut section = Summary::default();
            run.stage("writing", 0, |_| self.write_one(output, (measures, &run.tags), map, &mut section))?;
            run.summary.add_all(section);
            written.push(output.display().to_string());
        }
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
            return Err(Usage(format!("--areas: {} has no polygons", areas.display())).into());
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
        map: &dyn Fn(&HighestPoints) -> belvedere::Result<Picture>,
        summary: &mut Summary,
    ) -> Result<()> {
        if let (Some(relief), "png") = (self.relief(), extension(output).as_str()) {
            return Ok(write_png(output, &map(&relief)?)?);
        }
        let rows = match &self.source {
            TargetSource::File(_, file) => text_rows_for(file, output)?,
            _ => None,
        };
        let from = match &self.source {
            TargetSource::Cells | TargetSource::Single => TakenFrom::Nothing,
            TargetSource::Own => TakenFrom::Cloud(self.scene.cloud()),
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
