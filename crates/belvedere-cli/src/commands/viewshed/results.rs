//! Viewsheds as files.

use crate::arguments::refuse;
use crate::outputs::fading::{UNPROVEN_COLOR, fade, faded};
use crate::outputs::formats::extension;
use crate::outputs::sheet::Sheet;
use anyhow::Result;
use belvedere::apps::ask::UNCERTAIN;
use belvedere::apps::targets::Measure;
use belvedere::apps::viewshed::{Viewshed, title_of_cells};
use belvedere::figures::{MapLegend, MapPicture, Picture, map_picture, ramp, write_png};
use belvedere::ground::{Ground, MapGrid, highest_points};
use belvedere::io::{
    ExtraColumn, ExtraValues, Georeference, MetadataTag, PolygonArea, WriteReport, outlines, write_areas, write_cloud,
    write_npy_u32_bands, write_tif_u32,
};
use belvedere::query::Answer;
use belvedere::raster::Raster;
use belvedere::results::{ResultRaster, georeference, terrain_georeference};
use belvedere::{ElevationGrid, Frame, PointCloud};
use std::path::Path;

const SEEN_COLOR: [u8; 3] = [255, 176, 0];
const HIDDEN_COLOR: [u8; 3] = [38, 52, 96];
/// Terrain over which the cloud lies, which has cells of its own.
const CLOUD_COLOR: [u8; 3] = [120, 120, 120];

/// Viewshed of cells, and their position.
pub(super) struct SeenCells<'a> {
    pub(super) seen: &'a Viewshed,
    /// Certainty of the answers.
    pub(super) sure: &'a [Measure],
    pub(super) eyes: &'a [[f64; 3]],
    pub(super) frame: &'a Frame,
    pub(super) on: CellSurface<'a>,
    /// True for a reverse viewshed: the cells see the eye.
    pub(super) is_reverse: bool,
}

/// Surface below the cells.
#[derive(Clone, Copy)]
pub(super) enum CellSurface<'a> {
    /// The ground below a cloud.
    Ground(&'a Ground, &'a PointCloud),
    /// Terrain beyond the cloud.
    Terrain(&'a ElevationGrid),
}

impl CellSurface<'_> {
    fn size(self) -> [usize; 2] {
        match self {
            Self::Ground(ground, _) => [ground.grid.width, ground.grid.height],
            Self::Terrain(terrain) => [terrain.heights().width(), terrain.heights().height()],
        }
    }

    fn georeference(self, frame: &Frame) -> Georeference {
        match self {
            Self::Ground(ground, _) => georeference(&ground.grid, frame),
            Self::Terrain(terrain) => terrain_georeference(terrain, frame),
        }
    }
}

impl SeenCells<'_> {
    /// Writes a raster, a map or areas.
    pub(super) fn write(&self, output: &Path, tags: &[MetadataTag]) -> Result<()> {
        let place = self.on.georeference(self.frame);
        match extension(output).as_str() {
            "geojson" | "gpkg" => self.write_areas(output, &place),
            "png" => self.write_map(output),
            _ => {
                let size = self.on.size();
                let raster =
                    ResultRaster::of_measures(&[&self.seen.to_measures(), self.sure].concat(), size)?.with_tags(tags);
                Ok(raster.write(output, Some(&place))?)
            }
        }
    }

    fn write_areas(&self, output: &Path, place: &Georeference) -> Result<()> {
        let [width, height] = self.on.size();
        let unit = self.frame.crs.metres_per_unit;
        let steps = [place.column_step[0], place.row_step[1]].map(|step| step * unit);
        let mut areas = Vec::new();
        for (answer, name) in [(Answer::Visible, "visible"), (Answer::Unproven, "unproven")] {
            let cells = self.seen.answers.iter().map(|&a| a == answer).collect();
            let polygons = outlines(&Raster::from_values(width, height, cells)?);
            if polygons.is_empty() {
                continue;
            }
            let cell_count: usize = polygons.iter().map(|polygon| polygon.cell_count).sum();
            let mut area = PolygonArea::default();
            area.properties.insert("answer".to_owned(), name.into());
            area.properties.insert("area_m2".to_owned(), (cell_count as f64 * steps[0] * -steps[1]).into());
            let corner = |corner: [usize; 2]| [0, 1].map(|i| place.upper_left[i] * unit + corner[i] as f64 * steps[i]);
            area.polygons = polygons.iter().map(|polygon| polygon.rings(corner)).collect();
            areas.push(area);
        }
        write_areas(output, &areas, &self.frame.crs)?;
        Ok(())
    }

    fn write_map(&self, output: &Path) -> Result<()> {
        let Self { seen, eyes, is_reverse, .. } = *self;
        let is_of_one = seen.seen_counts.len() == 1;
        let uncertain = self.sure.iter().find(|measure| measure.name == UNCERTAIN).filter(|_| is_of_one);
        let map = SeenMap {
            answers: &seen.answers,
            counts: &seen.counts,
            uncertain: uncertain.map(|measure| &measure.values[..]),
            eyes,
            is_of_one,
            is_reverse,
        };
        let picture = match self.on {
            CellSurface::Ground(ground, cloud) => {
                let place = georeference(&ground.grid, self.frame);
                let relief = highest_points(&cloud.positions, ground);
                map.draw(relief, &ground.grid, place)?
            }
            CellSurface::Terrain(terrain) => map.draw_terrain(terrain, self.frame)?,
        };
        Ok(write_png(output, &picture)?)
    }
}

