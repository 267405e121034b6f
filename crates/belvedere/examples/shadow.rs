//! The shadow on a tile at an instant, as a raster: `cargo run --release --example shadow -- TILE.laz EPSG:7415
//! shadow.tif`.

use belvedere::prelude::*;

fn main() -> Result<()> {
    let [tile, crs, output] = std::array::from_fn(|i| std::env::args().nth(i + 1).unwrap_or_default());
    let control = Control::none();
    let (cloud, _) = read_cloud([tile.as_str()], &ReadOptions::new().with_crs(crs), &control)?;
    let (model, _) = SceneModel::build(&cloud, &ModelParams::default(), &control)?;
    let scene = model.scene(&model.rule(), UnprovenAs::Visible, &control)?;
    let cells = Targets::ground_cells(&cloud, 0.5)?;
    let (site, _) = Site::of_scene(model.frame(), &model.bounds(), None, None)?;
    let sun = ShadowSun::at_time(&site, parse_instant("2026-06-21T15:00+02:00", None)?)?;
    let lit = shadow(&scene, &cells, sun, &control)?;
    write_raster(output.as_ref(), &cells, &[&Measure::new("lit", lit)], &[])
}
