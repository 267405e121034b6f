//! All tiles of a result as one: a catalogue that programs of GIS open, or one raster.

use crate::grid::TileId;
use crate::plan::Plan;
use crate::question::TileQuestion;
use crate::record::{Stage, TileOutcome, TileRecord};
use belvedere::control::Control;
use belvedere::crs::text::wkt_line;
use belvedere::ground::MapGrid;
use belvedere::io::{Georeference, NamedBand, PlacedRaster, Source, atomic};
use belvedere::results::{Pixels, ResultRaster, georeference};
use belvedere::{Error, Parameter, Result};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

/// Most cells of a merged raster: a gigabyte of floats.
const MAX_CELLS: usize = 1 << 28;

/// What was merged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Merged {
    /// Tiles that have a result.
    pub tiles: usize,
    /// Tiles of the plan that have none, because they are empty, failed or are not done.
    pub without_result: usize,
}

/// Those of `tiles` with a result, and the grid of cells around all of them.
fn results(plan: &Plan, folder: &Path, question: &TileQuestion, tiles: &[TileId]) -> Result<(Vec<TileId>, MapGrid)> {
    let has_result = |tile: &TileId| {
        TileRecord::read(plan, folder, Stage::Answer(question), *tile)
            .is_some_and(|record| record.outcome == TileOutcome::Done)
    };
    let grid = plan.grid();
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for &tile in tiles {
        let core = grid.core(tile);
        low = [0, 1].map(|axis| low[axis].min(core.low[axis]));
        high = [0, 1].map(|axis| high[axis].max(core.high[axis]));
    }
    if tiles.is_empty() {
        return Err(Error::NoPoints { what: "the plan has no tile there".to_owned() });
    }
    let cell = plan.cells.of(question);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number of cells")]
    let count = |axis: usize| ((high[axis] - low[axis]) / cell).round() as usize;
    let cells = MapGrid { corner: [low[0], high[1]], cell, width: count(0), height: count(1) };
    Ok((tiles.iter().copied().filter(has_result).collect(), cells))
}

/// Column and row of the first cell of a tile, and cells along its side.
fn place_of(plan: &Plan, cells: &MapGrid, tile: TileId) -> [usize; 3] {
    let core = plan.grid().core(tile);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number of cells")]
    let number = |metres: f64| (metres / cells.cell).round() as usize;
    [number(core.low[0] - cells.corner[0]), number(cells.corner[1] - core.high[1]), number(plan.tile_size)]
}

