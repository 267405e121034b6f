//! All tiles of a result in one file: a catalogue for GIS programs, or one raster.

use crate::grid::{MapArea, TileId};
use crate::plan::Plan;
use crate::plan::question::TileQuestion;
use crate::plan::record::{TileOutcome, TileRecord};
use crate::plan::stage::Stage;
use crate::plan::window;
use belvedere::apps::ask::{Places, Remark};
use belvedere::cast::{to_i64, to_index};
use belvedere::control::Control;
use belvedere::crs::text::wkt_line;
use belvedere::ground::{HighestPoints, MapGrid};
use belvedere::io::{BandLabel, Georeference, NamedBand, PlacedRaster, Source, atomic};
use belvedere::query::FarTerrain;
use belvedere::raster::Raster;
use belvedere::results::{Pixels, ResultRaster, georeference, question_tags};
use belvedere::{Error, Parameter, Result};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

/// Maximum number of cells of a merged raster: a gigabyte of floats.
const MAX_CELLS: usize = 1 << 28;

/// Treatment of an unfinished run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UnfinishedRun {
    /// Refusal with an error.
    #[default]
    Refused,
    /// Merge of the existing results.
    Merged,
}

/// Counts of merged tiles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Merged {
    /// Number of tiles with a result.
    pub tiles: usize,
    /// Number of tiles of the plan without any value.
    pub empty: usize,
    /// Number of tiles of the plan that failed, are not done yet, or have a damaged result.
    pub missing: usize,
}

impl Merged {
    /// Returns a remark on missing tiles, if there are any.
    #[must_use]
    pub fn remarks(&self) -> Vec<Remark> {
        let Self { tiles, empty, missing } = *self;
        let text = format!(
            "the run is not finished: {missing} of {} tiles have no result yet, and their cells have no data",
            tiles + empty + missing
        );
        (missing > 0)
            .then(|| Remark::warning("run-unfinished", text).with("count", missing as f64))
            .into_iter()
            .collect()
    }
}

/// Returns the tiles with a result, and the counts of all kinds of tiles.
fn results(plan: &Plan, folder: &Path, question: &TileQuestion, tiles: &[TileId]) -> (Vec<TileId>, Merged) {
    let stage = Stage::Answer(question);
    let (mut with_result, mut counts) = (Vec::new(), Merged::default());
    for &tile in tiles {
        match TileRecord::read(plan, folder, stage, tile).map(|record| record.outcome) {
            Some(TileOutcome::Done) => {
                counts.tiles += 1;
                with_result.push(tile);
            }
            Some(TileOutcome::Nothing) => counts.empty += 1,
            Some(TileOutcome::Failed(_)) | None => counts.missing += 1,
        }
    }
    (with_result, counts)
}

/// Returns the smallest rectangle around all tiles.
fn area_of(plan: &Plan, tiles: &[TileId]) -> Result<MapArea> {
    let cores = tiles.iter().map(|&tile| plan.grid().core(tile));
    let area = cores.reduce(|area, core| area.joined(&core));
    area.ok_or_else(|| Error::NoPoints { what: "the plan has no tile there".to_owned() })
}

/// Returns the part of the area of `tiles`, up to the reach of points, in which cells of a question may have a value.
fn area_with_cells(plan: &Plan, question: &TileQuestion, tiles: &[TileId]) -> Result<MapArea> {
    let (whole, cell) = (area_of(plan, tiles)?, plan.cells.of(question));
    let near = plan.area();
    let edge =
        |axis: usize, v: f64, round: fn(f64) -> f64| whole.low[axis] + round((v - whole.low[axis]) / cell) * cell;
    Ok(MapArea {
        low: [0, 1].map(|axis| edge(axis, near.low[axis], f64::floor).max(whole.low[axis])),
        high: [0, 1].map(|axis| edge(axis, near.high[axis], f64::ceil).min(whole.high[axis])),
    })
}

/// Returns the cells of the result of a question over an area.
fn cells_over(plan: &Plan, question: &TileQuestion, area: &MapArea) -> MapGrid {
    let cell = plan.cells.of(question);
    let count = |axis: usize| to_index(((area.high[axis] - area.low[axis]) / cell).round());
    MapGrid { corner: [area.low[0], area.high[1]], cell, width: count(0), height: count(1) }
}

/// Returns column and row of the first cell of a tile, which may lie beside the cells.
fn place_of(plan: &Plan, cells: &MapGrid, tile: TileId) -> [i64; 2] {
    let core = plan.grid().core(tile);
    let number = |metres: f64| to_i64((metres / cells.cell).round());
    [number(core.low[0] - cells.corner[0]), number(cells.corner[1] - core.high[1])]
}

