//! `belvedere difference` of two rasters.

mod tables;

use crate::arguments::{DifferenceArguments, Global};
use crate::outputs::formats::{check_outputs, extension};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::{Result, bail};
use belvedere::apps::ask::Remark;
use belvedere::apps::difference::{clear_added, clear_unproven, contradiction_of, difference};
use belvedere::apps::result_columns::ResultColumn;
use belvedere::figures::write_png;
use belvedere::io::{
    BandLabel, BandValues, Bands, Georeference, NamedBand, PlacedRaster, ReadOptions, read_cloud, read_tif,
    write_table, write_tif_bands,
};
use belvedere::raster::Raster;
use belvedere::results::{ADDED_BAND, ResultKind, UNPROVEN_BAND, difference_map, relief_of};
use std::path::Path;

/// Share of a cell by which two rasters may lie apart and still have the same cells.
const SAME_PLACE: f64 = 1e-3;

pub(crate) fn run(arguments: &DifferenceArguments, global: &Global) -> Result<Summary> {
    check_outputs("-o", &arguments.output, &["tif", "tiff", "png", "csv"])?;
    let mut run = CommandContext::new(global);
    if [&arguments.before, &arguments.after].iter().all(|path| extension(path) == "csv") {
        tables::run(arguments, &mut run)?;
        return Ok(run.finish());
    }
    let read = |path: &Path, run: &mut CommandContext| run.stage("reading", 0, |_| read_tif(path));
    let mut before = read(&arguments.before, &mut run)?;
    let mut after = read(&arguments.after, &mut run)?;
    check_same_cells(&before, &after, arguments)?;
    warn_of_quantities(&before, &after, arguments, &mut run.summary);
    for (path, raster) in [(&arguments.before, &mut before), (&arguments.after, &mut after)] {
        let band = raster.further_bands.iter().find(|band| band.name == UNPROVEN_BAND);
        let unproven = band.map_or(&[][..], |band| band.values.values());
        let unproven = clear_unproven(raster.values.values_mut(), unproven, raster.description.as_deref());
        if unproven > 0 {
            run.summary.warn(
                "unproven-cells-left-out",
                format!("{}: unproven cells count as cells without a value ({unproven})", path.display()),
            );
        }
    }
    leave_out_added(&mut before, &mut after, &mut run.summary);
    let relief = arguments.relief.as_deref().map(|path| relief(path, &before, &mut run)).transpose()?;
    let place = before.place.as_ref();
    let unit = place.map_or(1.0, |place| place.crs.metres_per_unit);
    let [column, row] = place.map_or([[1.0, 0.0], [0.0, -1.0]], |place| [place.column_step, place.row_step]);
    let cell_area = (column[0] * row[1] - column[1] * row[0]).abs() * unit * unit;
    let change = difference(before.values.values(), after.values.values(), cell_area)?;
    let size = [before.values.width(), before.values.height()];
    let values = Raster::from_values(size[0], size[1], change.values)?;
    let further = further_changes(&before, &after, arguments, &mut run.summary);
    run.summary.add("difference", Summary::of(&change.report));
    let name = |path: &Path| path.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let title = || format!("Change from {} to {}", name(&arguments.before), name(&arguments.after));
    let title = arguments.title.clone().unwrap_or_else(title);
    for output in &arguments.output {
        run.stage("writing", 0, |_| match extension(output).as_str() {
            "csv" => write_figures(output, &change.report.figures()),
            "png" => write_png(output, &difference_map(&values, relief.as_ref(), cell_area.sqrt(), place, &title)?),
            _ => {
                let first = BandLabel::new(&before.name, &before.unit);
                let further_labels = further.iter().map(|band| BandLabel::new(&band.name, "1"));
                let labels: Vec<BandLabel> = std::iter::once(first).chain(further_labels).collect();
                let rasters: Vec<Raster<f32>> =
                    std::iter::once(&values).chain(further.iter().map(|band| &band.values)).cloned().collect();
                let values = BandValues::F32(&rasters, ResultKind::NO_NUMBER);
                let description = Some("after less before");
                write_tif_bands(output, &Bands { values, labels: &labels, tags: &run.tags, description }, place)
            }
        })?;
    }
    run.summary
        .headline(
            "gain on <difference.area_gain_m2> m2, loss on <difference.area_loss_m2> m2, of <difference.cells> cells",
        )
        .headline("mean <difference.mean_before> before, <difference.mean_after> after")
        .headline("largest gain <difference.largest_gain>, largest loss <difference.largest_loss>");
    run.summary.add_paths("written", &arguments.output);
    Ok(run.finish())
}

