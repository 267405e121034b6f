//! Chosen cameras as files.

use crate::outputs::formats::extension;
use anyhow::Result;
use belvedere::apps::ask::{CamerasResults, ChosenCamera, Scene};
use belvedere::apps::result_columns::ResultColumn;
use belvedere::figures::{MapLegend, MapMark, MapPicture, map_picture, write_png};
use belvedere::ground::{Ground, highest_points};
use belvedere::io::{PolygonArea, Spot, outlines, write_areas, write_places, write_table, write_tif_u16};
use belvedere::raster::Raster;
use belvedere::report::rounded;
use belvedere::results::{ResultKind, georeference};
use serde_json::{Map, Value};
use std::path::Path;

/// Colours of cells with no camera, one, two, three, and more.
const COLORS: [[u8; 3]; 5] = [[120, 40, 50], [253, 225, 60], [110, 200, 95], [35, 145, 140], [60, 80, 165]];

/// Results to write.
pub(super) struct CameraOutput<'a> {
    pub(super) found: &'a CamerasResults,
    pub(super) scene: &'a Scene,
}

impl CameraOutput<'_> {
    pub(super) fn write(&self, output: &Path) -> Result<()> {
        match (extension(output).as_str(), self.found.targets.ground()) {
            ("csv", _) => self.write_targets(output),
            ("png", Some(ground)) => self.write_map(output, ground),
            ("tif" | "tiff", Some(ground)) => self.write_counts(output, ground),
            _ => self.write_cameras(output),
        }
    }

    /// Coverage after each camera.
    pub(super) fn write_curve(&self, output: &Path) -> Result<()> {
        let new: Vec<&ChosenCamera> = self.found.cameras.iter().filter(|camera| camera.is_new).collect();
        let added = std::iter::once(f64::NAN).chain(new.iter().map(|camera| camera.added_percent));
        let columns = [
            ResultColumn::whole("new_cameras", 0..=new.len()),
            ResultColumn::real("added_percent", added, 4),
            ResultColumn::real("coverage_percent", self.found.placed.curve.iter().map(|share| 100.0 * share), 4),
        ];
        Ok(write_table(output, &columns)?)
    }

    /// A point for each camera, with the properties that `--existing` reads.
    fn write_cameras(&self, output: &Path) -> Result<()> {
        let frame = &self.found.targets.frame;
        let mut spots = Vec::new();
        for (number, camera) in (1_u64..).zip(&self.found.cameras) {
            let pose = camera.pose;
            if !pose.camera.eye.iter().all(|v| v.is_finite()) {
                continue;
            }
            let degrees = |angle: f64| Value::from(rounded(angle.to_degrees(), 3));
            let mut properties = Map::new();
            properties.insert("camera".to_owned(), number.into());
            properties.insert("existing".to_owned(), (!camera.is_new).into());
            if pose.heading.is_finite() {
                let heading = (pose.heading + self.found.grid_north).to_degrees().rem_euclid(360.0);
                properties.insert("heading".to_owned(), rounded(heading, 3).into());
            }
            if pose.tilt.is_finite() {
                properties.insert("tilt".to_owned(), degrees(pose.tilt));
            }
            properties.insert("fov".to_owned(), degrees(pose.width));
            if camera.is_new {
                properties.insert("added_percent".to_owned(), rounded(camera.added_percent, 4).into());
            }
            properties.insert("covered_targets".to_owned(), camera.covered.len().into());
            if self.found.targets.ground().is_none() {
                let numbers: Vec<Value> = camera.covered.iter().map(|target| (target + 1).into()).collect();
                properties.insert("targets".to_owned(), numbers.into());
            }
            let place: [f64; 3] = std::array::from_fn(|i| pose.camera.eye[i] + frame.origin[i]);
            spots.push(Spot { place, properties });
        }
        write_places(output, &spots, &[], &frame.crs)?;
        Ok(())
    }

    /// The cells that each camera covers.
    pub(super) fn write_footprints(&self, output: &Path) -> Result<()> {
        let mut areas = Vec::new();
        for (number, camera) in (1..).zip(&self.found.cameras) {
            areas.extend(self.footprint(camera, number)?);
        }
        write_areas(output, &areas, &self.found.targets.frame.crs)?;
        Ok(())
    }

    /// The cells that a camera covers, as an area.
    fn footprint(&self, camera: &ChosenCamera, number: u64) -> Result<Option<PolygonArea>> {
        let Some(ground) = self.found.targets.ground() else { return Ok(None) };
        let grid = ground.grid;
        let mut cells = vec![false; self.found.targets.len()];
        camera.covered.iter().for_each(|&target| cells[target] = true);
        let polygons = outlines(&Raster::from_values(grid.width, grid.height, cells)?);
        if polygons.is_empty() {
            return Ok(None);
        }
        let origin = self.found.targets.frame.origin;
        let place = |corner: [usize; 2]| {
            let [x, y] = grid.corner_at(corner);
            [x + origin[0], y + origin[1]]
        };
        let mut area = PolygonArea::default();
        area.properties.insert("camera".to_owned(), number.into());
        area.properties.insert("covered_m2".to_owned(), (camera.covered.len() as f64 * grid.cell * grid.cell).into());
        area.polygons = polygons.iter().map(|polygon| polygon.rings(place)).collect();
        Ok(Some(area))
    }

    /// The number of cameras of each cell; `None` for a cell that does not count.
    fn counts(&self) -> impl Iterator<Item = Option<u32>> + '_ {
        (0..self.found.targets.len()).map(|row| self.found.count(row))
    }

    fn write_counts(&self, output: &Path, ground: &Ground) -> Result<()> {
        let values = self.counts().map(ResultKind::count).collect();
        let raster = Raster::from_values(ground.grid.width, ground.grid.height, values)?;
        let place = georeference(&ground.grid, &self.found.targets.frame);
        let what = "number of cameras that cover the cell, 65535 nodata";
        Ok(write_tif_u16(output, &raster, Some(&place), Some(ResultKind::NO_COUNT), Some(what))?)
    }

    fn write_map(&self, output: &Path, ground: &Ground) -> Result<()> {
        let relief = highest_points(&self.scene.ground_cloud()?.positions, ground);
        let mark = |(number, camera): (usize, &ChosenCamera)| {
            let pose = camera.pose;
            let place = ground.grid.cell_position([pose.camera.eye[0], pose.camera.eye[1]])?;
            Some(MapMark { place, view: Some([pose.heading, pose.width]), label: number.to_string() })
        };
        let marks: Vec<MapMark> = (1..).zip(&self.found.cameras).filter_map(mark).collect();
        let max = self.counts().flatten().max().map_or(1, |max| (max as usize).clamp(1, COLORS.len() - 1));
        let color = |count: u32| COLORS.get((count as usize).min(max)).copied();
        let colors: Vec<Option<[u8; 3]>> = self.counts().map(|count| count.and_then(color)).collect();
        let names = ["no camera", "1 camera", "2 cameras", "3 cameras", "4 cameras or more"];
        let meanings: Vec<([u8; 3], &str)> = COLORS.into_iter().zip(names).take(max + 1).collect();
        let map = MapPicture {
            relief: &relief,
            cell: ground.grid.cell,
            place: Some(&georeference(&ground.grid, &self.found.targets.frame)),
            colors: &colors,
            marks: &marks,
            mark_name: "camera",
            title: "Cameras, and how many of them cover each cell",
            legend: MapLegend::Colors(&meanings),
        };
        Ok(write_png(output, &map_picture(&map)?)?)
    }

    fn write_targets(&self, output: &Path) -> Result<()> {
        let CamerasResults { targets, placed, .. } = self.found;
        let rows: Vec<usize> = (0..targets.len()).filter(|&row| targets.is_target(row)).collect();
        let mut cameras: Vec<Vec<String>> = vec![Vec::new(); targets.len()];
        for (number, camera) in (1..).zip(&self.found.cameras) {
            camera.covered.iter().for_each(|&target| cameras[target].push(i32::to_string(&number)));
        }
        let places: Vec<[f64; 3]> = rows.iter().map(|&row| targets.positions[row].map(f64::from)).collect();
        let mut columns = vec![ResultColumn::whole("target", rows.iter().map(|row| row + 1))];
        columns.extend(ResultColumn::coordinates(&targets.frame, &places));
        columns.extend([
            ResultColumn::real("weight", rows.iter().map(|&row| targets.weight(row)), 4),
            ResultColumn::whole("cameras", rows.iter().map(|&row| placed.counts[row] as usize)),
            ResultColumn::words("covered_by", rows.iter().map(|&row| cameras[row].join(" "))),
        ]);
        Ok(write_table(output, &columns)?)
    }
}