fn in_xml(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

/// Writes a catalogue (`.vrt`) of the results of a question that are there, which QGIS, GDAL and rasterio open as one
/// raster that says what its values are.
///
/// # Errors
/// [`Error::Io`].
pub fn write_catalogue(plan: &Plan, folder: &Path, question: &TileQuestion) -> Result<Merged> {
    let planned = plan.tiles_of(question);
    let (tiles, cells) = results(plan, folder, question, &planned)?;
    let frame = plan.frame()?;
    let place = georeference(&cells, &frame);
    let (kind, no_data) = plan.kind_of(question).in_gdal();
    let mut text = format!("<VRTDataset rasterXSize=\"{}\" rasterYSize=\"{}\">\n", cells.width, cells.height);
    if let Some(system) = wkt_line(&frame.crs) {
        let _ = writeln!(text, "  <SRS>{}</SRS>", in_xml(&system));
    }
    let [x, y] = place.upper_left;
    let step = place.column_step[0];
    let _ = writeln!(text, "  <GeoTransform>{x}, {step}, 0, {y}, 0, {}</GeoTransform>", -step);
    // as GDAL calls the description of a TIFF, so that one that is made from the catalogue has it too
    let what = in_xml(question.description());
    let _ = writeln!(text, "  <Metadata>\n    <MDI key=\"TIFFTAG_IMAGEDESCRIPTION\">{what}</MDI>\n  </Metadata>");
    for (band, name) in (1..).zip(question.bands(plan.kind_of(question))) {
        let name = in_xml(&name);
        let _ = writeln!(text, "  <VRTRasterBand dataType=\"{kind}\" band=\"{band}\">");
        let _ = writeln!(text, "    <Description>{name}</Description>\n    <NoDataValue>{no_data}</NoDataValue>");
        for &tile in &tiles {
            let [column, row, side] = place_of(plan, &cells, tile);
            let _ = writeln!(
                text,
                "    <SimpleSource><SourceFilename relativeToVRT=\"1\">{}/{}.tif</SourceFilename>\
                 <SourceBand>{band}</SourceBand><SrcRect xOff=\"0\" yOff=\"0\" xSize=\"{side}\" ySize=\"{side}\"/>\
                 <DstRect xOff=\"{column}\" yOff=\"{row}\" xSize=\"{side}\" ySize=\"{side}\"/></SimpleSource>",
                question.name(),
                tile.name()
            );
        }
        text.push_str("  </VRTRasterBand>\n");
    }
    text.push_str("</VRTDataset>\n");
    let path = folder.join(format!("{}.vrt", question.name()));
    atomic::write(&path, |file| file.write_all(text.as_bytes()).map_err(Error::io(&path)))?;
    Ok(Merged { tiles: tiles.len(), without_result: planned.len() - tiles.len() })
}

/// Writes the results of a question that are there as one cloud-optimised GeoTIFF, which says what its values are.
///
/// # Errors
/// [`Error::InvalidParameter`] for more cells than fit into memory; those of reading and writing rasters.
pub fn merge(
    plan: &Plan,
    folder: &Path,
    question: &TileQuestion,
    output: &Path,
    control: &Control<'_>,
) -> Result<Merged> {
    let (pixels, place, merged) = gather(plan, folder, question, &plan.tiles_of(question), control)?;
    let names = question.bands(pixels.kind());
    ResultRaster { pixels, names, description: question.description().to_owned() }.write_cog(output, &place)?;
    Ok(merged)
}

/// The results of a question that are there, of the tiles that touch the box from `low` to `high` on the map, metres of
/// the reference system.
///
/// # Errors
/// [`Error::NoPoints`] where the plan has no tile there, [`Error::InvalidParameter`] for more cells than fit into
/// memory; those of reading rasters.
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
    let (pixels, place, _) = gather(plan, folder, question, &tiles, control)?;
    let description = Some(question.description().to_owned());
    let mut bands = question.bands(pixels.kind()).into_iter().zip(pixels.to_numbers()?);
    let Some((name, values)) = bands.next() else {
        return Err(Error::NoPoints { what: "the result has no band".to_owned() });
    };
    let further_bands = bands.map(|(name, values)| NamedBand { name, values }).collect();
    Ok(PlacedRaster { values, name, place: Some(place), description, further_bands })
}

/// The results of `tiles` that are there, in one raster around all of them.
fn gather(
    plan: &Plan,
    folder: &Path,
    question: &TileQuestion,
    tiles: &[TileId],
    control: &Control<'_>,
) -> Result<(Pixels, Georeference, Merged)> {
    let (with_result, cells) = results(plan, folder, question, tiles)?;
    let (width, height) = (cells.width, cells.height);
    if width.saturating_mul(height) > MAX_CELLS {
        return Err(Error::InvalidParameter {
            parameter: Parameter::Raster,
            value: format!("{width} x {height} cells"),
            expected: "at most 268 million cells; open the .vrt, or convert it with gdal_translate",
        });
    }
    let kind = plan.kind_of(question);
    let mut all = Pixels::nothing(kind, question.bands(kind).len(), [width, height]);
    for &tile in &with_result {
        control.check()?;
        let stage = Stage::Answer(question);
        let Some(record) = TileRecord::read(plan, folder, stage, tile) else { continue };
        let path = stage.result(folder, tile);
        let values = Pixels::read(Source::bytes(&path, &record.read_result(&path)?))?;
        all.put(&values, place_of(plan, &cells, tile))?;
    }
    let merged = Merged { tiles: with_result.len(), without_result: tiles.len() - with_result.len() };
    Ok((all, georeference(&cells, &plan.frame()?), merged))
}
