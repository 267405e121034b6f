//! Views of a landmark as files.

use anyhow::Result;
use belvedere::PointCloud;
use belvedere::apps::landmark::{LandmarkMeasure, LandmarkView, measures};
use belvedere::apps::result_columns::ResultColumn;
use belvedere::apps::targets::Measure;
use belvedere::figures::{MapLegend, MapMark, MapPicture, map_picture, ramp, write_png};
use belvedere::ground::{Ground, highest_points};
use belvedere::io::{MetadataTag, TextRows, atomic, with_columns_read, write_table};
use belvedere::results::{ResultRaster, georeference};
use belvedere::vector::to_f32;
use std::path::Path;

/// Cells from which nothing of the landmark is seen: apart from the dark violet of a little.
const UNSEEN_COLOR: [u8; 3] = [176, 120, 120];

/// A row for each observer that stands somewhere, with what a table said of it; one that was skipped has its
/// coordinates alone.
pub(super) fn write_rows(
    output: &Path,
    views: &[LandmarkView],
    places: &[[f64; 3]],
    given: &TextRows,
    cloud: &PointCloud,
) -> Result<()> {
    let rows: Vec<usize> = (0..places.len()).filter(|&row| places[row][..2].iter().all(|v| v.is_finite())).collect();
    let kept: Vec<[f64; 3]> = rows.iter().map(|&row| places[row]).collect();
    let of_measure = |measure: &LandmarkMeasure| {
        ResultColumn::real(measure.name, rows.iter().map(|&row| measure.of(&views[row])), measure.decimals)
    };
    let columns =
        ResultColumn::coordinates(&cloud.frame, &kept).into_iter().chain(measures(views).iter().map(of_measure));
    let read = given.columns(rows.iter().copied());
    Ok(write_table(output, &with_columns_read(&read, &["x", "y", "z"], columns.collect()))?)
}

/// The share seen as a raster.
pub(super) fn write_share(
    output: &Path,
    views: &[LandmarkView],
    ground: &Ground,
    cloud: &PointCloud,
    tags: &[MetadataTag],
) -> Result<()> {
    write_measure(output, &measures(views)[0], views, (ground, cloud), tags)
}

/// Every measure as a raster of its own in `folder`; the files written.
pub(super) fn write_measures(
    folder: &Path,
    views: &[LandmarkView],
    ground: &Ground,
    cloud: &PointCloud,
    tags: &[MetadataTag],
) -> Result<Vec<String>> {
    atomic::make_folder(folder)?;
    let mut written = Vec::new();
    for measure in measures(views) {
        let path = folder.join(format!("{}.tif", measure.name));
        write_measure(&path, measure, views, (ground, cloud), tags)?;
        written.push(path.display().to_string());
    }
    Ok(written)
}

fn write_measure(
    output: &Path,
    measure: &LandmarkMeasure,
    views: &[LandmarkView],
    (ground, cloud): (&Ground, &PointCloud),
    tags: &[MetadataTag],
) -> Result<()> {
    let grid = ground.grid;
    let values = views.iter().map(|view| to_f32(measure.of(view))).collect();
    let of_cells = Measure::new(measure.name, values).with_description(measure.description).with_unit(measure.unit);
    let raster = ResultRaster::of_measures(&[of_cells], [grid.width, grid.height])?.with_tags(tags);
    Ok(raster.write(output, Some(&georeference(&grid, &cloud.frame)))?)
}

/// The share seen as a map.
pub(super) fn write_map(
    output: &Path,
    views: &[LandmarkView],
    ground: &Ground,
    cloud: &PointCloud,
    middle: [f64; 2],
) -> Result<()> {
    let relief = highest_points(&cloud.positions, ground);
    let shares: Vec<f64> = views.iter().map(LandmarkView::visible_share).collect();
    let max = shares.iter().copied().filter(|share| share.is_finite()).fold(0.0, f64::max).max(0.01);
    let color = |&share: &f64| match share {
        0.0 => Some(UNSEEN_COLOR),
        share => share.is_finite().then(|| ramp(share / max)),
    };
    let unseen = shares.contains(&0.0).then_some((UNSEEN_COLOR, "not visible"));
    let colors: Vec<Option<[u8; 3]>> = shares.iter().map(color).collect();
    let place = ground.grid.cell_position(middle);
    let mark = place.map(|place| MapMark { place, ..MapMark::default() });
    let map = MapPicture {
        relief: &relief,
        cell: ground.grid.cell,
        place: Some(&georeference(&ground.grid, &cloud.frame)),
        colors: &colors,
        marks: mark.as_slice(),
        mark_name: "landmark",
        title: "Visible share of the landmark",
        legend: MapLegend::Ramp("percent", [0.0, 100.0 * max], unseen.as_slice()),
    };
    Ok(write_png(output, &map_picture(&map)?)?)
}