fn warn_of_quantities(
    before: &PlacedRaster,
    after: &PlacedRaster,
    arguments: &DifferenceArguments,
    summary: &mut Summary,
) {
    let names = [&arguments.before, &arguments.after].map(|path| path.display().to_string());
    let [first, second] = [before, after].map(|raster| raster.description.as_deref().unwrap_or_default());
    let found = contradiction_of([&names[0], first], [&names[1], second]);
    summary.remarks(found.and_then(Remark::of_contradiction));
}

fn write_figures(output: &Path, figures: &[(&str, f64)]) -> belvedere::Result<()> {
    let decimals = |name: &str| if name.starts_with("cells") { 0 } else { 4 };
    let column = |&(name, value): &(&str, f64)| ResultColumn::real(name, [value], decimals(name));
    write_table(output, &figures.iter().map(column).collect::<Vec<_>>())
}

/// The changes of the further results that both rasters have.
fn further_changes(
    before: &PlacedRaster,
    after: &PlacedRaster,
    arguments: &DifferenceArguments,
    summary: &mut Summary,
) -> Vec<NamedBand> {
    let results = |raster: &PlacedRaster| -> Vec<NamedBand> {
        let is_result = |band: &&NamedBand| band.name != UNPROVEN_BAND && band.name != ADDED_BAND;
        raster.further_bands.iter().filter(is_result).cloned().collect()
    };
    let (before_bands, after_bands) = (results(before), results(after));
    let in_both = |name: &str| before_bands.iter().chain(&after_bands).filter(|band| band.name == name).count() == 2;
    for (path, bands) in [(&arguments.before, &before_bands), (&arguments.after, &after_bands)] {
        let others: Vec<&str> =
            bands.iter().map(|band| band.name.as_str()).filter(|name| name.is_empty() || !in_both(name)).collect();
        if !others.is_empty() {
            let text =
                format!("{}: bands that the other raster has not are left out: {}", path.display(), others.join(", "));
            summary.warn("bands-left-out", text);
        }
    }
    let change = |mut band: NamedBand| {
        let other = after_bands.iter().find(|other| other.name == band.name)?;
        // cells that are not compared have no value in the first band
        let is_compared = before.values.values().iter().zip(after.values.values());
        let both = band.values.values_mut().iter_mut().zip(other.values.values()).zip(is_compared);
        both.for_each(|((own, other), (a, b))| *own = if a.is_nan() && b.is_nan() { f32::NAN } else { other - *own });
        Some(band)
    };
    before_bands.into_iter().filter(|band| !band.name.is_empty()).filter_map(change).collect()
}

/// Leaves out the cells on top of what was added, before or after, which are reported.
fn leave_out_added(before: &mut PlacedRaster, after: &mut PlacedRaster, summary: &mut Summary) {
    let added = |raster: &PlacedRaster| {
        raster.further_bands.iter().find(|band| band.name == ADDED_BAND).map(|band| band.values.values().to_vec())
    };
    let count: usize = [added(before), added(after)]
        .into_iter()
        .flatten()
        .map(|added| clear_added(before.values.values_mut(), after.values.values_mut(), &added))
        .sum();
    if count > 0 {
        let text =
            format!("{count} cells on top of what was added are not compared: they are other places than before");
        summary.remarks([Remark::note("cells-on-added-left-out", text).with("count", count as f64)]);
    }
}

/// The heights whose relief a map shows: of a cloud, or of a raster of the same cells.
fn relief(path: &Path, raster: &PlacedRaster, run: &mut CommandContext) -> Result<Raster<f32>> {
    let size = [raster.values.width(), raster.values.height()];
    if ["tif", "tiff"].contains(&extension(path).as_str()) {
        let heights = run.stage("reading relief", 0, |_| read_tif(path))?.values;
        if [heights.width(), heights.height()] != size {
            bail!("{}: its cells are not those of the rasters that are compared", path.display());
        }
        return Ok(heights);
    }
    let Some(place) = &raster.place else { bail!("--relief: the rasters do not say where they lie") };
    let (cloud, _) = run.stage("reading relief", 0, |control| read_cloud([path], &ReadOptions::new(), control))?;
    cloud.frame.crs.check_for(&place.crs, "relief", path)?;
    Ok(relief_of(&cloud, place, size)?)
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
