//! Views from windows as files.

use crate::outputs::formats::extension;
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::ask::sections::GroundSection;
use belvedere::apps::ask::{self, Scene, WindowViewsResults};
use belvedere::apps::result_columns::ResultColumn;
use belvedere::apps::targets::{Measure, Targets};
use belvedere::apps::window_views::{SeenKind, named_columns};
use belvedere::figures::{MapLegend, MapPicture, map_picture, ramp, write_png};
use belvedere::ground::{GroundPoints, highest_points};
use belvedere::io::{Spot, TextRows, WriteReport, row_properties, with_columns_read, write_places, write_table};
use belvedere::results::{TakenFrom, georeference, write_measures};
use std::path::Path;

/// Radius of a window on a map, as a share of its longer side.
const DOT: f64 = 1.0 / 100.0;

/// Colour of cells without a window.
const NO_WINDOW_COLOR: [u8; 3] = [226; 3];

/// Results to write.
pub(super) struct WindowOutput<'a> {
    pub(super) scene: &'a Scene,
    pub(super) found: &'a WindowViewsResults,
    pub(super) measures: &'a [Measure],
    /// Position and properties of each window.
    pub(super) columns: Vec<ResultColumn>,
    /// Building of each window; empty where that is not known.
    pub(super) names: Vec<String>,
    /// The rows of a table of windows.
    pub(super) rows: &'a TextRows,
}

impl WindowOutput<'_> {
    /// A row or a point for each window.
    pub(super) fn write(&self, output: &Path) -> belvedere::Result<WriteReport> {
        match extension(output).as_str() {
            "csv" => self.write_table(output).map(|()| WriteReport::default()),
            "geojson" | "gpkg" => self.write_points(output).map(|()| WriteReport::default()),
            _ => {
                let centers: Vec<[f64; 3]> = self.found.windows.iter().map(|window| window.center).collect();
                let targets = Targets::of_places(&centers, self.scene.frame().clone());
                write_measures(output, &targets, TakenFrom::Nothing, self.measures, &[])
            }
        }
    }

    /// Columns of the windows, with `names` where these are known.
    fn columns(&self, names: &[String]) -> Vec<ResultColumn> {
        let mut columns = vec![ResultColumn::whole("window", 1..=self.found.windows.len())];
        if !names.is_empty() {
            columns.push(ResultColumn::words("name", names));
        }
        columns.extend(self.columns.iter().cloned());
        columns.extend(self.measures.iter().map(Measure::to_column));
        columns
    }

    fn write_table(&self, output: &Path) -> belvedere::Result<()> {
        let read = self.rows.columns(0..self.rows.row_count());
        let columns = self.columns(&self.found.names);
        write_table(output, &with_columns_read(&read, &["x", "y", "z", "azimuth", "tilt"], columns))
    }

    fn write_points(&self, output: &Path) -> belvedere::Result<()> {
        let frame = self.scene.frame();
        let mut columns = self.columns(&self.names);
        columns.retain(|column| !["x", "y", "z", "face", "area_m2"].contains(&&column.name[..]));
        let spot = |(row, window): (usize, &belvedere::apps::targets::Window)| {
            let place: [f64; 3] = std::array::from_fn(|axis| window.center[axis] + frame.origin[axis]);
            Spot { place, properties: row_properties(&columns, row) }
        };
        let spots: Vec<Spot> = self.found.windows.iter().enumerate().map(spot).collect();
        write_places(output, &spots, &[], &frame.crs).map(|_| ())
    }

    /// A row for each building.
    pub(super) fn write_buildings(&self, output: &Path) -> Result<()> {
        let found = self.found.by_name(&self.names);
        let mut columns = vec![
            ResultColumn::words("name", found.iter().map(|named| &named.name)),
            ResultColumn::whole("windows", found.iter().map(|named| named.windows)),
        ];
        columns.extend(named_columns(&found));
        Ok(write_table(output, &columns)?)
    }

    /// The share of one kind as dots on a map.
    pub(super) fn write_map(
        &self,
        output: &Path,
        title: &str,
        shown: SeenKind,
        run: &mut CommandContext,
    ) -> Result<()> {
        let grid = ask::GridCells::default().grid(self.scene)?;
        let known = self.scene.ground(grid, GroundPoints::Auto, &run.control())?;
        run.summary.add("ground", Summary::of(&GroundSection::of(&known)));
        let relief = highest_points(&self.scene.cloud().positions, &known.ground);
        let mut sums = vec![(0.0, 0.0); grid.len()];
        let radius = (DOT * grid.width.max(grid.height) as f64).max(1.0);
        for (window, view) in self.found.windows.iter().zip(&self.found.views) {
            let share = view.shares[shown as usize];
            let place = grid.cell_position([window.center[0], window.center[1]]);
            let Some(place) = place.filter(|_| share.is_finite()) else { continue };
            for cell in dot(place, radius, [grid.width, grid.height]) {
                sums[cell].0 += share;
                sums[cell].1 += 1.0;
            }
        }
        let shares: Vec<f64> = sums.into_iter().map(|(sum, count)| sum / count).collect();
        let max = shares.iter().copied().filter(|share| share.is_finite()).fold(0.0, f64::max).max(0.01);
        let colors: Vec<Option<[u8; 3]>> = shares
            .iter()
            .map(|share| Some(if share.is_finite() { ramp(share / max) } else { NO_WINDOW_COLOR }))
            .collect();
        let place = georeference(&grid, self.scene.frame());
        let legend =
            MapLegend::Ramp("percent of the view", [0.0, 100.0 * max], &[(NO_WINDOW_COLOR, "no window with a view")]);
        let map = MapPicture::of_colors(&relief, grid.cell, Some(&place), &colors, title, legend);
        Ok(run.stage("writing", 0, |_| write_png(output, &map_picture(&map)?))?)
    }
}

/// The cells of a disc around a place on a grid of `[width, height]` cells.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the grid")]
fn dot([x, y]: [f64; 2], radius: f64, size: [usize; 2]) -> impl Iterator<Item = usize> {
    let cells = |middle: f64, count: usize| {
        let from = (middle - radius).floor().max(0.0) as usize;
        from..((middle + radius).ceil().max(0.0) as usize).min(count)
    };
    let is_near =
        move |&(column, row): &(usize, usize)| (column as f64 + 0.5 - x).hypot(row as f64 + 0.5 - y) <= radius;
    let columns = cells(x, size[0]);
    let all = cells(y, size[1]).flat_map(move |row| columns.clone().map(move |column| (column, row)));
    all.filter(is_near).map(move |(column, row)| row * size[0] + column)
}