/// Content of a map of a viewshed.
pub(super) struct SeenMap<'a> {
    /// The best answer for each cell.
    pub(super) answers: &'a [Answer],
    /// Number of observers that see each.
    pub(super) counts: &'a [u32],
    /// Flags of the uncertain answers of the one observer, if known.
    pub(super) uncertain: Option<&'a [f32]>,
    /// Local metres.
    pub(super) eyes: &'a [[f64; 3]],
    pub(super) is_of_one: bool,
    /// True for a reverse viewshed: the cells see the eye.
    pub(super) is_reverse: bool,
}

impl SeenMap<'_> {
    /// Over the relief of the cells of `grid`.
    pub(super) fn draw(&self, relief: Raster<f32>, grid: &MapGrid, place: Georeference) -> belvedere::Result<Picture> {
        let sheet = Sheet { relief, colors: self.colors(None), cell: grid.cell, corner: grid.corner, place };
        self.on_sheet(&sheet, title_of_cells(self.is_of_one, self.is_reverse), None)
    }

    /// Over terrain beyond the cloud.
    fn draw_terrain(&self, terrain: &ElevationGrid, frame: &Frame) -> belvedere::Result<Picture> {
        let title = match (self.is_reverse, self.is_of_one) {
            (true, _) => "Terrain from which the target is visible",
            (false, true) => "Terrain visible from the observer",
            (false, false) => "Number of observers that see the terrain",
        };
        let sheet = Sheet::of_terrain(terrain, &self.colors(Some(CLOUD_COLOR)), frame)?;
        self.on_sheet(&sheet, title, Some((CLOUD_COLOR, "point cloud")))
    }

    /// Two at least: the legend of a range of two or more has whole numbers.
    fn greatest(&self) -> f64 {
        f64::from(self.counts.iter().copied().max().unwrap_or(0).max(2))
    }

    /// A colour for each cell; where the cloud is, `of_cloud`.
    fn colors(&self, of_cloud: Option<[u8; 3]>) -> Vec<Option<[u8; 3]>> {
        let (one, max) = (self.is_of_one, self.greatest());
        let color = |(answer, &count): (&Answer, &u32)| match answer {
            Answer::Visible if one => Some(SEEN_COLOR),
            Answer::Blocked if one => Some(HIDDEN_COLOR),
            Answer::Visible | Answer::Blocked => Some(ramp(f64::from(count) / max)),
            Answer::Unproven => Some(UNPROVEN_COLOR),
            Answer::OutsideCloud => of_cloud,
            _ => None,
        };
        let mut colors: Vec<Option<[u8; 3]>> = self.answers.iter().zip(self.counts).map(color).collect();
        if let Some(uncertain) = self.uncertain {
            fade(&mut colors, uncertain);
        }
        colors
    }

    fn on_sheet(
        &self,
        sheet: &Sheet,
        title: &str,
        cloud: Option<([u8; 3], &'static str)>,
    ) -> belvedere::Result<Picture> {
        let unproven = self.answers.contains(&Answer::Unproven).then_some((UNPROVEN_COLOR, "unproven"));
        let mut others = unproven.as_slice().to_vec();
        let mut classes = [&[(SEEN_COLOR, "visible")], &others[..], &[(HIDDEN_COLOR, "blocked")]].concat();
        if self.uncertain.is_some() {
            classes.extend([(faded(SEEN_COLOR), "visible, uncertain"), (faded(HIDDEN_COLOR), "blocked, uncertain")]);
        }
        others.extend(cloud);
        classes.extend(cloud);
        let marks = sheet.marks(self.eyes);
        let max = self.greatest();
        let legend = match self.is_of_one {
            true => MapLegend::Colors(&classes),
            false => MapLegend::Ramp("observers", [0.0, max], &others),
        };
        let mark_name = if self.is_reverse { "target" } else { "observer" };
        let Sheet { relief, colors, cell, place, .. } = sheet;
        let map =
            MapPicture { relief, cell: *cell, place: Some(place), colors, marks: &marks, mark_name, title, legend };
        map_picture(&map)
    }
}

/// Writes which observers see which cell.
pub(super) fn write_masks(output: &Path, seen: &Viewshed, ground: &Ground, cloud: &PointCloud) -> Result<()> {
    let grid = ground.grid;
    if extension(output) == "npy" {
        return Ok(write_npy_u32_bands(output, &seen.masks, grid.width, grid.height)?);
    }
    let [band] = &seen.masks[..] else {
        return refuse("--masks: a .tif holds 32 observers; use .npy");
    };
    let raster = Raster::from_values(grid.width, grid.height, band.clone())?;
    let what = "bit i: observer i sees the cell";
    Ok(write_tif_u32(output, &raster, Some(&georeference(&grid, &cloud.frame)), None, Some(what))?)
}

/// Writes the points of the cloud with what is seen of them.
pub(super) fn on_points(output: &Path, seen: &Viewshed, sure: &[Measure], cloud: &PointCloud) -> Result<WriteReport> {
    let codes: Vec<u8> = seen.answers.iter().map(|&answer| answer as u8).collect();
    let mut columns = vec![ExtraColumn {
        name: "answer",
        description: "0 no 1 yes 2 unproven 3 4 outside",
        values: ExtraValues::U8(&codes),
    }];
    if seen.seen_counts.len() > 1 {
        columns.push(ExtraColumn {
            name: "observers",
            description: "observers that see the point",
            values: ExtraValues::U32(&seen.counts),
        });
    }
    columns.extend(sure.iter().map(|measure| ExtraColumn {
        name: &measure.name,
        description: measure.description,
        values: ExtraValues::F32(&measure.values),
    }));
    Ok(write_cloud(output, cloud, &columns)?)
}
