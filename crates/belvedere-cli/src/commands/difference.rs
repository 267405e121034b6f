//! `belvedere difference`.

use super::{check_output, extension};
use crate::arguments::{DifferenceArguments, Global};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::{Result, bail};
use belvedere::apps::difference::{clear_unproven, difference};
use belvedere::figures::write_png;
use belvedere::io::{Georeference, PlacedRaster, TableCells, read_tif, write_table, write_tif_f32};
use belvedere::raster::Raster;
use belvedere::results::{ResultKind, UNPROVEN_BAND, difference_map};
use std::path::Path;

/// Share of a cell by which two rasters may lie apart and still have the same cells.
const SAME_PLACE: f64 = 1e-3;

pub(crate) fn run(arguments: &DifferenceArguments, global: &Global) -> Result<Summary> {
    for output in &arguments.output {
        check_output("-o", output, &["tif", "tiff", "png", "csv"])?;
    }
    let mut run = CommandContext::new(global);
    let read = |path: &Path, run: &mut CommandContext| run.stage("reading", 0, |_| read_tif(path));
    let mut before = read(&arguments.before, &mut run)?;
    let mut after = read(&arguments.after, &mut run)?;
    check_same_cells(&before, &after, arguments)?;
    if let (Some(first), Some(second)) = (&before.description, &after.description)
        && first != second
    {
        let files = [&arguments.before, &arguments.after].map(|path| path.display());
        run.summary.warn(
            "different-quantities",
            format!(
                "{} holds \"{first}\" and {} \"{second}\"; a difference of different quantities means nothing",
                files[0], files[1]
            ),
        );
    }
    for (path, raster) in [(&arguments.before, &mut before), (&arguments.after, &mut after)] {
        let band = raster.further_bands.iter().find(|band| band.name == UNPROVEN_BAND);
        let unproven = band.map_or(&[][..], |band| band.values.values());
        let unproven = clear_unproven(raster.values.values_mut(), unproven, raster.description.as_deref());
        if raster.further_bands.iter().any(|band| band.name != UNPROVEN_BAND) {
            run.summary.warn("bands-left-out", format!("{}: only the first band is compared", path.display()));
        }
        if unproven > 0 {
            run.summary.warn(
                "unproven-cells-left-out",
                format!("{}: unproven cells count as cells without a value ({unproven})", path.display()),
            );
        }
    }
    let place = before.place.as_ref();
    let unit = place.map_or(1.0, |place| place.crs.metres_per_unit);
    let [column, row] = place.map_or([[1.0, 0.0], [0.0, -1.0]], |place| [place.column_step, place.row_step]);
    let cell_area = (column[0] * row[1] - column[1] * row[0]).abs() * unit * unit;
    let change = difference(before.values.values(), after.values.values(), cell_area)?;
    let values = Raster::from_values(before.values.width(), before.values.height(), change.values)?;
    run.summary.add("difference", Summary::of(&change.report));
    let name = |path: &Path| path.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let title = || format!("Change from {} to {}", name(&arguments.before), name(&arguments.after));
    let title = arguments.title.clone().unwrap_or_else(title);
    for output in &arguments.output {
        run.stage("writing", 0, |_| match extension(output).as_str() {
            "csv" => {
                let figures = change.report.figures();
                let cells: Vec<[f64; 1]> = figures.iter().map(|(_, value)| [*value]).collect();
                let decimals = |name: &str| if name.starts_with("cells") { 0 } else { 4 };
                let columns: Vec<(&str, TableCells<'_>)> = figures
                    .iter()
                    .zip(&cells)
                    .map(|((name, _), value)| (*name, TableCells::Real(value, decimals(name))))
                    .collect();
                write_table(output, &columns)
            }
            "png" => write_png(output, &difference_map(&values, cell_area.sqrt(), place, &title)?),
            _ => write_tif_f32(output, &values, place, Some(ResultKind::NO_NUMBER), Some("after less before")),
        })?;
    }
    run.summary
        .headline(
            "gain on <difference.area_gain_m2> m2, loss on <difference.area_loss_m2> m2, of <difference.cells> cells",
        )
        .headline("mean <difference.mean_before> before, <difference.mean_after> after")
        .headline("largest gain <difference.largest_gain>, largest loss <difference.largest_loss>");
    run.summary.add("written", arguments.output.iter().map(|path| path.display().to_string()).collect::<Vec<_>>());
    Ok(run.finish())
}

/// Refuses rasters whose cells are not the same.
fn check_same_cells(before: &PlacedRaster, after: &PlacedRaster, arguments: &DifferenceArguments) -> Result<()> {
    let sizes = [before, after].map(|raster| [raster.values.width(), raster.values.height()]);
    let (first, second) = (arguments.before.display(), arguments.after.display());
    if sizes[0] != sizes[1] {
        let [[width, height], [other_width, other_height]] = sizes;
        bail!(
            "{second}: {other_width} x {other_height} cells, but {first} has {width} x {height}; give both commands the same --cell"
        );
    }
    let (Some(a), Some(b)) = (&before.place, &after.place) else { return Ok(()) };
    if a.crs.contradicts(&b.crs) {
        bail!("{second}: in {}, but {first} is in {}; convert one of them", b.crs.describe(), a.crs.describe());
    }
    let numbers = |place: &Georeference| [place.upper_left, place.column_step, place.row_step].concat();
    let cell = a.column_step[0].hypot(a.column_step[1]);
    if numbers(a).iter().zip(numbers(b)).any(|(a, b)| (a - b).abs() > SAME_PLACE * cell) {
        bail!(
            "{second}: its cells lie elsewhere than those of {first}; make both from the same cloud with the same --cell"
        );
    }
    Ok(())
}