/// Returns the number of cells along the side of a tile.
fn side_of(plan: &Plan, cells: &MapGrid) -> usize {
    to_index((plan.tile_size / cells.cell).round())
}

fn in_xml(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

/// Writes a catalogue (`.vrt`) of the existing results of a question. QGIS, GDAL and rasterio open it as one raster
/// with a description of its values.
pub fn write_catalogue(plan: &Plan, folder: &Path, question: &TileQuestion, control: &Control<'_>) -> Result<Merged> {
    let planned = plan.tiles_of(question);
    let (tiles, counts) = results(plan, folder, question, &planned);
    let cells = cells_over(plan, question, &area_of(plan, &planned)?);
    let frame = plan.frame()?;
    let place = georeference(&cells, &frame);
    let bands = plan.prepared(question, FarTerrain::default(), control)?.bands()?;
    let (kind, no_data) = bands.pixels.kind().in_gdal();
    let mut text = format!("<VRTDataset rasterXSize=\"{}\" rasterYSize=\"{}\">\n", cells.width, cells.height);
    if let Some(system) = wkt_line(&frame.crs) {
        let _ = writeln!(text, "  <SRS>{}</SRS>", in_xml(&system));
    }
    let [x, y] = place.upper_left;
    let step = place.column_step[0];
    let _ = writeln!(text, "  <GeoTransform>{x}, {step}, 0, {y}, 0, {}</GeoTransform>", -step);
    // GDAL's name for the description of a TIFF, so that a TIFF made from the catalogue has the description too.
    let what = in_xml(&bands.description);
    let _ = writeln!(text, "  <Metadata>\n    <MDI key=\"TIFFTAG_IMAGEDESCRIPTION\">{what}</MDI>\n  </Metadata>");
    for (band, label) in (1..).zip(&bands.labels) {
        let name = in_xml(&label.name);
        let _ = writeln!(text, "  <VRTRasterBand dataType=\"{kind}\" band=\"{band}\">");
        let _ = writeln!(text, "    <Description>{name}</Description>\n    <NoDataValue>{no_data}</NoDataValue>");
        for &tile in &tiles {
            let ([column, row], side) = (place_of(plan, &cells, tile), side_of(plan, &cells));
            let _ = writeln!(
                text,
                "    <SimpleSource><SourceFilename relativeToVRT=\"1\">{}/{}.tif</SourceFilename>\
                 <SourceBand>{band}</SourceBand><SrcRect xOff=\"0\" yOff=\"0\" xSize=\"{side}\" ySize=\"{side}\"/>\
                 <DstRect xOff=\"{column}\" yOff=\"{row}\" xSize=\"{side}\" ySize=\"{side}\"/></SimpleSource>",
                question.name,
                tile.name()
            );
        }
        text.push_str("  </VRTRasterBand>\n");
    }
    text.push_str("</VRTDataset>\n");
    let path = folder.join(format!("{}.vrt", question.name));
    atomic::write(&path, |file| file.write_all(text.as_bytes()).map_err(Error::io(&path)))?;
    Ok(counts)
}

/// Writes the results of a question as one cloud-optimised GeoTIFF with a description of its values. The raster extends
/// as far as points do.
///
/// # Errors
/// [`Error::Malformed`] for a run without a result, and for an unfinished run unless `unfinished` allows it.
/// [`Error::InvalidParameter`] for more cells than fit into memory. Also those of reading and writing rasters.
pub fn merge(
    plan: &Plan,
    folder: &Path,
    question: &TileQuestion,
    output: &Path,
    unfinished: UnfinishedRun,
    control: &Control<'_>,
) -> Result<Merged> {
    let tiles = plan.tiles_of(question);
    let (with_result, merged) = results(plan, folder, question, &tiles);
    let refused = |what: String| Err(Error::malformed(folder, what));
    let (name, Merged { missing, .. }) = (&question.name, merged);
    if with_result.is_empty() {
        let advice = if missing > 0 { "compute it with `belvedere city run`" } else { "no tile has a cell for it" };
        return refused(format!("has no result of {name}: {advice}"));
    }
    if missing > 0 && unfinished == UnfinishedRun::Refused {
        let count = tiles.len();
        return refused(format!(
            "is a run that is not finished: {missing} of {count} tiles have no result of {name} (`belvedere city status` \
             says which); run `belvedere city run` again, or merge what is there with --unfinished"
        ));
    }
    let cells = cells_over(plan, question, &area_with_cells(plan, question, &tiles)?);
    let prepared = plan.prepared(question, FarTerrain::default(), control)?;
    let places = Places::Cells(plan.grid_cells(question));
    let tags = question_tags(&prepared.question, &places, prepared.answers.time_zone());
    let bands = prepared.bands()?.with_tags(&tags);
    let (pixels, place) = gather(plan, folder, (question, &bands), (&with_result, &cells), control)?;
    ResultRaster { pixels, ..bands }.write_cog(output, &place)?;
    Ok(merged)
}

impl Plan {
    /// Returns the cells of a result of a question that may have a value, up to the reach of points.
    ///
    /// # Errors
    /// [`Error::NoPoints`] for a plan without a tile.
    pub fn cells_of(&self, question: &TileQuestion) -> Result<MapGrid> {
        Ok(cells_over(self, question, &area_with_cells(self, question, &self.tiles_of(question))?))
    }

    /// Returns the existing results of a question, on [`Plan::cells_of`].
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for more cells than fit into memory. Also those of reading rasters.
    pub(crate) fn results_of(
        &self,
        folder: &Path,
        (question, bands): (&TileQuestion, &ResultRaster),
        control: &Control<'_>,
    ) -> Result<Pixels> {
        let cells = self.cells_of(question)?;
        let (tiles, _) = results(self, folder, question, &self.tiles_of(question));
        Ok(gather(self, folder, (question, bands), (&tiles, &cells), control)?.0)
    }

    /// Returns the height of the highest point in each cell of a grid, for maps. A cell without points has the mean of
    /// its filled neighbours, or NaN without any. Points are read once and not kept.
    ///
    /// # Errors
    /// Those of reading the files.
    pub fn highest_points(&self, grid: &MapGrid, control: &Control<'_>) -> Result<Raster<f32>> {
        let mut highest = HighestPoints::new(*grid);
        window::each_batch(self, &self.area().widened(1.0), control, |cloud| highest.add(&cloud.positions))?;
        Ok(highest.filled(|_| f32::NAN))
    }
}

/// Returns the existing results of a question for tiles that touch a box. The box extends from `low` to `high` on the
/// map, in metres of the reference system.
///
/// # Errors
/// [`Error::NoPoints`] for a box without tiles of the plan, [`Error::InvalidParameter`] for more cells than fit into
/// memory. Also those of reading rasters.
pub fn merged_within(
    plan: &Plan,
    folder: &Path,
    question: &TileQuestion,
    (low, high): ([f64; 2], [f64; 2]),
    control: &Control<'_>,
) -> Result<PlacedRaster> {
    let (grid, origin) = (plan.grid(), plan.frame()?.origin);
    let touches = |tile: &TileId| {
        let core = grid.core(*tile);
        (0..2).all(|i| core.low[i] < high[i] - origin[i] && core.high[i] > low[i] - origin[i])
    };
    let tiles: Vec<TileId> = plan.tiles_of(question).into_iter().filter(touches).collect();
    let cells = cells_over(plan, question, &area_of(plan, &tiles)?);
    let with_result = results(plan, folder, question, &tiles).0;
    let bands = plan.prepared(question, FarTerrain::default(), control)?.bands()?;
    let (pixels, place) = gather(plan, folder, (question, &bands), (&with_result, &cells), control)?;
    let mut labelled = bands.labels.into_iter().zip(pixels.to_numbers()?);
    let Some((BandLabel { name, unit, .. }, values)) = labelled.next() else {
        return Err(Error::NoPoints { what: "the result has no band".to_owned() });
    };
    let further_bands = labelled.map(|(label, values)| NamedBand { name: label.name, values }).collect();
    Ok(PlacedRaster { values, name, unit, place: Some(place), description: Some(bands.description), further_bands })
}

/// Joins the results of tiles into one raster of cells.
fn gather(
    plan: &Plan,
    folder: &Path,
    (question, bands): (&TileQuestion, &ResultRaster),
    (tiles, cells): (&[TileId], &MapGrid),
    control: &Control<'_>,
) -> Result<(Pixels, Georeference)> {
    let (width, height) = (cells.width, cells.height);
    if width.saturating_mul(height) > MAX_CELLS {
        return Err(Error::invalid(
            Parameter::Raster,
            format!("{width} x {height} cells"),
            "at most 268 million cells; open the .vrt, or convert it with gdal_translate",
        ));
    }
    let mut all = Pixels::nothing(bands.pixels.kind(), bands.labels.len(), [width, height]);
    for &tile in tiles {
        control.check()?;
        let stage = Stage::Answer(question);
        let Some(record) = TileRecord::read(plan, folder, stage, tile) else { continue };
        let path = stage.result(plan, folder, tile);
        let values = Pixels::read(Source::bytes(&path, &record.read_result(&path)?))?;
        all.put(&values, place_of(plan, cells, tile), side_of(plan, cells))?;
    }
    Ok((all, georeference(cells, &plan.frame()?)))
}
