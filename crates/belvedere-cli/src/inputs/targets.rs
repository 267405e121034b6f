//! Targets of the sun and the sky: from flags and files to places.

use crate::arguments::{
    CloudInput, FacingChoice, GroundChoice, MapPosition, SceneInput, SkyOutputs, SkyPlaces, refuse,
};
use crate::inputs::observers::{ObserverUse, observer_rows, rows_as_given};
use crate::inputs::points::points_of_file;
use crate::inputs::typed_places::on_map;
use crate::outputs::formats::{check_output, check_outputs, extension};
use crate::outputs::targets::TargetSource;
use crate::pipeline::{self, KeepPoints, mesh_in};
use crate::run::CommandContext;
use anyhow::Result;
use belvedere::apps::ask::{GridCells, Places, Reach, Scene, Standing, Turned, position_on_map, standing_on_map};
use belvedere::apps::targets::{CellLevel, Facing, MeshParams, Route};
use belvedere::apps::viewshed::places_along;
use belvedere::ground::GroundPoints;
use belvedere::io::{FEATURE_EXTENSIONS, ReadOptions, RowsAre, TextRows, is_mesh};
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::sync::Arc;

/// Distance of places along lines of a file, metres.
const ALONG_LINES: f64 = 2.0;
/// Bytes of the header of a table that are looked at.
const LONGEST_HEADER: u64 = 1 << 16;

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
        check_outputs("-o", &outputs.output, known)?;
        check_outputs("--by-area", &outputs.by_area.by_area, &["csv", "geojson", "gpkg"])?;
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
            return refuse(format!("{flag} applies only to targets on {what}"));
        }
        if self.facing == Some(FacingChoice::Normals) && !mesh && !points {
            return refuse("--facing normals applies only to points and meshes; cells are horizontal");
        }
        Ok(())
    }

    /// Returns true if places are cells of a grid.
    pub(crate) fn is_grid(&self) -> bool {
        !self.places.own && self.places.targets.is_none() && self.places.at.is_empty()
    }

    /// Returns the choice to keep the points of the scene, which places may need.
    pub(crate) fn needed_points(&self) -> KeepPoints {
        if self.places.targets.as_deref().is_none_or(lacks_heights) { KeepPoints::Keep } else { KeepPoints::LetGo }
    }

    /// The scene before the far terrain of the flags, which keeps `points`.
    pub(crate) fn scene(
        &self,
        input: &SceneInput,
        shell: Option<f32>,
        points: KeepPoints,
        run: &mut CommandContext,
    ) -> Result<Scene> {
        self.check_on_map(&input.input)?;
        let mut scene = pipeline::scene(input, points, run)?;
        self.far.set(&mut scene, run)?;
        scene.into_question_scene(Some(&self.ground), shell, run)
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
                return refuse("--facing normals: the points have none; `belvedere normals` estimates them");
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
            let height = row.height.or(self.height.map(f64::from));
            let along = places_along(&row.corners, self.spacing.unwrap_or(ALONG_LINES))?;
            let distances = Route { places: along.clone() }.distances();
            for (place, distance) in along.into_iter().zip(distances) {
                let [x, y, _] = frame.file_from_local(place).map(|v| format!("{v:.3}"));
                let distance = if row.corners.len() > 1 { format!("{distance:.2}") } else { String::new() };
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
